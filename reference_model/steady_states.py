"""All steady motions of a system in which the contact slides all the time."""

from __future__ import annotations

from dataclasses import dataclass

from reference_model.pin_formulas import (
    equilibrium_position,
    largest_load_with_equilibrium,
    whirl_frequency,
    whirl_radius,
)
from reference_model.stability import equilibrium_eigenvalues, whirl_eigenvalues
from reference_model.systems import PinOnDisc


@dataclass(frozen=True, kw_only=True)
class SelfCentredEquilibrium:
    """A pin at rest in space on a disc that slides below it (3).

    Parameters
    ----------
    x, y : float
        In m.
    eigenvalues : tuple of complex
        In 1/s, the one that decays slowest first.
    stable : bool
        Whether all small deviations die out.

    """

    x: float
    y: float
    eigenvalues: tuple[complex, ...]
    stable: bool


@dataclass(frozen=True, kw_only=True)
class Whirl:
    """A motion on a circle about the axis with permanent slip (11).

    Parameters
    ----------
    radius : float
        In m.
    frequency : float
        In rad/s, negative where the pin turns clockwise.
    eigenvalues : tuple of complex
        In 1/s, in the frame that turns with the whirl: first the exact zero of the free phase, then the
        others, the one that decays slowest first.
    stable : bool
        Whether all small deviations die out but for a shift in phase.

    """

    radius: float
    frequency: float
    eigenvalues: tuple[complex, ...]
    stable: bool


def self_centred_equilibria(system: PinOnDisc) -> tuple[SelfCentredEquilibrium, ...]:
    """Return every equilibrium of ``system`` in which the pin rests in space and the disc slides below it.

    At most one: that of (3) where μN < C·|X0| and ω ≠ 0. There is none

    - where μN > C·|X0|, so for X0 = 0 too, and where μN = C·|X0|: then the pin would rest on the axis,
      where nothing slides, and it sticks;
    - for ω = 0 with friction: a pin at rest on a disc at rest sticks;
    - for C = 0: with friction nothing balances it, and without friction every position is as good.

    Without friction the pin rests at (X0, 0) whatever the disc does.
    """
    if system.stiffness == 0.0:
        return ()
    rests_without_sliding = (
        system.disc_speed == 0.0 or system.friction_force >= largest_load_with_equilibrium(system)
    )
    if system.friction_force > 0.0 and rests_without_sliding:
        return ()
    x, y = equilibrium_position(system)
    eigenvalues = equilibrium_eigenvalues(system)
    return (SelfCentredEquilibrium(x=x, y=y, eigenvalues=eigenvalues, stable=_decay(eigenvalues)),)


def whirls(system: PinOnDisc) -> tuple[Whirl, ...]:
    """Return every motion of ``system`` on a circle about the axis with permanent slip; X0 = 0 only.

    At most one: that of (11) where |ω| > k, in the sense in which the disc turns. There is none

    - for |ω| <= k: the pin would run ahead of the disc, and friction would brake it as the damping does;
    - for β = 0: with friction nothing limits the radius, and without friction every radius is as good;
    - for μN = 0: nothing drives it;
    - for C = 0: nothing holds the pin on a circle.

    Raises
    ------
    ValueError
        If the offset is not zero: then the orbit is no circle about the axis.

    """
    if system.offset != 0.0:
        raise ValueError(
            f"offset = {system.offset:g} m: whirls() takes an offset of 0 only; "
            "with an offset the periodic orbit is found by shooting, see whirl_orbit()"
        )
    lacks_a_force = 0.0 in (system.stiffness, system.damping, system.friction_force)
    if lacks_a_force or abs(system.disc_speed) <= system.natural_frequency:
        return ()
    eigenvalues = whirl_eigenvalues(system)
    return (
        Whirl(
            radius=whirl_radius(system),
            frequency=whirl_frequency(system),
            eigenvalues=eigenvalues,
            stable=_decay(eigenvalues[1:]),  # all but the phase
        ),
    )


def _decay(eigenvalues: tuple[complex, ...]) -> bool:
    return all(value.real < 0.0 for value in eigenvalues)
