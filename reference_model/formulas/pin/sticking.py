"""Section 2 of the paper: sticking, (6) to (9)."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import ArrayLike

from reference_model.formulas.pin.conditions import turning_direction
from reference_model.formulas.pin.rest import largest_load_with_equilibrium
from reference_model.support import require_linear_support
from reference_model.systems import FloatArray, PinOnDisc


def squared_holding_force(pin: PinOnDisc, radius: ArrayLike, disc_angle: ArrayLike) -> FloatArray:
    """Return the right side of (7) in N²: the square of the friction force that holds a pin on the disc.

    ``radius`` is the distance A of the stuck pin from the axis in m, ``disc_angle`` its angle ωt in rad; both may
    be arrays. Raises ``ValueError`` if the support is not linear.
    """
    require_linear_support(pin)
    A, angle = np.asarray(radius, dtype=float), np.asarray(disc_angle, dtype=float)
    C, X0, omega = pin.stiffness, pin.offset, pin.disc_speed
    elastic = C - pin.mass * omega**2
    viscous = pin.damping * omega
    squared_force: FloatArray = (
        elastic**2 * A**2
        + viscous**2 * A**2
        + C**2 * X0**2
        - 2.0 * C * X0 * A * (elastic * np.cos(angle) - viscous * np.sin(angle))
    )
    return squared_force


def turn_until_release(pin: PinOnDisc, radius: float, start_angle: float) -> float:
    """Return the rotation of the disc until release in rad, the first root of (7) with equality.

    The holding force is the third side of a triangle. The first two sides are the force that carries the pin round
    on springs relaxed at the axis, of magnitude √((C − mω²)² + β²ω²)·A, and the force C·X0 of the offset. Only the
    angle between these two changes in time, and it grows as the disc turns.

    ``radius`` is A >= 0 in m, and ``start_angle`` the angle of the pin at the start in rad. The result is >= 0 for
    either sense of rotation; ``inf`` for permanent stick, 0 if friction cannot hold the pin at the start. Raises
    ``ValueError`` if ``radius`` is negative or the support not linear.
    """
    require_linear_support(pin)
    if radius < 0.0:
        raise ValueError(f"radius = {radius:g} m: it must be >= 0")
    carry = _dynamic_stiffness(pin) * radius
    pull = largest_load_with_equilibrium(pin)
    friction = pin.friction_force
    if carry + pull <= friction:  # (8)
        return math.inf
    excess = carry - pull
    if abs(excess) > friction:
        return 0.0
    direction = turning_direction(pin)
    lead = math.atan2(pin.damping * pin.disc_speed, pin.stiffness - pin.mass * pin.disc_speed**2)
    half_turn = math.pi if pin.offset < 0.0 else 0.0
    start = math.remainder(direction * (start_angle + lead) + half_turn, 2.0 * math.pi)
    # The law of cosines for half the angle is accurate for a flat triangle, where an arccos loses digits.
    opening = 2.0 * math.atan2(
        math.sqrt((friction - excess) * (friction + excess)),
        math.sqrt((carry + pull - friction) * (carry + pull + friction)),
    )
    if abs(start) > opening:
        return 0.0
    return opening - start if pin.disc_speed != 0.0 else math.inf


def release_time(pin: PinOnDisc, radius: float, start_angle: float) -> float:
    """Return the time in s until a pin at ``radius`` (m) and ``start_angle`` (rad) is released, by (7)."""
    turn = turn_until_release(pin, radius, start_angle)
    return turn / abs(pin.disc_speed) if 0.0 < turn < math.inf else turn


def sticking_margin(pin: PinOnDisc, radius: float) -> float:
    """Return right side minus left side of (8) in N: >= 0 if a pin at ``radius`` (m) sticks in every position.

    Raises ``ValueError`` if the support is not linear.
    """
    return pin.friction_force - largest_load_with_equilibrium(pin) - _dynamic_stiffness(pin) * radius


def sticking_radius(pin: PinOnDisc) -> float:
    """Return the right side of (9) in m: the largest distance from the axis with permanent stick.

    It is ``inf`` if an undamped pin is carried round at its natural frequency, which takes no force.

    Raises ``ValueError`` if μN <= C·|X0|, where friction cannot hold the pin even on the axis, or if the support is
    not linear.
    """
    spare = sticking_margin(pin, 0.0)
    if spare <= 0.0:
        raise ValueError(
            f"friction_force = {pin.friction_force:g} N: the pin sticks permanently only above "
            f"stiffness·|offset| = {largest_load_with_equilibrium(pin):g} N (eq. 9)"
        )
    dynamic_stiffness = _dynamic_stiffness(pin)
    return spare / dynamic_stiffness if dynamic_stiffness > 0.0 else math.inf


def resonant_disc_speed(pin: PinOnDisc) -> float:
    """Return ω* below (9) in rad/s, the disc speed with the largest sticking domain.

    Raises ``ValueError`` if C/m <= β²/2m², where the domain shrinks from ω = 0 on, or if the support is not linear.
    """
    require_linear_support(pin)
    spring, damper = pin.stiffness / pin.mass, pin.damping**2 / (2.0 * pin.mass**2)
    if spring <= damper:
        raise ValueError(
            f"damping = {pin.damping:g} N s/m: the sticking domain has a maximum only below "
            f"√(2·mass·stiffness) = {math.sqrt(2.0 * pin.mass * pin.stiffness):g} N s/m"
        )
    return math.sqrt(spring - damper)


def _dynamic_stiffness(pin: PinOnDisc) -> float:
    """Return √((C − mω²)² + β²ω²) of (8) in N/m: the force per radius that carries the pin round."""
    require_linear_support(pin)
    return math.hypot(pin.stiffness - pin.mass * pin.disc_speed**2, pin.damping * pin.disc_speed)
