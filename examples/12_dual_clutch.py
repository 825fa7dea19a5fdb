"""A dual clutch changes from the first to the second gear under load.

The first clutch opens while the second closes, both linearly. The second clutch then slows the engine down to the
speed of its shaft and locks. The gears are elastic. An energy balance checks the run.
"""

import sys

import exudyn as exu
import numpy as np
from exudyn.itemInterface import (
    LoadCoordinate,
    MarkerNodeCoordinate,
    Node1D,
    ObjectGenericODE2,
    ObjectRotationalMass1D,
    SensorNode,
)

from exudyn_models import add_energy_balance, add_ring_friction, solve_dynamic

ENGINE, SHAFTS, VEHICLE = 0.2, (0.02, 0.025), 150.0  # kg m², the vehicle reduced to its wheels
RATIOS = (13.0, 8.0)  # speed of a shaft divided by the speed of the wheels
STIFFNESS, DAMPING = 5000.0, 10.0  # N m/rad, N m s/rad, per gear
TORQUE, RESISTANCE = 150.0, 400.0  # N m, on the engine and against the wheels
RADIUS, FRICTION_COEFFICIENT, PLATES = 0.07, 0.12, 8  # m; wet clutches of 8 pairs of faces
LOAD = 4500.0  # N; a clutch then holds 302 N m, twice the engine's torque
BEGIN, END = 0.2, 0.5  # s, of the gear change
UNTIL = 0.9  # s
START = 200.0  # rad/s, initial speed of the engine
VELOCITIES = exu.OutputVariableType.Coordinates_t

container = exu.SystemContainer()
mbs = container.AddSystem()


def add_rotor(inertia, speed, angle=0.0):
    """Add a rotor and return its node."""
    node = mbs.AddNode(Node1D(initialCoordinates=[angle], initialVelocities=[speed]))
    mbs.AddObject(ObjectRotationalMass1D(nodeNumber=node, inertia=inertia))
    return node


def add_torque(node, torque):
    """Add a constant torque to a rotor."""
    marker = mbs.AddMarker(MarkerNodeCoordinate(nodeNumber=node, coordinate=0))
    mbs.AddLoad(LoadCoordinate(markerNumber=marker, load=torque))


def opening(time):
    """Return the load of the first clutch in N."""
    return LOAD * min(1.0, max(0.0, (END - time) / (END - BEGIN)))


def closing(time):
    """Return the load of the second clutch in N."""
    return LOAD - opening(time)


# The first shaft starts with the twist of steady acceleration, so that nothing oscillates.
behind = (SHAFTS[1] * RATIOS[1] ** 2 + VEHICLE) / RATIOS[0] ** 2
rate = (TORQUE - RESISTANCE / RATIOS[0]) / (ENGINE + SHAFTS[0] + behind)
twist = (behind * rate + RESISTANCE / RATIOS[0]) / STIFFNESS

engine = add_rotor(ENGINE, START)
shafts = [add_rotor(SHAFTS[0], START, twist), add_rotor(SHAFTS[1], START * RATIOS[1] / RATIOS[0])]
wheels = add_rotor(VEHICLE, START / RATIOS[0])
add_torque(engine, TORQUE)
add_torque(wheels, -RESISTANCE)

clutches, gears = [], []
for shaft, load, ratio in zip(shafts, (opening, closing), RATIOS, strict=True):
    twisting = (1.0, -ratio)  # twist = angle of the shaft − ratio·(angle of the wheels)
    wound = np.outer(twisting, twisting)
    mbs.AddObject(
        ObjectGenericODE2(
            nodeNumbers=[shaft, wheels],
            massMatrix=np.zeros((2, 2)),
            stiffnessMatrix=STIFFNESS * wound,
            dampingMatrix=DAMPING * wound,
        )
    )
    clutches.append(
        add_ring_friction(
            mbs,
            engine,
            shaft,
            contact_radius=RADIUS,
            friction_coefficient=FRICTION_COEFFICIENT,
            normal_load=load,
            plates=PLATES,
        )
    )


def speed(node):
    """Return the speed of a rotor in rad/s."""
    return float(mbs.GetNodeOutput(node, VELOCITIES))


def angle(node):
    """Return the angle of a rotor in rad."""
    return float(mbs.GetNodeOutput(node, exu.OutputVariableType.Coordinates))


def gear_power(mbs, t):
    """Return the power of the dampers of both gears in W."""
    rates = [speed(shaft) - ratio * speed(wheels) for shaft, ratio in zip(shafts, RATIOS, strict=True)]
    return DAMPING * float(np.dot(rates, rates))


def gear_energy(mbs):
    """Return the energy in the springs of both gears in J."""
    twists = [angle(shaft) - ratio * angle(wheels) for shaft, ratio in zip(shafts, RATIOS, strict=True)]
    return STIFFNESS * float(np.dot(twists, twists)) / 2.0


read_balance = add_energy_balance(
    mbs,
    gains={"engine": lambda mbs, t: TORQUE * speed(engine)},
    losses={
        "first clutch": clutches[0].power,
        "second clutch": clutches[1].power,
        "gears": gear_power,
        "resistance": lambda mbs, t: RESISTANCE * speed(wheels),
    },
    stored=[gear_energy],
)
sensors = [
    mbs.AddSensor(SensorNode(nodeNumber=node, outputVariableType=VELOCITIES, storeInternal=True))
    for node in (engine, *shafts, wheels)
]
mbs.Assemble()

settings = exu.SimulationSettings()
settings.solution.file.write = False
settings.solution.sensors.writePeriod = 2e-3
options = settings.timeIntegration
options.verboseMode = 0
options.endTime, options.numberOfSteps = UNTIL, 1800
changes = solve_dynamic(mbs, settings, exu.DynamicSolverType.TrapezoidalIndex2, breaks=[BEGIN, END])

balance = read_balance()
speeds = np.column_stack([mbs.GetSensorStoredData(sensor)[:, 1] for sensor in sensors])


def draw(path):
    """Draw the speeds and the heat of both clutches during the gear change."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(8.0, 3.2), layout="constrained")
    left, right = figure.subplots(1, 2)
    times = UNTIL * np.linspace(0.0, 1.0, len(speeds))
    for name, curve in zip(("engine", "first shaft", "second shaft"), speeds.T, strict=False):
        left.plot(times, curve, label=name)
    left.set(xlabel="t in s", ylabel="speed in rad/s")
    for name in ("first clutch", "second clutch"):
        right.plot(balance.times, balance.losses[name], label=name)
    right.set(xlabel="t in s", ylabel="heat in J")
    for panel in (left, right):
        panel.axvspan(BEGIN, END, color="0.93")
        panel.legend(fontsize="small")
    figure.savefig(path, dpi=80)


if __name__ == "__main__":
    print(f"engine {speeds[-1, 0]:.2f} rad/s, second gear {RATIOS[1] * speeds[-1, 3]:.2f} rad/s")
    for name in ("first clutch", "second clutch"):
        print(f"{name}: {balance.losses[name][-1]:.0f} J of heat")
    residual = np.max(np.abs(balance.residual)) / balance.turnover
    print(f"residual of the energy balance: {residual:.1g} of the energy turnover")
    if len(sys.argv) > 1:
        draw(sys.argv[1])
