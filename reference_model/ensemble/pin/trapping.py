"""Trapping regions of a pin's equilibrium and whirl, for one set of parameters.

Both are fixed points of a map: the flow over a given time, or the return to the section where x is largest. Near a
stable fixed point with the derivative M the map contracts in the norm xᵀPx with MᵀPM − P = −1. The map moves the
region, an ellipsoid, and all smaller ellipsoids of its shape into clearly smaller ellipsoids.
"""

import math
from collections.abc import Callable
from dataclasses import replace
from functools import lru_cache, partial
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import solve_discrete_lyapunov

from reference_model.ensemble.end_states import EndState, Results
from reference_model.ensemble.pin.kernel import results_of
from reference_model.ensemble.pin.lanes import no_regions, settings_of
from reference_model.ensemble.task import Task, parameter_table
from reference_model.formulas.pin import equilibrium_position, whirl_frequency, whirl_radius
from reference_model.systems import FloatArray, PinOnDisc

Map = Callable[[FloatArray], FloatArray]
"""Takes points (n, d) and returns their images after a turn, NaN if the motion is of another kind."""

TOLERANCE = 1e-10
"""Tolerance of the maps, tight because they are differentiated."""

DIRECTIONS = 128
"""Number of points on an ellipsoid."""

GROWTH = 1.25
"""Ratio of successive ellipsoids; the first ellipsoid is FIRST times the size of the motion."""

FIRST = 1e-2

REQUIRED_SHARE = 0.25
"""Share of the contraction of small deviations that all points on an ellipsoid must reach."""

MOST_ELLIPSOIDS = 40

TURNS = 2
"""Free periods of the map about the equilibrium; more would let larger deviations return."""

LONGEST = 100.0
"""Longest time from the circle without offset to the whirl, in units of m/β."""

NEWTON_STEPS = 3

DIFFERENCE = 1e-4
"""Relative step for the derivative of the return map."""


@lru_cache(maxsize=64)
def trapping_regions(pin: PinOnDisc) -> NDArray[Any]:
    """Return the trapping regions of ``pin``, shape (1,), zero where unknown."""
    regions = no_regions()
    if pin.damping > 0.0 and pin.friction_force > 0.0:
        _find_equilibrium_region(pin, regions)
        _find_whirl_region(pin, regions)
    regions.flags.writeable = False
    return regions


def _find_equilibrium_region(pin: PinOnDisc, regions: NDArray[Any]) -> None:
    try:
        place = complex(*equilibrium_position(pin))
    except ValueError:
        return
    k = pin.natural_frequency
    along = place / abs(place)

    def after_some_time(points: FloatArray) -> FloatArray:
        z = place + along * (points[:, 0] + 1j * points[:, 1])
        v = k * along * (points[:, 2] + 1j * points[:, 3])
        starts = np.column_stack((z.real, z.imag, v.real, v.imag))
        duration = TURNS * 2.0 * math.pi / k
        results = _run(pin, starts, duration)
        x, y, vx, vy = results.states.T
        z, v = (x + 1j * y - place) / along, (vx + 1j * vy) / (k * along)
        given_up = results.times < 0.5 * duration
        return np.where(given_up[:, np.newaxis], np.nan, np.column_stack((z.real, z.imag, v.real, v.imag)))

    regions["level"], regions["form"] = _contracting_region(after_some_time, 4, abs(place))


def _find_whirl_region(pin: PinOnDisc, regions: NDArray[Any]) -> None:
    centred = replace(pin, offset=0.0)
    try:
        radius, frequency = whirl_radius(centred), whirl_frequency(centred)
    except ValueError:
        return
    k, longest = pin.natural_frequency, LONGEST * pin.mass / pin.damping

    def crossing_from(crossings: FloatArray) -> FloatArray:
        results = _run(pin, _on_section(crossings, k), longest, once=True)
        x, y, _, vy = results.states.T
        return np.where(
            results.ends[:, np.newaxis] == EndState.WHIRL, np.column_stack((x, y, vy / k)), np.nan
        )

    def crossing_near(turn: FloatArray, points: FloatArray) -> FloatArray:
        return crossing_from(turn + points)

    start = np.array([[pin.offset + radius, 0.0, 0.0, frequency * radius]])
    for _ in range(2):
        found = _run(pin, start, longest, early=True)
        if found.ends[0] != EndState.WHIRL:
            return
        x, y, _, vy = found.states[0]
        turn = np.array([x, y, vy / k])
        for _ in range(NEWTON_STEPS):
            matrix = _derivative(partial(crossing_near, turn), 3, radius)
            turn = turn - np.linalg.solve(matrix - np.eye(3), crossing_from(turn[np.newaxis])[0] - turn)
        start = _on_section(turn[np.newaxis], k)  # for the measures of the orbit itself
    regions["turn"], regions["measures"] = turn, tuple(found.measures[0])
    regions["reach"], regions["metric"] = _contracting_region(
        lambda points: crossing_from(turn + points) - turn, 3, radius
    )


def _on_section(crossings: FloatArray, k: float) -> FloatArray:
    x, y, v = crossings.T
    return np.column_stack((x, y, np.zeros_like(x), k * v))


def _run(
    pin: PinOnDisc, starts: FloatArray, duration: float, *, early: bool = False, once: bool = False
) -> Results:
    task = Task(parameter_table(pin), starts, np.full(1, duration))
    return results_of(task, settings_of(TOLERANCE, early, once))


def _derivative(flow: Map, dimension: int, size: float) -> FloatArray:
    points = DIFFERENCE * size * np.concatenate((np.eye(dimension), -np.eye(dimension)))
    images = flow(points)
    return np.asarray((images[:dimension] - images[dimension:]).T / (2.0 * DIFFERENCE * size))


def _contracting_region(flow: Map, dimension: int, size: float) -> tuple[float, FloatArray]:
    """Return the largest level of xᵀPx within which the map contracts, and the upper half of P, or zeros."""
    nothing = 0.0, np.zeros(dimension * (dimension + 1) // 2)
    matrix = _derivative(flow, dimension, size)
    if not np.all(np.isfinite(matrix)) or np.max(np.abs(np.linalg.eigvals(matrix))) >= 1.0:
        return nothing
    metric: FloatArray = solve_discrete_lyapunov(matrix.T, np.eye(dimension))
    directions = np.random.default_rng(0).normal(size=(DIRECTIONS, dimension))
    directions /= np.linalg.norm(directions, axis=1)[:, np.newaxis]
    surface = np.linalg.solve(np.linalg.cholesky(metric).T, directions.T).T
    # The linear map reduces xᵀPx by |x|². Requiring only a share leaves a margin between the points.
    allowed = 1.0 - REQUIRED_SHARE * (1.0 - math.sqrt(1.0 - 1.0 / np.linalg.eigvalsh(metric)[-1]))
    level, radius = 0.0, FIRST * size
    for _ in range(MOST_ELLIPSOIDS):
        images = flow(radius * surface)
        if not np.all(np.einsum("ni,ij,nj->n", images, metric, images) <= (allowed * radius) ** 2):
            break
        level, radius = radius**2, GROWTH * radius
    return level, metric[np.triu_indices(dimension)]
