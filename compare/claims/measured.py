"""Result of a claim's function: numbers, their errors and their names."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from compare.claims.error_estimates import COARSENING, change_as_error
from reference_model.systems import FloatArray, System

ONE = 0.5
"""Resolution of a count without open answers."""


@dataclass(frozen=True, eq=False, kw_only=True)
class Measured:
    """Predicted and measured values of a claim.

    Parameters
    ----------
    predicted, value : float or array of the same shape
        Numbers in the claim's unit.
    error : float or broadcastable array
        Numerical error of both, see ``ErrorBudget``.
    model : float
        Size of the first neglected term of an approximation.
    resolution : float, optional
        Largest total error of a conclusive agreement; overrides the declared one.
    components : sequence of str
        Names along the last axis, such as "x in m"; () for one quantity.
    at : mapping
        Varied quantities in the order of the other axes: a name with its unit, such as "μN in N", and the numbers or
        words along that axis.
    system : PinOnDisc or DiscOnDisc, optional
        System to repeat the measurement; overrides the study's.
    parameters : mapping
        Additional parameters to repeat the measurement.
    source : str
        Origin of the parameters; overrides the study's source.
    note : str
        Method, if it depends on the measurement; appended to the declared note.
    data : mapping
        Arrays by name, for the figures.
    named : mapping
        Names for quotes of an element (its flat index), in addition to the declared ones.
    size : float or broadcastable array, optional
        Scale of a relative error, see ``Claim.relative_error``.
    answers : bool
        True if the numbers count yes-or-no answers, see ``answers_of``.

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
        """Names along each axis, () for an axis without names.

        Raises ``ValueError`` if the number of names does not fit the shape.
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
                f"numbers of shape {shape} have names for {tuple(len(own) for own in names)} elements: "
                "both must be equal; change at or components"
            )
        return tuple(names)


def _place(name: str, value: Any) -> str:
    """Return "μN = 0.05 N" for "μN in N"."""
    symbol, _, unit = name.partition(" in ")
    shown = value if isinstance(value, str) else f"{value:g}"
    return f"{symbol} = {shown} {unit}".rstrip()


def answers_of(margins: ArrayLike, errors: ArrayLike = 0.0, *, may_be_open: int = 0, **more: Any) -> Measured:
    """Return the measurement of a claim that must hold in all of n cases; it differs if one case certainly fails.

    It is inconclusive if no case fails but more than ``may_be_open`` cases are undecided.

    Parameters
    ----------
    margins : array of n numbers or truth values
        Distance of each quantity from its threshold, positive if the case holds, in any unit; NaN is a failure.
    errors : broadcastable array
        Error of each margin; NaN if it could not be estimated, which is a failure; infinite if the margin is unknown.
    may_be_open : int
        Largest number of undecided cases in a conclusive claim.
    more
        Fields of :class:`Measured`.

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
    """Return the margins (see ``answers_of``) at ``tolerance`` and their errors.

    The error is estimated as in ``compare.claims.error_estimates.refined``, but only from the smaller tolerance. A
    truth value is undecided if it changes.
    """
    found, finer = (_as_numbers(question(asked_at)) for asked_at in (tolerance, tolerance / COARSENING))
    return found, change_as_error(found, finer)


def _as_numbers(margins: ArrayLike) -> FloatArray:
    """Return the margins; truth values become 1 and −1."""
    found = np.asarray(margins)
    return np.where(found, 1.0, -1.0) if found.dtype == np.bool_ else found.astype(float)
