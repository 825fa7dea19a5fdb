"""The motion in a step: a polynomial through position, velocity, acceleration and jerk at both ends."""

import math
from collections.abc import Callable
from typing import NamedTuple

from reference_model.ensemble.core.jit import inlined, scalar

GAUSS = (
    (0.06943184420297371, 0.17392742256872692),
    (0.33000947820757187, 0.32607257743127307),
    (0.6699905217924281, 0.32607257743127307),
    (0.9305681557970263, 0.17392742256872692),
)
"""Nodes and weights of four-point Gauss quadrature on (0, 1)."""

MOST_STEPS_TO_ROOT, CLOSE = 60, 1e-5
"""Largest number of iterations of a root search, and its tolerance for u; the error is far smaller."""


class Polynomial(NamedTuple):
    """Σ cᵢuⁱ + u⁴·Σ dᵢ(u − 1)ⁱ."""

    c0: float
    c1: float
    c2: float
    c3: float
    d0: float
    d1: float
    d2: float
    d3: float


class DenseOutput(NamedTuple):
    """x and y over a step of the duration ``span``, with u from 0 to 1."""

    x: Polynomial
    y: Polynomial
    span: float


@inlined
def size_of(z: complex) -> float:
    """Return |z| without the overflow protection of ``abs``, which is slower."""
    return math.sqrt(z.real * z.real + z.imag * z.imag)


class Motion(NamedTuple):
    """Position, velocity, acceleration and jerk."""

    place: complex
    velocity: complex
    acceleration: complex
    jerk: complex


@scalar
def dense_output(span: float, first: Motion, last: Motion) -> DenseOutput:
    v0, a0, j0 = first.velocity * span, first.acceleration * span**2, first.jerk * span**3
    v1, a1, j1 = last.velocity * span, last.acceleration * span**2, last.jerk * span**3
    z0, z1 = first.place, last.place
    return DenseOutput(
        _between(z0.real, v0.real, a0.real, j0.real, z1.real, v1.real, a1.real, j1.real),
        _between(z0.imag, v0.imag, a0.imag, j0.imag, z1.imag, v1.imag, a1.imag, j1.imag),
        span,
    )


@inlined
def _between(
    f0: float, f1: float, f2: float, f3: float, g0: float, g1: float, g2: float, g3: float
) -> Polynomial:
    """Return the polynomial with the value f0 and the derivatives f1, f2, f3 at 0 and g0 to g3 at 1."""
    c2, c3 = f2 / 2.0, f3 / 6.0
    e0, e1 = g0 - (f0 + f1 + c2 + c3), g1 - (f1 + f2 + 3.0 * c3)
    e2, e3 = g2 - (f2 + f3), g3 - f3
    d2 = (e2 - 8.0 * e1 + 20.0 * e0) / 2.0
    d3 = (e3 - 12.0 * e2 + 60.0 * e1 - 120.0 * e0) / 6.0
    return Polynomial(f0, f1, c2, c3, e0, e1 - 4.0 * e0, d2, d3)


@inlined
def _value(p: Polynomial, u: float) -> float:
    r = u - 1.0
    beyond = p.d0 + r * (p.d1 + r * (p.d2 + r * p.d3))
    return p.c0 + u * (p.c1 + u * (p.c2 + u * (p.c3 + u * beyond)))


@inlined
def _slope(p: Polynomial, u: float) -> float:
    r = u - 1.0
    beyond = p.d0 + r * (p.d1 + r * (p.d2 + r * p.d3))
    change = p.d1 + r * (2.0 * p.d2 + 3.0 * r * p.d3)
    return p.c1 + u * (2.0 * p.c2 + u * (3.0 * p.c3 + u * (4.0 * beyond + u * change)))


@inlined
def position_on(step: DenseOutput, u: float) -> complex:
    return complex(_value(step.x, u), _value(step.y, u))


@inlined
def velocity_on(step: DenseOutput, u: float) -> complex:
    return complex(_slope(step.x, u), _slope(step.y, u)) / step.span


@inlined
def rightward(step: DenseOutput, u: float) -> float:
    """Return ẋ(u) times the duration of the step."""
    return _slope(step.x, u)


@inlined
def outward(step: DenseOutput, u: float) -> float:
    """Return ρρ̇ times the duration of the step."""
    return _value(step.x, u) * _slope(step.x, u) + _value(step.y, u) * _slope(step.y, u)


@scalar
def where_rightmost(step: DenseOutput) -> float:
    """Return the u of the largest x; ẋ changes sign between the ends."""
    return _zero_of(rightward, step)


@scalar
def where_radius_turns(step: DenseOutput) -> float:
    """Return the u of the extreme radius; inf if the radius is monotonic."""
    if (outward(step, 0.0) > 0.0) == (outward(step, 1.0) > 0.0):
        return math.inf
    return _zero_of(outward, step)


@inlined
def _zero_of(measure: Callable[[DenseOutput, float], float], step: DenseOutput) -> float:
    low, high = 0.0, 1.0
    at_low, at_high = measure(step, low), measure(step, high)
    if at_low == at_high:
        return low
    u: float = at_low / (at_low - at_high)
    for _ in range(MOST_STEPS_TO_ROOT):
        at = measure(step, u)
        a, b, c = at_low - at_high, at_low - at, at_high - at
        new = low * at_high * at / (a * b) - high * at_low * at / (a * c) + u * at_low * at_high / (b * c)
        if (at > 0.0) == (at_low > 0.0):
            low, at_low = u, at
        else:
            high, at_high = u, at
        if not low < new < high:
            new = 0.5 * (low + high)
        change, u = abs(new - u), new
        if change < CLOSE:
            break
    return u


@scalar
def way_along(step: DenseOutput, u: float, disc_speed: float) -> float:
    """Return the slip distance ∫|ż − iωz|dt from the start of the step to u."""
    total: float = 0.0
    for place, weight in GAUSS:
        at = u * place
        total += weight * size_of(velocity_on(step, at) - complex(0.0, disc_speed) * position_on(step, at))
    return total * u * step.span
