"""Coefficients of friction over the slip speed: a table, and a peak at rest."""

from __future__ import annotations

import math
from bisect import bisect_right
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
from scipy.interpolate import PchipInterpolator

ROUNDING = 0.01
"""Of the edge of ``peak_over_sliding``, so that its slope is finite there: 50 times that of a fall along a line."""


def peak_over_sliding(share: float, static_ratio: float) -> float:
    """Return by how much friction exceeds that of sliding: ``static_ratio`` up to P/ε = ``share`` = 1, 1 from 2 on.

    Between it falls like a root of P/ε − 1. A law that leaves its peak along a line gets away from it by exponential
    growth, which takes the time ε·ln(1/ε); along a root it takes the time ε.
    """
    if share <= 1.0:
        return static_ratio
    if share >= 2.0:
        return 1.0
    way = math.sqrt(share - 1.0 + ROUNDING**2) - ROUNDING
    return static_ratio - (static_ratio - 1.0) * way / (math.sqrt(1.0 + ROUNDING**2) - ROUNDING)


def curve_of_table(name: str, table: Any) -> Callable[..., float]:
    """Return a coefficient as a function of ``slip_speed`` (m/s) from rows of a slip speed and its coefficient.

    It goes through all rows, smoothly and without overshoot (Fritsch & Butland, SIAM J. Sci. Stat. Comput. 5 (1984)
    300, by SciPy's ``PchipInterpolator``), and stays at the last one beyond.

    Raises ``ValueError`` if it is no such table.
    """
    speeds, values = _checked_table(name, table)
    curve = PchipInterpolator(speeds, values)
    starts, rows = speeds.tolist(), curve.c.T.tolist()
    last, end = starts[-1], float(values[-1])

    def coefficient(slip_speed: float) -> float:
        if slip_speed >= last:
            return end
        i = bisect_right(starts, slip_speed) - 1
        a, b, c, d = rows[i]
        way = slip_speed - starts[i]
        return float(((a * way + b) * way + c) * way + d)

    return coefficient


def _checked_table(name: str, table: Sequence[Sequence[float]]) -> tuple[Any, Any]:
    rule = "it must be two or more rows [slip speed in m/s, coefficient >= 0], the first at 0 m/s"
    try:
        rows = np.array(table, dtype=float)
    except (TypeError, ValueError):
        raise ValueError(f"{name} = {table!r}: {rule}") from None
    if rows.ndim != 2 or rows.shape[1:] != (2,) or len(rows) < 2 or rows[0, 0] != 0.0:
        raise ValueError(f"{name} = {rows.tolist()}: {rule}")
    if not np.isfinite(rows).all() or rows[:, 1].min() < 0.0:
        raise ValueError(f"{name} = {rows.tolist()}: all numbers must be finite and >= 0")
    if np.diff(rows[:, 0]).min() <= 0.0:
        raise ValueError(f"{name} = {rows.tolist()}: slip speeds must grow from row to row")
    return rows[:, 0], rows[:, 1]
