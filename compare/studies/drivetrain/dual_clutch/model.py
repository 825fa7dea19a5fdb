"""The gear change in Exudyn, from parts."""

from __future__ import annotations

from typing import Any

import numpy as np

from compare.studies.drivetrain.dual_clutch.parameters import (
    COEFFICIENT,
    DAMPING,
    ENGINE,
    EPSILON,
    HAND_OVER,
    PLATES,
    RADIUS,
    RATIOS,
    RESISTANCE,
    SHAFTS,
    STIFFNESS,
    TIMES,
    TORQUE,
    UNTIL,
    VEHICLE,
    closing,
    opening,
    speeds,
    wind_up,
)
from reference_model.systems import FloatArray


def run(tolerance: float) -> FloatArray:
    """Return speeds of engine, shafts and wheels in rad/s, and heat of both clutches in J, at ``TIMES``: (n, 6)."""
    import exudyn as exu
    import exudyn.itemInterface

    from exudyn_models import add_ring_friction, solve_dynamic

    items: Any = exudyn.itemInterface
    container = exu.SystemContainer()
    mbs: Any = container.AddSystem()
    nodes = []
    for inertia, speed, angle in zip(
        (ENGINE, *SHAFTS, VEHICLE), speeds(), (0.0, wind_up(), 0.0, 0.0), strict=True
    ):
        nodes.append(mbs.AddNode(items.Node1D(initialVelocities=[speed], initialCoordinates=[angle])))
        mbs.AddObject(items.ObjectRotationalMass1D(nodeNumber=nodes[-1], inertia=inertia))
    engine, *shafts, wheels = nodes
    for node, torque in ((engine, TORQUE), (wheels, -RESISTANCE)):
        marker = mbs.AddMarker(items.MarkerNodeCoordinate(nodeNumber=node, coordinate=0))
        mbs.AddLoad(items.LoadCoordinate(markerNumber=marker, load=torque))
    heats = []
    for shaft, load, ratio in zip(shafts, (opening, closing), RATIOS, strict=True):
        twist = np.array([1.0, -ratio])
        gear = items.ObjectGenericODE2(
            nodeNumbers=[shaft, wheels],
            massMatrix=np.zeros((2, 2)),
            stiffnessMatrix=STIFFNESS * np.outer(twist, twist),
            dampingMatrix=DAMPING * np.outer(twist, twist),
        )
        mbs.AddObject(gear)
        clutch = add_ring_friction(
            mbs,
            engine,
            shaft,
            contact_radius=RADIUS,
            friction_coefficient=COEFFICIENT,
            normal_load=load,
            plates=PLATES,
            regularisation=EPSILON,
        )
        heats.append(clutch.add_sensor("heat", storeInternal=True))
    of_speed = exu.OutputVariableType.Coordinates_t
    sensors = [
        mbs.AddSensor(items.SensorNode(nodeNumber=node, storeInternal=True, outputVariableType=of_speed))
        for node in nodes
    ]
    settings = exu.SimulationSettings()
    settings.solution.file.write = False
    settings.solution.sensors.writePeriod = 0.0  # every step
    numerical = settings.timeIntegration
    numerical.endTime, numerical.numberOfSteps, numerical.verboseMode = UNTIL, 1125, 0
    numerical.absoluteTolerance, numerical.relativeTolerance = tolerance, 0.0
    breaks = sorted({*HAND_OVER, *TIMES[:-1].tolist()})
    solve_dynamic(mbs, settings, exu.DynamicSolverType.DOPRI5, breaks=breaks)
    stored = [mbs.GetSensorStoredData(sensor) for sensor in (*sensors, *heats)]
    rows = np.searchsorted(stored[0][:, 0], TIMES - 1e-12)
    return np.column_stack([values[rows, 1] for values in stored])
