"""The disc on its shaft in Exudyn."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from compare.studies.drivetrain.judder.parameters import (
    COEFFICIENT,
    DAMPING,
    DRIVE_INERTIA,
    EPSILON,
    INERTIA,
    LOAD,
    PERTURBED,
    RADIUS,
    SPEED,
    STEADY_SLIP,
    STIFFNESS,
    TOLERANCE,
)
from compare.studies.drivetrain.judder.theory import MOMENT
from reference_model.systems import FloatArray


class Judder:
    """The model: the coefficient of friction falls by ``gradient`` in s/m, the disc starts at ``pushed`` in rad/s."""

    def __init__(self, gradient: float, pushed: float = PERTURBED) -> None:
        import exudyn as exu
        import exudyn.itemInterface

        from exudyn_models import add_ring_friction

        items: Any = exudyn.itemInterface
        self.container = exu.SystemContainer()  # lives as long as its model
        mbs: Any = self.container.AddSystem()
        drive = mbs.AddNode(items.Node1D(initialVelocities=[SPEED]))
        mbs.AddObject(items.ObjectRotationalMass1D(nodeNumber=drive, inertia=DRIVE_INERTIA))
        wound = MOMENT / STIFFNESS
        disc = mbs.AddNode(items.Node1D(initialCoordinates=[wound], initialVelocities=[pushed]))
        mbs.AddObject(items.ObjectRotationalMass1D(nodeNumber=disc, inertia=INERTIA))
        ground = mbs.AddNode(items.NodePointGround())
        markers = [
            mbs.AddMarker(items.MarkerNodeCoordinate(nodeNumber=node, coordinate=0))
            for node in (ground, disc)
        ]
        shaft = items.ObjectConnectorCoordinateSpringDamper(
            markerNumbers=markers, stiffness=STIFFNESS, damping=DAMPING
        )
        mbs.AddObject(shaft)
        add_ring_friction(
            mbs,
            drive,
            disc,
            contact_radius=RADIUS,
            friction_coefficient=lambda slip_speed: COEFFICIENT - gradient * (slip_speed - STEADY_SLIP),
            normal_load=LOAD,
            regularisation=EPSILON,
        )
        types = (exu.OutputVariableType.Coordinates, exu.OutputVariableType.Coordinates_t)
        self.sensors = [
            mbs.AddSensor(items.SensorNode(nodeNumber=disc, storeInternal=True, outputVariableType=kind))
            for kind in types
        ]
        mbs.Assemble()
        self.mbs = mbs

    def eigenvalue(self) -> complex:
        """Return Exudyn's eigenvalue of the disc with the positive imaginary part, in 1/s."""
        found, _ = self.mbs.ComputeODE2Eigenvalues(computeComplexEigenvalues=True, useAbsoluteValues=False)
        return complex(max(np.asarray(found), key=lambda value: value.imag))

    def run(self, until: float, breaks: Sequence[float] = (), tolerance: float = TOLERANCE) -> FloatArray:
        """Return time in s, the disc's angle in rad and speed in rad/s after each step, shape (n, 3).

        The run ends, and goes on, at the ``breaks``, so that these times are among them.
        """
        import exudyn as exu

        from exudyn_models import solve_dynamic
        from exudyn_models.solver.solver_run import quiet

        settings = exu.SimulationSettings()
        settings.solution.file.write = False
        settings.solution.sensors.writePeriod = 0.0  # every step
        run = settings.timeIntegration
        run.endTime, run.numberOfSteps, run.verboseMode = until, max(round(until / 1e-3), 1), 0
        run.absoluteTolerance, run.relativeTolerance = tolerance, 0.0
        with quiet():
            solve_dynamic(self.mbs, settings, exu.DynamicSolverType.DOPRI5, breaks=breaks)
        angle, speed = (self.mbs.GetSensorStoredData(sensor) for sensor in self.sensors)
        return np.column_stack((angle, speed[:, 1]))
