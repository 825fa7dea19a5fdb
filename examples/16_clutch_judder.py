"""Judder of a clutch whose friction falls with slip: a map of damping ratios and a run-up, both from one model.

The map linearises the model at many slips and shaft dampings. In the run-up the slip falls, so the clutch crosses the
limit of stability, judders and locks. Pass a path to save a figure.
"""

import sys

import exudyn as exu
import numpy as np
from exudyn.itemInterface import (
    MarkerNodeCoordinate,
    Node1D,
    ObjectConnectorCoordinateSpringDamper,
    ObjectRotationalMass1D,
    SensorNode,
)

from exudyn_models import add_ring_friction, add_torque, linearise, solve_dynamic

ENGINE, DISC, CAR = 0.3, 0.02, 10.0  # kg m², reduced to the clutch
STIFFNESS = 150.0  # N m/rad of the shaft between disc and car
RADIUS, LOAD = 0.1, 3000.0  # m, N
TORQUE, SPEED, GOVERNOR = 90.0, 20.0, 20.0  # N m and rad/s of the engine, N m s/rad of its governor
SLIPS, DAMPINGS = np.linspace(0.5, 30.0, 40), np.linspace(0.0, 3.0, 16)  # rad/s, N m s/rad
DAMPING = 0.4  # of the run-up
UNTIL, STEP = 2.5, 5e-4  # s


def coefficient(slip_speed):
    """Return the friction coefficient at a slip speed in m/s."""
    return 0.3 + 0.05 * np.exp(-slip_speed / 0.6)


def clutch_model(slip, damping, car=0.0):
    """Return container, model and nodes; disc and car start at one speed and with the moment of the clutch."""
    container = exu.SystemContainer()
    mbs = container.AddSystem()
    moment = RADIUS * LOAD * float(coefficient(RADIUS * slip))
    starts = {
        "engine": (ENGINE, 0.0, car + slip),
        "disc": (DISC, moment / STIFFNESS, car),
        "car": (CAR, 0.0, car),
    }
    nodes = {}
    for name, (inertia, angle, speed) in starts.items():
        nodes[name] = mbs.AddNode(Node1D(initialCoordinates=[angle], initialVelocities=[speed]))
        mbs.AddObject(ObjectRotationalMass1D(nodeNumber=nodes[name], inertia=inertia))
    ends = [
        mbs.AddMarker(MarkerNodeCoordinate(nodeNumber=nodes[name], coordinate=0)) for name in ("car", "disc")
    ]
    mbs.AddObject(
        ObjectConnectorCoordinateSpringDamper(markerNumbers=ends, stiffness=STIFFNESS, damping=damping)
    )
    add_torque(mbs, nodes["engine"], lambda time, angle, speed: TORQUE + GOVERNOR * (SPEED - speed))
    add_ring_friction(
        mbs,
        nodes["engine"],
        nodes["disc"],
        contact_radius=RADIUS,
        friction_coefficient=coefficient,
        normal_load=LOAD,
    )
    return container, mbs, nodes


def damping_ratio(slip, damping):
    """Return the least damping ratio of a vibration; it is negative if the clutch judders."""
    _container, mbs, _ = clutch_model(slip, damping)
    state = linearise(mbs)
    return np.min(state.damping_ratios[np.abs(state.eigenvalues.imag) > 1.0])


def run_up():
    """Return the times in s, the speeds of engine, disc and car in rad/s, and the changes of mode."""
    _container, mbs, nodes = clutch_model(SPEED, DAMPING)
    rates = exu.OutputVariableType.Coordinates_t
    sensors = [
        mbs.AddSensor(
            SensorNode(nodeNumber=node, outputVariableType=rates, storeInternal=True, writeToFile=False)
        )
        for node in nodes.values()
    ]
    settings = exu.SimulationSettings()
    settings.solution.file.write = False
    settings.solution.sensors.writePeriod = STEP
    run = settings.timeIntegration
    run.endTime, run.numberOfSteps, run.verboseMode = UNTIL, round(UNTIL / STEP), 0
    changes = solve_dynamic(mbs, settings, exu.DynamicSolverType.TrapezoidalIndex2)
    stored = [mbs.GetSensorStoredData(sensor) for sensor in sensors]
    return stored[0][:, 0], np.array([values[:, 1] for values in stored]), changes


ratios = np.array([[damping_ratio(slip, damping) for slip in SLIPS] for damping in DAMPINGS])
times, speeds, changes = run_up()


def draw(path):
    """Draw the map and the run-up."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(8.0, 3.6), layout="constrained")
    left, right = figure.subplots(1, 2)
    filled = left.contourf(
        SLIPS, DAMPINGS, ratios, levels=np.linspace(-0.8, 0.8, 17), cmap="RdBu", extend="both"
    )
    figure.colorbar(filled, label="damping ratio")
    left.contour(SLIPS, DAMPINGS, ratios, levels=[0.0], colors="k")
    left.axhline(DAMPING, color="k", linestyle=":")
    left.set(xlabel="slip in rad/s", ylabel="damping of the shaft in N m s/rad")
    for name, speed in zip(("engine", "disc", "car"), speeds, strict=True):
        right.plot(times, speed, label=name, linewidth=1)
    right.set(xlabel="t in s", ylabel="speed in rad/s")
    right.legend(frameon=False)
    figure.savefig(path, dpi=80)


if __name__ == "__main__":
    row = ratios[np.searchsorted(DAMPINGS, DAMPING)]
    limit = np.interp(0.0, row, SLIPS)
    print(f"with {DAMPING:g} N m s/rad the clutch judders below a slip of {limit:.1f} rad/s")
    print(f"the run-up sticks first after {changes[0].time:.3f} s and {len(changes)} changes of mode")
    if len(sys.argv) > 1:
        draw(sys.argv[1])
