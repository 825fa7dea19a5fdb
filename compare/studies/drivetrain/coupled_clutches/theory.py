"""The exact and the published motion, and the rotors in Exudyn."""

import csv
import functools
import math
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from compare.studies.toolkit.rotors import Rotors
from compare.studies.toolkit.torsional_chain import Chain, Harmonic, Motion
from reference_model.systems import FloatArray

INERTIAS, SPEED = (1.0, 1.0, 1.0, 1.0), 10.0
"""Inertias in kg m², and initial speed of the first rotor in rad/s; the others rest."""

TORQUE, FREQUENCY = 10.0, 5.0
"""Amplitude in N m and frequency in Hz of the torque on the first rotor."""

RADIUS, COEFFICIENT, STATIC_RATIO, LOAD = 1.0, 0.5, 1.1, 20.0
"""Modelica's cgeo in m, coefficient of sliding friction, peak ratio, and largest load of a clutch in N."""

OPENS = 0.2
"""Frequency in Hz of the cosine that unloads the first clutch; the load stays 0 after its first root."""

OPEN_FROM, ENGAGED_FROM, UNTIL = 0.25 / OPENS, (0.4, 0.9), 1.5
"""Times in s when the first clutch opens, and the second and third receive the whole load; duration in s."""

BREAKS = (*ENGAGED_FROM, OPEN_FROM)

SHOWN = np.array([0.05 * i for i in range(1, 30) if i != 20]).round(2)
"""Times in s, at least 5 ms from any event; a clutch releases 0.3 ms after 1 s."""

EPSILONS, TOLERANCE = 2.5e-4 * np.array([1.0, 2.0, 4.0, 8.0]), 1e-9
"""Explicit steps: ε in m/s, which equals rad/s at the radius of 1 m, and a tolerance of a millionth of its effect."""

STEPS, SMALL_EPSILON = 1.25e-4 * np.array([1.0, 2.0, 4.0, 8.0]), 1e-5
"""Implicit steps in s, and their ε in m/s, whose effect is at most a tenth of the effect of the shortest step."""

ALL_SLIP_UNTIL, LETS_GO_FROM = 0.7, 0.82
"""Times in s: all closed clutches slip until the first, one of ``SHOWN``; the first release is after the second."""

BRISTLES = ((5e-5, 6.25e6), (1e-4, 1.5625e6), (2e-4, 3.90625e5))
"""Step in s and bristle stiffness in N m/rad of Exudyn's own connector; errors double from row to row.

The bristle's damping in N m s/rad is twice the root of its stiffness, critical for a rotor of 1 kg m².
"""

DECAY = 1e-4
"""Range of slip in rad/s where that connector's friction falls from its static to its sliding value."""

PUBLISHED_TOLERANCE, ACCUMULATED = 1e-6, 10.0
"""Relative tolerance of DASSL in the published result, and assumed ratio of the motion's error to this tolerance."""


def first_load(time: float) -> float:
    return LOAD * max(0.0, math.cos(2.0 * math.pi * OPENS * time)) if time < OPEN_FROM else 0.0


def _engaged_from(begin: float) -> Callable[[float], float]:
    return lambda time: LOAD if time >= begin else 0.0


LOADS = (first_load, *map(_engaged_from, ENGAGED_FROM))
"""Loads in N."""


def torque(time: float) -> float:
    return TORQUE * math.sin(2.0 * math.pi * FREQUENCY * time)


PUBLISHED = Path(__file__).with_name("published.csv")

NOTHING = Harmonic()


def chain() -> Chain:
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
    return chain().motion([SPEED, 0.0, 0.0, 0.0], UNTIL)


@functools.cache
def switches() -> list[tuple[float, int, int]]:
    """Return time (s), clutch number and new mode of each event that friction alone causes."""
    return sorted(
        (time, clutch, mode)
        for clutch in range(len(INERTIAS) - 1)
        for time, mode in exact().switches(clutch)
        if time not in exact().chain.breaks
    )


@dataclass(frozen=True)
class Published:
    """Published times (s), modes, and speeds (rad/s) and angles (rad) of the first rotor and of each slip."""

    times: FloatArray
    speeds: FloatArray
    angles: FloatArray
    modes: NDArray[np.int_]


@functools.cache
def published() -> Published:
    """Return every tenth row of the published result, and the rows next to its events.

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
    """Return values of the first rotor and differences between neighbours, shape (n, 4)."""
    return np.column_stack((values[:, 0], np.diff(values, axis=1)))


# --- Exudyn with our contact, and with its own bristle connector


@dataclass(frozen=True)
class Run:
    """Speeds of the rotors (rad/s), shape (n, 4), at the ``times`` (s) of all steps."""

    times: FloatArray
    speeds: FloatArray

    def at(self, times: FloatArray) -> FloatArray:
        """Return interpolated speeds. The run contains each break twice."""
        return np.column_stack([np.interp(times, self.times, speed) for speed in self.speeds.T])

    @property
    def slips(self) -> FloatArray:
        """Slips of the clutches (rad/s), shape (n, 3)."""
        return np.diff(self.speeds, axis=1)


def _rotors() -> Rotors:
    rotors = Rotors(INERTIAS, (SPEED, 0.0, 0.0, 0.0))
    drive = rotors.items.LoadCoordinate(
        markerNumber=rotors.marker(rotors.nodes[0]), load=1.0, loadUserFunction=lambda mbs, t, load: torque(t)
    )
    rotors.mbs.AddLoad(drive)
    return rotors


def with_our_contact(epsilon: float, step: float | None = None, *, until: float = UNTIL) -> Run:
    """Return the run to ``until`` (s) with ``add_ring_friction`` at ε (m/s); it has a break at each of ``SHOWN``.

    The solver is implicit with a ``step`` (s), otherwise explicit.
    """
    from exudyn_models import add_ring_friction

    rotors = _rotors()
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
    found = rotors.run(
        until,
        round(until / (step or 1e-3)),
        solver="GeneralizedAlpha" if step else "DOPRI5",
        tolerance=TOLERANCE,
        breaks=sorted(time for time in {*BREAKS, *SHOWN.tolist()} if time < until),
    )
    return Run(found[:, 0], found[:, 1:])


def with_bristles(step: float, stiffness: float) -> Run:
    """Return the run with Exudyn's own connector, for a bristle ``stiffness`` (N m/rad) and a ``step`` (s).

    The connector has no input for the load, so a function sets its torques before each step, an error of second
    order. Without load the clutch is switched off, because its bristle would hold on.
    """
    rotors = _rotors()
    mbs, items, sliding = rotors.mbs, rotors.items, COEFFICIENT * RADIUS
    backward = items.NodeGenericData(
        initialCoordinates=[-sliding * LOAD, 0.0, 0.0], numberOfDataCoordinates=3
    )
    clutches = []
    for *pair, begins in zip(rotors.nodes, rotors.nodes[1:], (0.0, *ENGAGED_FROM), strict=False):
        connector = items.ObjectConnectorCoordinateSpringDamperExt(
            markerNumbers=[rotors.marker(node) for node in pair],
            nodeNumber=mbs.AddNode(backward),
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
        found.append(rotors.run(end, round((end - begin) / step), begin=begin, solver="GeneralizedAlpha"))
    together = np.vstack(found)
    return Run(together[:, 0], together[:, 1:])
