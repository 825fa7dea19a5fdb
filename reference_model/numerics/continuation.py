"""Solution curves of d − 1 equations in d unknowns, by pseudo-arclength continuation.

Each point is predicted along the tangent and corrected across it by Newton's method, so a curve may turn back in
every unknown (Keller 1977, Numerical solution of bifurcation and nonlinear eigenvalue problems).
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike
from scipy.optimize import brentq

from reference_model.systems import FloatArray

Function = Callable[[FloatArray], FloatArray]

DIFFERENCE = 6e-6
"""Step of the central differences in units of the scales: about the cube root of the rounding error."""

CONVERGED = 1e-7
"""Correction below which one more iteration leaves only rounding errors."""

ITERATIONS = 8
QUICK = 3
"""Largest number of Newton iterations, and largest number that lets the step grow."""

TURN = 0.97
"""Smallest cosine of the angle between the tangents at neighbouring points."""

SHORTEST = 1e-9


class ContinuationError(RuntimeError):
    """A curve could not be followed; the message says where."""


@dataclass(frozen=True, eq=False)
class Curve:
    """Points along a curve, shape (n, d); a closed curve repeats its first point at the end.

    ``ends`` are the indices of the limits at its first and last point; empty for a closed curve.
    """

    points: FloatArray
    ends: tuple[int, ...]

    @property
    def closed(self) -> bool:
        """True if the curve returns to its first point."""
        return not self.ends


def follow(
    equations: Function, limits: Function, start: ArrayLike, scales: ArrayLike, *, step: float = 0.03
) -> Curve:
    """Follow the curve through ``start`` in both directions until it reaches a limit or closes.

    Raises ``ContinuationError`` if Newton's method does not converge.

    Parameters
    ----------
    equations
        Takes the unknowns, shape (d,), and returns d − 1 residuals that are zero on the curve.
    limits
        Takes the unknowns and returns numbers, shape (m,), that are positive in the region of interest. Both
        functions are also called a little beyond it.
    start, scales : array of shape (d,)
        A point near the curve, and changes of the unknowns that count as equally large.
    step
        Largest distance between neighbouring points in units of ``scales``.

    """
    tracer = _Tracer(equations, limits, np.asarray(scales, dtype=float), step)
    near = np.asarray(start, dtype=float) / tracer.scales
    first, tangent, _ = tracer.corrected(near, tracer.tangent(near))
    points, last = tracer.walk(first, tangent)
    if last is None:
        return Curve(np.array(points) * tracer.scales, ())
    before, end = tracer.walk(first, -tangent)
    if end is None:
        raise ContinuationError(f"the curve through {first * tracer.scales} closes in one direction only")
    return Curve(np.array([*before[:0:-1], *points]) * tracer.scales, (end, last))


@dataclass(frozen=True, eq=False)
class _Tracer:
    equations: Function
    limits: Function
    scales: FloatArray
    step: float

    def walk(self, first: FloatArray, direction: FloatArray) -> tuple[list[FloatArray], int | None]:
        """Return the points from ``first`` on and the limit at their end, or None if the curve closes."""
        points, tangent, step = [first], direction, self.step / 4.0
        while step > SHORTEST:
            try:
                point, turned, iterations = self.corrected(points[-1] + step * tangent, tangent)
            except (ContinuationError, ArithmeticError, ValueError, np.linalg.LinAlgError):
                step /= 2.0
                continue
            turned *= np.sign(turned @ tangent)
            if turned @ tangent < TURN:
                step /= 2.0
                continue
            if np.any(self.limits(point * self.scales) <= 0.0):
                end, reached = self.end(points[-1], point)
                return [*points, end], reached
            points.append(point)
            passed = (points[-2] - first) @ direction < 0.0 <= (point - first) @ direction
            if passed and np.linalg.norm(point - first) <= 2.0 * step:
                return [*points[:-1], first], None
            tangent = turned
            step = min(1.5 * step, self.step) if iterations <= QUICK else step
        raise ContinuationError(f"the curve can't be followed beyond {points[-1] * self.scales}")

    def end(self, inside: FloatArray, outside: FloatArray) -> tuple[FloatArray, int]:
        """Return the first point between two others that lies on a limit, and the index of that limit."""
        chord = outside - inside

        def between(share: float) -> FloatArray:
            return self.corrected(inside + share * chord, chord)[0]

        violated = np.flatnonzero(self.limits(outside * self.scales) <= 0.0).tolist()
        shares = [
            brentq(lambda share, i=i: self.limits(between(share) * self.scales)[i], 0.0, 1.0, xtol=1e-14)
            for i in violated
        ]
        first = int(np.argmin(shares))
        return between(shares[first]), violated[first]

    def corrected(self, near: FloatArray, across: FloatArray) -> tuple[FloatArray, FloatArray, int]:
        """Return the curve point in the plane through ``near`` normal to ``across``, its tangent, and iterations."""

        def excess(point: FloatArray) -> FloatArray:
            return np.append(self.equations(point * self.scales), across @ (point - near))

        point, converged = near, False
        for iteration in range(1, ITERATIONS + 1):
            if not converged:
                slopes = _slopes(excess, point)
            correction = np.linalg.solve(slopes, excess(point))
            point = point - correction
            if converged:
                return point, _along(slopes[:-1]), iteration - 1
            converged = bool(np.linalg.norm(correction) < CONVERGED)
        raise ContinuationError(f"Newton's method finds no point of the curve near {near * self.scales}")

    def tangent(self, point: FloatArray) -> FloatArray:
        return _along(_slopes(lambda unknowns: self.equations(unknowns * self.scales), point))


def _along(slopes: FloatArray) -> FloatArray:
    return np.asarray(np.linalg.svd(slopes / np.linalg.norm(slopes, axis=1, keepdims=True))[2][-1])


def _slopes(function: Function, point: FloatArray) -> FloatArray:
    columns = []
    for i in range(len(point)):
        shift = np.zeros(len(point))
        shift[i] = DIFFERENCE
        columns.append((function(point + shift) - function(point - shift)) / (2.0 * DIFFERENCE))
    return np.column_stack(columns)
