"""A disc on single points that turns about one of them, which slips slowly or rests.

The coordinates are x, y, φ, r = κ(φ̇ − ω) and, while it slips, the velocity v of that point, which keeps its relative
accuracy down to zero. Other points follow: v_j = v + i(r/κ)(a_j − a_i) with the arms a. The point accelerates by B +
Gλ, where λ is its own friction divided by the mass, B the acceleration without it, and G = 1 + (i·a_i)⊗(i·a_i)/κ². In
slip
λ = −gq·v/|v| with the point's share q of the load; at rest λ = −G⁻¹B, up to gq.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy.optimize import brentq

from reference_model.contact.contact_law import NONE
from reference_model.contact.points import Points
from reference_model.motion.disc_equations import DiscMotion
from reference_model.motion.slip.coordinates import LEAST_SLIP, Coordinates, stop_surfaces
from reference_model.motion.stepper import Thresholds
from reference_model.systems import FloatArray

CLOSE = 0.25
"""Largest slip speed of a slow point, as a fraction of the relative speed of its neighbours."""


@dataclass(frozen=True)
class OnePoint:
    """Equations of motion of a disc in the coordinates of its contact point ``point``."""

    motion: DiscMotion
    contact: Points
    point: int

    @property
    def most(self) -> float:
        """Largest friction of the point divided by the mass, gq."""
        return self.motion.centre.friction * self.contact.shares[self.point]

    def arm(self, angle: float) -> complex:
        return self.contact.arm(self.point, angle) / self.motion.length

    @property
    def leverage(self) -> float:
        """Ratio of the arm to the radius of gyration, at least one; it amplifies errors of r."""
        return max(1.0, abs(self.arm(0.0)) / self.motion.gyration)

    def velocity(self, unknowns: Sequence[float]) -> complex:
        _, _, angle, ux, uy, r = unknowns
        return complex(ux, uy) + 1j * r / self.motion.gyration * self.arm(angle)

    def slipping_rates(self, unknowns: Sequence[float]) -> tuple[float, ...]:
        """Return the rates of x, y, φ, r, v_x, v_y, at v = 0 without the point's own friction."""
        v = unknowns[4] + 1j * unknowns[5]
        carried, spin_up, arm, free = self._without_friction(unknowns, v)
        friction = -self.most * (v / (abs(v) + NONE))
        torque = (arm.conjugate() * friction).imag / self.motion.gyration
        acceleration = free + friction + 1j * arm * torque / self.motion.gyration
        return (*carried, spin_up + torque, acceleration.real, acceleration.imag)

    def pivoting_rates(self, unknowns: Sequence[float]) -> tuple[float, ...]:
        carried, spin_up, arm, free = self._without_friction(unknowns, 0j)
        torque = (arm.conjugate() * self._holding(arm, free)).imag / self.motion.gyration
        return (*carried, spin_up + torque)

    def holding(self, unknowns: Sequence[float]) -> complex:
        _, _, arm, free = self._without_friction(unknowns, 0j)
        return self._holding(arm, free)

    def leaving(self, unknowns: Sequence[float]) -> FloatArray:
        """Return the direction of the incipient slip, a unit vector e with B − gq·G·e = c·e, c >= 0.

        Along and across the arm it is B_∥/(c + gq) and B_⊥/(c + gq·(1 + |a|²/κ²)).
        """
        _, _, arm, free = self._without_friction(unknowns, 0j)
        axis = arm / abs(arm) if arm != 0.0 else 1.0 + 0j
        along = free * axis.conjugate()
        stiffer = 1.0 + (abs(arm) / self.motion.gyration) ** 2

        def part(c: float) -> complex:
            return complex(along.real / (c + self.most), along.imag / (c + self.most * stiffer))

        c = 0.0
        if abs(part(0.0)) > 1.0:
            c = float(brentq(lambda c: abs(part(c)) - 1.0, 0.0, abs(free), rtol=1e-15))
        e = part(c) * axis
        return np.array((e.real, e.imag)) / abs(e)

    def grip(self, unknowns: Sequence[float]) -> float:
        """Return the relative margin of the point's friction."""
        return 1.0 - abs(self.holding(unknowns)) / self.most

    def gain(self, unknowns: Sequence[float]) -> float:
        """Return the slip speed that a point without enough friction gains before the disc rests, or inf."""
        r = unknowns[3]
        falling = -math.copysign(1.0, r) * self.pivoting_rates(unknowns)[3]
        if falling <= 0.0:
            return math.inf
        left = abs(r) / falling
        at_rest = [*unknowns[:3], math.copysign(LEAST_SLIP, r)]
        lacking = max(-self.grip(unknowns), -self.grip(at_rest), 0.0) + (self.motion.pace * left) ** 2
        leverage = abs(self.arm(0.0)) / self.motion.gyration
        return lacking * self.most * left * math.hypot(1.0, leverage)

    def slipping(self, thresholds: Thresholds) -> Coordinates:
        slow = thresholds.slow_slip * self.most
        passing = CLOSE * self.contact.spacing(self.point) / self.motion.length / self.motion.gyration

        def slow_slip(y: Sequence[float]) -> float:
            return min(slow, passing * abs(y[3]))

        return Coordinates(self.slipping_rates, 2, slow_slip, turning=3, **self._common)

    def pivoting(self, thresholds: Thresholds) -> Coordinates:
        slow = thresholds.slow_slip * self.motion.centre.friction
        own: dict[str, Any] = {"leverage": self.leverage, "grip": self.grip}
        return Coordinates(self.pivoting_rates, 1, lambda _: slow, **own, **self._common)

    @property
    def _common(self) -> dict[str, Any]:
        surfaces = stop_surfaces(self.motion.centre.support)
        return {"pace": self.motion.pace, "standard": self._standard, "angle": 2, "surfaces": surfaces}

    def _standard(self, unknowns: FloatArray) -> FloatArray:
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
        """Return the rates of x, y, φ and r, the arm and B, without the friction of this point."""
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
