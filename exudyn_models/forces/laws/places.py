"""Places of contact points and their shares of the load, for compiled code."""

import cmath
import math
from collections.abc import Sequence
from functools import cache

import numpy as np

from exudyn_models.forces.jit import compiled
from exudyn_models.forces.laws.tables import kept, kept_at, number_at
from reference_model.systems import FloatArray, Place

BEND = 4.0 / 3.0
"""Smallest slip of the slowest point, divided by δ, without effect on the other points."""


def ring_places(radius: float, points: int) -> tuple[Place, ...]:
    """Return points on a circle of ``radius`` (m), the first on the x-axis, with equal shares of the load."""
    arms = [cmath.rect(radius, 2.0 * math.pi * i / points) for i in range(points)]
    return tuple((arm.real, arm.imag, 1.0 / points) for arm in arms)


def point_regularisation(epsilon: float, places: Sequence[Place]) -> float:
    """Return δ in m/s, below which a single point's friction is viscous, for the ε of the contact in m/s.

    If the slip of point j is v, then P <= v + D·|S| with D the mean distance of the load from j. If another point at
    the distance d is not faster than v, then d·|S| <= 2v. So no two points are slower than ``BEND``·δ at P = ε.
    """
    if len(places) == 1:
        return epsilon
    arms, shares = np.array([complex(x, y) for x, y, _ in places]), np.array([share for *_, share in places])
    apart = [abs(arms - arm) for arm in arms]
    mean = max(float(shares @ distances) for distances in apart)
    nearest = min(float(np.delete(distances, i).min()) for i, distances in enumerate(apart))
    return epsilon / BEND / (1.0 + 2.0 * mean / nearest)


@cache
def table_of(places: tuple[Place, ...]) -> float:
    """Return the address of a table of δ/ε and of all ``places``."""
    return kept((point_regularisation(1.0, places), *np.ravel(places).tolist()))


def places_in(table: float) -> FloatArray:
    """Return x, y (m) and share of all points, shape (n, 3)."""
    return kept_at(table)[1:].reshape(-1, 3)


def slip_maps(table: float, angle: float) -> FloatArray:
    """Return the maps from (u, S) to the slip of each point, shape (n, 2, 3), at the ``angle`` (rad) of the disc."""
    x, y, _ = places_in(table).T
    arms = np.exp(1j * angle) * (x + 1j * y)
    maps = np.zeros((len(arms), 2, 3))
    maps[:, 0, 0] = maps[:, 1, 1] = 1.0
    maps[:, 0, 2], maps[:, 1, 2] = -arms.imag, arms.real
    return maps


@compiled
def place_at(table: float, point: int) -> tuple[complex, float]:
    """Return place (m) and share of a point."""
    start = 1 + 3 * point
    return complex(number_at(table, start), number_at(table, start + 1)), number_at(table, start + 2)


@compiled
def regularisation_at(table: float, epsilon: float) -> float:
    """Return δ in m/s for ε in m/s."""
    return epsilon * float(number_at(table, 0))
