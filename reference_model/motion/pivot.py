"""A disc on single points of which one slips slowly or rests on the master disc, while the disc turns about it.

Coordinates are x, y, φ, r = κ(φ̇ − ω) and, while it slips, the velocity v of that point, from which all others
follow: v_j = v + i(r/κ)(a_j − a_i) with the arms a of the points. So v keeps its digits down to zero. The point
accelerates by B + Gλ, where λ is its own friction over the mass, B all else and G = 1 + (i·a_i)⊗(i·a_i)/κ² what a
force at it does there. Slip has λ = −(g/n)·v/|v|; at rest λ = −G⁻¹B, as long as that is not more than g/n.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import cast

import numpy as np
from scipy.optimize import brentq

from reference_model.contact.contact_law import NONE, PointsOnRing
from reference_model.motion.disc_equations import DiscMotion
from reference_model.motion.slip.coordinates import LEAST_SLIP, Coordinates, stop_surfaces
from reference_model.motion.stepper import Thresholds
from reference_model.systems import FloatArray

CLOSE = 0.25
"""Slip of a point is slow only if it is below this fraction of the speed by which the next points pass it."""


@dataclass(frozen=True)
class OnePoint:
    """Equations of motion of a disc in the coordinates of one of its points.

    Parameters
    ----------
    motion : DiscMotion
        The disc.
    contact : PointsOnRing
        Its contact.
    point : int
        Which of the points.

    """

    motion: DiscMotion
    contact: PointsOnRing
    point: int

    @property
    def at_once(self) -> OnePoint:
        """The same for arrays of shape (k,) in place of numbers."""
        motion = self.motion.at_once
        return OnePoint(motion, cast(PointsOnRing, motion.contact), self.point)

    @property
    def most(self) -> float:
        """The greatest friction of the point over the mass, g/n."""
        return self.motion.centre.friction / self.contact.points

    def arm(self, angle: float) -> complex:
        """Return the arm of the point."""
        return self.contact.arm(self.point, angle) / self.motion.length

    @property
    def leverage(self) -> float:
        """The arm over the radius of gyration, but at least one: the errors of r matter so much."""
        return max(1.0, abs(self.arm(0.0)) / self.motion.gyration)

    def velocity(self, unknowns: Sequence[float]) -> complex:
        """Return the slip velocity of the point for the standard unknowns of the disc."""
        _, _, angle, ux, uy, r = unknowns
        return complex(ux, uy) + 1j * r / self.motion.gyration * self.arm(angle)

    def slipping_rates(self, unknowns: Sequence[float]) -> tuple[float, ...]:
        """Return the rates of x, y, φ, r, v_x, v_y; where the point rests, without its own friction."""
        v = unknowns[4] + 1j * unknowns[5]
        carried, spin_up, arm, free = self._without_friction(unknowns, v)
        friction = -self.most * (v / (abs(v) + NONE))
        torque = (arm.conjugate() * friction).imag / self.motion.gyration
        acceleration = free + friction + 1j * arm * torque / self.motion.gyration
        return (*carried, spin_up + torque, acceleration.real, acceleration.imag)

    def pivoting_rates(self, unknowns: Sequence[float]) -> tuple[float, ...]:
        """Return the rates of x, y, φ, r while the point rests."""
        carried, spin_up, arm, free = self._without_friction(unknowns, 0j)
        torque = (arm.conjugate() * self._holding(arm, free)).imag / self.motion.gyration
        return (*carried, spin_up + torque)

    def holding(self, unknowns: Sequence[float]) -> complex:
        """Return the friction over the mass that keeps the point at rest."""
        _, _, arm, free = self._without_friction(unknowns, 0j)
        return self._holding(arm, free)

    def leaving(self, unknowns: Sequence[float]) -> FloatArray:
        """Return the direction in which the point begins to slip, a unit vector e with B − (g/n)·G·e = c·e, c >= 0.

        Its parts along the arm and across it are B_∥/(c + g/n) and B_⊥/(c + (g/n)·(1 + |a|²/κ²)).
        """
        _, _, arm, free = self._without_friction(unknowns, 0j)
        along = free * arm.conjugate() / abs(arm)
        stiffer = 1.0 + (abs(arm) / self.motion.gyration) ** 2

        def part(c: float) -> complex:
            return complex(along.real / (c + self.most), along.imag / (c + self.most * stiffer))

        c = 0.0
        if abs(part(0.0)) > 1.0:
            c = float(brentq(lambda c: abs(part(c)) - 1.0, 0.0, abs(free), rtol=1e-15))
        e = part(c) * arm
        return np.array((e.real, e.imag)) / abs(e)

    def grip(self, unknowns: Sequence[float]) -> float:
        """Return by how much the friction that the point could give exceeds what it gives, as a share."""
        return 1.0 - abs(self.holding(unknowns)) / self.most

    def gain(self, unknowns: Sequence[float]) -> float:
        """Return what slip speed of the disc comes of friction that the point lacks until the disc rests.

        inf if the disc does not come to rest. What is lacking is that now or at rest, whichever is more; in between
        it differs from these in second order of the time.
        """
        r = unknowns[3]
        falling = -math.copysign(1.0, r) * self.pivoting_rates(unknowns)[3]
        if falling <= 0.0:
            return math.inf
        left = abs(r) / falling
        at_rest = [*unknowns[:3], math.copysign(LEAST_SLIP, r)]
        lacking = max(-self.grip(unknowns), -self.grip(at_rest), 0.0) + (self._pace * left) ** 2
        leverage = abs(self.arm(0.0)) / self.motion.gyration
        return lacking * self.most * left * math.hypot(1.0, leverage)

    def slipping(self, thresholds: Thresholds) -> Coordinates:
        """Return the coordinates of slip of the point."""
        slow = thresholds.slow_slip * self.most
        arms = self.contact.arms(0.0)
        passing = CLOSE * abs(arms[1] - arms[0]) / self.motion.length / self.motion.gyration

        def slow_slip(y: Sequence[float]) -> float:
            return min(slow, passing * abs(y[3]))

        surfaces = stop_surfaces(self.motion.centre.support)
        return Coordinates(
            self.slipping_rates,
            self.at_once.slipping_rates,
            2,
            slow_slip,
            self._pace,
            self._standard,
            angle=2,
            turning=3,
            surfaces=surfaces,
        )

    def pivoting(self, thresholds: Thresholds) -> Coordinates:
        """Return the coordinates of the disc that turns about the point: its only slip is r."""
        slow = thresholds.slow_slip * self.motion.centre.friction
        surfaces = stop_surfaces(self.motion.centre.support)
        return Coordinates(
            self.pivoting_rates,
            self.at_once.pivoting_rates,
            1,
            lambda _: slow,
            self._pace,
            self._standard,
            angle=2,
            leverage=self.leverage,
            grip=self.grip,
            surfaces=surfaces,
        )

    @property
    def _pace(self) -> float:
        return self.motion.pace

    def _standard(self, unknowns: FloatArray) -> FloatArray:
        """Return the standard unknowns of the disc for these, shape (4 or 6, n)."""
        x, y, angle, r = unknowns[:4]
        v = unknowns[4] + 1j * unknowns[5] if len(unknowns) == 6 else 0.0
        u = v - 1j * r / self.motion.gyration * self.arm(0.0) * np.exp(1j * angle)
        return np.array((x, y, angle, u.real, u.imag, r))

    def _holding(self, arm: complex, free: complex) -> complex:
        across = (arm.conjugate() * free).imag / (self.motion.gyration**2 + abs(arm) ** 2)
        return 1j * arm * across - free

    def _without_friction(
        self, unknowns: Sequence[float], v: complex
    ) -> tuple[tuple[float, float, float], float, complex, complex]:
        """Return rates of x, y, φ, that of r, the arm and B, all without the friction of this point."""
        x, y, angle, r = unknowns[:4]
        motion, kappa = self.motion, self.motion.gyration
        omega, g = motion.centre.disc_speed, motion.centre.friction
        own = self.arm(angle)
        force, moment = self.contact.friction_of_others(self.point, motion.length * v, -r / kappa, angle)
        u = v - 1j * r / kappa * own
        acceleration = motion.centre.pull(x + 1j * y, u) + g * force
        spin_up = motion.turning_pull(r) + g * moment / (motion.length * kappa)
        spin = omega + r / kappa
        free = acceleration + (1j * spin_up - spin * r) * own / kappa
        return (u.real - omega * y, u.imag + omega * x, spin), spin_up, own, free
