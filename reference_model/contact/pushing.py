"""Quasi-static pushing: a hand pushes a body that slides on contact points, with exact friction and no inertia.

The hand is a point that pushes a straight edge and never pulls. If it sticks to the edge, the body turns with the
least friction power (Moreau's principle), so its friction has no moment about the hand. If this needs a force outside
the hand's friction cone, the hand slides and pushes along the side of the cone. The motion is then normal to the
limit surface of the contact. The load does not matter, because it multiplies all forces.

S. Goyal, A. Ruina and J. Papadopoulos, Planar sliding with dry friction, Wear 143 (1991) 307-330.
K. M. Lynch and M. T. Mason, Stable pushing: mechanics, controllability, and planning, International Journal of
Robotics Research 15 (1996) 533-556.
"""

import cmath
import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.optimize import brentq

from reference_model.contact.contact_law import checked_vector
from reference_model.contact.limit_surface import PointsLimit
from reference_model.contact.points import Points
from reference_model.systems import finite_number, require_kind, require_whole

ACROSS_JUMP = 1e-9
"""Distance of two spins on both sides of a jump of the moment, relative to the largest possible spin."""

INSIDE = 1e-9
"""Rounding error of the gap between hand and edge, relative to the length of the path."""


@dataclass(frozen=True, eq=False)
class Pushing:
    """A body on ``contact`` that a hand pushes at a straight edge.

    ``edge`` is a point (m) of the edge, and ``normal`` of any length points into the body. Both are complex, x + iy,
    in the frame of the body. ``friction_coefficient`` >= 0 is the coefficient between hand and edge. Raises
    ``ValueError`` for invalid numbers.
    """

    contact: Points
    edge: complex
    normal: complex
    friction_coefficient: float

    def __post_init__(self) -> None:
        require_kind("contact", self.contact, Points)
        for name in ("edge", "normal"):
            object.__setattr__(self, name, checked_vector(name, getattr(self, name)))
        if self.normal == 0.0:
            raise ValueError("normal = 0: it must point into the body")
        if finite_number("friction_coefficient", self.friction_coefficient) < 0.0:
            raise ValueError(f"friction_coefficient = {self.friction_coefficient:g}: it must be >= 0")

    def pose(self, start: complex, end: complex, steps: int = 5) -> tuple[complex, float]:
        """Return the displacement (m) and turn (rad) of a body at 0 that a hand pushes from ``start`` to ``end``.

        The body rests until the hand touches the edge, and after the hand leaves it. Midpoint steps have an error of
        second order in 1/``steps``. Raises ``ValueError`` if the hand starts inside the body.
        """
        start, end = checked_vector("start", start), checked_vector("end", end)
        require_whole("steps", steps, least=1)
        way = end - start
        gap, approach = ((vector * self.normal.conjugate()).real for vector in (self.edge - start, way))
        if gap < -INSIDE * abs(approach):
            raise ValueError(f"start = {start}: the hand must start outside the body")
        position, angle = 0.0j, 0.0
        if gap >= approach:
            return position, angle
        step = (1.0 - gap / approach) / steps
        for i in range(steps):
            hand = start + (gap / approach + i * step) * way
            slip, spin = self.motion(hand, way, position, angle)
            middle = position + 0.5 * step * slip, angle + 0.5 * step * spin
            slip, spin = self.motion(hand + 0.5 * step * way, way, *middle)
            position, angle = position + step * slip, angle + step * spin
        return position, angle

    def motion(
        self, hand: complex, velocity: complex, position: complex = 0.0j, angle: float = 0.0
    ) -> tuple[complex, float]:
        """Return the velocity (m/s) and spin (rad/s) of a body that a hand touches.

        ``hand`` (m) and its ``velocity`` (m/s) are in the frame of ``position`` (m). A hand that moves away from the
        edge leaves the body at rest.
        """
        turn = cmath.exp(1j * angle)
        arm, velocity = (hand - position) / turn, velocity / turn  # in the frame of the body
        if (velocity * self.normal.conjugate()).real <= 0.0:
            return 0.0j, 0.0
        slip, spin, force = self._sticking(arm, velocity)
        cone, lean = math.atan(self.friction_coefficient), cmath.phase(force / self.normal)
        if abs(lean) > cone:
            slip, spin = self._sliding(
                arm, velocity, self.normal * cmath.rect(1.0, math.copysign(cone, lean))
            )
        return slip * turn, spin

    @cached_property
    def _limit(self) -> PointsLimit:
        return PointsLimit.of(self.contact)

    def _sticking(self, arm: complex, velocity: complex) -> tuple[complex, float, complex]:
        """Return slip, spin and the force (N per N of μN) of a hand that sticks."""
        arms, shares = self._limit.arms - arm, self._limit.shares

        def resistance(spin: float) -> tuple[complex, float]:
            slips = velocity + 1j * spin * arms
            forces = shares * slips / np.maximum(abs(slips), 1e-300)
            return complex(forces.sum()), float((arms.conj() * forces).imag.sum())

        # A faster spin needs more power than a translation.
        most = 2.0 * abs(velocity) / float(shares @ abs(arms))
        spin = float(brentq(lambda spin: resistance(spin)[1], -most, most, xtol=1e-14 * most))
        # The friction of a resting point lies between its values on both sides.
        (below, low), (above, high) = (resistance(spin + side * ACROSS_JUMP * most) for side in (-1.0, 1.0))
        force = complex(np.interp(0.0, (low, high), (below, above)))
        return velocity - 1j * spin * arm, spin, force

    def _sliding(self, arm: complex, velocity: complex, force: complex) -> tuple[complex, float]:
        """Return slip and spin for a hand that slides and pushes in the direction of ``force``."""
        moment = (arm.conjugate() * force).imag
        factor = self._limit.factor(force, moment)
        slip, spin = self._limit.direction(factor * force, factor * moment)
        normal = self.normal.conjugate()
        scale = (velocity * normal).real / ((slip + 1j * spin * arm) * normal).real
        return scale * slip, scale * spin
