"""The curves in a rectangle on which a function of two variables changes its sign.

A grid tells where they are. Each is followed from point to point with no more than the sign and the zero of the
function: the next point is the zero on an arc ahead of the last one. So the function need not be smooth, and away
from its zeros it may be as good as constant.

Libraries of contours interpolate between values on a grid, and a value costs a simulation here. For a circle
contourpy is wrong by 6e-4 of the rectangle with 1,100 values, and by 1e-5 with 66,000; for a function of which only
the sign says anything, by 1e-2 with 66,000. Here 1,800 values put each point on the circle to 6e-16, and 3,400 on the
latter to 5e-13.
"""

from __future__ import annotations

import cmath
import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import brentq

from reference_model.numerics.continuation import ContinuationError, Curve
from reference_model.systems import FloatArray

ComplexArray = NDArray[np.complex128]
Function = Callable[[FloatArray], float]

TURN = 0.35
"""Largest angle in rad between neighbouring chords of the same length; where a curve bends more they are shorter."""

SHORTEST = 1e-7
"""Step, as a fraction of the rectangle, at which a curve is given up."""

MOST_POINTS = 10_000
"""Points after which a curve is given up that neither closes nor leaves the rectangle."""

EXACT = 1e-13
"""Error of a point across the curve, as a fraction of the rectangle, that its search leaves if no other is given."""

SAME = 0.25
"""Distance, in steps along a curve, up to which a zero counts as one of it."""


def dividing_curves(
    function: Function, low: FloatArray, high: FloatArray, cells: int, error: float = EXACT
) -> tuple[Curve, ...]:
    """Return the curves in a rectangle on which ``function`` changes its sign, with points of shape (n, 2).

    The limits at which a curve ends are, by their index, the lower ones of both variables, then the upper ones.

    Parameters
    ----------
    function : callable
        From a point, shape (2,), to a number; it is asked up to a cell beyond the rectangle too.
    low, high : array of shape (2,)
        The limits of the rectangle.
    cells : int
        The sides of points on a grid of as many cells in each direction tell where a curve is, and the points of a
        curve are no farther apart than a cell. What comes and goes between two points of the grid is not found.
    error : float
        Of a point across the curve, as a fraction of the rectangle, that its search may leave.

    Raises
    ------
    ContinuationError
        If a curve can't be followed, because it has no end or others are much nearer to it than a cell.

    """
    square = _Square(function, low, high, 1.0 / cells, error)
    paths: list[tuple[ComplexArray, tuple[int, ...]]] = []
    for first, second in _edges(lambda z: function(square.point(z)) > 0.0, cells):
        if any(_crosses(path, first, second) for path, _ in paths):
            continue
        start = square.zero_between(first, second)
        if all(_distance(path, start) > SAME * square.step for path, _ in paths):
            paths.append(square.follow(start, second - first))
    return tuple(Curve(np.array([square.point(z) for z in path]), ends) for path, ends in paths)


@dataclass(frozen=True)
class _Square:
    """The rectangle as the unit square of the complex plane, in which a step has the same length all over."""

    function: Function
    low: FloatArray
    high: FloatArray
    step: float
    error: float

    def point(self, z: complex) -> FloatArray:
        """Return the point, shape (2,), that ``z`` stands for."""
        return np.asarray(self.low + (self.high - self.low) * (z.real, z.imag))

    def zero(
        self, place: Callable[[float], complex], left: float, right: float, scale: float = 1.0
    ) -> float | None:
        """Return where on a path the function is zero; None if it has the same sign at both ends.

        ``scale`` is the length on the path of a unit of its parameter.
        """

        def value(parameter: float) -> float:
            return self.function(self.point(place(parameter)))

        if value(left) * value(right) > 0.0:
            return None
        return float(brentq(value, left, right, xtol=self.error / scale))

    def zero_between(self, first: complex, second: complex) -> complex:
        """Return the zero on the straight line between two points on different sides."""
        share = self.zero(lambda share: first + share * (second - first), 0.0, 1.0)
        assert share is not None
        return first + share * (second - first)

    def follow(self, start: complex, across: complex) -> tuple[ComplexArray, tuple[int, ...]]:
        """Return the curve through ``start``, shape (n,), and the limits at which it ends."""
        ahead, last = self.walk(start, 1j * across)
        if last is None:
            return np.array(ahead), ()
        behind, first = self.walk(start, -1j * across)
        if first is None:
            raise ContinuationError(f"the curve through {self.point(start)} closes in one direction only")
        return np.array([*behind[:0:-1], *ahead]), (first, last)

    def walk(self, start: complex, along: complex) -> tuple[list[complex], int | None]:
        """Return the points from ``start`` on and the limit where they end, None if they come back."""
        path, heading, width, step = [start], cmath.phase(along), 0.5 * math.pi, 0.25 * self.step
        while step > SHORTEST and len(path) < MOST_POINTS:
            home = start - path[-1]
            if len(path) > 2 and abs(home) <= step and (home * cmath.rect(1.0, -heading)).real > 0.0:
                return [*path, start], None
            turned = self.ahead(path[-1], step, heading, width)
            if turned is None:  # the curve bends or has a corner
                step, width = step / 2.0, min(1.5 * width, 0.5 * math.pi)
                continue
            point = path[-1] + cmath.rect(step, turned)
            if min(_margins(point)) <= 0.0:
                end = self.end(path[-1], step, heading)
                return path if end == path[-1] else [*path, end], int(np.argmin(_margins(end)))
            path.append(point)
            heading, width, step = turned, TURN, min(1.5 * step, self.step)
        raise ContinuationError(f"the curve can't be followed beyond {self.point(path[-1])}")

    def ahead(self, last: complex, step: float, heading: float, width: float) -> float | None:
        """Return in which direction, not more than ``width`` off ``heading``, the curve is a ``step`` ahead."""
        return self.zero(lambda angle: last + cmath.rect(step, angle), heading - width, heading + width, step)

    def end(self, last: complex, step: float, heading: float) -> complex:
        """Return the point less than a ``step`` ahead at which the first limit is reached."""

        def point(part: float) -> complex:
            turned = self.ahead(last, part, heading, 0.5 * math.pi)
            if turned is None:
                raise ContinuationError(f"the curve can't be followed from {self.point(last)} to the limit")
            return last + cmath.rect(part, turned)

        def inside(part: float) -> float:
            return min(_margins(point(part)))

        if inside(SHORTEST) <= 0.0:
            return last
        return point(brentq(inside, SHORTEST, step, xtol=self.error))


def _margins(z: complex) -> tuple[float, float, float, float]:
    """Return the distances from the limits of the square, positive inside."""
    return z.real, z.imag, 1.0 - z.real, 1.0 - z.imag


def _edges(side: Callable[[complex], bool], cells: int) -> Iterator[tuple[complex, complex]]:
    """Yield the edges of a grid over the unit square whose ends lie on different sides, those on its rim last."""
    ticks = np.arange(cells + 1) / cells
    nodes = ticks[:, np.newaxis] + 1j * ticks
    sides = np.vectorize(side, otypes=[bool])(nodes)
    edges = [
        (first, second)
        for a, b, change in (
            (nodes[:-1], nodes[1:], sides[:-1] != sides[1:]),
            (nodes[:, :-1], nodes[:, 1:], sides[:, :-1] != sides[:, 1:]),
        )
        for first, second in zip(a[change].tolist(), b[change].tolist(), strict=True)
    ]
    yield from sorted(edges, key=lambda edge: min(_margins(0.5 * (edge[0] + edge[1]))) == 0.0)


def _crosses(path: ComplexArray, first: complex, second: complex) -> bool:
    """Tell whether the polygon through the points of ``path``, shape (n,), crosses the line between two others."""
    chords = np.diff(path)
    across = _cross(second - first, path - first)
    ends = _cross(chords, first - path[:-1]) * _cross(chords, second - path[:-1])
    return bool(np.any((across[:-1] * across[1:] < 0.0) & (ends < 0.0)))


def _cross(a: ComplexArray | complex, b: ComplexArray) -> FloatArray:
    return np.asarray((np.conj(a) * b).imag)


def _distance(path: ComplexArray, point: complex) -> float:
    """Return the distance of a ``point`` from the polygon through the points of ``path``, shape (n,)."""
    chords, to_point = np.diff(path), point - path[:-1]
    share = np.clip((np.conj(chords) * to_point).real / np.abs(chords) ** 2, 0.0, 1.0)
    return float(np.min(np.abs(to_point - share * chords)))
