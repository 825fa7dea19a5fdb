"""Final motions of many starts, and their boundary: the stable set of a stick–slip orbit."""

import functools
import math
from dataclasses import replace

import numpy as np
from scipy.interpolate import CubicSpline

from compare.claims import TIGHTEST, WORKING, Data, Measured, Study, answers_of, asked, known, refined
from compare.claims.parameters import FIG5, components_of
from compare.claims.shares import Ends, mixed, of_grid, of_sample
from compare.engines import Engine
from compare.studies.toolkit.measuring import compared
from reference_model import StickSlipOrbit, basin_boundary, simulate, stick_slip_orbits
from reference_model.ensemble import EndState, Ensemble, simulate_ensemble
from reference_model.formulas.pin import equilibrium_position
from reference_model.orbits.basin_boundary import Separatrix
from reference_model.orbits.release_map import Release, ReleaseMap
from reference_model.systems import FloatArray, PinOnDisc

PLANE = ((-0.3, 0.5), (-0.4, 0.4))  # x0 in m and vx0 in m/s; y0 = vy0 = 0
RECTANGLE = "−0.3 m < x < 0.5 m, |ẋ| < 0.4 m/s, y = ẏ = 0"

FROM_REST = "Fig. 5; starts from rest in y"

SIDE, FINER = 334, 3
"""Starts along each side of the plane, and refinement of the grid where ends differ."""

FASTEST = replace(FIG5, disc_speed=3.0)
"""Twice the speed of Fig. 5, with a small basin."""

WHERE = {FIG5: ((-0.2, 0.4), (-0.35, 0.25)), FASTEST: ((-0.03, 0.07), (-0.16, 0.06))}
"""Search range of each boundary; the ends on the grid show that no part of it lies outside."""

CELLS, ON_BOUNDARY = 8, 1e-5
"""Resolution and tolerance of the boundary; splines between its points are 1.2e-3 off, half a step of the grid."""

ASKED, BARELY = 64, 1e-6
"""Largest number of starts for shooting, and smallest distance (rad) from the saddle that decides their side."""

UNTIL = 3000.0  # duration in s
SPEEDS = tuple(np.linspace(1.05, FASTEST.disc_speed, 20).tolist())  # disc speeds in rad/s
STARTS, SEED = 2000, 5  # random starts, the same at every speed
STEP = 5e-3  # distance (rad) of neighbouring releases, whose differences give the multiplier

RECOMPUTED, SETTLED = 16, 250.0
"""Starts for the plain reference, half of them near the boundary, and duration in s until their ends."""

PLACES, ASIDE = 4, 5e-3
"""Starts on the boundary, and distance of simulated starts from it in m and m/s."""

WITHIN, REACH = (0.05, -0.1), 0.4
"""A start in the basin of the equilibrium, and a distance from it where all starts lead to the whirl."""

AFTER, ASIDE_TOLERANCE = 90.0, 1e-7
"""Duration in s until the engines' motions have left the saddle, and tolerance."""


def curves(
    side: int = SIDE, cells: int = CELLS, speeds: tuple[float, ...] = SPEEDS, starts: int = STARTS
) -> Data:
    orbit = saddle(FIG5).trajectory
    begins, ends = orbit.stick_times.reshape(-1, 2, 1).swapaxes(0, 1)
    held = np.any((orbit.times >= begins) & (orbit.times <= ends), axis=0).astype(float)
    return {
        "ends": ends_on_grid(FIG5, side).astype(float),
        "curve": smooth(boundary(FIG5, cells)),
        "saddle": np.column_stack((orbit.states[:, :2], held)),
        "speeds": np.array(speeds),
        "whirl": shares_over_speed(speeds, starts)[EndState.WHIRL],
    }


@functools.cache
def saddle(pin: PinOnDisc) -> StickSlipOrbit:
    (orbit,) = (orbit for orbit in stick_slip_orbits(pin, tolerance=TIGHTEST) if not orbit.stable)
    return orbit


def sought_from(pin: PinOnDisc) -> StickSlipOrbit:
    orbit = saddle(pin)
    return replace(orbit, problem=replace(orbit.problem, tolerance=ON_BOUNDARY))


@functools.cache
def boundary(pin: PinOnDisc, cells: int) -> FloatArray:
    """Return the boundary in the plane of x0 and vx0, shape (n, 2); the last point is the first."""
    (curve,) = basin_boundary(sought_from(pin), ranges=WHERE[pin], cells=cells)
    points = np.asarray(curve.points)
    return points if np.array_equal(points[0], points[-1]) else np.vstack((points, points[:1]))


def smooth(points: FloatArray, samples: int = 1000) -> FloatArray:
    """Return a closed curve through ``points`` (n, 2) by cubic splines, shape (samples + 1, 2)."""
    length = np.append(0.0, np.cumsum(np.hypot(*np.diff(points, axis=0).T)))
    curve = CubicSpline(length, points, bc_type="periodic")
    return np.asarray(curve(np.linspace(0.0, length[-1], samples + 1)))


def enclosed(curve: FloatArray) -> float:
    """Return the area inside a closed curve of shape (n, 2)."""
    (x, y), (x_next, y_next) = curve[:-1].T, curve[1:].T
    return 0.5 * abs(float(np.sum(x * y_next - x_next * y)))


def beyond_equilibrium(state: FloatArray) -> float:
    """Return the distance (m) of a state from the equilibrium minus X0; it is positive on the whirl."""
    return math.dist(state[:2], equilibrium_position(FIG5)) - abs(FIG5.offset)


def starts_at(x: FloatArray, vx: FloatArray) -> FloatArray:
    return np.column_stack((x, np.zeros_like(x), vx, np.zeros_like(x)))


def ensemble_of(starts: FloatArray, pin: PinOnDisc = FIG5, **parameters: FloatArray) -> Ensemble:
    return simulate_ensemble(pin, starts, duration=UNTIL, parameters=parameters)


def places_on_grid(side: int) -> FloatArray:
    x, vx = (np.linspace(low, high, side) for low, high in PLANE)
    return np.column_stack([each.ravel() for each in np.meshgrid(x, vx)])


@functools.lru_cache(maxsize=2)
def ends_on_grid(pin: PinOnDisc, side: int) -> Ends:
    return ensemble_of(starts_at(*places_on_grid(side).T), pin).end.reshape(side, side)


@functools.lru_cache(maxsize=2)
def ends_on_finer_grid(pin: PinOnDisc, side: int) -> Ends:
    """Return the ends on a grid ``FINER`` times as dense, shape (n, n), n = FINER·(side − 1) + 1.

    Only starts in cells whose corners have different ends are simulated.
    """
    coarse = ends_on_grid(pin, side)
    cell = np.arange(FINER * (side - 1) + 1) // FINER
    ends = coarse[np.ix_(cell, cell)]
    doubtful = np.pad(mixed(coarse), (0, 1))[np.ix_(cell, cell)]
    # The far edges of a cell are the near edges of the next cell.
    doubtful[1:] |= doubtful[:-1]
    doubtful[:, 1:] |= doubtful[:, :-1]
    places = places_on_grid(len(cell))[doubtful.ravel()]
    ends[doubtful] = ensemble_of(starts_at(*places.T), pin).end
    return ends


def random_places(starts: int) -> tuple[FloatArray, np.random.Generator]:
    """Return x0 and vx0 of the random starts, shape (starts, 2), and the generator for further starts."""
    random = np.random.default_rng(SEED)
    return np.column_stack([random.uniform(low, high, starts) for low, high in PLANE]), random


@functools.lru_cache(maxsize=1)
def shares_over_speed(speeds: tuple[float, ...], starts: int) -> dict[EndState, FloatArray]:
    """Return the share of each end and its 95 % interval, shape (speeds, 3)."""
    places, _ = random_places(starts)
    all_starts = np.tile(starts_at(*places.T), (len(speeds), 1))
    found = ensemble_of(all_starts, disc_speed=np.repeat(speeds, starts)).end
    rows = [of_sample(ends) for ends in found.reshape(len(speeds), starts)]
    return {end: np.array([row[end] for row in rows]) for end in EndState}


WORDS = {"rectangle": RECTANGLE, "side": f"{SIDE}"}
STUDY = Study.beside(__file__, "basins", words=WORDS, source="Fig. 5", system=FIG5, seconds=4.5)


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
    return compared(
        orbit.state,
        found,
        error=found.largest,
        components=components_of(FIG5),
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
    # The change is 15 times the error: twice the step multiplies an error of fourth order by 16.
    bent = abs(multiplier(2.0 * STEP, WORKING) - found.value[2]) / 7.5
    return compared(
        (orbit.period, orbit.stick_time, orbit.multiplier),
        found,
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
    "The stable set of the saddle-type orbit separates starts that lead to the equilibrium from starts that "
    "lead to the whirl",
    note=f"{SIDE} × {SIDE} starts by the compiled ensemble; the boundary by shooting and cubic splines. Some starts "
    "end as if they were on the other side of the splines. For the farthest of these starts, shooting "
    "determines their side of the saddle's stable set. The claim fails if one of them ends on the other side.",
    basis="reference",
)
def divides(side: int = SIDE, cells: int = CELLS) -> Measured:
    from matplotlib.path import Path
    from scipy.spatial import cKDTree

    curve, places, ends = smooth(boundary(FIG5, cells)), places_on_grid(side), ends_on_grid(FIG5, side)
    inside = Path(curve).contains_points(places)
    other = ends.ravel() != np.where(inside, EndState.SELF_CENTRED, EndState.WHIRL)
    beyond, whirled = places[other], ends.ravel()[other] == EndState.WHIRL
    off, _ = cKDTree(curve).query(beyond)
    farthest = np.argsort(off)[: -ASKED - 1 : -1]
    sides = Separatrix.of(saddle(FIG5))  # far tighter than required
    misses = np.array([sides.miss(start) for start in starts_at(*beyond[farthest].T)])
    before, behind = sides.ends
    as_it_ended = np.where(whirled[farthest] == (behind > before), misses, -misses)
    how_far = f", none farther than {off.max():.2g} from it" if off.size else ""
    # All other starts match their side of the curve, or are closer to it than the starts for shooting.
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
    whirls = [beyond_equilibrium(simulate(FIG5, start, [0.0, SETTLED]).at_end) > 0.0 for start in chosen]
    right = np.array(whirls) == (ensemble_of(chosen).end == EndState.WHIRL)
    return answers_of(right, source="Fig. 5; random starts, half of them near the boundary")


@STUDY.claim(
    "The basin of the self-centred equilibrium shrinks as ω grows",
    note=f"Is the share of the same {STARTS} random starts at each of {len(SPEEDS)} speeds at most the share "
    f"at the previous speed?",
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
