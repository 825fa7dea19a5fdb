"""The limit surface of a disc on points: the force and moment that friction can hold while all points rest.

A point slips with v_j = u + i·w·a_j, w = φ̇ − ω. Friction holds a force F and a moment M (per newton of μN, along the
slip that they drive) if for every slip their power is at most the power that friction dissipates: F·u + M·w <= P(u,
w), the mean of |v_j| weighted by the shares of the load. P is of degree one, so this is M <= h(F) and −M <= h(−F),
with h(F) = min over u of P(u, 1) − F·u. With u and M about the centre of the load P is at least |u|, so h is not
negative for |F| <= 1 and only the sign of M counts. Finding u is a Fermat-Weber problem with a pull F. It is convex,
and the solution may be a vertex, u = −i·a_j: then the disc begins to turn about point j, which stays at rest, and the
limit surface has a flat face.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from reference_model.systems import FloatArray

ComplexArray = NDArray[np.complex128]

MOST_ITERATIONS = 200

ROUNDING = 4e-16
"""Rounding error of a mean of unit vectors."""


class Limit(NamedTuple):
    """Squares of the largest moments that can be held together with given forces, and the slips for w = 1 there.

    Where the force alone is too large the squares continue as (1 − |F|)·R², which is also their leading term for |F|
    < 1. So they pass through zero with a finite slope.
    """

    squares: FloatArray
    slips: ComplexArray


@dataclass(frozen=True, eq=False)
class PointsLimit:
    """The limit surface of points with the ``arms`` (n,) in the frame of the disc and ``shares`` (n,) of the load."""

    arms: ComplexArray
    shares: FloatArray

    @cached_property
    def centre(self) -> complex:
        """Mean place of the load c. Moments about it and its slip separate force and moment where |F| = 1."""
        return complex(self.shares @ self.arms)

    @cached_property
    def radius(self) -> float:
        """Root mean square distance R of the load from its centre."""
        return math.sqrt(float(self.shares @ abs(self.arms - self.centre) ** 2))

    @cached_property
    def _vertices(self) -> ComplexArray:
        """Slips of the centre for w = 1 if one of the points rests."""
        return np.asarray(-1j * (self.arms - self.centre))

    @cached_property
    def _pulls(self) -> ComplexArray:
        """Force of the other points while the disc turns about each of them."""
        pulls = [self.shares @ _directions(vertex - self._vertices) for vertex in self._vertices]
        return np.array(pulls)

    def margins(self, forces: ComplexArray, moment: FloatArray | float) -> FloatArray:
        """Return (h² − M²)/R² for ``forces`` (t,); negative where friction cannot hold them."""
        about_centre = self._about_centre(forces, moment)
        squares = self.greatest(np.copysign(1.0, about_centre) * forces).squares
        return np.asarray((squares - about_centre**2) / self.radius**2)

    def direction(self, force: complex, moment: float) -> tuple[complex, float]:
        """Return the slip (u, w) normal to the limit surface near ``force`` and ``moment``."""
        sense = math.copysign(1.0, float(self._about_centre(force, moment)))
        slip = complex(self.greatest(np.array([sense * force])).slips[0])
        return sense * (slip - 1j * self.centre), sense

    def greatest(self, forces: ComplexArray) -> Limit:
        """Return the limit for ``forces`` (t,), with moments about the centre of the load and its slip."""
        # A point is the pivot if it can supply the force that friction of the other points leaves over.
        at_vertex = abs(forces[:, np.newaxis] - self._pulls) <= self.shares
        pivots = at_vertex.any(axis=1)
        too_much = abs(forces) >= 1.0
        far = self.radius * forces / FLAT
        slips = np.where(pivots, self._vertices[at_vertex.argmax(axis=1)], far)
        free = ~pivots & ~too_much
        slips[free] = self._fermat_weber(forces[free])
        squares = np.where(
            too_much, (1.0 - abs(forces)) * self.radius**2, self._objective(forces, slips) ** 2
        )
        return Limit(squares, slips)

    def _about_centre(self, forces: ComplexArray | complex, moment: FloatArray | float) -> FloatArray:
        return np.asarray(moment - (self.centre.conjugate() * forces).imag)

    def _objective(self, forces: ComplexArray, u: ComplexArray) -> FloatArray:
        mean = abs(u[:, np.newaxis] - self._vertices) @ self.shares
        return np.asarray(mean - (forces.conj() * u).real)

    def _fermat_weber(self, forces: ComplexArray) -> ComplexArray:
        """Minimise the mean distance minus F·u where the minimum is not at a vertex.

        Uses Newton's method, and a step of Weiszfeld's method, which always descends, where Newton's does not.
        """
        # This is exact in the limit of large |u| for points with the same spread in all directions.
        u: ComplexArray = self.radius * forces / (2.0 * np.sqrt(1.0 - abs(forces)))
        value = self._objective(forces, u)
        for _ in range(MOST_ITERATIONS):
            d = u[:, np.newaxis] - self._vertices
            distance = np.maximum(abs(d), 1e-300)
            gradient = (d / distance) @ self.shares - forces
            xx, yy = (d.imag**2 / distance**3) @ self.shares, (d.real**2 / distance**3) @ self.shares
            xy = -(d.real * d.imag / distance**3) @ self.shares
            determinant = xx * yy - xy**2
            regular = determinant > SINGULAR * (xx + yy) ** 2
            newton = u - (
                (yy * gradient.real - xy * gradient.imag) + 1j * (xx * gradient.imag - xy * gradient.real)
            ) / np.where(regular, determinant, np.inf)
            weights = self.shares / distance
            weiszfeld = (weights @ self._vertices + forces) / weights.sum(axis=1)
            after = self._objective(forces, newton)
            better = regular & (after <= value + 1e-15 * self.radius)
            new = np.where(better, newton, weiszfeld)
            done = (abs(new - u) <= 1e-12 * abs(new)) | (abs(gradient) < ROUNDING)
            u = new
            value = np.where(better, after, self._objective(forces, weiszfeld))
            if done.all():
                break
        return u


SINGULAR = 1e-12
"""Smallest determinant over the squared trace of a Hessian for Newton's method; points on one line give less."""

FLAT = 1e-9
"""Share of rotation in the slip of a disc whose force alone is too large: almost none."""


def _directions(slips: ComplexArray) -> ComplexArray:
    """Return unit vectors along ``slips``, zero where they vanish."""
    return np.asarray(slips / np.maximum(abs(slips), 1e-300))
