"""Section 3 of the paper: the whirl with a small offset, (18), and the exact first and third orders in X0."""

from __future__ import annotations

from typing import NamedTuple

from reference_model.formulas.pin.conditions import speed_ratio, turning_direction
from reference_model.formulas.pin.whirl import require_whirl, whirl_radius
from reference_model.systems import PinOnDisc


class WhirlResponse(NamedTuple):
    """First-order response of the whirl to an offset, with z = x + iy and frequency κ = ±k.

    z(t) = ρ_c·exp(iκt) + ``mean`` + ``second_harmonic``·exp(2iκt), all in m; the first harmonic is real at t = 0.
    """

    mean: complex
    second_harmonic: complex


def whirl_shift(pin: PinOnDisc) -> tuple[float, float]:
    """Return x_s and y_s of (18) in m, the paper's approximation of the time mean of the whirl with an offset.

    It balances only the first harmonic. The second harmonic that the offset excites is of the same order in X0 and
    changes the mean, see :func:`first_order_whirl_shift`.

    Raises ``ValueError`` as :func:`whirl_radius`.
    """
    require_whirl(pin)
    half = _relative_damping(pin) * speed_ratio(pin) / 2.0  # βω/(2mk(ω − k))
    x = pin.offset / (1.0 + half**2)
    return x, turning_direction(pin) * half * x


def first_order_whirl_response(pin: PinOnDisc) -> WhirlResponse:
    """Return the exact first-order response of the whirl to the offset; the mean's error is of order X0³.

    (10) linearised about (11), with ρ = ρ_c + Re(Ξ·exp(ikt)) and ψ = kt + Re(U·exp(ikt))/ρ_c, is::

        (−k² + ik(β/m)ω/(ω−k))·Ξ −          2ik²·U =  k²X0
                (2ik² + kβ/m)·Ξ + (−k² + ikβ/m)·U = ik²X0

    In x + iy = ρ·exp(iψ) these amplitudes give the mean (conj Ξ + i·conj U)/2 and, at 2k, (Ξ + iU)/2. Solved for
    these two, with d = β/(mk) and w = ω/(ω − k)::

        mean            = X0·conj((6 − id(w + 2))/(2(3 + d²w + id(w − 1))))
        second harmonic = X0·idw/(2(3 + d²w + id(w − 1)))

    Raises ``ValueError`` as :func:`whirl_radius`.
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
    """Return the time mean of x and y in m of the whirl with a small offset, exact to first order in X0.

    Raises ``ValueError`` as :func:`whirl_radius`.
    """
    mean = first_order_whirl_response(pin).mean
    return mean.real, mean.imag


def whirl_shift_error_limit(pin: PinOnDisc) -> complex:
    """Return the limit of the relative error of (18) for X0 → 0: z of (18) over the exact z, minus 1, z = x + iy.

    With d and w of :func:`first_order_whirl_response` it is the complex conjugate of d²w(2 − w)/((2 + idw)(6 − id(w +
    2))): zero at |ω| = 2k, and −1 as |ω| → k. It does not depend on the offset, which may be zero.

    Raises ``ValueError`` as :func:`whirl_radius`.
    """
    require_whirl(pin)
    d, w = _relative_damping(pin), speed_ratio(pin)
    error = d**2 * w * (2.0 - w) / (complex(2.0, d * w) * complex(6.0, -d * (w + 2.0)))
    return _mirrored(pin, error.conjugate())


def third_order_of_whirl_shift(pin: PinOnDisc) -> float:
    """Return the imaginary part of the whirl's mean at third order in X0 over first order, to leading order in d.

    With d = β/(mk), lengths in units of ρ_c and τ = kt, (1) without damping has the motions X0 + ρ·exp(iτ) +
    σ·exp(−iτ). Damping and friction, both of order d, select ρ and σ, and add −d times the mean direction of slip to
    the mean. Slip has the direction of −i·exp(iτ)·(1 + u), u = a·exp(−iτ) + b·exp(−2iτ), with w = ω/(ω − k), a =
    wX0/ρ and b = (2w − 1)σ/ρ. Its harmonics to third order give::

        exp(iτ)   1 − a²/4           = ρ
        exp(−iτ)  b/2 − a²/8         = −σ
        mean      a/2 + a³/16 − ab/4

    So σ = a²/(4(2w + 1)). The mean is X0·(1 + ½idw) to first order, and the third order relative to it is::

        i·d·w(w + 1)/(4(2w + 1))·(wX0/ρ_c)²

    Raises ``ValueError`` as :func:`whirl_radius`.
    """
    require_whirl(pin)
    d, w = _relative_damping(pin), speed_ratio(pin)
    turn = w * pin.offset / whirl_radius(pin)
    return turning_direction(pin) * d * w * (w + 1.0) / (4.0 * (2.0 * w + 1.0)) * turn**2


def _mirrored(pin: PinOnDisc, amplitude: complex) -> complex:
    """Return an amplitude of x + iy for ω, given its value for |ω|."""
    return amplitude.conjugate() if pin.disc_speed < 0.0 else amplitude


def _relative_damping(pin: PinOnDisc) -> float:
    return pin.damping / (pin.mass * pin.natural_frequency)
