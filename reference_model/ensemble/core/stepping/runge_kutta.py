"""One step of Dormand and Prince's method of eighth order, with the coefficients of SciPy's DOP853."""

import math
from collections.abc import Callable, Sequence
from functools import reduce
from typing import Any, TypeVar

import numba
from scipy.integrate import DOP853

from reference_model.core.single import LEAST
from reference_model.ensemble.core.jit import inlined

intrinsic: Any = numba.extending.intrinsic  # not fully typed
types: Any = numba.types

Tuple = tuple[float, ...]
Constants = TypeVar("Constants")


def _without_zeros(row: Sequence[float]) -> Tuple:
    return tuple(float(value) for value in row if value != 0.0)


A2, A3, A4, A5, A6, A7, A8, A9, A10, A11, A12 = (_without_zeros(DOP853.A[i, :i]) for i in range(1, 12))
B = _without_zeros(DOP853.B)
E3, E5 = _without_zeros(DOP853.E3), _without_zeros(DOP853.E5)
"""Weights of the step, and of its differences from the embedded methods of orders 3 and 5."""

TURNED_BACK = 256.0
"""Error assigned to a step whose slip turns by more than a right angle, which halves the next trial.

The error estimate would accept errors of a hundred tolerances.
"""

LOCAL = 0.1
"""Tolerance of a step as a share of the motion's tolerance."""

SMALLEST_FACTOR, LARGEST_FACTOR, CAUTION = 0.2, 10.0, 0.9
"""Bounds on the ratio of successive steps, and safety factor."""


def tolerance_of_steps(tolerance: float) -> float:
    return max(LOCAL * tolerance, LEAST)


# Machine instructions, one per term: loops over tuples would not become branch-free code.


@intrinsic  # type: ignore[untyped-decorator]
def weighted(context: Any, weights: Any, rates: Any) -> tuple[Any, Callable[..., Any]]:
    """Return Σ weights[j]·rates[j] of every unknown."""
    size = len(rates[0])

    def sums(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        return _packed(
            context, builder, signature, _sums(builder, *arguments, stages=len(weights), size=size)
        )

    return types.UniTuple(types.float64, size)(weights, rates), sums


@intrinsic  # type: ignore[untyped-decorator]
def moved(context: Any, y: Any, h: Any, weights: Any, rates: Any) -> tuple[Any, Callable[..., Any]]:
    """Return y + h·Σ weights[j]·rates[j], where rates may be longer than y."""
    size = len(y)

    def sums(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        before, step, *others = arguments
        ends = [
            builder.fadd(builder.extract_value(before, v), builder.fmul(step, change))
            for v, change in enumerate(_sums(builder, *others, stages=len(weights), size=size))
        ]
        return _packed(context, builder, signature, ends)

    return types.UniTuple(types.float64, size)(y, types.float64, weights, rates), sums


def _sums(builder: Any, weights: Any, rates: Any, *, stages: int, size: int) -> list[Any]:
    sums = []
    for v in range(size):
        terms = [
            builder.fmul(builder.extract_value(weights, j), builder.extract_value(rates, (j, v)))
            for j in range(stages)
        ]
        sums.append(reduce(builder.fadd, terms))
    return sums


def _packed(context: Any, builder: Any, signature: Any, values: list[Any]) -> Any:
    return context.make_tuple(builder, signature.return_type, values)


@inlined
def step(
    rates: Callable[[Tuple, Constants], Tuple], law: Constants, y: Tuple, k1: Tuple, h: float
) -> tuple[Tuple, Tuple, Tuple]:
    """Return the mean rates over a step of ``h`` from ``y``, and their differences from the rates of lower order.

    ``rates(y, law)`` returns the rates of ``y``, perhaps followed by other numbers. ``k1`` are the rates at ``y``.
    """
    k2 = rates(moved(y, h, A2, (k1,)), law)
    k3 = rates(moved(y, h, A3, (k1, k2)), law)
    k4 = rates(moved(y, h, A4, (k1, k3)), law)
    k5 = rates(moved(y, h, A5, (k1, k3, k4)), law)
    k6 = rates(moved(y, h, A6, (k1, k4, k5)), law)
    k7 = rates(moved(y, h, A7, (k1, k4, k5, k6)), law)
    k8 = rates(moved(y, h, A8, (k1, k4, k5, k6, k7)), law)
    k9 = rates(moved(y, h, A9, (k1, k4, k5, k6, k7, k8)), law)
    k10 = rates(moved(y, h, A10, (k1, k4, k5, k6, k7, k8, k9)), law)
    k11 = rates(moved(y, h, A11, (k1, k4, k5, k6, k7, k8, k9, k10)), law)
    k12 = rates(moved(y, h, A12, (k1, k4, k5, k6, k7, k8, k9, k10, k11)), law)
    ks = (k1, k6, k7, k8, k9, k10, k11, k12)
    return weighted(B, ks), weighted(E3, ks), weighted(E5, ks)


@inlined
def error_of(y: Tuple, new: Tuple, h: float, third: Tuple, fifth: Tuple, tolerance: float) -> float:
    """Return Hairer's error estimate relative to the tolerance, absolute for unknowns below 1."""
    high = low = 0.0
    for v in range(len(y)):
        size = 1.0 + max(abs(y[v]), abs(new[v]))
        high += (fifth[v] / size) ** 2
        low += (third[v] / size) ** 2
    return h * high / (math.sqrt((high + 0.01 * low) * len(y) + 1e-300) * tolerance)


@inlined
def factor_of(error: float) -> float:
    """Return the factor for the next step, error^(−1/8) within bounds."""
    root = math.sqrt(math.sqrt(math.sqrt(max(error, 1e-30))))
    factor = min(max(CAUTION / root, SMALLEST_FACTOR), LARGEST_FACTOR)
    return factor if error < 1e300 else SMALLEST_FACTOR
