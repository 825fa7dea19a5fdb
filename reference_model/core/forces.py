"""Forces on a pin or a disc relative to the master disc, in scaled units.

The unknowns are x, y, the slip velocity (ux, uy) of the centre and r = κ(φ̇ − ω) with the radius of gyration κ. A pin
is a disc without a radius, so its r stays zero.

The mean slip speed on a circle is P(U, W), where the centre slips with U and the circle with W, see
:mod:`reference_model.contact.elliptic`. With the smaller over the larger of both, k, and m = k², ∂P is L = (2/π)·E by
the larger and S = (2/π)·k·B by the smaller, B = [E − (1 − m)·K]/m. The arithmetic-geometric mean of 1 and √(1 − m)
gives both (DLMF 19.8(i)), and L − 2S/k without the cancellation for small k.

The integral of r·∂P over a disc contains the same integrals, so force and moment follow from L and S on its rim
(Farkas, Bartels, Unger and Wolf 2003). An annulus is the difference of two discs.
"""

import math
from collections.abc import Callable
from typing import Any, NamedTuple

from reference_model.core.parts import inlined, part
from reference_model.systems import FloatArray

AGREED = 1e-8
"""Relative difference of two means whose next means agree to rounding."""

SMALL = 1e-6
"""k² below which the terms after c₁² in the sum over k² are lost in rounding."""

NEAREST = 1e-16
"""Smallest relative distance from U = W that makes a difference."""

LEAST = 1e-300
"""Lower bound on speeds in denominators."""


@part
def means(k: float, apart: float) -> tuple[float, float, float]:
    """Return L, S and L − 2S/k for the modulus k, where ``apart`` is 1 − k to full precision."""
    m = k * k
    a, g = 1.0, math.sqrt(max(apart, NEAREST) * (1.0 + k))
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
    half = 0.5 * m * (1.0 + total)
    return (1.0 - half) / a, 0.5 * k * (1.0 - total) / a, (total - half) / a


@part
def circle(slip: float, rim: float) -> tuple[float, float]:
    """Return the shares of μN that resist slip of the centre and of the rim, for U, W >= 0 on a circle."""
    larger, smaller = max(slip, rim, LEAST), min(slip, rim)
    by_larger, by_smaller, _ = means(smaller / larger, (larger - smaller) / larger)
    return (by_larger, by_smaller) if slip >= rim else (by_smaller, by_larger)


@part
def disc(slip: float, rim: float) -> tuple[float, float]:
    """Return these shares under uniform pressure on a disc, for U and the speed W >= 0 of its rim."""
    larger, smaller = max(slip, rim, LEAST), min(slip, rim)
    k = smaller / larger
    by_larger, by_smaller, apart = means(k, (larger - smaller) / larger)
    if slip < rim:
        return (
            2.0 / 3.0 * (k * by_larger + by_smaller),
            2.0 / 9.0 * ((3.0 - 2.0 * k * k) * by_larger + k * by_smaller),
        )
    if k == 0.0:
        return 1.0, 0.0
    return 2.0 / 3.0 * (by_larger + by_smaller / k), 2.0 / 9.0 * (apart / k + 3.0 * by_smaller)


@part
def shares(slip: float, spin: float, outer: float, inner: float, load: float) -> tuple[float, float]:
    """Return force and moment as shares of μN that resist ``slip`` and ``spin``, both >= 0.

    ``load`` is R²/(R² − R₁²) of an annulus with the radii R (``outer``) and R₁, and 0 for a ring; a pin has R = 0.
    """
    if outer == 0.0:
        return (1.0 if slip > 0.0 else 0.0), 0.0
    if load == 0.0:
        force, moment = circle(slip, outer * spin)
        return force, outer * moment
    force, moment = disc(slip, outer * spin)
    if inner == 0.0:
        return force, outer * moment
    hole_force, hole_moment = disc(slip, inner * spin)
    hole = load - 1.0
    return load * force - hole * hole_force, load * outer * moment - hole * inner * hole_moment


class Law(NamedTuple):
    """Scaled parameters of a motion, with forces divided by the mass.

    ``hold`` is the friction that can hold the centre at rest, negative if friction cannot hold the shaft's moment.
    ``outer``, ``inner`` (over κ) and ``load`` are those of :func:`shares`. ``shaft`` is
    b/J, ``lag`` κ(ω − Ω), and ``gyration`` κ. ``stretch`` is s₀ of the stretched time.
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
    outer: float
    inner: float
    load: float
    shaft: float
    lag: float
    gyration: float
    stretch: float


def _unpacked() -> Callable[[FloatArray], Law]:
    namespace: dict[str, Any] = {"Law": Law}
    arguments = ", ".join(f"parameters[{i}]" for i in range(len(Law._fields)))
    exec(f"def unpacked(parameters):\n    return Law({arguments})", namespace)
    found: Callable[[FloatArray], Law] = part(namespace["unpacked"])
    return found


unpacked = _unpacked()
"""Return the law with the parameters in an array: numba takes 0.3 ms to pass a named tuple from Python."""


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


@inlined
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


@inlined
def friction(ux: float, uy: float, r: float, law: Law) -> tuple[float, float, float]:
    """Return the acceleration by friction of ux, uy and r."""
    slip = math.sqrt(ux * ux + uy * uy)
    if law.outer == 0.0:
        over = law.friction / slip if slip > 0.0 else 0.0
        return -over * ux, -over * uy, 0.0
    force, moment = shares(slip, abs(r), law.outer, law.inner, law.load)
    over = law.friction * force / slip if slip > 0.0 else 0.0
    return -over * ux, -over * uy, -law.friction * math.copysign(moment, r)


@inlined
def growth(x: float, y: float, ux: float, uy: float, r: float, law: Law) -> tuple[float, float, float]:
    """Return the rates of ux, uy and r."""
    ax, ay = pull(x, y, ux, uy, law)
    fx, fy, fr = friction(ux, uy, r, law)
    return ax + fx, ay + fy, fr - law.shaft * (r + law.lag)


@inlined
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
