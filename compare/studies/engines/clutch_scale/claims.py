"""Figs. 5, 6, 8 and 11 at the size and speed of a clutch: the same motions, with the same verdicts."""

from __future__ import annotations

import functools
from collections.abc import Mapping
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from compare.claims.claim import Claim, ErrorBudget
from compare.claims.error_estimates import refined
from compare.claims.paper_parameters import FIG4, FIG5, FIG8
from compare.claims.parameters import at_each, parameters_of
from compare.claims.study import Data, Findings, Study
from compare.engines import Engine
from compare.figures import BLACK, PURPLE, axis, engines_in, new_figure, points
from compare.studies.engines.clutch_scale.units import CLUTCH
from compare.studies.toolkit.deviations import remaining_transient
from compare.studies.toolkit.fig11_motion import RING, SIX, integrated
from reference_model import Orbit, Trajectory, self_centred_equilibria, simulate, whirl_orbit
from reference_model.formulas.pin import equilibrium_position
from reference_model.steady.stability import equilibrium_eigenvalues
from reference_model.systems import FloatArray, System

if TYPE_CHECKING:
    from matplotlib.figure import Figure

TO_REST = (0.1, 0.0, 0.0275, 0.0)
"""Near to the start that divides the motions: the pin sticks nine times before it comes to rest in space."""

UNTIL, SAMPLES = 240.0, 481
"""Time of the paper's scale, in s, in which that pin comes to rest, and how often its state is asked for."""

WHIRLING = replace(FIG4, disc_speed=1.2)
"""Fig. 6 at the load 0.12 N."""

REST_OF_DISC = 40.0
"""Time of the paper's scale, in s, for which the disc of Fig. 8 is left where (19) and (20) let it spin."""

CYCLE_START = (0.05, 0.0, 0.4, 0.0, 0.05, 1.3)
"""x, y, angle, vx, vy, spin at the paper's scale of a disc that spirals towards the cycle of Fig. 11, and slides."""

CYCLE_UNTIL, CYCLE_SAMPLES = 60.0, 13
"""Time of the paper's scale, in s, of the motion of Fig. 11, and how often its state is asked for."""

VELOCITIES = (0.0, 0.01, 0.02, 0.026, 0.0275, 0.03, 0.04, 0.06)
"""vx(0) in m/s at the paper's scale of starts that go to either end."""

ENDS_TOLERANCE, ENDS_UNTIL = 1e-7, 150.0

ENSEMBLE, SEED, ENSEMBLE_UNTIL = 1000, 13, 1000.0
"""Random starts of the ensemble, and the time of the paper's scale, in s, in which each comes to its end."""

SOURCE = (
    "{}; X0 = 0.1 mm, ω = 300 rad/s and a mass of 0.5 kg are ours, all dimensionless numbers are the paper's"
)

RESTS = "At the scale of a clutch the pin of Fig. 5 comes to rest at the position (3)"
STICKS = (
    "At the scale of a clutch the pin of Fig. 5 sticks and lets go at the times it has at the paper's scale"
)
ENDS = "At the scale of a clutch starts of Fig. 5 go to the equilibrium or the whirl as at the paper's scale"
WHIRLS = "At the scale of a clutch a pin on the whirl of Fig. 6 is back in its state after the period"
SPINS = "At the scale of a clutch the disc of Fig. 8 rests and spins by the balance of forces and moments"
CYCLES = "At the scale of a clutch a disc on {} moves as (19) says with the parameters of Fig. 11"
SHARES = "At the scale of a clutch each start of an ensemble has the end that it has at the paper's scale"


def measure(engine: Engine) -> Findings:
    """Simulate the four figures at the scale of a clutch, and compare all in the paper's units."""
    discs = {"the continuous ring": RING, "six points": SIX}
    cycles = [
        cycle_claim(engine, name, disc) for name, disc in discs.items() if engine.simulates(scaled(disc))
    ]
    spins = [spins_claim(engine)] if engine.simulates(scaled(FIG8)) else []
    trajectory = at_clutch(engine, FIG5, TO_REST, np.linspace(0.0, UNTIL, SAMPLES), 1e-9)
    data: Data = {
        "states": trajectory.states / CLUTCH.states(np.ones(4)),
        "sticks": trajectory.stick_times / CLUTCH.time,
    }
    claims = (rests_claim(engine), sticks_claim(engine), ends_claim(engine), whirls_claim(engine))
    return Findings((*claims, *spins, *cycles), data, engine.lacking([scaled(FIG8), scaled(SIX)]))


def theory(starts: int = ENSEMBLE) -> Findings:
    """Compare the ends of an ensemble at both scales, and simulate Fig. 5 at the paper's."""
    exact = exact_motion()
    path = simulate(FIG5, TO_REST, np.linspace(0.0, UNTIL, 10 * SAMPLES))
    return Findings(
        (shares_claim(starts),),
        {
            "states": exact.states,
            "path": path.states[:, :2],
            "sticks": exact.stick_times,
            "rest": np.array(equilibrium_position(FIG5)),
        },
    )


def scaled(system: System) -> System:
    """Return ``system`` at the scale of a clutch."""
    return CLUTCH.system(system)


def at_clutch(
    engine: Engine, system: System, start: tuple[float, ...], times: FloatArray, tolerance: float
) -> Trajectory:
    """Return the motion at the scale of a clutch of a ``system`` and ``start`` at ``times`` (s) of the paper's."""
    return engine.simulate(scaled(system), CLUTCH.states(start), CLUTCH.time * times, tolerance=tolerance)


def states_of(
    engine: Engine, system: System, start: tuple[float, ...], times: FloatArray, tolerance: float
) -> FloatArray:
    """Return the states after the start of ``at_clutch`` in the paper's units, shape (len(times) − 1, 4 or 6)."""
    states = at_clutch(engine, system, start, times, tolerance).states[1:]
    return np.asarray(states / CLUTCH.states(np.ones(states.shape[1])))


@functools.cache
def exact_motion() -> Trajectory:
    """Return the motion to rest at the paper's scale, from the reference at its tightest."""
    return simulate(FIG5, TO_REST, np.linspace(0.0, UNTIL, SAMPLES), tolerance=1e-13)


def rests_claim(engine: Engine) -> Claim:
    """Compare where the pin comes to rest with (3)."""
    times = np.append(0.0, np.linspace(UNTIL - 40.0, UNTIL, 81))
    places, error = refined(
        lambda tolerance: states_of(engine, FIG5, TO_REST, times, tolerance)[:, :2] / FIG5.offset
    )
    rate = -max(value.real for value in equilibrium_eigenvalues(FIG5))
    left = remaining_transient(places[:40], places[-1], rate, 20.0)
    return Claim(
        RESTS,
        equation="(3)",
        engine=engine.name,
        predicted=np.array(equilibrium_position(FIG5)) / FIG5.offset,
        measured=places[-1],
        budget=ErrorBudget(_largest(error[-1] + left), resolution=1e-3),
        parameters=parameters_of(scaled(FIG5)),
        source=SOURCE.format("Fig. 5"),
        note=f"x/X0 and y/X0 after {CLUTCH.time * UNTIL:g} s, after nine stick phases. Error: the change at a "
        "smaller tolerance, and what is left of the slowest transient.",
    )


def sticks_claim(engine: Engine) -> Claim:
    """Compare all times of stick and release with those of exact friction at the paper's scale."""
    predicted = exact_motion().stick_times

    def measured(tolerance: float) -> FloatArray:
        times = np.array([0.0, 80.0])
        found = at_clutch(engine, FIG5, TO_REST, times, tolerance).stick_times / CLUTCH.time
        return found if len(found) == len(predicted) else np.full(len(predicted), np.nan)

    events, error = refined(measured)
    return Claim(
        STICKS,
        equation="(6), (7)",
        kind="trajectory",
        engine=engine.name,
        predicted=predicted,
        measured=events,
        budget=ErrorBudget(_largest(error), resolution=1e-2),
        parameters=parameters_of(scaled(FIG5)),
        source=SOURCE.format("Fig. 5"),
        unit="s",
        note="Times of the clutch over 5 ms, which make them those of Fig. 5. Predicted: the reference at the "
        "paper's scale. A stick phase too many or too few shows as a missing number.",
    )


def ends_claim(engine: Engine) -> Claim:
    """Compare the ends of some starts with those at the paper's scale."""
    times = np.array([0.0, ENDS_UNTIL])

    def whirls(found: FloatArray) -> float:
        return float(np.hypot(*found[:2]) > 2.0 * FIG5.offset)

    starts = [(FIG5.offset, 0.0, velocity, 0.0) for velocity in VELOCITIES]
    return Claim(
        ENDS,
        equation="",
        kind="trajectory",
        engine=engine.name,
        predicted=[whirls(simulate(FIG5, start, times).at_end) for start in starts],
        measured=[whirls(states_of(engine, FIG5, start, times, ENDS_TOLERANCE)[-1]) for start in starts],
        budget=ErrorBudget(0.0, resolution=0.5),
        parameters=parameters_of(scaled(FIG5)) | {"tolerance": ENDS_TOLERANCE},
        source=SOURCE.format("Fig. 5"),
        note=f"1 for an end farther from the axis than 2·X0, 0 otherwise; vx(0) over 0.2 is "
        f"{at_each('vx(0)', VELOCITIES)}, in m/s at the paper's scale.",
    )


@functools.cache
def _whirl() -> Orbit:
    return whirl_orbit(WHIRLING)


def whirls_claim(engine: Engine) -> Claim:
    """Compare the state after a period of the whirl with that at its start."""
    orbit = _whirl()
    times, unit = (
        np.array([0.0, orbit.period]),
        np.array([1.0, 1.0, WHIRLING.disc_speed, WHIRLING.disc_speed]),
    )
    states, error = refined(
        lambda tolerance: (
            states_of(engine, WHIRLING, tuple(orbit.state), times, tolerance)[-1] / (unit * FIG5.offset)
        )
    )
    return Claim(
        WHIRLS,
        equation="(17)",
        kind="trajectory",
        engine=engine.name,
        predicted=orbit.state / (unit * FIG5.offset),
        measured=states,
        budget=ErrorBudget(_largest(error) + 1e-9, resolution=1e-5),
        parameters=parameters_of(scaled(WHIRLING)),
        source=SOURCE.format("Fig. 6, μN = 0.12 N"),
        note="x, y over X0 and vx, vy over ω·X0. Predicted: the periodic orbit that the reference finds by shooting "
        "at the paper's scale to 1e-9 of X0, which is part of the error.",
    )


def spins_claim(engine: Engine) -> Claim:
    """Compare where a disc stays and spins with the balance of forces and moments at the paper's scale."""
    rest = self_centred_equilibria(FIG8)[0]
    start = (rest.x, rest.y, 0.0, 0.0, 0.0, rest.spin)
    unit, times = (FIG8.offset, FIG8.offset, FIG8.disc_speed), np.array([0.0, REST_OF_DISC])
    found, error = refined(
        lambda tolerance: states_of(engine, FIG8, start, times, tolerance)[-1, [0, 1, 5]] / unit
    )
    return Claim(
        SPINS,
        equation="(19), (20)",
        engine=engine.name,
        predicted=np.array([rest.x, rest.y, rest.spin]) / unit,
        measured=found,
        budget=ErrorBudget(_largest(error) + 1e-9, resolution=1e-6),
        parameters=parameters_of(scaled(FIG8)),
        source=SOURCE.format("Fig. 8"),
        note=f"x/X0, y/X0 and spin over ω of a disc that starts there, after {CLUTCH.time * REST_OF_DISC:g} s. "
        "Rounding of the start: 1e-9.",
    )


def cycle_claim(engine: Engine, name: str, disc: System) -> Claim:
    """Compare the motion of Fig. 11 with (19) as plain equations at the paper's scale."""
    times = np.linspace(0.0, CYCLE_UNTIL, CYCLE_SAMPLES)
    predicted, rougher = (
        integrated(disc, CYCLE_START, CYCLE_UNTIL, CYCLE_SAMPLES, tolerance)[1:]
        for tolerance in (1e-13, 1e-11)
    )
    states, error = refined(lambda tolerance: states_of(engine, disc, CYCLE_START, times, tolerance))
    return Claim(
        CYCLES.format(name),
        equation="(19), (20)",
        kind="trajectory",
        engine=engine.name,
        predicted=predicted,
        measured=states,
        budget=ErrorBudget(_largest(error) + float(np.max(np.abs(rougher - predicted))), resolution=1e-6),
        parameters=parameters_of(scaled(disc)),
        source=SOURCE.format("Fig. 11"),
        unit="m, rad, m/s, rad/s",
        note="All components of the state at 12 times, in the units of the paper's scale. Predicted: SciPy on (19) "
        "as it is printed, at the paper's scale.",
    )


def shares_claim(starts: int = ENSEMBLE) -> Claim:
    """Compare the ends of random starts at both scales."""
    from reference_model.ensemble import EndState, simulate_ensemble

    random = np.random.default_rng(SEED)
    drawn = random.uniform(-1.0, 1.0, (starts, 4)) * [0.3, 0.3, 0.3, 0.3]
    ends = [
        simulate_ensemble(system, states, duration=time * ENSEMBLE_UNTIL).end
        for system, states, time in (
            (FIG5, drawn, 1.0),
            (scaled(FIG5), CLUTCH.states(drawn), CLUTCH.time),
        )
    ]
    kinds = (EndState.SELF_CENTRED, EndState.WHIRL)
    share = np.array([[np.mean(found == kind) for kind in kinds] for found in ends])
    return Claim(
        SHARES,
        equation="",
        kind="trajectory",
        engine="theory",
        predicted=[*share[0], 0.0],
        measured=[*share[1], np.mean(ends[0] != ends[1])],
        budget=ErrorBudget(0.5 / starts, resolution=1.0 / starts),
        parameters=parameters_of(scaled(FIG5)),
        source=SOURCE.format("Fig. 5"),
        note=f"Shares of the equilibrium and of the whirl among {starts} random starts with |x|, |y| < 3·X0 and "
        "|vx|, |vy| < 2·ω·X0, and the share of the starts with another end: the compiled ensemble at both scales.",
    )


def _largest(error: FloatArray) -> float:
    """Return the largest error; without bounds where a number is missing."""
    return float(np.max(np.nan_to_num(error, nan=np.inf)))


def draw(data: Mapping[str, Data]) -> dict[str, Figure]:
    """Draw the way to rest at both scales, and how far they are apart over time."""
    figure, (plane, history) = new_figure(ncols=2, width=11.0)
    exact = data.get("theory", {})
    micrometres = 1e6 * CLUTCH.length
    milliseconds = 1e3 * CLUTCH.time
    times = milliseconds * np.linspace(0.0, UNTIL, SAMPLES)
    if exact:
        x, y = micrometres * exact["path"].T
        plane.plot(x, y, color=BLACK, linewidth=0.8, label="Fig. 5, its lengths times 1e-3")
        plane.plot(
            *(micrometres * exact["rest"]), marker="*", markersize=12.0, color=PURPLE, label="rest by (3)"
        )
        for start, end in milliseconds * exact["sticks"].reshape(-1, 2):
            history.axvspan(start, end, color=PURPLE, alpha=0.15, linewidth=0.0)
    for engine in engines_in(data):
        found = data[engine]["states"]
        plane.plot(*(micrometres * found[::8, :2].T), **points(engine, markersize=3.0))
        if exact:
            apart = np.hypot(*(found - exact["states"])[:, :2].T) / FIG5.offset
            history.semilogy(times[1::4], np.maximum(apart[1::4], 1e-16), **points(engine, linestyle=":"))
    plane.set(xlabel=axis("x", "µm"), ylabel=axis("y", "µm"), aspect="equal")
    if plane.lines:
        plane.legend(loc="center left", bbox_to_anchor=(1.02, 0.5))
    history.set(xlabel=axis("t", "ms"), ylabel="distance from the line over X0")
    if history.lines:
        history.legend(loc="upper right")
    return {"clutch-scale": figure}


STUDY = Study(
    name="clutch-scale",
    title="The paper's motions at the size of a clutch",
    section="The engines",
    paper="The paper's pins and discs are a metre in size and turn once in four seconds. The numbers that decide are "
    "without dimension, so that the same motions happen in a clutch: an offset of 0.1 mm, 300 rad/s, half a "
    "kilogram. That takes engines whose tolerances, and whose speed below which friction is smoothed, follow the "
    "motion: one that takes them in metres and metres per second gives other motions there without a warning.",
    by_hand=measure,
    theory=theory,
    draw=draw,
    figures={
        "clutch-scale": "Left: a pin with an offset of 100 µm comes to rest at 300 rad/s; the line is Fig. 5's "
        "motion by the reference with all lengths times 1e-3, the marks are the engines. Right: how far the engines "
        "are from that line; while the pin sticks (shaded) the smoothed friction of Exudyn lets it creep.",
    },
    seconds=6.0,
)
