"""Claims on the end of sliding and spinning, on rest, heat and the final ratio."""

import cmath
import math
from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike
from scipy.interpolate import make_interp_spline
from scipy.optimize import brentq

import compare.studies.disc.free_ring.theory as theory
from compare.claims import Measured, Study, answers_of, observed_exponent, refined
from compare.claims.parameters import at_each
from compare.engines import Engine
from compare.studies.disc.free_ring.theory import OTHERS, REMAINING, RINGS, SOURCE, TOLERANCE, Throw
from compare.studies.toolkit.free_bodies import LARGEST, NEAR, Slowing
from reference_model.contact.annulus import Annulus
from reference_model.contact.elliptic import mean_directions
from reference_model.systems import FloatArray

Throws = Sequence[Throw]

STUDY = Study.beside(__file__, "free-ring", source=SOURCE, seconds=2.0)
STUDY.provides(curves=theory.curves)


# --- End of sliding and spinning


@STUDY.claim(
    "Sliding and spinning end at the same instant, whatever the start",
    equation="(19), (20)",
    resolution=1e-4,
    note="Delay of the end of sliding after the end of spinning, over the time to rest; U and W are extrapolated "
    f"linearly from t/T = {REMAINING[1]:g}, {REMAINING[0]:g} before rest. Error: the change for "
    "earlier samples, and at a smaller tolerance.",
)
def end_together(engine: Engine, throws: Throws = (*RINGS, *OTHERS)) -> Measured:
    rests = np.array([theory.roughly_rest(engine, throw) for throw in throws])

    def apart(tolerance: float) -> FloatArray:
        """Return how much later the centre rests than the rim, as a share of the duration, from two sample pairs."""
        found = []
        for throw, rest in zip(throws, rests.tolist(), strict=True):
            times = rest * (1.0 - REMAINING[:3])
            centre, rim = theory.speeds_at(theory.thrown(engine, throw, tolerance), times)
            found.append((_zeros_between(times, centre) - _zeros_between(times, rim)) / rest)
        return np.array(found)

    found = refined(apart, TOLERANCE)
    # Three errors of a speed divided by its slope, which exceeds 0.4·g.
    noise = 2.0 * 3.0 * TOLERANCE / (0.4 * theory.DECELERATION) / rests
    # Speeds are not straight lines while the ratio still changes, which earlier samples show more clearly.
    bend = np.abs(found.value[:, 1] - found.value[:, 0])
    return of_throws(
        throws,
        predicted=np.zeros(len(throws)),
        value=found.value[:, 0],
        error=found.largest + noise + bend,
        source=SOURCE + theory.CITED,
    )


def of_throws(throws: Throws, **measured: Any) -> Measured:
    at = {"throw": [throw.name for throw in throws]} | measured.pop("at", {})
    return Measured(system=theory.TABLE, at=at, **measured)


def _zeros_between(times: FloatArray, speeds: FloatArray) -> FloatArray:
    return times[:-1] + speeds[:-1] * (times[:-1] - times[1:]) / (speeds[1:] - speeds[:-1])


@STUDY.claim(
    "The ratio of sliding speed to rim speed ends at 1 for a ring with J = mR², whatever the start",
    equation="(19), (20)",
    resolution=1e-4,
    note=f"U/W when {REMAINING[0]:g} of the time to rest remains. Error: the tolerance of both speeds, "
    "and the change at a smaller one. Model error: the remaining distance to 1.",
)
def ratio_one(engine: Engine, throws: Throws = RINGS) -> Measured:

    def ratio(tolerance: float) -> list[float]:
        found = (theory.speeds_before_rest(engine, throw, tolerance, REMAINING[0]) for throw in throws)
        return [sliding[0] / rim[0] for sliding, rim in found]

    found = refined(ratio, TOLERANCE)
    left = REMAINING[0] * np.array([theory.roughly_rest(engine, throw) for throw in throws])
    farthest = np.array([theory.expected_approach(throw) for throw in throws]) / left
    return of_throws(
        throws,
        predicted=np.ones(len(throws)),
        value=found.value,
        error=found.largest + ratio_noise(left),
        model=float(np.max(theory.deviation(farthest))),
        source=SOURCE + theory.CITED,
        data={"ratio of rings": np.mean(found.value)},
    )


def ratio_noise(left: ArrayLike) -> FloatArray:
    """Return the error of ln(U/W), ``left`` s before rest, that the tolerance of both speeds causes for c = 1."""
    speed = 2.0 / math.pi * theory.DECELERATION * np.asarray(left)
    return np.asarray(2.0 * TOLERANCE / speed)


@STUDY.claim(
    "For J = mR², the ratio of both speeds approaches 1 like exp(−A/t) with the remaining time t",
    equation="(19), (20)",
    unit="s",
    note="A = t·(ln(8/|ln U/W|) − 2). Predicted by the integrals over the ratio. Error: the tolerance of both "
    "speeds, and the change at a smaller one. Model error: the change of the integrals if they end at the δ of the "
    "measurement.",
    basis="reference",
)
def approach(engine: Engine, throws: Throws = RINGS) -> Measured:

    def constants(tolerance: float) -> FloatArray:
        found = []
        for throw in throws:
            trajectory = theory.thrown(engine, throw, tolerance)
            times = theory.approach_times(engine, throw)
            sliding, rim = theory.speeds_at(trajectory, times)
            found.append((theory.rest_of(trajectory) - times) * theory.nearness(np.log(sliding / rim)))
        return np.array(found)

    found = refined(constants, TOLERANCE)
    there = np.isfinite(found.error)  # samples without an error estimate must not affect the others
    largest = np.where(there, np.max(found.error[there], initial=0.0), found.error)
    predicted = np.array([theory.expected_approach(throw) for throw in throws])
    # dL = −dδ/δ.
    left = predicted[:, np.newaxis] / np.array(theory.NEARNESSES)
    noise = left * ratio_noise(left) / theory.deviation(theory.NEARNESSES)
    # The law of the approach is valid for small δ; integrals to the measured δ give its error.
    near = float(theory.deviation(theory.NEARNESSES[0]))
    left_out = np.abs([theory.expected_approach(throw, near) for throw in throws] - predicted)
    return of_throws(
        throws,
        predicted=np.repeat(predicted[:, np.newaxis], len(theory.NEARNESSES), axis=1),
        value=found.value,
        error=largest + noise,
        model=float(np.max(left_out)),
        resolution=1e-2 * float(np.min(predicted)),
        at={"A/t": theory.NEARNESSES},
        data=lambda: _drawn(engine, throws),
    )


def _drawn(engine: Engine, throws: Throws) -> dict[str, ArrayLike]:
    rows = []
    for throw in throws:
        trajectory = theory.thrown(engine, throw, TOLERANCE)
        times = theory.uniform_times(engine, throw)
        approach = theory.expected_approach(throw) / (theory.rest_of(trajectory) - times)
        rows.append((*theory.speeds_at(trajectory, times), approach))
    return dict(zip(("sliding", "rim", "approach"), zip(*rows, strict=True), strict=True))


@STUDY.claim(
    "For mR²/2 < J < 2mR², the ratio ends at the balance of both decelerations, whatever the start",
    equation="(19), (20)",
    resolution=1e-2,
    note=f"U/W at t/T = {', '.join(f'{left:g}' for left in REMAINING[:3])} of the time to rest, "
    "extrapolated to zero as a power. Predicted: the root of J·∂P/∂U·W = mR²·∂P/∂W·U of the closed form. Error: "
    "the change at twice the remaining time, and at a smaller tolerance.",
    basis="reference",
    swept=("polar_inertia",),
)
def other_ratios(engine: Engine, throws: Throws = OTHERS) -> Measured:

    def ratios(tolerance: float) -> FloatArray:
        found = []
        for throw in throws:
            sliding, rim = theory.speeds_before_rest(engine, throw, tolerance, REMAINING[:4])
            found.append([_limit(*(sliding / rim)[:3]), _limit(*(sliding / rim)[1:])])
        return np.array(found)

    found = refined(ratios, TOLERANCE)
    return of_throws(
        throws,
        predicted=[math.exp(Slowing(throw.inertia).terminal) for throw in throws],
        value=found.value[:, 0],
        error=found.largest + np.abs(found.value[:, 1] - found.value[:, 0]),
        source=SOURCE + theory.CITED,
        data={"inertia": [throw.inertia for throw in throws], "ratio": found.value[:, 0]},
    )


def _limit(last: float, middle: float, first: float) -> float:
    """Return the limit of a geometrically convergent sequence (Aitken)."""
    return float(last - (last - middle) ** 2 / ((last - middle) - (middle - first)))


@STUDY.claim(
    "The rim's share of slip vanishes as a power of the remaining time for J < mR²/2, the centre's for J > 2mR²",
    equation="(19), (20)",
    resolution=0.05,
    note=f"Power of W/U ~ t^(mR²/2J − 1) or U/W ~ t^(J/2mR² − 1), fitted to the last {theory.ENDING[-1]:g} to "
    f"{theory.ENDING[0]:g} of the time to rest, with the next term, whose size is the model error.",
    swept=("polar_inertia",),
    friction=False,
)
def powers(engine: Engine, throws: Throws = theory.LOPSIDED) -> Measured:
    predicted, found = [], []
    for throw in throws:
        slow = throw.inertia < 0.5
        power = 0.5 / throw.inertia - 1.0 if slow else 0.5 * throw.inertia - 1.0

        def shares(tolerance: float, throw: Throw = throw, slow: bool = slow) -> FloatArray:
            sliding, rim = theory.speeds_before_rest(engine, throw, tolerance, theory.ENDING)
            return rim / sliding if slow else sliding / rim

        share = refined(shares, TOLERANCE)
        predicted.append(power)
        found.append(
            observed_exponent(theory.ENDING, share.value, next_term=2.0 * power, noise=share.largest)
        )
    exponents, errors, models = zip(*found, strict=True)
    return of_throws(
        throws,
        predicted=predicted,
        value=exponents,
        error=errors,
        model=max(models),
        source=SOURCE + "; limits as Goyal et al. 1991",
    )


# --- Rest and energy balance


@STUDY.claim(
    "The time and the distances to rest equal the integrals over the ratio of the speeds",
    equation="(19), (20)",
    unit="s, m, rad",
    resolution=1e-8,
    note="Predicted: integrals over the ratio U/W, without time steps.",
    basis="reference",
    swept=("polar_inertia",),
)
def stops(engine: Engine, throws: Throws = theory.INTEGRATED) -> Measured:

    def stops_at(tolerance: float) -> list[tuple[float, ...]]:
        runs = [theory.thrown(engine, throw, tolerance) for throw in throws]
        return [(theory.rest_of(run), *run.at_end[:3]) for run in runs]

    found = refined(stops_at, TOLERANCE)
    predicted, nearly = (
        np.array([_integrated(throw, near) for throw in throws]) for near in (NEAR, 10.0 * NEAR)
    )
    return of_throws(
        throws,
        predicted=predicted,
        value=found.value,
        error=found.largest + float(np.max(np.abs(predicted - nearly))),
        components=("time in s", "x in m", "y in m", "angle in rad"),
    )


def _integrated(throw: Throw, near: float) -> list[float]:
    rest = Slowing(throw.inertia).stop(throw.sliding, abs(throw.rim), near)
    place = cmath.rect(rest.slid / theory.DECELERATION, theory.HEADING)
    turned = math.copysign(rest.turned, throw.rim) / theory.DECELERATION / theory.TABLE.contact_radius
    return [rest.time / theory.DECELERATION, place.real, place.imag, turned]


@STUDY.claim(
    "The energy loss of the ring equals the heat of friction",
    equation="(19), (20)",
    kind="conservation",
    resolution=1e-6,
    note="Largest difference at any time, relative to the initial energy. Error: the tolerance, and the change of "
    "the quadrature of μN·P(U, W) without every second sample.",
    basis="reference",
)
def heat(engine: Engine, throws: Throws = RINGS) -> Measured:

    def imbalance(tolerance: float) -> FloatArray:
        found = []
        for throw in throws:
            times = theory.uniform_times(engine, throw)
            sliding, rim = theory.speeds_at(theory.thrown(engine, throw, tolerance), times)
            energy = 0.5 * theory.TABLE.mass * (sliding**2 + throw.inertia * rim**2)
            shares = [mean_directions(*both) for both in zip(sliding, rim, strict=True)]
            power = theory.TABLE.friction_force * np.sum(np.column_stack((sliding, rim)) * shares, axis=1)
            row = []
            for step in (1, 2):
                heat = make_interp_spline(times[::step], power[::step], k=5).antiderivative()
                row.append(np.max(np.abs(energy[0] - energy - heat(times))[::2]) / energy[0])
            found.append(row)
        return np.array(found)

    found = refined(imbalance, TOLERANCE)
    halved = np.abs(found.value[:, 1] - found.value[:, 0])
    error = found.largest + 2.0 * TOLERANCE / theory.SPEED + halved
    return of_throws(throws, predicted=np.zeros(len(throws)), value=found.value[:, 0], error=error)


# --- Existence of a terminal ratio


@STUDY.claim(
    "The ratio of the speeds stays finite only for mR²/2 < J < 2mR²",
    equation="(20)",
    note="Does the closed form of (20) contain a balance of both decelerations? For "
    f"{at_each('J/mR²', theory.INERTIAS)}.",
)
def ratio_exists() -> Measured:

    def has_ratio(inertia: float) -> bool:
        slowing = Slowing(inertia)
        return slowing.unevenness(-LARGEST) < 0.0 < slowing.unevenness(LARGEST)

    return answers_of(
        [has_ratio(inertia) == (0.5 < inertia < 2.0) for inertia in theory.INERTIAS],
        source="assumption: J/(mR²) from 0.1 to 10; limits as Goyal, Ruina and Papadopoulos 1991",
    )


@STUDY.claim(
    "For contact on the whole face of a uniform disc, the balance of both decelerations yields the published ratio",
    equation="(20)",
    resolution=1e-3,
    note="Final ratio of sliding to rim speed, by the mean of the closed form of (20) over all radii; J = mR²/2. "
    "Model error: half of the last published digit.",
)
def published_ratio() -> Measured:
    return Measured(predicted=0.653, value=annulus_ratio(0.0), error=1e-10, model=5e-4, source=PUBLISHED)


PUBLISHED = "Farkas, Bartels, Unger and Wolf 2003; Weidman and Malhotra 2007"

THIN = 1e-3
"""Width of a thin annulus over its outer radius."""


@STUDY.claim(
    "For contact on a uniform annulus, the balance of both decelerations tends to the published ratio of the ring",
    equation="(20)",
    resolution=1e-2,
    note="Final ratio of sliding to rim speed for an inner radius of 0.999 times the outer one. Model error: the "
    "width over the radius; the radius of gyration differs from the outer radius by half of the width.",
)
def published_ratio_of_a_ring() -> Measured:
    return Measured(predicted=1.0, value=annulus_ratio(1.0 - THIN), error=1e-10, model=THIN, source=PUBLISHED)


def annulus_ratio(inner: float) -> float:
    """Return the final ratio U/W of a uniform annulus with the radii ``inner`` and 1."""
    face = Annulus(inner, 1.0, rings=16)

    def unevenness(ratio: float) -> float:
        resistance, moment = face.shares(ratio, 1.0)
        return resistance / ratio - moment / (0.5 * (1.0 + inner**2))

    return float(brentq(unevenness, 0.1, 1.5, xtol=1e-12))
