"""Result of a claim's function: numbers, their errors and their names."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any, get_args

import numpy as np
from numpy.typing import ArrayLike

from compare.claims.error_estimates import COARSENING, change_as_error
from reference_model.systems import FloatArray, real_numbers, require_flag, require_kind
from reference_model.systems.joint import AnySystem

ONE = 0.5
"""Resolution of a count without open answers."""


@dataclass(frozen=True, eq=False, kw_only=True)
class Measured:
    """Predicted and measured values of a claim.

    - ``predicted``, ``value``, of the same shape: numbers in the claim's unit.
    - ``error``, ``model``: numerical error of both (broadcastable), and model error, see ``ErrorBudget``.
    - ``components``: names along the last axis, such as "x in m"; () for one quantity.
    - ``at``: varied quantities in the order of the other axes: a name with its unit, such as "μN in N", and the
      numbers or words along that axis.
    - ``system``, ``source``, ``resolution``: these override the study's and the declared ones.
    - ``parameters``, ``note``, ``named``: additions to the system's and the declared ones.
    - ``data``: arrays by name for the figures, or a function that returns them, whose failure costs no verdict.
    - ``size``, ``answers``, ``friction``: as in ``Claim``.
    """

    predicted: ArrayLike
    value: ArrayLike
    error: ArrayLike = 0.0
    model: float = 0.0
    resolution: float | None = None
    components: Sequence[str] = ()
    at: Mapping[str, Sequence[Any] | FloatArray] = field(default_factory=dict)
    system: AnySystem | None = None
    parameters: Mapping[str, float | str] = field(default_factory=dict)
    source: str = ""
    note: str = ""
    data: Mapping[str, ArrayLike] | Callable[[], Mapping[str, ArrayLike]] = field(default_factory=dict)
    named: Mapping[str, int | None] = field(default_factory=dict)
    size: ArrayLike | None = None
    answers: bool = False
    friction: bool = True

    def __post_init__(self) -> None:
        """Raise ``ValueError`` for a wrong type; NaN is a missing number."""
        for name in ("predicted", "value", "error", "model"):
            real_numbers(name, getattr(self, name))
        for name in ("resolution", "size"):
            if getattr(self, name) is not None:
                real_numbers(name, getattr(self, name))
        for name in ("at", "parameters", "named"):
            require_kind(name, getattr(self, name), Mapping)
        for name in ("answers", "friction"):
            require_flag(name, getattr(self, name))
        if self.system is not None:
            require_kind("system", self.system, *get_args(AnySystem))

    @property
    def axes(self) -> tuple[tuple[str, ...], ...]:
        """Names along each axis, () for an axis without names; raises ``ValueError`` unless they fit the shape."""
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

    It is inconclusive if no case fails but more than ``may_be_open`` are undecided. ``margins``, n numbers or truth
    values, are the distances of quantities from their thresholds, positive if the case holds. A margin or error of
    NaN is a failure, and an infinite error leaves a case undecided. ``more`` contains fields of :class:`Measured`.
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
    found = np.asarray(margins)
    return np.where(found, 1.0, -1.0) if found.dtype == np.bool_ else found.astype(float)
