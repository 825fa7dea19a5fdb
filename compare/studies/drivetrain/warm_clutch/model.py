"""The clutch with its thermal node in Exudyn."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from compare.studies.drivetrain.warm_clutch.parameters import (
    CAPACITY,
    COEFFICIENT,
    EPSILON,
    FADE,
    LOAD,
    RADIUS,
    SURROUNDINGS,
)
from reference_model.systems import FloatArray


@dataclass(frozen=True, eq=False)
class Run:
    """Times in s, the speeds of both rotors in rad/s, temperature in °C, heat in J that was lost.

    ``speeds`` has the shape (n, 2), the others (n,).
    """

    times: FloatArray
    speeds: FloatArray
    temperature: FloatArray
    lost: FloatArray

    @property
    def slip(self) -> FloatArray:
        """Of the first rotor over the second in rad/s."""
        return self.speeds[:, 0] - self.speeds[:, 1]

    def at(self, times: FloatArray) -> Run:
        """Return what there is at ``times``, which are among those of the run."""
        rows = np.searchsorted(self.times, times - 1e-9)  # a run ends a little before each
        return Run(times, self.speeds[rows], self.temperature[rows], self.lost[rows])


def fading(temperature: float) -> float:
    """Return the coefficient of friction at a temperature in °C."""
    return COEFFICIENT * (1.0 - FADE * (temperature - SURROUNDINGS))


def run(
    inertias: tuple[float, float], slip: float, conductance: float, times: FloatArray, tolerance: float
) -> Run:
    """Return the motion of two rotors with a clutch between them until the last of ``times``, and at each."""
    import exudyn as exu
    import exudyn.itemInterface

    from exudyn_models import add_ring_friction, add_thermal_node, solve_dynamic
    from exudyn_models.solver.solver_run import quiet

    items: Any = exudyn.itemInterface
    container = exu.SystemContainer()
    mbs: Any = container.AddSystem()
    nodes = [mbs.AddNode(items.Node1D(initialVelocities=[speed])) for speed in (slip, 0.0)]
    for node, inertia in zip(nodes, inertias, strict=True):
        mbs.AddObject(items.ObjectRotationalMass1D(nodeNumber=node, inertia=inertia))
    lining = add_thermal_node(mbs, heat_capacity=CAPACITY, conductance=conductance, surroundings=SURROUNDINGS)
    add_ring_friction(
        mbs,
        *nodes,
        contact_radius=RADIUS,
        friction_coefficient=fading,
        normal_load=LOAD,
        regularisation=EPSILON,
        thermal_node=lining,
    )
    of_speed = exu.OutputVariableType.Coordinates_t
    sensors = [
        mbs.AddSensor(items.SensorNode(nodeNumber=node, storeInternal=True, outputVariableType=of_speed))
        for node in nodes
    ]
    sensors.append(lining.add_sensor())
    settings = exu.SimulationSettings()
    settings.solution.file.write = False
    settings.solution.sensors.writePeriod = 0.0  # every step
    until = float(times[-1])
    numerical = settings.timeIntegration
    numerical.endTime, numerical.numberOfSteps, numerical.verboseMode = until, 100, 0
    numerical.absoluteTolerance, numerical.relativeTolerance = tolerance, 0.0
    with quiet():
        solve_dynamic(mbs, settings, exu.DynamicSolverType.DOPRI5, breaks=times[:-1].tolist())
    first, second, thermal = (mbs.GetSensorStoredData(sensor) for sensor in sensors)
    return Run(first[:, 0], np.column_stack((first[:, 1], second[:, 1])), thermal[:, 1], thermal[:, 2])
