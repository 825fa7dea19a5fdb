"""A patch under uniform pressure as contact points: a quadrature over the area of a polygon."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

import numpy as np
from numpy.typing import NDArray

from reference_model.contact.points import Points
from reference_model.systems import finite_number, require_whole

ComplexArray = NDArray[np.complex128]

INSIDE = np.array([[2.0, 0.5, 0.5], [0.5, 2.0, 0.5], [0.5, 0.5, 2.0]]) / 3.0
"""Weights of the corners of a triangle in the three points of the rule of degree 2, which have equal shares.

A. H. Stroud, Approximate Calculation of Multiple Integrals, Prentice-Hall 1971, rule T2:2-1.
"""


def polygon_patch(corners: Iterable[tuple[float, float]], divisions: int) -> Points:
    """Return the contact of a polygon under uniform pressure, as points inside it.

    The polygon is cut into triangles, and each of them into ``divisions``² equal ones with three points each. With h
    the longest side of these triangles the error of force and moment falls like h⁴ if the centre of rotation lies
    outside the patch, and on average like h² if it lies inside, where friction jumps.

    Parameters
    ----------
    corners : sequence of (float, float)
        x and y in m of at least three corners in the frame of the disc, in order around the polygon.
    divisions : int
        Number of divisions of each side of a triangle, >= 1.

    Raises
    ------
    ValueError
        If a number is invalid or the polygon has no area or intersects itself.

    """
    require_whole("divisions", divisions, least=1)
    around = _checked_corners(corners)
    pieces = np.concatenate([_divided(np.array(triangle), divisions) for triangle in _triangles(around)])
    areas = np.array([_doubled_area(*piece) for piece in pieces])
    places = (pieces @ INSIDE).ravel()
    shares = np.repeat(areas / (3.0 * areas.sum()), 3)
    return Points(np.column_stack((places.real, places.imag, shares)).tolist())


def _checked_corners(corners: Iterable[tuple[float, float]]) -> list[complex]:
    try:
        given = [(finite_number("corners", x), finite_number("corners", y)) for x, y in corners]
    except TypeError:
        raise ValueError(f"corners = {corners!r}: it must be a list of (x, y) in m") from None
    if len(given) < 3:
        raise ValueError(f"corners = {given}: a polygon has at least three corners")
    around = [complex(x, y) for x, y in given]
    doubled_area = sum(_doubled_area(0j, a, b) for a, b in zip(around, [*around[1:], around[0]], strict=True))
    return around if doubled_area > 0.0 else around[::-1]


def _triangles(around: Sequence[complex]) -> list[tuple[complex, complex, complex]]:
    """Cut ears off a polygon whose corners are in counterclockwise order.

    A triangle of neighbours is an ear if it turns left and contains no other corner.
    """
    left, result = list(around), []
    while len(left) > 2:
        for i in range(len(left)):
            ear = (left[i - 1], left[i], left[(i + 1) % len(left)])
            if _doubled_area(*ear) > 0.0 and not any(
                _contains(ear, corner) for corner in left if corner not in ear
            ):
                result.append(ear)
                del left[i]
                break
        else:
            corners = [(corner.real, corner.imag) for corner in around]
            raise ValueError(f"corners = {corners}: the polygon has no area or intersects itself")
    return result


def _contains(triangle: tuple[complex, complex, complex], point: complex) -> bool:
    a, b, c = triangle
    return all(_doubled_area(start, end, point) >= 0.0 for start, end in ((a, b), (b, c), (c, a)))


def _doubled_area(a: complex, b: complex, c: complex) -> float:
    """Return twice the area of a triangle, negative if the corners are in clockwise order."""
    return ((b - a).conjugate() * (c - a)).imag


def _divided(triangle: ComplexArray, n: int) -> ComplexArray:
    """Return n² equal triangles, shape (n², 3)."""
    a, b, c = triangle
    first, second = (b - a) / n, (c - a) / n
    upright = [a + i * first + j * second for i in range(n) for j in range(n - i)]
    inverted = [a + i * first + j * second for i in range(1, n + 1) for j in range(1, n + 1 - i)]
    return np.array(
        [[p, p + first, p + second] for p in upright] + [[p, p - first, p - second] for p in inverted]
    )
