"""Criteria for a pin's end state during its motion.

Permanent stick
    In the frame of the disc the pull is the sum of a constant k²X₀ and a turning part of size q. Friction holds it
    permanently if k²|X₀| + q <= g = μN/m (eq. 7). A pin slightly outside creeps forever, and counts as stuck, if k >
    |ω| and it moves inward per turn by less than the remaining distance (``laws.creeps_by_turns``). Without offset it
    does so if damping prevents overshoot (``slip.creeps_steadily``, ``slip.creeps_slaved``).

Self-centred
    The motion is inside a trapping region of the equilibrium (3), bounded by a level of a quadratic form V. For equal
    parameters ``trapping`` finds it. Otherwise, with the deviations ξ along the radius of the
    equilibrium and η across, eq. 1 is a cascade::

        η'' + c·η' + k²η = R_η,    ξ'' + D·ξ' + k²ξ = ∓(g/ρ*)·η + R_ξ,    D = c + g/s*

    where c = β/m, s* = |ω|ρ*, and R is the nonlinear part of the direction of slip, |R| <= g·(|δw|/s*)² for |δw| <=
    s*/2. V = V_D(ξ) + κ·V_c(η) with V_d(x) = (x' + dx/2)² + (k² + d²/4)x² falls by d·(x'² + k²x²) for each
    oscillator, except for coupling and R, which :func:`equilibrium_region` bounds.

Whirl
    For equal parameters ``trapping`` finds the orbit and a neighbourhood that its return map to the section where x
    is largest contracts. Otherwise the crossings must converge: with the distance d of the last two and the larger q
    of the last two ratios, d·q/(1 − q) remains and must be below ACCURACY times the speed there. Distances that are
    only noise also count. A motion may pass an unstable orbit, so the orbit must also attract, and the derivative of
    its return map must confirm the distance. Small deviations (δz, δv), with the slip velocity w = s·n, satisfy::

        δz' = δv,    δv' = −k²·δz − c·δv − (g/s)·i·n·Im(n̄·δw),    δw = δv − iω·δz

Stick-slip
    The distance from the axis at a release determines the state, so its change is judged like the crossings above.
"""

import math
from typing import NamedTuple

from reference_model.ensemble.core.jit import inlined, scalar, written_out
from reference_model.ensemble.core.laws import PinLaw
from reference_model.ensemble.core.stepping.dense_output import size_of
from reference_model.ensemble.core.stepping.linear import (
    complex_zeros,
    length_of,
    powers_vanish,
    quadratic_form,
    solve,
    zeros,
)
from reference_model.ensemble.core.stepping.runge_kutta import Tuple
from reference_model.systems import ComplexArray, FloatArray

FORM_SIZE = 10
"""Size of the upper half of a quadratic form in ξ, η, ξ'/k, η'/k."""


class EquilibriumRegion(NamedTuple):
    """The self-centred equilibrium z* (3), the upper half of V, and the level of its trapping region, else -1."""

    place: complex
    form: Tuple
    level: float


NOTHING = (0.0,) * FORM_SIZE


@scalar
def equilibrium_region(law: PinLaw) -> EquilibriumRegion:
    """Return the self-centred equilibrium with the estimated V."""
    k2, c, g = law.stiffness, law.damping, law.friction
    reach = k2 * abs(law.offset)
    if k2 == 0.0 or c == 0.0 or (g > 0.0 and (g >= reach or law.disc_speed == 0.0)):
        return EquilibriumRegion(0j, NOTHING, -1.0)
    if g == 0.0:
        return EquilibriumRegion(complex(law.offset, 0.0), NOTHING, math.inf)
    radius = math.sqrt((reach - g) * (reach + g)) / k2
    place = radius / law.offset * complex(radius, math.copysign(g / k2, law.disc_speed))
    slip = abs(law.disc_speed) * radius
    k = math.sqrt(k2)
    along, across = (c + g / slip) / k, c / k
    lever_along, lever_across = math.sqrt(1.0 + along**2 / 4.0), math.sqrt(1.0 + across**2 / 4.0)
    weight = (2.0 * lever_along * g / (radius * k2)) ** 2 / (along * across)
    form = (
        1.0 + along**2 / 2.0, 0.0, along / 2.0, 0.0,
        weight * (1.0 + across**2 / 2.0), 0.0, weight * across / 2.0,
        1.0, 0.0, weight,
    )  # fmt: skip
    # With u² = ξ² + (ξ'/k)² and v² likewise for η, kV falls by at least half of D·u² + κc·v², except for R; and |δw|
    # <= (k + |ω|)·√(u² + v²).
    swing = (k + abs(law.disc_speed)) / slip
    bound = min(along, weight * across) * k2 / (4.0 * g * swing**2)
    least_along, least_across = _least_share(along), _least_share(across)
    root = bound / (lever_along / math.sqrt(least_along) + lever_across * math.sqrt(weight / least_across))
    nearest = math.sqrt(min(least_along, weight * least_across)) / (2.0 * swing)  # |δw| <= s*/2
    return EquilibriumRegion(place, form, min(root, nearest) ** 2)


@inlined
def _least_share(a: float) -> float:
    """Return the smaller eigenvalue of ((1 + a²/2, a/2), (a/2, 1)), which is V_d in x and x'/k with a = d/k."""
    return (1.0 + a**2 / 4.0) / (1.0 + a**2 / 4.0 + math.sqrt(a**4 / 16.0 + a**2 / 4.0))


@scalar
def depth(z: complex, w: complex, law: PinLaw, equilibrium: complex, form: FloatArray | Tuple) -> float:
    size = abs(equilibrium)
    along = equilibrium.conjugate() / size if size > 0.0 else 1.0 + 0j
    place = (z - equilibrium) * along
    speed = (w + 1j * law.disc_speed * z) * along / math.sqrt(law.stiffness)
    return quadratic_form(form, (place.real, place.imag, speed.real, speed.imag))


# --- Stability of a closed orbit of a slipping pin

STRIDE, STABLE = 0.5, 1.5
"""Step sizes, in units of time or of the time scale of the slip velocity, and in units of 1/(c + g/s).

Deviations decay at the rate c + g/s; the method is stable up to 2.8 units of 1/(c + g/s).
"""

MOST_STRIDES = 20_000
"""Largest number of steps in a turn; more are needed only if slip almost ends."""

COEFFICIENTS = ((0.5, 1.0 / 6.0), (0.5, 1.0 / 3.0), (1.0, 1.0 / 3.0), (0.0, 1.0 / 6.0))
"""Weights of the rates of each stage in the next stage and in the step."""


@written_out
def orbit_attracts(
    z: complex, v: complex, period: float, law: PinLaw, came: tuple[float, float, float], near: float
) -> bool:
    """Return whether an orbit attracts and is near, given position z and velocity v of a pin where x is largest.

    ``came`` is the change of x, y and ẏ since the previous crossing. With the derivative M of the return map the
    orbit is (1 − M)⁻¹ times ``came`` away from the previous crossing, and must be within ``near`` of the present
    crossing.
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
    """Write the derivative of the return map with respect to (x, y, ẏ); return whether the turn was completed."""
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
