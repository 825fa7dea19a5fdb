"""Claims."""

from __future__ import annotations

import functools
import math
from typing import TYPE_CHECKING

import numpy as np

from compare.claims import WORKING, ByEngine, Figures, Measured, Study, answers_of, asked, known, refined
from compare.claims.parameters import FIG5, FIG5_STARTS
from compare.claims.shares import of_grid
from compare.engines import Engine
from compare.output.figures import BLACK, GREEN, PURPLE, SKY, axis, curve, new_figure
from compare.studies.pin.basins.theory import (
    AFTER,
    ASIDE,
    ASIDE_TOLERANCE,
    ASKED,
    BARELY,
    CELLS,
    FINER,
    FROM_REST,
    ON_BOUNDARY,
    PLACES,
    PLANE,
    REACH,
    RECOMPUTED,
    RECTANGLE,
    SETTLED,
    SIDE,
    SPEEDS,
    STARTS,
    STEP,
    WHERE,
    WITHIN,
    beyond_equilibrium,
    boundary,
    curves,
    distances,
    enclosed,
    ends_on_finer_grid,
    ends_on_grid,
    ensemble_of,
    inside,
    places_on_grid,
    random_places,
    saddle,
    shares_over_speed,
    smooth,
    sought_from,
    starts_at,
)
from reference_model import simulate
from reference_model.ensemble import EndState
from reference_model.orbits.basin_boundary import Separatrix
from reference_model.orbits.release_map import Release, ReleaseMap
from reference_model.systems import FloatArray, PinOnDisc

if TYPE_CHECKING:
    pass


STUDY = Study.beside(
    __file__,
    "basins",
    words={"rectangle": RECTANGLE, "side": f"{SIDE}"},
    source="Fig. 5",
    system=FIG5,
    seconds=4.5,
)


@STUDY.claim(
    "The stick–slip orbit between the two basins of Fig. 5 returns to its start after one period",
    equation="(1), (6)",
    kind="trajectory",
    unit="m, m/s",
    resolution=1e-4,
)
def closes(engine: Engine) -> Measured:
    orbit = saddle(FIG5)
    found = refined(
        lambda tolerance: engine.simulate(FIG5, orbit.state, [0.0, orbit.period], tolerance=tolerance).at_end
    )
    return Measured(
        predicted=orbit.state,
        value=found.value,
        error=found.largest,
        components=("x in m", "y in m", "vx in m/s", "vy in m/s"),
        note=f"Found by the map from release to release: period {orbit.period:.7g} s including "
        f"{orbit.stick_time:.5g} s of stick; multipliers "
        f"{', '.join(f'{abs(value):.5g}' for value in orbit.multipliers)}.",
    )


@STUDY.claim(
    "The stick–slip orbit between the basins has the period, the stick time and the multiplier of its release map",
    equation="(1), (6)",
    kind="trajectory",
    unit="s, 1",
    resolution=1e-3,
    note=f"One turn from release to release, and turns from releases {STEP:g} and {2.0 * STEP:g} rad to either side "
    "for differences of fourth order. Error: the change at a smaller tolerance and with twice these differences.",
    named={"period of the saddle": 0, "stick of the saddle": 1, "multiplier of the saddle": 2},
)
def returns(engine: Engine) -> Measured:
    orbit = saddle(FIG5)
    releases = ReleaseMap(FIG5, ON_BOUNDARY)

    def after(angle: float, tolerance: float) -> Release:
        times = [0.0, 1.5 * orbit.period]
        run = engine.simulate(FIG5, releases.state(angle), times, tolerance=tolerance)
        late = (release for release in releases.along(run) if release.time > 0.5 * orbit.period)
        return next(late, Release(math.nan, math.nan, math.nan))

    @functools.cache
    def slope(reach: float, tolerance: float) -> float:
        ends = [after(orbit.release_angle + side * reach, tolerance).angle for side in (1.0, -1.0)]
        return (ends[0] - ends[1]) / (2.0 * reach)

    def multiplier(reach: float, tolerance: float) -> float:
        return (4.0 * slope(reach, tolerance) - slope(2.0 * reach, tolerance)) / 3.0

    def one_turn(tolerance: float) -> FloatArray:
        middle = after(orbit.release_angle, tolerance)
        return np.array([middle.time, middle.stick_time, multiplier(STEP, tolerance)])

    found = refined(one_turn)
    # For differences of fourth order, twice the step has 16 times the error, so the change is 15 times the error.
    bent = abs(multiplier(2.0 * STEP, WORKING) - found.value[2]) / 7.5
    return Measured(
        predicted=(orbit.period, orbit.stick_time, orbit.multiplier),
        value=found.value,
        error=known(found.value, found.plus(np.array([0.0, 0.0, bent])).error),
        components=("period in s", "stick time in s", "multiplier in 1"),
    )


@STUDY.claim(
    "Starts on either side of the computed boundary end in the equilibrium and on the whirl",
    equation="(3), (17)",
    note=f"Starts {ASIDE:g} inside and outside the boundary, after {AFTER:g} s: is the distance from the position "
    "(3) smaller, or larger, than X0?",
    basis="reference",
)
def parts(engine: Engine, places: int = PLACES) -> Measured:
    rays = np.exp(2j * math.pi * np.arange(places) / places)
    ways = np.column_stack((rays.real, rays.imag))
    within = starts_at(*(WITHIN + np.zeros_like(ways)).T)
    without = starts_at(*(WITHIN + REACH * ways).T)
    divided = Separatrix.of(sought_from(FIG5))
    middle = [divided.point_between(start, end)[[0, 2]] for start, end in zip(within, without, strict=True)]
    sides = starts_at(*np.concatenate((middle - ASIDE * ways, middle + ASIDE * ways)).T)
    outwards = np.repeat((-1.0, 1.0), places)

    def margins(tolerance: float) -> FloatArray:
        runs = engine.simulate_many([(FIG5, start, [0.0, AFTER]) for start in sides], tolerance=tolerance)
        return outwards * [beyond_equilibrium(run.at_end) for run in runs]

    return answers_of(*asked(margins, ASIDE_TOLERANCE), source=FROM_REST, note=f"{2 * places} starts.")


@STUDY.claim(
    "The stable set of the saddle-type orbit separates the starts of the equilibrium from those of the whirl",
    note=f"{SIDE} × {SIDE} starts by the compiled ensemble; the boundary by shooting and cubic splines. Some starts "
    "end as if they were on the other side of the splines. For those of them that are farthest away, shooting "
    "determines the side of the saddle's stable set, and the claim fails for a start if that is not the side of its "
    "end.",
    basis="reference",
)
def divides(side: int = SIDE, cells: int = CELLS) -> Measured:
    curve, places, ends = smooth(boundary(FIG5, cells)), places_on_grid(side), ends_on_grid(FIG5, side)
    other = ends.ravel() != np.where(inside(places, curve), EndState.SELF_CENTRED, EndState.WHIRL)
    beyond, whirled = places[other], ends.ravel()[other] == EndState.WHIRL
    off = distances(beyond, curve)
    farthest = np.argsort(off)[: -ASKED - 1 : -1]
    sides = Separatrix.of(saddle(FIG5))  # far tighter than the required margin
    misses = np.array([sides.miss(start) for start in starts_at(*beyond[farthest].T)])
    before, behind = sides.ends
    as_it_ended = np.where(whirled[farthest] == (behind > before), misses, -misses)
    how_far = f", none farther than {off.max():.2g} from it" if len(off) else ""
    # The others match their side of the curve, or are closer to it than the starts for shooting.
    margins = np.concatenate((as_it_ended, np.ones(len(places) - len(farthest))))
    return answers_of(
        margins,
        BARELY,
        source=FROM_REST,
        note=f"The boundary consists of {len(boundary(FIG5, cells)) - 1} starts that lead to the saddle; {len(off)} "
        f"starts do not match their side of the splines{how_far}; shooting checked {len(farthest)} of these.",
    )


@STUDY.claim(
    "The share of starts that end in the equilibrium equals the share of the area inside the boundary, at both "
    "speeds",
    resolution=2e-3,
    note=f"{SIDE} × {SIDE} starts by the compiled ensemble, and a grid {FINER} times as dense in cells with "
    "different ends; the boundary by shooting. Numerical error: half of the finer cells that contain the boundary.",
    basis="reference",
    swept=("disc_speed",),
)
def area(side: int = SIDE, cells: int = CELLS, pins: tuple[PinOnDisc, ...] = tuple(WHERE)) -> Measured:
    whole = math.prod(high - low for low, high in PLANE)
    shares = [of_grid(ends_on_finer_grid(pin, side))[EndState.SELF_CENTRED] for pin in pins]
    return Measured(
        predicted=[enclosed(smooth(boundary(pin, cells))) / whole for pin in pins],
        value=[share.value for share in shares],
        error=[0.5 * (share.high - share.low) for share in shares],
        at={"ω in rad/s": [pin.disc_speed for pin in pins]},
        source=f"Fig. 5; starts in {RECTANGLE}",
        named={f"share at {pin.disc_speed:g} rad/s": i for i, pin in enumerate(pins)},
    )


@STUDY.claim(
    "The plain reference and the compiled ensemble find the same ends",
    equation="(1), (6)",
    kind="trajectory",
    note=f"{RECOMPUTED} starts, half of them within {ASIDE:g} of the boundary.",
)
def recomputes(count: int = RECOMPUTED, starts: int = STARTS, cells: int = CELLS) -> Measured:
    curve, (places, random) = smooth(boundary(FIG5, cells)), random_places(starts)
    near = curve[random.integers(len(curve), size=count // 2)]
    near = near + random.uniform(-ASIDE, ASIDE, (count // 2, 2))
    chosen = starts_at(*np.concatenate((places[: count // 2], near)).T)
    found = ensemble_of(chosen).end
    return answers_of(
        [
            (beyond_equilibrium(simulate(FIG5, start, [0.0, SETTLED]).at_end) > 0.0)
            == (end == EndState.WHIRL)
            for start, end in zip(chosen, found, strict=True)
        ],
        source="Fig. 5; random starts, half of them near the boundary",
    )


@STUDY.claim(
    "The basin of the self-centred equilibrium shrinks as ω grows",
    note=f"Is the share of the same {STARTS} random starts at each of {len(SPEEDS)} speeds not larger than at the "
    "previous one?",
    basis="independent",
    swept=("disc_speed",),
)
def shrinks(speeds: tuple[float, ...] = SPEEDS, starts: int = STARTS) -> Measured:
    shares = shares_over_speed(speeds, starts)
    rest = shares[EndState.SELF_CENTRED][:, 0]
    last = max(int(np.argmax(rest < 1.0)) - 1, 0)
    # Equal shares are allowed; a start with an unknown end may be on either side.
    margins = -np.diff(rest[last:]) + 0.5 / starts
    open_ends = shares[EndState.UNDECIDED][last:, 0]
    return answers_of(
        margins,
        open_ends[:-1] + open_ends[1:],
        source=f"Section 5; Fig. 5 except for ω; starts in {RECTANGLE}",
        note=f"All starts lead to the equilibrium up to ω = {speeds[last]:.3g} rad/s; {100.0 * rest[-1]:.2g} % still "
        f"do at {speeds[-1]:g} rad/s.",
    )


# --- Figure


def draw(data: ByEngine) -> Figures:
    if "theory" not in data:
        return {}
    from matplotlib.colors import ListedColormap

    found = data["theory"]
    figure, (plane, orbit, share) = new_figure(ncols=3, width=13.0, height=4.0)
    whirls = found["ends"] == EndState.WHIRL
    plane.imshow(
        np.where(found["ends"] == EndState.SELF_CENTRED, 0.0, np.where(whirls, 1.0, 2.0)),
        origin="lower",
        extent=(*PLANE[0], *PLANE[1]),
        cmap=ListedColormap([SKY, "#f3ead7", PURPLE]),
        vmin=0.0,
        vmax=2.0,
        interpolation="nearest",
        aspect="equal",
    )
    plane.plot(*found["curve"].T, **curve("theory", "stable set of the saddle"))
    for x, _, vx, _ in FIG5_STARTS.values():
        plane.plot(x, vx, "+", color=BLACK, markersize=7.0)
    plane.text(0.065, -0.11, "equilibrium", ha="center")
    plane.text(-0.13, 0.25, "whirl", ha="center")
    plane.set(xlabel=axis("x_0", "m"), ylabel=axis(r"\dot x_0", "m/s"))
    plane.legend(loc="lower left")

    x, y, held = found["saddle"].T
    orbit.plot(x, y, color=BLACK, linewidth=1.0)
    orbit.plot(*np.where(held > 0.0, (x, y), np.nan), color=PURPLE, linewidth=4.0, label="sticks")
    orbit.plot(0.0, 0.0, "+", color=BLACK, markersize=8.0)
    orbit.set(xlabel=axis("x", "m"), ylabel=axis("y", "m"), aspect="equal")
    orbit.legend(loc="best")

    value, low, high = found["whirl"].T
    # Points without a line, because the share between two speeds is unknown.
    bars = np.abs([value - low, high - value])
    share.errorbar(
        found["speeds"],
        value,
        bars,
        color=GREEN,
        fmt="o",
        markersize=3.5,
        capsize=2.5,
        label="whirl, 95 % interval",
    )
    share.set(xlabel=axis(r"\omega", "rad/s"), ylabel="share of the starts", ylim=(-0.02, 1.02))
    share.legend(loc="lower right")
    return {"basins": figure}


STUDY.provides(figures=draw, curves=curves)
