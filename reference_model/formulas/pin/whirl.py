"""Section 3 of the paper: the whirl without offset, (11)."""

from __future__ import annotations

import math

from reference_model.formulas.pin.conditions import require_positive, turning_direction
from reference_model.support import Support
from reference_model.systems import PinOnDisc


def whirl_radius(pin: PinOnDisc) -> float:
    """Return ρ_c of (11) in m, the radius of the whirl without offset.

    By the balance along the circle the pin moves at the speed v = μN/β, whatever its support. The circle follows
    from m·v² = C·ρ² + C₃·ρ⁴ + C_s·ρ·max(0, ρ − gap). It is unique because the right side grows with ρ.

    Raises ``ValueError`` if there is no whirl. The paper says it "always exists", but by the sense of the friction
    force in (10) it requires |ω| > ψ̇ (k on a linear support), and springs, damping and friction.
    """
    require_whirl(pin)
    return driven_radius(pin, pin.friction_force)


def whirl_frequency(pin: PinOnDisc) -> float:
    """Return ψ̇ of (11) in rad/s: k if ω > k, −k if ω < −k, and (μN/β)/ρ_c in general.

    Raises ``ValueError`` as :func:`whirl_radius`.
    """
    require_whirl(pin)
    return turning_direction(pin) * circling_speed(pin, driven_radius(pin, pin.friction_force))


def driven_radius(pin: PinOnDisc, drive: float) -> float:
    """Return the radius in m of a pin that the support carries on a circle at the speed ``drive`` (N) / β."""
    if pin.linear_support:
        return drive / (pin.damping * pin.natural_frequency)
    return Support.of(pin).circle(pin.mass * (drive / pin.damping) ** 2)


def circling_speed(pin: PinOnDisc, radius: float) -> float:
    """Return the angular velocity in rad/s of a free circle about (X0, 0)."""
    return math.sqrt(Support.of(pin).secant(radius) / pin.mass)


def require_drive(pin: PinOnDisc) -> None:
    """Raise ``ValueError`` unless there are springs, damping and friction, which every whirl requires."""
    if pin.linear_support:
        require_positive(pin, "stiffness")
    elif pin.damping == 0.0 < pin.friction_force:
        raise ValueError(
            "damping = 0: it must be > 0 for a whirl to exist; without it the circle grows until the support "
            "carries the pin as fast as the disc turns, and the pin sticks"
        )
    require_positive(pin, "damping", "friction_force")


def require_whirl(pin: PinOnDisc) -> None:
    """Raise ``ValueError`` unless a whirl exists, see :func:`whirl_radius`."""
    require_drive(pin)
    if not pin.linear_support:
        radius = driven_radius(pin, pin.friction_force)
        frequency = circling_speed(pin, radius)
        if abs(pin.disc_speed) <= frequency:
            raise ValueError(
                f"disc_speed = {pin.disc_speed:g} rad/s: the whirl exists only if the disc turns faster than the "
                f"{frequency:g} rad/s at which the support carries the pin on a circle of {radius:g} m; here the "
                "pin ends by sticking"
            )
        return
    if abs(pin.disc_speed) <= pin.natural_frequency:
        raise ValueError(
            f"disc_speed = {pin.disc_speed:g} rad/s: the whirl exists only if the disc turns faster than "
            f"the natural frequency {pin.natural_frequency:g} rad/s in either sense"
        )
