"""The limit surface of a disc on points: the force and moment that friction can hold while all points rest.

A point slips with v_j = u + i·w·a_j, w = φ̇ − ω. Friction holds a force F and a moment M (per newton of μN, along the
slip that they drive) if for every slip their power is at most the power that friction dissipates: F·u + M·w <= P(u,
w), the mean of |v_j|. P is of degree one, so this is M <= h(F) and −M <= h(−F) with h(F) = min over u of P(u, 1) −
F·u. P is at least |u|, so h is not negative for |F| <= 1 and only the sign of M counts. Finding u is a Fermat-Weber
problem with a pull F. It is convex, and the solution may be a vertex, u = −i·a_j: then the disc begins to turn about
point j, which stays at rest, and the limit surface has a flat face.
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
"""Rounding error of a mean of unit vectors."""


class Limit(NamedTuple):
    """Squares of the largest moments that can be held together with given forces, and the slips u for w = 1 there.

    Where the force alone is too large the squares continue as (1 − |F|)·R², which is also their leading term for |F|
    < 1. So they pass through zero with a finite slope.
    """

    squares: FloatArray
    slips: ComplexArray


@dataclass(frozen=True, eq=False)
class PointsLimit:
    """The limit surface of points with the arms ``arms``, shape (n,), in the frame of the disc."""

    arms: ComplexArray

    def margins(self, forces: ComplexArray, moment: float) -> FloatArray:
        """Return (h² − M²)/R² for ``forces`` (t,); negative where friction cannot hold them."""
        squares = self.greatest(math.copysign(1.0, moment) * forces).squares
        return np.asarray((squares - moment**2) / abs(self.arms[0]) ** 2)

    def direction(self, force: complex, moment: float) -> tuple[complex, float]:
        """Return the slip (u, w) normal to the limit surface near ``force`` and ``moment``."""
        sense = math.copysign(1.0, moment)
        return sense * complex(self.greatest(np.array([sense * force])).slips[0]), sense

    def greatest(self, forces: ComplexArray) -> Limit:
        """Return the limit for ``forces`` (t,)."""
        radius, vertices = abs(self.arms[0]), -1j * self.arms
        n = len(vertices)
        apart = vertices[:, np.newaxis] - vertices
        distance = abs(apart) + np.eye(n)
        # A point is the pivot if it can supply the force that friction of the other points leaves over.
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
"""Share of rotation in the slip of a disc whose force alone is too large: almost none."""


def _objective(vertices: ComplexArray, forces: ComplexArray, u: ComplexArray) -> FloatArray:
    result: FloatArray = abs(u[:, np.newaxis] - vertices).mean(axis=1) - (forces.conj() * u).real
    return result


def _fermat_weber(vertices: ComplexArray, forces: ComplexArray) -> ComplexArray:
    """Minimise the mean distance minus F·u where the minimum is not at a vertex.

    Uses Newton's method, and a step of Weiszfeld's method, which always descends, where Newton's does not.
    """
    u: ComplexArray = (
        abs(vertices[0]) * forces / (2.0 * np.sqrt(1.0 - abs(forces)))
    )  # exact in the limit of large |u|
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
