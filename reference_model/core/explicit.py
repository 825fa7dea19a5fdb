"""One step of Dormand and Prince's method of eighth order, as straight-line text from SciPy's coefficients of DOP853.

Hairer, Nørsett and Wanner, Solving Ordinary Differential Equations I, II.5.
"""

import math
from collections.abc import Callable, Sequence
from typing import Any

from scipy.integrate import DOP853

from reference_model.core.forces import Law, rates
from reference_model.core.parts import part

NAMES = ("x", "y", "ux", "uy", "r", "angle", "t")

Unknowns = tuple[float, float, float, float, float, float, float]


def _sum(weights: Sequence[float], name: str) -> str:
    return " + ".join(f"{float(w)!r} * k{j}{name}" for j, w in enumerate(weights, 1) if w != 0.0)


def _text() -> str:
    lines = ["def take(y0, h, law):", "x, y, ux, uy, r, angle, t = y0"]
    for stage in range(1, 13):
        if stage == 1:
            arguments = "x, y, ux, uy, r"
        else:
            arguments = ", ".join(f"{name} + h * ({_sum(DOP853.A[stage - 1], name)})" for name in NAMES[:5])
        found = ", ".join(f"k{stage}{name}" for name in NAMES)
        lines.append(f"{found} = rates({arguments}, law)")
    for result, weights in (("new", DOP853.B), ("third", DOP853.E3), ("fifth", DOP853.E5)):
        for name in NAMES:
            start = f"{name} + h * " if result == "new" else ""
            lines.append(f"{result}_{name} = {start}({_sum(weights, name)})")
    for result in ("new", "third", "fifth"):
        lines.append(f"{result} = ({', '.join(f'{result}_{name}' for name in NAMES)})")
    return "\n    ".join([*lines, "return new, third, fifth"])


_namespace: dict[str, Any] = {"rates": rates}
exec(_text(), _namespace)
take: Callable[[Unknowns, float, Law], tuple[Unknowns, Unknowns, Unknowns]] = part(_namespace["take"])
"""Return the unknowns after a step, and their differences from the embedded methods of orders 3 and 5."""


@part
def error_of(old: Unknowns, new: Unknowns, third: Unknowns, fifth: Unknowns, tolerance: float, law: Law) -> float:
    """Return Hairer's estimate of the error in tolerances.

    The error of small slip counts relative to slip, because its direction decides where slip ends.
    """
    s = math.sqrt(new[2] * new[2] + new[3] * new[3] + new[4] * new[4])
    share = s / (s + law.stretch) if law.stretch > 0.0 else 1.0
    high = low = 0.0
    for v in range(7):
        scale = tolerance * (1.0 + max(abs(old[v]), abs(new[v])))
        if v >= 2 and v < 5:
            scale *= share
        if v >= 5:
            scale = tolerance
        a, b = fifth[v] / scale, third[v] / scale
        high += a * a
        low += b * b
    if not high > 0.0:
        return 0.0 if high == 0.0 else math.inf
    return high / math.sqrt((high + 0.01 * low) * 7.0)


@part
def factor_of(error: float) -> float:
    """Return the factor for the next step, error^(−1/8) within bounds."""
    if not error < 1e300:
        return 0.2
    return min(max(0.9 * max(error, 1e-30) ** -0.125, 0.2), 10.0)
