"""Errors in the formulas of the paper, with numerical evidence.

"Printed" refers to the text we worked from, see ``TEXT``.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from compare.claims.linearised_flow import measured_eigenvalues
from compare.claims.parameters import CENTRED, FIG8, FIG9
from compare.engines import reference
from reference_model import whirl_orbit
from reference_model.contact.contact_law import ThreeTermRing
from reference_model.formulas.disc import (
    inverse_slip_speed,
    inverse_slip_speed_as_printed,
    pin_of,
    positions_by_26,
)
from reference_model.formulas.pin import (
    characteristic_coefficients,
    characteristic_coefficients_as_printed,
    first_order_whirl_shift,
    variational_matrix,
    whirl_shift,
)
from reference_model.steady.stability import equilibrium_eigenvalues
from reference_model.steady.steady_states import self_centred_equilibria

TEXT = (
    "The formulas are those of the text we worked from, which names no journal or year. It was probably published as "
    "A. Fidlin and W. Stamm, On the radial dynamics of friction disks, European Journal of Mechanics – A/Solids 28 "
    "(2009), pp. 526–534. Printed versions may differ."
)
"""Origin of the formulas."""


@dataclass(frozen=True)
class Evidence:
    """One quantity from both formulas and, as ``exact``, from the equations of motion."""

    quantity: str
    exact: float
    printed_value: float
    corrected_value: float


@dataclass(frozen=True)
class Erratum:
    """A printed formula and its correction.

    ``equation`` is a number and a term, such as "(13), coefficient of λ²", or a section and its words.
    ``explanation`` says why the printed formula is wrong and derives the other; ``evidence`` computes numbers.
    """

    equation: str
    printed: str
    correct: str
    explanation: str
    evidence: Callable[[], Evidence]

    @property
    def heading(self) -> str:
        """Heading of the erratum."""
        return f"Equation {self.equation}" if self.equation.startswith("(") else self.equation


def _characteristic_coefficient() -> Evidence:
    matrix_coefficients = np.poly(variational_matrix(CENTRED))
    return Evidence(
        "coefficient of λ² of det(λI − A), A the matrix of (12), in 1/s, at Fig. 4's parameters with ω = 1.5 rad/s",
        exact=float(matrix_coefficients[1]),
        printed_value=float(characteristic_coefficients_as_printed(CENTRED)[1]),
        corrected_value=float(characteristic_coefficients(CENTRED)[1]),
    )


def _force_on_the_circle() -> Evidence:
    """Return the tangential force of eq. 1 on a pin on the circle of eq. 11 at ω < k."""
    pin = replace(CENTRED, disc_speed=0.8)
    k = pin.natural_frequency
    radius = pin.friction_force / (pin.damping * k)
    z, w = complex(radius, 0.0), 1j * (k - pin.disc_speed) * radius
    friction = -pin.friction_force * w / abs(w)
    force = -pin.damping * 1j * k * z - pin.stiffness * z + friction
    # Uniform circular motion requires zero tangential force, as the printed statement implies.
    corrected = pin.friction_force * math.copysign(1.0, pin.disc_speed - k) - pin.damping * k * radius
    return Evidence(
        "tangential force in N on a pin on the circle (11) at Fig. 4's parameters with ω = 0.8 rad/s < k",
        exact=force.imag,
        printed_value=0.0,
        corrected_value=corrected,
    )


def _shift_of_the_whirl() -> Evidence:
    pin = replace(CENTRED, disc_speed=1.2, offset=1e-3)
    return Evidence(
        "x_s/X0 of the whirl for X0 = 1 mm, at Fig. 4's parameters with ω = 1.2 rad/s; exact: the periodic orbit",
        exact=float(whirl_orbit(pin).mean[0]) / pin.offset,
        printed_value=whirl_shift(pin)[0] / pin.offset,
        corrected_value=first_order_whirl_shift(pin)[0] / pin.offset,
    )


def _moment_of_the_expansion() -> Evidence:
    """Return the moment on a ring at equal slip speeds of centre and rim."""
    slip, rim_speed = 1j, 1.0
    mean_speed = math.hypot(abs(slip), rim_speed)
    places = 2.0 * math.pi * np.arange(16) / 16  # averages are exact: cubic at most in sine and cosine
    along_rim = [slip.real * math.sin(place) - slip.imag * math.cos(place) + rim_speed for place in places]
    corrected = [inverse_slip_speed(slip, rim_speed, place) for place in places]
    # The first line is ν̃_r/|ν_r| as printed, and ν̄_r/|ν_r| as corrected.
    return Evidence(
        "moment over μN·R where U = R(ω − φ̇), from the average of the first line over the ring; exact: (23)",
        exact=ThreeTermRing(radius=1.0).shares(abs(slip), rim_speed).moment,
        printed_value=float(
            np.mean([inverse_slip_speed_as_printed(slip, rim_speed, place) for place in places])
        ),
        corrected_value=float(np.mean(np.multiply(along_rim, corrected))) / mean_speed,
    )


def _spin_of_the_self_centred_disc() -> Evidence:
    (equilibrium,) = self_centred_equilibria(FIG8, ThreeTermRing(FIG8.contact_radius))
    (printed,) = positions_by_26(FIG8, as_printed=True)
    (corrected,) = positions_by_26(FIG8)
    return Evidence(
        f"spin in rad/s of Fig. 8's disc at μN = {FIG8.friction_force:g} N, X0 = {FIG8.offset:g} m; exact: the "
        "steady state of (19) with (23)",
        exact=equilibrium.spin,
        printed_value=printed.spin,
        corrected_value=corrected.spin,
    )


def _growth_beside_the_equilibrium() -> Evidence:
    """Return the growth rate of the slowest deviation from the self-centred equilibrium."""
    (equilibrium,) = self_centred_equilibria(FIG9)
    simulated, _ = measured_eigenvalues(reference, FIG9, equilibrium.state, duration=1.0)
    return Evidence(
        f"growth rate in 1/s of the slowest deviation from the self-centred equilibrium of Fig. 9's disc at μN = "
        f"{FIG9.friction_force:g} N, X0 = {FIG9.offset:g} m; exact: from simulated deviations; printed: for a pin",
        exact=float(np.max(simulated.real)),
        printed_value=equilibrium_eigenvalues(pin_of(FIG9))[0].real,
        corrected_value=equilibrium.eigenvalues[0].real,
    )


ERRATA: tuple[Erratum, ...] = (
    Erratum(
        '(11), "always exists"',
        printed="ψ̇ = k, ρ = μN/(βk) for every ω",
        correct="only for ω > k",
        explanation="The tangential balance of (10) is βρk = μN·sign(ω − k). Below k, friction brakes the pin as "
        "the damping does, so nothing drives the whirl.",
        evidence=_force_on_the_circle,
    ),
    Erratum(
        "(13), coefficient of λ²",
        printed="1 + (β/m)·ω/(ω − k)",
        correct="(β/m)·(1 + ω/(ω − k))",
        explanation="The coefficient is the negative trace of the matrix of (12). The printed form adds a "
        "dimensionless number to a rate. Only the corrected form leads to (14)–(16), which are correct as "
        "printed.",
        evidence=_characteristic_coefficient,
    ),
    Erratum(
        "(18), neglected harmonic",
        printed="x_s = X0/(1 + β²ω²/(4mC(ω−k)²)), y_s = βωx_s/(2mk(ω−k))",
        correct="x_s + iy_s = X0·conj[(6 − id(w+2)) / (6 + 2d²w + 2id(w−1))], d = β/(mk), w = ω/(ω−k)",
        explanation="The offset also excites a second harmonic. It is of first order in X0 too, and friction couples "
        "it to the mean. (18) keeps the first harmonic only. The correction solves (12) with the offset as "
        "forcing. The relative error of (18) does not vanish as X0 → 0. It is zero at ω = 2k and tends to 1 as ω "
        "→ k.",
        evidence=_shift_of_the_whirl,
    ),
    Erratum(
        "(22), first line",
        printed="ν̃_r/|ν_r| = 1 − R(ω − φ̇)ν̃_xy/ν̄_r²",
        correct="ν̄_r/|ν_r| = 1 − R(ω − φ̇)ν̃_xy/ν̄_r² + (3/2)R²(ω − φ̇)²ν̃_xy²/ν̄_r⁴",
        explanation="Because |ν_r|² = ν̄_r²(1 + 2ε) with ε = R(ω − φ̇)ν̃_xy/ν̄_r², the right side is an "
        "expansion of ν̄_r/|ν_r|. Here ν̄_r is the root mean square of |ν_r| over the ring. (23) averages the slip "
        "velocity times three terms of this expansion. The printed line omits the third term, which gives the terms "
        "with ¾ in (23). Without it the moment would not depend on the slip of the centre at all.",
        evidence=_moment_of_the_expansion,
    ),
    Erratum(
        "(26), bracket in A",
        printed="1 − ½cos²α + (3/16)sin²α",
        correct="1 − ½sin²α + (3/16)sin²2α",
        explanation="Inserting (24) into (23) gives F = μN·cos α·(1 − ½sin²α + ¾cos²α·sin²α), and the springs "
        "balance it: C²A²cos²α + F² = C²X0². The δ and θ lines of (26) are correct as printed.",
        evidence=_spin_of_the_self_centred_disc,
    ),
    Erratum(
        'Section 5, "still remains stable"',
        printed="the self-centred equilibrium of the disc is stable at high speeds too",
        correct="for ω > k only up to a load: 0.0210 N at Fig. 9's parameters with X0 = 0.1 m",
        explanation="Friction along the slip grows with the slip speed of the ring's centre, at the rate "
        "μN·∂F/∂U > 0. For a pin this rate is zero. It couples the radial motion back to the tangential motion. "
        "Above the natural frequency it drives a circular motion, just as it destabilises the rotation on "
        "the axis.",
        evidence=_growth_beside_the_equilibrium,
    ),
)
