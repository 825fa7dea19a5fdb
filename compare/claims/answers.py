"""Claims of yes or no: how many of n answers are yes, and which of them an engine's own error leaves open."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from compare.claims.claim import ErrorBudget
from compare.claims.error_estimates import COARSENING, change_as_error
from reference_model.systems import FloatArray

ONE = 0.5
"""Resolution of a count of which no answer may be open."""


def holds(margins: ArrayLike, errors: ArrayLike = 0.0, *, may_be_open: int = 0) -> dict[str, Any]:
    """Return what a ``Claim`` takes that is to hold in all of n cases: it differs where one is surely no.

    It is inconclusive where none is, but more than ``may_be_open`` are too close to tell.

    Parameters
    ----------
    margins : array of n numbers or truth values
        By how much each quantity is on the right side of its threshold, in any unit; a number that is missing is no.
    errors : array that fits to it
        What each margin can be off; not a number where an engine gave none to estimate it from, which is a no.
    may_be_open : int
        How many answers may be open in a claim that still says something.

    """
    margins, errors = np.broadcast_arrays(_as_numbers(margins), np.asarray(errors, dtype=float))
    yes, unsure = margins > errors, np.abs(margins) <= errors
    return {
        "predicted": float(margins.size),
        "measured": float(np.count_nonzero(yes)),
        "budget": ErrorBudget(float(np.count_nonzero(unsure)), resolution=may_be_open + ONE),
        "answers": True,
    }


def asked(question: Callable[[float], ArrayLike], tolerance: float) -> tuple[FloatArray, FloatArray]:
    """Return the margins, see ``holds``, that an engine gives at ``tolerance``, and their errors.

    The error is estimated as in ``compare.claims.error_estimates.refined``, but from the smaller tolerance only. An
    answer without a margin, yes or no, is open if it changes.
    """
    found, finer = (_as_numbers(question(asked_at)) for asked_at in (tolerance, tolerance / COARSENING))
    return found, change_as_error(found, finer)


def _as_numbers(margins: ArrayLike) -> FloatArray:
    """Return margins; those of truth values are 1 and −1."""
    found = np.asarray(margins)
    return np.where(found, 1.0, -1.0) if found.dtype == np.bool_ else found.astype(float)
