"""Figs. 5, 6, 8 and 11 at the size and speed of a clutch: the same motions, with the same verdicts."""

from __future__ import annotations

import functools
from collections.abc import Callable

import numpy as np

from compare.claims.error_estimates import WORKING, refined
from compare.claims.measured import Measured
from compare.claims.paper_parameters import FIG5, FIG8
from compare.claims.study import Study
from compare.engines import Engine
from compare.studies.engines.clutch_scale.parameters import (
    CYCLE_SAMPLES,
    CYCLE_START,
    CYCLE_UNTIL,
    ENDS_TOLERANCE,
    ENDS_UNTIL,
    ENSEMBLE,
    ENSEMBLE_UNTIL,
    REST_OF_DISC,
    SAMPLES,
    SEED,
    SOURCE,
    TO_REST,
    UNTIL,
    VELOCITIES,
    WHIRLING,
    scaled,
)
from compare.studies.engines.clutch_scale.pictures import draw
from compare.studies.engines.clutch_scale.theory import curves, exact_motion, exact_whirl
from compare.studies.engines.clutch_scale.units import CLUTCH
from compare.studies.toolkit.deviations import remaining_transient
from compare.studies.toolkit.fig11_motion import DISCS, integrated
from reference_model import Trajectory, self_centred_equilibria, simulate
from reference_model.formulas.pin import equilibrium_position
from reference_model.steady.stability import equilibrium_eigenvalues
from reference_model.systems import DiscOnDisc, FloatArray, System

STUDY = Study.beside(
    __file__,
    "clutch-scale",
    source=SOURCE.format("Fig. 5"),
    system=scaled(FIG5),
    seconds=1.5,
)
STUDY.provides(figures=draw, curves=curves)


def at_clutch(
    engine: Engine, system: System, start: tuple[float, ...], times: FloatArray, tolerance: float
) -> Trajectory:
    """Return the motion at the scale of a clutch of a ``system`` and ``start`` at ``times`` (s) of the paper's."""
    return engine.simulate(scaled(system), CLUTCH.states(start), CLUTCH.time * times, tolerance=tolerance)


def states_of(
    engine: Engine, system: System, start: tuple[float, ...], times: FloatArray
) -> Callable[[float], FloatArray]:
    """Return the states after the start in the paper's units, shape (len(times) − 1, 4 or 6), by tolerance."""

    def states(tolerance: float) -> FloatArray:
        found = at_clutch(engine, system, start, times, tolerance).states[1:]
        return np.asarray(found / CLUTCH.states(np.ones(found.shape[1])))

    return states


@functools.lru_cache(maxsize=2)
def to_rest(engine: Engine, tolerance: float) -> Trajectory:
    """Return the motion to rest at the scale of a clutch, of which two claims are made."""
    return at_clutch(engine, FIG5, TO_REST, np.linspace(0.0, UNTIL, SAMPLES), tolerance)


@STUDY.claim(
    "At the scale of a clutch the pin of Fig. 5 comes to rest at the position (3)",
    equation="(3)",
    resolution=1e-3,
    note=f"After {CLUTCH.time * UNTIL:g} s and nine stick phases. Error: the change at a smaller tolerance, and what "
    "is left of the slowest transient.",
)
def rests(engine: Engine) -> Measured:
    """Compare where the pin comes to rest with (3)."""
    # Places of the last 40 s, in the paper's units.
    places, error = refined(
        lambda tolerance: (
            to_rest(engine, tolerance).states[-81:, :2] / CLUTCH.states(np.ones(4))[:2] / FIG5.offset
        )
    )
    rate = -max(value.real for value in equilibrium_eigenvalues(FIG5))
    left = remaining_transient(places[:40], places[-1], rate, 20.0)
    motion = to_rest(engine, WORKING)
    return Measured(
        predicted=np.array(equilibrium_position(FIG5)) / FIG5.offset,
        value=places[-1],
        error=float(np.max(error[-1] + left)),
        components=("x/X0", "y/X0"),
        data={
            "states": motion.states / CLUTCH.states(np.ones(4)),
            "sticks": motion.stick_times / CLUTCH.time,
        },
    )


@STUDY.claim(
    "At the scale of a clutch the pin of Fig. 5 sticks and lets go at the times it has at the paper's scale",
    equation="(6), (7)",
    kind="trajectory",
    unit="s",
    resolution=1e-2,
    note="Times of the clutch over 5 ms, which make them those of Fig. 5. Predicted: the reference at the paper's "
    "scale. A stick phase too many or too few shows as a missing number.",
)
def sticks(engine: Engine) -> Measured:
    """Compare all times of stick and release with those of exact friction at the paper's scale."""
    predicted = exact_motion().stick_times

    def measured(tolerance: float) -> FloatArray:
        found = to_rest(engine, tolerance).stick_times / CLUTCH.time
        return found if len(found) == len(predicted) else np.full(len(predicted), np.nan)

    events, error = refined(measured)
    names = [f"{('stick', 'release')[i % 2]} {i // 2 + 1}" for i in range(len(predicted))]
    return Measured(
        predicted=predicted,
        value=events,
        error=float(np.max(error)),
        components=names,
        size=1.0 / FIG5.natural_frequency,
    )


@STUDY.claim(
    "At the scale of a clutch starts of Fig. 5 go to the equilibrium or the whirl as at the paper's scale",
    kind="trajectory",
    resolution=0.5,
    note="1 for an end farther from the axis than 2·X0, 0 otherwise; vx(0) at the paper's scale.",
)
def ends(engine: Engine) -> Measured:
    """Compare the ends of some starts with those at the paper's scale."""
    times = np.array([0.0, ENDS_UNTIL])
    starts = [(FIG5.offset, 0.0, velocity, 0.0) for velocity in VELOCITIES]

    def whirls(found: FloatArray) -> float:
        return float(np.hypot(*found[:2]) > 2.0 * FIG5.offset)

    return Measured(
        predicted=[whirls(simulate(FIG5, start, times).at_end) for start in starts],
        value=[whirls(states_of(engine, FIG5, start, times)(ENDS_TOLERANCE)[-1]) for start in starts],
        at={"vx(0) in m/s": VELOCITIES},
        parameters={"tolerance": ENDS_TOLERANCE},
    )


@STUDY.claim(
    "At the scale of a clutch a pin on the whirl of Fig. 6 is back in its state after the period",
    equation="(17)",
    kind="trajectory",
    resolution=1e-5,
    note="Predicted: the periodic orbit that the reference finds by shooting at the paper's scale to 1e-9 of X0, "
    "which is part of the error.",
)
def whirls(engine: Engine) -> Measured:
    """Compare the state after a period of the whirl with that at its start."""
    orbit = exact_whirl()
    unit = np.array([1.0, 1.0, WHIRLING.disc_speed, WHIRLING.disc_speed]) * FIG5.offset
    states = states_of(engine, WHIRLING, tuple(orbit.state), np.array([0.0, orbit.period]))
    found = refined(lambda tolerance: states(tolerance)[-1] / unit)
    return Measured(
        predicted=orbit.state / unit,
        value=found.value,
        error=float(np.max(found.error)) + 1e-9,
        components=("x/X0", "y/X0", "vx/(ω·X0)", "vy/(ω·X0)"),
        system=scaled(WHIRLING),
        source=SOURCE.format("Fig. 6, μN = 0.12 N"),
    )


@STUDY.claim(
    "At the scale of a clutch the disc of Fig. 8 rests and spins by the balance of forces and moments",
    equation="(19), (20)",
    resolution=1e-6,
    note=f"A disc that starts there, after {CLUTCH.time * REST_OF_DISC:g} s. Rounding of the start: 1e-9.",
)
def spins(engine: Engine) -> Measured:
    """Compare where a disc stays and spins with the balance of forces and moments at the paper's scale."""
    rest = self_centred_equilibria(FIG8)[0]
    unit = (FIG8.offset, FIG8.offset, FIG8.disc_speed)
    start = (rest.x, rest.y, 0.0, 0.0, 0.0, rest.spin)
    states = states_of(engine, FIG8, start, np.array([0.0, REST_OF_DISC]))
    found = refined(lambda tolerance: states(tolerance)[-1, [0, 1, 5]] / unit)
    return Measured(
        predicted=np.array([rest.x, rest.y, rest.spin]) / unit,
        value=found.value,
        error=float(np.max(found.error)) + 1e-9,
        components=("x/X0", "y/X0", "spin/ω"),
        system=scaled(FIG8),
        source=SOURCE.format("Fig. 8"),
    )


@STUDY.claim(
    "At the scale of a clutch a disc on {} moves as (19) says with the parameters of Fig. 11",
    equation="(19), (20)",
    kind="trajectory",
    unit="m, rad, m/s, rad/s",
    resolution=1e-6,
    note="In the units of the paper's scale. Predicted: SciPy on (19) as it is printed, at the paper's scale.",
    each=DISCS,
)
def cycles(engine: Engine, disc: DiscOnDisc) -> Measured:
    """Compare the motion of Fig. 11 with (19) as plain equations at the paper's scale."""
    times = np.linspace(0.0, CYCLE_UNTIL, CYCLE_SAMPLES)
    predicted, rougher = (
        integrated(disc, CYCLE_START, CYCLE_UNTIL, CYCLE_SAMPLES, tolerance)[1:]
        for tolerance in (1e-13, 1e-11)
    )
    found = refined(states_of(engine, disc, CYCLE_START, times))
    return Measured(
        predicted=predicted,
        value=found.value,
        error=float(np.max(found.error)) + float(np.max(np.abs(rougher - predicted))),
        at={"t in s": times[1:]},
        components=("x in m", "y in m", "angle in rad", "vx in m/s", "vy in m/s", "spin in rad/s"),
        system=scaled(disc),
        source=SOURCE.format("Fig. 11"),
    )


@STUDY.claim(
    "At the scale of a clutch each start of an ensemble has the end that it has at the paper's scale",
    kind="trajectory",
    note="Random starts with |x|, |y| < 3·X0 and |vx|, |vy| < 2·ω·X0: the compiled ensemble at both scales.",
)
def shares(starts: int = ENSEMBLE) -> Measured:
    """Compare the ends of random starts at both scales."""
    from reference_model.ensemble import EndState, simulate_ensemble

    drawn = np.random.default_rng(SEED).uniform(-1.0, 1.0, (starts, 4)) * [0.3, 0.3, 0.3, 0.3]
    ends = [
        simulate_ensemble(system, states, duration=time * ENSEMBLE_UNTIL).end
        for system, states, time in (
            (FIG5, drawn, 1.0),
            (scaled(FIG5), CLUTCH.states(drawn), CLUTCH.time),
        )
    ]
    kinds = (EndState.SELF_CENTRED, EndState.WHIRL)
    share = np.array([[np.mean(found == kind) for kind in kinds] for found in ends])
    return Measured(
        predicted=[*share[0], 0.0],
        value=[*share[1], np.mean(ends[0] != ends[1])],
        error=0.5 / starts,
        resolution=1.0 / starts,
        components=("share of the equilibrium", "share of the whirl", "share with another end"),
        note=f"{starts} starts.",
    )
