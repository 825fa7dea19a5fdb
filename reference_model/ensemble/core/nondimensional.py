"""Units that make a motion of order one, and its rounding error in them."""

from __future__ import annotations

from reference_model.ensemble.core.jit import scalar

ROUNDING = 4.0 * 2.220446049250313e-16
"""Relative slip that counts as none: a body that moves with the disc to rounding error sticks."""


@scalar
def units(
    k: float, c: float, g: float, omega: float, offset: float, place: float, speed: float
) -> tuple[float, float]:
    """Return the unit of length in m and the inverse unit of time in 1/s, as ``units.Units.of`` for a pin."""
    rate = max(k, abs(omega))
    if rate == 0.0:
        rate = c
    if rate == 0.0:
        rate = g / speed if g > 0.0 and speed > 0.0 else 1.0
    length = max(max(place, abs(offset)), max(speed / rate, g / rate**2))
    return (length if length > 0.0 else 1.0), rate
