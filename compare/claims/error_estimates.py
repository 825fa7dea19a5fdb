"""Estimates of numerical errors and of observed orders from the measurements themselves."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from typing import NamedTuple, TypeVar

import numpy as np
from numpy.typing import ArrayLike
from scipy.special import stdtrit  # without the rest of scipy.stats

from compare.engines import COARSENING as COARSENING
from compare.engines import USUAL_TOLERANCE
from compare.engines.engine import Engine
from compare.engines.outside.processor_time import processor_time
from compare.output.outside_text import printable
from reference_model.systems import FloatArray, positive_number, require_callable, require_flag

WORKING = USUAL_TOLERANCE
"""Default tolerance of engines in studies."""

TIGHTEST = 1e-12
"""Smallest tolerance; an eighth of it is close to rounding error."""

TRUTH = 1e-13
"""Tolerance of the reference in place of the exact motion."""

SAFETY = 8.0
"""Ratio of the error estimate to the change at the smaller tolerance.

If errors are proportional to the tolerance, the estimate is 8·(1 − 1/8) = 7 times the error. It also covers errors
that fall slowly or irregularly. The change against a *larger* tolerance is too small for one number in twenty of the
reference and one in fifty of Exudyn.
"""

COARSE = 1e-4
"""Relative error of states above which events may appear or vanish."""

ROUNDING = 64.0 * np.finfo(float).eps
"""Relative error below which two runs may coincide by chance."""


class Measurement(NamedTuple):
    """A number or an array, and the error of each element."""

    value: FloatArray
    error: FloatArray

    @property
    def largest(self) -> float:
        """The largest error."""
        return float(np.max(self.error))

    @property
    def rows(self) -> FloatArray:
        """Largest error of each row (along the last axis), broadcast."""
        return np.broadcast_to(np.max(self.error, axis=-1, keepdims=True), self.error.shape)

    def plus(self, error: float | FloatArray) -> Measurement:
        """Return the same numbers with errors larger by ``error`` (broadcastable)."""
        return Measurement(self.value, np.asarray(self.error + error))


def refined(
    quantity: Callable[[float], ArrayLike], tolerance: float = WORKING, *, alike: bool = True
) -> Measurement:
    """Return ``quantity(tolerance)`` and an estimate of its error, of the same shape.

    The estimate is ``SAFETY`` times the change against ``quantity(tolerance / COARSENING)``, at least rounding error.
    If the numbers of a row (the last axis) are ``alike`` in unit and size, it is also at least the row's largest
    change, because a single number may hardly change by chance. If the engine does not follow the smaller tolerance,
    the next larger tolerance with an effect is used.
    """
    require_callable("quantity", quantity)
    tolerance = positive_number("tolerance", tolerance, "")
    require_flag("alike", alike)
    found = np.asarray(quantity(tolerance), dtype=float)
    for factor in (1.0 / COARSENING, COARSENING, COARSENING**2):
        other = np.asarray(quantity(factor * tolerance), dtype=float)
        if not np.array_equal(found, other, equal_nan=True):
            break
    return Measurement(found, change_as_error(found, other, alike=alike))


def known(values: ArrayLike, errors: ArrayLike) -> FloatArray:
    """Return ``errors`` with NaN replaced by infinity if the value is a number.

    If the value is missing too, the error stays NaN, which is a failure.
    """
    return np.where(np.isnan(errors) & np.isfinite(values), np.inf, errors)


def open_where_coarse(found: Measurement, states: Measurement) -> Measurement:
    """Return ``found`` with infinite errors for missing values, if the ``states`` they are read from are coarse."""
    coarse = states.largest > COARSE * float(np.max(np.abs(states.value)))
    missing = ~np.isfinite(found.value)
    return Measurement(found.value, np.where(missing & coarse, np.inf, found.error))


def change_as_error(found: FloatArray, other: FloatArray, *, alike: bool = True) -> FloatArray:
    """Return the error of ``found`` estimated from ``other``, see ``refined``; all of the same shape.

    The error is infinite if only one of the two is a number.
    """
    with np.errstate(invalid="ignore"):
        change = np.where(np.isfinite(found) ^ np.isfinite(other), np.inf, np.abs(other - found))
    numbers = np.where(np.isfinite(change), change, 0.0)
    largest = np.max(numbers, axis=-1, keepdims=True, initial=0.0) if alike and change.ndim > 0 else change
    rounding = ROUNDING * np.max(np.abs(found), where=np.isfinite(found), initial=0.0)
    return np.asarray(np.maximum(SAFETY * change, largest) + rounding)


def observed_exponent(
    x: FloatArray, errors: FloatArray, *, next_term: float, noise: ArrayLike = 0.0
) -> tuple[float, float, float]:
    """Return p of errors ~ x^p·(1 + b·x^next_term) as x → 0, its numerical and its model error.

    ln e = a + p·ln x + b·x^next_term is fitted by least squares. The numerical error is the 95 % interval from the
    scatter of successive errors, plus the effect of ``noise``, the error of the errors. The model error is the change
    of p without the next term. All shapes are (n,). p is NaN if an error is not a positive number.
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

    Orders observed between neighbours are a series in h, so 2·(last) − (second last) gains one power. The model error
    is the last change of the observed orders. The numerical error is the last change of the extrapolated orders, plus
    the effect of ``noise``.
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


# --- Shorter steps, if the fixed step of an engine leaves a claim open

SHORTER = 4.0
"""Ratio of successive steps."""

LONGEST = 4.0
"""Largest expected processor time in s of a shorter step."""

MOST_SHORTER = 16.0
"""Factor of the step beyond which no shorter step is tried if all have failed."""

Answer = TypeVar("Answer")


def decided(
    engine: Engine | None, ask: Callable[[Engine | None], Answer], is_open: Callable[[Answer], bool]
) -> tuple[Answer, str]:
    """Return the engine's answer, at a shorter step if its own leaves the claim open or fails, and a note.

    An exception at a shorter step goes into the note if the engine's own step succeeded. Shorter steps do not help an
    engine of limited precision: in single precision, friction may be too weak to change the speed within a step.
    """
    began, share, note = processor_time(), 1.0, ""
    answer = _answer(ask, engine)
    while engine is not None and engine.step is not None and _fails(answer, is_open):
        failed = isinstance(answer, Exception)
        first = failed and share == 1.0  # it may have compiled
        late = SHORTER * (processor_time() - began) > LONGEST and not first
        if late or (share > MOST_SHORTER if failed else engine.noise > 0.0):
            break
        began, share = processor_time(), SHORTER * share
        shorter = _answer(ask, replace(engine, step=engine.step / share))
        if not isinstance(shorter, Exception):
            answer = shorter
            note = f"Measured with 1/{share:g} of the engine's own step, which leaves the claim inconclusive."
        elif not isinstance(answer, Exception):
            note = f"The run with 1/{share:g} of the engine's own step failed: {printable(shorter)}"
            break
    if isinstance(answer, Exception):
        raise answer
    return answer, note


def _answer(ask: Callable[[Engine | None], Answer], engine: Engine | None) -> Answer | Exception:
    try:
        return ask(engine)
    except Exception as error:  # a step may be too large for any answer
        return error


def _fails(answer: Answer | Exception, is_open: Callable[[Answer], bool]) -> bool:
    return isinstance(answer, RuntimeError) or (not isinstance(answer, Exception) and is_open(answer))
