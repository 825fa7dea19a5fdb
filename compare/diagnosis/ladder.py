"""Convergence of a quantity at successively smaller tolerances or steps."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from compare.claims.error_estimates import ROUNDING
from compare.engines import COARSENING, USUAL_TOLERANCE, Engine
from reference_model.systems import FloatArray

RUNGS = 4
HALVED = 2.0

SAFETY = 3.0
"""Ratio of the error estimate to the last change: three times the error for first order and halved steps."""


def tolerances(engine: Engine) -> FloatArray:
    """Return the tolerances of the rungs, shape (RUNGS,), down to the default."""
    factor = COARSENING if engine.step is None else HALVED**engine.root
    return USUAL_TOLERANCE * factor ** np.arange(RUNGS - 1, -1, -1.0)


@dataclass(frozen=True, eq=False)
class Ladder:
    """Values of one quantity at each rung, shape (RUNGS, ...)."""

    values: FloatArray

    @classmethod
    def of(cls, engine: Engine, question: Callable[[float], ArrayLike]) -> Ladder:
        """Evaluate ``question(tolerance)`` at each rung."""
        return cls(np.array([question(tolerance) for tolerance in tolerances(engine).tolist()], dtype=float))

    @property
    def finest(self) -> FloatArray:
        """Value at the finest rung, shape (...)."""
        return np.asarray(self.values[-1])

    @property
    def error(self) -> FloatArray:
        """Estimated distance of the finest value from the limit."""
        change = np.max(np.abs(np.diff(self.values[-3:], axis=0)), axis=0)
        return np.asarray(SAFETY * change + ROUNDING * np.max(np.abs(self.finest), initial=0.0))


def step_ratio(engine: Engine) -> float:
    """Return the ratio of steps, or of tolerances, from rung to rung."""
    return COARSENING if engine.step is None else HALVED


def falling(sizes: Sequence[float] | FloatArray, ratio: float) -> float:
    """Return the order from the last two ``sizes`` and the ``ratio`` of their steps, or NaN."""
    if len(sizes) < 2 or not (0.0 < sizes[-2] < math.inf and 0.0 < sizes[-1] < math.inf):
        return math.nan
    return math.log(sizes[-2] / sizes[-1]) / math.log(ratio)
