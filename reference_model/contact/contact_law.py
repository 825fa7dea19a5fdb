"""Coulomb friction between two discs: the interface of all laws, a pin, a ring, and the expansion (22).

A law returns force (N per N of μN) and moment (m) on the disc if its centre slips with u over the master disc, which
turns with S = ω − φ̇ relative to it. A point at r·exp(iα) from the centre slips with u − i·S·r·exp(iα) (21).
Plane vectors are complex numbers. Laws depend only on the ratio of u and S. Laws of circles are also *isotropic*: the
force is opposite to u, and nothing depends on the direction of u or on the angle φ.
"""

import math
from abc import ABC, abstractmethod
from dataclasses import dataclass
from typing import Any, NamedTuple, Protocol

import numpy as np

from reference_model.contact.elliptic import mean_curvatures, mean_directions
from reference_model.contact.points import Points, PointsOnRing
from reference_model.systems import (
    DiscOnDisc,
    FloatArray,
    PinOnDisc,
    System,
    finite_number,
    positive_number,
    require_kind,
    require_system,
    shown,
)

NONE = 1e-300
"""Added to speeds before division, so friction is zero at a point at rest."""


class Contact(Protocol):
    """A friction law between two discs."""

    def force_and_moment(self, slip: complex, relative_spin: float, angle: float) -> tuple[complex, float]:
        """Return force (N per N of μN) and moment (m) on the disc.

        ``slip`` is u = (ẋ + ωy) + i(ẏ − ωx) in m/s, ``relative_spin`` S = ω − φ̇ in rad/s, ``angle`` φ in rad.
        """
        ...

    def jacobian(self, slip: complex, relative_spin: float, angle: float) -> FloatArray:
        """Return the derivatives of (F_x, F_y, M) with respect to (u_x, u_y, S, φ), shape (3, 4).

        Raises ``ValueError`` if a point of the contact is at rest, where friction is not differentiable.
        """
        ...


class Shares(NamedTuple):
    """Resistance to slip of the centre (N per N) and moment about it (m), per newton of μN."""

    resistance: float
    moment: float


class Slopes(NamedTuple):
    """Derivatives of :class:`Shares` with respect to slip speed U (m/s) and relative spin S (rad/s)."""

    resistance_by_slip: float
    resistance_by_spin: float
    moment_by_slip: float
    moment_by_spin: float


class IsotropicContact(ABC):
    """An isotropic law: force −F(U, S)·u/U and moment M(U, S), with U = |u|."""

    @property
    def resting_radii(self) -> tuple[float, ...]:
        """Radii r in m with infinite slopes at U = r|S|, where steps must end."""
        return ()

    @abstractmethod
    def shares(self, slip_speed: float, relative_spin: float) -> Shares:
        """Return F and M for U >= 0 and S of either sign, not both zero; F(0, S) = 0."""

    @abstractmethod
    def slopes(self, slip_speed: float, relative_spin: float) -> Slopes:
        """Return the derivatives of F and M, at U = 0 from above; raise ``ValueError`` where there are none."""

    def force_and_moment(self, slip: complex, relative_spin: float, angle: float) -> tuple[complex, float]:
        speed = abs(slip)
        if speed == 0.0 and relative_spin == 0.0:
            return 0j, 0.0
        resistance, moment = self.shares(speed, relative_spin)
        return (-resistance * (slip / speed) if speed > 0.0 else 0j), moment

    def jacobian(self, slip: complex, relative_spin: float, angle: float) -> FloatArray:
        """Like :meth:`Contact.jacobian`; friction acts across the slip like a damper F/U."""
        speed = abs(slip)
        slopes = self.slopes(speed, relative_spin)
        direction = slip / speed if speed > 0.0 else 1.0 + 0j
        along = np.array((direction.real, direction.imag))
        across = np.array((-direction.imag, direction.real))
        turning = (
            self.shares(speed, relative_spin).resistance / speed if speed > 0.0 else slopes.resistance_by_slip
        )
        result = np.zeros((3, 4))
        result[:2, :2] = -slopes.resistance_by_slip * np.outer(along, along) - turning * np.outer(
            across, across
        )
        if speed > 0.0:
            result[:2, 2] = -slopes.resistance_by_spin * along
            result[2, :2] = slopes.moment_by_slip * along
        result[2, 2] = slopes.moment_by_spin
        return result


@dataclass(frozen=True)
class Pin(IsotropicContact):
    """Point contact at the centre (1): full friction against slip, no moment."""

    def shares(self, slip_speed: float, relative_spin: float) -> Shares:
        return Shares(1.0 if slip_speed > 0.0 else 0.0, 0.0)

    def slopes(self, slip_speed: float, relative_spin: float) -> Slopes:
        if slip_speed == 0.0:
            raise ValueError("slip = 0 m/s: the pin is at rest, where friction has no derivative")
        return Slopes(0.0, 0.0, 0.0, 0.0)


@dataclass(frozen=True)
class _OnCircle:
    radius: float

    def __post_init__(self) -> None:
        object.__setattr__(self, "radius", positive_number("radius", self.radius, "m"))


@dataclass(frozen=True)
class Ring(_OnCircle, IsotropicContact):
    """Contact on the whole circle of ``radius`` R > 0 in m (20), in closed form.

    F = ∂P/∂U and M = R·∂P/∂W·sign(S), W = R·|S|, with the mean slip speed P(U, W) on the circle, see
    :mod:`reference_model.contact.elliptic`. Both are accurate to rounding.
    """

    @property
    def resting_radii(self) -> tuple[float, ...]:
        return (self.radius,)

    def shares(self, slip_speed: float, relative_spin: float) -> Shares:
        rim = self.radius * relative_spin
        along_slip, along_rim = mean_directions(slip_speed, abs(rim))
        return Shares(along_slip, math.copysign(self.radius * along_rim, rim))

    def slopes(self, slip_speed: float, relative_spin: float) -> Slopes:
        rim = abs(self.radius * relative_spin)
        if slip_speed == rim:
            raise ValueError(
                f"slip = {slip_speed:g} m/s = radius·|relative spin|: one point of the ring is at rest, "
                "where friction has no derivative"
            )
        by_slip, mixed, by_rim = mean_curvatures(slip_speed, rim)
        mixed *= math.copysign(self.radius, relative_spin)
        return Slopes(by_slip, mixed, mixed, self.radius**2 * by_rim)


@dataclass(frozen=True)
class ThreeTermRing(_OnCircle, IsotropicContact):
    """The paper's approximation (23) of the ring of ``radius`` R > 0 in m: three terms of (22) of ν̄/|ν_r|.

    With U = ν̄·cos α and R·S = ν̄·sin α, F = cos α·(1 − ½sin²α + ¾cos²α·sin²α) and M = R·sin α·(1 − ½cos²α +
    ¾cos²α·sin²α). Their potential ν̄·(1 − ¼cos²α·sin²α) is convex, so friction never feeds in power. The largest
    error is 0.10, near U = 0.77·R|S| for the force and at the reciprocal ratio for the moment.
    """

    def shares(self, slip_speed: float, relative_spin: float) -> Shares:
        _, c, s = self._polar(slip_speed, relative_spin)
        both = 0.75 * (c * s) ** 2
        return Shares(c * (1.0 - 0.5 * s**2 + both), self.radius * s * (1.0 - 0.5 * c**2 + both))

    def slopes(self, slip_speed: float, relative_spin: float) -> Slopes:
        speed, c, s = self._polar(slip_speed, relative_spin)
        curvature = (0.5 + 3.75 * (c * s) ** 2) / speed  # (P + d²P/dα²)/ν̄
        mixed = -self.radius * c * s * curvature
        return Slopes(s**2 * curvature, mixed, mixed, (self.radius * c) ** 2 * curvature)

    def _polar(self, slip_speed: float, relative_spin: float) -> tuple[float, float, float]:
        rim = self.radius * relative_spin
        speed = math.hypot(slip_speed, rim)
        if speed == 0.0:
            raise ValueError("slip = 0 m/s and relative spin = 0 rad/s: the disc is at rest")
        return speed, slip_speed / speed, rim / speed


def contact_of(system: System, contact: Contact | None = None) -> IsotropicContact | Points:
    """Return ``contact`` or the law of ``system``; raise ``ValueError`` if the system cannot have it."""
    require_system(system)
    if isinstance(system, PinOnDisc):
        if contact is not None:
            raise ValueError(f"contact = {contact}: a pin has point contact; pass contact only with a disc")
        return Pin()
    if contact is None:
        if system.contact_points is None:
            return Ring(system.contact_radius)
        return PointsOnRing(system.contact_radius, system.contact_points)
    return checked_contact(contact)


def checked_contact(contact: Any) -> IsotropicContact | Points:
    """Return ``contact``; raise ``ValueError`` unless it is a law of a disc."""
    if not isinstance(contact, IsotropicContact | Points):
        raise ValueError(
            f"contact = {shown(contact)}: it must be an isotropic law, like Ring(radius), or "
            "Points([(x, y, share), ...])"
        )
    return contact


def checked_vector(name: str, vector: Any) -> complex:
    """Return a vector x + iy; raise ``ValueError`` unless it is a finite number, which may be complex."""
    parts = (vector.real, vector.imag) if isinstance(vector, complex) else (vector, 0.0)
    return complex(*(finite_number(name, part) for part in parts))


def isotropic_contact_of(system: DiscOnDisc, contact: IsotropicContact | None, what: str) -> IsotropicContact:
    """Return ``contact`` or the law of ``system``; raise ``ValueError`` naming ``what`` for a law of points."""
    require_kind("disc", system, DiscOnDisc)
    law = contact_of(system, contact)
    if not isinstance(law, IsotropicContact):
        given = f"contact_points = {system.contact_points}" if contact is None else f"contact = {contact}"
        raise ValueError(
            f"{given}: {what} cannot be computed for single points, whose friction depends on the angle; "
            "use the continuous ring, contact_points = None"
        )
    return law
