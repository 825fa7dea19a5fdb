"""What the function of a claim returns: numbers, their errors, and what each of them is."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from compare.claims.error_estimates import COARSENING, change_as_error
from reference_model.systems import FloatArray, System

ONE = 0.5
"""Resolution of a count of which no answer may be open."""


@dataclass(frozen=True, eq=False, kw_only=True)
class Measured:
    """What was predicted and what an engine, or the theory, gives.

    Parameters
    ----------
    predicted, value : float or array of the same shape
        In the claim's unit.
    error : float or array that fits to it
        Numerical error of both, see ``ErrorBudget``.
    model : float
        For an approximation the derived size of the first term left out.
    resolution : float, optional
        The largest total error with which agreement still says something, in place of the declared one.
    components : sequence of str
        What stands along the last axis, as "x in m"; () for one quantity.
    at : mapping
        What was varied, in the order of the other axes: a name with its unit, as "μN in N", and the value, number or
        word, at each place.
    system : PinOnDisc or DiscOnDisc, optional
        The one to repeat it with, in place of the study's.
    parameters : mapping
        What is to be known besides to repeat it.
    source : str
        Where the parameters come from, in place of the study's source.
    note : str
        How it was measured, where that depends on what was; it follows on the declared note.
    data : mapping
        Arrays by name, for the figures.
    named : mapping
        Names by which texts quote an element (its flat index), besides the declared ones.
    size : float or array that fits to the numbers, optional
        Beside which an error is small, where the prediction does not say it, see ``Claim.relative_error``.
    answers : bool
        Whether the numbers count answers of yes or no, see ``answers_of``.

    """

    predicted: ArrayLike
    value: ArrayLike
    error: ArrayLike = 0.0
    model: float = 0.0
    resolution: float | None = None
    components: Sequence[str] = ()
    at: Mapping[str, Sequence[Any] | FloatArray] = field(default_factory=dict)
    system: System | None = None
    parameters: Mapping[str, float | str] = field(default_factory=dict)
    source: str = ""
    note: str = ""
    data: Mapping[str, ArrayLike] = field(default_factory=dict)
    named: Mapping[str, int | None] = field(default_factory=dict)
    size: ArrayLike | None = None
    answers: bool = False

    @property
    def axes(self) -> tuple[tuple[str, ...], ...]:
        """Names of the places along each axis, () where they have none.

        Raises ``ValueError`` where the names are not as many as the numbers.
        """
        shape = np.shape(self.predicted)
        if not (self.at or self.components):
            return ()
        names = [tuple(_place(name, value) for value in values) for name, values in self.at.items()]
        if self.components:
            names += [()] * (len(shape) - 1 - len(names)) + [tuple(self.components)]
        names += [()] * (len(shape) - len(names))
        if len(names) != len(shape) or any(
            len(own) not in (0, n) for own, n in zip(names, shape, strict=True)
        ):
            raise ValueError(
                f"numbers of shape {shape} have names for {tuple(len(own) for own in names)} places: "
                "as many are needed"
            )
        return tuple(names)


def _place(name: str, value: Any) -> str:
    """Return "μN = 0.05 N" for "μN in N"."""
    symbol, _, unit = name.partition(" in ")
    shown = value if isinstance(value, str) else f"{value:g}"
    return f"{symbol} = {shown} {unit}".rstrip()


def answers_of(margins: ArrayLike, errors: ArrayLike = 0.0, *, may_be_open: int = 0, **more: Any) -> Measured:
    """Return the measurement of a claim that is to hold in all of n cases: it differs where one is surely no.

    It is inconclusive where none is, but more than ``may_be_open`` are too close to tell.

    Parameters
    ----------
    margins : array of n numbers or truth values
        By how much each quantity is on the right side of its threshold, in any unit; a number that is missing is no.
    errors : array that fits to it
        What each margin can be off; not a number where an engine gave none to estimate it from, which is a no;
        infinite where nothing is known.
    may_be_open : int
        How many answers may be open in a claim that still says something.
    more
        As :class:`Measured` takes it.

    """
    margins, errors = np.broadcast_arrays(_as_numbers(margins), np.asarray(errors, dtype=float))
    yes, unsure = margins > errors, (np.abs(margins) <= errors) | np.isposinf(errors)
    return replace(
        Measured(
            predicted=float(margins.size),
            value=float(np.count_nonzero(yes)),
            error=float(np.count_nonzero(unsure)),
            resolution=may_be_open + ONE,
            answers=True,
        ),
        **more,
    )


def asked(question: Callable[[float], ArrayLike], tolerance: float) -> tuple[FloatArray, FloatArray]:
    """Return the margins, see ``answers_of``, that an engine gives at ``tolerance``, and their errors.

    The error is estimated as in ``compare.claims.error_estimates.refined``, but from the smaller tolerance only. An
    answer without a margin, yes or no, is open if it changes.
    """
    found, finer = (_as_numbers(question(asked_at)) for asked_at in (tolerance, tolerance / COARSENING))
    return found, change_as_error(found, finer)


def _as_numbers(margins: ArrayLike) -> FloatArray:
    """Return margins; those of truth values are 1 and −1."""
    found = np.asarray(margins)
    return np.where(found, 1.0, -1.0) if found.dtype == np.bool_ else found.astype(float)
