"""First and second derivatives of the mean slip speed on a circle, by complete elliptic integrals.

If the centre slips with U and the rim turns with W = R·|S| relative to the master disc, the mean slip speed is P(U,
W) = (1/2π)∫√(U² + W² − 2UW·cos χ) dχ. Friction is the derivative of P, which is symmetric in U and W and of degree 1.
For k = W/U <= 1 and m = k² Landen's transformation gives P = (2/π)·U·[2E(m) − (1 − m)·K(m)], so::

    ∂P/∂U = (2/π)·E(m),   ∂P/∂W = (2/π)·k·B(m),   ∂²P/∂W² = (2/π)·D(m)/U

with B = [E − (1 − m)K]/m and D = (K − E)/m (DLMF 19.2(iii)). At U = W one point rests and the second derivatives are
infinite, like a logarithm.
"""

import math
from collections.abc import Sequence

from scipy.special import ellipe, ellipkm1

SMALL = 0.05
"""Parameter m below which B and D are series, because differences would lose digits."""

TERMS = 13
"""Number of terms; the first omitted one is below SMALL^13 = 1e-17."""


def mean_directions(slip: float, rim: float) -> tuple[float, float]:
    """Return ∂P/∂U and ∂P/∂W for U, W >= 0 in m/s, not both zero; both lie between 0 and 1."""
    faster = slip >= rim
    ratio = rim / slip if faster else slip / rim
    m = ratio * ratio
    integral = float(ellipe(m))
    by_larger = 2.0 / math.pi * integral
    if m < SMALL:
        by_smaller = 0.5 * ratio * _series(_B_SERIES, m)
    else:
        complement = 1.0 - m  # multiplied by its logarithm, so its rounding does not matter
        rest = complement * float(ellipkm1(complement)) if complement > 0.0 else 0.0
        by_smaller = 2.0 / math.pi * (integral - rest) / ratio
    return (by_larger, by_smaller) if faster else (by_smaller, by_larger)


def mean_curvatures(slip: float, rim: float) -> tuple[float, float, float]:
    """Return ∂²P/∂U², ∂²P/∂U∂W and ∂²P/∂W² in s/m for U, W >= 0 in m/s, which must differ."""
    larger, smaller = max(slip, rim), min(slip, rim)
    ratio = smaller / larger
    m = ratio * ratio
    if m < SMALL:
        integral = math.pi / 4.0 * _series(_D_SERIES, m)
    else:
        complement = (larger - smaller) / larger * (1.0 + ratio)  # 1 − m to full precision
        integral = (float(ellipkm1(complement)) - float(ellipe(m))) / m
    # Derivatives with respect to the smaller argument. The others follow, because first derivatives have degree 0.
    curvature = 2.0 / math.pi * integral / larger
    mixed, by_larger = -ratio * curvature, m * curvature
    return (by_larger, mixed, curvature) if slip > rim else (curvature, mixed, by_larger)


def _series(coefficients: Sequence[float], m: float) -> float:
    value = 0.0
    for coefficient in coefficients:
        value = value * m + coefficient
    return value


def _hypergeometric(a: float, b: float) -> tuple[float, ...]:
    coefficients = [1.0]
    for n in range(TERMS - 1):
        coefficients.append(coefficients[-1] * (a + n) * (b + n) / ((n + 2) * (n + 1)))
    return tuple(reversed(coefficients))


_B_SERIES = _hypergeometric(0.5, 0.5)  # B = (π/4)·F(½, ½; 2; m)
_D_SERIES = _hypergeometric(0.5, 1.5)  # D = (π/4)·F(½, 3/2; 2; m)
