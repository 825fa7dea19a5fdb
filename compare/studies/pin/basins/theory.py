"""Ends of many starts, and the boundary between them: the stable set of a saddle-type stick–slip orbit."""

from __future__ import annotations

import functools
import math
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import CubicSpline

from compare.claims import TIGHTEST, Data
from compare.claims.parameters import FIG5
from compare.claims.shares import Ends, mixed, of_sample
from reference_model import StickSlipOrbit, basin_boundary, self_centred_equilibria, stick_slip_orbits
from reference_model.ensemble import EndState, Ensemble, simulate_ensemble
from reference_model.systems import FloatArray, PinOnDisc

# --- The plane of starts, and parameters of the search for ends and boundary

PLANE = ((-0.3, 0.5), (-0.4, 0.4))
"""Ranges of x0 in m and vx0 in m/s; y0 and vy0 are zero."""

RECTANGLE = "−0.3 m < x < 0.5 m, |ẋ| < 0.4 m/s, y = ẏ = 0"
"""The same ranges as text."""

FROM_REST = "Fig. 5; starts from rest in y"

SIDE, FINER = 334, 3
"""Starts along each side of the plane, and refinement factor of the grid where ends differ."""

FASTEST = replace(FIG5, disc_speed=3.0)
"""Fig. 5 at twice its speed, where the basin is small."""

WHERE = {FIG5: ((-0.2, 0.4), (-0.35, 0.25)), FASTEST: ((-0.03, 0.07), (-0.16, 0.06))}
"""Search range for the boundary of each pin. The ends on the grid show that no part of it lies outside."""

CELLS, ON_BOUNDARY = 8, 1e-5
"""Resolution and tolerance of the boundary. Splines between its points are 1.2e-3 off, half a step of the grid."""

ASKED, BARELY = 64, 1e-6
"""Largest number of starts for shooting, and smallest distance from the saddle in rad that decides their side."""

UNTIL = 3000.0
"""Duration in s until every start has reached its end."""

SPEEDS = tuple(np.linspace(1.05, FASTEST.disc_speed, 20).tolist())
"""Disc speeds in rad/s."""

STARTS, SEED = 2000, 5
"""Number of random starts in the plane, the same at every speed, and seed."""

RECOMPUTED = 16
"""Starts that the plain reference recomputes, half of them near the boundary."""

SETTLED = 250.0
"""Duration in s until the plain reference has reached one of the two ends from these starts."""

STEP = 5e-3
"""Distance in rad of other releases from the saddle's, for an engine's multiplier."""

PLACES, ASIDE = 4, 5e-3
"""Number of starts on the boundary for each engine, and distance from it to either side in m and m/s."""

WITHIN, REACH = (0.05, -0.1), 0.4
"""A start in the basin of the equilibrium, and a distance from it where all starts lead to the whirl."""

AFTER, ASIDE_TOLERANCE = 90.0, 1e-7
"""Duration in s until the engines' motions have left the saddle, and tolerance."""


def curves(
    side: int = SIDE, cells: int = CELLS, speeds: tuple[float, ...] = SPEEDS, starts: int = STARTS
) -> Data:
    orbit = saddle(FIG5).trajectory
    held = np.zeros(len(orbit.times))
    for begin, end in orbit.stick_times.reshape(-1, 2):
        held[(orbit.times >= begin) & (orbit.times <= end)] = 1.0
    return {
        "ends": ends_on_grid(FIG5, side).astype(float),
        "curve": smooth(boundary(FIG5, cells)),
        "saddle": np.column_stack((orbit.states[:, :2], held)),
        "speeds": np.array(speeds),
        "whirl": shares_over_speed(speeds, starts)[EndState.WHIRL],
    }


@functools.cache
def saddle(pin: PinOnDisc) -> StickSlipOrbit:
    """Return the orbit of ``pin`` whose stable set is the boundary."""
    (orbit,) = (orbit for orbit in stick_slip_orbits(pin, tolerance=TIGHTEST) if not orbit.stable)
    return orbit


def sought_from(pin: PinOnDisc) -> StickSlipOrbit:
    """Return the saddle with the tolerance for points of the boundary."""
    orbit = saddle(pin)
    return replace(orbit, problem=replace(orbit.problem, tolerance=ON_BOUNDARY))


@functools.cache
def boundary(pin: PinOnDisc = FIG5, cells: int = CELLS) -> FloatArray:
    """Return the closed boundary in the plane of x0 and vx0, shape (n, 2); the last point is the first."""
    (curve,) = basin_boundary(sought_from(pin), ranges=WHERE[pin], cells=cells)
    points = np.asarray(curve.points)
    return points if np.array_equal(points[0], points[-1]) else np.vstack((points, points[:1]))


def smooth(points: FloatArray, samples: int = 1000) -> FloatArray:
    """Return a closed curve through ``points`` (n, 2) by periodic cubic splines, shape (samples + 1, 2)."""
    length = np.append(0.0, np.cumsum(np.hypot(*np.diff(points, axis=0).T)))
    curve = CubicSpline(length, points, bc_type="periodic")
    return np.asarray(curve(np.linspace(0.0, length[-1], samples + 1)))


def distances(points: FloatArray, curve: FloatArray) -> FloatArray:
    """Return the distances of points (n, 2) from the points of a curve."""
    from scipy.spatial import cKDTree

    return np.asarray(cKDTree(curve).query(points)[0])


def enclosed(curve: FloatArray) -> float:
    """Return the area inside a closed curve of shape (n, 2)."""
    (x, y), (x_next, y_next) = curve[:-1].T, curve[1:].T
    return 0.5 * abs(float(np.sum(x * y_next - x_next * y)))


def inside(points: FloatArray, curve: FloatArray) -> NDArray[np.bool_]:
    from matplotlib.path import Path

    return np.asarray(Path(curve).contains_points(points))


def beyond_equilibrium(state: FloatArray) -> float:
    """Return the distance in m of a state from the equilibrium minus X0; it is positive on the whirl."""
    (rest,) = self_centred_equilibria(FIG5)
    return math.hypot(state[0] - rest.x, state[1] - rest.y) - abs(FIG5.offset)


def starts_at(x: FloatArray, vx: FloatArray) -> FloatArray:
    """Return states of shape (n, 4) from components of shape (n,)."""
    zero = np.zeros_like(x)
    return np.column_stack((x, zero, vx, zero))


def ensemble_of(starts: FloatArray, pin: PinOnDisc = FIG5, **parameters: FloatArray) -> Ensemble:
    """Return the ends of ``starts`` of shape (n, 4)."""
    return simulate_ensemble(pin, starts, duration=UNTIL, parameters=parameters)


def places_on_grid(side: int) -> FloatArray:
    """Return x0 and vx0 of the grid, shape (side², 2)."""
    x, vx = (np.linspace(low, high, side) for low, high in PLANE)
    return np.column_stack([each.ravel() for each in np.meshgrid(x, vx)])


@functools.lru_cache(maxsize=2)
def ends_on_grid(pin: PinOnDisc, side: int) -> Ends:
    """Return the ends of the starts on the grid, shape (side, side)."""
    return ensemble_of(starts_at(*places_on_grid(side).T), pin).end.reshape(side, side)


@functools.lru_cache(maxsize=2)
def ends_on_finer_grid(pin: PinOnDisc, side: int) -> Ends:
    """Return the ends on a grid ``FINER`` times as dense, shape (n, n), n = FINER·(side − 1) + 1.

    Only starts in cells of the grid of ``side`` whose corners have different ends are simulated. All other starts get
    the end of the corners of their cell.
    """
    coarse = ends_on_grid(pin, side)
    cell = np.arange(FINER * (side - 1) + 1) // FINER
    ends = coarse[np.ix_(cell, cell)]
    doubtful = np.pad(mixed(coarse), (0, 1))[np.ix_(cell, cell)]
    # The far edges of a cell are the near ones of the next.
    doubtful[1:] |= doubtful[:-1]
    doubtful[:, 1:] |= doubtful[:, :-1]
    places = places_on_grid(len(cell))[doubtful.ravel()]
    ends[doubtful] = ensemble_of(starts_at(*places.T), pin).end
    return ends


def random_places(starts: int) -> tuple[FloatArray, np.random.Generator]:
    """Return x0 and vx0 of the random starts, shape (starts, 2), and the generator for further ones."""
    random = np.random.default_rng(SEED)
    return np.column_stack([random.uniform(low, high, starts) for low, high in PLANE]), random


@functools.lru_cache(maxsize=1)
def shares_over_speed(speeds: tuple[float, ...], starts: int) -> dict[EndState, FloatArray]:
    """Return the share of each end at each speed and its 95 % interval, shape (speeds, 3)."""
    places, _ = random_places(starts)
    found = ensemble_of(
        np.tile(starts_at(*places.T), (len(speeds), 1)), disc_speed=np.repeat(speeds, starts)
    ).end.reshape(len(speeds), starts)
    rows = [of_sample(ends) for ends in found]
    return {end: np.array([row[end] for row in rows]) for end in EndState}
