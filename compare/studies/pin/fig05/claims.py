"""Fig. 5: equilibrium and whirl side by side, the stick phases on the way, and the start that divides them."""

from __future__ import annotations

import functools
import math
from collections.abc import Callable

import numpy as np
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

from compare.claims.answers import asked, holds
from compare.claims.claim import Claim, ErrorBudget
from compare.claims.error_estimates import refined
from compare.claims.paper_parameters import FIG5, FIG5_STARTS
from compare.claims.parameters import parameters_of
from compare.claims.study import Data, Findings, Study
from compare.engines import Engine
from compare.studies.pin.fig05.pictures import animate, draw
from compare.studies.toolkit.deviations import remaining_transient
from reference_model import Orbit, Trajectory, simulate, whirl_orbit
from reference_model.formulas.pin import equilibrium_position, release_time
from reference_model.motion.pin_equations import simulate_polar_form
from reference_model.steady.stability import equilibrium_eigenvalues
from reference_model.systems import FloatArray

Run = Callable[[str, float], Trajectory]
"""Gives the run of Fig. 5 to the motion of that name, at a tolerance."""

UNTIL = 400.0
"""Length of the runs in s; the paper does not print it. The slowest transients are down to 1e-8 by then."""

SAMPLES = 4001

FURTHER_TURNS = 20

SLIDING_START = (0.9, 0.0, 0.0, 0.9)
"""A start near to the whirl, from which the pin slides all the time (our choice)."""

CAPTURE = 1e-6
"""How well the critical initial velocity is to be known, in m/s."""

SOURCE = "Fig. 5 and its printed initial conditions"

SLIDES = "A sliding pin moves for 100 s as (10) says, integrated independently in polar form"
RESTS = "The first start of Fig. 5 ends in the self-centred equilibrium"
WHIRLS = "The second start of Fig. 5 ends on the whirl, whose mean is that of the periodic orbit"
FIRST_STICK = (
    "First stick and release on the way to the {} are where an event on the slip of (10) and (7) say"
)
ALL_STICKS = "All stick and release times on the way to the {} are those of exact Coulomb friction"
CRITICAL = "The critical initial velocity between the two motions of Fig. 5"
SIDES = "Starts 1e-6 m/s below and above the critical velocity end in equilibrium and whirl"


def measure(engine: Engine) -> Findings:
    """Run both starts of Fig. 5 and a sliding one; look at their ends, their stick phases and what divides them."""
    run = functools.cache(functools.partial(_run, engine))
    claims = [
        _claim_slip_trajectory(engine),
        _claim_equilibrium(engine, run),
        _claim_whirl(engine, run),
        *(_claim_first_stick(engine, run, name) for name in FIG5_STARTS),
        *(_claim_all_events(engine, run, name) for name in FIG5_STARTS),
        *_claims_critical_velocity(engine),
    ]
    data: Data = {}
    for name in FIG5_STARTS:
        trajectory = run(name, 1e-9)
        data |= {
            f"{name}: times": trajectory.times,
            f"{name}: states": trajectory.states,
            f"{name}: sticks": trajectory.stick_times,
            f"{name}: reference sticks": reference_events(name),
        }
    return Findings(tuple(claims), data)


def _run(engine: Engine, name: str, tolerance: float) -> Trajectory:
    times = np.linspace(0.0, UNTIL, SAMPLES)
    return engine.simulate(FIG5, FIG5_STARTS[name], times, tolerance=tolerance)


@functools.cache
def reference_events(name: str) -> FloatArray:
    """Return all times in s at which the pin sticks and lets go, from the reference at its tightest."""
    return simulate(FIG5, FIG5_STARTS[name], [0.0, UNTIL], tolerance=1e-13).stick_times


SLIDING_TIMES = np.linspace(0.0, 100.0, 101)


@functools.cache
def _sliding_in_polar_form(tolerance: float) -> FloatArray:
    return simulate_polar_form(FIG5, np.array(SLIDING_START), SLIDING_TIMES, tolerance=tolerance)


def _claim_slip_trajectory(engine: Engine) -> Claim:
    # The other integrator's own error: its change at a larger tolerance.
    predicted, rougher = (_sliding_in_polar_form(tolerance) for tolerance in (3e-14, 2e-13))
    measured, error = refined(
        lambda tolerance: engine.simulate(
            FIG5, SLIDING_START, SLIDING_TIMES, tolerance=tolerance
        ).states.ravel()
    )
    # A single number may be right by chance.
    worst = float(np.max(error + np.abs(rougher - predicted).ravel()))
    return Claim(
        SLIDES,
        equation="(1), (10)",
        kind="trajectory",
        engine=engine.name,
        predicted=predicted.ravel(),
        measured=measured,
        budget=ErrorBudget(worst, resolution=1e-7),
        parameters=parameters_of(FIG5),
        source="Fig. 5; start (0.9, 0, 0, 0.9) is an assumption: near to the whirl, without sticking",
        unit="m, m/s",
        note="All components of the state at 101 times.",
        basis="independent",  # (10) has equations and an integration of its own
        named={"slip for 100 s": None},
    )


def _claim_equilibrium(engine: Engine, run: Run) -> Claim:
    measured, error = refined(lambda tolerance: run("equilibrium", tolerance).at_end[:2])
    states = run("equilibrium", 1e-9).states
    rate = -max(value.real for value in equilibrium_eigenvalues(FIG5))
    left = remaining_transient(states[-700:-300, :2], states[-1, :2], rate, 30.0)
    return Claim(
        RESTS,
        equation="(3)",
        engine=engine.name,
        predicted=equilibrium_position(FIG5),
        measured=measured,
        budget=ErrorBudget(float(np.max(error + left)), resolution=1e-6 * FIG5.offset),
        parameters=parameters_of(FIG5),
        source=SOURCE + f"; t = {UNTIL:g} s",
        unit="m",
    )


@functools.cache
def _whirl() -> Orbit:
    return whirl_orbit(FIG5)


def _claim_whirl(engine: Engine, run: Run) -> Claim:
    orbit = _whirl()
    # The run goes on for some more turns, and the last one is averaged.
    times = np.concatenate(([0.0], orbit.period * (FURTHER_TURNS + np.linspace(0.0, 1.0, 129))))

    def mean(tolerance: float) -> FloatArray:
        states = engine.simulate(FIG5, run("whirl", tolerance).at_end, times, tolerance=tolerance).states
        return np.asarray(states[1:-1, :2].mean(axis=0))

    measured, error = refined(mean)
    multiplier = sorted(abs(value) for value in orbit.multipliers)[-2]  # the largest but that of the phase
    # What is left of the transient after the run, from the largest deviation that it can have had at its start.
    left = float(np.max(np.abs(orbit.state))) * multiplier ** ((UNTIL - 60.0) / orbit.period + FURTHER_TURNS)
    return Claim(
        WHIRLS,
        equation="(17)",
        kind="trajectory",
        engine=engine.name,
        predicted=orbit.mean,
        measured=measured,
        budget=ErrorBudget(float(np.max(error + left)), resolution=1e-6 * FIG5.offset),
        parameters=parameters_of(FIG5),
        source=SOURCE + f"; t = {UNTIL:g} s and {FURTHER_TURNS} turns",
        unit="m",
        note="Predicted: the periodic orbit found by shooting with the reference at its tightest. Remaining "
        "transient: the orbit's slowest multiplier over the time since the last stick phase.",
    )


def _claim_first_stick(engine: Engine, run: Run, name: str) -> Claim:
    predicted, other = refined(lambda tolerance: first_stick_and_release(name, tolerance), 4e-13)
    measured, error = refined(lambda tolerance: _padded(run(name, tolerance).stick_times[:2], 2))
    return Claim(
        FIRST_STICK.format(name),
        equation="(7), (10)",
        kind="trajectory",
        engine=engine.name,
        predicted=predicted,
        measured=measured,
        budget=ErrorBudget(_largest(error + other), resolution=1e-3),
        parameters=parameters_of(FIG5),
        source=SOURCE,
        unit="s",
        basis="independent",  # nothing of the reference's simulation takes part
    )


@functools.cache
def first_stick_and_release(name: str, tolerance: float) -> FloatArray:
    """Return both times from eq. 1 with a plain event on the slip speed, and eq. 7; nothing of ``simulate``.

    The event is at a slip speed s that falls with the tolerance; the slip that is left then lasts for
    s/(μN/m − |a|), where ma is the force that friction must balance in stick.
    """
    m, C, beta, omega = FIG5.mass, FIG5.stiffness, FIG5.damping, FIG5.disc_speed
    limit = 1e4 * tolerance

    def eq1(_: float, state: FloatArray) -> FloatArray:
        x, y, vx, vy = state
        wx, wy = vx + omega * y, vy - omega * x
        friction = FIG5.friction_force / math.hypot(wx, wy)
        return np.array(
            [
                vx,
                vy,
                (-beta * vx - C * (x - FIG5.offset) - friction * wx) / m,
                (-beta * vy - C * y - friction * wy) / m,
            ]
        )

    def slip(_: float, state: FloatArray) -> float:
        x, y, vx, vy = state
        return math.hypot(vx + omega * y, vy - omega * x) - limit

    slip.terminal, slip.direction = True, -1.0  # type: ignore[attr-defined]
    solution = solve_ivp(
        eq1, (0.0, 20.0), FIG5_STARTS[name], method="DOP853", events=slip, rtol=tolerance, atol=tolerance
    )
    x, y = solution.y_events[0][0][:2]
    z = complex(x, y)
    pull = -beta * 1j * omega * z - C * (z - FIG5.offset) + m * omega**2 * z
    left = limit / ((FIG5.friction_force - abs(pull)) / m)
    stick = solution.t_events[0][0] + left
    return np.array([stick, stick + release_time(FIG5, abs(z), math.atan2(y, x) + omega * left)])


def _claim_all_events(engine: Engine, run: Run, name: str) -> Claim:
    predicted = reference_events(name)
    measured, error = refined(lambda tolerance: _padded(run(name, tolerance).stick_times, len(predicted)))
    return Claim(
        ALL_STICKS.format(name),
        equation="(6), (7)",
        kind="trajectory",
        engine=engine.name,
        predicted=predicted,
        measured=measured,
        budget=ErrorBudget(_largest(error), resolution=1e-2),
        parameters=parameters_of(FIG5),
        source=SOURCE,
        unit="s",
        note="Predicted: the reference at tolerance 1e-13. A stick phase too many or too few shows as a "
        "missing number.",
        named={f"events on the way to the {name}": None},
    )


def _padded(events: FloatArray, size: int) -> FloatArray:
    """Return ``events`` if there are ``size`` of them, and no numbers otherwise."""
    return events if len(events) == size else np.full(size, np.nan)


def _largest(error: FloatArray) -> float:
    """Return the largest error; without bounds where one of the runs that give it has no number."""
    return float(np.max(np.nan_to_num(error, nan=np.inf)))


def _claims_critical_velocity(engine: Engine) -> tuple[Claim, Claim]:
    """Find the initial velocity that divides both motions, and see what becomes of its neighbours."""
    predicted = _predicted_critical_velocity()
    measured, error = refined(functools.partial(critical_velocity, engine), 1e-10)
    parameters = parameters_of(FIG5)
    root = Claim(
        CRITICAL,
        equation="",
        kind="trajectory",
        engine=engine.name,
        predicted=predicted,
        measured=measured,
        budget=ErrorBudget(_largest(error), resolution=CAPTURE),
        parameters=parameters,
        source=SOURCE + "; x(0) = 0.1, vx(0) between the two printed values",
        unit="m/s",
        note="Where the second stick phase is as far from the axis as the first. Between slip phases a pin "
        "has one degree of freedom, the radius at which it sticks, so the motions divide at the fixed point of "
        "the map from one stick phase to the next. Predicted: the reference at tolerance 1e-12.",
        named={"dividing velocity": 0},
    )
    tolerance = 1e-7
    ends = Claim(
        SIDES,
        equation="",
        engine=engine.name,
        **holds(*asked(functools.partial(parted, engine), tolerance)),
        parameters=parameters | {"tolerance": tolerance},
        source=SOURCE,
        note="Whether the end is nearer to the axis than 2·X0, then whether it is farther; run to 220 s, from the "
        "engine's own critical velocity.",
        basis="self-check",
    )
    return root, ends


@functools.cache
def _predicted_critical_velocity() -> float:
    return critical_velocity(Engine("reference", simulate), 1e-12)


def critical_velocity(engine: Engine, tolerance: float) -> float:
    """Return vx(0) in m/s at which stick phases neither move outwards nor inwards.

    It is no number for an engine whose pin does not stick twice, or moves the same way from both starts.
    """

    def outward(velocity: float) -> float:
        trajectory = engine.simulate(FIG5, (0.1, 0.0, velocity, 0.0), [0.0, 15.0], tolerance=tolerance)
        radii = [math.hypot(*phase.initial_state[:2]) for phase in trajectory.stick_phases[:2]]
        return radii[1] - radii[0] if len(radii) == 2 else math.nan

    low, high = (start[2] for start in FIG5_STARTS.values())
    if not outward(low) * outward(high) < 0.0:
        return math.nan
    return float(brentq(outward, low, high, xtol=1e-12))


def parted(engine: Engine, tolerance: float) -> FloatArray:
    """Return by how much in m starts beside the engine's critical velocity end inside and outside of 2·X0."""
    middle = critical_velocity(engine, tolerance)
    if not math.isfinite(middle):
        return np.full(2, math.nan)
    return np.array(
        [side * outside_at_end(engine, middle + side * CAPTURE, tolerance) for side in (-1.0, 1.0)]
    )


def outside_at_end(engine: Engine, velocity: float, tolerance: float) -> float:
    """Return how much farther than 2·X0 from the axis the pin with vx(0) = ``velocity`` in m/s is at 220 s, in m."""
    until = 220.0  # 1e-6 m/s grows by a quarter in each turn, and must become of order one
    trajectory = engine.simulate(FIG5, (0.1, 0.0, velocity, 0.0), [0.0, until], tolerance=tolerance)
    return float(trajectory.radius[-1]) - 2.0 * FIG5.offset


STUDY = Study(
    name="fig05",
    title="Equilibrium and whirl side by side",
    section="The friction pin",
    paper="For the same parameters the pin ends in the self-centred equilibrium (3) or on the whirl (17), from "
    "initial conditions that differ by 0.03 m/s: both have limited attraction areas (Fig. 5). On the way it "
    "sticks and slips; the paper leaves stick–slip to later work and gives neither the stick phases nor the "
    "initial condition that divides the two motions. Here both are found.",
    by_hand=measure,
    draw=draw,
    figures={
        "fig05-motions": "Left: Fig. 5 redrawn: equilibrium black, whirl green and dashed, from the reference; "
        "marks: other engines. Middle: distance from the axis over time, stick phases thick. Right: errors of "
        "the stick and release times against the reference at tolerance 1e-13; filled: on the way to the "
        "equilibrium, hollow: to the whirl.",
        "fig05-animation": "The two motions of Fig. 5 on the turning disc. The pin is purple while it sticks.",
    },
    animations=animate,
    seconds=6.0,
    quick=True,
)
