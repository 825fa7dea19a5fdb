"""Claims of yes or no where a study still makes its claims by hand."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from compare.claims.claim import ErrorBudget
from compare.claims.measured import answers_of, asked

__all__ = ["asked", "holds"]


def holds(margins: ArrayLike, errors: ArrayLike = 0.0, *, may_be_open: int = 0) -> dict[str, Any]:
    """Return what a ``Claim`` takes of ``answers_of``."""
    found = answers_of(margins, errors, may_be_open=may_be_open)
    budget = ErrorBudget(found.error, resolution=float(found.resolution or np.nan))
    return {"predicted": found.predicted, "measured": found.value, "budget": budget, "answers": True}
