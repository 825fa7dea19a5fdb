"""What the friction of points on a ring can hold: the limit surface of a disc that rests as a whole.

With the slip of a point v_j = u + i·w·a_j, w = φ̇ − ω, friction holds a force F and a moment M (both as shares, along
the slip that they drive) if they put less power into any slip than friction takes: F·u + M·w <= P(u, w), the
mean of |v_j|. As P is of degree one, that is M <= h(F) and −M <= h(−F) with h(F) = min over u of P(u, 1) − F·u; as P
is not less than |u|, h is not negative for |F| <= 1, and only the one with the sign of M counts. To find u is a
problem of Fermat and Weber with a pull F: convex, and the solution may be a vertex, u = −i·a_j. Then the disc begins
to turn about point j, which goes on resting: the limit surface has a flat face there.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from reference_model.systems import FloatArray

ComplexArray = NDArray[np.complex128]

MOST_ITERATIONS = 200

ROUNDING = 4e-16
"""Of a mean of unit vectors."""


class Limit(NamedTuple):
    """Squares of the greatest moments beside some forces, and the slips u for w = 1 that go with them.

    The squares are continued where the force alone is too large, by (1 − |F|)·R², as which they start on the other
    side: so they fall through zero there with a slope that is finite.
    """

    squares: FloatArray
    slips: ComplexArray


@dataclass(frozen=True, eq=False)
class PointsLimit:
    """The limit surface of points with the arms ``arms`` (n,), in the frame of the disc."""

    arms: ComplexArray

    def margins(self, forces: ComplexArray, moment: float) -> FloatArray:
        """Return h² − M² over R² for ``forces`` (t,); negative where friction gives way."""
        squares = self.greatest(math.copysign(1.0, moment) * forces).squares
        return np.asarray((squares - moment**2) / abs(self.arms[0]) ** 2)

    def direction(self, force: complex, moment: float) -> tuple[complex, float]:
        """Return slip (u, w) normal to the limit surface near to ``force`` and ``moment``."""
        sense = math.copysign(1.0, moment)
        return sense * complex(self.greatest(np.array([sense * force])).slips[0]), sense

    def greatest(self, forces: ComplexArray) -> Limit:
        """Return what can be held beside ``forces`` (shape (t,))."""
        radius, vertices = abs(self.arms[0]), -1j * self.arms
        n = len(vertices)
        apart = vertices[:, np.newaxis] - vertices
        distance = abs(apart) + np.eye(n)
        # A point is the pivot if it can give what friction of the others leaves over.
        left = forces[:, np.newaxis] - (apart / distance).sum(axis=1) / n
        at_vertex = abs(left) <= 1.0 / n
        pivots = at_vertex.any(axis=1)
        too_much = abs(forces) >= 1.0
        slips = np.where(pivots, vertices[at_vertex.argmax(axis=1)], radius * forces / FLAT)
        free = ~pivots & ~too_much
        slips[free] = _fermat_weber(vertices, forces[free])
        squares = np.where(
            too_much, (1.0 - abs(forces)) * radius**2, _objective(vertices, forces, slips) ** 2
        )
        return Limit(squares, slips)


FLAT = 1e-9
"""Share of turning in the slip of a disc whose force alone is too large: next to none."""


def _objective(vertices: ComplexArray, forces: ComplexArray, u: ComplexArray) -> FloatArray:
    """Return the mean distance from the vertices less F·u."""
    result: FloatArray = abs(u[:, np.newaxis] - vertices).mean(axis=1) - (forces.conj() * u).real
    return result


def _fermat_weber(vertices: ComplexArray, forces: ComplexArray) -> ComplexArray:
    """Minimise the mean distance less F·u where the minimum is at no vertex.

    By Newton's method, and where that does not go down by Weiszfeld's, which always does.
    """
    u: ComplexArray = (
        abs(vertices[0]) * forces / (2.0 * np.sqrt(1.0 - abs(forces)))
    )  # right where |u| is large
    value = _objective(vertices, forces, u)
    for _ in range(MOST_ITERATIONS):
        d = u[:, np.newaxis] - vertices
        distance = np.maximum(abs(d), 1e-300)
        gradient = (d / distance).mean(axis=1) - forces
        xx = (d.imag**2 / distance**3).mean(axis=1)
        yy = (d.real**2 / distance**3).mean(axis=1)
        xy = -(d.real * d.imag / distance**3).mean(axis=1)
        determinant = xx * yy - xy**2
        newton = u - (
            (yy * gradient.real - xy * gradient.imag) + 1j * (xx * gradient.imag - xy * gradient.real)
        ) / np.where(determinant > 0.0, determinant, np.inf)
        weights = 1.0 / distance
        weiszfeld = ((vertices * weights).sum(axis=1) + len(vertices) * forces) / weights.sum(axis=1)
        after = _objective(vertices, forces, newton)
        better = after <= value + 1e-15 * abs(vertices[0])
        new = np.where(better, newton, weiszfeld)
        done = (abs(new - u) <= 1e-12 * abs(new)) | (abs(gradient) < ROUNDING)
        u = new
        value = np.where(better, after, _objective(vertices, forces, weiszfeld))
        if done.all():
            break
    return u
