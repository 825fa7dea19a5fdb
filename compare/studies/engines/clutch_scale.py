"""Figs. 5, 6, 8 and 11 at the size and speed of a clutch."""

import functools
from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike

from compare.claims import TRUTH, Measured, Study, refined
from compare.claims.parameters import FIG4, FIG5, FIG8
from compare.engines import Engine
from compare.engines.units import in_units
from compare.studies.toolkit.deviations import remaining_transient
from compare.studies.toolkit.fig11 import DISCS, integrated
from reference_model import Orbit, Trajectory, self_centred_equilibria, simulate, whirl_orbit
from reference_model.formulas.pin import equilibrium_position
from reference_model.steady.stability import equilibrium_eigenvalues
from reference_model.systems import DiscOnDisc, FloatArray, System


@dataclass(frozen=True)
class Scale:
    """Length (m), time (s) and mass (kg) that correspond to 1 m, 1 s and 1 kg of a system."""

    length: float
    time: float
    mass: float

    def system(self, system: System) -> System:
        """Return the scaled ``system``; dimensionless numbers do not change."""
        return in_units(system, self.mass, self.length, self.time)

    def states(self, states: ArrayLike) -> FloatArray:
        """Return scaled ``states`` of shape (..., 4) for a pin or (..., 6) for a disc; angles do not change."""
        states = np.asarray(states, dtype=float)
        places = [self.length, self.length, 1.0][: states.shape[-1] // 2]
        return np.asarray(states * [*places, *(place / self.time for place in places)])


CLUTCH = Scale(length=1e-3, time=1.5 / 300.0, mass=0.5)
"""X0 = 0.1 m becomes 0.1 mm, ω = 1.5 rad/s becomes 300 rad/s, and 1 kg becomes half a kilogram."""


# --- Starts and durations at the paper's scale

TO_REST = (0.1, 0.0, 0.0275, 0.0)
"""Near the critical start: the pin sticks nine times before it comes to rest in space."""

UNTIL, SAMPLES = 240.0, 481
"""Duration in s until this pin rests, and number of samples."""

WHIRLING = replace(FIG4, disc_speed=1.2)
"""The pin of Fig. 6 at 0.12 N."""

REST_OF_DISC = 40.0
"""Duration in s for a disc of Fig. 8 that starts in the equilibrium of (19) and (20)."""

CYCLE_START = (0.05, 0.0, 0.4, 0.0, 0.05, 1.3)
"""x, y, angle, vx, vy, spin of a disc that spirals towards the cycle of Fig. 11."""

CYCLE_UNTIL, CYCLE_SAMPLES = 60.0, 13
"""Duration in s of this motion, and number of samples."""

VELOCITIES = (0.0, 0.02, 0.0275, 0.03, 0.06)
"""Initial vx in m/s of pins that come to rest or reach the whirl."""

ENDS_TOLERANCE, ENDS_UNTIL = 1e-7, 150.0

ENSEMBLE, SEED, ENSEMBLE_UNTIL = 1000, 13, 1000.0
"""Random starts, seed, and duration in s until each has reached its end."""

SOURCE = (
    "{}; X0 = 0.1 mm, ω = 300 rad/s and m = 0.5 kg are our choice, all dimensionless numbers are the paper's"
)


def scaled(system: System) -> System:
    return CLUTCH.system(system)


@functools.cache
def exact_events() -> FloatArray:
    return simulate(FIG5, TO_REST, np.linspace(0.0, UNTIL, SAMPLES), tolerance=TRUTH).stick_times


@functools.cache
def exact_whirl() -> Orbit:
    return whirl_orbit(WHIRLING)


SOURCE_5 = SOURCE.format("Fig. 5")
STUDY = Study.beside(__file__, "clutch-scale", source=SOURCE_5, system=scaled(FIG5), seconds=1.5)


def at_clutch(
    engine: Engine, system: System, start: tuple[float, ...], times: FloatArray, tolerance: float
) -> Trajectory:
    """Return the motion at the scale of a clutch, from arguments at the paper's scale."""
    return engine.simulate(scaled(system), CLUTCH.states(start), CLUTCH.time * times, tolerance=tolerance)


def states_of(
    engine: Engine, system: System, start: tuple[float, ...], times: FloatArray
) -> Callable[[float], FloatArray]:
    """Return a function from a tolerance to the states after the start, in the paper's units."""

    def states(tolerance: float) -> FloatArray:
        found = at_clutch(engine, system, start, times, tolerance).states[1:]
        return np.asarray(found / CLUTCH.states(np.ones(found.shape[1])))

    return states


@functools.lru_cache(maxsize=2)
def to_rest(engine: Engine, tolerance: float) -> Trajectory:
    return at_clutch(engine, FIG5, TO_REST, np.linspace(0.0, UNTIL, SAMPLES), tolerance)


@STUDY.claim(
    "At the scale of a clutch, the pin of Fig. 5 comes to rest at the position (3)",
    equation="(3)",
    resolution=1e-3,
    note=f"After {CLUTCH.time * UNTIL:g} s and nine stick phases. Numerical error: the change at a smaller "
    "tolerance, plus the rest of the slowest transient.",
)
def rests(engine: Engine) -> Measured:
    # The last 40 s in the paper's units.
    places, error = refined(
        lambda tolerance: (
            to_rest(engine, tolerance).states[-81:, :2] / CLUTCH.states(np.ones(4))[:2] / FIG5.offset
        )
    )
    rate = -max(value.real for value in equilibrium_eigenvalues(FIG5))
    left = remaining_transient(places[:40], places[-1], rate, 20.0)
    return Measured(
        predicted=np.array(equilibrium_position(FIG5)) / FIG5.offset,
        value=places[-1],
        error=float(np.max(error[-1] + left)),
        components=("x/X0", "y/X0"),
    )


@STUDY.claim(
    "At the scale of a clutch, the pin of Fig. 5 sticks and is released at the times of the paper's scale",
    equation="(6), (7)",
    kind="trajectory",
    unit="s",
    resolution=1e-2,
    note="Times of the clutch divided by 5 ms, which converts them to the scale of Fig. 5. Predicted: the reference "
    "at the paper's scale. A missing or additional stick phase makes all numbers missing.",
)
def sticks(engine: Engine) -> Measured:
    predicted = exact_events()

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
    "At the scale of a clutch, each start of Fig. 5 ends in the same motion as at the paper's scale",
    kind="trajectory",
    resolution=0.5,
    note="1 if the end is farther from the axis than 2·X0, otherwise 0; vx(0) at the paper's scale.",
)
def ends(engine: Engine) -> Measured:
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
    "At the scale of a clutch, a pin on the whirl of Fig. 6 returns to its state after one period",
    equation="(17)",
    kind="trajectory",
    resolution=1e-5,
    note="Predicted: the periodic orbit of the reference, by shooting at the paper's scale. The accuracy of "
    "this orbit, 1e-9 of X0, is part of the error.",
)
def whirls(engine: Engine) -> Measured:
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
    "At the scale of a clutch, the disc of Fig. 8 rests and spins as the balance of forces and moments predicts",
    equation="(19), (20)",
    resolution=1e-6,
    note=f"A disc that starts in this state, after {CLUTCH.time * REST_OF_DISC:g} s. Rounding of the start: 1e-9.",
    basis="reference",
)
def spins(engine: Engine) -> Measured:
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
    "At the scale of a clutch, a disc on {} with the parameters of Fig. 11 moves according to (19)",
    equation="(19), (20)",
    kind="trajectory",
    unit="m, rad, m/s, rad/s",
    resolution=1e-6,
    note="Measured in the units of the paper's scale. Predicted: SciPy's integration of (19) as printed, at "
    "the paper's "
    "scale.",
    each=DISCS,
)
def cycles(engine: Engine, disc: DiscOnDisc) -> Measured:
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
    "At the scale of a clutch, each start of an ensemble has the same end as at the paper's scale",
    kind="trajectory",
    note="Random starts with |x|, |y| < 3·X0 and |vx|, |vy| < 2·ω·X0, by the compiled ensemble at both scales.",
)
def shares(starts: int = ENSEMBLE) -> Measured:
    from reference_model.ensemble import EndState, simulate_ensemble

    drawn = np.random.default_rng(SEED).uniform(-1.0, 1.0, (starts, 4)) * [0.3, 0.3, 0.3, 0.3]
    motions = (FIG5, drawn, 1.0), (scaled(FIG5), CLUTCH.states(drawn), CLUTCH.time)
    ends = [
        simulate_ensemble(system, states, duration=time * ENSEMBLE_UNTIL).end
        for system, states, time in motions
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
