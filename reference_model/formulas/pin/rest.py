"""Section 2 of the paper: the self-centred equilibrium, (3) to (5)."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import ArrayLike

from reference_model.formulas.pin.conditions import turning_direction
from reference_model.support import Support
from reference_model.systems import FloatArray, PinOnDisc


def equilibrium_radius(pin: PinOnDisc) -> float:
    """Return ρ* of (3), the distance of the pin at rest from the axis, in m.

    Friction acts along the circle about the axis, so the springs must pull by μN at a right angle to ρ*. Their
    deflection d* = √(X0² − ρ*²) is that of the force μN, which is μN/C on a linear support.

    Raises ``ValueError`` if (5) fails, if there are no springs, or if the disc is at rest and there is friction.
    """
    _require_equilibrium(pin)
    if pin.linear_support:
        largest, load = largest_load_with_equilibrium(pin), pin.friction_force
        # A product, because the difference of two nearly equal squares would lose digits near the limit (5).
        return math.sqrt((largest - load) * (largest + load)) / pin.stiffness
    offset, deflection = abs(pin.offset), _equilibrium_deflection(pin)
    return math.sqrt(max((offset - deflection) * (offset + deflection), 0.0))


def equilibrium_angle(pin: PinOnDisc) -> float:
    """Return ψ* of (3), the angle of the pin at rest, in rad between −π and π.

    Raises ``ValueError`` as :func:`equilibrium_radius`, and if the offset is zero, where no direction is
    distinguished.
    """
    _require_equilibrium(pin)
    if pin.offset == 0.0:
        raise ValueError("offset = 0 m: the equilibrium is the axis itself and has no angle")
    angle = math.atan2(_equilibrium_deflection(pin), equilibrium_radius(pin))
    if pin.offset < 0.0:
        angle -= math.pi
    return turning_direction(pin) * angle


def equilibrium_position(pin: PinOnDisc) -> tuple[float, float]:
    """Return x* and y* of (3), the position of the pin at rest, in m.

    Raises ``ValueError`` as :func:`equilibrium_radius`.
    """
    radius = equilibrium_radius(pin)
    if pin.offset == 0.0:
        return 0.0, 0.0
    x = radius**2 / pin.offset
    y = turning_direction(pin) * _equilibrium_deflection(pin) / pin.offset * radius
    return x, y


def semicircle_residual(pin: PinOnDisc, x: ArrayLike, y: ArrayLike) -> FloatArray:
    """Return left side minus right side of (4), in m²: zero on the circle through the axis and (X0, 0).

    ``x`` and ``y`` in m may be numbers or arrays of one shape; the result has that shape.
    """
    x, y = np.asarray(x, dtype=float), np.asarray(y, dtype=float)
    residual: FloatArray = (x - pin.offset / 2.0) ** 2 + y**2 - pin.offset**2 / 4.0
    return residual


def largest_load_with_equilibrium(pin: PinOnDisc) -> float:
    """Return C·|X0| of (5) in N, the spring force on the axis: the equilibrium exists up to this μN."""
    return Support.of(pin).pull(abs(pin.offset))


def largest_load_in_words(pin: PinOnDisc) -> str:
    """Return a description of :func:`largest_load_with_equilibrium` for messages."""
    return "stiffness·|offset|" if pin.linear_support else "force of the support at |offset|"


def _require_equilibrium(pin: PinOnDisc) -> None:
    support = Support.of(pin)
    if not (support.centring or (pin.stop_stiffness > 0.0 and pin.friction_force > 0.0)):
        raise ValueError("stiffness = 0 N/m: without springs there is no self-centred equilibrium")
    if pin.friction_force > largest_load_with_equilibrium(pin):
        raise ValueError(
            f"friction_force = {pin.friction_force:g} N: the self-centred equilibrium exists only up to "
            f"{largest_load_in_words(pin)} = {largest_load_with_equilibrium(pin):g} N (eq. 5)"
        )
    if pin.disc_speed == 0.0 and pin.friction_force > 0.0:
        raise ValueError("disc_speed = 0 rad/s: a pin at rest sticks to a disc at rest and does not slide")


def _equilibrium_deflection(pin: PinOnDisc) -> float:
    return Support.of(pin).deflection(pin.friction_force)
