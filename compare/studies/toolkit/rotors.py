"""Rotors about one axis in Exudyn, with a sensor on each speed."""

from collections.abc import Sequence
from typing import Any

import numpy as np

from reference_model.systems import FloatArray

NUMERICAL_DAMPING = 0.8
"""Spectral radius of generalised-α, below 1 to damp vibrations that a jump of friction excites."""


class Rotors:
    """Rotors with inertias (kg m²), initial speeds (rad/s) and the initial angle (rad) of the last rotor."""

    def __init__(self, inertias: Sequence[float], speeds: Sequence[float], last_angle: float = 0.0) -> None:
        import exudyn as exu  # deferred: the command line must start without it
        import exudyn.itemInterface

        self.items: Any = exudyn.itemInterface  # its type hints do not fit its calls
        self.container = exu.SystemContainer()  # must live as long as its model
        self.mbs: Any = self.container.AddSystem()
        self.nodes, self.sensors = [], []
        self.changes: list[Any] = []  # modes of contacts that stick exactly, in the last run
        angles = [last_angle if i == len(inertias) - 1 else 0.0 for i in range(len(inertias))]
        for inertia, speed, angle in zip(inertias, speeds, angles, strict=True):
            node = self.mbs.AddNode(self.items.Node1D(initialCoordinates=[angle], initialVelocities=[speed]))
            self.mbs.AddObject(self.items.ObjectRotationalMass1D(nodeNumber=node, inertia=inertia))
            self.sensors.append(self.sensor(node, exu.OutputVariableType.Coordinates_t))
            self.nodes.append(node)

    def sensor(self, node: Any, variable: Any) -> Any:
        """Return a new sensor of a node, which stores its values."""
        sensor = self.items.SensorNode(nodeNumber=node, storeInternal=True, outputVariableType=variable)
        return self.mbs.AddSensor(sensor)

    def marker(self, node: Any) -> Any:
        """Return a new marker on a node's angle."""
        return self.mbs.AddMarker(self.items.MarkerNodeCoordinate(nodeNumber=node, coordinate=0))

    def run(
        self,
        end: float,
        steps: int,
        *,
        begin: float = 0.0,
        solver: str = "DOPRI5",
        tolerance: float = 1e-8,
        breaks: Sequence[float] = (),
        newton: float | None = None,
    ) -> FloatArray:
        """Continue the motion; return times (s) and the sensor values after each step, one column each.

        The times contain the ``breaks``. All ``steps`` have equal size; DOPRI5 subdivides them for a local error of
        ``tolerance``. ``newton`` is the tolerance of implicit solvers, by default Exudyn's.
        """
        import exudyn as exu

        from exudyn_models import solve_dynamic
        from exudyn_models.solver.solver_run import quiet

        settings = exu.SimulationSettings()
        settings.solution.file.write = False
        settings.solution.sensors.writePeriod = 0.0  # every step
        options = settings.timeIntegration
        options.startTime, options.endTime, options.numberOfSteps, options.verboseMode = begin, end, steps, 0
        options.absoluteTolerance, options.relativeTolerance = tolerance, 0.0
        options.generalizedAlpha.spectralRadius = NUMERICAL_DAMPING
        if newton is not None:
            options.newton.absoluteTolerance = options.newton.relativeTolerance = newton
        kind = getattr(exu.DynamicSolverType, solver)
        with quiet():
            self.changes = solve_dynamic(self.mbs, settings, kind, updateInitialValues=True, breaks=breaks)
        stored = [self.mbs.GetSensorStoredData(sensor) for sensor in self.sensors]
        return np.column_stack((stored[0][:, 0], *(values[:, 1:] for values in stored)))
