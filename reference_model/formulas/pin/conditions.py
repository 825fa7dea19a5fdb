"""Conditions that several formulas of the pin share."""

from __future__ import annotations

import math

from reference_model.support import require_linear_support
from reference_model.systems import PinOnDisc


def turning_direction(pin: PinOnDisc) -> float:
    """Return the sign of ω."""
    return math.copysign(1.0, pin.disc_speed)


def speed_ratio(pin: PinOnDisc) -> float:
    """Return ω/(ω − k) of (12)–(18), for |ω|."""
    require_linear_support(pin)
    speed, k = abs(pin.disc_speed), pin.natural_frequency
    if speed == k:
        raise ValueError(
            f"disc_speed = {pin.disc_speed:g} rad/s: ω/(ω − k) is undefined at the natural frequency k"
        )
    return speed / (speed - k)


def require_positive(pin: PinOnDisc, *names: str) -> None:
    """Raise ``ValueError`` unless these parameters are > 0, which every whirl requires."""
    for name in names:
        if getattr(pin, name) == 0.0:
            raise ValueError(f"{name} = 0: it must be > 0 for a whirl to exist")
