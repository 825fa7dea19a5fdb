"""Section 2 of the paper: the self-centred equilibrium, (3) to (5), and sticking, (6) to (9)."""

import math

import numpy as np
from numpy.typing import ArrayLike

from reference_model.support import Support, require_linear_support
from reference_model.systems import FloatArray, PinOnDisc, real_numbers, require_kind


def turning_direction(pin: PinOnDisc) -> float:
    """Return the sign of ω."""
    return math.copysign(1.0, pin.disc_speed)


def equilibrium_radius(pin: PinOnDisc) -> float:
    """Return ρ* of (3), the distance of the pin at rest from the axis, in m.

    Friction acts along the circle about the axis, so the springs must pull by μN at a right angle to ρ*. Their
    deflection is √(X0² − ρ*²), which is μN/C on a linear support.

    Raises ``ValueError`` if (5) fails, if there are no springs, or if the disc is at rest and there is friction.
    """
    _require_equilibrium(pin)
    if pin.linear_support:
        largest, load = largest_load_with_equilibrium(pin), pin.friction_force
        # The difference of two nearly equal squares would lose digits near the limit (5).
        return math.sqrt((largest - load) * (largest + load)) / pin.stiffness
    offset, deflection = abs(pin.offset), _equilibrium_deflection(pin)
    return math.sqrt(max((offset - deflection) * (offset + deflection), 0.0))


def equilibrium_angle(pin: PinOnDisc) -> float:
    """Return ψ* of (3), the angle of the pin at rest, in rad from −π to π; ``ValueError`` also without offset."""
    _require_equilibrium(pin)
    if pin.offset == 0.0:
        raise ValueError("offset = 0 m: the equilibrium is the axis itself and has no angle")
    angle = math.atan2(_equilibrium_deflection(pin), equilibrium_radius(pin))
    if pin.offset < 0.0:
        angle -= math.pi
    return turning_direction(pin) * angle


def equilibrium_position(pin: PinOnDisc) -> tuple[float, float]:
    """Return x* and y* of (3), the position of the pin at rest, in m."""
    radius = equilibrium_radius(pin)
    if pin.offset == 0.0:
        return 0.0, 0.0
    x = radius**2 / pin.offset
    y = turning_direction(pin) * _equilibrium_deflection(pin) / pin.offset * radius
    return x, y


def semicircle_residual(pin: PinOnDisc, x: ArrayLike, y: ArrayLike) -> FloatArray:
    """Return left side minus right side of (4), in m²: zero on the circle through the axis and (X0, 0).

    ``x`` and ``y`` in m may be numbers or arrays of one shape.
    """
    x, y = real_numbers("x", x), real_numbers("y", y)
    residual: FloatArray = (x - pin.offset / 2.0) ** 2 + y**2 - pin.offset**2 / 4.0
    return residual


def largest_load_with_equilibrium(pin: PinOnDisc) -> float:
    """Return C·|X0| of (5) in N, the spring force on the axis: the largest μN with equilibrium."""
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


def squared_holding_force(pin: PinOnDisc, radius: ArrayLike, disc_angle: ArrayLike) -> FloatArray:
    """Return the right side of (7) in N²: the square of the friction force that holds a pin on the disc.

    ``radius`` is the distance A from the axis in m, ``disc_angle`` the angle ωt in rad; both may be arrays.
    """
    require_linear_support(pin)
    A, angle = real_numbers("radius", radius), real_numbers("disc_angle", disc_angle)
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

    The holding force closes a triangle with the force that carries the pin round on springs relaxed at the axis,
    √((C − mω²)² + β²ω²)·A, and the force C·X0 of the offset. Only the angle between these two changes: it grows as
    the disc turns.

    ``radius`` is A >= 0 in m, and ``start_angle`` the angle of the pin at the start in rad. The result is ``inf`` for
    permanent stick, 0 if friction cannot hold the pin at the start. Raises ``ValueError`` if ``radius`` is negative
    or the support not linear.
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
    # For half the angle the law of cosines is accurate where an arccos loses digits.
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
    """Return right side minus left side of (8) in N: >= 0 if a pin at ``radius`` (m) sticks in every position."""
    return pin.friction_force - largest_load_with_equilibrium(pin) - _dynamic_stiffness(pin) * radius


def sticking_radius(pin: PinOnDisc) -> float:
    """Return the right side of (9) in m: the largest distance from the axis with permanent stick.

    It is ``inf`` if an undamped pin is carried round at its natural frequency. Raises ``ValueError`` if μN <= C·|X0|,
    where friction cannot hold the pin even on the axis, or if the support is not linear.
    """
    require_kind("pin", pin, PinOnDisc)
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
