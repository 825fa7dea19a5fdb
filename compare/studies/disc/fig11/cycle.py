"""The modulated cycle itself: period, turn and extremes on the continuous ring, rests of points on six points."""

from __future__ import annotations

import functools
import itertools

import numpy as np
from scipy.interpolate import CubicSpline

from compare.claims.claim import Claim, ErrorBudget
from compare.claims.error_estimates import refined
from compare.claims.parameters import parameters_of
from compare.claims.study import Findings
from compare.engines import Engine
from compare.studies.toolkit.fig11_motion import RING, SIX, SOURCE, START, integrated
from reference_model import Trajectory, simulate
from reference_model.orbits import modulated_cycle
from reference_model.systems import DiscOnDisc, FloatArray

SLIDING_START = (0.02, 0.0, 0.0, 0.0, 0.02, 1.39)
"""From here no point of the contact comes to rest for 100 s (our choice)."""

SLIDING = np.linspace(0.0, 100.0, 101)

UNTIL = 700.0
"""In s: three periods of the modulation."""

TIMES = np.linspace(0.0, UNTIL, 2801)

ROUND = np.linspace(0.0, 300.0, 1201)
"""In s: one period of the modulation and more."""

TRAJECTORY = "A disc on {} that slides moves for 100 s as (19) to (21) say, integrated as they stand"
MODULATION = "Period of the modulation on the continuous ring, and the turn about the axis within it"
EXTREMES = "Least and greatest radius and spin of the modulated cycle on the continuous ring"
RESTS = "Single points of six come to rest, so that the disc turns about them, when the reference says"
SIX_EXTREMES = "Least and greatest radius and spin of the modulated motion on six points within 300 s"
SHOOTING = "Shooting finds the modulated cycle, periodic but for a turn, where integration settles"


def trajectory_claim(engine: Engine, words: str, disc: DiscOnDisc) -> Claim:
    """Return the trajectory of a disc that slides all the time."""
    predicted, rougher = (
        integrated(disc, SLIDING_START, SLIDING[-1], len(SLIDING), tolerance) for tolerance in (3e-14, 2e-13)
    )
    measured, error = refined(
        lambda tolerance: engine.simulate(disc, SLIDING_START, SLIDING, tolerance=tolerance).states, 5e-10
    )
    # A single number may be right by chance.
    worst = float(np.max(error)) + float(np.max(np.abs(rougher - predicted)))
    return Claim(
        TRAJECTORY.format(words),
        equation="(19)–(21)",
        kind="trajectory",
        engine=engine.name,
        predicted=predicted,
        measured=measured,
        budget=ErrorBudget(worst, resolution=1e-8),
        parameters=parameters_of(disc),
        source=f"{SOURCE}: 0 here; start {SLIDING_START} is an assumption",
        unit="m, rad, m/s, rad/s",
        note=f"All components of the state at {len(SLIDING)} times.",
        named={f"slip for 100 s on {words}": None},
    )


def modulations(states: FloatArray) -> FloatArray:
    """Return period, turn, least and greatest radius and spin of each modulation at ``TIMES``, shape (n, 6).

    In s, rad, m and rad/s, from one maximum of the radius to the next; no rows where there are no two.
    """
    x, y = states[:, 0], states[:, 1]
    radius, spin = CubicSpline(TIMES, np.hypot(x, y)), CubicSpline(TIMES, states[:, 5])
    angle = CubicSpline(TIMES, np.unwrap(np.arctan2(y, x)))
    turning, of_spin = (curve.derivative().roots(extrapolate=False) for curve in (radius, spin))
    largest = turning[radius(turning, 2) < 0.0]
    rows = []
    for start, end in itertools.pairwise(largest):
        radii = radius(turning[(start <= turning) & (turning <= end)])
        spins = spin([start, *of_spin[(start < of_spin) & (of_spin < end)]])
        rows.append(
            [end - start, angle(end) - angle(start), radii.min(), radii.max(), spins.min(), spins.max()]
        )
    return np.array(rows).reshape(-1, 6)


def last_modulation(states: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return the last row of :func:`modulations` and its change from the one before, no numbers without them."""
    found = modulations(states)
    if len(found) < 2:
        return np.full(6, np.nan), np.full(6, np.nan)
    return found[-1], np.abs(found[-1] - found[-2])


@functools.cache
def predicted_modulation() -> tuple[FloatArray, FloatArray]:
    """Return the last modulation of (19), integrated as it stands, and its error, both of shape (6,)."""
    fine, rough = (
        last_modulation(integrated(RING, START, UNTIL, len(TIMES), tolerance)) for tolerance in (1e-12, 1e-11)
    )
    return fine[0], np.abs(rough[0] - fine[0]) + fine[1]


def measure_cycle(engine: Engine) -> Findings:
    """Measure period and turn of the modulation, and the extremes of the cycle, on the continuous ring."""
    run = functools.cache(lambda tolerance: engine.simulate(RING, START, TIMES, tolerance=tolerance))
    predicted, other = predicted_modulation()
    measured, error = refined(lambda tolerance: last_modulation(run(tolerance).states)[0], alike=False)
    error = np.nan_to_num(error + other + last_modulation(run(1e-9).states)[1], nan=np.inf)
    claims = tuple(
        Claim(
            sentence,
            equation="(19)–(21)",
            kind="trajectory",
            engine=engine.name,
            predicted=predicted[part],
            measured=measured[part],
            budget=ErrorBudget(error[part], resolution=resolution),
            parameters=parameters_of(RING),
            source=f"{SOURCE}: 0 here; start {START}",
            unit=unit,
            note=f"The last modulation within {UNTIL:g} s, from one maximum of the radius to the next. Predicted: "
            "(19) as it stands, integrated at a tolerance of 1e-12. Error: the change at a smaller tolerance, and "
            "the change from the modulation before, of both.",
            named=named,
        )
        for sentence, part, resolution, unit, named in (
            (MODULATION, slice(0, 2), 1e-3, "s, rad", {"period of the modulation": 0, "turn in it": 1}),
            (EXTREMES, slice(2, 6), 1e-6, "m, rad/s", {}),
        )
    )
    return Findings(claims, {"the continuous ring": run(1e-9).states})


@functools.cache
def _six_points_of_reference() -> Trajectory:
    return simulate(SIX, START, ROUND, tolerance=1e-11)


def rests_of_points(trajectory: Trajectory) -> FloatArray:
    """Return when single points come to rest and let go, in s, one after the other, shape (2·rests,)."""
    return np.ravel([(phase.start, phase.end) for phase in trajectory.phases if phase.kind == "pivot"])


def extremes_of(trajectory: Trajectory) -> FloatArray:
    """Return least and greatest radius in m and spin in rad/s, shape (4,)."""
    found = []
    for values in (trajectory.radius, trajectory.states[:, 5]):
        curve = CubicSpline(trajectory.times, values)
        all_values = [*curve(curve.derivative().roots(extrapolate=False)), *values[[0, -1]]]
        found += [min(all_values), max(all_values)]
    return np.array(found)


def measure_six_points(engine: Engine) -> Findings:
    """Measure when single points rest, and the extremes, over one modulation of the disc on six points."""
    run = functools.cache(lambda tolerance: engine.simulate(SIX, START, ROUND, tolerance=tolerance))
    predicted = rests_of_points(_six_points_of_reference())

    def rests(tolerance: float) -> FloatArray:
        found = rests_of_points(run(tolerance))
        return found if len(found) == len(predicted) else np.full(len(predicted), np.nan)

    times, times_error = refined(rests)
    values, values_error = refined(lambda tolerance: extremes_of(run(tolerance)), alike=False)
    source, note = (
        f"{SOURCE}: 0 here; start {START}",
        f"Within {ROUND[-1]:g} s. Predicted: the reference at 1e-11.",
    )
    claims = (
        Claim(
            RESTS,
            equation="(19)–(21)",
            kind="trajectory",
            engine=engine.name,
            predicted=predicted,
            measured=times,
            budget=ErrorBudget(float(np.max(np.nan_to_num(times_error, nan=np.inf))), resolution=1e-2),
            parameters=parameters_of(SIX),
            source=source,
            unit="s",
            note=f"{note} A rest too many or too few shows as a missing number.",
        ),
        Claim(
            SIX_EXTREMES,
            equation="(19)–(21)",
            kind="trajectory",
            engine=engine.name,
            predicted=extremes_of(_six_points_of_reference()),
            measured=values,
            budget=ErrorBudget(float(np.max(values_error)), resolution=1e-5),
            parameters=parameters_of(SIX),
            source=source,
            unit="m, rad/s",
            note=note,
        ),
    )
    longer = engine.simulate(SIX, START, TIMES, tolerance=1e-8)
    return Findings(claims, {"six points": longer.states, "six points: rests": rests_of_points(longer)})


def shooting_claim() -> Claim:
    """Return the modulated cycle as a relative periodic orbit, beside the motion that has settled."""
    predicted, error = predicted_modulation()
    guess = simulate(RING, START, TIMES, tolerance=1e-7)

    def found(tolerance: float) -> FloatArray:
        orbit = modulated_cycle(RING, guess, tolerance=tolerance, samples=len(ROUND))
        return np.array([orbit.period, orbit.turn, *extremes_of(orbit.trajectory)])

    measured, change = refined(found, alike=False)
    return Claim(
        SHOOTING,
        equation="(19)–(21)",
        kind="trajectory",
        engine="theory",
        predicted=predicted,
        measured=measured,
        budget=ErrorBudget(change + error, resolution=1e-3),
        parameters=parameters_of(RING),
        source=f"{SOURCE}: 0 here",
        unit="s, rad, m, rad/s",
        note="Period, turn within it, least and greatest radius and spin. Error: the change at a smaller tolerance, "
        "and the change from the modulation before in the motion that settles.",
    )
