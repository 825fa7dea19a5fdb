"""Friction in your own model: a motor's flywheel drags a clutch disc, and the disc's shaft drives a load.

The shaft is elastic, and its axis is 1 mm off the axis of the flywheel. When the clutch engages, friction pulls the
disc's centre towards the flywheel's axis (self-centring). Pass a path to save a figure.
"""

import sys

import exudyn as exu
import numpy as np
from exudyn.itemInterface import (
    CoordinateSpringDamper,
    LoadCoordinate,
    MarkerNodeCoordinate,
    Node1D,
    NodePointGround,
    NodeRigidBody2D,
    ObjectRigidBody2D,
    ObjectRotationalMass1D,
    SensorNode,
)

from exudyn_models import add_energy_balance, add_radial_support, add_ring_friction, solve_dynamic

MOTOR_TORQUE, MOTOR_DROOP = 240.0, 2.4  # N m, N m s/rad; 100 rad/s without load
DRAG = 0.28  # N m s/rad, of the load
OFFSET = 1e-3  # m, from the axis of the flywheel to that of the shaft
VELOCITIES = exu.OutputVariableType.Coordinates_t

container = exu.SystemContainer()
mbs = container.AddSystem()

# Two bodies. Their nodes may be Node1D, NodeRigidBody2D, NodeRigidBodyRotVecLG or NodeRigidBodyRxyz.
flywheel = mbs.AddNode(Node1D(initialVelocities=[100.0]))
mbs.AddObject(ObjectRotationalMass1D(nodeNumber=flywheel, inertia=0.2))
disc = mbs.AddNode(NodeRigidBody2D(initialCoordinates=[OFFSET, 0.0, 0.0]))
mbs.AddObject(ObjectRigidBody2D(nodeNumber=disc, mass=0.6, inertia=0.01))

# Motor and load from Exudyn's own items.
ground = mbs.AddMarker(MarkerNodeCoordinate(nodeNumber=mbs.AddNode(NodePointGround()), coordinate=0))
motor = mbs.AddMarker(MarkerNodeCoordinate(nodeNumber=flywheel, coordinate=0))
load = mbs.AddMarker(MarkerNodeCoordinate(nodeNumber=disc, coordinate=2))
mbs.AddLoad(LoadCoordinate(markerNumber=motor, load=MOTOR_TORQUE))
mbs.AddObject(CoordinateSpringDamper(markerNumbers=[ground, motor], damping=MOTOR_DROOP))
mbs.AddObject(CoordinateSpringDamper(markerNumbers=[ground, load], damping=DRAG))

# The elastic shaft, and the friction between flywheel and disc.
shaft = add_radial_support(mbs, None, disc, stiffness=1e4, damping=20.0, offset=(OFFSET, 0.0))
clutch = add_ring_friction(
    mbs,
    flywheel,
    disc,
    contact_radius=0.1,
    friction_coefficient=0.3,
    normal_load=lambda time: 800.0 * min(1.0, time / 0.05),
    regularisation=1e-3,
)


def motor_power(mbs, t):
    """Return the power of the motor in W."""
    speed = mbs.GetNodeOutput(flywheel, VELOCITIES)
    return (MOTOR_TORQUE - MOTOR_DROOP * speed) * speed


def load_power(mbs, t):
    """Return the power of the load in W."""
    return DRAG * mbs.GetNodeOutput(disc, VELOCITIES)[2] ** 2


# The residual of the balance is the error of the run.
read_balance = add_energy_balance(
    mbs,
    gains={"motor": motor_power},
    losses={"load": load_power, "friction": clutch.power, "shaft": shaft.power},
    stored=[shaft.stored_energy],
)
sensors = [
    mbs.AddSensor(SensorNode(nodeNumber=node, outputVariableType=kind, storeInternal=True, writeToFile=False))
    for node, kind in (
        (flywheel, VELOCITIES),
        (disc, VELOCITIES),
        (disc, exu.OutputVariableType.Position),
    )
]
mbs.Assemble()

settings = exu.SimulationSettings()
settings.solution.file.write = False
settings.solution.sensors.writePeriod = 2e-3
options = settings.timeIntegration
options.verboseMode = 0
options.endTime, options.numberOfSteps, options.initialStepSize = 2.0, 400, 1e-6
options.absoluteTolerance, options.relativeTolerance = 1e-8, 0.0
solve_dynamic(mbs, settings, exu.DynamicSolverType.DOPRI5)  # mbs.SolveDynamic with additional checks

balance = read_balance()
flywheel_speed, disc_velocity, place = (mbs.GetSensorStoredData(sensor)[:, 1:] for sensor in sensors)


def draw(path):
    """Draw the path of the disc's centre, the speeds and the energy balance."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(12.0, 3.6), layout="constrained")
    way, speeds, heats = figure.subplots(1, 3)
    way.plot(*1e3 * place[:, :2].T, "tab:green")
    way.plot(0.0, 0.0, "k+", markersize=9, label="axis of the flywheel")
    way.plot(1e3 * OFFSET, 0.0, "kx", markersize=9, label="axis of the shaft, start")
    way.plot(*1e3 * place[-1, :2], "o", color="tab:green", label="end: self-centred")
    way.set(title="disc's centre", xlabel="x in mm", ylabel="y in mm", aspect="equal", ylim=(-0.15, 0.95))
    times = balance.times
    speeds.plot(times, flywheel_speed, label="flywheel")
    speeds.plot(times, disc_velocity[:, 2], label="disc")
    speeds.set(title="speeds", xlabel="t in s", ylabel="rad/s", xlim=(0.0, 0.4), ylim=(0.0, None))
    heats.stackplot(times, *balance.losses.values(), labels=balance.losses, alpha=0.5)
    given = balance.gains["motor"] - (balance.stored - balance.stored[0])
    heats.plot(times, given, "k--", label="motor minus stored")
    heats.set(title="energy balance", xlabel="t in s", ylabel="J", xlim=(0.0, 0.4), ylim=(0.0, 800.0))
    for panel, corner in ((way, "upper right"), (speeds, "lower right"), (heats, "upper left")):
        panel.legend(loc=corner, frameon=False)
    figure.savefig(path, dpi=80)


if __name__ == "__main__":
    print(f"the disc's centre is {1e3 * np.hypot(*place[-1, :2]):.4f} mm from the axis of the flywheel")
    print(f"the contact slips at {flywheel_speed[-1, 0] - disc_velocity[-1, 2]:.4f} rad/s")
    print(f"the balance accounts for the motor's {balance.gains['motor'][-1]:.1f} J", end=" ")
    print(f"to {np.max(np.abs(balance.residual)):.1g} J")
    if len(sys.argv) > 1:
        draw(sys.argv[1])
