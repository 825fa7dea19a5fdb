"""The same question at ever smaller tolerances or steps, and what the answers tend to."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from compare.claims.error_estimates import ROUNDING
from compare.engines import COARSENING, USUAL_TOLERANCE, Engine
from reference_model.systems import FloatArray

RUNGS = 4
"""Of a ladder, for every engine and on every machine: what one costs depends on neither."""

HALVED = 2.0
"""Ratio of fixed steps from rung to rung."""

SAFETY = 3.0
"""Error of the finest rung over its change. Of a first order and halved steps that is three times the error."""


def tolerances(engine: Engine) -> FloatArray:
    """Return the tolerances of the rungs, from the largest, shape (RUNGS,); the last one is the usual."""
    factor = COARSENING if engine.step is None else HALVED**engine.root
    return USUAL_TOLERANCE * factor ** np.arange(RUNGS - 1, -1, -1.0)


@dataclass(frozen=True, eq=False)
class Ladder:
    """Answers to one question, an array of numbers at each rung, shape (RUNGS, ...)."""

    values: FloatArray

    @classmethod
    def of(cls, engine: Engine, question: Callable[[float], ArrayLike]) -> Ladder:
        """Ask ``question(tolerance)`` at each rung."""
        return cls(np.array([question(tolerance) for tolerance in tolerances(engine).tolist()], dtype=float))

    @property
    def finest(self) -> FloatArray:
        """The answer at the finest rung, shape (...)."""
        return np.asarray(self.values[-1])

    @property
    def error(self) -> FloatArray:
        """What the finest answer may be off what the answers tend to, shape (...), never less than rounding."""
        change = np.max(np.abs(np.diff(self.values[-3:], axis=0)), axis=0)
        return np.asarray(SAFETY * change + ROUNDING * np.max(np.abs(self.finest), initial=0.0))


def step_ratio(engine: Engine) -> float:
    """Return by how much what is called a step falls from rung to rung: the tolerance, where none is fixed."""
    return COARSENING if engine.step is None else HALVED
