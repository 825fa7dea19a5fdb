"""Coefficients of friction as functions of the slip speed: a table, and a peak at rest."""

import math
from bisect import bisect_right
from collections.abc import Callable, Sequence
from itertools import pairwise
from typing import Any

import numpy as np

from reference_model.systems import FloatArray, finite_numbers

ROUNDING = 0.01
"""Rounding of the edge of ``peak_over_sliding``, which limits its slope to 50 times the slope of a linear fall."""


def peak_over_sliding(share: float, static_ratio: float) -> float:
    """Return friction divided by sliding friction: ``static_ratio`` up to P/ε = ``share`` = 1, and 1 from 2 on.

    In between it falls like a square root of P/ε − 1, so a contact leaves the peak in the time ε; a linear fall would
    take ε·ln(1/ε).
    """
    if share <= 1.0:
        return static_ratio
    if share >= 2.0:
        return 1.0
    way = math.sqrt(share - 1.0 + ROUNDING**2) - ROUNDING
    return static_ratio - (static_ratio - 1.0) * way / (math.sqrt(1.0 + ROUNDING**2) - ROUNDING)


def curve_of_table(name: str, table: Any) -> Callable[[float], float]:
    """Return the coefficient as a function of the slip speed >= 0 (m/s), from rows of slip speed and coefficient.

    The coefficient is linear between the rows and beyond the last row, like Modelica's ``mu_pos``, but not below 0.
    Raises ``ValueError`` if the table is invalid.
    """
    rows = _checked_table(name, table)
    speeds, values = rows.T.tolist()
    slopes = [(w - u) / (v - t) for (t, u), (v, w) in pairwise(rows.tolist())] or [0.0]

    def coefficient(slip_speed: float) -> float:
        piece = min(bisect_right(speeds, slip_speed), len(slopes)) - 1
        return max(0.0, float(values[piece] + slopes[piece] * (slip_speed - speeds[piece])))

    return coefficient


def _checked_table(name: str, table: Sequence[Sequence[float]]) -> FloatArray:
    rule = "it must be rows [slip speed in m/s, coefficient >= 0], the first at 0 m/s"
    rows = finite_numbers(name, table)
    if rows.ndim != 2 or rows.shape[1:] != (2,) or len(rows) < 1 or rows[0, 0] != 0.0:
        raise ValueError(f"{name} = {rows.tolist()}: {rule}")
    if rows[:, 1].min() < 0.0:
        raise ValueError(f"{name} = {rows.tolist()}: all numbers must be >= 0")
    if (np.diff(rows[:, 0]) <= 0.0).any():
        raise ValueError(f"{name} = {rows.tolist()}: slip speeds must increase")
    return rows
