"""Forces on a pin or a disc relative to the master disc, in scaled units.

The unknowns are x, y, the slip velocity (vx, vy) of the centre or of a contact point, and r = κ(φ̇ − ω) with the
radius of gyration κ. A pin is a disc without a radius, so its r stays zero.
"""

import math

from reference_model.core.forces.contact import resisted
from reference_model.core.forces.law import CENTRE, Law
from reference_model.core.forces.pivot import turning
from reference_model.core.forces.points import centre_slip, friction_of_points, of_point
from reference_model.numerics.parts import inlined, part


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
def friction(vx: float, vy: float, r: float, angle: float, law: Law) -> tuple[float, float, float, float]:
    """Return the acceleration by friction of the centre and of r, and the pace dt/dτ of stretched time."""
    if len(law.around) > 0:
        return friction_of_points(vx, vy, r, angle, law)
    slip = math.sqrt(vx * vx + vy * vy)
    if law.outer == 0.0:
        over = law.friction / slip if slip > 0.0 else 0.0
        return -over * vx, -over * vy, 0.0, slip / (slip + law.stretch) if law.stretch > 0.0 else 1.0
    s = math.sqrt(slip * slip + r * r)
    force, moment = resisted(slip, abs(r), law)
    over = law.friction * force / slip if slip > 0.0 else 0.0
    return (
        -over * vx, -over * vy, -law.friction * math.copysign(moment, r),
        s / (s + law.stretch) if law.stretch > 0.0 else 1.0,
    )  # fmt: skip


@inlined
def growth(
    x: float, y: float, vx: float, vy: float, r: float, angle: float, law: Law
) -> tuple[float, float, float, float, float, float]:
    """Return the rates of vx, vy and r, the pace of stretched time, and the slip of the centre."""
    ux, uy = vx, vy
    if law.point != CENTRE:
        ux, uy = centre_slip(vx, vy, r, angle, law)
    ax, ay = pull(x, y, ux, uy, law)
    if law.sense != 0.0:
        return 0.0, 0.0, turning(ax, ay, r, angle, law)[0], 1.0, ux, uy
    fx, fy, fr, pace = friction(vx, vy, r, angle, law)
    ax, ay, ar = ax + fx, ay + fy, fr - law.shaft * (r + law.lag)
    if law.point != CENTRE:
        ax, ay = of_point(ax, ay, ar, r, angle, law)
    return ax, ay, ar, pace, ux, uy


@inlined
def rates(
    x: float, y: float, vx: float, vy: float, r: float, angle: float, law: Law
) -> tuple[float, float, float, float, float, float, float]:
    """Return the rates of x, y, vx, vy, r, the angle and the time in stretched time.

    Time is stretched by half the rate of g over the slip speed, a mean over contact points, so dτ = dt·(1 + ½g/s).
    """
    ax, ay, ar, pace, ux, uy = growth(x, y, vx, vy, r, angle, law)
    return (
        pace * (ux - law.omega * y),
        pace * (uy + law.omega * x),
        pace * ax,
        pace * ay,
        pace * ar,
        pace * (law.omega + r / law.gyration),
        pace,
    )
