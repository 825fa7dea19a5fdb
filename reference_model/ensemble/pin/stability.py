"""Stability of a closed orbit of a slipping pin, by the derivative of its return map.

Small deviations (δz, δv) of a motion satisfy::

    δz' = δv,    δv' = −k²·δz − c·δv − (g/s)·i·n·Im(n̄·δw),    δw = δv − iω·δz

where w = s·n is the slip velocity. The classical Runge-Kutta method follows three deviations on the section where x
is largest for one turn.
"""

from __future__ import annotations

from reference_model.contact.limit_surface import ComplexArray
from reference_model.ensemble.core.jit import scalar, written_out
from reference_model.ensemble.core.laws import PinLaw
from reference_model.ensemble.core.stepping.dense_output import size_of
from reference_model.ensemble.core.stepping.linear import (
    complex_zeros,
    length_of,
    powers_vanish,
    solve,
    zeros,
)
from reference_model.systems import FloatArray

STRIDE, STABLE = 0.5, 1.5
"""Step sizes, in units of time or of the time scale of the slip velocity, and in units of 1/(c + g/s).

Deviations decay at the rate c + g/s; the method is stable up to 2.8 units of 1/(c + g/s).
"""

MOST_STRIDES = 20_000
"""Largest number of steps in a turn; more are needed only if slip almost ends."""

COEFFICIENTS = ((0.5, 1.0 / 6.0), (0.5, 1.0 / 3.0), (1.0, 1.0 / 3.0), (0.0, 1.0 / 6.0))
"""How far the rates of each stage carry the next one, and their weight in the step."""


@written_out
def orbit_attracts(
    z: complex, v: complex, period: float, law: PinLaw, came: tuple[float, float, float], near: float
) -> bool:
    """Return whether an orbit attracts and is near, given position z and velocity v of a pin where x is largest.

    ``came`` is the change of x, y and ẏ since the previous crossing. With the derivative M of the return map the
    orbit is (1 − M)⁻¹ times ``came`` away from the previous crossing, and must be within ``near`` of this one.
    """
    derivative, matrix, left = zeros(9).reshape(3, 3), zeros(9).reshape(3, 3), zeros(3)
    if not return_derivative(z, v, period, law, derivative) or not powers_vanish(derivative):
        return False
    for i in range(3):
        left[i] = came[i]
        for j in range(3):
            matrix[i, j] = (1.0 if i == j else 0.0) - derivative[i, j]
    solvable = solve(matrix, left)
    for i in range(3):
        left[i] -= came[i]
    return solvable and length_of(left) <= near


@scalar
def return_derivative(z: complex, v: complex, period: float, law: PinLaw, derivative: FloatArray) -> bool:
    """Write the derivative of the return map in (x, y, ẏ); return whether the turn was completed."""
    work = complex_zeros(32).reshape(4, 4, 2)
    y, stage, change, rates = work[0], work[1], work[2], work[3]
    y[0, 0], y[0, 1], y[1, 0], y[2, 0], y[3, 1] = z, v, 1.0, 1j, 1j
    left = period
    for _ in range(MOST_STRIDES):
        _put_rates(y, law, rates)
        if left <= 0.0:
            break
        turn = 1j * law.disc_speed
        slip, growth = y[0, 1] - turn * y[0, 0], rates[0, 1] - turn * rates[0, 0]
        s = size_of(slip)
        h = min(left, STRIDE / (1.0 + size_of(growth) / s), STABLE / (law.damping + law.friction / s))
        change[:] = 0.0
        for ahead, weight in COEFFICIENTS:
            for j in range(4):
                for i in range(2):
                    change[j, i] += h * weight * rates[j, i]
                    stage[j, i] = y[j, i] + h * ahead * rates[j, i]
            if ahead > 0.0:
                _put_rates(stage, law, rates)
        for j in range(4):
            for i in range(2):
                y[j, i] += change[j, i]
        left -= h
    if left > 0.0:
        return False
    for j in range(3):
        late = y[j + 1, 1].real / rates[0, 1].real
        dz, dv = y[j + 1, 0] - late * rates[0, 0], y[j + 1, 1] - late * rates[0, 1]
        derivative[0, j], derivative[1, j], derivative[2, j] = dz.real, dz.imag, dv.imag
    return True


@scalar
def _put_rates(y: ComplexArray, law: PinLaw, rates: ComplexArray) -> None:
    turn = complex(0.0, law.disc_speed)
    z, v = y[0, 0], y[0, 1]
    w = v - turn * z
    s = size_of(w)
    n = (1.0 / s) * w
    turning = (law.friction / s) * complex(-n.imag, n.real)
    rates[0, 0] = v
    rates[0, 1] = -law.stiffness * (z - law.offset) - law.damping * v - law.friction * n
    for j in range(1, 4):
        dz, dv = y[j, 0], y[j, 1]
        across = (n.conjugate() * (dv - turn * dz)).imag
        rates[j, 0] = dv
        rates[j, 1] = -law.stiffness * dz - law.damping * dv - across * turning
