"""Coefficients of friction as functions of the slip speed: a table, and a peak at rest."""

import math
from collections.abc import Sequence
from typing import Any

import numpy as np

from exudyn_models.forces.jit import compiled
from exudyn_models.forces.laws.calls import number_at
from reference_model.systems import FloatArray, finite_numbers

ROUNDING = 0.01
"""Rounding of the edge of ``peak_over_sliding``, which limits its slope to 50 times the slope of a linear fall."""

COLUMNS = 3
"""Columns of ``curve_of_table``: slip speed and coefficient at the start of a piece, and its slope."""


@compiled
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


def curve_of_table(name: str, table: Any) -> FloatArray:
    """Return the pieces of a coefficient curve, shape (n, ``COLUMNS``), from rows of slip speed and coefficient.

    The coefficient is linear between the rows and beyond the last row, like Modelica's ``mu_pos``, but not below 0.
    Raises ``ValueError`` if the table is invalid.
    """
    speeds, values = _checked_table(name, table)
    slopes = np.diff(values) / np.diff(speeds) if len(speeds) > 1 else np.zeros(1)
    return np.column_stack((speeds[: len(slopes)], values[: len(slopes)], slopes))


@compiled
def coefficient_of_curve(address: float, pieces: float, slip_speed: float) -> float:
    """Return the coefficient at a slip speed >= 0 (m/s); ``pieces`` is the number of pieces at ``address``."""
    first, last = 0, int(pieces) - 1
    while first < last:  # first <= piece <= last
        middle = (first + last + 1) // 2
        if number_at(address, middle * COLUMNS) <= slip_speed:
            first = middle
        else:
            last = middle - 1
    start = first * COLUMNS
    way = slip_speed - number_at(address, start)
    return max(0.0, float(number_at(address, start + 1) + number_at(address, start + 2) * way))


def _checked_table(name: str, table: Sequence[Sequence[float]]) -> tuple[Any, Any]:
    rule = "it must be rows [slip speed in m/s, coefficient >= 0], the first at 0 m/s"
    rows = finite_numbers(name, table)
    if rows.ndim != 2 or rows.shape[1:] != (2,) or len(rows) < 1 or rows[0, 0] != 0.0:
        raise ValueError(f"{name} = {rows.tolist()}: {rule}")
    if rows[:, 1].min() < 0.0:
        raise ValueError(f"{name} = {rows.tolist()}: all numbers must be >= 0")
    if (np.diff(rows[:, 0]) <= 0.0).any():
        raise ValueError(f"{name} = {rows.tolist()}: slip speeds must increase")
    return rows[:, 0], rows[:, 1]
