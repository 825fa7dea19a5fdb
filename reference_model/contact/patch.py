"""Contact points of a patch under uniform pressure: a quadrature over a polygon."""

from collections.abc import Iterable
from typing import Any

import numpy as np

from reference_model.contact.points import Points
from reference_model.systems import ComplexArray, finite_number, require_whole, shown

MOST_CORNERS = 300  # the time to cut triangles off grows with the cube
INSIDE = np.array([[2.0, 0.5, 0.5], [0.5, 2.0, 0.5], [0.5, 0.5, 2.0]]) / 3.0
"""Weights of a triangle's corners in the three points of the rule of degree 2.

A. H. Stroud, Approximate Calculation of Multiple Integrals, Prentice-Hall 1971, rule T2:2-1.
"""


def polygon_patch(corners: Iterable[tuple[float, float]], divisions: int) -> Points:
    """Return the contact of a polygon under uniform pressure, as points inside it.

    ``corners`` are x and y in m of at least three corners in the frame of the disc, in order around the polygon. Each
    of its triangles is cut into ``divisions``² equal triangles, at most 100², with three points each. If h is the
    longest side of these triangles, the error falls like h⁴ for a centre of rotation outside the patch, and like h²
    on average for a centre inside, where friction jumps.

    Raises ``ValueError`` if a number is invalid, or the polygon has no area or intersects itself.
    """
    require_whole("divisions", divisions, least=1, most=100)
    triangles = _triangles(_checked_corners(corners))
    pieces = np.concatenate([_divided(np.array(triangle), divisions) for triangle in triangles])
    areas = _doubled_area(*pieces.T)
    places = (pieces @ INSIDE).ravel()
    return Points(
        np.column_stack((places.real, places.imag, np.repeat(areas / (3.0 * areas.sum()), 3))).tolist()
    )


def _checked_corners(corners: Iterable[tuple[float, float]]) -> list[complex]:
    try:
        around = [complex(finite_number("corners", x), finite_number("corners", y)) for x, y in corners]
    except (TypeError, ValueError) as error:
        if "must be" in str(error):
            raise
        raise ValueError(f"corners = {shown(corners)}: it must be a list of (x, y) in m") from None
    if len(around) < 3:
        raise ValueError(f"corners = {corners}: a polygon has at least three corners")
    require_whole("number of corners", len(around), least=3, most=MOST_CORNERS)
    return around if _doubled_area(0j, np.array(around), np.roll(around, -1)).sum() > 0.0 else around[::-1]


def _triangles(around: list[complex]) -> list[tuple[complex, ...]]:
    """Cut ears off the polygon: triangles of neighbours that turn left and contain no other corner."""
    left = list(around)
    result: list[tuple[complex, ...]] = []
    while len(left) > 2:
        for i in range(len(left)):
            ear = a, b, c = left[i - 1], left[i], left[(i + 1) % len(left)]
            others = np.array([corner for corner in left if corner not in ear])
            outside = [_doubled_area(*side, others) < 0.0 for side in ((a, b), (b, c), (c, a))]
            if _doubled_area(*ear) > 0.0 and np.all(np.any(outside, axis=0)):
                result.append(ear)
                del left[i]
                break
        else:
            corners = [(corner.real, corner.imag) for corner in around]
            raise ValueError(f"corners = {corners}: the polygon has no area or intersects itself")
    return result


def _doubled_area(a: Any, b: Any, c: Any) -> Any:
    """Return twice the area, negative if the corners are in clockwise order."""
    return (np.conj(b - a) * (c - a)).imag


def _divided(triangle: ComplexArray, n: int) -> ComplexArray:
    a, b, c = triangle
    first, second = (b - a) / n, (c - a) / n
    upright = [[i * first + j * second, 1.0] for i in range(n) for j in range(n - i)]
    inverted = [[i * first + j * second, -1.0] for i in range(1, n + 1) for j in range(1, n + 1 - i)]
    starts, signs = np.array(upright + inverted).T
    return np.asarray(a + starts[:, np.newaxis] + np.multiply.outer(signs, [0j, first, second]))
