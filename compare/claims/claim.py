"""A claim: a measured number beside the predicted one, with the error that is allowed to lie between them."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from enum import Enum
from functools import cached_property
from typing import Any, Literal, get_args

import numpy as np
from numpy.typing import ArrayLike

from reference_model.systems import FloatArray

Kind = Literal["formula", "conservation", "order", "trajectory"]
"""What the prediction is taken from.

"formula": a closed form, an eigenvalue, the root of a balance, or which of several ends a theory says;
"conservation": energy or momentum, with no other solution beside; "order": how an error falls; "trajectory": another
simulation's motion, or what is read off it. An engine that shares a mistake with that simulation passes the last.
"""

KINDS: tuple[Kind, ...] = get_args(Kind)

THEORY = "theory"
"""Stands for the engine of a claim in which none takes part."""

Evidence = Literal["independent", "self-check", "algebra", "implied"]
"""What agreement is worth, see ``EVIDENCE``."""

EVIDENCE: dict[Evidence, str] = {
    "independent": "beside a formula, a conservation law, an order of convergence, or a code that shares nothing",
    "self-check": "an engine against itself: at another tolerance, or with the same law of friction on both sides",
    "algebra": "formulas of the theory against each other; no engine takes part",
    "implied": "it follows from another verdict that agrees, to which it adds nothing",
}
"""Kinds of evidence, from the one that counts to those that do not add to it, in words."""

Basis = Literal["independent", "reference", "self-check", "algebra"]
"""What evidence a claim is, before it is known which engine it is about.

"reference": the prediction is a motion of the reference, or is computed with its law of friction. That is a
self-check of the reference and of what shares code with it, and independent of all others.
"""

BASES: tuple[Basis, ...] = get_args(Basis)


class Verdict(Enum):
    """What a claim has shown; only AGREES is a pass."""

    AGREES = "agrees"
    DIFFERS = "differs"
    INCONCLUSIVE = "inconclusive"


class Grade(Enum):
    """How finely a claim agrees: by its error over the size of what is predicted, see ``Claim.grade``."""

    EXACT = "exact"
    FINE = "fine"
    COARSE = "coarse"


GRADES = {Grade.EXACT: 1e-7, Grade.FINE: 1e-4, Grade.COARSE: 1e-2}
"""The largest relative error of each grade."""


@dataclass(frozen=True)
class ErrorBudget:
    """The difference that the engine's and the formula's own errors can explain.

    Parameters
    ----------
    numerical : float or array
        Estimated from the run itself (same run at another tolerance, Richardson), in the claim's unit. Not a
        number where an engine gave none to estimate it from: then the claim differs.
    model : float
        Zero for an identity; for an approximation the derived size of the first term left out.
    resolution : float
        The largest total budget with which agreement says all that the claim says. With a larger one it may still
        say that the engine is right to a coarser grade, see ``Claim.grade``.

    """

    numerical: FloatArray
    model: float
    resolution: float

    def __init__(self, numerical: ArrayLike, *, resolution: float, model: float = 0.0) -> None:
        object.__setattr__(self, "numerical", np.asarray(numerical, dtype=float))
        object.__setattr__(self, "model", float(model))
        object.__setattr__(self, "resolution", float(resolution))
        if np.any(self.numerical < 0.0) or not (self.model >= 0.0 and self.resolution > 0.0):
            raise ValueError("an error budget takes errors >= 0 and a resolution > 0")

    @property
    def total(self) -> FloatArray:
        """Numerical plus model error."""
        return self.numerical + self.model


@dataclass(frozen=True, eq=False)
class Claim:
    """One statement about one engine (or about the theory alone).

    Parameters
    ----------
    sentence : str
        What is claimed, the same for every engine; it names the row of the matrix.
    equation : str
        Of the paper, as "(3)", or "" where the statement is ours.
    kind : str
        What the prediction is taken from, one of ``KINDS``.
    engine : str
        Name of the engine, or "theory" where no simulation takes part.
    predicted, measured : float or array of the same shape
        In ``unit``.
    budget : ErrorBudget
        Errors in the same unit.
    parameters : mapping
        All that is needed to repeat the measurement: numbers, or words where a number says less.
    source : str
        Where the parameters come from: a figure, or an assumption in words.
    unit : str
        "" for a dimensionless number.
    note : str
        How the measurement or its error estimate was made, where that is not obvious.
    basis : str
        What evidence it is, one of ``BASES``. Without it: "reference" for the kind "trajectory", else "algebra" where
        no engine takes part and "independent" where one does.
    implied_by : str
        Sentence of a claim of the same study from which this one follows for the same engine, by algebra or because
        it is read off the same numbers; "" for none.
    answers : bool
        Whether the numbers count answers of yes or no, see ``compare.claims.measured.answers_of``.
    named : mapping
        Names by which texts quote an element (its flat index), or all of them at once (None), see
        ``compare.report.quotes``.
    identity : str
        What the claim is called for good, as "fig06/rests"; "" where it is made by hand.
    size : float or array that fits to the numbers, optional
        Beside which an error is small, where the prediction does not say it, as a zero doesn't, see
        ``relative_error``.
    axes : tuple
        Names of the places along each axis of the numbers, () for an axis where they have none; () for none at all.

    """

    sentence: str
    equation: str
    kind: Kind
    engine: str
    predicted: FloatArray
    measured: FloatArray
    budget: ErrorBudget
    parameters: Mapping[str, float | str]
    source: str
    unit: str = ""
    note: str = ""
    basis: Basis = "independent"
    implied_by: str = ""
    answers: bool = False
    named: Mapping[str, int | None] = field(default_factory=dict)
    identity: str = ""
    size: FloatArray | None = None
    axes: tuple[tuple[str, ...], ...] = ()

    def __init__(
        self,
        sentence: str,
        *,
        equation: str,
        kind: Kind = "formula",
        engine: str,
        predicted: ArrayLike,
        measured: ArrayLike,
        budget: ErrorBudget,
        parameters: Mapping[str, float | str],
        source: str,
        unit: str = "",
        note: str = "",
        basis: Basis | None = None,
        implied_by: str = "",
        answers: bool = False,
        named: Mapping[str, int | None] | None = None,
        identity: str = "",
        size: ArrayLike | None = None,
        axes: Sequence[Sequence[str]] = (),
    ) -> None:
        values = {
            "sentence": sentence,
            "equation": equation,
            "kind": kind,
            "engine": engine,
            "predicted": np.asarray(predicted, dtype=float),
            "measured": np.asarray(measured, dtype=float),
            "budget": budget,
            "parameters": parameters,
            "source": source,
            "unit": unit,
            "note": note,
            "basis": usual_basis(kind, engine) if basis is None else basis,
            "implied_by": implied_by,
            "answers": answers,
            "named": dict(named or {}),
            "identity": identity,
            "size": None if size is None else np.asarray(size, dtype=float),
            "axes": tuple(tuple(names) for names in axes),
        }
        for name, value in values.items():
            object.__setattr__(self, name, value)
        self._check()

    def _check(self) -> None:
        """Raise ``ValueError`` for what does not fit together."""
        sentence, numerical = self.sentence, self.budget.numerical
        if self.kind not in KINDS:
            raise ValueError(
                f"claim {sentence!r}: kind = {self.kind!r}: it must be one of {', '.join(KINDS)}"
            )
        if self.basis not in BASES:
            raise ValueError(
                f"claim {sentence!r}: basis = {self.basis!r}: it must be one of {', '.join(BASES)}"
            )
        if self.basis == "algebra" and self.engine != THEORY:
            raise ValueError(f"claim {sentence!r} is about {self.engine}: algebra is of the theory alone")
        if self.predicted.shape != self.measured.shape:
            raise ValueError(
                f"claim {sentence!r}: predicted has shape {self.predicted.shape}, "
                f"measured {self.measured.shape}"
            )
        mixed = [unit.strip() for unit in self.unit.split(",")]
        if len(mixed) > 1 and any(_unit(name) not in mixed for name in (self.axes or ((),))[-1] or ("",)):
            raise ValueError(
                f"claim {sentence!r} has numbers in {self.unit}: each component must say which, as 'x in m'"
            )
        if self.predicted.size == 0:
            raise ValueError(f"claim {sentence!r} has no numbers: it would agree whatever the engine does")
        for name, place in self.named.items():
            if place is not None and not 0 <= place < self.predicted.size:
                raise ValueError(f"claim {sentence!r}: {name!r} is element {place} of {self.predicted.size}")
        if np.broadcast_shapes(numerical.shape, self.predicted.shape) != self.predicted.shape:
            raise ValueError(
                f"claim {sentence!r}: numerical error has shape {numerical.shape}, "
                f"predicted {self.predicted.shape}"
            )

    def unit_of(self, index: int) -> str:
        """Return the unit of element ``index`` (flat), "1" where several are mixed and it has none."""
        return self.units[index % len(self.units)]

    @cached_property
    def units(self) -> tuple[str, ...]:
        """The unit of each place along the last axis where they are mixed, or the one of all."""
        if "," not in self.unit:
            return (self.unit,)
        return tuple(_unit(name) for name in self.axes[-1])

    def element(self, index: int) -> str:
        """Return in words which element ``index`` (flat) is, as "μN = 0.05 N, x in m"; "" where nothing names it."""
        return self._named(np.unravel_index(index, self.predicted.shape))

    def elements(self) -> Iterator[str]:
        """Yield in words which element each is, in their flat order."""
        return map(self._named, np.ndindex(self.predicted.shape))

    def _named(self, places: Sequence[Any]) -> str:
        return ", ".join(names[i] for names, i in zip(self.axes, places, strict=False) if names)

    @property
    def difference(self) -> FloatArray:
        """|measured − predicted|, elementwise."""
        return np.abs(self.measured - self.predicted)

    @property
    def ratio(self) -> FloatArray:
        """Difference over budget, elementwise: agreement is up to 1.

        Without a difference it is 0, whatever the budget; a difference without a budget, and a number that is
        missing, is infinitely far off.
        """
        difference, total = np.broadcast_arrays(self.difference, self.budget.total)
        with np.errstate(divide="ignore", invalid="ignore"):
            ratio = np.where(difference == 0.0, 0.0, difference / total)
        missing = np.isnan(total) | ~np.isfinite(self.measured) | ~np.isfinite(self.predicted)
        return np.asarray(np.where(missing, np.inf, ratio))

    @cached_property
    def worst(self) -> int:
        """Flat index of the element with the largest ratio; among several, of the largest difference."""
        ratio = self.ratio
        return _place_of_largest(np.where(ratio == np.max(ratio), self.difference, -1.0))

    @cached_property
    def largest(self) -> int:
        """Flat index of the element with the largest difference, a missing one before all."""
        return _place_of_largest(self.difference)

    @cached_property
    def relative_error(self) -> float:
        """The largest total error over the size of what is predicted; infinite where that has none.

        Without a ``size`` it is that of the largest prediction, of each unit where they are mixed.
        Orders and answers have no size beside which an error is small.
        """
        if self.answers or self.kind == "order":
            return math.inf
        total, size = np.broadcast_arrays(self.budget.total, self._size())
        with np.errstate(divide="ignore", invalid="ignore"):
            relative = np.where(total == 0.0, 0.0, total / size)
        return float(np.max(np.nan_to_num(relative, nan=math.inf), initial=0.0))

    def _size(self) -> FloatArray:
        """Return what an error is small beside, of a shape that fits to the numbers."""
        if self.size is not None:
            return self.size
        numbers = np.abs(self.predicted)
        units = np.array(self.units)
        if units.size == 1:
            return np.asarray(np.max(numbers, initial=0.0))
        return np.array([np.max(numbers[..., units == unit], initial=0.0) for unit in units])

    @cached_property
    def grade(self) -> Grade | None:
        """The finest grade to which the claim is conclusive; None where only its resolution says what is small."""
        relative = self.relative_error
        return next((grade for grade, largest in GRADES.items() if relative <= largest), None)

    @cached_property
    def verdict(self) -> Verdict:
        """Differs beyond the budget or without a number, else agrees within the resolution or to a grade.

        It is inconclusive where the error is larger than both.
        """
        difference, total = np.broadcast_arrays(self.difference, self.budget.total)
        missing = ~np.isfinite(self.measured)
        open_ = missing & np.isinf(total)  # there at one tolerance and not at another
        if not np.all((difference <= total) & ~missing | open_):  # False for NaN
            return Verdict.DIFFERS
        if np.any(self.budget.total > self.budget.resolution) and self.grade is None:
            return Verdict.INCONCLUSIVE
        return Verdict.AGREES


def _unit(name: str) -> str:
    """Return the unit that the name of a component ends with, as "x in m"; "" where it has none."""
    return name.rpartition(" in ")[2] if " in " in name else ""


def _place_of_largest(values: FloatArray) -> int:
    return int(np.argmax(np.nan_to_num(values, nan=np.inf, posinf=np.inf)))


def usual_basis(kind: Kind, engine: str) -> Basis:
    """Return what evidence a claim of this kind is, where nothing else is said of it."""
    if kind == "trajectory":
        return "reference"
    return "algebra" if engine == THEORY else "independent"
