"""A claim: a measured and a predicted number, and the difference allowed between them."""

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import KW_ONLY, dataclass, field, replace
from enum import Enum
from functools import cached_property
from typing import Any, Literal, Self, get_args

import numpy as np
from numpy.typing import ArrayLike, NDArray

from reference_model.systems import FloatArray, finite_number, real_numbers

Kind = Literal["formula", "conservation", "order", "trajectory"]
"""Source of the prediction.

"formula": a closed form, an eigenvalue, the root of a balance, or the end state that a theory predicts.
"conservation": energy or momentum. "order": the order of an error. "trajectory": another simulation, whose mistakes
an engine may share.
"""

KINDS: tuple[Kind, ...] = get_args(Kind)

THEORY = "theory"
"""Engine name of claims about the theory alone."""

Evidence = Literal["independent", "self-check", "algebra", "implied"]
"""Kind of evidence that agreement provides."""

EVIDENCE: dict[Evidence, str] = {
    "independent": "comparison with a formula, a conservation law, an order of convergence or an independent code",
    "self-check": "an engine against itself, at another tolerance or with the same friction law on both sides",
    "algebra": "formulas of the theory against each other, without an engine",
    "implied": "consequence of another verdict that agrees; not counted as additional evidence",
}
"""Kinds of evidence, the strongest first."""

Basis = Literal["independent", "reference", "self-check", "algebra"]
"""Kind of evidence before the engine is known.

"reference": the prediction comes from the reference or its friction law, so it is a self-check for engines that share
its code.
"""

BASES: tuple[Basis, ...] = get_args(Basis)


class Verdict(Enum):
    """Verdict on a claim; only AGREES is a pass."""

    AGREES = "agrees"
    DIFFERS = "differs"
    INCONCLUSIVE = "inconclusive"


class Grade(Enum):
    """Precision of a claim, see ``Claim.grade``."""

    EXACT = "exact"
    FINE = "fine"
    COARSE = "coarse"


GRADES = {Grade.EXACT: 1e-7, Grade.FINE: 1e-4, Grade.COARSE: 1e-2}
"""Largest relative error of each grade."""


NEGLIGIBLE = GRADES[Grade.EXACT]
"""Largest relative difference that does not matter in a study, whose claims must fail for small faults."""

DOUBT = 3.0
"""Uncertainty factor of an error that two runs of an engine show, if it lies beyond the resolution."""


@dataclass(frozen=True)
class ErrorBudget:
    """Difference that the errors of the engine and the formula can explain.

    - ``numerical``: error in the claim's unit, estimated from the run itself; NaN if there is no estimate.
    - ``model``: size of the first neglected term of an approximation; zero for an identity.
    - ``resolution``: largest total error of a conclusive agreement. Beyond it the claim may agree to a coarser grade.
    - ``negligible``: largest difference that does not matter; the resolution unless given.
    - ``doubt``: factor, >= 1, that a total error beyond the resolution may be too small.
    """

    numerical: FloatArray
    model: float
    resolution: float
    negligible: float
    doubt: float

    def __init__(
        self,
        numerical: ArrayLike,
        *,
        resolution: float,
        model: float = 0.0,
        negligible: float = math.inf,
        doubt: float = 1.0,
    ) -> None:
        object.__setattr__(self, "numerical", real_numbers("numerical", numerical))
        object.__setattr__(self, "model", float(real_numbers("model", model)))
        object.__setattr__(self, "resolution", float(real_numbers("resolution", resolution)))
        object.__setattr__(self, "negligible", min(float(negligible), self.resolution))
        object.__setattr__(self, "doubt", finite_number("doubt", doubt))
        if self.doubt < 1.0:
            raise ValueError(f"doubt = {self.doubt:g}: it must be >= 1")
        if np.any(self.numerical < 0.0) or not (self.model >= 0.0 and self.resolution > 0.0):
            raise ValueError(
                f"error budget: numerical and model errors must be >= 0 (model = {self.model:g}), "
                f"the resolution ({self.resolution:g}) must be > 0"
            )

    @property
    def total(self) -> FloatArray:
        """Numerical plus model error."""
        return self.numerical + self.model


@dataclass(frozen=True, eq=False)
class Claim:
    """One statement about one engine (or about the theory alone).

    - ``sentence``: statement, the same for every engine.
    - ``equation``: equation of the paper, such as "(3)"; "" if the statement is ours.
    - ``engine``: name of the engine, or "theory" without a simulation.
    - ``predicted``, ``measured``, of the same shape, and ``budget``: numbers and their errors in ``unit``.
    - ``parameters``, ``source``: numbers or words that repeat the measurement, and their origin.
    - ``note``: method of the measurement or its error estimate, if not obvious.
    - ``basis``: kind of evidence, by default ``usual_basis``.
    - ``implied_by``: sentence of a claim of the same study that implies this one for the same engine, or "".
    - ``answers``: True if the numbers count yes-or-no answers, see ``compare.claims.measured.answers_of``.
    - ``friction``: False if the claim also agrees with half the friction force, as tests show.
    - ``named``: names for quotes of an element (its flat index), or of all (None), see ``compare.report.quotes``.
    - ``identity``: permanent id, such as "fig06/rests".
    - ``size``: scale of a relative error, broadcastable, required if the prediction is zero.
    - ``axes``: names of the elements along each axis, () for an axis without names.
    """

    sentence: str
    _: KW_ONLY
    equation: str
    kind: Kind = "formula"
    engine: str
    predicted: FloatArray
    measured: FloatArray
    budget: ErrorBudget
    parameters: Mapping[str, float | str]
    source: str
    unit: str = ""
    note: str = ""
    basis: Basis = ""  # type: ignore[assignment]  # replaced by the usual one
    implied_by: str = ""
    answers: bool = False
    friction: bool = True
    named: Mapping[str, int | None] = field(default_factory=dict)
    identity: str = ""
    size: FloatArray | None = None
    axes: tuple[tuple[str, ...], ...] = ()

    def __post_init__(self) -> None:
        for name in ("predicted", "measured", "size"):
            if (value := getattr(self, name)) is not None:
                object.__setattr__(self, name, np.asarray(value, dtype=float))
        object.__setattr__(self, "basis", self.basis or usual_basis(self.kind, self.engine))
        object.__setattr__(self, "axes", tuple(map(tuple, self.axes)))
        self._check()

    def _check(self) -> None:
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
            raise ValueError(
                f"claim {sentence!r}: basis = 'algebra' requires engine = {THEORY!r}, not {self.engine!r}"
            )
        if self.predicted.shape != self.measured.shape:
            raise ValueError(
                f"claim {sentence!r}: predicted has shape {self.predicted.shape}, "
                f"measured {self.measured.shape}"
            )
        mixed = [unit.strip() for unit in self.unit.split(",")]
        if len(mixed) > 1 and any(_unit(name) not in mixed for name in (self.axes or ((),))[-1] or ("",)):
            raise ValueError(
                f"claim {sentence!r}: unit = {self.unit!r}: each component must name its unit, such as 'x in m'"
            )
        if self.predicted.size == 0:
            raise ValueError(f"claim {sentence!r}: predicted is empty: it must contain at least one number")
        for name, place in self.named.items():
            if place is not None and not 0 <= place < self.predicted.size:
                raise ValueError(
                    f"claim {sentence!r}: named[{name!r}] = {place}: "
                    f"it must be from 0 to {self.predicted.size - 1}, or None"
                )
        if np.broadcast_shapes(numerical.shape, self.predicted.shape) != self.predicted.shape:
            raise ValueError(
                f"claim {sentence!r}: numerical error has shape {numerical.shape}, "
                f"predicted {self.predicted.shape}"
            )

    @cached_property
    def units(self) -> tuple[str, ...]:
        """Units along the last axis, or one unit."""
        if "," not in self.unit:
            return (self.unit,)
        return tuple(_unit(name) for name in self.axes[-1])

    def element(self, index: int) -> str:
        """Return the name of element ``index`` (flat), such as "μN = 0.05 N, x in m", or ""."""
        return self._named(np.unravel_index(index, self.predicted.shape))

    def elements(self) -> Iterator[str]:
        """Yield the names of all elements in flat order."""
        return map(self._named, np.ndindex(self.predicted.shape))

    def _named(self, places: Sequence[Any]) -> str:
        return ", ".join(names[i] for names, i in zip(self.axes, places, strict=False) if names)

    @property
    def difference(self) -> FloatArray:
        """|measured − predicted|, elementwise."""
        return np.abs(self.measured - self.predicted)

    @property
    def ratio(self) -> FloatArray:
        """Difference over budget, elementwise: at most 1 for agreement, infinite for a missing number."""
        difference, total = np.broadcast_arrays(self.difference, self.budget.total)
        with np.errstate(divide="ignore", invalid="ignore"):
            ratio = np.where(difference == 0.0, 0.0, difference / total)
        missing = np.isnan(total) | ~np.isfinite(self.measured) | ~np.isfinite(self.predicted)
        return np.asarray(np.where(missing, np.inf, ratio))

    @cached_property
    def worst(self) -> int:
        """Flat index of the element with the largest ratio or, among equals, difference."""
        ratio = np.where(self._wrong, self.ratio, -1.0) if np.any(self._wrong) else self.ratio
        nearest = np.where(ratio == np.max(ratio), self.difference, -1.0)
        return int(np.argmax(np.nan_to_num(nearest, nan=np.inf, posinf=np.inf)))

    @cached_property
    def relative_error(self) -> float:
        """Largest ratio of total error to ``size``, by default the largest prediction of the same unit.

        It is infinite for orders and answers, which lack a scale.
        """
        return self._relative(self.budget.total)

    def _relative(self, errors: FloatArray) -> float:
        if self.answers or self.kind == "order":
            return math.inf
        errors, size = np.broadcast_arrays(errors, self._size())
        with np.errstate(divide="ignore", invalid="ignore"):
            relative = np.where(errors == 0.0, 0.0, errors / size)
        return float(np.max(np.nan_to_num(relative, nan=math.inf), initial=0.0))

    @property
    def strict(self) -> Self:
        """The same claim, with at most ``NEGLIGIBLE`` of its size as the negligible difference."""
        sizes = self._size()
        least = NEGLIGIBLE * float(np.min(sizes, where=sizes > 0.0, initial=math.inf))
        negligible = min(self.budget.negligible, least)
        return replace(self, budget=replace(self.budget, negligible=negligible))

    def _size(self) -> FloatArray:
        if self.size is not None:
            return self.size
        numbers = np.abs(self.predicted)
        units = np.array(self.units)
        if units.size == 1:
            return np.asarray(np.max(numbers, initial=0.0))
        return np.array([np.max(numbers[..., units == unit], initial=0.0) for unit in units])

    @cached_property
    def grade(self) -> Grade | None:
        """Finest grade that the relative error and the difference permit, or None."""
        relative = self._relative(np.maximum(self.budget.total, self.difference))
        return next((grade for grade, largest in GRADES.items() if relative <= largest), None)

    @cached_property
    def verdict(self) -> Verdict:
        """Verdict; a claim differs if it exceeds both budget and resolution, or if a number is missing.

        A budget beyond the resolution must be exceeded ``budget.doubt`` times. Otherwise the claim agrees if the
        budget is finite, covers the difference and lies within the resolution or a grade, else it is inconclusive.
        """
        if np.any(self._wrong):
            return Verdict.DIFFERS
        coarse = np.any(self.budget.total > self.budget.resolution) and self.grade is None
        if np.any(self._open) or coarse or np.any(self.difference > self._allowed):
            return Verdict.INCONCLUSIVE
        return Verdict.AGREES

    @property
    def _open(self) -> NDArray[np.bool_]:
        """True without an error estimate, or if a number appears at a single tolerance."""
        total = self.budget.total
        return np.asarray(np.isfinite(self.measured) & np.isnan(total) | np.isinf(total))

    @property
    def _wrong(self) -> NDArray[np.bool_]:
        """True where a number is missing, or the difference matters and exceeds even a doubtful budget."""
        poor = (self.budget.total > self.budget.resolution) & (not self.answers)
        doubt = np.where(poor, self.budget.doubt, 1.0)
        return ~self._open & ~((self.difference <= doubt * self._allowed) & np.isfinite(self.measured))

    @property
    def _allowed(self) -> FloatArray:
        """Difference that the budget explains, or that does not matter; one wrong answer always matters."""
        return np.asarray(np.maximum(self.budget.total, 0.0 if self.answers else self.budget.negligible))

    @property
    def caution(self) -> str:
        """Sentence about a budget that is too small for a difference within the resolution, or ""."""
        if self.verdict is not Verdict.AGREES or self.ratio.flat[self.worst] <= 1.0:
            return ""
        budget = np.broadcast_to(self.budget.total, self.predicted.shape).flat[self.worst]
        difference = self.difference.flat[self.worst]
        return f"The error budget of {budget:.2g} was too small for the difference of {difference:.2g}."


def _unit(name: str) -> str:
    return name.rpartition(" in ")[2] if " in " in name else ""


def usual_basis(kind: Kind, engine: str) -> Basis:
    """Return the default basis of a claim."""
    if kind == "trajectory":
        return "reference"
    return "algebra" if engine == THEORY else "independent"
