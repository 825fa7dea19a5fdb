"""The support of pin and disc: a spring, which may harden, and a stop.

It pulls the mass towards (X0, 0) with a force that depends only on the deflection d = |z − X0|::

    C·d + C₃·d³ + C_s·max(0, d − gap)
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from reference_model.numerics.roots import zero_between
from reference_model.systems import FloatArray, System

ROUNDED_UP = 1.0 + 1e-14
"""Factor that moves a bound to the safe side of rounding."""


@dataclass(frozen=True)
class Support:
    """Spring, hardening and stop, with parameters of :class:`reference_model.PinOnDisc` in any consistent units."""

    stiffness: float
    offset: float
    hardening: float = 0.0
    stop_gap: float = 0.0
    stop_stiffness: float = 0.0

    @classmethod
    def of(cls, system: System) -> Support:
        """Return the support of a pin or a disc."""
        return cls(system.stiffness, system.offset, system.hardening, system.stop_gap, system.stop_stiffness)

    def scaled(self, factor: float, length: float = 1.0) -> Support:
        """Return the support with forces multiplied by ``factor``, in units of ``length``."""
        return Support(
            self.stiffness * factor,
            self.offset / length,
            self.hardening * factor * length**2,
            self.stop_gap / length,
            self.stop_stiffness * factor,
        )

    @cached_property
    def linear(self) -> bool:
        """True without hardening or stop."""
        return self.hardening == 0.0 and self.stop_stiffness == 0.0

    @property
    def centring(self) -> bool:
        """True if the support pulls back at every deflection, however small."""
        return self.stiffness > 0.0 or self.hardening > 0.0 or self.stop_stiffness > 0.0 == self.stop_gap

    def force(self, z: complex) -> complex:
        """Return the force on the mass at z = x + iy."""
        w = z - self.offset
        return -(self.stiffness if self.linear else self.secant(abs(w))) * w

    def secant(self, d: float) -> float:
        """Return force divided by deflection, or its limit at d = 0."""
        if self.linear:
            return self.stiffness
        result = self.stiffness + self.hardening * d * d
        if d >= self.stop_gap:
            result += self.stop_stiffness * (1.0 - self.stop_gap / d if self.stop_gap > 0.0 else 1.0)
        return result

    def tangent(self, d: float) -> float:
        """Return the derivative of the force with respect to the deflection; at the stop, from outside."""
        stop = self.stop_stiffness if d >= self.stop_gap else 0.0
        return self.stiffness + 3.0 * self.hardening * d * d + stop

    def stiffness_matrix(self, z: complex) -> FloatArray:
        """Return the negative derivative of the force with respect to (x, y), shape (2, 2).

        It is the tangent stiffness along the deflection and the secant stiffness across it. Raises ``ValueError``
        exactly at the stop.
        """
        w = z - self.offset
        d = abs(w)
        if d == self.stop_gap > 0.0 < self.stop_stiffness:
            raise ValueError(
                f"deflection = stop_gap = {d:g} m: the force has no derivative where the stop begins"
            )
        along = np.array((w.real, w.imag)) / d if d > 0.0 else np.zeros(2)
        secant = self.secant(d)
        return np.asarray(secant * np.eye(2) + (self.tangent(d) - secant) * np.outer(along, along))

    def energy(self, d: float) -> float:
        """Return the potential energy at a deflection."""
        beyond = max(0.0, d - self.stop_gap)
        return (
            0.5 * self.stiffness * d**2 + 0.25 * self.hardening * d**4 + 0.5 * self.stop_stiffness * beyond**2
        )

    def pull(self, d: float) -> float:
        """Return the magnitude of the force."""
        return self.secant(d) * d

    def deflection(self, pull: float) -> float:
        """Return the deflection for a force of magnitude ``pull`` > 0; inf without springs."""
        return pull / self.stiffness if self.linear and self.stiffness > 0.0 else self._where(1, pull)

    def circle(self, twice_kinetic_energy: float) -> float:
        """Return the radius of a circle about (X0, 0) whose centripetal force mv²/d the support provides.

        ``twice_kinetic_energy`` is mv² > 0. The result is inf without springs.
        """
        return self._where(2, twice_kinetic_energy)

    def _where(self, power: int, value: float) -> float:
        bounds = [math.inf]
        if self.stiffness > 0.0:
            bounds.append((value / self.stiffness) ** (1.0 / power))
        if self.hardening > 0.0:
            bounds.append((value / self.hardening) ** (1.0 / (power + 2.0)))
        if self.stop_stiffness > 0.0:
            bounds.append(self.stop_gap + (value / self.stop_stiffness) ** (1.0 / power))
        largest = min(bounds) * ROUNDED_UP
        if not 0.0 < largest < math.inf:
            return largest
        return zero_between(lambda d: self.secant(d) * d**power - value, 0.0, largest)


def require_linear_support(system: System) -> None:
    """Raise ``ValueError`` if the support hardens or has a stop."""
    for name, unit in (("hardening", "N/m³"), ("stop_stiffness", "N/m")):
        value = getattr(system, name)
        if value > 0.0:
            raise ValueError(
                f"{name} = {value:g} {unit}: it must be 0 here, because only linear supports are covered"
            )
