"""Parameters, formulas and claims."""

import functools
import math

import numpy as np
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

from compare.claims.error_estimates import TIGHTEST, TRUTH, WORKING, Measurement, open_where_coarse, refined
from compare.claims.measured import Measured, answers_of, asked
from compare.claims.parameters import FIG5, FIG5_STARTS, components_of
from compare.claims.study import Study
from compare.engines import Engine, reference
from compare.studies.toolkit.deviations import remaining_transient
from compare.studies.toolkit.measuring import compared
from reference_model import Orbit, Trajectory, plain, simulate, whirl_orbit
from reference_model.formulas.pin import equilibrium_position, release_time, squared_holding_force
from reference_model.formulas.pin.polar_form import simulate_polar_form
from reference_model.steady.stability import equilibrium_eigenvalues
from reference_model.systems import FloatArray

SOURCE = "Fig. 5 and its printed initial conditions"

UNTIL = 400.0
"""Duration in s, which the paper omits; the slowest transients then have decayed to 1e-8."""

SAMPLES = 4001

FURTHER_TURNS = 20  # turns of the whirl after a run; the last turn is averaged
SLIDING_START, SLIDING_TIMES = (0.9, 0.0, 0.0, 0.9), np.linspace(0.0, 100.0, 101)
"""Permanent slip near the whirl (our choice)."""

CAPTURE, AFTERWARDS = 1e-6, 220.0
"""Accuracy of the critical velocity in m/s, and duration in s until such a deviation, which grows by a quarter per
turn, is of order one.
"""

RUNS_TOLERANCE, CRITICAL_TOLERANCE = 5.0 * WORKING, WORKING / 5.0
"""Tolerances of runs and of the critical velocity, whose error is a hundred times larger if regularised."""

SIDES_TOLERANCE, BESIDE = 1e-7, 2e-5
"""Tolerance of the first search for the critical velocity, and half width in m/s of the second search."""

LEAST_SHARE = 1e-5
"""Smallest error of stick times, as a share of their resolution.

Stick times of engines with events jump with the tolerance, so their change may be small by chance. Correct engines
deviated by up to 1.2e-6 of the resolution.
"""

STICK_RESOLUTIONS = {"first": 1e-3, "all": 1e-2}
"""Resolutions in s."""


@functools.cache
def whirl() -> Orbit:
    """Return the periodic orbit by shooting with the reference."""
    return whirl_orbit(FIG5)


@functools.cache
def reference_events(name: str) -> FloatArray:
    """Return all stick and release times (s) by the reference at its tightest tolerance."""
    return simulate(FIG5, FIG5_STARTS[name], [0.0, UNTIL], tolerance=TRUTH).stick_times


@functools.cache
def first_stick_and_release(name: str, tolerance: float) -> FloatArray:
    """Return both times from (1) with a simple event on the slip speed, and (7), without ``simulate``.

    The event occurs at a slip speed s. The remaining slip lasts for ms/(μN − F), with the force F that (7) holds.
    """
    omega, limit = FIG5.disc_speed, 1e4 * tolerance
    friction = plain.on_ring(FIG5.friction_force, 0.0, 1, 0.0)

    def slip(_: float, state: FloatArray) -> float:
        x, y, vx, vy = state
        return math.hypot(vx + omega * y, vy - omega * x) - limit

    slip.terminal, slip.direction = True, -1.0  # type: ignore[attr-defined]
    solution = solve_ivp(
        lambda _, state: plain.rates(FIG5, friction, state),
        (0.0, 20.0),
        FIG5_STARTS[name],
        method="DOP853",
        events=slip,
        rtol=tolerance,
        atol=tolerance,
    )
    x, y = solution.y_events[0][0][:2]
    radius, angle = math.hypot(x, y), math.atan2(y, x)
    left = FIG5.mass * limit / (FIG5.friction_force - math.sqrt(squared_holding_force(FIG5, radius, angle)))
    stick = solution.t_events[0][0] + left
    return np.array([stick, stick + release_time(FIG5, radius, angle + omega * left)])


@functools.lru_cache(maxsize=8)
def critical_velocity(engine: Engine, tolerance: float) -> float:
    """Return vx(0) (m/s) that puts the second stick phase as far from the axis as the first.

    It is NaN if a pin does not stick twice, or moves in the same direction from both starts.
    """

    def outward(velocity: float) -> float:
        trajectory = engine.simulate(FIG5, (0.1, 0.0, velocity, 0.0), [0.0, 15.0], tolerance=tolerance)
        radii = [math.hypot(*phase.initial_state[:2]) for phase in trajectory.stick_phases[:2]]
        return radii[1] - radii[0] if len(radii) == 2 else math.nan

    ranges = [tuple(start[2] for start in FIG5_STARTS.values())]
    rough = critical_velocity(engine, SIDES_TOLERANCE) if tolerance < SIDES_TOLERANCE else math.nan
    if math.isfinite(rough):
        ranges.insert(0, (rough - BESIDE, rough + BESIDE))
    for low, high in ranges:
        if outward(low) * outward(high) < 0.0:
            return float(brentq(outward, low, high, xtol=1e-4 * CAPTURE))
    return math.nan


STUDY = Study.beside(__file__, "fig05", source=SOURCE, system=FIG5, seconds=4.5)


@functools.lru_cache(maxsize=8)
def run_of(engine: Engine, name: str, tolerance: float) -> Trajectory:
    times = np.linspace(0.0, UNTIL, SAMPLES)
    return engine.simulate(FIG5, FIG5_STARTS[name], times, tolerance=tolerance)


@STUDY.claim(
    "A pin that slides for 100 s moves according to (10), integrated independently in polar form",
    equation="(1), (10)",
    kind="trajectory",
    unit="m, m/s",
    resolution=1e-7,
    basis="independent",  # separate equations and integration
    named={"slip for 100 s": None},
)
def slides(engine: Engine) -> Measured:
    # The error of the other integrator is its change at a larger tolerance.
    predicted, rougher = (
        simulate_polar_form(FIG5, np.array(SLIDING_START), SLIDING_TIMES, tolerance=tolerance).ravel()
        for tolerance in (3e-14, 2e-13)
    )
    motion = FIG5, SLIDING_START, SLIDING_TIMES
    found = refined(lambda tolerance: engine.simulate(*motion, tolerance=tolerance).states.ravel())
    return compared(
        predicted,
        found,
        error=found.plus(np.abs(rougher - predicted)).largest,
        components=[f"t = {t:g} s, {name}" for t in SLIDING_TIMES for name in components_of(FIG5)],
        source="Fig. 5; start (0.9, 0, 0, 0.9) near the whirl and without stick is our choice",
    )


@STUDY.claim(
    "The first start of Fig. 5 ends in the self-centred equilibrium",
    equation="(3)",
    unit="m",
    resolution=1e-6 * FIG5.offset,
)
def rests(engine: Engine) -> Measured:
    found = refined(lambda tolerance: run_of(engine, "equilibrium", tolerance).at_end[:2], RUNS_TOLERANCE)
    states = run_of(engine, "equilibrium", RUNS_TOLERANCE).states
    rate = -max(value.real for value in equilibrium_eigenvalues(FIG5))
    left = remaining_transient(states[-700:-300, :2], states[-1, :2], rate, 30.0)
    return compared(
        equilibrium_position(FIG5),
        found,
        error=found.plus(left).largest,
        components=("x", "y"),
        source=f"{SOURCE}; t = {UNTIL:g} s",
    )


@STUDY.claim(
    "The second start of Fig. 5 ends on the whirl with the mean position of the periodic orbit",
    equation="(17)",
    kind="trajectory",
    unit="m",
    resolution=1e-6 * FIG5.offset,
    note="Predicted: the periodic orbit by shooting with the reference at its tightest tolerance. Remaining "
    "transient: from the slowest multiplier of the orbit and the time since the last stick phase.",
)
def whirls(engine: Engine) -> Measured:
    orbit = whirl()
    times = np.concatenate(([0.0], orbit.period * (FURTHER_TURNS + np.linspace(0.0, 1.0, 129))))

    def mean(tolerance: float) -> FloatArray:
        end = run_of(engine, "whirl", tolerance).at_end
        states = engine.simulate(FIG5, end, times, tolerance=tolerance).states
        return np.asarray(states[1:-1, :2].mean(axis=0))

    found = refined(mean, RUNS_TOLERANCE)
    multiplier = sorted(map(abs, orbit.multipliers))[-2]  # the largest except the multiplier of the phase
    # The remaining transient follows from the largest possible deviation at the end of stick.
    left = float(np.max(np.abs(orbit.state))) * multiplier ** ((UNTIL - 60.0) / orbit.period + FURTHER_TURNS)
    return compared(
        orbit.mean,
        found,
        error=found.plus(left).largest,
        components=("x", "y"),
        source=f"{SOURCE}; t = {UNTIL:g} s and {FURTHER_TURNS} turns",
    )


@STUDY.claim(
    "On the way to the {}, a pin first sticks when its slip by (10) ends, and is released at the time of (7)",
    equation="(7), (10)",
    kind="trajectory",
    unit="s",
    resolution=STICK_RESOLUTIONS["first"],
    basis="independent",  # without the reference's simulation
    each=tuple(FIG5_STARTS),
)
def first_stick(engine: Engine, name: str) -> Measured:
    predicted = refined(lambda tolerance: first_stick_and_release(name, tolerance), 4e-13)
    found = _events(engine, name, "first", 2)
    return compared(
        predicted.value,
        found,
        error=found.plus(predicted.error).largest,
        components=("stick", "release"),
        size=1.0 / FIG5.natural_frequency,
    )


@STUDY.claim(
    "All stick and release times on the way to the {} equal those of exact Coulomb friction",
    equation="(6), (7)",
    kind="trajectory",
    unit="s",
    resolution=STICK_RESOLUTIONS["all"],
    note="Predicted: the reference at tolerance 1e-13. A missing or additional stick phase makes all numbers "
    "missing.",
    each=tuple(FIG5_STARTS),
)
def all_sticks(engine: Engine, name: str) -> Measured:
    predicted = reference_events(name)
    found = _events(engine, name, "all", len(predicted))
    run = run_of(engine, name, RUNS_TOLERANCE)
    return compared(
        predicted,
        found,
        error=found.largest,
        size=1.0 / FIG5.natural_frequency,
        components=[
            f"{event} no. {i}" for i in range(1, len(predicted) // 2 + 1) for event in ("stick", "release")
        ],
        named={f"events on the way to the {name}": None},
        data={
            f"{name}: times": run.times,
            f"{name}: states": run.states,
            f"{name}: sticks": run.stick_times,
            f"{name}: reference sticks": predicted,
            f"{name}: error bar of sticks": found.largest,
        },
    )


def _events(engine: Engine, name: str, which: str, size: int) -> Measurement:
    def times(tolerance: float) -> FloatArray:
        found = run_of(engine, name, tolerance).stick_times
        events = found[:size] if which == "first" else found
        return events if len(events) == size else np.full(size, np.nan)

    found = refined(times, RUNS_TOLERANCE)
    found = Measurement(found.value, np.maximum(found.error, LEAST_SHARE * STICK_RESOLUTIONS[which]))
    return open_where_coarse(
        found, refined(lambda tolerance: run_of(engine, name, tolerance).states, RUNS_TOLERANCE)
    )


@STUDY.claim(
    "The critical initial velocity between the two motions of Fig. 5 equals that of exact Coulomb friction",
    kind="trajectory",
    unit="m/s",
    resolution=CAPTURE,
    note="At this velocity, the second stick phase is as far from the axis as the first. Between slip phases, a pin "
    "has one degree of freedom, the radius at which it sticks. The boundary between the motions is therefore the "
    "fixed point of the map from one stick phase to the next. Predicted: the reference at tolerance 1e-12.",
    named={"dividing velocity": 0},
)
def critical(engine: Engine) -> Measured:
    source = f"{SOURCE}; x(0) = 0.1, vx(0) between the two printed values"
    return compared(critical_velocity(reference, TIGHTEST), _critical(engine), source=source)


def _critical(engine: Engine) -> Measurement:
    return refined(functools.partial(critical_velocity, engine), CRITICAL_TOLERANCE)


@STUDY.claim(
    "Starts 1e-6 m/s below and above the critical velocity end in the equilibrium and on the whirl",
    note="Is the end of the first start closer to the axis than 2·X0, and the end of the second farther away? Runs "
    "of 220 s from the engine's own critical velocity.",
    basis="self-check",
)
def sides(engine: Engine) -> Measured:
    margins, errors = asked(functools.partial(_parted, engine), SIDES_TOLERANCE)
    if _critical(engine).largest > CAPTURE:  # the motions may divide at another start
        errors = np.full_like(margins, math.inf)
    return answers_of(margins, errors, parameters={"tolerance": SIDES_TOLERANCE})


def _parted(engine: Engine, tolerance: float) -> FloatArray:
    middle = critical_velocity(engine, tolerance)
    if not math.isfinite(middle):
        return np.full(2, math.nan)
    margins = []
    for side in (-1.0, 1.0):
        start = (0.1, 0.0, middle + side * CAPTURE, 0.0)
        run = engine.simulate(FIG5, start, [0.0, AFTERWARDS], tolerance=tolerance)
        margins.append(side * (float(run.radius[-1]) - 2.0 * FIG5.offset))
    return np.array(margins)
