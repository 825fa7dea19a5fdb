"""The closed forms of sections 2 and 3 of the paper, one function an equation.

Signs
-----
The paper takes ω > 0 and X0 > 0. Here both may have either sign:

- A disc that turns the other way gives the motion mirrored in the x axis. So a formula of the paper is
  evaluated for |ω|, and what it says about y, about an angle or about a direction of turning changes its
  sign where ω < 0: the whirl of ω < −k has the frequency −k.
- An offset on the other side gives the motion turned by half a revolution: x and y change their signs. So
  conditions such as (5) and (8) hold with |X0|.

Those of the balances of (3) and (11) hold for a support that hardens or has a stop too, with its force in the place
of that of the spring. The others are for a linear support and refuse any else.

A formula raises ``ValueError`` where what it describes does not exist, and names the condition that fails.
The exceptions are (12)–(16), which the paper uses for ω < k too: they are statements about a matrix and its
characteristic equation, and only |ω| = k, where ω/(ω − k) has no value, is refused.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from reference_model.support import Support, require_linear_support
from reference_model.systems import FloatArray, PinOnDisc

# ---------------------------------------------------------------- section 2: the self-centred equilibrium


def equilibrium_radius(pin: PinOnDisc) -> float:
    """ρ* of (3), the distance of the pin at rest from the axis, in m.

    Friction acts along the circle about the axis, so that springs must pull at a right angle to ρ*, and by μN: their
    deflection d* = √(X0² − ρ*²) is that of the force μN, μN/C of a linear support.

    Raises
    ------
    ValueError
        If (5) fails, if there are no springs, or if the disc stands still under a pin with friction.

    """
    _require_equilibrium(pin)
    if pin.linear_support:
        largest, load = largest_load_with_equilibrium(pin), pin.friction_force
        # As a product: the difference of two nearly equal squares would lose the digits near the limit (5).
        return math.sqrt((largest - load) * (largest + load)) / pin.stiffness
    offset, deflection = abs(pin.offset), _equilibrium_deflection(pin)
    return math.sqrt(max((offset - deflection) * (offset + deflection), 0.0))


def equilibrium_angle(pin: PinOnDisc) -> float:
    """ψ* of (3), the angle of the pin at rest, in rad between −π and π.

    Raises
    ------
    ValueError
        As :func:`equilibrium_radius`, and for an offset of zero, where no direction is distinguished.

    """
    _require_equilibrium(pin)
    if pin.offset == 0.0:
        raise ValueError("offset = 0 m: the equilibrium is the axis itself and has no angle")
    angle = math.atan2(_equilibrium_deflection(pin), equilibrium_radius(pin))
    if pin.offset < 0.0:
        angle -= math.pi
    return _turning_direction(pin) * angle


def equilibrium_position(pin: PinOnDisc) -> tuple[float, float]:
    """x* and y* of (3), the position of the pin at rest, in m.

    Raises
    ------
    ValueError
        As :func:`equilibrium_radius`.

    """
    radius = equilibrium_radius(pin)
    if pin.offset == 0.0:
        return 0.0, 0.0
    x = radius**2 / pin.offset
    y = _turning_direction(pin) * _equilibrium_deflection(pin) / pin.offset * radius
    return x, y


def semicircle_residual(pin: PinOnDisc, x: ArrayLike, y: ArrayLike) -> FloatArray:
    """Left side minus right side of (4), in m²: zero on the circle through the axis and (X0, 0).

    ``x`` and ``y`` in m may be numbers or arrays of one shape; the result has that shape.
    """
    x, y = np.asarray(x, dtype=float), np.asarray(y, dtype=float)
    residual: FloatArray = (x - pin.offset / 2.0) ** 2 + y**2 - pin.offset**2 / 4.0
    return residual


def largest_load_with_equilibrium(pin: PinOnDisc) -> float:
    """Return C·|X0| of (5) in N, the pull of the springs on the axis: up to this μN the equilibrium exists."""
    return Support.of(pin).pull(abs(pin.offset))


def largest_load_in_words(pin: PinOnDisc) -> str:
    """Say what :func:`largest_load_with_equilibrium` is."""
    return "stiffness·|offset|" if pin.linear_support else "force of the support at |offset|"


# ---------------------------------------------------------------- section 2: sticking


def squared_holding_force(pin: PinOnDisc, radius: ArrayLike, disc_angle: ArrayLike) -> FloatArray:
    """Return the right side of (7) in N²: the square of the friction force that holds a pin on the disc.

    Parameters
    ----------
    pin : PinOnDisc
        The parameters.
    radius : float or array
        A, the distance of the stuck pin from the axis, in m.
    disc_angle : float or array
        ωt, the angle at which the stuck pin is, in rad.

    Raises
    ------
    ValueError
        If the support is not linear.

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
    """Angle by which the disc turns until it can't hold the pin: the first root of (7) with equality.

    The holding force is the third side of a triangle. The first two are the force that carries the pin round
    on springs relaxed at the axis, of magnitude √((C − mω²)² + β²ω²)·A, and the force C·X0 of the offset.
    Only the angle between these two changes in time, and it grows as the disc turns.

    Parameters
    ----------
    pin : PinOnDisc
        The parameters.
    radius : float
        A, the distance of the stuck pin from the axis, in m, >= 0.
    start_angle : float
        The angle of the pin at the start, in rad.

    Returns
    -------
    float
        In rad, >= 0 for either sense of turning; ``inf`` if the pin stays on the disc for ever, 0 if friction
        can't hold it at the start.

    Raises
    ------
    ValueError
        If ``radius`` is negative or the support not linear.

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
    direction = _turning_direction(pin)
    lead = math.atan2(pin.damping * pin.disc_speed, pin.stiffness - pin.mass * pin.disc_speed**2)
    half_turn = math.pi if pin.offset < 0.0 else 0.0
    start = math.remainder(direction * (start_angle + lead) + half_turn, 2.0 * math.pi)
    # Law of cosines for half the angle: keeps its digits where the triangle is flat, which an arccos loses.
    opening = 2.0 * math.atan2(
        math.sqrt((friction - excess) * (friction + excess)),
        math.sqrt((carry + pull - friction) * (carry + pull + friction)),
    )
    if abs(start) > opening:
        return 0.0
    return opening - start if pin.disc_speed != 0.0 else math.inf


def release_time(pin: PinOnDisc, radius: float, start_angle: float) -> float:
    """Time in s until a pin stuck at ``radius`` (m) and ``start_angle`` (rad) lets go, by (7) with equality.

    ``inf`` if it stays on the disc for ever, 0 if friction can't hold it at the start. Raises ``ValueError``
    as :func:`turn_until_release`.
    """
    turn = turn_until_release(pin, radius, start_angle)
    return turn / abs(pin.disc_speed) if 0.0 < turn < math.inf else turn


def sticking_margin(pin: PinOnDisc, radius: float) -> float:
    """Right side minus left side of (8) in N: >= 0 where a pin at ``radius`` (m) sticks in every position.

    Raises ``ValueError`` if the support is not linear.
    """
    return pin.friction_force - largest_load_with_equilibrium(pin) - _dynamic_stiffness(pin) * radius


def sticking_radius(pin: PinOnDisc) -> float:
    """Right side of (9) in m: up to this distance from the axis the pin sticks for ever.

    ``inf`` where an undamped pin is carried round at its natural frequency, which takes no force.

    Raises
    ------
    ValueError
        If μN <= C·|X0|: then friction is too weak to hold the pin even on the axis; if the support is not linear.

    """
    spare = sticking_margin(pin, 0.0)
    if spare <= 0.0:
        raise ValueError(
            f"friction_force = {pin.friction_force:g} N: the pin sticks for ever only above "
            f"stiffness·|offset| = {largest_load_with_equilibrium(pin):g} N (eq. 9)"
        )
    dynamic_stiffness = _dynamic_stiffness(pin)
    return spare / dynamic_stiffness if dynamic_stiffness > 0.0 else math.inf


def resonant_disc_speed(pin: PinOnDisc) -> float:
    """ω* below (9) in rad/s, the speed at which the sticking domain is largest.

    Raises
    ------
    ValueError
        If C/m <= β²/2m²: then the domain shrinks from ω = 0 on; if the support is not linear.

    """
    require_linear_support(pin)
    spring, damper = pin.stiffness / pin.mass, pin.damping**2 / (2.0 * pin.mass**2)
    if spring <= damper:
        raise ValueError(
            f"damping = {pin.damping:g} N s/m: the sticking domain has a largest size only below "
            f"√(2·mass·stiffness) = {math.sqrt(2.0 * pin.mass * pin.stiffness):g} N s/m"
        )
    return math.sqrt(spring - damper)


# ---------------------------------------------------------------- section 3: the whirl and its stability


def whirl_radius(pin: PinOnDisc) -> float:
    """ρ_c of (11) in m, the radius of the whirl without offset.

    By the balance along the circle the pin moves at the speed v = μN/β, whatever its support; and of the circles on
    which that carries it round, m·v² = C·ρ² + C₃·ρ⁴ + C_s·ρ·max(0, ρ − gap), there is one, since the right side grows
    with ρ.

    Raises
    ------
    ValueError
        If there is no whirl. The paper says "always exists"; by the sense of the friction force in (10) it
        does only where |ω| > ψ̇ (k on a linear support), and it takes springs, damping and friction.

    """
    _require_whirl(pin)
    return driven_radius(pin, pin.friction_force)


def whirl_frequency(pin: PinOnDisc) -> float:
    """ψ̇ of (11) in rad/s: k where ω > k, −k where ω < −k; (μN/β)/ρ_c in general.

    Raises
    ------
    ValueError
        As :func:`whirl_radius`.

    """
    _require_whirl(pin)
    return _turning_direction(pin) * circling_speed(pin, driven_radius(pin, pin.friction_force))


def driven_radius(pin: PinOnDisc, drive: float) -> float:
    """Return the radius in m of the circle on which the support carries a pin of the speed ``drive`` (N) / β."""
    if pin.linear_support:
        return drive / (pin.damping * pin.natural_frequency)
    return Support.of(pin).circle(pin.mass * (drive / pin.damping) ** 2)


def circling_speed(pin: PinOnDisc, radius: float) -> float:
    """Return the speed of turning in rad/s at which the support carries the pin on a circle about (X0, 0)."""
    return math.sqrt(Support.of(pin).secant(radius) / pin.mass)


def variational_matrix(pin: PinOnDisc) -> FloatArray:
    """Matrix of (12), shape (3, 3): its product with (ξ, ξ̇, η) is the time derivative of that.

    ξ and η are the deviations of the radius in m and of the speed of turning, counted in the sense of ω, in
    rad/s.

    Raises
    ------
    ValueError
        If |ω| = k, if damping or friction force is zero, or if the support is not linear.

    """
    _require_positive(pin, "damping", "friction_force")
    rate, k = pin.damping / pin.mass, pin.natural_frequency
    coupling = pin.damping * k**2 / pin.friction_force
    return np.array(
        [
            [0.0, 1.0, 0.0],
            [0.0, -rate * _speed_ratio(pin), 2.0 * pin.friction_force / pin.damping],
            [-coupling * rate, -2.0 * coupling, -rate],
        ]
    )


def characteristic_coefficients(pin: PinOnDisc) -> tuple[float, float, float, float]:
    """Coefficients of λ³, λ², λ and 1 of the characteristic equation of (12): (13) corrected.

    In units of 1, 1/s, 1/s² and 1/s³. Raises ``ValueError`` if |ω| = k.
    """
    rate, k, ratio = pin.damping / pin.mass, pin.natural_frequency, _speed_ratio(pin)
    return 1.0, rate * (1.0 + ratio), rate**2 * ratio + 4.0 * k**2, 2.0 * k**2 * rate


def characteristic_coefficients_as_printed(pin: PinOnDisc) -> tuple[float, float, float, float]:
    """Coefficients of (13) as the paper prints them; wrong, and kept to show it.

    The coefficient of λ² is printed as 1 + (β/m)·ω/(ω − k), which adds a number to a rate. The determinant of
    (12) has (β/m)·(1 + ω/(ω − k)), see :func:`characteristic_coefficients`. Raises ``ValueError`` if |ω| = k.
    """
    _, _, linear, constant = characteristic_coefficients(pin)
    return 1.0, 1.0 + pin.damping / pin.mass * _speed_ratio(pin), linear, constant


def coefficient_margins(pin: PinOnDisc) -> tuple[float, float]:
    """Left side minus right side of the two conditions (14): both > 0 where the coefficients of (13) are.

    Raises ``ValueError`` if |ω| = k or if the damping is zero.
    """
    ratio = _speed_ratio(pin)
    return ratio + 1.0, ratio + _stiffness_to_damping(pin)


def lower_branch_margin(pin: PinOnDisc) -> float:
    """Right side minus left side of (15): > 0 where it holds, which excludes (14).

    Raises ``ValueError`` if |ω| = k or if the damping is zero.
    """
    q = _stiffness_to_damping(pin)
    return -0.5 * (1.0 + q + math.hypot(1.0, q)) - _speed_ratio(pin)


def upper_branch_margin(pin: PinOnDisc) -> float:
    """Left side minus right side of (16): > 0 exactly where all roots of (13) have negative real parts.

    Raises ``ValueError`` if |ω| = k or if the damping is zero.
    """
    q = _stiffness_to_damping(pin)
    # q − √(1 + q²) without the cancellation that would leave nothing of it for weak damping.
    return _speed_ratio(pin) + 0.5 * (1.0 - 1.0 / (q + math.hypot(1.0, q)))


# ---------------------------------------------------------------- section 3: the whirl with a small offset


class WhirlResponse(NamedTuple):
    """First-order response of the whirl to an offset, with z = x + iy and frequency κ = ±k.

    z(t) = ρ_c·exp(iκt) + ``mean`` + ``second_harmonic``·exp(2iκt), all in m; t = 0 is chosen such that the
    first harmonic is real.
    """

    mean: complex
    second_harmonic: complex


def whirl_shift(pin: PinOnDisc) -> tuple[float, float]:
    """x_s and y_s of (18) in m, the paper's approximation of the time mean of the whirl with an offset.

    It balances the first harmonic only. The second harmonic that the offset excites is of the same order in
    X0 and changes the mean, see :func:`first_order_whirl_shift`.

    Raises
    ------
    ValueError
        As :func:`whirl_radius`.

    """
    _require_whirl(pin)
    half = _relative_damping(pin) * _speed_ratio(pin) / 2.0  # βω/(2mk(ω − k))
    x = pin.offset / (1.0 + half**2)
    return x, _turning_direction(pin) * half * x


def first_order_whirl_response(pin: PinOnDisc) -> WhirlResponse:
    """Exact response of the whirl to the offset in first order of X0; the mean's error is of order X0³.

    (10) linearised about (11), with ρ = ρ_c + Re(Ξ·exp(ikt)) and ψ = kt + Re(U·exp(ikt))/ρ_c, is::

        (−k² + ik(β/m)ω/(ω−k))·Ξ −          2ik²·U =  k²X0
                (2ik² + kβ/m)·Ξ + (−k² + ikβ/m)·U = ik²X0

    In x + iy = ρ·exp(iψ) these amplitudes give the mean (conj Ξ + i·conj U)/2 and, at 2k, (Ξ + iU)/2. Solved
    for these two, with d = β/(mk) and w = ω/(ω − k)::

        mean            = X0·conj((6 − id(w + 2))/(2(3 + d²w + id(w − 1))))
        second harmonic = X0·idw/(2(3 + d²w + id(w − 1)))

    Raises
    ------
    ValueError
        As :func:`whirl_radius`.

    """
    _require_whirl(pin)
    d, w = _relative_damping(pin), _speed_ratio(pin)
    denominator = 2.0 * complex(3.0 + d**2 * w, d * (w - 1.0))
    response = WhirlResponse(
        mean=(pin.offset * complex(6.0, -d * (w + 2.0)) / denominator).conjugate(),
        second_harmonic=pin.offset * complex(0.0, d * w) / denominator,
    )
    return WhirlResponse(*(_mirrored(pin, amplitude) for amplitude in response))


def first_order_whirl_shift(pin: PinOnDisc) -> tuple[float, float]:
    """Time mean of x and y in m of the whirl with a small offset, exact in first order of X0.

    Raises
    ------
    ValueError
        As :func:`whirl_radius`.

    """
    mean = first_order_whirl_response(pin).mean
    return mean.real, mean.imag


def whirl_shift_error_limit(pin: PinOnDisc) -> complex:
    """Limit of the relative error of (18) as X0 → 0: z of (18) over the exact z, minus 1, with z = x + iy.

    With d and w of :func:`first_order_whirl_response` it is the complex conjugate of
    d²w(2 − w)/((2 + idw)(6 − id(w + 2))): zero at |ω| = 2k, and −1 as |ω| → k. It does not depend on the
    offset, which may be zero.

    Raises
    ------
    ValueError
        As :func:`whirl_radius`.

    """
    _require_whirl(pin)
    d, w = _relative_damping(pin), _speed_ratio(pin)
    error = d**2 * w * (2.0 - w) / (complex(2.0, d * w) * complex(6.0, -d * (w + 2.0)))
    return _mirrored(pin, error.conjugate())


def third_order_of_whirl_shift(pin: PinOnDisc) -> float:
    """Third order in X0 of the whirl's mean over its first order, to leading order in d = β/(mk): its imaginary part.

    With lengths in units of ρ_c and τ = kt, (1) without damping has the motions X0 + ρ·exp(iτ) + σ·exp(−iτ). Damping
    and friction, both of order d, choose ρ and σ, and add −d times the mean direction of slip to the mean. Slip has
    the direction of −i·exp(iτ)·(1 + u), u = a·exp(−iτ) + b·exp(−2iτ), with w = ω/(ω − k), a = wX0/ρ and
    b = (2w − 1)σ/ρ, of which these harmonics are left, to third order::

        exp(iτ)   1 − a²/4           = ρ
        exp(−iτ)  b/2 − a²/8         = −σ
        mean      a/2 + a³/16 − ab/4

    so that σ = a²/(4(2w + 1)), and the mean is X0·(1 + ½idw) to first order and, relative to it, to third::

        i·d·w(w + 1)/(4(2w + 1))·(wX0/ρ_c)²

    Raises
    ------
    ValueError
        As :func:`whirl_radius`.

    """
    _require_whirl(pin)
    d, w = _relative_damping(pin), _speed_ratio(pin)
    turn = w * pin.offset / whirl_radius(pin)
    return _turning_direction(pin) * d * w * (w + 1.0) / (4.0 * (2.0 * w + 1.0)) * turn**2


# ---------------------------------------------------------------- terms and conditions that several share


def _turning_direction(pin: PinOnDisc) -> float:
    """Sign of ω."""
    return math.copysign(1.0, pin.disc_speed)


def _mirrored(pin: PinOnDisc, amplitude: complex) -> complex:
    """Return an amplitude of x + iy, found for |ω|, as it is for ω."""
    return amplitude.conjugate() if pin.disc_speed < 0.0 else amplitude


def _dynamic_stiffness(pin: PinOnDisc) -> float:
    """√((C − mω²)² + β²ω²) of (8) in N/m: force a metre of radius for carrying the pin round."""
    require_linear_support(pin)
    return math.hypot(pin.stiffness - pin.mass * pin.disc_speed**2, pin.damping * pin.disc_speed)


def _relative_damping(pin: PinOnDisc) -> float:
    """β/(mk)."""
    return pin.damping / (pin.mass * pin.natural_frequency)


def _stiffness_to_damping(pin: PinOnDisc) -> float:
    """4k²m²/β² of (14)–(16)."""
    _require_positive(pin, "damping")
    ratio = 2.0 * pin.natural_frequency * pin.mass / pin.damping
    return ratio * ratio


def _speed_ratio(pin: PinOnDisc) -> float:
    """ω/(ω − k) of (12)–(18), for |ω|."""
    require_linear_support(pin)
    speed, k = abs(pin.disc_speed), pin.natural_frequency
    if speed == k:
        raise ValueError(
            f"disc_speed = {pin.disc_speed:g} rad/s: ω/(ω − k) has no value at the natural frequency k"
        )
    return speed / (speed - k)


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


def require_drive(pin: PinOnDisc) -> None:
    """Raise ``ValueError`` unless there are springs, damping and friction, which every whirl takes."""
    if pin.linear_support:
        _require_positive(pin, "stiffness")
    elif pin.damping == 0.0 < pin.friction_force:
        raise ValueError(
            "damping = 0: it must be > 0 for a whirl to exist; without it the circle grows until the support turns "
            "the pin as fast as the disc turns, and then it sticks"
        )
    _require_positive(pin, "damping", "friction_force")


def _require_whirl(pin: PinOnDisc) -> None:
    require_drive(pin)
    if not pin.linear_support:
        radius = driven_radius(pin, pin.friction_force)
        frequency = circling_speed(pin, radius)
        if abs(pin.disc_speed) <= frequency:
            raise ValueError(
                f"disc_speed = {pin.disc_speed:g} rad/s: the whirl exists only where the disc turns faster than the "
                f"{frequency:g} rad/s at which the support would turn the pin, on a circle of {radius:g} m; here the "
                "pin ends by sticking"
            )
        return
    if abs(pin.disc_speed) <= pin.natural_frequency:
        raise ValueError(
            f"disc_speed = {pin.disc_speed:g} rad/s: the whirl exists only where the disc turns faster than "
            f"the natural frequency {pin.natural_frequency:g} rad/s, in either sense"
        )


def _equilibrium_deflection(pin: PinOnDisc) -> float:
    """Return the deflection in m of the support that pulls by μN."""
    return Support.of(pin).deflection(pin.friction_force)


def _require_positive(pin: PinOnDisc, *names: str) -> None:
    for name in names:
        if getattr(pin, name) == 0.0:
            raise ValueError(f"{name} = 0: it must be > 0 for a whirl to exist")
