"""All steady motions with permanent slip, and their stability."""

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import overload

import numpy as np

from reference_model.contact.contact_law import IsotropicContact, contact_of, isotropic_contact_of
from reference_model.formulas.disc import held_pin, pin_of, shaft_torque
from reference_model.formulas.pin import (
    circling_speed,
    equilibrium_position,
    largest_load_in_words,
    largest_load_with_equilibrium,
    require_drive,
    whirl_frequency,
    whirl_radius,
)
from reference_model.formulas.torque_balance import circles, least_load_with_whirl, resting_positions
from reference_model.steady.stability import equilibrium_eigenvalues, whirl_eigenvalues
from reference_model.support import Support
from reference_model.systems import DiscOnDisc, FloatArray, PinOnDisc, System, require_system


@dataclass(frozen=True, kw_only=True)
class SelfCentredEquilibrium:
    """A pin or disc whose centre rests in space while the master disc slides below it (3), (24).

    The position ``x``, ``y`` is in m. ``eigenvalues`` are in 1/s, slowest decay first: four for a pin, five for a
    disc, without its angle.
    """

    x: float
    y: float
    eigenvalues: tuple[complex, ...]

    @property
    def stable(self) -> bool:
        """True if all small deviations decay."""
        return self.eigenvalues[0].real < 0.0

    @property
    def state(self) -> FloatArray:
        """State, shape (4,)."""
        return np.array([self.x, self.y, 0.0, 0.0])


@dataclass(frozen=True, kw_only=True)
class SpinningEquilibrium(SelfCentredEquilibrium):
    """The self-centred equilibrium of a disc with the ``spin`` φ̇ in rad/s about its resting centre."""

    spin: float

    @property
    def state(self) -> FloatArray:
        """State with the angle zero, shape (6,)."""
        return resting(self.x, self.y, self.spin)


@dataclass(frozen=True, kw_only=True)
class Whirl:
    """A motion on a circle about the axis with permanent slip (11).

    ``radius`` is in m, ``frequency`` in rad/s, negative if clockwise. ``eigenvalues`` are in 1/s in the frame that
    turns with the whirl: first the exact zero of the free phase, then three for a pin or four for a disc, slowest
    decay first.
    """

    radius: float
    frequency: float
    eigenvalues: tuple[complex, ...]

    @property
    def stable(self) -> bool:
        """True if all small deviations decay, apart from a shift in phase."""
        return self.eigenvalues[1].real < 0.0

    @property
    def state(self) -> FloatArray:
        """State with the centre on the x axis, shape (4,)."""
        return np.array([self.radius, 0.0, 0.0, self.frequency * self.radius])


@dataclass(frozen=True, kw_only=True)
class SpinningWhirl(Whirl):
    """The whirl of a disc with the constant ``spin`` φ̇ in rad/s about its circling centre."""

    spin: float

    @property
    def state(self) -> FloatArray:
        """State with the centre on the x axis and the angle zero, shape (6,)."""
        return circling(self.radius, self.frequency, self.spin)


def resting(x: float, y: float, spin: float) -> FloatArray:
    """Return the state of a disc whose centre rests."""
    return np.array([x, y, 0.0, 0.0, 0.0, spin])


def circling(radius: float, frequency: float, spin: float) -> FloatArray:
    """Return the state of a disc whose centre circles the axis, at a point on the x axis."""
    return np.array([radius, 0.0, 0.0, 0.0, frequency * radius, spin])


@overload
def self_centred_equilibria(
    system: PinOnDisc, contact: IsotropicContact | None = None
) -> tuple[SelfCentredEquilibrium, ...]: ...


@overload
def self_centred_equilibria(
    system: DiscOnDisc, contact: IsotropicContact | None = None
) -> tuple[SpinningEquilibrium, ...]: ...


def self_centred_equilibria(
    system: System, contact: IsotropicContact | None = None
) -> tuple[SelfCentredEquilibrium, ...]:
    """Return every equilibrium of ``system`` with the centre at rest in space and a sliding contact.

    A pin has at most one equilibrium, (3), but none

    - if μN >= C·|X0|; at equality it would stick on the axis;
    - if ω = 0 with friction, because it sticks;
    - if C = 0: friction is not balanced, or without friction every position is an equilibrium.

    A disc on a ring has at most one: at a given radius the torsional balance allows one spin, and the balance of
    forces, (Cρ)² + (μN·F)² = (C·X0)², one radius, because F and M are derivatives of one convex function. It has none

    - if friction holds it at rest on the axis, or on a master disc at rest;
    - if C = 0 with ω = 0 or without friction, where every position is an equilibrium;
    - if b = 0 without friction, where every spin is one.

    For a nonlinear support replace C·|X0| by its force at the deflection |X0|, and the balance by ρ² + d² = X0², with
    the deflection d at the force μN·F.

    ``contact`` is the friction law of a disc; None: the law of the parameters. Raises ``ValueError`` for a disc on
    single points, a contact of a pin, or equal slip of centre and rim of a ring, where eigenvalues do not exist.
    """
    require_system(system)
    if isinstance(system, PinOnDisc):
        contact_of(system, contact)  # raises if a contact is given
        if _why_no_equilibrium_of_pin(system) is not None:
            return ()
        x, y = equilibrium_position(system)
        return (SelfCentredEquilibrium(x=x, y=y, eigenvalues=equilibrium_eigenvalues(system)),)
    law = isotropic_contact_of(system, contact, "steady motions")
    found = []
    for z, spin in resting_positions(system, law):
        eigenvalues = equilibrium_eigenvalues(system, resting(z.real, z.imag, spin), law)
        found.append(SpinningEquilibrium(x=z.real, y=z.imag, spin=spin, eigenvalues=eigenvalues))
    return tuple(found)


@overload
def whirls(system: PinOnDisc, contact: IsotropicContact | None = None) -> tuple[Whirl, ...]: ...


@overload
def whirls(system: DiscOnDisc, contact: IsotropicContact | None = None) -> tuple[SpinningWhirl, ...]: ...


def whirls(system: System, contact: IsotropicContact | None = None) -> tuple[Whirl, ...]:
    """Return every motion of ``system`` on a circle about the axis with permanent slip; X0 = 0 only.

    A pin has at most one whirl, (11), but none

    - if |ω| <= k: it would overtake the disc, and friction would brake it;
    - if β = 0: with friction nothing limits the radius, and without friction every radius is possible;
    - if μN = 0, because nothing drives it, or C = 0, because nothing holds it on a circle.

    A disc may have several, listed from the largest, with the pin's frequency ±k and smaller radii. The same
    conditions hold, and the load must reach :func:`smallest_load_with_whirl`.

    On a nonlinear support the frequency grows with the circle, and the pin's circle, with the speed μN/β, is a whirl
    only if the disc turns faster. A disc's friction acts only partly along the circle, so it may whirl where a pin
    sticks.

    Raises ``ValueError`` if the offset is not zero; otherwise arguments and errors are the same as in
    :func:`self_centred_equilibria`.
    """
    _require_centred(system)
    if isinstance(system, PinOnDisc):
        contact_of(system, contact)  # raises if a contact is given
        if _refusal(whirl_radius, system) is not None:
            return ()
        radius, frequency = whirl_radius(system), whirl_frequency(system)
        return (Whirl(radius=radius, frequency=frequency, eigenvalues=whirl_eigenvalues(system)),)
    law = isotropic_contact_of(system, contact, "steady motions")
    if _why_no_circle_of_disc(system) is not None:
        return ()
    found = []
    for radius, spin in circles(system, law):
        frequency = math.copysign(circling_speed(pin_of(system), radius), system.disc_speed)
        state = circling(radius, frequency, spin)
        eigenvalues = whirl_eigenvalues(system, state, law)
        found.append(SpinningWhirl(radius=radius, frequency=frequency, spin=spin, eigenvalues=eigenvalues))
    return tuple(found)


def why_no_equilibrium(system: System, contact: IsotropicContact | None = None) -> str | None:
    """Return the condition that fails if :func:`self_centred_equilibria` finds none; else None."""
    if self_centred_equilibria(system, contact):
        return None
    if isinstance(system, PinOnDisc):
        return _why_no_equilibrium_of_pin(system)
    if not Support.of(system).centring and 0.0 in (system.disc_speed, system.friction_force):
        return "stiffness = 0 N/m: without springs the disc may rest at any position"
    if system.friction_force == 0.0:
        return "shaft_damping = 0 N m s/rad, friction_force = 0 N: the disc may spin at any speed"
    held, torque = held_pin(system, contact), shaft_torque(system)
    if system.disc_speed == 0.0:
        return (
            f"disc_speed = 0 rad/s, friction_force = {system.friction_force:g} N: friction holds the moment of the "
            f"shaft, {torque:g} N m, and a disc at rest sticks to a master disc at rest"
        )
    return (
        f"friction_force = {system.friction_force:g} N: together with the shaft's moment of {torque:g} N m friction "
        f"holds a force of {held.friction_force:g} N, at least the spring force "
        f"{largest_load_in_words(held)} = {largest_load_with_equilibrium(held):g} N: the disc sticks on the axis"
    )


def why_no_whirl(system: System, contact: IsotropicContact | None = None) -> str | None:
    """Return the condition that fails if :func:`whirls` finds none; else None."""
    if whirls(system, contact):
        return None
    if isinstance(system, PinOnDisc):
        return _refusal(whirl_radius, system)
    reason = _why_no_circle_of_disc(system)
    if reason is not None:
        return reason
    if not system.linear_support:
        return (
            f"friction_force = {system.friction_force:g} N: support and shaft balance "
            "sliding friction on no circle"
        )
    return (
        f"friction_force = {system.friction_force:g} N: a whirl exists only above "
        f"{smallest_load_with_whirl(system, contact):g} N; below, the disc rotates about the axis"
    )


def smallest_load_with_whirl(disc: DiscOnDisc, contact: IsotropicContact | None = None) -> float:
    """Return the smallest μN in N of a whirl of a disc without offset; zero if a whirl exists at every load.

    It belongs to a whirl of zero radius, :func:`reference_model.steady.stability.onset_load`, or to a fold, where two
    whirls meet; ``friction_force`` does not matter. Raises ``ValueError`` if whirls do not exist at any load, or if
    the support is not linear, where whirls may begin and end at several loads.
    """
    law = isotropic_contact_of(disc, contact, "the smallest load")
    _require_centred(disc)
    return least_load_with_whirl(disc, law)


def _why_no_equilibrium_of_pin(pin: PinOnDisc) -> str | None:
    reason = _refusal(equilibrium_position, pin)
    limit = largest_load_with_equilibrium(pin)
    if reason is None and 0.0 < pin.friction_force == limit:
        return f"friction_force = {pin.friction_force:g} N = {largest_load_in_words(pin)}: the pin sticks on the axis"
    return reason


def _why_no_circle_of_disc(disc: DiscOnDisc) -> str | None:
    """Return why a disc has no whirl. With a nonlinear support it may whirl where a pin does not."""
    return _refusal(whirl_radius if disc.linear_support else require_drive, pin_of(disc))


def _refusal(formula: Callable[[PinOnDisc], object], pin: PinOnDisc) -> str | None:
    try:
        formula(pin)
    except ValueError as error:
        return str(error)
    return None


def _require_centred(system: System) -> None:
    require_system(system)
    if system.offset != 0.0:
        raise ValueError(
            f"offset = {system.offset:g} m: with an offset the periodic orbit is not a circle about the axis; "
            "use whirl_orbit(), which finds it by shooting"
        )
