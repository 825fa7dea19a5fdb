"""How small deviations from the whirl of Fig. 11 grow, on the continuous ring and on single points."""

from __future__ import annotations

import functools
import math
from dataclasses import dataclass, replace

import numpy as np
from scipy.stats import t as student

from compare.claims.answers import holds
from compare.claims.claim import Claim, ErrorBudget
from compare.claims.error_estimates import refined
from compare.claims.linearised_flow import ComplexArray, rotated
from compare.claims.parameters import parameters_of
from compare.engines import Engine
from compare.studies.toolkit.fig11_motion import DISCS, RING, SOURCE
from compare.studies.toolkit.steady_motion import steady_motion
from reference_model import simulate, whirls
from reference_model.contact.contact_law import IsotropicContact, ThreeTermRing
from reference_model.steady.stability import turning_frame_jacobian
from reference_model.systems import ANGLE, DiscOnDisc, FloatArray

AMPLITUDE = 1e-4
"""Of the deviation at its start, in units of the whirl's radius."""

DURATION = 200.0
"""In s: about a period of the modulation, in which the deviation grows by a factor of ten."""

TOLERANCE = 5e-10

WHIRL_TOLERANCE = 1e-13
"""Of the simulations that give the whirl on points."""

FOLLOWED = 900.0
"""In s: by then a deviation has grown to the modulated cycle."""

STEP = 1e-4
"""Of the differences that give its linearised return map, in units of the whirl's radius."""

EXPANSION = ThreeTermRing(RING.contact_radius)

NOTE = (
    f"Rate and frequency of a deviation of {AMPLITUDE:g} radii, followed for {DURATION:g} s to either side: straight "
    "lines through logarithm and phase of its share in the pair of modes. Error: scatter about the lines, the change "
    "with twice the deviation, and at a smaller tolerance."
)

RATE = "A small deviation from the whirl on {} grows at the rate that its linearisation gives"
FREQUENCY = "A small deviation from the whirl on {} swings with the frequency that its linearisation gives"
STABILITY = "The whirl is unstable on the continuous ring and on six points; by (23) it would be stable"
DECAY = "By (23) a small deviation from the whirl dies out as its linearisation says"


@dataclass(frozen=True, eq=False)
class SteadyWhirl:
    """A whirl that comes back turned after each period, and the pair of modes by which it is left.

    On the continuous ring it is a circle, which comes back at any time. On n points it has a ripple besides, which
    repeats whenever the disc has turned by 2π/n against the line from the axis to its centre.

    Parameters
    ----------
    state : array of shape (6,)
        A state on the whirl.
    period : float
        In s.
    turn, advance : float
        Angle in rad by which all has turned about the axis in a period, and by which the disc has turned further.
    eigenvalue : complex
        Growth rate and frequency in 1/s of the pair that decays slowest, with the positive frequency.
    mode, projection : complex array of shape (6,)
        Right and left eigenvector, with a product of 1: of a deviation d, in the axes that turn with the whirl, the
        share projection·d grows with the eigenvalue.

    """

    state: FloatArray
    period: float
    turn: float
    advance: float
    eigenvalue: complex
    mode: ComplexArray
    projection: ComplexArray

    @property
    def radius(self) -> float:
        """Of the circle on which the centre starts, in m."""
        return math.hypot(*self.state[:2])

    def displaced(self, amplitude: float) -> FloatArray:
        """Return the state displaced along the mode by ``amplitude``, in units of the radius."""
        return np.asarray(self.state + amplitude * self.radius * self.mode.real)


@functools.cache
def steady_whirl(disc: DiscOnDisc, contact: IsotropicContact | None = None) -> SteadyWhirl:
    """Return the whirl of ``disc`` without offset under its own law or that of ``contact``.

    On points it is the one next to the circle of the continuous ring.
    """
    ring = replace(disc, contact_points=None)
    circle = whirls(ring, contact)[0]
    if disc.contact_points is not None:
        return _on_points(disc, circle.state)
    values, right = np.linalg.eig(turning_frame_jacobian(ring, circle.state, contact))
    mode, projection = _growing(values, right)
    period = 2.0 * math.pi / circle.frequency
    # The angle, of which nothing depends, does not take part.
    return SteadyWhirl(
        circle.state,
        period,
        2.0 * math.pi,
        circle.spin * period - 2.0 * math.pi,
        next(value for value in circle.eigenvalues if value.imag > 0.0),
        np.insert(mode, ANGLE, 0.0),
        np.insert(projection, ANGLE, 0.0),
    )


def _on_points(disc: DiscOnDisc, guess: FloatArray) -> SteadyWhirl:
    """Return the whirl on points near to the state ``guess``, with its linearised return map by differences."""
    reference = Engine("reference", simulate, ("points",))
    motion = steady_motion(reference, disc, guess, WHIRL_TOLERANCE)
    if motion is None:
        raise RuntimeError(f"no whirl on {disc.contact_points} points near the circle of the ring")
    period, turn = motion.period, motion.frequency * motion.period

    def returned(state: FloatArray) -> FloatArray:
        return rotated(simulate(disc, state, [0.0, period], tolerance=WHIRL_TOLERANCE).at_end, -turn)

    step = STEP * guess[0]
    columns = [
        (returned(motion.state + shift) - returned(motion.state - shift)) / (2.0 * step)
        for shift in step * np.eye(disc.state_size)
    ]
    multipliers, right = np.linalg.eig(np.column_stack(columns))
    values = np.log(multipliers.astype(complex)) / period
    mode, projection = _growing(values, right)
    return SteadyWhirl(
        motion.state, period, turn, motion.spin * period - turn, _pair(values), mode, projection
    )


def _pair(values: ComplexArray) -> complex:
    """Return the eigenvalue of the slowest pair, with the positive imaginary part."""
    return complex(max((value for value in values if value.imag > 0.0), key=lambda value: value.real))


def _growing(values: ComplexArray, right: ComplexArray) -> tuple[ComplexArray, ComplexArray]:
    """Return both eigenvectors of the slowest pair, the right one with its place of length 1."""
    which = int(np.argmin(np.abs(values - _pair(values))))
    left = np.linalg.inv(right)[which]
    size = np.linalg.norm(right[:2, which])
    return np.asarray(right[:, which] / size), np.asarray(left * size)


def deviation(
    engine: Engine, disc: DiscOnDisc, whirl: SteadyWhirl, amplitude: float, tolerance: float
) -> tuple[FloatArray, ComplexArray]:
    """Return times in s, once a period, and the share of the pair in a deviation, 1 at the start.

    Half the difference of two simulations that start on opposite sides of the whirl: its even powers drop out.
    """
    turns = np.arange(round(DURATION / whirl.period) + 1)
    times = turns * whirl.period
    outwards, inwards = (
        rotated(
            engine.simulate(disc, whirl.displaced(sign * amplitude), times, tolerance=tolerance).states,
            -turns * whirl.turn,
        )
        for sign in (1.0, -1.0)
    )
    # The start is the real part of the mode: half of it, and half of its conjugate.
    share = (outwards - inwards) @ whirl.projection / (amplitude * whirl.radius)
    return np.asarray(times, dtype=float), np.asarray(share)


def growth(engine: Engine, disc: DiscOnDisc, whirl: SteadyWhirl) -> tuple[FloatArray, FloatArray]:
    """Return growth rate and frequency of a deviation in 1/s, and their errors, shape (2,).

    Straight lines through ln|q| and the phase of q over time. The error is the 95 % interval that the scatter about
    them gives, the change with a deviation twice as large and that at a smaller tolerance.
    """
    (measured, scatter), (error, _) = refined(
        lambda tolerance: _fitted(*deviation(engine, disc, whirl, AMPLITUDE, tolerance)), TOLERANCE
    )
    larger, _ = _fitted(*deviation(engine, disc, whirl, 2.0 * AMPLITUDE, TOLERANCE))
    return measured, scatter + np.abs(larger - measured) + error


def _fitted(times: FloatArray, share: ComplexArray) -> tuple[FloatArray, FloatArray]:
    """Return the slopes of ln|q| and of the phase of q, and what the scatter leaves open of them."""
    logarithms = np.column_stack((np.log(np.abs(share)), np.unwrap(np.angle(share))))
    matrix = np.column_stack((np.ones_like(times), times))
    inverse = np.linalg.pinv(matrix)
    coefficients = inverse @ logarithms
    freedom = len(times) - 2
    residual = np.linalg.norm(logarithms - matrix @ coefficients, axis=0) / math.sqrt(freedom)
    scatter = float(student.ppf(0.975, freedom)) * float(np.linalg.norm(inverse[1])) * residual
    return coefficients[1], scatter


def growth_claims(engine: Engine, words: str, disc: DiscOnDisc) -> tuple[Claim, Claim]:
    """Return growth rate and frequency of a small deviation from the whirl."""
    whirl = steady_whirl(disc)
    measured, error = growth(engine, disc, whirl)
    linearised = (
        "the eigenvalues in the frame that turns with the whirl"
        if disc.contact_points is None
        else f"the multipliers of the whirl on points, which comes back turned after {whirl.period:.4g} s, by the "
        "reference"
    )
    rate, frequency = (
        Claim(
            sentence.format(words),
            equation="(19)–(21)",
            engine=engine.name,
            predicted=predicted,
            measured=measured[i],
            budget=ErrorBudget(error[i], resolution=share * abs(predicted)),
            parameters=parameters_of(disc),
            source=f"{SOURCE}: 0 here",
            unit="1/s",
            note=f"{NOTE} Predicted: {linearised}.",
            basis="reference",
            named={f"{name} of growth on {words}": 0},
        )
        for i, (sentence, name, predicted, share) in enumerate(
            (
                (RATE, "rate", whirl.eigenvalue.real, 1e-2),
                (FREQUENCY, "frequency", whirl.eigenvalue.imag, 5e-3),
            )
        )
    )
    return rate, frequency


def stability_claims() -> tuple[Claim, Claim]:
    """Return on which contact the whirl is stable, and how a deviation dies out under (23)."""
    expanded = steady_whirl(RING, EXPANSION)
    whirls_of = [*(steady_whirl(disc) for disc in DISCS.values()), expanded]
    reference = Engine("reference by (23)", functools.partial(simulate, contact=EXPANSION), ("ring",))
    measured, error = growth(reference, RING, expanded)
    return (
        Claim(
            STABILITY,
            equation="(19)–(23)",
            engine="theory",
            **holds(np.array((1.0, 1.0, -1.0)) * [whirl.eigenvalue.real for whirl in whirls_of]),
            parameters=parameters_of(RING, without=("contact_points",)),
            source=f"{SOURCE}: 0 here",
            note="Sign of the largest real part, in this order: "
            + ", ".join(f"{whirl.eigenvalue:.5f}" for whirl in whirls_of)
            + " 1/s. So the simplified equations would not have shown the modulated cycle.",
            basis="reference",
        ),
        Claim(
            DECAY,
            equation="(23)",
            engine="theory",
            predicted=(expanded.eigenvalue.real, expanded.eigenvalue.imag),
            measured=measured,
            budget=ErrorBudget(error, resolution=5e-3 * abs(expanded.eigenvalue)),
            parameters=parameters_of(RING) | {"contact_points": "continuous ring by (23)"},
            source=f"{SOURCE}: 0 here",
            unit="1/s",
            note=f"Simulated with the reference. {NOTE}",
            basis="reference",
        ),
    )


def departure(
    engine: Engine, disc: DiscOnDisc, whirl: SteadyWhirl, until: float
) -> tuple[FloatArray, FloatArray]:
    """Return times in s, once a period, and the size of the pair's share in units of the radius.

    The deviation starts ten times as large as that of :func:`deviation`, and is followed beyond where it is small.
    """
    turns = np.arange(round(until / whirl.period) + 1)
    times = turns * whirl.period
    run = engine.simulate(disc, whirl.displaced(10.0 * AMPLITUDE), times, tolerance=1e-8)
    away = rotated(run.states, -turns * whirl.turn) - whirl.state
    away[:, ANGLE] -= turns * whirl.advance
    sizes = np.abs(away @ whirl.projection) / whirl.radius
    return np.asarray(times, dtype=float), np.asarray(sizes)
