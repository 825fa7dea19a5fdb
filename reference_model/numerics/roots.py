"""All zeros of a function of one variable on an interval."""

from collections.abc import Callable, Iterator

import numpy as np
from scipy.optimize import brentq, minimize_scalar

from reference_model.systems import FloatArray

NODES = 121
REACH = 3.25  # the outermost nodes are about 1e-17 of the interval from its ends

FLAT = 1e-13
"""Relative change between nodes that rounding alone may cause."""


def nodes_between(left: float, right: float) -> FloatArray:
    """Return the nodes of tanh-sinh quadrature in [left, right], at most NODES + 2, dense towards both ends."""
    part = 1.0 / (1.0 + np.exp(np.pi * np.sinh(np.linspace(REACH, -REACH, NODES))))
    # Measured from the nearer end, so that the distance to it keeps all its digits.
    inner = np.where(part < 0.5, left + (right - left) * part, right - (right - left) * part[::-1])
    return np.unique(np.concatenate(([left], inner, [right])))


def zeros_between(function: Callable[[float], float], left: float, right: float) -> list[float]:
    """Return the zeros of a continuous ``function`` on [left, right] in increasing order.

    A zero shows as a change of sign between two of the :func:`nodes_between`, or in a dip towards zero. Only two dips
    between three neighbouring nodes could hide zeros. Neighbouring nodes that are zeros count as one zero.
    """
    return sorted(set(_zeros(function, nodes_between(left, right).tolist())))


def zero_between(function: Callable[[float], float], left: float, right: float) -> float:
    """Return the zero of a continuous ``function`` that changes its sign once on [left, right]."""
    return float(brentq(function, left, right, xtol=1e-300, rtol=4.0 * np.finfo(float).eps, maxiter=2000))


def largest_between(function: Callable[[float], float], left: float, right: float) -> float:
    """Return the largest value of a continuous ``function`` on [left, right]."""
    nodes = nodes_between(left, right).tolist()
    values = [function(node) for node in nodes]
    best = int(np.argmax(values))
    top = _bottom(function, nodes[max(best - 1, 0)], nodes[min(best + 1, len(nodes) - 1)], -1.0)
    return max(values[best], function(top))


def _zeros(function: Callable[[float], float], nodes: list[float]) -> Iterator[float]:
    values = [function(node) for node in nodes]
    last = len(nodes) - 1
    for i, value in enumerate(values):
        before, after = max(i - 1, 0), min(i + 1, last)
        if value == 0.0:
            if i == 0 or values[before] != 0.0:
                yield _zero_of_run(nodes, values, i)
            continue
        sign = 1.0 if value > 0.0 else -1.0
        if sign * values[after] < 0.0:
            yield zero_between(function, nodes[i], nodes[after])
        rises = [sign * (values[j] - value) for j in (before, after)]
        if min(rises) >= 0.0 and max(rises) > FLAT * abs(value):
            bottom = _bottom(function, nodes[before], nodes[after], sign)
            if sign * function(bottom) < 0.0:
                yield zero_between(function, nodes[before], bottom)
                yield zero_between(function, bottom, nodes[after])


def _zero_of_run(nodes: list[float], values: list[float], first: int) -> float:
    """Return one zero of the run of zeros from node ``first`` on: an end of the interval, or else the middle."""
    last = next((i for i in range(first, len(nodes)) if values[i] != 0.0), len(nodes)) - 1
    if first == 0:
        return nodes[0]
    return nodes[last] if last == len(nodes) - 1 else nodes[(first + last) // 2]


def _bottom(function: Callable[[float], float], left: float, right: float, sign: float) -> float:
    found = minimize_scalar(
        lambda x: sign * function(x),
        bounds=(left, right),
        method="bounded",
        options={"xatol": 1e-9 * (right - left)},
    )
    return float(found.x)
