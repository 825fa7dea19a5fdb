"""How far the laws of contact are from each other, and from the integral that they stand for."""

from __future__ import annotations

import functools
import math
from collections.abc import Callable, Sequence

import numpy as np

from compare.claims.error_estimates import ROUNDING
from compare.claims.study import Data
from compare.studies.disc.contact_laws.integrals import average_of_expansion, ring_by_quadrature
from compare.studies.disc.contact_laws.parameters import INNER, NUMBERS, ZOOMS, R
from reference_model.contact.annulus import Annulus
from reference_model.contact.contact_law import Contact, PointsOnRing, Ring, ThreeTermRing
from reference_model.systems import FloatArray

RING, EXPANSION = Ring(R), ThreeTermRing(R)

QUADRATURE = 1e-11
"""Error of an integral: ten times what the quadrature is asked for."""


def friction(law: Contact, slip: complex, rim: float, angle: float = 0.0) -> FloatArray:
    """Return (F_x, F_y, M) of ``law`` in the units and for the arguments of ``contact_integrals``."""
    force, moment = law.force_and_moment(slip, rim / R, angle)
    return np.array((force.real, force.imag, moment / R))


@functools.cache
def greatest_errors_of_expansion() -> tuple[FloatArray, FloatArray]:
    """Return for (23) U/W, size and error of the place of the greatest errors in force and in moment, shape (2, 3).

    First by the integral (20), and the same with the three terms of (22); then by the closed forms.
    """

    def by_integrals(i: int) -> Callable[[float], float]:
        return lambda ratio: abs(
            float((average_of_expansion(ratio, 1.0) - ring_by_quadrature(ratio, 1.0)[0])[i])
        )

    def by_formulas(i: int) -> Callable[[float], float]:
        return lambda ratio: abs(float((friction(EXPANSION, ratio, 1.0) - friction(RING, ratio, 1.0))[i]))

    integrals, formulas = (
        np.array([top(by(i), QUADRATURE) for i in (0, 2)]) for by in (by_integrals, by_formulas)
    )
    return integrals, formulas


def top(error: Callable[[float], float], noise: float) -> tuple[float, float, float]:
    """Return U/W where ``error`` is the largest, how large it is there, and the error of the place.

    On a parabola of curvature c, places within √(2·noise/c) of the top can't be told from it; nor does the search
    aim at better than 1e-6.
    """
    from scipy.optimize import minimize_scalar

    coarse = max(np.geomspace(1e-2, 1e2, 201).tolist(), key=error)
    found = minimize_scalar(
        lambda ratio: -error(ratio),
        bounds=(0.95 * coarse, 1.05 * coarse),
        method="bounded",
        options={"xatol": 1e-6},
    )
    place, h = float(found.x), 0.01 * coarse
    curvature = abs(error(place - h) - 2.0 * error(place) + error(place + h)) / h**2
    return place, -float(found.fun), math.sqrt(2.0 * noise / curvature) + 1e-6


@functools.cache
def greatest_errors_of_points(numbers: Sequence[int]) -> FloatArray:
    """Return what ``worst`` does for each of ``numbers`` of points, in force and in moment, shape (n, 2, 4)."""
    return np.array([[worst(number, part) for part in (slice(2), slice(2, 3))] for number in numbers])


def worst(number: int, part: slice) -> tuple[float, float, float, float]:
    """Return where the error of ``number`` points is the largest, its size, and the errors of size and place.

    The place is U/W; ``part`` selects force or moment. The largest error is next to a jump, so that a search must not
    use slopes.
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
    """Return force along the slip and moment of all laws over U/W, of points the range over φ."""
    # Beside U = W and not on it: there a point rests, which leaves less than its neighbourhood.
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
        off = (
            np.hypot(found[:, :, 0] + exact[:, :, 0], found[:, :, 1]),
            np.abs(found[:, :, 2] - exact[:, :, 1]),
        )
        data[f"points{number}_error"] = np.stack([distance.max(axis=1) for distance in off], axis=1)
    return data
