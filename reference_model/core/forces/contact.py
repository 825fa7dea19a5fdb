"""Friction of a pin, a ring and an annulus under uniform pressure, in closed form.

The mean slip speed on a circle is P(U, W), where the centre slips with U and the circle with W, see
:mod:`reference_model.contact.elliptic`. Let k be the smaller over the larger of U and W, and m = k². Then ∂P is L =
(2/π)·E by the larger and S = (2/π)·k·B by the smaller, with B = [E − (1 − m)·K]/m. The arithmetic-geometric mean of 1
and √(1 − m) gives both (DLMF 19.8(i)), and L − 2S/k without the cancellation for small k.

The integral of r·∂P over a disc contains the same integrals, so force and moment follow from L and S on its rim
(Farkas, Bartels, Unger and Wolf 2003). An annulus is the difference of two discs.
"""

import math

from reference_model.core.forces.law import OWN, Law
from reference_model.numerics.parts import part, replaced_by

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


def no_shares(slip: float, spin: float, law: Law) -> tuple[float, float]:
    """Return no force, because compiled code does not support laws of the user."""
    return math.nan, math.nan


@replaced_by(no_shares)
def own_shares(slip: float, spin: float, law: Law) -> tuple[float, float]:
    """Return :func:`shares` of a law of the user."""
    if slip == 0.0 and spin == 0.0:
        return 0.0, 0.0
    resistance, moment = law.own.shares(slip, spin)
    return float(resistance), float(moment)


@part
def resisted(slip: float, spin: float, law: Law) -> tuple[float, float]:
    """Return :func:`shares` of any law."""
    if law.load == OWN:
        return own_shares(slip, spin, law)
    return shares(slip, spin, law.outer, law.inner, law.load)
