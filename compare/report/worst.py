"""The element of a claim that decides its verdict."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from compare.claim import Claim, Verdict


@dataclass(frozen=True)
class Worst:
    """The numbers of one element, ``index`` (from 0) of ``count``."""

    index: int
    count: int
    predicted: float
    measured: float
    difference: float
    numerical: float
    model: float

    @property
    def total(self) -> float:
        """Numerical plus model error."""
        return self.numerical + self.model


def worst(claim: Claim) -> Worst:
    """Return the element that is the furthest off, or, where nothing was shown, the least certain one."""
    numerical = np.broadcast_to(claim.budget.numerical, claim.predicted.shape)
    i = int(np.argmax(numerical)) if claim.verdict is Verdict.INCONCLUSIVE else claim.worst
    return Worst(
        i,
        claim.predicted.size,
        float(claim.predicted.flat[i]),
        float(claim.measured.flat[i]),
        float(claim.difference.flat[i]),
        float(numerical.flat[i]),
        claim.budget.model,
    )
