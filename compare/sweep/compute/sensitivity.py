"""Sobol indices of results for uncertain quantities (Saltelli et al. 2010), computed block by block."""

import math
from collections.abc import Sequence
from functools import reduce
from typing import NamedTuple

import numpy as np

from compare.claims.shares import CONFIDENCE
from compare.sweep.plan import BASES
from reference_model.systems import FloatArray

GROUPS = 16  # groups of rows, whose scatter gives the error of the indices
LEAST_SAMPLES = 16 * GROUPS


class Indices(NamedTuple):
    """Sobol indices of shape (results, quantities), and half the widths of their confidence intervals.

    The first-order index is the share of the variance that vanishes if the quantity is known, the total index the
    share that remains if only the others are known. Both are NaN without variance.
    """

    first: FloatArray
    total: FloatArray
    first_error: FloatArray
    total_error: FloatArray


class Moments(NamedTuple):
    """Contribution of a block of rows to the indices.

    For the results f_A and f_B of both draws, shape (results,): the number of rows, the ``mean``, the sum of
    ``squares`` of deviations from it; ``least`` and ``largest`` include the mixtures. With the results f_M of the
    mixtures, shape (results, quantities): sums of (f_B − mean)(f_M − f_A), of f_M − f_A and of its square.
    """

    rows: int
    mean: FloatArray
    squares: FloatArray
    least: FloatArray
    largest: FloatArray
    product: FloatArray
    change: FloatArray
    change_squared: FloatArray


def moments(results: FloatArray) -> Moments:
    """Return the moments of ``results``, shape (results, rows, 2 + quantities)."""
    bases, change = results[..., :BASES], results[..., BASES:] - results[..., :1]
    mean = np.mean(bases, axis=(1, 2))
    deviations = bases - mean[:, np.newaxis, np.newaxis]
    return Moments(
        rows=results.shape[1],
        mean=mean,
        squares=np.sum(deviations**2, axis=(1, 2)),
        least=np.min(results, axis=(1, 2)),
        largest=np.max(results, axis=(1, 2)),
        product=np.sum(deviations[..., 1:] * change, axis=1),
        change=np.sum(change, axis=1),
        change_squared=np.sum(change**2, axis=1),
    )


def indices(blocks: Sequence[Moments]) -> Indices:
    """Return the indices from ordered blocks of equal size; ``GROUPS`` divides their number."""
    size = len(blocks) // GROUPS
    grouped = [reduce(_together, blocks[i * size : (i + 1) * size]) for i in range(GROUPS)]
    of_groups = np.array([_indices(group) for group in grouped])
    whole = reduce(_together, grouped)
    first, total = _indices(whole)
    from scipy.stats import t  # slow import

    width = t.ppf(0.5 + 0.5 * CONFIDENCE, GROUPS - 1) / math.sqrt(GROUPS)
    errors = width * np.std(of_groups, axis=0, ddof=1)
    varies = whole.largest > whole.least
    for array in (first, total, *errors):
        array[~varies] = np.nan
    return Indices(first, total, errors[0], errors[1])


def _together(one: Moments, other: Moments) -> Moments:
    """Return the moments of all rows (Chan, Golub and LeVeque 1983)."""
    rows = one.rows + other.rows
    apart = other.mean - one.mean
    mean = one.mean + apart * (other.rows / rows)
    return Moments(
        rows=rows,
        mean=mean,
        squares=one.squares + other.squares + BASES * apart**2 * (one.rows * other.rows / rows),
        least=np.minimum(one.least, other.least),
        largest=np.maximum(one.largest, other.largest),
        product=_about(one, mean) + _about(other, mean),
        change=one.change + other.change,
        change_squared=one.change_squared + other.change_squared,
    )


def _about(of: Moments, mean: FloatArray) -> FloatArray:
    """Return the sum of (f_B − ``mean``)(f_M − f_A) of these rows, for a ``mean`` of more rows."""
    return of.product + (of.mean - mean)[:, np.newaxis] * of.change


def _indices(of: Moments) -> tuple[FloatArray, FloatArray]:
    variance = of.squares[:, np.newaxis] / BASES
    with np.errstate(divide="ignore", invalid="ignore"):  # results that do not vary
        return of.product / variance, 0.5 * of.change_squared / variance
