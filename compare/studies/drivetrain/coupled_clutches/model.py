"""The four rotors in Exudyn: with our contact, and with Exudyn's own connector with bristles."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from compare.studies.drivetrain.coupled_clutches.parameters import (
    BREAKS,
    COEFFICIENT,
    DECAY,
    ENGAGED_FROM,
    INERTIAS,
    LOAD,
    LOADS,
    NUMERICAL_DAMPING,
    OPEN_FROM,
    RADIUS,
    SHOWN,
    SPEED,
    STATIC_RATIO,
    TOLERANCE,
    UNTIL,
    first_load,
    torque,
)
from reference_model.systems import FloatArray


@dataclass(frozen=True)
class Run:
    """Speeds of the rotors in rad/s, shape (n, 4), after each step, at ``times`` in s."""

    times: FloatArray
    speeds: FloatArray

    def at(self, times: FloatArray) -> FloatArray:
        """Return the speeds at other times, of which a run from break to break has those of the breaks twice."""
        return np.column_stack([np.interp(times, self.times, speed) for speed in self.speeds.T])

    @property
    def slips(self) -> FloatArray:
        """Of the clutches in rad/s, shape (n, 3)."""
        return np.diff(self.speeds, axis=1)


class _Rotors:
    """The rotors, the torque on the first one, and a sensor of each speed."""

    def __init__(self) -> None:
        import exudyn as exu
        import exudyn.itemInterface

        items: Any = exudyn.itemInterface
        self.container = exu.SystemContainer()  # lives as long as its model
        self.mbs: Any = self.container.AddSystem()
        self.nodes, self.markers, self.sensors = [], [], []
        for inertia, speed in zip(INERTIAS, (SPEED, 0.0, 0.0, 0.0), strict=True):
            node = self.mbs.AddNode(items.Node1D(initialVelocities=[speed]))
            self.mbs.AddObject(items.ObjectRotationalMass1D(nodeNumber=node, inertia=inertia))
            self.nodes.append(node)
            self.markers.append(self.mbs.AddMarker(items.MarkerNodeCoordinate(nodeNumber=node, coordinate=0)))
            of_speed = exu.OutputVariableType.Coordinates_t
            self.sensors.append(
                self.mbs.AddSensor(
                    items.SensorNode(nodeNumber=node, storeInternal=True, outputVariableType=of_speed)
                )
            )
        drive = items.LoadCoordinate(
            markerNumber=self.markers[0], load=1.0, loadUserFunction=lambda mbs, t, load: torque(t)
        )
        self.mbs.AddLoad(drive)

    def settings(self, step: float, begin: float = 0.0, end: float = UNTIL) -> Any:
        """Return the settings of a run with steps of ``step`` in s."""
        import exudyn as exu

        settings = exu.SimulationSettings()
        settings.solution.file.write = False
        settings.solution.sensors.writePeriod = 0.0  # every step
        run = settings.timeIntegration
        run.startTime, run.endTime, run.numberOfSteps, run.verboseMode = (
            begin,
            end,
            round((end - begin) / step),
            0,
        )
        run.generalizedAlpha.spectralRadius = NUMERICAL_DAMPING
        return settings

    def recorded(self) -> FloatArray:
        """Return times and speeds of the last run, shape (n, 5)."""
        data = [self.mbs.GetSensorStoredData(sensor) for sensor in self.sensors]
        return np.column_stack((data[0], *(of_one[:, 1] for of_one in data[1:])))


def with_our_contact(epsilon: float, step: float | None = None, *, until: float = UNTIL) -> Run:
    """Return the run to ``until`` in s with ``add_ring_friction`` at ε in m/s, explicit or by steps of ``step`` in s.

    Such steps are implicit. It ends, and goes on, at the times of ``SHOWN`` too: speeds there are the run's own, and
    not interpolated.
    """
    import exudyn as exu

    from exudyn_models import add_ring_friction, solve_dynamic
    from exudyn_models.solver.solver_run import quiet

    rotors = _Rotors()
    for *pair, load in zip(rotors.nodes, rotors.nodes[1:], LOADS, strict=False):
        add_ring_friction(
            rotors.mbs,
            *pair,
            contact_radius=RADIUS,
            friction_coefficient=COEFFICIENT,
            normal_load=load,
            static_ratio=STATIC_RATIO,
            regularisation=epsilon,
        )
    settings = rotors.settings(step or 1e-3, end=until)
    settings.timeIntegration.absoluteTolerance, settings.timeIntegration.relativeTolerance = TOLERANCE, 0.0
    solver = exu.DynamicSolverType.GeneralizedAlpha if step else exu.DynamicSolverType.DOPRI5
    breaks = sorted(time for time in {*BREAKS, *SHOWN.tolist()} if time < until)
    with quiet():
        solve_dynamic(rotors.mbs, settings, solver, breaks=breaks)
    found = rotors.recorded()
    return Run(found[:, 0], found[:, 1:])


def with_bristles(step: float, stiffness: float) -> Run:
    """Return the run with Exudyn's own connector, of bristle ``stiffness`` in N m/rad, by steps of ``step`` in s.

    It has no load: its torques are set before each step, which leaves slip of second order in the step. A clutch
    without load is switched off, since its bristle would go on to hold on to where it stuck last.
    """
    import exudyn as exu
    import exudyn.itemInterface

    from exudyn_models import solve_dynamic
    from exudyn_models.solver.solver_run import quiet

    items: Any = exudyn.itemInterface
    rotors = _Rotors()
    mbs, sliding = rotors.mbs, COEFFICIENT * RADIUS
    clutches = []
    for *markers, begins in zip(rotors.markers, rotors.markers[1:], (0.0, *ENGAGED_FROM), strict=False):
        slipping = [-sliding * LOAD, 0.0, 0.0]  # backward
        connector = items.ObjectConnectorCoordinateSpringDamperExt(
            markerNumbers=markers,
            nodeNumber=mbs.AddNode(
                items.NodeGenericData(initialCoordinates=slipping, numberOfDataCoordinates=3)
            ),
            stickingStiffness=stiffness,
            stickingDamping=2.0 * math.sqrt(stiffness),
            exponentialDecayStatic=DECAY,
            dynamicFrictionForce=sliding * LOAD,
            staticFrictionOffsetForce=(STATIC_RATIO - 1.0) * sliding * LOAD,
            activeConnector=begins == 0.0,
        )
        clutches.append(mbs.AddObject(connector))

    def press(mbs: Any, time: float) -> bool:
        capacity = sliding * first_load(time)
        mbs.SetObjectParameter(clutches[0], "dynamicFrictionForce", capacity)
        mbs.SetObjectParameter(clutches[0], "staticFrictionOffsetForce", (STATIC_RATIO - 1.0) * capacity)
        return True

    mbs.SetPreStepUserFunction(press)
    mbs.Assemble()
    at_begin = {begin: (clutch, True) for begin, clutch in zip(ENGAGED_FROM, clutches[1:], strict=True)}
    at_begin[OPEN_FROM] = clutches[0], False
    found = []
    for begin, end in zip((0.0, *BREAKS), (*BREAKS, UNTIL), strict=True):
        if begin in at_begin:
            clutch, closed = at_begin[begin]
            mbs.SetObjectParameter(clutch, "activeConnector", closed)
        settings = rotors.settings(step, begin, end)
        with quiet():
            solve_dynamic(mbs, settings, exu.DynamicSolverType.GeneralizedAlpha, updateInitialValues=True)
        found.append(rotors.recorded())
    together = np.vstack(found)
    return Run(together[:, 0], together[:, 1:])
