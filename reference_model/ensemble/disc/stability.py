"""Stability of a steady motion of a disc and its distance, without eigenvalues.

With the derivative A of the rates f at a fixed point, (1 − A)⁻¹(1 + A) maps the half plane of decaying eigenvalues to
the inside of the unit circle, so its powers vanish exactly if all eigenvalues decay. Newton's correction A⁻¹f is
the distance.
"""

import numpy as np

from reference_model.core.forces.law import Law
from reference_model.core.forces.rates import growth
from reference_model.ensemble.core.contact_shares import LEAST
from reference_model.ensemble.core.jit import scalar
from reference_model.ensemble.core.stepping.linear import length_of, powers_vanish, solve, zeros
from reference_model.systems import FloatArray

APART = 1e-5
"""Scaled differences for the derivative of the rates."""

DIMENSION = 5


@scalar
def attracts(z: complex, v: complex, r: float, law: Law, circle: bool, near: float) -> bool:
    """Return whether an equilibrium or a circle attracts and lies within ``near`` of z, v and r.

    For a disc on points we know this only without friction.
    """
    if len(law.around) > 0:
        return law.friction == 0.0 and law.damping > 0.0 and law.stiffness > 0.0
    if circle:
        radius = max(abs(z), LEAST)
        along = (1.0 / radius) * v * z.conjugate()
        y = np.array((radius, along.real, along.imag, r, 0.0))
    else:
        y = np.array((z.real, z.imag, v.real, v.imag, r))
    slopes, power, matrix = _square(), _square(), _square()
    column = zeros(DIMENSION)
    for j in range(DIMENSION):
        y[j] += APART
        more = _rates(y, law, circle)
        y[j] -= 2.0 * APART
        less = _rates(y, law, circle)
        y[j] += APART
        for i in range(DIMENSION):
            slopes[i, j] = (more[i] - less[i]) / (2.0 * APART)
    rates = _rates(y, law, circle)
    for i in range(DIMENSION):
        column[i] = rates[i]
        for j in range(DIMENSION):
            matrix[i, j] = slopes[i, j]
    if not solve(matrix, column) or length_of(column) > near:
        return False
    for j in range(DIMENSION):
        for i in range(DIMENSION):
            column[i] = slopes[i, j]
            for k in range(DIMENSION):
                matrix[i, k] = -slopes[i, k]
            matrix[i, i] += 1.0
        column[j] += 1.0
        if not solve(matrix, column):
            return False
        for i in range(DIMENSION):
            power[i, j] = column[i]
    return powers_vanish(power)


@scalar
def _square() -> FloatArray:
    return zeros(DIMENSION * DIMENSION).reshape(DIMENSION, DIMENSION)


@scalar
def _rates(y: FloatArray, law: Law, circle: bool) -> tuple[float, float, float, float, float]:
    """Return the rates of x, y, vx, vy, r; for a circle, of ρ, v along and across the radius, r, and 0."""
    if circle:
        z, v, r = complex(y[0]), complex(y[1], y[2]), y[3]
    else:
        z, v, r = complex(y[0], y[1]), complex(y[2], y[3]), y[4]
    u = v - 1j * law.omega * z
    ax, ay, spin_up, _, _, _ = growth(z.real, z.imag, u.real, u.imag, r, 0.0, law)
    a = complex(ax, ay) + 1j * law.omega * v
    if circle:
        return y[1], a.real + y[2] * y[2] / y[0], a.imag - y[1] * y[2] / y[0], spin_up, -y[4]
    return v.real, v.imag, a.real, a.imag, spin_up
