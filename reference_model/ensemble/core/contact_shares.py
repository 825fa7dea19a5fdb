"""Friction of a ring and of points on a ring as branch-free code, which can be inlined into loops over lanes.

Both are resistances, as shares of μN, to slip of the centre and of the rim. Those of the ring are elliptic integrals
by the arithmetic-geometric mean of a₀ = 1 and g₀ = √(1 − k²). With the ratio k of the smaller to the larger of U =
|u| and the rim's |W|, and the halved differences c of a and g::

    ∂P by the larger = (1 − ½·Σ 2ⁿcₙ²)/A,    ∂P by the smaller = k·(½ − ½·Σ_{n>0} 2ⁿcₙ²/k²)/A,    c₀ = k

where A is the mean (DLMF 19.8(i)). The only cancellation is of order 1/A, a logarithm, at U = |W|.
"""

import math
from collections.abc import Callable
from typing import Any

import numpy as np
from numba.extending import overload

from reference_model.ensemble.core.jit import INLINED, generated, inlined

LEAST = 1e-300
"""Lower bound on speeds in denominators."""

NEAREST = 1e-16
"""Smallest relative distance from U = |W| that makes a difference."""

SMALL = 1e-4
"""k² below which the terms after c₁² in the sum over k² are lost in rounding."""

HALVINGS = 7
"""Number of means of a and g, which then agree to rounding for all k."""

QUARTER = (
    float.fromhex("0x1.921fb54400000p+0"),
    float.fromhex("0x1.0b4611a600000p-34"),
    2.02226624871116645580e-21,
)
"""π/2 in three parts, the first two of 33 bits."""

SINE = tuple((-1.0) ** n / math.factorial(2 * n + 1) for n in range(8, -1, -1))
COSINE = tuple((-1.0) ** n / math.factorial(2 * n) for n in range(8, -1, -1))
"""Taylor coefficients in the square of the angle, highest power first."""


@inlined
def ring_shares(slip: float, rim: float) -> tuple[float, float]:
    """Return ∂P/∂U and ∂P/∂W of a ring for U, W >= 0."""
    more = slip >= rim
    larger = slip if more else rim
    smaller = rim if more else slip
    larger = larger if larger > LEAST else LEAST
    k = smaller / larger
    apart = (larger - smaller) / larger  # 1 − k to full precision
    apart = apart if apart > NEAREST else NEAREST
    m = k * k
    a, g = 1.0, math.sqrt(apart * (1.0 + k))
    a, g = 0.5 * (a + g), math.sqrt(a * g)
    first = m / (8.0 * a * a)
    rest, weight = 0.0, 1.0
    for _ in range(HALVINGS - 1):
        c = a - g
        rest += weight * c * c
        weight *= 2.0
        a, g = 0.5 * (a + g), math.sqrt(a * g)
    total = first + (rest / m if m > SMALL else 0.0)
    by_larger = (1.0 - 0.5 * m * (1.0 + total)) / a
    by_smaller = k * (0.5 - 0.5 * total) / a
    return (by_larger if more else by_smaller), (by_smaller if more else by_larger)


def points_shares(
    ux: float, uy: float, rim: float, around: tuple[float, ...]
) -> tuple[float, float, float, float]:
    """Return the resistances along x, y and the rim, and the mean slip speed, of points on a ring.

    ``around`` contains (cos, sin) of each point in sequence. A point at rest contributes nothing.
    """
    raise NotImplementedError


@overload(points_shares, jit_options=INLINED, strict=False)
def _points_shares(ux: Any, uy: Any, rim: Any, around: Any) -> Callable[..., Any]:
    lines = ["fx = fy = moment = power = 0.0"]
    for i in range(0, len(around), 2):
        lines += [
            f"vx, vy = ux - rim * around[{i + 1}], uy + rim * around[{i}]",
            "speed = math.sqrt(vx * vx + vy * vy)",
            f"inverse = 1.0 / max(speed, {LEAST!r})",
            "vx, vy = vx * inverse, vy * inverse",
            "fx, fy, power = fx + vx, fy + vy, power + speed",
            f"moment = moment + around[{i}] * vy - around[{i + 1}] * vx",
        ]
    share = 1.0 / (len(around) // 2)
    lines.append(f"return {share!r} * fx, {share!r} * fy, {share!r} * moment, {share!r} * power")
    return generated("ux, uy, rim, around", lines)


@inlined
def turned(angle: float) -> tuple[float, float]:
    """Return cosine and sine of an angle up to 1e6 rad without a branch, by quarter turns (Cody and Waite)."""
    quarters = np.rint(angle * (2.0 / math.pi))
    x = ((angle - quarters * QUARTER[0]) - quarters * QUARTER[1]) - quarters * QUARTER[2]
    m = x * x
    sine, cosine = SINE[0], COSINE[0]
    for coefficient in SINE[1:]:
        sine = sine * m + coefficient
    for coefficient in COSINE[1:]:
        cosine = cosine * m + coefficient
    sine *= x
    turn = quarters - 4.0 * np.rint(0.25 * quarters)
    odd = abs(turn) == 1.0
    c = sine if odd else cosine
    s = cosine if odd else sine
    return (-c if turn == 1.0 or abs(turn) == 2.0 else c), (-s if turn == -1.0 or abs(turn) == 2.0 else s)
