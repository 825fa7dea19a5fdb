"""Forces on a pin or a ring relative to the master disc, in scaled units.

The unknowns are x, y, the slip velocity (ux, uy) of the centre and r = κ(φ̇ − ω) with the radius of gyration κ. A pin
is a ring without a radius, so its r stays zero.
"""

import math
from typing import NamedTuple

from reference_model.core.parts import part

AGREED = 1e-8
"""Relative difference of two means whose next means agree to rounding."""

SMALL = 1e-4
"""k² below which the terms after c₁² in the sum over k² are lost in rounding."""

NEAREST = 1e-16
"""Smallest relative distance from U = W that makes a difference."""


class Law(NamedTuple):
    """Scaled parameters of a motion, with forces divided by the mass.

    ``hold`` is the friction that can hold the centre at rest, negative if friction cannot hold the shaft's moment.
    ``rim`` is R/κ, ``shaft`` b/J, ``lag`` κ(ω − Ω), and ``gyration`` κ. ``stretch`` is s₀ of the stretched time.
    """

    damping: float
    stiffness: float
    offset: float
    hardening: float
    gap: float
    stop: float
    friction: float
    hold: float
    omega: float
    rim: float
    shaft: float
    lag: float
    gyration: float
    stretch: float


@part
def secant(d: float, law: Law) -> float:
    """Return the force of the support divided by the deflection ``d``."""
    result = law.stiffness + law.hardening * d * d
    if law.stop > 0.0 and d >= law.gap:
        result += law.stop * (1.0 - law.gap / d) if law.gap > 0.0 else law.stop
    return result


@part
def tangent(d: float, law: Law) -> float:
    """Return the derivative of the force of the support; at the stop, from outside."""
    return law.stiffness + 3.0 * law.hardening * d * d + (law.stop if d >= law.gap else 0.0)


@part
def pull(x: float, y: float, ux: float, uy: float, law: Law) -> tuple[float, float]:
    """Return the acceleration of the slip by everything except friction."""
    wx = x - law.offset
    k = law.stiffness
    if law.hardening > 0.0 or law.stop > 0.0:
        k = secant(math.sqrt(wx * wx + y * y), law)
    vx, vy = ux - law.omega * y, uy + law.omega * x
    return (
        -k * wx - law.damping * vx + law.omega * vy,
        -k * y - law.damping * vy - law.omega * vx,
    )


@part
def shares(slip: float, rim: float) -> tuple[float, float]:
    """Return ∂P/∂U and ∂P/∂W of the mean slip speed of a ring for U, W >= 0, by the arithmetic-geometric mean."""
    if rim == 0.0:
        return (1.0 if slip > 0.0 else 0.0), 0.0
    more = slip >= rim
    larger, smaller = (slip, rim) if more else (rim, slip)
    k = smaller / larger
    apart = max((larger - smaller) / larger, NEAREST)
    m = k * k
    a, g = 1.0, math.sqrt(apart * (1.0 + k))
    a, g = 0.5 * (a + g), math.sqrt(a * g)
    first = m / (8.0 * a * a)
    rest, weight = 0.0, 1.0
    while a - g > AGREED * a:
        c = a - g
        rest += weight * c * c
        weight *= 2.0
        a, g = 0.5 * (a + g), math.sqrt(a * g)
    rest += weight * (a - g) * (a - g)
    a = 0.5 * (a + g)
    total = first + (rest / m if m > SMALL else 0.0)
    by_larger = (1.0 - 0.5 * m * (1.0 + total)) / a
    by_smaller = k * (0.5 - 0.5 * total) / a
    if more:
        return by_larger, by_smaller
    return by_smaller, by_larger


@part
def friction(ux: float, uy: float, r: float, law: Law) -> tuple[float, float, float]:
    """Return the acceleration by friction of ux, uy and r."""
    slip = math.sqrt(ux * ux + uy * uy)
    along_slip, along_rim = shares(slip, law.rim * abs(r))
    over = law.friction * along_slip / slip if slip > 0.0 else 0.0
    return -over * ux, -over * uy, -law.friction * law.rim * math.copysign(along_rim, r)


@part
def growth(
    x: float, y: float, ux: float, uy: float, r: float, law: Law
) -> tuple[float, float, float]:
    """Return the rates of ux, uy and r."""
    ax, ay = pull(x, y, ux, uy, law)
    fx, fy, fr = friction(ux, uy, r, law)
    return ax + fx, ay + fy, fr - law.shaft * (r + law.lag)


@part
def rates(
    x: float, y: float, ux: float, uy: float, r: float, law: Law
) -> tuple[float, float, float, float, float, float, float]:
    """Return the rates of x, y, ux, uy, r, the angle and the time in stretched time dτ = dt·(s + s₀)/s."""
    ax, ay, ar = growth(x, y, ux, uy, r, law)
    s = math.sqrt(ux * ux + uy * uy + r * r)
    pace = s / (s + law.stretch) if law.stretch > 0.0 else 1.0
    return (
        pace * (ux - law.omega * y),
        pace * (uy + law.omega * x),
        pace * ax,
        pace * ay,
        pace * ar,
        pace * (law.omega + r / law.gyration),
        pace,
    )
