"""Forces on a pin or a disc relative to the master disc, in scaled units.

The unknowns are x, y, the slip velocity (ux, uy) of the centre and r = κ(φ̇ − ω) with the radius of gyration κ. A pin
is a disc without a radius, so its r stays zero.
"""

import math
from collections.abc import Callable
from typing import Any, NamedTuple

from reference_model.core.contact import shares
from reference_model.core.parts import inlined, part
from reference_model.systems import FloatArray


class Law(NamedTuple):
    """Scaled parameters of a motion, with forces divided by the mass.

    ``hold`` is the friction that can hold the centre at rest, negative if friction cannot hold the shaft's moment.
    ``outer``, ``inner`` (over κ) and ``load`` are those of :func:`reference_model.core.contact.shares`. ``shaft`` is
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
    return part(namespace["unpacked"])


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
