"""The exact motion, and the published one."""

from __future__ import annotations

import csv
import functools
import math
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from compare.studies.toolkit.torsional_chain import Chain, Harmonic, Motion
from reference_model.systems import FloatArray

# --- Modelica.Mechanics.Rotational.Examples.CoupledClutches, as its sources have it, and how finely it is run.

INERTIAS = (1.0, 1.0, 1.0, 1.0)
"""In kg m²."""

SPEED = 10.0
"""Of the first rotor at the start in rad/s; the others rest."""

TORQUE, FREQUENCY = 10.0, 5.0
"""Amplitude in N m and frequency in Hz of what acts on the first rotor."""

RADIUS, COEFFICIENT, STATIC_RATIO, LOAD = 1.0, 0.5, 1.1, 20.0
"""The clutches' cgeo in m, their coefficient of sliding friction, their peak, and the largest load in N."""

OPENS = 0.2
"""Frequency in Hz of the cosine by which the load of the first clutch falls, and is 0 from its first root on."""

OPEN_FROM = 0.25 / OPENS
ENGAGED_FROM = (0.4, 0.9)
"""In s, of the second and the third clutch, with the whole load at once."""

BREAKS = (*ENGAGED_FROM, OPEN_FROM)
UNTIL = 1.5
"""In s."""

SHOWN = np.array([0.05 * i for i in range(1, 30) if i != 20]).round(2)
"""When speeds are compared, in s: not at 1 s, 0.3 ms before a clutch lets go, but 5 ms from any event or more."""

EPSILONS = 2.5e-4 * np.array([1.0, 2.0, 4.0, 8.0])
"""In m/s, at the radius of 1 m: rad/s."""

TOLERANCE = 1e-9
"""Of explicit steps, in rad/s: a millionth of what the smallest ε changes."""

SMALL_EPSILON = 1e-5
"""In m/s, of implicit steps: it changes a tenth of what the shortest of ``STEPS`` does, or less."""

STEPS = 1.25e-4 * np.array([1.0, 2.0, 4.0, 8.0])
"""Of implicit runs, in s."""

ALL_SLIP_UNTIL = 0.7
"""In s: a time of ``SHOWN`` up to which all clutches that are closed slip."""

LETS_GO_FROM = 0.82
"""In s, after the second clutch holds and the first one does, and before that lets go."""

NUMERICAL_DAMPING = 0.8
"""The spectral radius of generalised-α: below 1, so that what a jump of friction excites dies away."""

BRISTLES = ((5e-5, 6.25e6), (1e-4, 1.5625e6), (2e-4, 3.90625e5))
"""Step in s and bristle stiffness in N m/rad of Exudyn's own connector: all errors double from one to the next.

The bristle's damping in N m s/rad is twice the root of its stiffness, the critical one of a rotor of 1 kg m².
"""

DECAY = 1e-4
"""In rad/s: over which slip static friction of that connector falls to the sliding one."""

PUBLISHED_TOLERANCE = 1e-6
"""Relative, with which the published result was integrated, by DASSL."""

ACCUMULATED = 10.0
"""By how much larger than the tolerance, which is that of a step, the error of the whole motion is taken to be."""


def first_load(time: float) -> float:
    """Return the load of the first clutch in N."""
    return LOAD * max(0.0, math.cos(2.0 * math.pi * OPENS * time)) if time < OPEN_FROM else 0.0


def second_load(time: float) -> float:
    """Return the load of the second clutch in N."""
    return LOAD if time >= ENGAGED_FROM[0] else 0.0


def third_load(time: float) -> float:
    """Return the load of the third clutch in N."""
    return LOAD if time >= ENGAGED_FROM[1] else 0.0


LOADS = (first_load, second_load, third_load)


def torque(time: float) -> float:
    """Return the torque on the first rotor in N m."""
    return TORQUE * math.sin(2.0 * math.pi * FREQUENCY * time)


PUBLISHED = Path(__file__).with_name("published.csv")

NOTHING = Harmonic()


def chain() -> Chain:
    """Return the rotors with their clutches."""
    capacity = RADIUS * COEFFICIENT * LOAD
    falling = Harmonic(capacity, 2.0 * math.pi * OPENS)
    drive = Harmonic(TORQUE, 2.0 * math.pi * FREQUENCY, 0.0)
    return Chain(
        INERTIAS,
        torques=[((0.0, drive),), *[((0.0, NOTHING),)] * 3],
        capacities=[
            ((0.0, falling), (OPEN_FROM, NOTHING)),
            *(((0.0, NOTHING), (begin, Harmonic(capacity))) for begin in ENGAGED_FROM),
        ],
        static_ratio=STATIC_RATIO,
    )


@functools.cache
def exact() -> Motion:
    """Return the exact motion."""
    return chain().motion([SPEED, 0.0, 0.0, 0.0], UNTIL)


@functools.cache
def switches() -> list[tuple[float, int, int]]:
    """Return time in s, clutch and new mode where a clutch begins to hold, or lets go, by friction alone."""
    found = [
        (time, clutch, mode)
        for clutch in range(len(INERTIAS) - 1)
        for time, mode in exact().switches(clutch)
        if time not in exact().chain.breaks
    ]
    return sorted(found)


@dataclass(frozen=True)
class Published:
    """The published times in s, speeds in rad/s and angles in rad of the first rotor and of each slip, and modes."""

    times: FloatArray
    speeds: FloatArray
    angles: FloatArray
    modes: NDArray[np.int_]


@functools.cache
def published() -> Published:
    """Return every tenth row of the published result, and those beside its events.

    Source: Modelica Association, MAP-LIB_ReferenceResults, Modelica.Mechanics.Rotational.Examples.CoupledClutches,
    Dymola 2020x, DASSL at a tolerance of 1e-6.
    """
    with PUBLISHED.open(newline="", encoding="utf-8") as file:
        rows = list(csv.DictReader(line for line in file if not line.startswith("#")))
    clutches = range(1, len(INERTIAS))

    def columns(*names: str) -> FloatArray:
        return np.array([[float(row[name]) for name in names] for row in rows])

    return Published(
        columns("time")[:, 0],
        columns("J1.w", *(f"clutch{i}.w_rel" for i in clutches)),
        columns("J1.phi", *(f"clutch{i}.phi_rel" for i in clutches)),
        columns(*(f"clutch{i}.mode" for i in clutches)).astype(int),
    )


def first_and_slips(values: FloatArray) -> FloatArray:
    """Return the first rotor's and the differences of neighbours from what each rotor has, both of shape (n, 4)."""
    return np.column_stack((values[:, 0], np.diff(values, axis=1)))


# --- The four rotors in Exudyn: with our contact, and with Exudyn's own connector with bristles.


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
