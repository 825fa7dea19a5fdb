"""Claims on sliding, the growth of small deviations from the whirl, and the modulated cycle."""

import functools
import math
from dataclasses import replace
from typing import Any

import numpy as np
from scipy.special import stdtrit

import compare.studies.disc.fig11.theory as theory
from compare.claims import WORKING, Measured, Measurement, known, refined
from compare.claims.linearised_flow import ComplexArray, rotated
from compare.claims.parameters import components_of
from compare.engines import Engine
from compare.studies.disc.fig11.theory import STUDY, SteadyWhirl, predicted_modulation, steady_whirl
from compare.studies.toolkit.fig11 import DISCS, RING, START, integrated
from compare.studies.toolkit.measuring import compared
from reference_model import Trajectory
from reference_model.contact.contact_law import IsotropicContact
from reference_model.systems import ANGLE, DiscOnDisc, FloatArray

SLIDING_START, SLIDING = (0.02, 0.0, 0.0, 0.0, 0.02, 1.39), np.linspace(0.0, 100.0, 101)
"""All contact points slip for 100 s (our choice)."""

AMPLITUDE, DURATION, TOLERANCE = 1e-4, 200.0, 2000 * WORKING
"""Initial deviation as a share of the whirl's radius, duration in s until it is ten times larger, and tolerance."""

OF_CYCLE = 10 * WORKING  # for the motion that settles on the modulated cycle


GROWTH_NOTE = (
    f"Rate and frequency of a deviation of {AMPLITUDE:g} radii, followed for {DURATION:g} "
    "s to either side, from straight lines through logarithm and phase of its component in the pair of modes. Error: "
    "scatter about the lines, the change with twice the deviation, and at a smaller tolerance."
)


@STUDY.claim(
    "A sliding disc on {} moves for 100 s according to (19) to (21), integrated as printed",
    equation="(19)–(21)",
    kind="trajectory",
    unit="m, rad, m/s, rad/s",
    resolution=1e-8,
    each=tuple(DISCS),
)
def slides(engine: Engine, contact: str) -> Measured:
    disc = DISCS[contact]
    predicted, rougher = (
        integrated(disc, SLIDING_START, SLIDING[-1], len(SLIDING), tolerance) for tolerance in (3e-14, 2e-13)
    )
    motion = disc, SLIDING_START, SLIDING
    found = refined(lambda tolerance: engine.simulate(*motion, tolerance=tolerance).states, 5e-10)
    return compared(
        predicted,
        found,
        error=found.largest + float(np.max(np.abs(rougher - predicted))),
        at={"t in s": SLIDING},
        components=components_of(RING),
        system=disc,
        source=f"{theory.CENTRED}; start {SLIDING_START} is our choice",
        named={f"slip for 100 s on {contact}": None},
    )


@STUDY.claim(
    "A small deviation from the whirl on {} grows at the rate of its linearisation",
    equation="(19)–(21)",
    unit="1/s",
    note=GROWTH_NOTE,
    basis="reference",
    each=tuple(DISCS),
)
def rate_of_growth(engine: Engine, contact: str) -> Measured:
    def data() -> dict[str, FloatArray]:
        return {f"{contact}: departure": departure(engine, DISCS[contact], steady_whirl(DISCS[contact]))}

    return replace(_of_growth(engine, contact, 0, 1e-2, "rate"), data=data)


@STUDY.claim(
    "A small deviation from the whirl on {} oscillates at the frequency of its linearisation",
    equation="(19)–(21)",
    unit="1/s",
    note=GROWTH_NOTE,
    basis="reference",
    each=tuple(DISCS),
)
def frequency_of_growth(engine: Engine, contact: str) -> Measured:
    return _of_growth(engine, contact, 1, 5e-3, "frequency")


def _of_growth(engine: Engine, contact: str, which: int, share: float, name: str) -> Measured:
    found, whirl = growth(engine, DISCS[contact]), steady_whirl(DISCS[contact])
    predicted = (whirl.eigenvalue.real, whirl.eigenvalue.imag)[which]
    note = "Predicted: the eigenvalues in the frame that turns with the whirl."
    if DISCS[contact].contact_points is not None:
        note = "Predicted: the multipliers of the whirl on points, which repeats up to a rotation after "
        note += f"{whirl.period:.4g} s, by the reference."
    return Measured(
        predicted=predicted,
        value=found.value[which],
        error=found.error[which],
        resolution=share * abs(predicted),
        system=DISCS[contact],
        source=theory.CENTRED,
        note=note,
        named={f"{name} of growth on {contact}": 0},
    )


@functools.lru_cache(maxsize=4)
def growth(engine: Engine, disc: DiscOnDisc, contact: IsotropicContact | None = None) -> Measurement:
    """Return growth rate and frequency (1/s) of a deviation from the whirl under the law ``contact``, shape (2,).

    The error is the 95 % interval plus the changes with twice the deviation and at a smaller tolerance.
    """
    whirl = steady_whirl(disc, contact)
    (measured, scatter), (error, _) = refined(
        lambda tolerance: fitted(*deviation(engine, disc, whirl, AMPLITUDE, tolerance)), TOLERANCE
    )
    larger, _ = fitted(*deviation(engine, disc, whirl, 2.0 * AMPLITUDE, TOLERANCE))
    return Measurement(measured, scatter + np.abs(larger - measured) + error)


def deviation(
    engine: Engine, disc: DiscOnDisc, whirl: SteadyWhirl, amplitude: float, tolerance: float
) -> tuple[FloatArray, ComplexArray]:
    """Return times (s), once a period, and the pair's share q of a deviation, 1 at the start.

    Half the difference of two simulations from opposite sides of the whirl has no even powers.
    """
    turns = np.arange(round(DURATION / whirl.period) + 1)
    times = turns * whirl.period
    motions = [(disc, whirl.displaced(sign * amplitude), times) for sign in (1.0, -1.0)]
    outwards, inwards = (
        rotated(run.states, -turns * whirl.turn) for run in engine.simulate_many(motions, tolerance=tolerance)
    )
    # The displacement is the mode's real part, half of the mode, so q = 1 belongs to the whole difference.
    share = (outwards - inwards) @ whirl.projection / (amplitude * whirl.radius)
    return np.asarray(times, dtype=float), np.asarray(share)


def fitted(times: FloatArray, share: ComplexArray) -> tuple[FloatArray, FloatArray]:
    """Return the slopes of ln|q| and of the phase of q, and their 95 % intervals, shape (2,) each."""
    logarithms = np.column_stack((np.log(np.abs(share)), np.unwrap(np.angle(share))))
    matrix = np.column_stack((np.ones_like(times), times))
    inverse = np.linalg.pinv(matrix)
    coefficients = inverse @ logarithms
    freedom = len(times) - 2
    residual = np.linalg.norm(logarithms - matrix @ coefficients, axis=0) / math.sqrt(freedom)
    scatter = float(stdtrit(freedom, 0.975)) * float(np.linalg.norm(inverse[1])) * residual
    return coefficients[1], scatter


def departure(engine: Engine, disc: DiscOnDisc, whirl: SteadyWhirl) -> FloatArray:
    """Return times (s), once a period, and the size of the pair's share divided by the radius, shape (n, 2).

    The deviation starts ten times larger than in :func:`deviation`, and reaches the cycle in 900 s.
    """
    turns = np.arange(round(900.0 / whirl.period) + 1)
    times = turns * whirl.period
    run = engine.simulate(disc, whirl.displaced(10.0 * AMPLITUDE), times, tolerance=1e-6)
    away = rotated(run.states, -turns * whirl.turn) - whirl.state
    away[:, ANGLE] -= turns * whirl.advance
    return np.column_stack((times, np.abs(away @ whirl.projection) / whirl.radius))


# --- The modulated cycle on the ring

CYCLE_NOTE = (
    f"The last modulation within {theory.UNTIL:g} s, from one maximum of the radius to the next. Predicted: "
    "(19) as printed, integrated at a tolerance of 1e-12. Error: the change at a smaller tolerance, and the "
    "change from the previous modulation, in both motions."
)


@STUDY.claim(
    "The modulation on the continuous ring has the period, and the turn per period, of (19)",
    equation="(19)–(21)",
    kind="trajectory",
    unit="s, rad",
    resolution=1e-3,
    note=CYCLE_NOTE,
    named={"period of the modulation": 0, "turn in it": 1},
)
def period_and_turn(engine: Engine) -> Measured:
    data = {"the continuous ring": _run(engine, OF_CYCLE).states}
    return _of_modulation(engine, slice(2), components=("period in s", "turn in rad"), data=data)


@STUDY.claim(
    "The modulated cycle on the continuous ring has the smallest and largest radius and spin of (19)",
    equation="(19)–(21)",
    kind="trajectory",
    unit="m, rad/s",
    resolution=1e-6,
    note=CYCLE_NOTE,
)
def extremes(engine: Engine) -> Measured:
    return _of_modulation(engine, slice(2, None), components=theory.EXTREMES)


def _of_modulation(engine: Engine, part: slice, **more: Any) -> Measured:
    value, error = modulation(engine)
    return compared(predicted_modulation()[0][part], Measurement(value[part], error[part]), **more)


@functools.lru_cache(maxsize=4)
def modulation(engine: Engine) -> Measurement:
    """Return the engine's ``last_modulation``, with the errors of the engine and the prediction."""

    def last(tolerance: float) -> tuple[FloatArray, FloatArray]:
        return theory.last_modulation(_run(engine, tolerance).states)

    found = refined(lambda tolerance: last(tolerance)[0], OF_CYCLE, alike=False)
    error = found.error + predicted_modulation()[1] + last(OF_CYCLE)[1]
    return Measurement(found.value, known(found.value, error))


@functools.lru_cache(maxsize=4)
def _run(engine: Engine, tolerance: float) -> Trajectory:
    return engine.simulate(RING, START, theory.TIMES, tolerance=tolerance)
