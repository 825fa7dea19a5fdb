"""Shares of initial states by their end states, with bounds."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from reference_model.ensemble import EndState

Ends = NDArray[np.uint8]
BoolArray = NDArray[np.bool_]
IntArray = NDArray[np.int64]

CONFIDENCE = 0.95

SAMPLE = (
    f"Wilson's interval of {100.0 * CONFIDENCE:g} % for independent initial states; "
    "undecided ones may have any end state"
)
GRID = (
    "fractions of the area: cells with this end state at all corners, to cells with at least one such or undecided "
    "corner; valid bounds if the boundary passes only through cells with different corners"
)


class Share(NamedTuple):
    """A share between 0 and 1, and its bounds."""

    value: float
    low: float
    high: float


def counted(ends: Ends) -> IntArray:
    """Return the number of each end state."""
    return np.bincount(ends.ravel(), minlength=len(EndState))


def of_sample(ends: Ends) -> dict[EndState, Share]:
    """Return the shares of end states (shape (n,)) of random starts."""
    return of_counts(counted(ends))


def of_counts(counts: IntArray) -> dict[EndState, Share]:
    """Return the shares of random starts from the number of each end state."""
    total, doubtful = int(np.sum(counts)), int(counts[EndState.UNDECIDED])
    shares = {}
    for end in EndState:
        count = int(counts[end])
        shares[end] = of_count(count, total, 0 if end == EndState.UNDECIDED else doubtful)
    return shares


def of_count(count: int, total: int, doubtful: int = 0) -> Share:
    """Return the share of ``count`` among ``total`` random starts; ``doubtful`` more may count."""
    from scipy.stats import binomtest  # slow import

    low, high = (
        binomtest(k, total).proportion_ci(CONFIDENCE, method="wilson") for k in (count, count + doubtful)
    )
    return Share(count / total, float(low.low), float(high.high))


def of_grid(ends: Ends) -> dict[EndState, Share]:
    """Return the shares of a rectangle's area from the end states on a grid over it, shape (y, x).

    Each corner counts for a quarter of its cell.
    """
    uniform = ~mixed(ends)
    doubtful = _corners(ends == EndState.UNDECIDED) > 0
    shares = {}
    for end in EndState:
        corners = _corners(ends == end)
        possible = (corners > 0) | (doubtful if end != EndState.UNDECIDED else False)
        shares[end] = Share(
            float(np.mean(corners)) / 4.0,
            float(np.mean(uniform & (corners == 4))),
            float(np.mean(possible)),
        )
    return shares


def mixed(ends: Ends) -> BoolArray:
    """Return a mask of the cells with different corners, one shorter than ``ends`` along each axis."""
    corner = ends[:-1, :-1]
    result: BoolArray = (corner != ends[1:, :-1]) | (corner != ends[:-1, 1:]) | (corner != ends[1:, 1:])
    return result


def _corners(chosen: np.ndarray) -> np.ndarray:
    one = chosen.astype(np.uint8)
    result: np.ndarray = one[:-1, :-1] + one[1:, :-1] + one[:-1, 1:] + one[1:, 1:]
    return result
