"""Modelica's example CoupledClutches in Exudyn: four rotors and three clutches, which stick exactly.

The first rotor starts at 10 rad/s, and a sinusoidal torque acts on it. The first clutch opens, and the others engage
in steps. The comments give Modelica's names.
"""

import math
import sys

import exudyn as exu
import numpy as np
from exudyn.itemInterface import LoadCoordinate, MarkerNodeCoordinate, Node1D, ObjectRotationalMass1D

from exudyn_models import add_ring_friction, solve_dynamic

SPEEDS = (10.0, 0.0, 0.0, 0.0)  # rad/s
LOADS = (
    lambda time: 20.0 * max(0.0, math.cos(2.0 * math.pi * 0.2 * time)),  # N
    lambda time: 20.0 if time >= 0.4 else 0.0,
    lambda time: 20.0 if time >= 0.9 else 0.0,
)

container = exu.SystemContainer()  # must live as long as its models
mbs = container.AddSystem()
rotors = [mbs.AddNode(Node1D(initialVelocities=[speed])) for speed in SPEEDS]
for rotor in rotors:
    mbs.AddObject(ObjectRotationalMass1D(nodeNumber=rotor, inertia=1.0))  # kg m²
first = mbs.AddMarker(MarkerNodeCoordinate(nodeNumber=rotors[0], coordinate=0))
mbs.AddLoad(
    LoadCoordinate(
        markerNumber=first,
        load=10.0,  # N m
        loadUserFunction=lambda mbs, t, load: load * math.sin(2.0 * math.pi * 5.0 * t),
    )
)
clutches = [
    add_ring_friction(
        mbs,
        master,
        disc,
        contact_radius=1.0,  # cgeo in m
        friction_coefficient=0.5,  # mu_pos
        static_ratio=1.1,  # peak
        normal_load=load,
    )
    for master, disc, load in zip(rotors, rotors[1:], LOADS, strict=False)
]
modes = [clutch.add_sensor("mode") for clutch in clutches]
speeds = [
    mbs.AddSensor(
        exu.itemInterface.SensorNode(
            nodeNumber=rotor, outputVariableType=exu.OutputVariableType.Coordinates_t, storeInternal=True
        )
    )
    for rotor in rotors
]

settings = exu.SimulationSettings()
settings.solution.file.write = False
run = settings.timeIntegration
run.endTime, run.numberOfSteps, run.verboseMode = 1.5, 1500, 0
settings.solution.sensors.writePeriod = 2e-3
changes = solve_dynamic(mbs, settings, exu.DynamicSolverType.TrapezoidalIndex2)


def draw(path):
    """Draw the speeds of the rotors, and mark each change of a clutch."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(6.0, 3.2), layout="constrained")
    panel = figure.subplots()
    for number, sensor in enumerate(speeds, 1):
        times, speed = np.transpose(mbs.GetSensorStoredData(sensor))
        panel.plot(times, speed, label=f"rotor {number}")
    for change in changes:
        panel.axvline(change.time, color="0.85", zorder=0)
    panel.set(xlabel="t in s", ylabel="speed in rad/s", title="grey: a clutch sticks or releases")
    panel.legend(fontsize="small")
    figure.savefig(path, dpi=80)


if __name__ == "__main__":
    print("clutches stick or release at t =", ", ".join(f"{change.time:.4f}" for change in changes), "s")
    print(
        "final speeds:", ", ".join(f"{float(mbs.GetSensorValues(sensor)):.4f}" for sensor in speeds), "rad/s"
    )
    if len(sys.argv) > 1:
        draw(sys.argv[1])
