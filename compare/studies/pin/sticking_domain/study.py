"""The radius (9) and the turn until release (7) against the disc speed."""

import functools
import itertools
import math
from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import ArrayLike

from compare.claims.error_estimates import ROUNDING, Measurement, refined
from compare.claims.linearised_flow import rotated
from compare.claims.measured import Measured, answers_of, asked
from compare.claims.parameters import FIG4
from compare.claims.study import Data, Study
from compare.engines import Engine
from compare.studies.toolkit.measuring import compared
from compare.studies.toolkit.pins import first_release, safest_angle, stuck
from reference_model.formulas.pin import resonant_disc_speed, sticking_radius, turn_until_release
from reference_model.systems import FloatArray, PinOnDisc

PIN = FIG4
SOURCE = "Fig. 4, whose friction force is above C·X0; the values of ω are our choice"
RESONANCE = resonant_disc_speed(PIN)

SPEEDS = (0.4, 0.7, RESONANCE, 1.4, 2.5)  # ω in rad/s

INSIDE = 0.98
OUTSIDE = (1.02, 1.5)
"""Radii as multiples of (9)."""
CREEP = 1e-2  # relative displacement that leaves stick uncertain

CREEP_AT_EDGE = 0.05 * (OUTSIDE[0] - 1.0)
"""Such a displacement just outside (9), where creep by this share of the distance to the edge may hold a pin."""

LATEST, REVOLUTIONS = 1.1, 2.0
"""Duration for a pin outside (9) as multiple of (7); turns for a pin inside (9): two periods of the holding force."""

SEARCHED = (0.9, 1.0, 1.1, 0.4, 2.0)
"""ω in rad/s of the search for the largest sticking radius; the first three are near the resonance."""

BRACKET, PRECISION, SEARCH_TOLERANCE = (0.03, 4.0), 6e-5, 1e-7
"""Initial bracket of the search in units of X0, independent of (9), its relative accuracy and its tolerance."""

TOLERANCE = 3e-8  # moderate, because regularised laws close to Coulomb's make stick expensive
DAMPINGS = np.geomspace(0.01, 1.3, 15)  # β in N s/m
FAST = (10.0, 30.0, 100.0)  # ω in rad/s far above the resonance


def pin_at(speed: float) -> PinOnDisc:
    return replace(PIN, disc_speed=speed)


def curves() -> Data:
    speeds = np.unique(np.concatenate((np.linspace(0.15, 2.6, 200), RESONANCE + np.linspace(-0.2, 0.2, 81))))
    return {
        "speed": speeds,
        "radius": np.array([sticking_radius(pin_at(speed)) for speed in speeds]),
        "turn": predicted_turns(speeds),
    }


def predicted_turns(speeds: ArrayLike) -> FloatArray:
    """Return the turns (rad) that (7) predicts, shape (n, 2), for ``speeds`` (rad/s), shape (n,)."""
    return np.array(
        [
            [turn_until_release(pin, share * sticking_radius(pin), safest_angle(pin)) for share in OUTSIDE]
            for pin in map(pin_at, np.asarray(speeds, dtype=float).tolist())
        ]
    )


def vertex(s: FloatArray, values: FloatArray, relative_error: FloatArray) -> tuple[float, float]:
    """Return the square root of the vertex of the parabola through three points 1/A² over s = ω², and its error.

    ``relative_error`` is the relative error of the radii A. If a radius is missing, the vertex is NaN;
    its error is infinite if those of all missing radii are, else 0.
    """

    def found(values: FloatArray) -> float:
        square, linear, _ = np.polyfit(s, values, 2)
        return math.sqrt(max(-linear / (2.0 * square), 0.0))

    missing = ~np.isfinite(values)
    if np.any(missing):
        return math.nan, math.inf if np.all(np.isinf(relative_error[missing])) else 0.0
    middle = found(values)
    if not np.all(np.isfinite(relative_error)):
        return middle, math.inf
    moved = values * (1.0 + 2.0 * np.diag(relative_error))
    return middle, sum(abs(found(each) - middle) for each in moved)


def top(pin: PinOnDisc, speed: float, width: float) -> float:
    """Return ω (rad/s) at the vertex of a parabola through the radius (9) at three speeds."""
    step = width * speed
    # The nodes are not symmetric, so the result does not contain its own prediction.
    nodes = speed + step * np.array([-0.6, 0.4, 1.4])
    low, middle, high = (sticking_radius(replace(pin, disc_speed=node)) for node in nodes)
    return float(nodes[1] + 0.5 * step * (low - high) / (low - 2.0 * middle + high))


STUDY = Study.beside(__file__, "sticking-domain", source=SOURCE, system=PIN, seconds=6.0)

LARGEST_AT = "The sticking domain is largest at the disc speed ω* = √(C/m − β²/2m²)"


@functools.lru_cache(maxsize=4)
def two_revolutions(
    engine: Engine, speeds: tuple[float, ...], tolerance: float
) -> tuple[FloatArray, list[bool]]:
    """Return displacements, in radii, of pins inside (9), shape (n, 2), and which pins always stick."""
    turn = REVOLUTIONS * 2.0 * math.pi
    motions = [
        (pin, stuck(pin, INSIDE * sticking_radius(pin), safest_angle(pin)), [0.0, turn / pin.disc_speed])
        for pin in map(pin_at, speeds)
    ]
    displacements, sticks = [], []
    for run, (_, start, _) in zip(engine.simulate_many(motions, tolerance=tolerance), motions, strict=True):
        displacements.append((rotated(run.at_end, -turn) - start)[:2] / np.hypot(*start[:2]))
        sticks.append(all(phase.kind != "slip" for phase in run.phases))
    return np.array(displacements), sticks


def displaced(engine: Engine, speeds: tuple[float, ...] = SPEEDS) -> Measurement:
    found = refined(lambda tolerance: two_revolutions(engine, speeds, tolerance)[0], TOLERANCE)
    # Zero displacements have no scale for rounding, so the rounding of a turn counts.
    return found.plus(ROUNDING)


def creeps(engine: Engine, speeds: tuple[float, ...] = SPEEDS, *, most: float = CREEP) -> bool:
    """Return whether stuck pins may creep by more than ``most``."""
    return displaced(engine, speeds).largest > most


@STUDY.claim(
    "A pin stuck at 0.98 of the radius (9) is at the same position on the disc two revolutions later",
    equation="(9)",
    resolution=CREEP,
    note="Displacement on the disc over the distance from the axis; starts where the holding force is smallest. "
    "Error: the change at a smaller tolerance, which reveals the creep of a law that only approximates stick.",
    swept=("disc_speed",),
)
def stays(engine: Engine, speeds: tuple[float, ...] = SPEEDS) -> Measured:
    found = displaced(engine, speeds)
    return compared(
        np.zeros_like(found.value),
        found,
        error=found.rows,
        size=1.0,
        at={"ω in rad/s": speeds},
        components=("x", "y"),
    )


@STUDY.claim(
    "A pin stuck at 0.98 of the radius (9) does not slip within two revolutions",
    equation="(8)",
    note="Is each of these motions without a slip phase?",
    swept=("disc_speed",),
)
def holds(engine: Engine, speeds: tuple[float, ...] = SPEEDS) -> Measured:
    margins, errors = asked(lambda tolerance: two_revolutions(engine, speeds, tolerance)[1], TOLERANCE)
    if np.any(margins < 0.0) and creeps(engine, speeds):
        errors = np.full_like(margins, np.inf)
    return answers_of(margins, errors)


@STUDY.claim(
    "A pin stuck at 1.02 and at 1.5 of the radius (9) is released at the time that (7) predicts",
    equation="(7)",
    unit="rad",
    resolution=1e-2,
    note="Turn of the disc until the end of the first stick phase, from a start where the holding force is smallest. "
    "Error: the change at a smaller tolerance.",
    swept=("disc_speed",),
)
def lets_go(engine: Engine, speeds: Sequence[float] = SPEEDS) -> Measured:

    def turns(tolerance: float) -> FloatArray:
        motions = []
        for pin, share in itertools.product(map(pin_at, speeds), OUTSIDE):
            radius, angle = share * sticking_radius(pin), safest_angle(pin)
            release = turn_until_release(pin, radius, angle) / pin.disc_speed
            motions.append((pin, stuck(pin, radius, angle), [0.0, LATEST * release]))
        runs = engine.simulate_many(motions, tolerance=tolerance)
        found = [run.system.disc_speed * first_release(run) for run in runs]
        return np.array(found).reshape(len(speeds), len(OUTSIDE))

    found = refined(turns, TOLERANCE)
    return compared(
        predicted_turns(speeds),
        found,
        error=_unless_missing(engine, found.value, found.rows),
        at={"ω in rad/s": speeds, "radius/(9)": OUTSIDE},
        data={"speed": speeds, "turn": found.value, "turn_error": found.rows},
    )


@functools.lru_cache(maxsize=2)
def largest_radii(engine: Engine, searched: Sequence[float]) -> Measurement:
    """Return the largest sticking radii (m) at ``searched`` ω (rad/s), by bisection, shape (n,)."""
    pins = [pin_at(speed) for speed in searched]
    first = [_between(engine, pin, SEARCH_TOLERANCE, _anywhere(pin)) for pin in pins]

    around = [
        near if np.all(np.isfinite(near)) else _anywhere(pin) for pin, near in zip(pins, first, strict=True)
    ]

    def radii(tolerance: float) -> FloatArray:
        found = first
        if tolerance != SEARCH_TOLERANCE:
            found = [_between(engine, pin, tolerance, near) for pin, near in zip(pins, around, strict=True)]
        return np.asarray(np.sqrt(np.prod(found, axis=1)))

    found = refined(radii, SEARCH_TOLERANCE)
    error = found.error + PRECISION * found.value / 2.0
    return Measurement(found.value, _unless_missing(engine, found.value, error))


def _unless_missing(engine: Engine, values: FloatArray, errors: FloatArray) -> FloatArray:
    """Return the errors of ``values``; a missing value makes the claim open if the engine creeps, else wrong."""
    missing = ~np.isfinite(values)
    if not np.any(missing):
        return errors
    of_missing = np.inf if creeps(engine, most=CREEP_AT_EDGE) else 0.0
    return np.where(missing, of_missing, np.where(np.isnan(errors), np.inf, errors))


def _anywhere(pin: PinOnDisc) -> tuple[float, float]:
    return BRACKET[0] * pin.offset, BRACKET[1] * pin.offset


def _between(
    engine: Engine, pin: PinOnDisc, tolerance: float, around: tuple[float, float]
) -> tuple[float, float]:
    """Return radii (m) around the largest sticking radius, by bisection from ``around``, or NaN."""
    # The holding force goes from its minimum to its maximum in half a revolution.
    end = 1.02 * math.pi / pin.disc_speed

    @functools.cache
    def sticks(radius: float) -> bool:
        start = stuck(pin, radius, safest_angle(pin))
        run = engine.simulate(pin, start, [0.0, end], tolerance=tolerance)
        return all(phase.kind == "stick" for phase in run.phases)

    (inside, outside), (least, most) = around, _anywhere(pin)
    ratio = outside / inside
    while not sticks(inside):
        inside, outside, ratio = inside / ratio, inside, ratio**2
        if inside < least:
            return math.nan, math.nan
    while sticks(outside):
        inside, outside, ratio = outside, outside * ratio, ratio**2
        if outside > most:
            return math.nan, math.nan
    while outside - inside > PRECISION * outside:
        middle = math.sqrt(inside * outside)
        inside, outside = (middle, outside) if sticks(middle) else (inside, middle)
    return inside, outside


@STUDY.claim(
    "The largest radius at which a stuck pin does not slip is (9)",
    equation="(9)",
    resolution=1e-2,
    note=f"By bisection to {PRECISION:g} of the radius, with starts that pass the angle of the largest force. "
    "Relative to (9). Error: the error of the bisection, and the change at a smaller tolerance. Both miss an "
    "error below 1e-3, because just outside the radius the slip grows from zero like the power 3/2 of the "
    "distance. "
    "Regularised friction hides it: Exudyn's radii have errors of 2e-4 to 6e-4 at tolerances from 1e-6 to 1e-8.",
    swept=("disc_speed",),
)
def largest(engine: Engine, searched: Sequence[float] = SEARCHED) -> Measured:
    found = largest_radii(engine, searched)
    predicted = np.array([sticking_radius(pin_at(speed)) for speed in searched])
    return Measured(
        predicted=np.ones(len(searched)),
        value=found.value / predicted,
        error=found.error / predicted,
        at={"ω in rad/s": searched},
        data={"searched": searched, "radius": found.value, "radius_error": found.error},
    )


@STUDY.claim(
    LARGEST_AT,
    equation="(9)",
    unit="rad/s",
    resolution=1e-3 * RESONANCE,
    note="Vertex of the parabola for 1/A² in ω² through the first three radii; by (9), 1/A² is such a parabola.",
    implied_by=largest,
    swept=("disc_speed",),
)
def resonance(engine: Engine, searched: Sequence[float] = SEARCHED) -> Measured:
    radii, error = (each[:3] for each in largest_radii(engine, searched))
    relative = np.where(np.isfinite(radii), error / radii, error)
    found, error_of_vertex = vertex(np.array(searched[:3]) ** 2, 1.0 / radii**2, relative)
    return Measured(predicted=RESONANCE, value=found, error=error_of_vertex)


@STUDY.claim(
    LARGEST_AT,
    equation="(9)",
    unit="rad/s",
    resolution=1e-3 * RESONANCE,
    note="Maximum of the right side of (9), by differences.",
    swept=("disc_speed", "damping"),
)
def resonance_of_9() -> Measured:
    found, errors, expected = [], [], []
    for damping in DAMPINGS:
        pin = replace(PIN, damping=damping)
        expected.append(resonant_disc_speed(pin))
        # The logarithm of the radius is a parabola near its maximum; halving the width gives the error of the vertex.
        wide, narrow = (top(pin, expected[-1], width) for width in (2e-3, 1e-3))
        found.append(narrow)
        errors.append(abs(wide - narrow) + np.finfo(float).eps / (1e-3 * damping) ** 2)
    return Measured(
        predicted=expected,
        value=found,
        error=errors,
        at={"β in N s/m": DAMPINGS},
        source=f"Fig. 4; β = {DAMPINGS[0]:g} … {DAMPINGS[-1]:g} N s/m is our choice",
    )


@STUDY.claim(
    "For large ω, the sticking domain shrinks like 1/ω²",
    equation="(9)",
    resolution=0.05,
    note="Right side of (9) over (μN − C·X0)/(mω²). Model error: twice the first omitted term, (ω*/ω)² at the "
    "smallest ω.",
    swept=("disc_speed",),
)
def shrinks() -> Measured:
    speeds = np.array(FAST)
    radii = np.array([sticking_radius(pin_at(speed)) for speed in FAST])
    return Measured(
        predicted=np.ones(len(FAST)),
        value=PIN.mass * speeds**2 * radii / (PIN.friction_force - PIN.stiffness * PIN.offset),
        error=4.0 * np.finfo(float).eps,
        model=2.0 * (RESONANCE / FAST[0]) ** 2,
        at={"ω in rad/s": FAST},
        source="Fig. 4; the values of ω are our choice",
    )
