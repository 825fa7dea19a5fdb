"""Fig. 6: equilibrium, sticking and whirl under increasing load, and where each of them ends."""

from __future__ import annotations

import functools
import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
from scipy.interpolate import PchipInterpolator
from scipy.optimize import brentq

from compare.claims.answers import asked, holds
from compare.claims.claim import Claim, ErrorBudget
from compare.claims.error_estimates import refined
from compare.claims.paper_parameters import FIG4
from compare.claims.study import Data, Findings, Study
from compare.engines import USUAL_TOLERANCE, Engine
from compare.figures import GREEN, GREY, ORANGE, axis, curve, engines_in, new_figure, points
from compare.studies.toolkit.study_parameters import at_each, parameters_of
from reference_model import Orbit, PinOnDisc, last_whirl, simulate, sticking_radius, whirl_branch, whirl_orbit
from reference_model.formulas.pin import (
    equilibrium_position,
    equilibrium_radius,
    largest_load_with_equilibrium,
)
from reference_model.systems import FloatArray

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

FIG6 = replace(FIG4, disc_speed=1.2)

LIMIT = largest_load_with_equilibrium(FIG6)

WHIRL_LOADS = (0.08, 0.09, 0.1, 0.12, 0.14, 0.16, 0.18, 0.2)
EQUILIBRIUM_LOADS = (0.02, 0.04, 0.06, 0.08, 0.095)
"""μN in N. The paper does not print the range of its axis; 2·C·X0 shows all that happens."""

CYCLE_LOAD = 0.102
"""Between C·X0 and the load at which the stick–slip cycle ends."""

CYCLE_DEVIATION = 0.01
CYCLE_TURNS = 5
"""How far from the cycle pins are started, relative to it, and for how many turns they are followed."""

INNERMOST = 0.012
"""Crossing of the x axis in m down to which the branch is followed towards the axis."""

SHOOTING = 1e-9

ON_THE_WAY = 1e-8
"""Tolerance of the branch that is drawn, and that leads to the cycle; its loads are right to 1e-10 N."""

SOURCE = "Fig. 6: Fig. 4 with ω = 1.2 rad/s; the loads are our choice, the paper prints no range"

EQUILIBRIA = "A pin started near to the equilibrium (3) comes to rest there, at every load up to C·X0"
WHIRLS = "The whirls that the engine finds by shooting are those of exact Coulomb friction, at every load"
LAST_WHIRL = "The whirl ends at the load below which the branch of periodic orbits has none"
COEXIST = "Sticking and the whirl exist for the same parameters"
CYCLE = "Between C·X0 and the load where it ends, a small stick–slip cycle is one more motion"
CYCLE_STABLE = "A pin started beside that cycle comes nearer to it in each turn by the cycle's multiplier"


def measure(
    engine: Engine,
    whirl_loads: Sequence[float] = WHIRL_LOADS,
    equilibrium_loads: Sequence[float] = EQUILIBRIUM_LOADS,
) -> Findings:
    """Find the motions at several loads (μN in N), and the load below which there is no whirl."""
    whirls = {load: whirl(engine, load, SHOOTING) for load in whirl_loads}
    extents = np.array([extent(orbit) for orbit in whirls.values()])
    equilibria = equilibria_claim(engine, equilibrium_loads)
    claims = (
        equilibria,
        whirls_claim(engine, whirls),
        last_whirl_claim(engine),
        coexistence_claim(engine),
        cycle_claim(engine),
        cycle_stability_claim(engine),
    )
    return Findings(
        claims,
        {
            "whirl loads": np.array(whirl_loads),
            "whirl extents": extents,
            "equilibrium loads": np.array(equilibrium_loads),
            "equilibrium radius": np.hypot(*equilibria.measured[:, -1].T),
        },
    )


def theory(innermost: float = INNERMOST, step: float = 0.14) -> Findings:
    """Follow the branch of whirls through its folds with the reference, and evaluate (3) and (9).

    The branch is followed to the crossing ``innermost`` in m, in relative steps of ``step``.
    """
    outermost = whirl_orbit(replace(FIG6, friction_force=WHIRL_LOADS[-1]), tolerance=ON_THE_WAY)
    branch = list(whirl_branch(outermost, innermost, step=step))
    loads = LIMIT * np.sin(np.linspace(0.0, 0.5 * np.pi, 101))[:-1]  # closer where (3) is steep
    sticking = np.linspace(LIMIT, WHIRL_LOADS[-1], 101)[1:]
    return Findings(
        data={
            "branch load": np.array([orbit.system.friction_force for orbit in branch]),
            "branch extent": np.array([extent(orbit) for orbit in branch]),
            "branch sticks": np.array([float(len(orbit.trajectory.stick_phases) > 0) for orbit in branch]),
            "equilibrium load": loads,
            "equilibrium radius": np.array([_at(load, equilibrium_radius) for load in loads]),
            "sticking load": sticking,
            "sticking radius": np.array([_at(load, sticking_radius) for load in sticking]),
        }
    )


def _at(load: float, formula: Callable[[PinOnDisc], float]) -> float:
    return float(formula(replace(FIG6, friction_force=float(load))))


def whirl(engine: Engine, load: float, tolerance: float, guess: Orbit | None = None) -> Orbit:
    """Return the whirl at ``load`` in N, found by shooting with ``engine``."""
    pin = replace(FIG6, friction_force=load)
    return whirl_orbit(pin, simulate=engine.simulate, tolerance=tolerance, guess=guess, samples=64)


def extent(orbit: Orbit) -> FloatArray:
    """Return the least and the greatest distance from the axis in m."""
    radius = orbit.trajectory.radius
    return np.array([np.min(radius), np.max(radius)])


def _rest(engine: Engine, load: float, tolerance: float) -> FloatArray:
    """Return where a pin is at several late times that starts 5 mm beside the equilibrium."""
    pin = replace(FIG6, friction_force=load)
    x, y = equilibrium_position(pin)
    times = np.concatenate(([0.0], np.linspace(590.0, 600.0, 11)))  # one state alone may be right by chance
    return engine.simulate(pin, (x + 0.005, y, 0.0, 0.0), times, tolerance=tolerance).states[1:, :2]


def equilibria_claim(engine: Engine, loads: Sequence[float]) -> Claim:
    """Compare where pins come to rest with (3)."""
    measured, error = refined(lambda tolerance: [_rest(engine, load, tolerance) for load in loads])
    positions = [equilibrium_position(replace(FIG6, friction_force=load)) for load in loads]
    predicted = np.repeat(np.array(positions)[:, np.newaxis], measured.shape[1], axis=1)
    # The slowest deviation decays like exp(−βt/2m); it was 5 mm.
    left = 0.005 * np.exp(-FIG6.damping / (2.0 * FIG6.mass) * 590.0)
    return Claim(
        EQUILIBRIA,
        equation="(3), (5)",
        engine=engine.name,
        predicted=predicted,
        measured=measured,
        budget=ErrorBudget(float(np.max(error)) + left, resolution=1e-6 * FIG6.offset),
        parameters=parameters_of(FIG6, friction_force=loads[-1]),
        source=SOURCE,
        unit="m",
        note=at_each("μN", loads) + " N; x and y of each, at eleven times from 590 to 600 s.",
    )


@functools.cache
def _reference_whirl(load: float) -> Orbit:
    return whirl(Engine("reference", simulate), load, 3e-13)


def whirls_claim(engine: Engine, whirls: Mapping[float, Orbit]) -> Claim:
    """Compare the whirls that ``engine`` found, by load in N, with those of the reference."""

    def period_and_extent(tolerance: float) -> FloatArray:
        orbits = [whirl(engine, load, tolerance, guess) for load, guess in whirls.items()]
        return np.array([[orbit.period, *extent(orbit)] for orbit in orbits])

    measured, error = refined(period_and_extent, SHOOTING)
    others = [_reference_whirl(load) for load in whirls]
    predicted = np.array([[orbit.period, *extent(orbit)] for orbit in others])
    miss = max(orbit.residual for orbit in (*whirls.values(), *others))
    # Near the fold a small miss of the orbit moves it by more: by the inverse of 1 − its slowest multiplier.
    sharpness = max(1.0 / (1.0 - abs(orbit.multipliers[1])) for orbit in others)
    return Claim(
        WHIRLS,
        equation="(17)",
        kind="trajectory",
        engine=engine.name,
        predicted=predicted,
        measured=measured,
        budget=ErrorBudget(float(np.max(error)) + miss * sharpness, resolution=1e-6),
        parameters=parameters_of(FIG6, friction_force=max(whirls)),
        source=SOURCE,
        unit="s, m",
        note=f"Period, least and greatest radius for {at_each('μN', list(whirls))} N. "
        "Predicted: shooting with the reference at tolerance 3e-13.",
    )


def last_whirl_claim(engine: Engine) -> Claim:
    """Compare the smallest load of the branch with the load at which a multiplier is one."""
    predicted = _load_of_unit_multiplier()
    fold = last_whirl(replace(FIG6, friction_force=0.08), simulate=engine.simulate, tolerance=SHOOTING)
    measured, error = refined(
        lambda tolerance: (
            last_whirl(FIG6, simulate=engine.simulate, guess=fold, tolerance=tolerance).system.friction_force
        ),
        SHOOTING,
    )
    return Claim(
        LAST_WHIRL,
        equation="",
        kind="trajectory",
        engine=engine.name,
        predicted=predicted,
        measured=measured,
        budget=ErrorBudget(error + UNIT_MULTIPLIER_ERROR**2, resolution=1e-8),
        parameters=parameters_of(FIG6, friction_force=float(measured)),
        source=SOURCE,
        unit="N",
        note="Not in the paper. Measured: the smallest load on the branch. Predicted: the load at which a second "
        "multiplier of the reference's whirl passes 1 (the load is flat there, so an error δ in where it does "
        "changes the load by δ²).",
        named={"least load of a whirl": 0},
    )


UNIT_MULTIPLIER_ERROR = 1e-5
"""Error of a multiplier from central differences with the relative step ``orbits.CENTRAL``, near a fold.

There two multipliers meet, so that it is the root of that of the return map: 3e-6 was seen.
"""


@functools.cache
def _load_of_unit_multiplier() -> float:
    orbit = whirl_orbit(replace(FIG6, friction_force=0.08))

    def excess(x: float) -> float:
        nonlocal orbit
        orbit = whirl_orbit(FIG6, guess=orbit, at_crossing=x, samples=2)
        real = sorted(orbit.multipliers, key=lambda multiplier: abs(multiplier - 1.0))
        return float(real[1].real) - 1.0

    x = float(orbit.state[0])
    brentq(excess, 0.85 * x, x, xtol=1e-5 * x)
    return orbit.system.friction_force


def coexistence_claim(engine: Engine) -> Claim:
    """See whether one start sticks and the other goes on sliding."""
    stuck = 0.5 * sticking_radius(FIG6)
    orbit = whirl_orbit(FIG6)
    starts = ((stuck, 0.0, 0.0, stuck * FIG6.disc_speed), (*orbit.state[:3], 0.9 * orbit.state[3]))
    # Without a whirl it takes a pin some 30 s to come down from there and stick.
    lengths = (10.0, 100.0)

    def sticks_and_slides(tolerance: float) -> list[bool]:
        stays, whirls = (
            engine.simulate(FIG6, start, [0.0, length], tolerance=tolerance)
            for start, length in zip(starts, lengths, strict=True)
        )
        return [len(stays.phases) == 1 and bool(stays.stick_phases), not whirls.stick_phases]

    return Claim(
        COEXIST,
        equation="(9), (17)",
        engine=engine.name,
        **holds(*asked(sticks_and_slides, USUAL_TOLERANCE)),
        parameters=parameters_of(FIG6),
        source=SOURCE,
        note="Whether a start stuck at half the radius (9) sticks all the time, for 10 s, and one 10 % slower than "
        "the whirl slides all the time, for 100 s.",
    )


@functools.cache
def _cycle() -> Orbit:
    """Return the stable stick–slip cycle at ``CYCLE_LOAD``, reached along the branch of whirls."""
    start = whirl_orbit(replace(FIG6, friction_force=0.08), tolerance=ON_THE_WAY)
    *_, orbit = whirl_branch(start, 0.06, step=0.4, samples=2)
    return whirl_orbit(replace(FIG6, friction_force=CYCLE_LOAD), guess=orbit)


def cycle_claim(engine: Engine) -> Claim:
    """Follow the reference's cycle for a turn."""
    orbit = _cycle()
    times = np.linspace(0.0, orbit.period, 9)
    predicted = simulate(orbit.system, orbit.state, times, tolerance=1e-13).states
    measured, error = refined(
        lambda tolerance: engine.simulate(orbit.system, orbit.state, times, tolerance=tolerance).states
    )
    return Claim(
        CYCLE,
        equation="",
        kind="trajectory",
        engine=engine.name,
        predicted=predicted,
        measured=measured,
        budget=ErrorBudget(float(np.max(error)) + orbit.residual, resolution=1e-4),
        parameters=parameters_of(orbit.system),
        source=SOURCE,
        unit="m, m/s",
        note="Not in the paper, which shows only equilibrium, sticking and whirl. State at nine times of one "
        "period, from the reference's orbit.",
    )


def cycle_stability_claim(engine: Engine) -> Claim:
    """Measure by how much the distance from the cycle falls in a turn."""
    orbit = _cycle()
    measured, error = refined(lambda tolerance: _decay_in_a_turn(engine, orbit, tolerance, CYCLE_DEVIATION))
    # Central differences: a quarter of the error at twice the deviation, which is three times what is left.
    wide = _decay_in_a_turn(engine, orbit, 1e-9, 2.0 * CYCLE_DEVIATION)
    numerical = float(error) + abs(float(measured) - wide) + UNIT_MULTIPLIER_ERROR
    return Claim(
        CYCLE_STABLE,
        equation="",
        kind="trajectory",
        engine=engine.name,
        predicted=abs(orbit.multipliers[1]),
        measured=measured,
        budget=ErrorBudget(numerical if math.isfinite(numerical) else math.inf, resolution=5e-3),
        parameters=parameters_of(orbit.system),
        source=SOURCE,
        note=f"Two pins start with all of the cycle's state larger and smaller by {CYCLE_DEVIATION:g}; the "
        f"distance of the radii at which they stick, from one stick phase to the next, over {CYCLE_TURNS} turns. "
        "Predicted: the largest multiplier of the reference's orbit but that of the phase. Error: tolerance, "
        "and twice the deviation.",
    )


def _decay_in_a_turn(engine: Engine, orbit: Orbit, tolerance: float, deviation: float) -> float:
    """Return the mean factor for a turn, or no number where a pin does not stick once in each turn."""
    times = [0.0, (CYCLE_TURNS + 1.0) * orbit.period]
    ends = []
    for scale in (1.0 + deviation, 1.0 - deviation):
        trajectory = engine.simulate(orbit.system, scale * orbit.state, times, tolerance=tolerance)
        radii = [math.hypot(*phase.initial_state[:2]) for phase in trajectory.stick_phases]
        if len(radii) != CYCLE_TURNS + 1:
            return math.nan
        ends.append((radii[0], radii[-1]))
    (first, last), (first_below, last_below) = ends
    ratio = (last - last_below) / (first - first_below)
    return ratio ** (1.0 / CYCLE_TURNS) if ratio > 0.0 else math.nan


def draw(data: Mapping[str, Data]) -> dict[str, Figure]:
    """Draw the branches over the load, and those near the limit (5) enlarged."""
    figure, (whole, near) = new_figure(ncols=2, width=10.0, height=4.2)
    for panel in (whole, near):
        if "theory" in data:
            _draw_theory(panel, data["theory"])
        for engine in engines_in(data):
            found = data[engine]
            panel.plot(found["equilibrium loads"], found["equilibrium radius"], **points(engine))
            panel.plot(found["whirl loads"], found["whirl extents"], **points(engine, ""))
        panel.set(xlabel=axis(r"\mu N", "N"))
    whole.set(ylabel=axis(r"\rho", "m"), xlim=(0.0, WHIRL_LOADS[-1]), ylim=(0.0, None))
    near.set(xlim=(0.07, 0.115), ylim=(0.0, 0.4))
    handles, labels = whole.get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=4)
    return {"fig06-branches": figure}


def _draw_theory(panel: Axes, found: Data) -> None:
    panel.plot(
        found["equilibrium load"], found["equilibrium radius"], **curve("theory", "equilibrium, eq. (3)")
    )
    panel.fill_between(
        found["sticking load"],
        found["sticking radius"],
        color=GREY,
        alpha=0.4,
        linewidth=0.0,
        label="sticks, (9)",
    )
    # A smooth curve through the orbits. In a fold a multiplier passes 1, so they are stable where the load falls
    # from the outermost whirl on, unstable where it rises.
    number = np.arange(len(found["branch load"]))
    fine = np.linspace(0.0, number[-1], 20 * number[-1] + 1)
    load = PchipInterpolator(number, found["branch load"])(fine)
    extent = PchipInterpolator(number, found["branch extent"])(fine)
    stable = np.gradient(load) < 0.0
    sticks = found["branch sticks"][np.rint(fine).astype(int)] > 0.5
    kinds = (
        ("whirl, stable", stable & ~sticks, GREEN, "-"),
        ("unstable", ~stable, GREY, (0.0, (3.0, 1.5))),
        ("stick–slip cycle, stable", stable & sticks, ORANGE, "-"),
    )
    for label, mask, colour, dashes in kinds:
        shown = np.where(mask[:, np.newaxis], extent, np.nan)
        panel.plot(load, shown[:, 0], color=colour, linestyle=dashes, linewidth=1.6, label=label)
        panel.plot(load, shown[:, 1], color=colour, linestyle=dashes, linewidth=1.6)


STUDY = Study(
    name="fig06",
    title="Branches under increasing load",
    section="The friction pin",
    paper="Fig. 6 shows the steady motions at ω = 1.2 rad/s over the load: the equilibrium (3) up to μN = C·X0, "
    "sticking above it within the radius (9), and the whirl; sticking and whirl exist for the same parameters. "
    "The paper does not say where the whirl ends: it meets an unstable whirl in a fold. That one goes on to "
    "higher loads as a stick–slip orbit, and turns there into a small stable stick–slip cycle, a fourth motion "
    "that bridges the equilibrium's end.",
    measure=measure,
    draw=draw,
    theory=theory,
    figures={
        "fig06-branches": "Fig. 6 redrawn: distance from the axis over the load, for orbits the least and the "
        "greatest one; right: the surroundings of the limit (5), enlarged. Lines: (3), (9), and the branch of "
        "periodic orbits followed by the reference through its folds; marks: what the engines found."
    },
    seconds=7.0,
)
