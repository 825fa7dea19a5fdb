"""Section 3 of the paper: the whirl with a small offset, (18), and what is exact in its order of X0."""

from __future__ import annotations

from typing import NamedTuple

from reference_model.formulas.pin.conditions import speed_ratio, turning_direction
from reference_model.formulas.pin.whirl import require_whirl, whirl_radius
from reference_model.systems import PinOnDisc


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
    require_whirl(pin)
    half = _relative_damping(pin) * speed_ratio(pin) / 2.0  # βω/(2mk(ω − k))
    x = pin.offset / (1.0 + half**2)
    return x, turning_direction(pin) * half * x


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
    require_whirl(pin)
    d, w = _relative_damping(pin), speed_ratio(pin)
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
    require_whirl(pin)
    d, w = _relative_damping(pin), speed_ratio(pin)
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
    require_whirl(pin)
    d, w = _relative_damping(pin), speed_ratio(pin)
    turn = w * pin.offset / whirl_radius(pin)
    return turning_direction(pin) * d * w * (w + 1.0) / (4.0 * (2.0 * w + 1.0)) * turn**2


def _mirrored(pin: PinOnDisc, amplitude: complex) -> complex:
    """Return an amplitude of x + iy, found for |ω|, as it is for ω."""
    return amplitude.conjugate() if pin.disc_speed < 0.0 else amplitude


def _relative_damping(pin: PinOnDisc) -> float:
    """β/(mk)."""
    return pin.damping / (pin.mass * pin.natural_frequency)
