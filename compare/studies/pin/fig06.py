"""Fig. 6: equilibrium, permanent stick and whirl against the friction force."""

import functools
import math
from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from scipy.interpolate import PchipInterpolator
from scipy.optimize import brentq

from compare.claims.error_estimates import TRUTH, WORKING, known, refined
from compare.claims.measured import Measured, answers_of, asked
from compare.claims.parameters import FIG4, components_of
from compare.claims.study import ByEngine, Data, Figures, Study
from compare.engines import Engine
from compare.output.figures import GREEN, GREY, ORANGE, Axes, axis, curve, engines_in, new_figure, points
from compare.studies.toolkit.measuring import compared
from compare.studies.toolkit.pins import SIZES, exact_whirl, extent, resting, sizes_of, stuck, whirl_of
from reference_model import Orbit, PinOnDisc, last_whirl, simulate, whirl_branch, whirl_orbit
from reference_model.formulas import pin as formulas

FIG6 = replace(FIG4, disc_speed=1.2)

SOURCE = "Fig. 6: Fig. 4 with ω = 1.2 rad/s; the friction forces are our choice, the paper prints no range"

LIMIT = formulas.largest_load_with_equilibrium(FIG6)

WHIRL_LOADS = (0.08, 0.09, 0.1, 0.12, 0.14, 0.16, 0.18, 0.2)
EQUILIBRIUM_LOADS = (0.02, 0.04, 0.06, 0.08, 0.095)
"""μN in N; the paper omits the range, and up to 2·C·X0 shows all motions."""

CYCLE_LOAD, CYCLE_DEVIATION, CYCLE_TURNS = 0.102, 0.01, 5
"""μN in N between C·X0 and the end of the stick–slip cycle, relative distance from the cycle, and number of turns."""

TOLERANCE, ON_THE_WAY = 10.0 * WORKING, 1e-8
"""Tolerances of claims other than the end of the whirl, and of the branch, whose μN are right to 1e-10 N."""

INNERMOST = 0.012  # crossing of the x axis in m that ends the branch


def with_load(load: float) -> PinOnDisc:
    return replace(FIG6, friction_force=float(load))


def curves(innermost: float = INNERMOST, step: float = 0.14) -> Data:
    """Return (3), (9) and the branch of whirls, down to the crossing ``innermost`` (m), against μN."""
    outermost = whirl_orbit(with_load(WHIRL_LOADS[-1]), tolerance=ON_THE_WAY)
    branch = list(whirl_branch(outermost, innermost, step=step))
    loads = LIMIT * np.sin(np.linspace(0.0, 0.5 * np.pi, 101))[:-1]  # closer where (3) is steep
    sticking = np.linspace(LIMIT, WHIRL_LOADS[-1], 101)[1:]
    return {
        "branch load": np.array([orbit.system.friction_force for orbit in branch]),
        "branch extent": np.array([extent(orbit).value for orbit in branch]),
        "branch sticks": np.array([float(len(orbit.trajectory.stick_phases) > 0) for orbit in branch]),
        "equilibrium load": loads,
        "equilibrium radius": np.array([formulas.equilibrium_radius(with_load(load)) for load in loads]),
        "sticking load": sticking,
        "sticking radius": np.array([formulas.sticking_radius(with_load(load)) for load in sticking]),
    }


UNIT_MULTIPLIER_ERROR = 1e-5
"""Error of a multiplier near a fold, from central differences with the relative step ``orbits.CENTRAL``.

Two multipliers meet there, so it is the root of the error of the return map; 3e-6 was observed.
"""


@functools.cache
def load_of_unit_multiplier() -> float:
    """Return the friction force (N) where a second multiplier of the reference's whirl passes 1."""
    orbit = whirl_orbit(with_load(0.08))

    def excess(x: float) -> float:
        nonlocal orbit
        orbit = whirl_orbit(FIG6, guess=orbit, at_crossing=x, samples=2)
        real = sorted(orbit.multipliers, key=lambda multiplier: abs(multiplier - 1.0))
        return float(real[1].real) - 1.0

    x = float(orbit.state[0])
    brentq(excess, 0.85 * x, x, xtol=1e-5 * x)
    return orbit.system.friction_force


@functools.cache
def cycle() -> Orbit:
    """Return the stable stick–slip cycle at ``CYCLE_LOAD``, by continuation of the branch of whirls."""
    *_, orbit = whirl_branch(whirl_orbit(with_load(0.08), tolerance=ON_THE_WAY), 0.06, step=0.4, samples=2)
    return whirl_orbit(replace(FIG6, friction_force=CYCLE_LOAD), guess=orbit)


STUDY = Study.beside(
    __file__, "fig06", words={"innermost": f"{INNERMOST:g}"}, source=SOURCE, system=FIG6, seconds=3.5
)


@STUDY.claim(
    "A pin that starts near the equilibrium (3) comes to rest there, at every friction force up to C·X0",
    equation="(3), (5)",
    unit="m",
    resolution=1e-6 * FIG6.offset,
    swept=("friction_force",),
)
def rests(engine: Engine, loads: Sequence[float] = EQUILIBRIUM_LOADS) -> Measured:
    times = np.linspace(590.0, 600.0, 11)
    found = resting(engine, [with_load(load) for load in loads], times, TOLERANCE, {"μN in N": loads})
    radius = np.hypot(*np.asarray(found.value)[:, -1].T)
    return replace(found, data={"equilibrium loads": loads, "equilibrium radius": radius})


@STUDY.claim(
    "The whirls found by shooting equal those of exact Coulomb friction, at every friction force",
    equation="(17)",
    kind="trajectory",
    unit="s, m",
    resolution=1e-6,
    note="Predicted: shooting with the reference at tolerance 3e-13.",
    swept=("friction_force",),
)
def whirls(engine: Engine, loads: Sequence[float] = WHIRL_LOADS) -> Measured:
    first = [whirl_of(engine, with_load(load), TOLERANCE) for load in loads]
    found = refined(
        lambda tolerance: [sizes_of(whirl_of(engine, one.system, tolerance, one)) for one in first], TOLERANCE
    )
    others = [exact_whirl(with_load(load)) for load in loads]
    miss = max(orbit.residual for orbit in (*first, *others))
    # Near the fold, a residual shifts the orbit more, by the factor 1/(1 − slowest multiplier).
    sharpness = max(1.0 / (1.0 - abs(orbit.multipliers[1])) for orbit in others)
    extents, exact = ([extent(orbit) for orbit in orbits] for orbits in (first, others))
    read = max(one.largest for one in (*extents, *exact))
    return compared(
        [sizes_of(orbit) for orbit in others],
        found,
        error=found.largest + miss * sharpness + 2.0 * read,
        at={"μN in N": loads},
        components=SIZES,
        data=lambda: {"whirl loads": loads, "whirl extents": [one.value for one in extents]},
    )


@STUDY.claim(
    "The whirl ends where a second multiplier of its orbit passes 1",
    kind="trajectory",
    unit="N",
    resolution=1e-8,
    note="This is not in the paper. Measured: the smallest μN on the branch. Predicted: the μN at which a second "
    "multiplier of the reference's whirl passes 1. Because μN is stationary there, an error δ of the position "
    "changes μN only by δ².",
    named={"least load of a whirl": 0},
)
def whirl_ends(engine: Engine) -> Measured:
    fold = last_whirl(with_load(0.08), simulate=engine.simulate, tolerance=WORKING, precision=engine.noise)

    def least_load(tolerance: float) -> float:
        # The load is stationary there, so it changes with the tolerance like its smallest value.
        x = float(fold.state[0])
        return whirl_of(engine, FIG6, tolerance, fold, at_crossing=x, samples=2).system.friction_force

    found = refined(least_load, WORKING).plus(UNIT_MULTIPLIER_ERROR**2)
    return compared(load_of_unit_multiplier(), found, parameters={"friction_force": float(found.value)})


@STUDY.claim(
    "Permanent stick and the whirl exist at the same parameters",
    equation="(9), (17)",
    note="Does a start stuck at half the radius (9) stick for the whole 10 s, and does a start 10 % slower than the "
    "whirl slide for the whole 100 s?",
)
def coexist(engine: Engine) -> Measured:
    held = stuck(FIG6, 0.5 * formulas.sticking_radius(FIG6), 0.0)
    slower = whirl_orbit(FIG6).state * (1.0, 1.0, 1.0, 0.9)
    # A pin without a whirl would stick after about 30 s.
    motions = [(FIG6, held, [0.0, 10.0]), (FIG6, slower, [0.0, 100.0])]

    def sticks_and_slides(tolerance: float) -> list[bool]:
        stays, whirls = engine.simulate_many(motions, tolerance=tolerance)
        return [len(stays.phases) == 1 and bool(stays.stick_phases), not whirls.stick_phases]

    return answers_of(*asked(sticks_and_slides, TOLERANCE))


@STUDY.claim(
    "A small stick–slip cycle exists just above the friction force C·X0",
    kind="trajectory",
    unit="m, m/s",
    resolution=1e-4,
    note="This is not in the paper, which shows only equilibrium, stick and whirl. The start is on the reference's "
    "orbit.",
)
def cycle_exists(engine: Engine) -> Measured:
    orbit = cycle()
    motion = orbit.system, orbit.state, np.linspace(0.0, orbit.period, 65)
    found = refined(lambda tolerance: engine.simulate(*motion, tolerance=tolerance).states, TOLERANCE)
    radius = np.hypot(found.value[:, 0], found.value[:, 1])
    return compared(
        simulate(*motion, tolerance=TRUTH).states,
        found,
        error=found.largest + orbit.residual,
        at={"t in s": motion[-1]},
        components=components_of(orbit.system),
        system=orbit.system,
        data={"cycle load": orbit.system.friction_force, "cycle extent": [np.min(radius), np.max(radius)]},
    )


@STUDY.claim(
    "In each turn, the distance of a pin from the small stick–slip cycle shrinks by the cycle's multiplier",
    kind="trajectory",
    resolution=5e-3,
    note=f"Two pins start with the cycle's state enlarged and reduced by {CYCLE_DEVIATION:g}. Measured: the "
    f"difference of the radii at which they stick, from one stick phase to the next, over {CYCLE_TURNS} turns. "
    "Predicted: the largest multiplier of the reference's orbit except the multiplier of the phase. Error: "
    "tolerance, and "
    "twice the deviation.",
)
def cycle_attracts(engine: Engine) -> Measured:
    orbit = cycle()
    found = refined(lambda tolerance: _decay_in_a_turn(engine, orbit, tolerance, CYCLE_DEVIATION), TOLERANCE)
    # For central differences, the error is a third of the change at twice the deviation.
    wide = _decay_in_a_turn(engine, orbit, TOLERANCE, 2.0 * CYCLE_DEVIATION)
    error = float(found.error) + abs(float(found.value) - wide) + UNIT_MULTIPLIER_ERROR
    return compared(abs(orbit.multipliers[1]), found, error=known(found.value, error), system=orbit.system)


def _decay_in_a_turn(engine: Engine, orbit: Orbit, tolerance: float, deviation: float) -> float:
    """Return the mean factor per turn, or NaN if a pin does not stick once in each turn."""
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


def draw(data: ByEngine) -> Figures:
    figure, (whole, near) = new_figure(ncols=2, width=10.0, height=4.2)
    for panel in (whole, near):
        if "theory" in data:
            _draw_theory(panel, data["theory"])
        for engine in engines_in(data):
            found = data[engine]
            panel.plot(found["equilibrium loads"], found["equilibrium radius"], **points(engine))
            panel.plot(found["whirl loads"], found["whirl extents"], **points(engine, ""))
            if "cycle load" in found:
                panel.plot(np.full(2, found["cycle load"]), found["cycle extent"], **points(engine, ""))
        panel.set(xlabel=axis(r"\mu N", "N"))
    whole.set(ylabel=axis(r"\rho", "m"), xlim=(0.0, WHIRL_LOADS[-1]), ylim=(0.0, None))
    near.set(xlim=(0.07, 0.115), ylim=(0.0, 0.4))
    figure.legend(*whole.get_legend_handles_labels(), loc="outside lower center", ncols=4)
    return {"fig06-branches": figure}


def _draw_theory(panel: Axes, found: Data) -> None:
    style = curve("theory", "equilibrium, eq. (3)")
    panel.plot(found["equilibrium load"], found["equilibrium radius"], **style)
    sticking = found["sticking load"], found["sticking radius"]
    panel.fill_between(*sticking, color=GREY, alpha=0.4, linewidth=0.0, label="permanent stick, (9)")
    # A multiplier passes 1 in each fold. From the outermost whirl on, orbits are therefore stable where the load
    # falls, and unstable where it rises.
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
        panel.plot(load, shown, color=colour, linestyle=dashes, linewidth=1.6, label=(label, "_"))


STUDY.provides(figures=draw, curves=curves)
