"""How likely the whirl is: the basins of Fig. 5, their boundary, and how they change with the speed."""

from __future__ import annotations

import functools
import math
from collections.abc import Mapping
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import CubicSpline

from compare.claims.answers import asked, holds
from compare.claims.claim import Claim, ErrorBudget
from compare.claims.error_estimates import refined
from compare.claims.paper_parameters import FIG5
from compare.claims.parameters import at_each, parameters_of
from compare.claims.shares import of_grid, of_sample
from compare.claims.study import Findings, Study
from compare.engines import Engine
from compare.studies.pin.basins.pictures import draw
from reference_model import StickSlipOrbit, basin_boundary, boundary_point, simulate, stick_slip_orbits
from reference_model.orbits.basin_boundary import Separatrix
from reference_model.orbits.release_map import Release, ReleaseMap
from reference_model.systems import FloatArray, PinOnDisc

if TYPE_CHECKING:
    from reference_model.ensemble import EndState, Ensemble

PLANE = ((-0.3, 0.5), (-0.4, 0.4))
"""Of x0 in m and vx0 in m/s; the others are zero."""

RECTANGLE = "−0.3 m < x < 0.5 m, |ẋ| < 0.4 m/s, y = ẏ = 0"
"""The same in words."""

SIDE = 1000
"""Starts along each side of the plane."""

FASTEST = replace(FIG5, disc_speed=3.0)
"""Fig. 5 at twice its speed: there the basin is small."""

WHERE = {FIG5: ((-0.2, 0.4), (-0.35, 0.25)), FASTEST: ((-0.03, 0.07), (-0.16, 0.06))}
"""Where in the plane the boundary of each pin is looked for; that no other part of it lies elsewhere the ends of the
grid say."""

CELLS, ON_BOUNDARY = 10, 1e-7
"""With which resolution and tolerance."""

ASKED, BARELY = 64, 10.0 * ON_BOUNDARY
"""How many starts at most are asked by shooting, and by how much in rad they must miss the saddle to be on a side."""

UNTIL = 3000.0
"""In s: long enough for every start to have come to its end."""

SPEEDS = np.linspace(1.05, FASTEST.disc_speed, 40)
"""In rad/s."""

STARTS, SEED = 4000, 5
"""Random starts in the plane, the same at every speed."""

RECOMPUTED = 16
"""Starts whose end the plain reference is asked for, half of them next to the boundary."""

SETTLED = 250.0
"""In s: what the plain reference takes to come to one of the two ends from these."""

STEP = 5e-3
"""In rad: by how much other releases are off the saddle's, from which an engine's multiplier is taken."""

PLACES, ASIDE = 4, 5e-3
"""Starts on the boundary that each engine is asked about, and how far to its sides, in m and m/s."""

WITHIN, REACH = (0.05, -0.1), 0.4
"""A start in the basin of the equilibrium, and how far from it all are in that of the whirl."""

AFTER, ASIDE_TOLERANCE = 90.0, 1e-7
"""When the engines' motions have left the saddle for good, in s, and at which tolerance."""

CLOSES = "The stick–slip orbit between the two basins of Fig. 5 comes back to its start after its period"
RETURNS = "That orbit has the period, the time of stick and the multiplier that its map of releases gives"
PARTS = "Starts on either side of the boundary, which is found by shooting, come to equilibrium and whirl"
DIVIDES = "The stable set of the stick–slip orbit of saddle type divides the ends of all starts of a grid"
AREA = (
    "The equilibrium's share of the starts of the rectangle is that of the area which the boundary encloses, "
    "at both speeds"
)
RECOMPUTES = "The plain reference finds the ends that the compiled ensemble finds"
SHRINKS = "The attraction area of the self-centred equilibrium shrinks as ω grows"


@functools.cache
def saddle(tolerance: float = 1e-12, pin: PinOnDisc = FIG5) -> StickSlipOrbit:
    """Return the orbit of ``pin`` whose stable set is the boundary."""
    (orbit,) = (orbit for orbit in stick_slip_orbits(pin, tolerance=tolerance) if not orbit.stable)
    return orbit


@functools.cache
def boundary(pin: PinOnDisc = FIG5) -> FloatArray:
    """Return the closed boundary in the plane of x0 and vx0, shape (n, 2); the last point is the first."""
    (curve,) = basin_boundary(saddle(ON_BOUNDARY, pin), ranges=WHERE[pin], cells=CELLS)
    points = np.asarray(curve.points)
    return points if np.array_equal(points[0], points[-1]) else np.vstack((points, points[:1]))


def smooth(points: FloatArray, samples: int = 1000) -> FloatArray:
    """Return a closed curve through ``points`` (n, 2) by periodic cubic splines, shape (samples + 1, 2)."""
    length = np.append(0.0, np.cumsum(np.hypot(*np.diff(points, axis=0).T)))
    curve = CubicSpline(length, points, bc_type="periodic")
    return np.asarray(curve(np.linspace(0.0, length[-1], samples + 1)))


def distances(points: FloatArray, curve: FloatArray) -> FloatArray:
    """Return how far points (n, 2) are from those of a curve."""
    from scipy.spatial import cKDTree

    return np.asarray(cKDTree(curve).query(points)[0])


def enclosed(curve: FloatArray) -> float:
    """Return the area inside of a closed curve, shape (n, 2)."""
    (x, y), (x_next, y_next) = curve[:-1].T, curve[1:].T
    return 0.5 * abs(float(np.sum(x * y_next - x_next * y)))


def grid() -> tuple[FloatArray, FloatArray]:
    """Return x0 and vx0 of the grid, shape (SIDE,) each."""
    first, second = (np.linspace(low, high, SIDE) for low, high in PLANE)
    return first, second


def starts_at(x: FloatArray, vx: FloatArray) -> FloatArray:
    """Return states of shape (n, 4) from components of shape (n,)."""
    zero = np.zeros_like(x)
    return np.column_stack((x, zero, vx, zero))


def ensemble_of(starts: FloatArray, pin: PinOnDisc = FIG5, **parameters: FloatArray) -> Ensemble:
    """Return what ``starts`` of shape (n, 4) end in."""
    from reference_model.ensemble import simulate_ensemble

    return simulate_ensemble(pin, starts, duration=UNTIL, parameters=parameters)


def measure(engine: Engine) -> Findings:
    """Follow the saddle for a period, and starts beside its stable set to their ends."""
    return Findings((closes_claim(engine), returns_claim(engine), parts_claim(engine)))


def closes_claim(engine: Engine) -> Claim:
    """Compare the state after a period with that at the start."""
    orbit = saddle()
    measured, error = refined(
        lambda tolerance: engine.simulate(FIG5, orbit.state, [0.0, orbit.period], tolerance=tolerance).at_end
    )
    return Claim(
        CLOSES,
        equation="(1), (6)",
        kind="trajectory",
        engine=engine.name,
        predicted=orbit.state,
        measured=measured,
        budget=ErrorBudget(float(np.max(error)), resolution=1e-4),
        parameters=parameters_of(FIG5),
        source="Fig. 5",
        unit="m, m/s",
        note=f"Found by the map from release to release: period {orbit.period:.7g} s, of which it sticks "
        f"{orbit.stick_time:.5g} s; multipliers "
        f"{', '.join(f'{abs(value):.5g}' for value in orbit.multipliers)}.",
    )


def returns_claim(engine: Engine) -> Claim:
    """Compare period, time of stick and multiplier of the saddle in the engine's own map of releases."""
    orbit = saddle()
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

    def found(tolerance: float) -> FloatArray:
        middle = after(orbit.release_angle, tolerance)
        return np.array([middle.time, middle.stick_time, multiplier(STEP, tolerance)])

    measured, error = refined(found)
    # Of fourth order: at twice the step it is 16 times as far off, and the change 15 times.
    error[2] += abs(multiplier(2.0 * STEP, 1e-9) - measured[2]) / 7.5
    return Claim(
        RETURNS,
        equation="(1), (6)",
        kind="trajectory",
        engine=engine.name,
        predicted=(orbit.period, orbit.stick_time, orbit.multiplier),
        measured=measured,
        budget=ErrorBudget(np.nan_to_num(error, nan=np.inf), resolution=1e-3),
        parameters=parameters_of(FIG5),
        source="Fig. 5",
        unit="s, 1",
        note=f"From release to release, and from releases {STEP:g} and {2.0 * STEP:g} rad to either side by "
        "differences of fourth order. Error: the change at a smaller tolerance and with twice these differences.",
        named={"period of the saddle": 0, "stick of the saddle": 1, "multiplier of the saddle": 2},
    )


def parts_claim(engine: Engine) -> Claim:
    """Tell to which end starts on either side of the boundary come."""
    rays = np.exp(2j * math.pi * np.arange(PLACES) / PLACES)
    ways = np.column_stack((rays.real, rays.imag))
    zero = np.zeros_like(ways)
    middle = [
        boundary_point(saddle(), start, end)[[0, 2]]
        for start, end in zip(
            starts_at(*(WITHIN + zero).T), starts_at(*(WITHIN + REACH * ways).T), strict=True
        )
    ]
    sides = np.concatenate((middle - ASIDE * ways, middle + ASIDE * ways))
    outwards = np.repeat((-1.0, 1.0), PLACES)

    def margins(tolerance: float) -> FloatArray:
        ends = [
            engine.simulate(FIG5, start, [0.0, AFTER], tolerance=tolerance).at_end
            for start in starts_at(*sides.T)
        ]
        return outwards * [beyond_equilibrium(end) for end in ends]

    return Claim(
        PARTS,
        equation="(3), (17)",
        engine=engine.name,
        **holds(*asked(margins, ASIDE_TOLERANCE)),
        parameters=parameters_of(FIG5),
        source="Fig. 5; starts from rest in y",
        note=f"{len(sides)} starts, {ASIDE:g} inside and outside of the boundary, after {AFTER:g} s: whether the "
        "distance from the place (3) is smaller, or larger, than X0.",
        basis="reference",
    )


def beyond_equilibrium(state: FloatArray) -> float:
    """Return by how much in m a state is farther than X0 from the equilibrium: beyond it is on the whirl."""
    from reference_model import self_centred_equilibria

    (rest,) = self_centred_equilibria(FIG5)
    return math.hypot(state[0] - rest.x, state[1] - rest.y) - abs(FIG5.offset)


def inside(points: FloatArray, curve: FloatArray) -> NDArray[np.bool_]:
    """Tell which points (n, 2) a closed curve encloses."""
    from matplotlib.path import Path

    return np.asarray(Path(curve).contains_points(points))


def theory() -> Findings:
    """Simulate the starts of the grid and at all speeds; compare with the boundary and the plain reference."""
    from reference_model.ensemble import EndState

    curve, (x, vx) = smooth(boundary()), grid()
    places = np.column_stack([axis.ravel() for axis in np.meshgrid(x, vx)])
    ends_of = {pin: ensemble_of(starts_at(*places.T), pin).end for pin in WHERE}
    ends = ends_of[FIG5]
    random = np.random.default_rng(SEED)
    drawn = np.column_stack([random.uniform(low, high, STARTS) for low, high in PLANE])
    shares = shares_over_speed(drawn)
    orbit = saddle().trajectory
    held = np.zeros(len(orbit.times))
    for begin, end in orbit.stick_times.reshape(-1, 2):
        held[(orbit.times >= begin) & (orbit.times <= end)] = 1.0
    return Findings(
        (
            divides_claim(places, ends, curve),
            area_claim({pin: each.reshape(SIDE, SIDE) for pin, each in ends_of.items()}),
            recomputes_claim(random, drawn, curve),
            shrinks_claim(shares),
        ),
        {
            "ends": ends.reshape(SIDE, SIDE).astype(float)[::2, ::2],
            "curve": curve,
            "saddle": np.column_stack((orbit.states[:, :2], held)),
            "speeds": SPEEDS,
            "whirl": shares[EndState.WHIRL],
        },
    )


def shares_over_speed(drawn: FloatArray) -> dict[EndState, FloatArray]:
    """Return the share of each end at each speed and its 95 % interval, shape (speeds, 3)."""
    from reference_model.ensemble import EndState

    n = len(drawn)
    found = ensemble_of(
        np.tile(starts_at(*drawn.T), (len(SPEEDS), 1)), disc_speed=np.repeat(SPEEDS, n)
    ).end.reshape(len(SPEEDS), n)
    rows = [of_sample(ends) for ends in found]
    return {end: np.array([row[end] for row in rows]) for end in EndState}


def divides_claim(places: FloatArray, ends: NDArray[np.uint8], curve: FloatArray) -> Claim:
    """Count the starts that end otherwise than their side of the boundary says.

    The curve is interpolated: starts that end as its other side does are asked by shooting on which side they are.
    """
    from reference_model.ensemble import EndState

    other = ends != np.where(inside(places, curve), EndState.SELF_CENTRED, EndState.WHIRL)
    beyond, whirled = places[other], ends[other] == EndState.WHIRL
    off = distances(beyond, curve)
    farthest = np.argsort(off)[: -ASKED - 1 : -1]
    sides = Separatrix.of(saddle(ON_BOUNDARY))
    misses = np.array([sides.miss(start) for start in starts_at(*beyond[farthest].T)])
    before, behind = sides.ends
    as_it_ended = np.where(whirled[farthest] == (behind > before), misses, -misses)
    how_far = f", none farther than {off.max():.2g} from it" if len(off) else ""
    # The others end as their side of the curve says, or lie nearer to it than those that are asked.
    margins = np.concatenate((as_it_ended, np.ones(len(places) - len(farthest))))
    return Claim(
        DIVIDES,
        equation="",
        engine="theory",
        **holds(margins, BARELY),
        parameters=parameters_of(FIG5),
        source="Fig. 5; starts from rest in y",
        note=f"{SIDE} × {SIDE} starts by the compiled ensemble; the boundary from {len(boundary()) - 1} starts that "
        f"come to the saddle, and cubic splines. {len(off)} starts end as the other side of the splines "
        f"does{how_far}. {len(farthest)} of these, the farthest, were asked by shooting on which side of the "
        "saddle's stable set they are: those do not hold for which that is not their end.",
        basis="reference",
    )


def area_claim(ends: Mapping[PinOnDisc, NDArray[np.uint8]]) -> Claim:
    """Compare the share of the starts with the share of the area, for each pin."""
    from reference_model.ensemble import EndState

    whole = math.prod(high - low for low, high in PLANE)
    shares = [of_grid(each)[EndState.SELF_CENTRED] for each in ends.values()]
    return Claim(
        AREA,
        equation="",
        engine="theory",
        predicted=[enclosed(smooth(boundary(pin))) / whole for pin in ends],
        measured=[share.value for share in shares],
        budget=ErrorBudget([0.5 * (share.high - share.low) for share in shares], resolution=2e-3),
        parameters=parameters_of(FIG5, without=("disc_speed",)),
        source=f"Fig. 5; starts in {RECTANGLE}",
        note=f"{SIDE} × {SIDE} starts by the compiled ensemble, for {at_each('ω', [pin.disc_speed for pin in ends])} "
        "rad/s; the boundary by shooting. Numerical error: half of the cells through which the boundary passes.",
        basis="reference",
        named={f"share at {pin.disc_speed:g} rad/s": i for i, pin in enumerate(ends)},
    )


def recomputes_claim(random: np.random.Generator, drawn: FloatArray, curve: FloatArray) -> Claim:
    """Ask the plain reference about some of the starts, and about some next to the boundary."""
    from reference_model.ensemble import EndState

    near = curve[random.integers(len(curve), size=RECOMPUTED // 2)] + random.uniform(
        -ASIDE, ASIDE, (RECOMPUTED // 2, 2)
    )
    starts = starts_at(*np.concatenate((drawn[: RECOMPUTED // 2], near)).T)
    found = ensemble_of(starts).end
    return Claim(
        RECOMPUTES,
        equation="(1), (6)",
        kind="trajectory",
        engine="theory",
        **holds(
            [
                (beyond_equilibrium(simulate(FIG5, start, [0.0, SETTLED]).at_end) > 0.0)
                == (end == EndState.WHIRL)
                for start, end in zip(starts, found, strict=True)
            ]
        ),
        parameters=parameters_of(FIG5),
        source="Fig. 5; random starts, half of them beside the boundary",
        note=f"{RECOMPUTED} starts, of which half are not farther than {ASIDE:g} from the boundary.",
    )


def shrinks_claim(shares: dict[EndState, FloatArray]) -> Claim:
    """Compare the equilibrium's shares at neighbouring speeds, from the first that has a whirl on."""
    from reference_model.ensemble import EndState

    rest = shares[EndState.SELF_CENTRED][:, 0]
    last = max(int(np.argmax(rest < 1.0)) - 1, 0)
    # Equal shares are no growth; a start whose end is not known may be on either side.
    shrinks = -np.diff(rest[last:]) + 0.5 / STARTS
    open_ends = shares[EndState.UNDECIDED][last:, 0]
    return Claim(
        SHRINKS,
        equation="",
        engine="theory",
        **holds(shrinks, open_ends[:-1] + open_ends[1:]),
        parameters=parameters_of(FIG5, without=("disc_speed",)),
        source=f"Section 5; Fig. 5 but for ω; starts in {RECTANGLE}",
        note=f"Whether the share of the same {STARTS} random starts does not grow from one of {len(SPEEDS)} speeds "
        f"to the next. All come to the equilibrium up to ω = {SPEEDS[last]:.3g} rad/s; {100.0 * rest[-1]:.2g} % "
        f"still do at {SPEEDS[-1]:g} rad/s.",
        basis="independent",
    )


STUDY = Study(
    name="basins",
    title="How likely the whirl is",
    paper="Fig. 5 shows that equilibrium and whirl exist side by side, each with an area of attraction of its own, "
    "and section 5 says that the equilibrium's shrinks at high speeds. Here all starts of a rectangle, "
    f"{RECTANGLE}, are followed to their ends. What divides them is the stable set of a periodic motion of saddle "
    "type that sticks once a period: it is found by the map from one release to the next, and the boundary by "
    "shooting at it. Of the starts of the rectangle {share at 1.5 rad/s, %, 4 digits, ±} % come to the equilibrium, "
    "at twice the speed, ω = 3 rad/s, {share at 3 rad/s, %, 2 digits, ±} %.",
    by_hand=measure,
    draw=draw,
    theory=theory,
    figures={
        "basins": f"Left: ends of {SIDE} × {SIDE} starts with the parameters of Fig. 5, from rest in y; the "
        "boundary is not drawn from them, but found by shooting. Crosses: the two starts of Fig. 5. Middle: the "
        "stick–slip orbit of saddle type, which the motions on the boundary come to; it sticks where it is bold. "
        "Right: the share of random starts of this rectangle that the whirl captures, with 95 % intervals."
    },
    section="The friction pin",
    finding="What divides equilibrium and whirl in Fig. 5 is the stable set of a stick–slip orbit of saddle type. Of "
    f"the starts in {RECTANGLE}, "
    "{share at 1.5 rad/s, %, 3 digits} % come to the equilibrium, at twice the speed "
    "{share at 3 rad/s, %, 2 digits} %.",
    seconds=35.0,
)
