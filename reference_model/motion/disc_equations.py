"""Equations of motion of the friction disc: eq. 19 to 21 for the relative velocities.

The third component of the slip is r = κ(φ̇ − ω) with the radius of gyration κ = √(J/m). In (u, r), u = ż − iωz, the
relative kinetic energy is m/2 times the squared length, and friction is the gradient of −(μN/m)·P(u, S), with the
mean slip speed P.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

from reference_model.contact.contact_law import Contact
from reference_model.motion.pin_equations import SlipMotion
from reference_model.systems import DiscOnDisc


@dataclass(frozen=True)
class DiscMotion:
    """Eq. 19 divided by the mass, for the unknowns x, y, φ, u_x, u_y, r.

    ``centre`` contains the equations of a pin at the centre; ``gyration`` is κ in m, ``shaft_rate`` b/J in 1/s, and
    ``lag`` κ(ω − Ω) in m/s. ``length`` is their unit of length in that of ``contact``.
    """

    centre: SlipMotion
    gyration: float
    shaft_rate: float
    lag: float
    contact: Contact
    length: float = 1.0

    @classmethod
    def of(cls, disc: DiscOnDisc, contact: Contact) -> DiscMotion:
        gyration = math.sqrt(disc.polar_inertia / disc.mass)
        return cls(
            SlipMotion.of(disc),
            gyration,
            disc.shaft_damping / disc.polar_inertia,
            gyration * (disc.disc_speed - disc.shaft_speed),
            contact,
        )

    def rates(self, unknowns: Sequence[float]) -> tuple[float, ...]:
        """Return the rates of x, y, φ, u_x, u_y, r; without friction at rest."""
        x, y, angle, ux, uy, r = unknowns
        omega, g = self.centre.disc_speed, self.centre.friction
        u = ux + 1j * uy
        force, moment = self.contact.force_and_moment(self.length * u, -r / self.gyration, angle)
        a = self.centre.pull(x + 1j * y, u) + g * force
        spin_up = self.turning_pull(r) + g * moment / (self.length * self.gyration)
        return ux - omega * y, uy + omega * x, omega + r / self.gyration, a.real, a.imag, spin_up

    def lead_over_rim(self, radius: float, unknowns: Sequence[float]) -> float:
        """Return U − r|S| for a radius in the contact's unit of length: zero if a point of that circle rests."""
        u = self.length * math.hypot(unknowns[3], unknowns[4])
        return u - radius * abs(unknowns[5]) / self.gyration

    def turning_pull(self, r: float) -> float:
        """Return the rate of r due to the shaft, in m/s²."""
        return -self.shaft_rate * (r + self.lag)

    @property
    def pace(self) -> float:
        """Bound in 1/T on the rates of everything except the slip, at least 1."""
        return abs(self.centre.disc_speed) + self.shaft_rate + 1.0
