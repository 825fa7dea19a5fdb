"""Differences of the contact laws from each other and from the integral (20)."""

import functools
import math
from collections.abc import Callable, Sequence

import numpy as np
from numpy.typing import ArrayLike

from compare.claims import ROUNDING, Data
from compare.claims.parameters import FIG11
from reference_model.contact.annulus import Annulus
from reference_model.contact.contact_law import Contact, Ring, ThreeTermRing
from reference_model.contact.points import PointsOnRing
from reference_model.systems import FloatArray

R = FIG11.contact_radius

NUMBERS = (6, 12, 24)  # numbers of points
ZOOMS = 30  # halvings of the search range for the largest error
INNER = 2.0 / 3.0 * R  # inner radius of the annulus (m)

# --- Friction on a contact ring by (20) to (22), independent of the reference's closed forms. ``slip`` is the slip of
# the disc's centre, u = (ẋ + ωy) + i(ẏ − ωx), and ``rim`` is R·(ω − φ̇), both in m/s. Friction is the array (F_x,
# F_y, M) over μN and μN·R.

EVEN = 16  # angles, exact for the mean of trigonometric polynomials up to order 15


def velocities(slip: complex, rim: float, angle: ArrayLike) -> FloatArray:
    """Return ν_rx, ν_ry and ν̃_r of (21) at the angles φ + χ (rad), shape (3, ...)."""
    s, c = np.sin(angle), np.cos(angle)
    x, y = slip.real + rim * s, slip.imag - rim * c
    return np.stack((x, y, x * s - y * c))


def directions(slip: complex, rim: float, angle: ArrayLike) -> FloatArray:
    """Return −ν_rx/|ν_r|, −ν_ry/|ν_r| and ν̃_r/|ν_r| of (20) at the angles φ + χ (rad), shape (3, ...)."""
    x, y, along = velocities(slip, rim, angle)
    speed = np.hypot(x, y)
    return np.stack((-x, -y, along)) / np.where(speed > 0.0, speed, 1.0)


@functools.cache  # shared by several claims
def ring_by_quadrature(slip: complex, rim: float) -> tuple[FloatArray, float]:
    """Return the integral (20) by adaptive quadrature, and its error."""
    from scipy.integrate import quad_vec

    # Start at the slowest point, so its kink is at the ends of the range.
    start = math.atan2(slip.imag, slip.real) - math.copysign(0.5 * math.pi, rim)
    value, error = quad_vec(
        lambda angle: directions(slip, rim, angle), start, start + 2.0 * math.pi, epsabs=1e-12, epsrel=0.0
    )
    return np.asarray(value) / (2.0 * math.pi), float(error) / (2.0 * math.pi)


def sum_of_points(slip: complex, rim: float, angle: float, number: int) -> FloatArray:
    """Return the mean over points at φ + 2πi/n instead of the integral (20), with φ = ``angle`` (rad)."""
    return np.asarray(
        np.mean(directions(slip, rim, angle + 2.0 * math.pi * np.arange(number) / number), axis=1)
    )


def average_of_expansion(slip: complex, rim: float) -> FloatArray:
    """Return the exact integral (20) with three terms of (22) instead of ν̄_r/|ν_r|."""
    angle = 2.0 * math.pi * np.arange(EVEN) / EVEN
    x, y, along = velocities(slip, rim, angle)
    mean_square = abs(slip) ** 2 + rim**2
    term = rim * (slip.real * np.sin(angle) - slip.imag * np.cos(angle)) / mean_square
    inverse_speed = (1.0 - term + 1.5 * term**2) / math.sqrt(mean_square)
    return np.asarray(np.mean(inverse_speed * np.stack((-x, -y, along)), axis=1))


RING, EXPANSION = Ring(R), ThreeTermRing(R)

QUADRATURE = 1e-11  # ten times the tolerance of the quadrature


def friction(law: Contact, slip: complex, rim: float, angle: float = 0.0) -> FloatArray:
    """Return (F_x, F_y, M) of ``law``."""
    force, moment = law.force_and_moment(slip, rim / R, angle)
    return np.array((force.real, force.imag, moment / R))


@functools.cache
def greatest_errors_of_expansion() -> tuple[FloatArray, FloatArray]:
    """Return the largest errors of (23) by integrals (20), and by closed forms.

    Each array contains U/W, size and the error of U/W, for force and moment, shape (2, 3).
    """

    def by_integrals(ratio: float) -> FloatArray:
        return average_of_expansion(ratio, 1.0) - ring_by_quadrature(ratio, 1.0)[0]

    def by_formulas(ratio: float) -> FloatArray:
        return friction(EXPANSION, ratio, 1.0) - friction(RING, ratio, 1.0)

    def largest(difference: Callable[[float], FloatArray], part: int) -> tuple[float, float, float]:
        return top(lambda ratio: abs(float(difference(ratio)[part])), QUADRATURE)

    integrals, formulas = (
        np.array([largest(difference, part) for part in (0, 2)]) for difference in (by_integrals, by_formulas)
    )
    return integrals, formulas


def top(error: Callable[[float], float], noise: float) -> tuple[float, float, float]:
    """Return the U/W of the largest ``error``, its size, and the error of U/W.

    On a parabola of curvature c, points within √(2·noise/c) of the maximum cannot be distinguished from it.
    """
    from scipy.optimize import minimize_scalar

    coarse = max(np.geomspace(1e-2, 1e2, 201).tolist(), key=error)
    around, options = (0.95 * coarse, 1.05 * coarse), {"xatol": 1e-6}
    found = minimize_scalar(lambda ratio: -error(ratio), bounds=around, method="bounded", options=options)
    place, h = float(found.x), 0.01 * coarse
    curvature = abs(error(place - h) - 2.0 * error(place) + error(place + h)) / h**2
    return place, -float(found.fun), math.sqrt(2.0 * noise / curvature) + 1e-6


@functools.cache
def greatest_errors_of_points(numbers: Sequence[int]) -> FloatArray:
    """Return ``worst`` for all ``numbers``, for force and moment, shape (n, 2, 4)."""
    return np.array([[worst(number, part) for part in (slice(2), slice(2, 3))] for number in numbers])


def worst(number: int, part: slice) -> tuple[float, float, float, float]:
    """Return the U/W of the largest error of ``number`` points, its size, and the errors of size and U/W.

    The search uses no slopes, because the maximum is next to a jump.
    """
    law = PointsOnRing(R, number)
    centre, spans, history = np.zeros(2), np.array((math.log(20.0), math.pi / number)), []
    for _ in range(ZOOMS):
        grid = []
        for stretch in centre[0] + spans[0] * np.linspace(-1.0, 1.0, 17):
            ratio = math.exp(stretch)
            ring = friction(RING, ratio, 1.0)
            for angle in centre[1] + spans[1] * np.linspace(-1.0, 1.0, 17):
                distance = float(np.linalg.norm((friction(law, ratio, 1.0, angle) - ring)[part]))
                grid.append((distance, stretch, angle))
        size, *best = max(grid)
        centre = np.array(best)
        history.append((size, math.exp(centre[0])))
        spans *= 0.5
    (before, at), (size, place) = history[-2:]
    return place, size, 2.0 * abs(size - before) + ROUNDING, 2.0 * abs(place - at) + 2.0 * float(spans[0])


def curves() -> Data:
    # Exclude U = W, where a point rests and the error is smaller than nearby.
    near = np.geomspace(1e-5, 0.1, 50)
    ratios = np.unique(np.concatenate((np.geomspace(0.05, 20.0, 240), 1.0 - near, 1.0 + near)))
    data = {"ratio": ratios}
    for name, law in {"ring": RING, "expansion": EXPANSION, "annulus": Annulus(INNER, R)}.items():
        data[name] = np.array([friction(law, ratio, 1.0)[[0, 2]] for ratio in ratios]) * (-1.0, 1.0)
    data["expansion_error"] = np.abs(data["expansion"] - data["ring"])
    for number in NUMBERS:
        # A point rests at −π/2 if U = W.
        angles = -0.5 * math.pi + 2.0 * math.pi / number * np.arange(24) / 24
        points = PointsOnRing(R, number)
        found = np.array([[friction(points, ratio, 1.0, angle) for angle in angles] for ratio in ratios])
        exact = data["ring"][:, np.newaxis]
        data[f"points{number}"] = np.stack((found.min(axis=1), found.max(axis=1)))[:, :, [0, 2]] * (-1.0, 1.0)
        force = np.hypot(found[:, :, 0] + exact[:, :, 0], found[:, :, 1])
        moment = np.abs(found[:, :, 2] - exact[:, :, 1])
        data[f"points{number}_error"] = np.stack((force.max(axis=1), moment.max(axis=1)), axis=1)
    return data
