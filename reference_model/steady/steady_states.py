"""All steady motions of a system in which the contact slides all the time, each with its stability."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import overload

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
from reference_model.formulas.torque_balance import circles, least_load_with_whirl, resting_places
from reference_model.steady.stability import equilibrium_eigenvalues, whirl_eigenvalues
from reference_model.steady.steady_motions import (
    SelfCentredEquilibrium,
    SpinningEquilibrium,
    SpinningWhirl,
    Whirl,
    circling,
    resting,
)
from reference_model.support import Support
from reference_model.systems import DiscOnDisc, PinOnDisc, System, require_system

__all__ = [
    "SelfCentredEquilibrium",
    "SpinningEquilibrium",
    "SpinningWhirl",
    "Whirl",
    "self_centred_equilibria",
    "smallest_load_with_whirl",
    "whirls",
    "why_no_equilibrium",
    "why_no_whirl",
]


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
    """Return every equilibrium of ``system`` in which the centre rests in space and the contact slides.

    Of a pin there is at most one: that of (3) where μN < C·|X0| and ω ≠ 0. There is none

    - where μN > C·|X0|, so for X0 = 0 too, and where μN = C·|X0|: then the pin would rest on the axis,
      where nothing slides, and it sticks;
    - for ω = 0 with friction: a pin at rest on a disc at rest sticks;
    - for C = 0: with friction nothing balances it, and without friction every position is as good.

    On a support that hardens or has a stop, its force at the deflection |X0| takes the place of C·|X0|, for a disc
    too, and a disc's (Cρ)² + (μN·F)² = (C·X0)² below is ρ² + d² = X0² with the deflection d at which the force is
    μN·F.

    Of a disc there is one where friction can't hold it at rest on the axis against springs and shaft, and on the
    continuous ring no other: at a given radius the torsional balance leaves one spin, and with a larger radius the
    force of friction grows as that of the springs does, (Cρ)² + (μN·F)² = (C·X0)², because F and M are derivatives
    of one convex function of slip. On the axis (X0 = 0), without springs (C = 0) and on a master disc at rest
    (ω = 0) the centre does not slide and the disc only spins. A disc that does not spin against the master disc
    (b = 0, ω = Ω) behaves like a pin. There is none

    - where friction holds the disc at rest on the axis, or on a master disc at rest;
    - for C = 0 with ω = 0 or without friction, where every position is as good;
    - for b = 0 without friction, where every spin is as good.

    Without friction the centre rests at (X0, 0) whatever the master disc does. :func:`why_no_equilibrium` tells
    which condition fails.

    Parameters
    ----------
    system : PinOnDisc or DiscOnDisc
        The parameters.
    contact : IsotropicContact or None
        Law of friction of a disc; None for that of the parameters.

    Raises
    ------
    ValueError
        If a disc rests on single points, or if a pin is given a contact. If the centre slips exactly as fast as the
        rim of a continuous ring, a point of which is then at rest: there are no eigenvalues.

    """
    require_system(system)
    if isinstance(system, PinOnDisc):
        contact_of(system, contact)  # refuses any
        return _equilibria_of_pin(system)
    return _equilibria_of_disc(system, isotropic_contact_of(system, contact, "steady motions"))


def _equilibria_of_pin(pin: PinOnDisc) -> tuple[SelfCentredEquilibrium, ...]:
    """Return the one of (3), if there is one."""
    if _why_no_equilibrium_of_pin(pin) is not None:
        return ()
    x, y = equilibrium_position(pin)
    eigenvalues = equilibrium_eigenvalues(pin)
    return (SelfCentredEquilibrium(x=x, y=y, eigenvalues=eigenvalues, stable=_decay(eigenvalues)),)


def _equilibria_of_disc(disc: DiscOnDisc, law: IsotropicContact) -> tuple[SpinningEquilibrium, ...]:
    """Return those that are left by the balances of forces and moments."""
    found = []
    for z, spin in resting_places(disc, law):
        eigenvalues = equilibrium_eigenvalues(disc, resting(z.real, z.imag, spin), law)
        found.append(
            SpinningEquilibrium(
                x=z.real, y=z.imag, spin=spin, eigenvalues=eigenvalues, stable=_decay(eigenvalues)
            )
        )
    return tuple(found)


@overload
def whirls(system: PinOnDisc, contact: IsotropicContact | None = None) -> tuple[Whirl, ...]: ...


@overload
def whirls(system: DiscOnDisc, contact: IsotropicContact | None = None) -> tuple[SpinningWhirl, ...]: ...


def whirls(system: System, contact: IsotropicContact | None = None) -> tuple[Whirl, ...]:
    """Return every motion of ``system`` on a circle about the axis with permanent slip; X0 = 0 only.

    Of a pin there is at most one: that of (11) where |ω| > k, in the sense in which the disc turns. There is none

    - for |ω| <= k: the pin would run ahead of the disc, and friction would brake it as the damping does;
    - for β = 0: with friction nothing limits the radius, and without friction every radius is as good;
    - for μN = 0: nothing drives it;
    - for C = 0: nothing holds the pin on a circle.

    Of a disc there may be several, all with the pin's frequency ±k and smaller than the pin's, the largest first.
    The same conditions hold, and the load must reach :func:`smallest_load_with_whirl`.
    :func:`why_no_whirl` tells which condition fails.

    A support that hardens or has a stop turns the pin the faster the larger its circle is. At the speed μN/β there is
    one circle only, see :func:`reference_model.formulas.pin.whirl_radius`; it is a whirl where the disc turns faster.
    Where it does not the pin ends by sticking, at the radius at which the support carries it round with the disc; so
    it does for β = 0. The circles of a disc, where friction has a share along the circle only, are smaller and slower
    than the pin's: it may have whirls where a pin sticks.

    Parameters
    ----------
    system : PinOnDisc or DiscOnDisc
        The parameters.
    contact : IsotropicContact or None
        Law of friction of a disc; None for that of the parameters.

    Raises
    ------
    ValueError
        If the offset is not zero: then the orbit is no circle about the axis. Else as
        :func:`self_centred_equilibria`.

    """
    _require_centred(system)
    if isinstance(system, PinOnDisc):
        contact_of(system, contact)  # refuses any
        return _whirls_of_pin(system)
    return _whirls_of_disc(system, isotropic_contact_of(system, contact, "steady motions"))


def _whirls_of_pin(pin: PinOnDisc) -> tuple[Whirl, ...]:
    """Return the one of (11), if there is one."""
    if _why_no_whirl_of_pin(pin) is not None:
        return ()
    eigenvalues = whirl_eigenvalues(pin)
    return (
        Whirl(
            radius=whirl_radius(pin),
            frequency=whirl_frequency(pin),
            eigenvalues=eigenvalues,
            stable=_decay(eigenvalues[1:]),  # all but the phase
        ),
    )


def _whirls_of_disc(disc: DiscOnDisc, law: IsotropicContact) -> tuple[SpinningWhirl, ...]:
    """Return those that are left by the balances of forces and moments, the largest first."""
    if _why_no_circle_of_disc(disc) is not None:
        return ()
    found = []
    for radius, spin in circles(disc, law):
        frequency = math.copysign(circling_speed(pin_of(disc), radius), disc.disc_speed)
        eigenvalues = whirl_eigenvalues(disc, circling(radius, frequency, spin), law)
        found.append(
            SpinningWhirl(
                radius=radius,
                frequency=frequency,
                spin=spin,
                eigenvalues=eigenvalues,
                stable=_decay(eigenvalues[1:]),
            )
        )
    return tuple(found)


def why_no_equilibrium(system: System, contact: IsotropicContact | None = None) -> str | None:
    """Return in a sentence which condition fails where ``self_centred_equilibria`` are none; else None.

    Parameters and errors as there.
    """
    if self_centred_equilibria(system, contact):
        return None
    if isinstance(system, PinOnDisc):
        return _why_no_equilibrium_of_pin(system)
    if not Support.of(system).centring and 0.0 in (system.disc_speed, system.friction_force):
        return "stiffness = 0 N/m: without springs the disc rests in every place, and in none more than in another"
    if system.friction_force == 0.0:
        return (
            "shaft_damping = 0 N m s/rad, friction_force = 0 N: the disc spins at every speed, and at none more "
            "than at another"
        )
    held, torque = held_pin(system, contact), shaft_torque(system)
    if system.disc_speed == 0.0:
        return (
            f"disc_speed = 0 rad/s, friction_force = {system.friction_force:g} N: friction holds the moment of the "
            f"shaft, {torque:g} N m, and a disc at rest sticks to a master disc at rest"
        )
    return (
        f"friction_force = {system.friction_force:g} N: beside the moment of the shaft, {torque:g} N m, friction "
        f"holds a force of {held.friction_force:g} N, not less than that of the springs, "
        f"{largest_load_in_words(held)} = {largest_load_with_equilibrium(held):g} N: the disc sticks on the axis"
    )


def why_no_whirl(system: System, contact: IsotropicContact | None = None) -> str | None:
    """Return in a sentence which condition fails where :func:`whirls` finds none; else None.

    Parameters and errors as there.
    """
    if whirls(system, contact):
        return None
    if isinstance(system, PinOnDisc):
        return _why_no_whirl_of_pin(system)
    reason = _why_no_circle_of_disc(system)
    if reason is not None:
        return reason
    if not system.linear_support:
        return (
            f"friction_force = {system.friction_force:g} N: on no circle do the support, which turns the disc the "
            "faster the larger it is, and the shaft balance friction that slips"
        )
    return (
        f"friction_force = {system.friction_force:g} N: a whirl exists only above "
        f"{smallest_load_with_whirl(system, contact):g} N; below, the disc rotates about the axis"
    )


def smallest_load_with_whirl(disc: DiscOnDisc, contact: IsotropicContact | None = None) -> float:
    """Return the μN in N above which a disc without offset has a whirl; zero where it has one at every load.

    The balances of a whirl give its load in closed form for each ratio of slip to rim speed, see
    :func:`reference_model.formulas.disc.whirl_at`. The least of these loads belongs either to a whirl of no size,
    and then it is :func:`reference_model.steady.stability.onset_load`, or to a fold, where two whirls meet.

    Parameters
    ----------
    disc : DiscOnDisc
        The parameters; ``friction_force`` does not matter.
    contact : IsotropicContact or None
        Law of friction; None for that of the parameters.

    Raises
    ------
    ValueError
        If there is no whirl at any load, see :func:`whirls`; if the support is not linear, so that whirls may begin
        and end at several loads.

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


def _why_no_whirl_of_pin(pin: PinOnDisc) -> str | None:
    return _refusal(whirl_radius, pin)


def _why_no_circle_of_disc(disc: DiscOnDisc) -> str | None:
    """Return why a disc has no whirl at any load; shared-out friction may drive one where that of a pin may not."""
    return _refusal(whirl_radius if disc.linear_support else require_drive, pin_of(disc))


def _refusal(formula: Callable[[PinOnDisc], object], pin: PinOnDisc) -> str | None:
    """Return why ``formula`` does not hold for ``pin``, or None."""
    try:
        formula(pin)
    except ValueError as error:
        return str(error)
    return None


def _require_centred(system: System) -> None:
    require_system(system)
    if system.offset != 0.0:
        raise ValueError(
            f"offset = {system.offset:g} m: without an offset of 0 the periodic orbit is no circle about the axis; "
            "it is found by shooting, see whirl_orbit()"
        )


def _decay(eigenvalues: tuple[complex, ...]) -> bool:
    return all(value.real < 0.0 for value in eigenvalues)
