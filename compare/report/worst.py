"""The element of a claim that decides its verdict, and the numbers that stand for it wherever that is shown."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from compare.claims.claim import Claim, Verdict
from compare.report.numbers import error_text

SPACE = "\N{NO-BREAK SPACE}"


@dataclass(frozen=True)
class Worst:
    """The numbers of one element, ``index`` (from 0) of ``count``, and which difference is the largest.

    ``name`` and ``largest_name`` say in words which elements they are, "" where there is only one.
    """

    index: int
    count: int
    name: str
    predicted: float
    measured: float
    difference: float
    numerical: float
    model: float
    largest_index: int
    largest_name: str
    largest_difference: float

    @property
    def total(self) -> float:
        """Numerical plus model error."""
        return self.numerical + self.model


def worst(claim: Claim) -> Worst:
    """Return the element that is nearest to failing, or, where nothing was shown, the least certain one."""
    numerical = np.broadcast_to(claim.budget.numerical, claim.predicted.shape)
    i = int(np.argmax(numerical)) if claim.verdict is Verdict.INCONCLUSIVE else claim.worst
    return Worst(
        i,
        claim.predicted.size,
        _name(claim, i),
        float(claim.predicted.flat[i]),
        float(claim.measured.flat[i]),
        float(claim.difference.flat[i]),
        float(numerical.flat[i]),
        claim.budget.model,
        claim.largest,
        _name(claim, claim.largest),
        float(claim.difference.flat[claim.largest]),
    )


def _name(claim: Claim, index: int) -> str:
    """Return which element it is in words, by its number where nothing names it."""
    if claim.predicted.size == 1:
        return ""
    return claim.element(index) or f"no. {index + 1} of {claim.predicted.size}"


def deciding(claims: Sequence[Claim]) -> Claim:
    """Return the one of several claims with the same verdict that decides it, as ``worst`` does of elements."""

    def weight(claim: Claim) -> float:
        element = worst(claim)
        if claim.verdict is Verdict.INCONCLUSIVE:
            return element.total
        return float(claim.ratio.flat[element.index])

    return max(claims, key=weight)


def in_short(claim: Claim) -> str:
    """Return what stands beside a verdict: the error that is allowed, "± 2×10⁻⁹ m", or that it is off, "by 3 m".

    Of answers, "7 of 8"; nothing where an exact number is met exactly.
    """
    element = worst(claim)
    if claim.answers:
        return f"{answers_text(element.measured)} of {answers_text(element.predicted)}"
    unit = f" {claim.unit}" if claim.unit else ""
    if claim.verdict is Verdict.DIFFERS:
        return f"by{SPACE}{error_text(element.difference)}{unit}"
    return f"±{SPACE}{error_text(element.total)}{unit}" if element.total > 0.0 else ""


def answers_text(count: float) -> str:
    """Return a number of answers, which is whole: "3", "1,000,000"."""
    return f"{round(count):,}"
