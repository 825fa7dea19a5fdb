"""Which uncertain quantity an uncertain result depends on: Sobol's indices by SciPy."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from scipy.stats import sobol_indices, t

from compare.claims.shares import CONFIDENCE
from compare.sweep.define.plan import BASES
from reference_model.systems import FloatArray

GROUPS = 16
"""Of rows: the scatter of the indices among them gives their error."""

LEAST_SAMPLES = 16 * GROUPS
"""Of rows."""


class Indices(NamedTuple):
    """Sobol's indices, each of shape (results, quantities), and half of the width of their intervals.

    The first order is the part of the variance that would be gone if the quantity were known; the total order is
    the part that would be left if all others were. NaN where the result does not vary.
    """

    first: FloatArray
    total: FloatArray
    first_error: FloatArray
    total_error: FloatArray


def indices(results: FloatArray) -> Indices:
    """Return the indices of ``results``, shape (results, rows, 2 + quantities), in the order of the plan.

    The number of rows is a power of 2, at least ``LEAST_SAMPLES``.
    """
    first, total = _indices(results)
    groups = np.array([_indices(group) for group in np.split(results, GROUPS, axis=1)])
    width = t.ppf(0.5 + 0.5 * CONFIDENCE, GROUPS - 1) / math.sqrt(GROUPS)
    errors = width * np.std(groups, axis=0, ddof=1)
    varies = np.ptp(results, axis=(1, 2)) > 0.0
    for array in (first, total, *errors):
        array[~varies] = np.nan
    return Indices(first, total, errors[0], errors[1])


def _indices(results: FloatArray) -> tuple[FloatArray, FloatArray]:
    f_a, f_b = results[..., 0], results[..., 1]
    f_ab = np.moveaxis(results[..., BASES:], -1, 0)
    found = sobol_indices(func={"f_A": f_a, "f_B": f_b, "f_AB": f_ab}, n=results.shape[1])
    shape = (results.shape[0], results.shape[2] - BASES)
    return found.first_order.reshape(shape), found.total_order.reshape(shape)
