"""How sliding and spinning end: at once, and in a ratio that forgets the start."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike

from compare.claims.error_estimates import observed_exponent, refined
from compare.claims.measured import Measured
from compare.engines import Engine
from compare.studies.disc.free_ring.claims.study import STUDY
from compare.studies.disc.free_ring.parameters import (
    CITED,
    DECELERATION,
    ENDING,
    LOPSIDED,
    NEARNESSES,
    OTHERS,
    REMAINING,
    RINGS,
    SOURCE,
    TABLE,
    TOLERANCE,
    Throw,
)
from compare.studies.disc.free_ring.theory import deviation, expected_approach, nearness
from compare.studies.disc.free_ring.throws import (
    approach_times,
    rest_of,
    roughly_rest,
    speeds_at,
    speeds_before_rest,
    thrown,
    uniform_times,
)
from compare.studies.toolkit.free_bodies import Slowing
from reference_model.systems import FloatArray


@STUDY.claim(
    "Sliding and spinning end at the same instant, whatever the start",
    equation="(19), (20)",
    resolution=1e-4,
    note="Time by which sliding ends after spinning, over that to rest: U and W, extrapolated in straight lines from "
    f"t/T = {REMAINING[1]:g}, {REMAINING[0]:g} of it before. Error: the change from twice as far away, and at a "
    "smaller tolerance.",
)
def end_together(engine: Engine, throws: Sequence[Throw] = (*RINGS, *OTHERS)) -> Measured:
    """Extrapolate both speeds to zero."""
    rests = np.array([roughly_rest(engine, throw) for throw in throws])

    def apart(tolerance: float) -> FloatArray:
        """Return by how much the rest of the centre is later than that of the rim, from two pairs of samples."""
        found = []
        for throw, rest in zip(throws, rests.tolist(), strict=True):
            times = rest * (1.0 - REMAINING[:3])
            speeds = speeds_at(thrown(engine, throw, tolerance), times)
            ends = [_zeros_between(times, speed) for speed in speeds]
            found.append((ends[0] - ends[1]) / rest)
        return np.array(found)

    found = refined(apart, TOLERANCE)
    # A line through two speeds is zero to within three errors of a speed over its slope, which is above 0.4·g here.
    noise = 2.0 * 3.0 * TOLERANCE / (0.4 * DECELERATION) / rests
    # Speeds in a ratio that still changes are no straight lines: from farther away that is seen better.
    bend = np.abs(found.value[:, 1] - found.value[:, 0])
    return Measured(
        system=TABLE,
        predicted=np.zeros(len(throws)),
        value=found.value[:, 0],
        error=found.largest + noise + bend,
        at={"throw": [throw.name for throw in throws]},
        source=SOURCE + CITED,
    )


def _zeros_between(times: FloatArray, speeds: FloatArray) -> FloatArray:
    """Return where straight lines through neighbours, the last first, are zero."""
    return times[:-1] + speeds[:-1] * (times[:-1] - times[1:]) / (speeds[1:] - speeds[:-1])


@STUDY.claim(
    "Sliding and rim speed of a ring with J = mR² end in the ratio 1, whatever the start",
    equation="(19), (20)",
    resolution=1e-4,
    note=f"U/W when {REMAINING[0]:g} of the time to rest is left. Error: the tolerance of both speeds, and the "
    "change at a smaller one. Model error: what the approach to 1 leaves.",
)
def ratio_one(engine: Engine, throws: Sequence[Throw] = RINGS) -> Measured:
    """Compare the ratio at the last of the times with 1."""

    def ratio(tolerance: float) -> FloatArray:
        speeds = [speeds_before_rest(engine, throw, tolerance, REMAINING[0]) for throw in throws]
        return np.array([sliding[0] / rim[0] for sliding, rim in speeds])

    found = refined(ratio, TOLERANCE)
    rests = np.array([roughly_rest(engine, throw) for throw in throws])
    farthest = np.array([expected_approach(throw) for throw in throws]) / (REMAINING[0] * rests)
    return Measured(
        system=TABLE,
        predicted=np.ones(len(throws)),
        value=found.value,
        error=found.largest + ratio_noise(REMAINING[0] * rests),
        model=float(np.max(deviation(farthest))),
        at={"throw": [throw.name for throw in throws]},
        source=SOURCE + CITED,
        data={"ratio of rings": np.mean(found.value)},
    )


def ratio_noise(left: ArrayLike) -> FloatArray:
    """Return the error of ln U/W that the tolerance of both speeds makes when so much time (s) is left, for c = 1."""
    speed = 2.0 / math.pi * DECELERATION * np.asarray(left)
    return np.asarray(2.0 * TOLERANCE / speed)


@STUDY.claim(
    "With J = mR² the ratio of both speeds comes to 1 like exp(−A/t) with the remaining time t",
    equation="(19), (20)",
    unit="s",
    note="A = t·(ln(8/|ln U/W|) − 2). Predicted by the integrals over the ratio. Error: the tolerance of both "
    "speeds, and the change at a smaller one. Model error: the change of the integrals if they end at the δ of the "
    "measurement.",
    basis="reference",
)
def approach(engine: Engine, throws: Sequence[Throw] = RINGS) -> Measured:
    """Compare A of the approach to the ratio 1 with the integrals."""

    def constants(tolerance: float) -> FloatArray:
        found = []
        for throw in throws:
            trajectory = thrown(engine, throw, tolerance)
            times = approach_times(engine, throw)
            sliding, rim = speeds_at(trajectory, times)
            found.append((rest_of(trajectory) - times) * nearness(np.log(sliding / rim)))
        return np.array(found)

    found = refined(constants, TOLERANCE)
    there = np.isfinite(found.error)  # what comes and goes with the tolerance makes nothing else open
    largest = np.where(there, np.max(found.error[there], initial=0.0), found.error)
    predicted = np.array([expected_approach(throw) for throw in throws])
    # An error of δ changes L by as much, relative to δ.
    left = predicted[:, np.newaxis] / np.array(NEARNESSES)
    noise = left * ratio_noise(left) / deviation(NEARNESSES)
    # The law of the approach is that of small δ: the integrals tell what it leaves out at the δ of the measurement.
    left_out = [
        abs(expected_approach(throw, float(deviation(NEARNESSES[0]))) - expected_approach(throw))
        for throw in throws
    ]
    return Measured(
        system=TABLE,
        predicted=np.repeat(predicted[:, np.newaxis], len(NEARNESSES), axis=1),
        value=found.value,
        error=largest + noise,
        model=max(left_out),
        resolution=1e-2 * float(np.min(predicted)),
        at={"throw": [throw.name for throw in throws], "A/t": NEARNESSES},
        data=_drawn(engine, throws),
    )


def _drawn(engine: Engine, throws: Sequence[Throw]) -> dict[str, ArrayLike]:
    """Return both speeds in m/s, and A over the remaining time, from the start to rest."""
    speeds, approaches = [], []
    for throw in throws:
        trajectory, times = thrown(engine, throw, TOLERANCE), uniform_times(engine, throw)
        speeds.append(speeds_at(trajectory, times))
        approaches.append(expected_approach(throw) / (rest_of(trajectory) - times))
    sliding, rim = zip(*speeds, strict=True)
    return {"sliding": sliding, "rim": rim, "approach": approaches}


@STUDY.claim(
    "For mR²/2 < J < 2mR² the ratio ends at the balance of both decelerations, whatever the start",
    equation="(19), (20)",
    resolution=1e-2,
    note=f"U/W at t/T = {', '.join(f'{left:g}' for left in REMAINING[:3])} of the time to rest, extrapolated to zero "
    "as a power. Predicted: the root of J·∂P/∂U·W = mR²·∂P/∂W·U of the closed form. Error: the change from twice as "
    "far away, and at a smaller tolerance.",
    basis="reference",
    swept=("polar_inertia",),
)
def other_ratios(engine: Engine, throws: Sequence[Throw] = OTHERS) -> Measured:
    """Extrapolate the ratio of other moments of inertia to the end."""

    def ratios(tolerance: float) -> FloatArray:
        found = []
        for throw in throws:
            sliding, rim = speeds_before_rest(engine, throw, tolerance, REMAINING[:4])
            found.append([_limit(*(sliding / rim)[:3]), _limit(*(sliding / rim)[1:])])
        return np.array(found)

    found = refined(ratios, TOLERANCE)
    return Measured(
        system=TABLE,
        predicted=[math.exp(Slowing(throw.inertia).terminal) for throw in throws],
        value=found.value[:, 0],
        error=found.largest + np.abs(found.value[:, 1] - found.value[:, 0]),
        at={"throw": [throw.name for throw in throws]},
        source=SOURCE + CITED,
        data={"inertia": [throw.inertia for throw in throws], "ratio": found.value[:, 0]},
    )


def _limit(last: float, middle: float, first: float) -> float:
    """Return the limit of a sequence that approaches it like a geometric one (Aitken)."""
    return float(last - (last - middle) ** 2 / ((last - middle) - (middle - first)))


@STUDY.claim(
    "As a power of the time left, the rim's share of the slip goes to zero for J < mR²/2, the centre's for J > 2mR²",
    equation="(19), (20)",
    resolution=0.05,
    note=f"Power of W/U ~ t^(mR²/2J − 1) or U/W ~ t^(J/2mR² − 1), fitted to the last {ENDING[-1]:g} to {ENDING[0]:g} "
    "of the time to rest, with the next term, whose size is the model error.",
    swept=("polar_inertia",),
)
def powers(engine: Engine, throws: Sequence[Throw] = LOPSIDED) -> Measured:
    """Fit the power with which the ratio goes to zero or to infinity."""
    predicted, found = [], []
    for throw in throws:
        slow = throw.inertia < 0.5
        power = 0.5 / throw.inertia - 1.0 if slow else 0.5 * throw.inertia - 1.0

        def shares(tolerance: float, throw: Throw = throw, slow: bool = slow) -> FloatArray:
            sliding, rim = speeds_before_rest(engine, throw, tolerance, ENDING)
            return rim / sliding if slow else sliding / rim

        share = refined(shares, TOLERANCE)
        predicted.append(power)
        found.append(observed_exponent(ENDING, share.value, next_term=2.0 * power, noise=share.largest))
    exponents, errors, models = zip(*found, strict=True)
    return Measured(
        system=TABLE,
        predicted=predicted,
        value=exponents,
        error=errors,
        model=max(models),
        at={"throw": [throw.name for throw in throws]},
        source=SOURCE + "; limits as Goyal et al. 1991",
    )
