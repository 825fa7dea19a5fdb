"""Small deviations from a steady motion: what is left of them."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from reference_model.systems import FloatArray


def remaining_transient(earlier: ArrayLike, end: ArrayLike, rate: float, delay: float) -> FloatArray:
    """Return how far ``end`` can still be from the steady state that it decays to.

    A deviation a·exp(−rt) changes by a·(exp(r·delay) − 1) in the last ``delay`` seconds, a being its size at
    the end. So the change that is seen gives what is left.

    Parameters
    ----------
    earlier : array of shape (n, ...)
        The quantity over a period of its oscillation that ends ``delay`` seconds before the end: the largest
        change from there counts.
    end : array of shape (...)
        The quantity at the end.
    rate : float
        Decay rate r in 1/s of the slowest mode.
    delay : float
        In s.

    """
    change = np.max(np.abs(np.asarray(earlier) - np.asarray(end)), axis=0)
    return np.asarray(change / np.expm1(rate * delay))
