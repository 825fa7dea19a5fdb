"""Numerical error of a measured quantity, and observed orders, estimated from the measurement itself."""

from __future__ import annotations

import math
import time
from collections.abc import Callable
from dataclasses import replace
from typing import NamedTuple, TypeVar

import numpy as np
from numpy.typing import ArrayLike
from scipy.special import stdtrit  # the quantile of Student's t, without the rest of scipy.stats

from compare.engines import COARSENING as COARSENING
from compare.engines import USUAL_TOLERANCE
from compare.engines.engine import Engine
from compare.output.outside_text import printable
from reference_model.systems import FloatArray

WORKING = USUAL_TOLERANCE
"""Tolerance at which an engine is asked, unless a study says why by a factor."""

TIGHTEST = 1e-12
"""The smallest tolerance that is asked of an engine or of shooting: an eighth of it is near to rounding."""

TRUTH = 1e-13
"""Tolerance of the reference where it stands for the exact motion."""

SAFETY = 8.0
"""Estimate of an error over the change to the result at the smaller tolerance.

With errors in proportion to the tolerance that is 8·(1 − 1/8) = 7 times the error, by construction. It covers the
error unless that of the other result is by chance as large, to within an eighth: also where errors fall slowly or
irregularly with the tolerance, as tolerance^(1/10), or from one of a few steps to the next. The change to a result at
a *larger* tolerance would be 7 times the error too; but it falls short wherever the other result is less than twice
as far off in place of 8 times, which is so in one number of twenty of the reference, and in one of fifty of Exudyn.
"""

COARSE = 1e-4
"""Relative error of states from which on what is read off them may come and go: a stick phase, a release."""

ROUNDING = 64.0 * np.finfo(float).eps
"""Relative error below which two runs may coincide by chance."""


class Measurement(NamedTuple):
    """A number, or an array of them, and the error of each."""

    value: FloatArray
    error: FloatArray

    @property
    def largest(self) -> float:
        """The largest error."""
        return float(np.max(self.error))

    @property
    def rows(self) -> FloatArray:
        """The largest error of each row (along the last axis), for all numbers of the row; of the errors' shape."""
        return np.broadcast_to(np.max(self.error, axis=-1, keepdims=True), self.error.shape)

    def plus(self, error: float | FloatArray) -> Measurement:
        """Return the same numbers with errors larger by ``error``, of any shape that fits."""
        return Measurement(self.value, np.asarray(self.error + error))


def refined(
    quantity: Callable[[float], ArrayLike], tolerance: float = WORKING, *, alike: bool = True
) -> Measurement:
    """Return ``quantity(tolerance)`` and an estimate of its error, of the same shape.

    The estimate is ``SAFETY`` times the change against ``quantity(tolerance / COARSENING)``, and never less than the
    largest change in its row (along the last axis), if the numbers there are ``alike``, of one unit and size: one of
    several numbers may change by next to nothing by chance, but not all. Nor is it less than rounding. No engine
    takes notice of ever smaller tolerances: where that changes nothing at all, the change against the next larger
    tolerance that does counts in its place. How often the estimate covers the true error, and how far it lies above,
    the study "error-estimates" measures.
    """
    found = np.asarray(quantity(tolerance), dtype=float)
    for factor in (1.0 / COARSENING, COARSENING, COARSENING**2):
        other = np.asarray(quantity(factor * tolerance), dtype=float)
        if not np.array_equal(found, other, equal_nan=True):
            break
    return Measurement(found, change_as_error(found, other, alike=alike))


def known(values: ArrayLike, errors: ArrayLike) -> FloatArray:
    """Return ``errors``, infinite where they are no number although the value is one.

    Where the value is missing too they stay so: that is a mistake, and no doubt.
    """
    return np.where(np.isnan(errors) & np.isfinite(values), np.inf, errors)


def open_where_coarse(found: Measurement, states: Measurement) -> Measurement:
    """Return ``found`` with infinite errors of what is missing in it, if the ``states`` it is read off are coarse.

    Whether a body sticks once more, or when it is let go at last, may hang on less than they are off by.
    """
    coarse = states.largest > COARSE * float(np.max(np.abs(states.value)))
    missing = ~np.isfinite(found.value)
    return Measurement(found.value, np.where(missing & coarse, np.inf, found.error))


def change_as_error(found: FloatArray, other: FloatArray, *, alike: bool = True) -> FloatArray:
    """Return the error of ``found`` that is estimated from ``other``, see ``refined``; all of the same shape.

    It is infinite where only one of them has a number: what comes and goes with the tolerance is not known.
    """
    with np.errstate(invalid="ignore"):  # of two infinite numbers
        change = np.where(np.isfinite(found) ^ np.isfinite(other), np.inf, np.abs(other - found))
    numbers = np.where(np.isfinite(change), change, 0.0)
    largest = np.max(numbers, axis=-1, keepdims=True, initial=0.0) if alike and change.ndim > 0 else change
    rounding = ROUNDING * np.max(np.abs(found), where=np.isfinite(found), initial=0.0)
    return np.asarray(np.maximum(SAFETY * change, largest) + rounding)


def observed_exponent(
    x: FloatArray, errors: FloatArray, *, next_term: float, noise: ArrayLike = 0.0
) -> tuple[float, float, float]:
    """Return p of errors ~ x^p·(1 + b·x^next_term) as x → 0, its numerical and its model error.

    Least squares of ln e = a + p·ln x + b·x^next_term. The numerical error is the 95 % interval that the scatter of
    successive errors gives, and what ``noise``, the error of the errors themselves, can add. The model error is the
    size of the next term: the change of p when it is left out. All shapes are (n,). Without numbers p is none either.
    """
    if not np.all(errors > 0.0) or not np.all(np.isfinite(errors)):
        return math.nan, 0.0, 0.0
    y = np.log(errors)
    plain = np.column_stack((np.ones_like(x), np.log(x)))
    full = np.column_stack((plain, (x / x[0]) ** next_term))
    inverse = np.linalg.pinv(full)
    residual = y - full @ (inverse @ y)
    freedom = len(x) - full.shape[1]
    row = inverse[1]
    scatter = math.sqrt(float(residual @ residual) / freedom) * float(np.linalg.norm(row))
    exponent = float(row @ y)
    relative = np.nan_to_num(np.broadcast_to(noise, x.shape) / errors, nan=np.inf)
    numerical = float(stdtrit(freedom, 0.975)) * scatter + float(np.abs(row) @ relative)
    return exponent, numerical, abs(exponent - float(np.linalg.pinv(plain)[1] @ y))


def extrapolated_order(errors: FloatArray, noise: float) -> tuple[float, float, float]:
    """Return the order in h of ``errors`` at halved steps (shape (n,), n >= 4), its numerical and its model error.

    Orders observed between neighbours are a series in h, so that twice the last less the one before is better by one
    power. The model error is that extrapolation's own step, the numerical one its change from one step to the
    next, and what ``noise`` in the errors can add.
    """
    if not np.all(errors > 0.0) or not np.all(np.isfinite(errors)):
        return math.nan, 0.0, 0.0
    orders = np.log2(errors[:-1] / errors[1:])
    extrapolated = 2.0 * orders[1:] - orders[:-1]
    rounding = 4.0 * noise / float(errors[-1]) / math.log(2.0)
    return (
        float(extrapolated[-1]),
        float(abs(extrapolated[-1] - extrapolated[-2])) + rounding,
        float(abs(orders[-1] - orders[-2])),
    )


# --- Engines whose fixed step is too long for a question: they are asked again at shorter ones.
#
# At a longer step the engine's own error may be larger than what a claim can tell. That says nothing about
# the engine, and a shorter step often decides.

SHORTER = 4.0
"""By which steps become shorter from one time to the next."""

LONGEST = 4.0
"""Time in s that an answer is expected to take, up to which it is asked for at a shorter step."""

Answer = TypeVar("Answer")


def decided(
    engine: Engine | None, ask: Callable[[Engine | None], Answer], is_open: Callable[[Answer], bool]
) -> tuple[Answer, str]:
    """Return what ``engine`` answers, at a shorter step than its own if that leaves it open, and a note of that.

    What the engine or the question raises at the engine's own step is raised; at a shorter one the note says it.
    """
    began, share, note = time.perf_counter(), 1.0, ""
    answer = ask(engine)
    while engine is not None and engine.step is not None and is_open(answer):
        if SHORTER * (time.perf_counter() - began) > LONGEST:
            break
        began, share = time.perf_counter(), SHORTER * share
        try:
            answer = ask(replace(engine, step=engine.step / share))
        except Exception as error:  # whatever the engine may raise: its own step was no failure
            return (
                answer,
                f"At a step {share:g} times as short as the engine's own it failed: {printable(error)}",
            )
        note = f"Asked at a step {share:g} times as short as the engine's own, which leaves it open."
    return answer, note
