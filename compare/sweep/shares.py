"""How large a share of the starts ends as what, and between which bounds it lies."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from scipy.special import ndtri

from compare.sweep.refinement import Ends, mixed
from reference_model.ensemble import EndState

CONFIDENCE = 0.95

SAMPLE = (
    f"Wilson's interval of {100.0 * CONFIDENCE:g} % for independent starts; what is undecided may be any end"
)
GRID = (
    "from the cells of which all corners end like this to those of which one does (or is undecided), as parts of the "
    "area: a bound as long as the boundary passes only through cells whose corners differ"
)


class Share(NamedTuple):
    """A share between 0 and 1, and its bounds."""

    value: float
    low: float
    high: float


def of_sample(ends: Ends) -> dict[EndState, Share]:
    """Return the shares among independent random starts of the ends ``ends``, shape (n,)."""
    counts = {end: int(np.count_nonzero(ends == end)) for end in EndState}
    doubtful = counts[EndState.UNDECIDED]
    shares = {}
    for end, count in counts.items():
        most = count if end == EndState.UNDECIDED else count + doubtful
        low, high = _wilson(count, ends.size)[0], _wilson(most, ends.size)[1]
        shares[end] = Share(count / ends.size, low, high)
    return shares


def _wilson(count: int, n: int) -> tuple[float, float]:
    """Return the probabilities whose expectation lies within z standard deviations of ``count`` out of ``n``.

    E. B. Wilson 1927; as ``scipy.stats.binomtest`` has it, without the time that it takes to load.
    """
    z = float(ndtri(0.5 + 0.5 * CONFIDENCE))
    middle = count + 0.5 * z**2
    half = z * math.sqrt(count * (n - count) / n + 0.25 * z**2)
    return (middle - half) / (n + z**2), (middle + half) / (n + z**2)


def of_grid(ends: Ends) -> dict[EndState, Share]:
    """Return the shares of a rectangle's area from the ends on a grid that covers it, shape (y, x).

    The value counts each corner of a cell as a quarter of it.
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


def _corners(chosen: np.ndarray) -> np.ndarray:
    """Return how many corners of each cell are chosen."""
    one = chosen.astype(np.uint8)
    result: np.ndarray = one[:-1, :-1] + one[1:, :-1] + one[:-1, 1:] + one[1:, 1:]
    return result
