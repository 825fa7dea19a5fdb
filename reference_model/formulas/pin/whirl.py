"""Section 3 of the paper: the whirl (11), its stability, (12) to (16), and the whirl with an offset.

For the offset it contains (18), and the exact first and third orders in X0. Its functions raise ``ValueError`` as
:func:`whirl_radius`.
"""

import math
from typing import NamedTuple

import numpy as np

from reference_model.formulas.pin.rest import turning_direction
from reference_model.support import Support, require_linear_support
from reference_model.systems import FloatArray, PinOnDisc


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
    """Raise ``ValueError`` unless these parameters are > 0."""
    for name in names:
        if getattr(pin, name) == 0.0:
            raise ValueError(f"{name} = 0: it must be > 0 for a whirl to exist")


def whirl_radius(pin: PinOnDisc) -> float:
    """Return ρ_c of (11) in m, the radius of the whirl without offset.

    The balance along the circle gives the speed v = μN/β. The circle follows from m·v² = C·ρ² + C₃·ρ⁴ + C_s·ρ·max(0,
    ρ − gap), whose right side grows with ρ.

    Raises ``ValueError`` without a whirl. The paper says it "always exists", but by the sense of friction in (10) it
    requires |ω| > ψ̇ (k on a linear support), springs, damping and friction.
    """
    require_whirl(pin)
    return driven_radius(pin, pin.friction_force)


def whirl_frequency(pin: PinOnDisc) -> float:
    """Return ψ̇ of (11) in rad/s: k if ω > k, −k if ω < −k, and (μN/β)/ρ_c in general."""
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
    """Raise ``ValueError`` unless a whirl exists."""
    require_drive(pin)
    if not pin.linear_support:
        radius = driven_radius(pin, pin.friction_force)
        frequency = circling_speed(pin, radius)
        if abs(pin.disc_speed) <= frequency:
            raise ValueError(
                f"disc_speed = {pin.disc_speed:g} rad/s: a whirl needs |disc_speed| > {frequency:g} rad/s, the speed "
                f"of free motion on a circle of {radius:g} m; below it the pin ends up sticking"
            )
        return
    if abs(pin.disc_speed) <= pin.natural_frequency:
        raise ValueError(
            f"disc_speed = {pin.disc_speed:g} rad/s: the whirl exists only if |disc_speed| exceeds the "
            f"natural frequency {pin.natural_frequency:g} rad/s"
        )


def variational_matrix(pin: PinOnDisc) -> FloatArray:
    """Return the matrix of (12), shape (3, 3): its product with (ξ, ξ̇, η) is the time derivative of (ξ, ξ̇, η).

    ξ is the deviation of the radius in m, and η the deviation of the angular velocity in the sense of ω, in rad/s.
    Raises ``ValueError`` if |ω| = k, if damping or friction force is zero, or if the support is not linear.
    """
    require_positive(pin, "damping", "friction_force")
    rate, k = pin.damping / pin.mass, pin.natural_frequency
    coupling = pin.damping * k**2 / pin.friction_force
    return np.array(
        [
            [0.0, 1.0, 0.0],
            [0.0, -rate * speed_ratio(pin), 2.0 * pin.friction_force / pin.damping],
            [-coupling * rate, -2.0 * coupling, -rate],
        ]
    )


def characteristic_coefficients(pin: PinOnDisc) -> tuple[float, float, float, float]:
    """Return the coefficients of λ³, λ², λ and 1 of the characteristic equation of (12): (13) corrected.

    Their units are 1, 1/s, 1/s² and 1/s³.
    """
    rate, k, ratio = pin.damping / pin.mass, pin.natural_frequency, speed_ratio(pin)
    return 1.0, rate * (1.0 + ratio), rate**2 * ratio + 4.0 * k**2, 2.0 * k**2 * rate


def characteristic_coefficients_as_printed(pin: PinOnDisc) -> tuple[float, float, float, float]:
    """Return the wrong coefficients of (13), as printed, for comparison.

    The coefficient of λ² is printed as 1 + (β/m)·ω/(ω − k), which adds a number to a rate; the determinant of (12)
    gives (β/m)·(1 + ω/(ω − k)).
    """
    _, _, linear, constant = characteristic_coefficients(pin)
    return 1.0, 1.0 + pin.damping / pin.mass * speed_ratio(pin), linear, constant


def coefficient_margins(pin: PinOnDisc) -> tuple[float, float]:
    """Return left side minus right side of the conditions (14): both > 0 if the coefficients of (13) are."""
    ratio = speed_ratio(pin)
    return ratio + 1.0, ratio + _stiffness_to_damping(pin)


def lower_branch_margin(pin: PinOnDisc) -> float:
    """Return right side minus left side of (15): > 0 if it holds, which excludes (14)."""
    q = _stiffness_to_damping(pin)
    return -0.5 * (1.0 + q + math.hypot(1.0, q)) - speed_ratio(pin)


def upper_branch_margin(pin: PinOnDisc) -> float:
    """Return left side minus right side of (16): > 0 exactly if all roots of (13) have negative real parts."""
    q = _stiffness_to_damping(pin)
    # q − √(1 + q²) without cancellation for weak damping
    return speed_ratio(pin) + 0.5 * (1.0 - 1.0 / (q + math.hypot(1.0, q)))


def _stiffness_to_damping(pin: PinOnDisc) -> float:
    require_positive(pin, "damping")
    ratio = 2.0 * pin.natural_frequency * pin.mass / pin.damping
    return ratio * ratio


class WhirlResponse(NamedTuple):
    """First-order response of the whirl to an offset, with z = x + iy and frequency κ = ±k.

    z(t) = ρ_c·exp(iκt) + ``mean`` + ``second_harmonic``·exp(2iκt), all in m; the first harmonic is real at t = 0.
    """

    mean: complex
    second_harmonic: complex


def whirl_shift(pin: PinOnDisc) -> tuple[float, float]:
    """Return x_s and y_s of (18) in m, the paper's approximation of the time mean of the whirl with an offset.

    It omits the second harmonic, which changes the mean to the same order in X0, see :func:`first_order_whirl_shift`.
    """
    require_whirl(pin)
    half = _relative_damping(pin) * speed_ratio(pin) / 2.0
    x = pin.offset / (1.0 + half**2)
    return x, turning_direction(pin) * half * x


def first_order_whirl_response(pin: PinOnDisc) -> WhirlResponse:
    """Return the exact first-order response of the whirl to the offset; the mean's error is of order X0³.

    (10) linearised about (11), with ρ = ρ_c + Re(Ξ·exp(ikt)) and ψ = kt + Re(U·exp(ikt))/ρ_c, is::

        (−k² + ik(β/m)ω/(ω−k))·Ξ −          2ik²·U =  k²X0
                (2ik² + kβ/m)·Ξ + (−k² + ikβ/m)·U = ik²X0

    In x + iy = ρ·exp(iψ) they give the mean (conj Ξ + i·conj U)/2 and, at 2k, (Ξ + iU)/2. With d = β/(mk) and w =
    ω/(ω − k)::

        mean            = X0·conj((6 − id(w + 2))/(2(3 + d²w + id(w − 1))))
        second harmonic = X0·idw/(2(3 + d²w + id(w − 1)))
    """
    require_whirl(pin)
    d, w = _relative_damping(pin), speed_ratio(pin)
    denominator = 2.0 * complex(3.0 + d**2 * w, d * (w - 1.0))
    response = WhirlResponse(
        mean=(pin.offset * complex(6.0, -d * (w + 2.0)) / denominator).conjugate(),
        second_harmonic=pin.offset * complex(0.0, d * w) / denominator,
    )
    return WhirlResponse(*(_mirrored(pin, amplitude) for amplitude in response))


def first_order_whirl_shift(pin: PinOnDisc) -> tuple[float, float]:
    """Return the time mean of x and y in m of the whirl with a small offset, exact to first order in X0."""
    mean = first_order_whirl_response(pin).mean
    return mean.real, mean.imag


def whirl_shift_error_limit(pin: PinOnDisc) -> complex:
    """Return the limit of the relative error of (18), z = x + iy by (18) / exact z − 1, for X0 → 0.

    It is the complex conjugate of d²w(2 − w)/((2 + idw)(6 − id(w + 2))), d and w of
    :func:`first_order_whirl_response`: zero at |ω| = 2k, and −1 as |ω| → k.
    """
    require_whirl(pin)
    d, w = _relative_damping(pin), speed_ratio(pin)
    error = d**2 * w * (2.0 - w) / (complex(2.0, d * w) * complex(6.0, -d * (w + 2.0)))
    return _mirrored(pin, error.conjugate())


def third_order_of_whirl_shift(pin: PinOnDisc) -> float:
    """Return the imaginary part of the whirl's mean at third order in X0 over first order, to leading order in d.

    Let d = β/(mk) and τ = kt. In units of ρ_c, (1) without damping has the motions X0 + ρ·exp(iτ) + σ·exp(−iτ).
    Damping and friction, both of order d, select ρ and σ, and add −d times the mean direction of slip to the mean.
    The slip has the direction of −i·exp(iτ)·(1 + u), u = a·exp(−iτ) + b·exp(−2iτ), with w = ω/(ω − k), a = wX0/ρ and
    b = (2w − 1)σ/ρ. Its harmonics to third order give::

        exp(iτ)   1 − a²/4           = ρ
        exp(−iτ)  b/2 − a²/8         = −σ
        mean      a/2 + a³/16 − ab/4

    So σ = a²/(4(2w + 1)). Relative to the first order X0·(1 + ½idw) the third order of the mean is::

        i·d·w(w + 1)/(4(2w + 1))·(wX0/ρ_c)²
    """
    require_whirl(pin)
    d, w = _relative_damping(pin), speed_ratio(pin)
    turn = w * pin.offset / whirl_radius(pin)
    return turning_direction(pin) * d * w * (w + 1.0) / (4.0 * (2.0 * w + 1.0)) * turn**2


def _mirrored(pin: PinOnDisc, amplitude: complex) -> complex:
    return amplitude.conjugate() if pin.disc_speed < 0.0 else amplitude


def _relative_damping(pin: PinOnDisc) -> float:
    return pin.damping / (pin.mass * pin.natural_frequency)
