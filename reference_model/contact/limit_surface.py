"""The limit surface of a contact: the force and moment that friction can hold while the disc rests.

A point slips with v_j = u + i·w·a_j, w = φ̇ − ω. Friction holds a force F and a moment M (per newton of μN) if F·u +
M·w <= P(u, w) for every slip, where P is the mean of |v_j| weighted by the shares of the load. P is of degree one, so
this is M <= h(F) and −M <= h(−F), with h(F) = min over u of P(u, 1) − F·u. About the centre of the load h >= 0 for
|F| <= 1, and only the sign of M counts. Finding u is a convex Fermat-Weber problem with a pull F. If its solution is
a vertex, u = −i·a_j, the disc begins to turn about the resting point j.

Experiments only partially confirm this: S. R. Dahmen, Z. Farkas, H. Hinrichsen and D. E. Wolf, Physical Review E 71
(2005) 066602; P. D. Weidman and C. P. Malhotra, On the terminal motion of sliding spinning disks with uniform Coulomb
friction, 2007.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.optimize import brentq

from reference_model.contact.contact_law import IsotropicContact, Shares, checked_contact, checked_vector
from reference_model.contact.points import Points
from reference_model.systems import ComplexArray, FloatArray, finite_number

MOST_ITERATIONS = 200

ROUNDING = 4e-16
"""Rounding error of a mean of unit vectors."""


def wrench_of_slip(contact: IsotropicContact | Points, slip: complex, spin: float) -> tuple[complex, float]:
    """Return the force (N per N of μN) and the moment (m) about the centre that drive a slip of a disc at φ = 0.

    The slip, u of the centre in m/s and w = φ̇ − ω in rad/s, is normal to the limit surface there.
    """
    slip, spin = checked_vector("slip", slip), finite_number("spin", spin)
    friction, moment = checked_contact(contact).force_and_moment(slip, -spin, 0.0)
    return -friction, -moment


def largest_wrench(
    contact: IsotropicContact | Points, force: complex, moment: float
) -> tuple[complex, float]:
    """Return the largest multiple of a force and a moment that friction can hold at φ = 0.

    ``force`` and ``moment`` (about the centre, in m times the unit of the force) give the direction. The result is in
    N per N of μN and in m. Raises ``ValueError`` if both are zero.
    """
    contact, force = checked_contact(contact), checked_vector("force", force)
    moment = finite_number("moment", moment)
    if force == 0.0 and moment == 0.0:
        raise ValueError("force and moment are 0: they must have a direction")
    if isinstance(contact, Points):
        factor = PointsLimit.of(contact).factor(force, moment)
    else:
        factor = _factor_of_circles(contact, abs(force), abs(moment))
    return factor * force, factor * moment


def _factor_of_circles(contact: IsotropicContact, force: float, moment: float) -> float:
    lever = contact.shares(0.0, 1.0).moment
    if lever == 0.0:
        return 0.0 if moment > 0.0 else 1.0 / force

    def load(alpha: float) -> tuple[float, float]:
        return contact.shares(math.cos(alpha), math.sin(alpha) / lever)

    def excess(alpha: float) -> float:
        resistance, resisted = load(alpha)
        return resistance * moment - resisted * force

    if force == 0.0 or moment == 0.0:
        return lever / moment if force == 0.0 else 1.0 / force
    alpha = float(brentq(excess, 0.0, math.pi / 2.0, xtol=1e-16, rtol=1e-15))
    return math.hypot(load(alpha)[0], load(alpha)[1] / lever) / math.hypot(force, moment / lever)


def force_beside(contact: IsotropicContact, load: float, moment: float) -> float | None:
    """Return the largest force in N that friction can hold with a moment >= 0 in N m, None if it cannot hold this.

    ``load`` is μN in N. As S ~ sin α grows, the moment on the limit surface grows and the force falls.
    """
    most = contact.shares(0.0, 1.0).moment
    if moment > load * most:
        return None

    def held(alpha: float) -> Shares:
        return contact.shares(math.cos(alpha), math.sin(alpha) / most)

    alpha = 0.0
    if moment > 0.0:
        quarter = math.pi / 2.0
        alpha = float(brentq(lambda a: load * held(a).moment - moment, 0.0, quarter, xtol=1e-16, rtol=1e-15))
    return load * held(alpha).resistance


@dataclass(frozen=True, eq=False)
class PointsLimit:
    """The limit surface of points with ``arms`` (n,) in the frame of the disc and ``shares`` (n,) of the load."""

    arms: ComplexArray
    shares: FloatArray

    @classmethod
    def of(cls, contact: Points, length: float = 1.0) -> PointsLimit:
        return cls(np.array(contact.arms(0.0), dtype=np.complex128) / length, np.array(contact.shares))

    @cached_property
    def centre(self) -> complex:
        """Centre of the load, about which moments and slips separate force and moment where |F| = 1."""
        return complex(self.shares @ self.arms)

    @cached_property
    def radius(self) -> float:
        return math.sqrt(float(self.shares @ abs(self.arms - self.centre) ** 2))

    @cached_property
    def _vertices(self) -> ComplexArray:
        return np.asarray(-1j * (self.arms - self.centre))

    @cached_property
    def _pulls(self) -> ComplexArray:
        """Force of the other points while the disc turns about each point."""
        pulls = [self.shares @ _directions(vertex - self._vertices) for vertex in self._vertices]
        return np.array(pulls)

    def margins(self, forces: ComplexArray, moment: FloatArray | float) -> FloatArray:
        """Return (h² − M²)/R² for ``forces`` (t,); negative where friction cannot hold them."""
        about_centre = self._about_centre(forces, moment)
        squares, _ = self.greatest(np.copysign(1.0, about_centre) * forces)
        return np.asarray((squares - about_centre**2) / self.radius**2)

    def direction(self, force: complex, moment: float) -> tuple[complex, float]:
        """Return the slip (u, w) normal to the limit surface near ``force`` and ``moment``."""
        sense = math.copysign(1.0, float(self._about_centre(force, moment)))
        slip = complex(self.greatest(np.array([sense * force]))[1][0])
        return sense * (slip - 1j * self.centre), sense

    def factor(self, force: complex, moment: float) -> float:
        lever = float(self.shares @ abs(self.arms - self.centre))
        most = 1.0 / max(abs(force), abs(float(self._about_centre(force, moment))) / lever)

        def margin(factor: float) -> float:
            return float(self.margins(np.array([factor * force]), factor * moment)[0])

        return most if margin(most) >= 0.0 else float(brentq(margin, 0.0, most, xtol=1e-300, rtol=1e-15))

    def greatest(self, forces: ComplexArray) -> tuple[FloatArray, ComplexArray]:
        """Return the squares of the largest moments that can be held with ``forces`` (t,), and the slips for w = 1.

        Both are about the centre of the load. Where the force alone is too large the squares continue as (1 −
        |F|)·R², so they pass through zero with a finite slope.
        """
        # A point is the pivot if it can supply the remaining force.
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
        return squares, slips

    def _about_centre(self, forces: ComplexArray | complex, moment: FloatArray | float) -> FloatArray:
        return np.asarray(moment - (self.centre.conjugate() * forces).imag)

    def _objective(self, forces: ComplexArray, u: ComplexArray) -> FloatArray:
        mean = abs(u[:, np.newaxis] - self._vertices) @ self.shares
        return np.asarray(mean - (forces.conj() * u).real)

    def _fermat_weber(self, forces: ComplexArray) -> ComplexArray:
        """Minimise the mean distance minus F·u, which is convex, away from vertices.

        Armijo's rule halves Newton's steps. Where a halved step descends less, Weiszfeld's method replaces it.
        """
        # Exact for large |u| and points with the same spread in all directions.
        u: ComplexArray = self.radius * forces / (2.0 * np.sqrt(1.0 - abs(forces)))
        value = self._objective(forces, u)
        for _ in range(MOST_ITERATIONS):
            d = u[:, np.newaxis] - self._vertices
            distance = np.maximum(abs(d), 1e-300)
            gradient = (d / distance) @ self.shares - forces
            xx, yy = (d.imag**2 / distance**3) @ self.shares, (d.real**2 / distance**3) @ self.shares
            xy = -(d.real * d.imag / distance**3) @ self.shares
            determinant = np.maximum(xx * yy - xy**2, SINGULAR * (xx + yy) ** 2)
            step = (xy * gradient.imag - yy * gradient.real) + 1j * (xy * gradient.real - xx * gradient.imag)
            step /= determinant
            slope = ARMIJO * (gradient.conj() * step).real
            after, halved = self._objective(forces, u + step), np.zeros(len(u), dtype=bool)
            for _ in range(MOST_HALVINGS):
                worse = after > value + slope + 1e-15 * self.radius
                if not worse.any():
                    break
                step[worse] *= 0.5
                slope[worse] *= 0.5
                after[worse] = self._objective(forces[worse], (u + step)[worse])
                halved |= worse
            if halved.any():
                weights = self.shares / distance
                weiszfeld = (weights @ self._vertices + forces) / weights.sum(axis=1)
                by_weiszfeld = self._objective(forces, weiszfeld)
                better = halved & (by_weiszfeld < after)
                step = np.where(better, weiszfeld - u, step)
                after = np.where(better, by_weiszfeld, after)
            u, value = u + step, after
            if np.all((abs(step) <= 1e-12 * abs(u)) | (abs(gradient) < ROUNDING)):
                break
        return u


SINGULAR = 1e-15
"""Smallest ratio of determinant to squared trace of a Hessian, zero for points on one line."""

ARMIJO = 1e-4
"""Smallest ratio of a step's descent to the descent that the slope predicts."""

MOST_HALVINGS = 60

FLAT = 1e-9
"""Share of rotation in the slip of a disc whose force alone is too large."""


def _directions(slips: ComplexArray) -> ComplexArray:
    return np.asarray(slips / np.maximum(abs(slips), 1e-300))
