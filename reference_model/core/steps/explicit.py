"""One step of Dormand and Prince's method of eighth order and its interpolant, with SciPy's coefficients of DOP853.

Hairer, Nørsett and Wanner, Solving Ordinary Differential Equations I, II.5 and II.6.
"""

import math
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
from scipy.integrate import DOP853

from reference_model.core.forces.law import CENTRE, Law
from reference_model.core.forces.rates import rates
from reference_model.numerics.parts import inlined, part
from reference_model.systems import FloatArray

NAMES = ("x", "y", "ux", "uy", "r", "angle", "t")

Unknowns = tuple[float, float, float, float, float, float, float]

SIZE, STAGES, EXTENDED = 7, 12, 16
"""Numbers of unknowns, of stages, and of rates that the interpolant needs."""

TERMS = 7
"""Number of terms of the interpolant."""

EXTRA, DENSE = DOP853.A_EXTRA, DOP853.D
WEIGHTS = np.append(DOP853.B, np.zeros(EXTENDED - STAGES))


def _sum(weights: Sequence[float], name: str) -> str:
    return " + ".join(f"{float(w)!r} * k{j}{name}" for j, w in enumerate(weights, 1) if w != 0.0)


def _text() -> str:
    lines = ["def take(start, first, h, law, K):", f"{', '.join(NAMES)} = start"]
    lines.append(f"{', '.join(f'k1{name}' for name in NAMES)} = first")
    for stage in range(2, STAGES + 1):
        arguments = ", ".join(f"{name} + h * ({_sum(DOP853.A[stage - 1], name)})" for name in NAMES[:6])
        found = ", ".join(f"k{stage}{name}" for name in NAMES)
        lines.append(f"{found} = rates({arguments}, law)")
    for result, weights in (("new", DOP853.B), ("third", DOP853.E3), ("fifth", DOP853.E5)):
        for name in NAMES:
            origin = f"{name} + h * " if result == "new" else ""
            lines.append(f"{result}_{name} = {origin}({_sum(weights, name)})")
    for stage in range(1, STAGES + 1):
        lines += [f"K[{stage - 1}, {v}] = k{stage}{name}" for v, name in enumerate(NAMES)]
    for result in ("new", "third", "fifth"):
        lines.append(f"{result} = ({', '.join(f'{result}_{name}' for name in NAMES)})")
    return "\n    ".join([*lines, "return new, third, fifth"])


_namespace: dict[str, Any] = {"rates": rates}
exec(_text(), _namespace)
Step = Callable[[Unknowns, Unknowns, float, Law, FloatArray], tuple[Unknowns, Unknowns, Unknowns]]
take: Step = part(_namespace["take"])
"""Return the unknowns after a step, and their differences from the embedded methods of orders 3 and 5.

It takes the unknowns, their rates, the step and the law, and writes the rates of all stages to an array.
"""


@inlined
def shares_of(y: Unknowns, law: Law) -> tuple[float, float]:
    """Return factors of the tolerances of slip and r: small for small slip, and for the arm of a point for r."""
    if law.point == CENTRE:
        s = math.sqrt(y[2] * y[2] + y[3] * y[3] + y[4] * y[4])
        share = s / (s + law.stretch) if law.stretch > 0.0 else 1.0
        return share, share
    squared = 1.0 + law.arm_x * law.arm_x + law.arm_y * law.arm_y
    spin = 1.0 / math.sqrt(squared)
    if law.sense != 0.0:
        return 1.0, spin
    v = math.sqrt(y[2] * y[2] + y[3] * y[3])
    slip = v / (v + law.stretch * law.share * squared)
    return slip, spin * abs(y[4]) / (abs(y[4]) + law.stretch)


@part
def error_of(
    old: Unknowns, new: Unknowns, third: Unknowns, fifth: Unknowns, tolerance: float, law: Law
) -> float:
    """Return Hairer's estimate of the error per step in tolerances.

    The error of small slip counts relative to slip, because its direction decides where slip ends.
    """
    slip, spin = shares_of(new, law)
    high = low = 0.0
    for v in range(SIZE):
        scale = tolerance
        if v < 5:
            scale *= 1.0 + max(abs(old[v]), abs(new[v]))
        if 2 <= v < 4:
            scale *= slip
        elif v == 4:
            scale *= spin
        inverse = 1.0 / scale
        a, b = fifth[v] * inverse, third[v] * inverse
        high += a * a
        low += b * b
    if not high > 0.0:
        return 0.0 if high == 0.0 else math.inf
    return high / math.sqrt((high + 0.01 * low) * SIZE)


@part
def factor_of(error: float) -> float:
    """Return the factor for the next step, error^(−1/8) within bounds."""
    if not error < 1e300:
        return 0.2
    return float(min(max(0.9 * max(error, 1e-30) ** -0.125, 0.2), 10.0))


@part
def interpolate(
    y: Unknowns, new: Unknowns, last: Unknowns, h: float, law: Law, K: FloatArray, F: FloatArray
) -> None:
    """Write the interpolant of a step to ``F``, shape (TERMS + 1, SIZE), from the rates ``K`` and ``last``."""
    for v in range(SIZE):
        K[STAGES, v] = last[v]
    for i in range(3):
        stage = STAGES + 1 + i
        place = np.zeros(6)
        for v in range(6):
            total = 0.0
            for j in range(stage):
                total += EXTRA[i, j] * K[j, v]
            place[v] = y[v] + h * total
        found = rates(place[0], place[1], place[2], place[3], place[4], place[5], law)
        for v in range(SIZE):
            K[stage, v] = found[v]
    for v in range(SIZE):
        change = new[v] - y[v]
        F[0, v] = y[v]
        F[1, v] = change
        F[2, v] = h * K[0, v] - change
        F[3, v] = 2.0 * change - h * (K[0, v] + last[v])
    for i in range(4):
        for v in range(SIZE):
            total = 0.0
            for j in range(EXTENDED):
                total += DENSE[i, j] * K[j, v]
            F[4 + i, v] = h * total


@part
def component(F: FloatArray, place: float, v: int) -> tuple[float, float]:
    """Return an unknown at ``place`` in [0, 1] of a step, and its derivative with respect to it."""
    value = slope = 0.0
    for i in range(TERMS, 0, -1):
        value += F[i, v]
        if i % 2 == 1:
            slope = slope * place + value
            value *= place
        else:
            slope = slope * (1.0 - place) - value
            value *= 1.0 - place
    return F[0, v] + value, slope


@part
def inside(F: FloatArray, place: float) -> Unknowns:
    """Return the unknowns at ``place`` in [0, 1] of a step."""
    return (
        component(F, place, 0)[0], component(F, place, 1)[0], component(F, place, 2)[0], component(F, place, 3)[0],
        component(F, place, 4)[0], component(F, place, 5)[0], component(F, place, 6)[0],
    )  # fmt: skip
