"""Vectorised friction laws for implicit methods."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from reference_model.contact.contact_law import NONE, Contact, Ring
from reference_model.contact.elliptic import mean_directions_at
from reference_model.contact.points import Points
from reference_model.systems import FloatArray

ComplexArray = NDArray[np.complex128]


class ContactAtOnce(Protocol):
    """A vectorised friction law."""

    def force_and_moment(
        self, slip: ComplexArray, relative_spin: FloatArray, angle: FloatArray
    ) -> tuple[ComplexArray, FloatArray]:
        """Like :meth:`Contact.force_and_moment`, for arrays of shape (k,)."""
        ...


@dataclass(frozen=True)
class PointsAtOnce:
    """Vectorised :class:`Points`."""

    law: Points

    @property
    def shares(self) -> tuple[float, ...]:
        return self.law.shares

    def arm(self, point: int, angle: FloatArray) -> ComplexArray:
        return np.asarray(self.law.arm(point, 0.0) * np.exp(1j * angle))

    def force_and_moment(
        self, slip: ComplexArray, relative_spin: FloatArray, angle: FloatArray
    ) -> tuple[ComplexArray, FloatArray]:
        arms = self._arms(angle)
        return self._friction(arms, slip - 1j * relative_spin * arms)

    def friction_of_others(
        self, point: int, slip: ComplexArray, relative_spin: FloatArray, angle: FloatArray
    ) -> tuple[ComplexArray, FloatArray]:
        arms = self._arms(angle)
        velocities = slip - 1j * relative_spin * (arms - arms[point])
        velocities[point] = 0.0
        return self._friction(arms, velocities)

    def _arms(self, angle: FloatArray) -> ComplexArray:
        return np.asarray(np.multiply.outer(np.array(self.law.arms(0.0)), np.exp(1j * angle)))

    def _friction(self, arms: ComplexArray, velocities: ComplexArray) -> tuple[ComplexArray, FloatArray]:
        friction = velocities * (-np.array(self.shares)[:, np.newaxis] / (abs(velocities) + NONE))
        moments = arms.real * friction.imag - arms.imag * friction.real
        return friction.sum(axis=0), moments.sum(axis=0)


@dataclass(frozen=True)
class RingAtOnce:
    """Vectorised :class:`Ring`."""

    law: Ring

    def force_and_moment(
        self, slip: ComplexArray, relative_spin: FloatArray, angle: FloatArray
    ) -> tuple[ComplexArray, FloatArray]:
        speed, rim = np.asarray(abs(slip), dtype=np.float64), self.law.radius * relative_spin
        along_slip, along_rim = mean_directions_at(speed, abs(rim))
        return -along_slip * slip / (speed + NONE), self.law.radius * along_rim * np.sign(rim)


@dataclass(frozen=True)
class OneByOne:
    """Any law, evaluated state by state."""

    law: Contact

    def force_and_moment(
        self, slip: ComplexArray, relative_spin: FloatArray, angle: FloatArray
    ) -> tuple[ComplexArray, FloatArray]:
        states = zip(slip.tolist(), relative_spin.tolist(), angle.tolist(), strict=True)
        forces, moments = zip(*(self.law.force_and_moment(*state) for state in states), strict=True)
        return np.array(forces), np.array(moments)


def at_once(contact: Contact) -> ContactAtOnce:
    """Return the vectorised law."""
    if isinstance(contact, Points):
        return PointsAtOnce(contact)
    return RingAtOnce(contact) if isinstance(contact, Ring) else OneByOne(contact)
