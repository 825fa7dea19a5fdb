"""Whether a closed orbit of a slipping pin attracts, told in compiled code: by the derivative of its return map.

Small deviations (δz, δv) of a motion go by the linear equations::

    δz' = δv,    δv' = −k²·δz − c·δv − (g/s)·i·n·Im(n̄·δw),    δw = δv − iω·δz

where w = s·n is the slip velocity: its direction n turns, with what is across it. Three of them, on the section where
x is largest, are followed for one turn together with the motion itself by the classical method of fourth order.
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
"""Step, in units of time or of that in which the slip velocity changes by itself; and in those in which deviations
decay by damping and friction, at the rate c + g/s: the method is stable up to 2.8 of them.

The multipliers of Fig. 5's whirls err by 1e-5, and by 1e-3 where slip all but ends in a turn.
"""

MOST_STRIDES = 20_000
"""In a turn: with more, slip all but ends in it."""

COEFFICIENTS = ((0.5, 1.0 / 6.0), (0.5, 1.0 / 3.0), (1.0, 1.0 / 3.0), (0.0, 1.0 / 6.0))
"""Of each stage: how far its rates carry the next, and their weight in the step."""


@written_out
def orbit_attracts(
    z: complex, v: complex, period: float, law: PinLaw, came: tuple[float, float, float], near: float
) -> bool:
    """Tell whether an orbit attracts on which a pin has place z and velocity v where x is largest, and is near.

    ``came`` is by how much x, y and ẏ differ there from the crossing before. With the derivative M of the return map
    the orbit crosses by (1 − M)⁻¹ times that from the crossing before, and it may be up to ``near`` from this one.
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
    """Put the derivative of the return map in (x, y, ẏ) into ``derivative``; tell whether the turn could be made."""
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
        # Along the motion back to the section.
        late = y[j + 1, 1].real / rates[0, 1].real
        dz, dv = y[j + 1, 0] - late * rates[0, 0], y[j + 1, 1] - late * rates[0, 1]
        derivative[0, j], derivative[1, j], derivative[2, j] = dz.real, dz.imag, dv.imag
    return True


@scalar
def _put_rates(y: ComplexArray, law: PinLaw, rates: ComplexArray) -> None:
    """Put the rates of the motion, the first row of ``y``, and of deviations from it, the others, into ``rates``."""
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
