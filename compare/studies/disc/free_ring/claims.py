"""A ring thrown on a table at rest: sliding and spinning end together, in a ratio that forgets the start.

Farkas, Bartels, Unger and Wolf (2003), Frictional coupling between sliding and spinning motion, Physical Review
Letters 90, 248302, for the disc; Weidman and Malhotra (2007), On the terminal motion of sliding spinning disks with
uniform Coulomb friction, Physica D 233, for ring, disc and annulus; Goyal, Ruina and Papadopoulos (1991), Wear 143,
331, for all moments of inertia.
"""

from __future__ import annotations

import cmath
import functools
import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike
from scipy.interpolate import make_interp_spline

from compare.claims.claim import Claim, ErrorBudget
from compare.claims.error_estimates import observed_exponent, refined
from compare.claims.paper_parameters import FIG8
from compare.claims.parameters import at_each, parameters_of
from compare.claims.study import Findings, Study
from compare.engines import Engine
from compare.studies.disc.free_ring.pictures import draw
from compare.studies.disc.free_ring.theory import approach_constant, deviation, nearness, theory
from compare.studies.toolkit.free_bodies import NEAR, Slowing
from reference_model import Trajectory
from reference_model.contact.elliptic import mean_directions
from reference_model.systems import DiscOnDisc, FloatArray

TABLE = replace(
    FIG8,
    polar_inertia=FIG8.mass * FIG8.contact_radius**2,
    stiffness=0.0,
    damping=0.0,
    shaft_damping=0.0,
    friction_force=0.1,
    disc_speed=0.0,
    shaft_speed=0.0,
    offset=0.0,
)
"""The ring of Fig. 8 without springs, dampers and shaft on a master disc at rest, J = mR²."""

DECELERATION = TABLE.friction_force / TABLE.mass
"""g of a ring that only slides, in m/s²."""

SPEED = 0.3
"""√(U² + W²) at the start in m/s, U of the centre and W of the rim."""

HEADING = 0.7
"""Direction of the throw in rad from the x axis."""


@dataclass(frozen=True)
class Throw:
    """How a ring is thrown.

    Parameters
    ----------
    inertia : float
        c = J/(mR²).
    degrees : float
        atan(W/U) at the start: 0 only slides, 90 only spins; negative is a spin in the other sense.

    """

    inertia: float
    degrees: float

    @property
    def disc(self) -> DiscOnDisc:
        """The parameters."""
        return replace(TABLE, polar_inertia=self.inertia * TABLE.mass * TABLE.contact_radius**2)

    @property
    def sliding(self) -> float:
        """U at the start in m/s."""
        return 0.0 if abs(self.degrees) == 90.0 else SPEED * math.cos(math.radians(self.degrees))

    @property
    def rim(self) -> float:
        """W at the start in m/s, with its sign."""
        return SPEED * math.sin(math.radians(self.degrees))

    @property
    def state(self) -> FloatArray:
        """The state at the start, shape (6,)."""
        velocity = cmath.rect(self.sliding, HEADING)
        return np.array([0.0, 0.0, 0.0, velocity.real, velocity.imag, self.rim / TABLE.contact_radius])


DEGREES = (8.0, 20.0, -33.0, 57.0, -70.0, 82.0)
RINGS = tuple(Throw(1.0, degrees) for degrees in DEGREES)

OTHERS = tuple(Throw(inertia, degrees) for inertia in (0.7, 0.8, 1.25, 1.4) for degrees in (15.0, -75.0))
"""Bodies on a ring of contact with a terminal ratio that is another than 1, from both sides of it."""

INTEGRATED = (*RINGS, *OTHERS[:2], *OTHERS[-2:])

LOPSIDED = tuple(Throw(inertia, degrees) for inertia in (0.3, 3.0) for degrees in (30.0, 60.0))
"""Beyond the limits of 1/2 and 2."""

PURE = tuple(Throw(inertia, degrees) for inertia in (1.0, 2.5) for degrees in (0.0, -90.0))

INTERVALS = 400
"""Of the time to rest, for the heat and the figure."""

REMAINING = np.array([2e-4, 4e-4, 8e-4, 1.6e-3])
"""Remaining times at which the end is looked at, as fractions of the whole."""

NEARNESSES = (7.0, 9.0)
"""A/t at which the approach to the ratio 1 is looked at."""

ENDING = np.geomspace(1e-3, 3e-2, 10)
"""Remaining times of a power law, as fractions of the whole."""

TOLERANCE = 1e-10

SOURCE = "assumption: the ring of Fig. 8 on a table at rest; load and starts are our choice"
CITED = "; Farkas et al. 2003, Weidman and Malhotra 2007"

TOGETHER = "Sliding and spinning end at the same instant, whatever the start"
RATIO_ONE = "Sliding and rim speed of a ring with J = mR² end in the ratio 1, whatever the start"
APPROACH = "Their ratio comes to 1 like exp(−A/t) with the remaining time t, faster than any power"
RATIO_OTHER = "For mR²/2 < J < 2mR² the ratio ends at the balance of both decelerations, whatever the start"
LOPSIDED_POWERS = (
    "For J < mR²/2 the rim's share, for J > 2mR² the centre's goes to zero as a power of the time left"
)
STOP = "Time and ways to rest are those of the integrals over the ratio"
EXACT = "A ring that only slides or only spins is slowed down by all of the friction"
HEAT = "The energy that the ring loses is the heat of friction"


def measure(
    engine: Engine,
    rings: Sequence[Throw] = RINGS,
    others: Sequence[Throw] = OTHERS,
    integrated: Sequence[Throw] = INTEGRATED,
    lopsided: Sequence[Throw] = LOPSIDED,
) -> Findings:
    """Throw the ring in several ways with ``engine``."""
    ones, ratios = ratio_one_claim(engine, rings), ratio_other_claim(engine, others)
    claims = (
        together_claim(engine, (*rings, *others)),
        ones,
        approach_claim(engine, rings),
        ratios,
        lopsided_claim(engine, lopsided),
        stop_claim(engine, integrated),
        exact_claim(engine),
        heat_claim(engine, rings),
    )
    drawn = [thrown(engine, throw, TOLERANCE) for throw in rings]
    times = [uniform_times(engine, throw) for throw in rings]
    speeds = [speeds_at(trajectory, when) for trajectory, when in zip(drawn, times, strict=True)]
    left = [rest_of(trajectory) - when for trajectory, when in zip(drawn, times, strict=True)]
    return Findings(
        claims,
        {
            "sliding": np.array([sliding for sliding, _ in speeds]),
            "rim": np.array([rim for _, rim in speeds]),
            "approach": np.array(
                [expected_approach(throw) / time for throw, time in zip(rings, left, strict=True)]
            ),
            "inertia": np.array([*(throw.inertia for throw in others), 1.0]),
            "ratio": np.append(ratios.measured, np.mean(ones.measured)),
        },
    )


# ---------------------------------------------------------------- throws


@functools.cache
def roughly_rest(engine: Engine, throw: Throw) -> float:
    """Return about when the ring of ``engine`` rests, in s: it decides at which times it is looked at."""
    longest = 2.0 * max(1.0, throw.inertia) * SPEED / DECELERATION
    found = rest_of(engine.simulate(throw.disc, throw.state, [0.0, longest], tolerance=1e-6))
    return found if math.isfinite(found) else longest


@functools.cache
def thrown(engine: Engine, throw: Throw, tolerance: float) -> Trajectory:
    """Return the motion of a throw, at all times at which it is looked at."""
    rest = roughly_rest(engine, throw)
    times = [
        *uniform_times(engine, throw),
        *(rest * (1.0 - REMAINING)),
        *(rest * (1.0 - ENDING)),
        1.02 * rest,
    ]
    if throw in RINGS:
        times += [*approach_times(engine, throw)]
    return engine.simulate(throw.disc, throw.state, np.unique(times), tolerance=tolerance)


def uniform_times(engine: Engine, throw: Throw) -> FloatArray:
    """Return equally spaced times until the ring rests, in s."""
    return np.linspace(0.0, roughly_rest(engine, throw), INTERVALS + 1)[:-1]


def approach_times(engine: Engine, throw: Throw) -> FloatArray:
    """Return when the remaining time is A over each of the nearnesses, in s."""
    return roughly_rest(engine, throw) - expected_approach(throw) / np.array(NEARNESSES)


@functools.cache
def expected_approach(throw: Throw, near: float = NEAR) -> float:
    """Return A in s."""
    return approach_constant(throw.sliding, abs(throw.rim), near) / DECELERATION


def rest_of(trajectory: Trajectory) -> float:
    """Return when the ring comes to rest in s, no number if it does not."""
    return trajectory.phases[-1].start if trajectory.phases[-1].kind == "stick" else math.nan


def speeds_at(trajectory: Trajectory, times: ArrayLike) -> tuple[FloatArray, FloatArray]:
    """Return U and W in m/s at ``times``, which are among those of the trajectory."""
    states = trajectory.states[[int(np.argmin(np.abs(trajectory.times - time))) for time in np.ravel(times)]]
    return np.hypot(states[:, 3], states[:, 4]), TABLE.contact_radius * np.abs(states[:, 5])


# ---------------------------------------------------------------- claims


def together_claim(engine: Engine, throws: Sequence[Throw]) -> Claim:
    """Extrapolate both speeds to zero."""

    def apart(tolerance: float) -> FloatArray:
        """Return by how much the rest of the centre is later than that of the rim, from two pairs of samples."""
        found = []
        for throw in throws:
            times = roughly_rest(engine, throw) * (1.0 - REMAINING[:3])
            ends = [
                _zeros_between(times, speed) for speed in speeds_at(thrown(engine, throw, tolerance), times)
            ]
            found.append((ends[0] - ends[1]) / roughly_rest(engine, throw))
        return np.array(found)

    measured, error = refined(apart, TOLERANCE)
    # A line through two speeds is zero to within three errors of a speed over its slope, which is above 0.4·g here.
    rests = np.array([roughly_rest(engine, throw) for throw in throws])
    noise = 2.0 * 3.0 * TOLERANCE / (0.4 * DECELERATION) / rests
    # Speeds in a ratio that still changes are no straight lines: from farther away that is seen better.
    bend = np.abs(measured[:, 1] - measured[:, 0])
    return Claim(
        TOGETHER,
        equation="(19), (20)",
        engine=engine.name,
        predicted=np.zeros(len(throws)),
        measured=measured[:, 0],
        budget=ErrorBudget(np.max(error) + noise + bend, resolution=1e-4),
        parameters=parameters_of(TABLE),
        source=SOURCE + CITED,
        note=f"Time by which sliding ends after spinning, over that to rest: U and W, extrapolated in straight lines "
        f"from {at_each('t/T', REMAINING[1::-1])} of it before. {_described(throws)} Error: the change from twice as "
        "far away, and at a smaller tolerance.",
    )


def _zeros_between(times: FloatArray, speeds: FloatArray) -> FloatArray:
    """Return where straight lines through neighbours, the last first, are zero."""
    return times[:-1] + speeds[:-1] * (times[:-1] - times[1:]) / (speeds[1:] - speeds[:-1])


def ratio_one_claim(engine: Engine, throws: Sequence[Throw]) -> Claim:
    """Compare the ratio at the last of the times with 1."""

    def ratio(tolerance: float) -> FloatArray:
        found = []
        for throw in throws:
            sliding, rim = speeds_at(
                thrown(engine, throw, tolerance), roughly_rest(engine, throw) * (1.0 - REMAINING[0])
            )
            found.append(sliding[0] / rim[0])
        return np.array(found)

    measured, error = refined(ratio, TOLERANCE)
    rests = np.array([roughly_rest(engine, throw) for throw in throws])
    farthest = np.array([expected_approach(throw) for throw in throws]) / (REMAINING[0] * rests)
    return Claim(
        RATIO_ONE,
        equation="(19), (20)",
        engine=engine.name,
        predicted=np.ones(len(throws)),
        measured=measured,
        budget=ErrorBudget(
            np.max(error) + ratio_noise(REMAINING[0] * rests),
            model=float(np.max(deviation(farthest))),
            resolution=1e-4,
        ),
        parameters=parameters_of(TABLE),
        source=SOURCE + CITED,
        note=f"U/W when {REMAINING[0]:g} of the time to rest is left. {_described(throws)} Error: the tolerance of "
        "both speeds, and the change at a smaller one. Model error: what the approach to 1 leaves.",
    )


def ratio_noise(left: ArrayLike) -> FloatArray:
    """Return the error of ln U/W that the tolerance of both speeds makes when so much time (s) is left, for c = 1."""
    speed = 2.0 / math.pi * DECELERATION * np.asarray(left)
    return np.asarray(2.0 * TOLERANCE / speed)


def approach_claim(engine: Engine, throws: Sequence[Throw]) -> Claim:
    """Compare A of the approach to the ratio 1 with the integrals."""

    def constants(tolerance: float) -> FloatArray:
        found = []
        for throw in throws:
            trajectory = thrown(engine, throw, tolerance)
            times = approach_times(engine, throw)
            sliding, rim = speeds_at(trajectory, times)
            found.append((rest_of(trajectory) - times) * nearness(np.log(sliding / rim)))
        return np.array(found)

    measured, error = refined(constants, TOLERANCE)
    predicted = np.array([expected_approach(throw) for throw in throws])
    # An error of δ changes L by as much, relative to δ.
    left = predicted[:, np.newaxis] / np.array(NEARNESSES)
    noise = left * ratio_noise(left) / deviation(NEARNESSES)
    # The law of the approach is that of small δ: the integrals tell what it leaves out at the δ of the measurement.
    left_out = [
        abs(expected_approach(throw, float(deviation(NEARNESSES[0]))) - expected_approach(throw))
        for throw in throws
    ]
    return Claim(
        APPROACH,
        equation="(19), (20)",
        engine=engine.name,
        predicted=np.repeat(predicted[:, np.newaxis], len(NEARNESSES), axis=1),
        measured=measured,
        budget=ErrorBudget(
            np.max(error) + noise, model=max(left_out), resolution=1e-2 * float(np.min(predicted))
        ),
        parameters=parameters_of(TABLE),
        source=SOURCE,
        unit="s",
        note=f"A = t·(ln(8/|ln U/W|) − 2) at {at_each('A/t', NEARNESSES)}. {_described(throws)} Predicted by the "
        "integrals over the ratio. Error: the tolerance of both speeds, and the change at a "
        "smaller one. Model error: the change of the integrals if they end at the δ of the measurement.",
        basis="reference",
    )


def ratio_other_claim(engine: Engine, throws: Sequence[Throw]) -> Claim:
    """Extrapolate the ratio of other moments of inertia to the end."""

    def ratios(tolerance: float) -> FloatArray:
        found = []
        for throw in throws:
            sliding, rim = speeds_at(
                thrown(engine, throw, tolerance), roughly_rest(engine, throw) * (1.0 - REMAINING[:4])
            )
            found.append([_limit(*(sliding / rim)[:3]), _limit(*(sliding / rim)[1:])])
        return np.array(found)

    measured, error = refined(ratios, TOLERANCE)
    return Claim(
        RATIO_OTHER,
        equation="(19), (20)",
        engine=engine.name,
        predicted=[math.exp(Slowing(throw.inertia).terminal) for throw in throws],
        measured=measured[:, 0],
        budget=ErrorBudget(np.max(error) + np.abs(measured[:, 1] - measured[:, 0]), resolution=1e-2),
        parameters=parameters_of(TABLE, without=("polar_inertia",)),
        source=SOURCE + CITED,
        note=f"U/W at {at_each('t/T', REMAINING[:3])} of the time to rest, extrapolated to zero as a power. "
        f"{_described(throws)} Predicted: the root of J·∂P/∂U·W = mR²·∂P/∂W·U of the closed form. Error: the change "
        "from twice as far away, and at a smaller tolerance.",
        basis="reference",
    )


def _limit(last: float, middle: float, first: float) -> float:
    """Return the limit of a sequence that approaches it like a geometric one (Aitken)."""
    return float(last - (last - middle) ** 2 / ((last - middle) - (middle - first)))


def lopsided_claim(engine: Engine, throws: Sequence[Throw]) -> Claim:
    """Fit the power with which the ratio goes to zero or to infinity."""
    predicted, measured, errors, models = [], [], [], []
    for throw in throws:
        slow = throw.inertia < 0.5
        power = 0.5 / throw.inertia - 1.0 if slow else 0.5 * throw.inertia - 1.0

        def shares(tolerance: float, throw: Throw = throw, slow: bool = slow) -> FloatArray:
            sliding, rim = speeds_at(
                thrown(engine, throw, tolerance), roughly_rest(engine, throw) * (1.0 - ENDING)
            )
            return rim / sliding if slow else sliding / rim

        share, error = refined(shares, TOLERANCE)
        exponent, numerical, model = observed_exponent(
            ENDING, share, next_term=2.0 * power, noise=float(np.max(error))
        )
        predicted.append(power)
        measured.append(exponent)
        errors.append(numerical)
        models.append(model)
    return Claim(
        LOPSIDED_POWERS,
        equation="(19), (20)",
        engine=engine.name,
        predicted=predicted,
        measured=measured,
        budget=ErrorBudget(errors, model=max(models), resolution=0.05),
        parameters=parameters_of(TABLE, without=("polar_inertia",)),
        source=SOURCE + "; limits as Goyal et al. 1991",
        note=f"Power of W/U ~ t^(mR²/2J − 1) or U/W ~ t^(J/2mR² − 1). {_described(throws)} Fitted to the last "
        f"{ENDING[-1]:g} to {ENDING[0]:g} of the time to rest, with the next term, whose size is the model error.",
    )


def stop_claim(engine: Engine, throws: Sequence[Throw]) -> Claim:
    """Compare rest and ways with the integrals."""

    def measured_stop(tolerance: float) -> FloatArray:
        trajectories = [thrown(engine, throw, tolerance) for throw in throws]
        return np.array([[rest_of(trajectory), *trajectory.at_end[:3]] for trajectory in trajectories])

    measured, error = refined(measured_stop, TOLERANCE)
    predicted, nearly = (
        np.array([_integrated(throw, near) for throw in throws]) for near in (NEAR, 10.0 * NEAR)
    )
    left_out = float(np.max(np.abs(predicted - nearly)))
    return Claim(
        STOP,
        equation="(19), (20)",
        engine=engine.name,
        predicted=predicted,
        measured=measured,
        budget=ErrorBudget(float(np.max(error)) + left_out, resolution=1e-8),
        parameters=parameters_of(TABLE, without=("polar_inertia",)),
        source=SOURCE,
        unit="s, m, rad",
        note=f"Time to rest, x, y and angle there. {_described(throws)} Predicted by integrals over the ratio U/W, "
        "without a step in time.",
        basis="reference",
    )


def _integrated(throw: Throw, near: float) -> list[float]:
    rest = Slowing(throw.inertia).stop(throw.sliding, abs(throw.rim), near)
    place = cmath.rect(rest.slid / DECELERATION, HEADING)
    turned = math.copysign(rest.turned, throw.rim) / DECELERATION / TABLE.contact_radius
    return [rest.time / DECELERATION, place.real, place.imag, turned]


def exact_claim(engine: Engine) -> Claim:
    """Compare throws without spin, and without sliding, with uniform deceleration."""

    def measured_stop(tolerance: float) -> FloatArray:
        trajectories = [thrown(engine, throw, tolerance) for throw in PURE]
        return np.array([[rest_of(trajectory), *trajectory.at_end[:3]] for trajectory in trajectories])

    measured, error = refined(measured_stop, TOLERANCE)
    predicted = []
    for throw in PURE:
        inertia = throw.inertia if throw.sliding == 0.0 else 1.0
        time = inertia * SPEED / DECELERATION
        way = 0.5 * SPEED * time
        place = cmath.rect(way, HEADING) if throw.sliding else 0j
        predicted.append(
            [time, place.real, place.imag, 0.0 if throw.sliding else -way / TABLE.contact_radius]
        )
    return Claim(
        EXACT,
        equation="(19), (20)",
        engine=engine.name,
        predicted=predicted,
        measured=measured,
        budget=ErrorBudget(float(np.max(error)), resolution=1e-7),
        parameters=parameters_of(TABLE, without=("polar_inertia",)),
        source=SOURCE,
        unit="s, m, rad",
        note=f"Time to rest, x, y and angle there: mU/μN and mU²/2μN, or JW/(μN·R²) and JW²/(2μN·R³). "
        f"{_described(PURE)}",
    )


def heat_claim(engine: Engine, throws: Sequence[Throw]) -> Claim:
    """Compare the energy that is lost with the integral of the friction power."""

    def imbalance(tolerance: float) -> FloatArray:
        """Return the largest difference in time, as a fraction of all energy, by all samples and by every second."""
        found = []
        for throw in throws:
            times = uniform_times(engine, throw)
            sliding, rim = speeds_at(thrown(engine, throw, tolerance), times)
            energy = 0.5 * TABLE.mass * (sliding**2 + throw.inertia * rim**2)
            shares = [mean_directions(*both) for both in zip(sliding, rim, strict=True)]
            power = TABLE.friction_force * np.sum(np.column_stack((sliding, rim)) * shares, axis=1)
            row = []
            for step in (1, 2):
                heat = make_interp_spline(times[::step], power[::step], k=5).antiderivative()
                row.append(np.max(np.abs(energy[0] - energy - heat(times))[::2]) / energy[0])
            found.append(row)
        return np.array(found)

    measured, error = refined(imbalance, TOLERANCE)
    return Claim(
        HEAT,
        equation="(19), (20)",
        kind="conservation",
        engine=engine.name,
        predicted=np.zeros(len(throws)),
        measured=measured[:, 0],
        budget=ErrorBudget(
            np.max(error) + 2.0 * TOLERANCE / SPEED + np.abs(measured[:, 1] - measured[:, 0]), resolution=1e-6
        ),
        parameters=parameters_of(TABLE),
        source=SOURCE,
        note=f"Largest difference at any time, as a fraction of the energy at the start. {_described(throws)} "
        "Error: the tolerance, and every second sample left out of the quadrature of μN·P(U, W).",
        basis="reference",
    )


def _described(throws: Sequence[Throw]) -> str:
    inertias, degrees = [throw.inertia for throw in throws], [throw.degrees for throw in throws]
    several = len(set(inertias)) > 1
    moments = f"{at_each('J/mR²', inertias)}; " if several else ""
    return f"Throws: {moments}{at_each('atan(W/U)', degrees)}°."


STUDY = Study(
    name="free-ring",
    title="A ring thrown on a table: sliding and spinning stop together",
    section="The friction disc",
    paper=(
        "Not in the paper, but contained in (19) to (21): without springs, dampers and shaft, on a master disc at "
        "rest, the friction disc is a ring thrown on a table. Published results that do not depend on the paper: "
        "sliding and spinning always stop at the same instant (Farkas, Bartels, Unger and Wolf 2003), and the ratio "
        "of their speeds tends to 1 for a ring, whatever the start (Weidman and Malhotra 2007). For other moments of "
        "inertia on the same ring of contact it tends to another number if J is between mR²/2 and 2mR², and "
        "otherwise to zero or infinity (Goyal, Ruina and Papadopoulos 1991)."
    ),
    by_hand=measure,
    theory=theory,
    draw=draw,
    figures={
        "free-ring": (
            "Left: speeds of the centre and the rim for J = mR², in units of the root of the sum of their squares at "
            "the start; all motions end along the line of the ratio 1. Middle: how the ratio comes to 1, over the "
            "inverse of the remaining time t; all starts fall on the law 8e⁻²·exp(−A/t), which is faster than any "
            "power because friction has an infinite slope there. Right: the ratio in the end over the moment of "
            "inertia."
        ),
    },
    seconds=2.0,
)
