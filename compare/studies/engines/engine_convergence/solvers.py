"""Exudyn's solvers at a fixed step: their declared orders, and how they are drawn."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from compare.output.figures import BLUE, GREEN, ORANGE, PURPLE


@dataclass(frozen=True)
class Solver:
    """One of Exudyn's solvers at a fixed step: declared order, steps in s, and how it is drawn.

    ``sticks`` says whether its work is shown for a motion with stick phases too.
    """

    name: str
    order: int
    steps: tuple[float, ...]
    look: Mapping[str, Any]
    sticks: bool = False


SOLVERS = (
    Solver(
        "RK44",
        4,
        (0.4, 0.2, 0.1, 0.05, 0.025),
        {"color": BLUE, "marker": "o", "markersize": 6.0},
        sticks=True,
    ),
    Solver("RK67", 6, (0.8, 0.4, 0.2, 0.1, 0.05), {"color": GREEN, "marker": "s", "markersize": 5.5}),
    Solver(
        "GeneralizedAlpha",
        2,
        (0.4, 0.2, 0.1, 0.05, 0.025),
        {"color": ORANGE, "marker": "^", "markersize": 8.0},
        sticks=True,
    ),
    Solver(
        "TrapezoidalIndex2",
        2,
        (0.4, 0.2, 0.1, 0.05, 0.025),
        {"color": PURPLE, "marker": "x", "markersize": 4.5},
    ),
)
