"""The first Lyapunov coefficient of a whirl at its Hopf boundary: soft or hard onset of modulation.

Near a Hopf boundary the motion is ż = λz + c·z|z|² in a complex amplitude z. If Re c < 0 a small stable cycle, of
amplitude √(−Re λ/Re c), grows out of the whirl beyond the boundary. If Re c > 0 an unstable cycle shrinks onto the
whirl before the boundary, and beyond it the motion jumps to another attractor (Kuznetsov 2004, Elements of applied
bifurcation theory, sections 3.5 and 5.4).
"""

import math
from collections.abc import Callable

import numpy as np
from numpy.typing import ArrayLike

from reference_model.contact.contact_law import IsotropicContact, isotropic_contact_of
from reference_model.support import Support, require_linear_support
from reference_model.systems import ComplexArray, DiscOnDisc, FloatArray, checked_state

STEP = 8e-3
"""Step of the differences, in units of the distance to infinite derivatives of friction.

Errors of the third difference are far below 1 %.
"""

SIZE = 4
"""Number of components of the state (r, ṙ, rψ̇, ω − φ̇)."""

Rates = Callable[[FloatArray], FloatArray]


def growth_by_amplitude(disc: DiscOnDisc, state: ArrayLike, contact: IsotropicContact | None = None) -> float:
    """Return Re c in 1/s of a whirl without offset and with a pair of eigenvalues on the imaginary axis.

    a is the amplitude of the radius, r = ρ·(1 + a·cos νt), with ȧ = Re λ·a + Re c·a³. ``state``, shape (6,),
    lies on the whirl, with the centre on the x axis.

    Raises ``ValueError`` if the eigenvalues nearest to the imaginary axis are real, or the disc rests on single
    points or a nonlinear support.
    """
    require_linear_support(disc)
    law = isotropic_contact_of(disc, contact, "the modulation")
    radius, _, _, _, speed, spin = checked_state(disc, state, "state").tolist()
    whirl = np.array([radius, 0.0, speed, disc.disc_speed - spin])
    slip, rim = abs(speed - disc.disc_speed * radius), disc.contact_radius * abs(whirl[3])
    # Fraction of the distance to where a point of the ring comes to rest, or the centre reaches the axis.
    scales = np.array([radius, radius, radius, abs(whirl[3])]) * min(abs(slip / rim - 1.0), 0.3)
    rates = polar_rates(disc, law)

    def scaled(deviation: FloatArray) -> FloatArray:
        return np.asarray(rates(whirl + scales * deviation) / scales)

    return _real_cubic_coefficient(scaled) * float(radius / scales[0]) ** 2


def polar_rates(disc: DiscOnDisc, law: IsotropicContact) -> Rates:
    """Return the function from (r, ṙ, rψ̇, ω − φ̇) to its derivative: (19) without offset."""
    support = Support.of(disc)

    def rates(state: FloatArray) -> FloatArray:
        r, outward, around, relative_spin = state.tolist()
        across = around - disc.disc_speed * r
        slip = math.hypot(outward, across)
        resistance, moment = law.shares(slip, relative_spin)
        friction = disc.friction_force * resistance / slip
        torque = disc.shaft_damping * (disc.disc_speed - relative_spin - disc.shaft_speed)
        return np.array(
            [
                outward,
                around**2 / r - ((disc.damping + friction) * outward + support.pull(r)) / disc.mass,
                -outward * around / r - (disc.damping * around + friction * across) / disc.mass,
                (torque - disc.friction_force * moment) / disc.polar_inertia,
            ]
        )

    return rates


def _real_cubic_coefficient(rates: Rates) -> float:
    """Return Re c at the origin for z whose real part is the first component: half of (5.62) in Kuznetsov."""
    origin = np.zeros(SIZE)
    at_origin = rates(origin)
    step = 1e-2 * STEP

    def second(u: FloatArray) -> FloatArray:
        return (rates(STEP * u) - 2.0 * at_origin + rates(-STEP * u)) / STEP**2

    def third(u: FloatArray) -> FloatArray:
        odd = rates(2.0 * STEP * u) - rates(-2.0 * STEP * u) - 2.0 * (rates(STEP * u) - rates(-STEP * u))
        return odd / (2.0 * STEP**3)

    def mixed(x: FloatArray, y: FloatArray) -> FloatArray:
        return (second(x + y) - second(x - y)) / 4.0

    def bilinear(u: ComplexArray, v: ComplexArray) -> ComplexArray:
        real = mixed(u.real, v.real) - mixed(u.imag, v.imag)
        return real + 1j * (mixed(u.real, v.imag) + mixed(u.imag, v.real))

    matrix = np.column_stack([(rates(step * e) - rates(-step * e)) / (2.0 * step) for e in np.eye(SIZE)])
    values, vectors = np.linalg.eig(matrix)
    which = int(np.argmin(np.abs(values.real)))
    if values[which].imag == 0.0:
        raise ValueError(
            f"eigenvalue {values[which].real:g} 1/s: the eigenvalue nearest to the imaginary axis must be "
            "one of a complex pair"
        )
    q: ComplexArray = np.asarray(vectors[:, which] / (2.0 * vectors[0, which]), dtype=np.complex128)
    p = np.linalg.inv(vectors)[which] * (2.0 * vectors[0, which])
    a, b = q.real, q.imag
    sum_ab, difference_ab, aaa, bbb = third(a + b), third(a - b), third(a), third(b)
    aab = (sum_ab - difference_ab - 2.0 * bbb) / 6.0
    abb = (sum_ab + difference_ab - 2.0 * aaa) / 6.0
    mean: ComplexArray = np.asarray(np.linalg.solve(matrix, bilinear(q, q.conj())), dtype=np.complex128)
    shifted = 2j * values[which].imag * np.eye(SIZE) - matrix
    double: ComplexArray = np.asarray(np.linalg.solve(shifted, bilinear(q, q)), dtype=np.complex128)
    cubic = aaa + abb + 1j * (aab + bbb) - 2.0 * bilinear(q, mean) + bilinear(q.conj(), double)
    return float((p @ cubic).real / 2.0)
