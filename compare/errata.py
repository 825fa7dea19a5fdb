"""Where the printed formulas of the paper are wrong or incomplete, with the numbers that show it."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from compare.paper import CENTRED
from reference_model import whirl_orbit
from reference_model.pin_formulas import (
    characteristic_coefficients,
    characteristic_coefficients_as_printed,
    first_order_whirl_shift,
    variational_matrix,
    whirl_shift,
)


@dataclass(frozen=True)
class Evidence:
    """One quantity, found independently of both formulas and from each of them.

    Parameters
    ----------
    quantity : str
        What is compared, with its unit and the parameters.
    exact : float
        From the equations of motion themselves.
    printed_value, corrected_value : float
        From the printed and from the corrected formula.

    """

    quantity: str
    exact: float
    printed_value: float
    corrected_value: float


@dataclass(frozen=True)
class Erratum:
    """A printed formula beside its correction.

    Parameters
    ----------
    equation : str
        Number and place: "(13), coefficient of λ²".
    printed, correct : str
        Both formulas as plain text.
    explanation : str
        Why the printed one is wrong and how the corrected one follows.
    evidence : callable
        Computes the numbers.

    """

    equation: str
    printed: str
    correct: str
    explanation: str
    evidence: Callable[[], Evidence]


def _characteristic_coefficient() -> Evidence:
    matrix_coefficients = np.poly(variational_matrix(CENTRED))
    return Evidence(
        "coefficient of λ² of det(λI − A), A the matrix of (12), in 1/s, at Fig. 4's parameters with ω = 1.5",
        exact=float(matrix_coefficients[1]),
        printed_value=float(characteristic_coefficients_as_printed(CENTRED)[1]),
        corrected_value=float(characteristic_coefficients(CENTRED)[1]),
    )


def _force_on_the_circle() -> Evidence:
    """Return the tangential force of eq. 1 on a pin that moves on the circle of eq. 11 at ω < k."""
    pin = replace(CENTRED, disc_speed=0.8)
    k = pin.natural_frequency
    radius = pin.friction_force / (pin.damping * k)
    z, w = complex(radius, 0.0), 1j * (k - pin.disc_speed) * radius
    friction = -pin.friction_force * w / abs(w)
    force = -pin.damping * 1j * k * z - pin.stiffness * z + friction
    # Uniform motion on a circle takes no tangential force; the printed statement says that none is left.
    corrected = pin.friction_force * math.copysign(1.0, pin.disc_speed - k) - pin.damping * k * radius
    return Evidence(
        "tangential force in N on a pin on the circle (11) at Fig. 4's parameters with ω = 0.8 < k",
        exact=force.imag,
        printed_value=0.0,
        corrected_value=corrected,
    )


def _shift_of_the_whirl() -> Evidence:
    pin = replace(CENTRED, disc_speed=1.2, offset=1e-3)
    return Evidence(
        "x_s/X0 of the whirl for X0 = 1 mm, at Fig. 4's parameters with ω = 1.2; exact: the periodic orbit",
        exact=float(whirl_orbit(pin).mean[0]) / pin.offset,
        printed_value=whirl_shift(pin)[0] / pin.offset,
        corrected_value=first_order_whirl_shift(pin)[0] / pin.offset,
    )


ERRATA: tuple[Erratum, ...] = (
    Erratum(
        '(11), "always exists"',
        printed="ψ̇ = k, ρ = μN/(βk) for every ω",
        correct="only for ω > k",
        explanation="The tangential balance of (10) is βρk = μN·sign(ω − k). Below k friction brakes the pin "
        "as the damping does, and there is nothing that drives it round.",
        evidence=_force_on_the_circle,
    ),
    Erratum(
        "(13), coefficient of λ²",
        printed="1 + (β/m)·ω/(ω − k)",
        correct="(β/m)·(1 + ω/(ω − k))",
        explanation="It is the negative trace of the matrix of (12). The printed form adds a number without "
        "unit to a rate. Only the corrected form leads to (14)–(16), which are right as printed.",
        evidence=_characteristic_coefficient,
    ),
    Erratum(
        "(18), what is left out",
        printed="x_s = X0/(1 + β²ω²/(4mC(ω−k)²)), y_s = βωx_s/(2mk(ω−k))",
        correct="x_s + iy_s = X0·conj[(6 − id(w+2)) / (6 + 2d²w + 2id(w−1))], d = β/(mk), w = ω/(ω−k)",
        explanation="The offset excites a second harmonic of the same first order in X0, coupled to the mean "
        "through friction; (18) keeps the first harmonic only. The correction solves (12) with the offset "
        "as its forcing. The relative error of (18) does not vanish as X0 → 0: nothing at ω = 2k, all of the "
        "shift as ω → k.",
        evidence=_shift_of_the_whirl,
    ),
)
"""In the order of the equations."""
