"""Equations of motion of the friction disc on the master disc: eq. 19 to 21 for the relative velocities.

The centre moves like a pin, with a force that depends on the spin too. As third component of the slip serves
r = κ(φ̇ − ω) with the radius of gyration κ = √(J/m): for (u, r), u = ż − iωz, the kinetic energy is m/2 times
the square, so that one number says how fast the disc slips as a whole, and friction of any law that is derived
from a mean slip speed P(u, S) is the gradient of −(μN/m)·P in these three.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import cast

from reference_model.contact.at_once import at_once
from reference_model.contact.contact_law import Contact
from reference_model.motion.pin_equations import SlipMotion
from reference_model.systems import DiscOnDisc


@dataclass(frozen=True)
class DiscMotion:
    """Eq. 19 divided by the mass, for the unknowns x, y, φ, u_x, u_y, r.

    Parameters
    ----------
    centre : SlipMotion
        The same for a pin in the place of the centre; its ``friction`` is g = μN/m.
    gyration : float
        κ = √(J/m) in m.
    shaft_rate : float
        b/J in 1/s.
    lag : float
        κ(ω − Ω) in m/s, the speed by which the master disc is ahead of the shaft.
    contact : Contact
        The law of friction.
    length : float
        The unit of length of all others here in that of the contact.

    """

    centre: SlipMotion
    gyration: float
    shaft_rate: float
    lag: float
    contact: Contact
    length: float = 1.0

    @classmethod
    def of(cls, disc: DiscOnDisc, contact: Contact) -> DiscMotion:
        """Return the equations of motion of ``disc`` with friction by ``contact``."""
        gyration = math.sqrt(disc.polar_inertia / disc.mass)
        return cls(
            SlipMotion.of(disc),
            gyration,
            disc.shaft_damping / disc.polar_inertia,
            gyration * (disc.disc_speed - disc.shaft_speed),
            contact,
        )

    def rates(self, unknowns: Sequence[float]) -> tuple[float, ...]:
        """Return the rates of x, y, φ, u_x, u_y, r; at rest, where friction is set-valued, without friction."""
        x, y, angle, ux, uy, r = unknowns
        omega, g = self.centre.disc_speed, self.centre.friction
        u = ux + 1j * uy
        force, moment = self.contact.force_and_moment(self.length * u, -r / self.gyration, angle)
        a = self.centre.pull(x + 1j * y, u) + g * force
        spin_up = self.turning_pull(r) + g * moment / (self.length * self.gyration)
        return ux - omega * y, uy + omega * x, omega + r / self.gyration, a.real, a.imag, spin_up

    @cached_property
    def at_once(self) -> DiscMotion:
        """The same for arrays of shape (k,) in place of numbers."""
        return replace(self, contact=cast(Contact, at_once(self.contact)))

    def lead_over_rim(self, radius: float, unknowns: Sequence[float]) -> float:
        """Return U − r|S| for a radius in the contact's unit of length: zero where a point of that circle rests."""
        u = self.length * math.hypot(unknowns[3], unknowns[4])
        return u - radius * abs(unknowns[5]) / self.gyration

    def turning_pull(self, r: float) -> float:
        """Return the rate of r without friction, by the shaft, in m/s²."""
        return -self.shaft_rate * (r + self.lag)

    @property
    def pace(self) -> float:
        """A rate, in 1/T, which nothing but the slip exceeds by much; scaled to a unit of time it is 1 at least."""
        return abs(self.centre.disc_speed) + self.shaft_rate + 1.0
