"""Uncertainties of comparisons with measurements, as in ASME V&V 20."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import astuple, dataclass

import numpy as np

from compare.claims.validation import EXPECTED, Validation
from reference_model.systems import FloatArray

ROUNDING = 1e-12
"""Uncertainty that counts as zero."""


@dataclass(frozen=True)
class Uncertainties:
    """Standard uncertainties of one difference, shape (n,) each."""

    data: FloatArray
    input: FloatArray
    numerical: FloatArray

    @classmethod
    def joined(cls, several: Sequence[Uncertainties]) -> Uncertainties:
        """Return the uncertainties of several differences."""
        return cls(*(np.concatenate(kind) for kind in zip(*map(astuple, several), strict=True)))

    def share_explained(self, errors: FloatArray) -> float:
        """Return the share of ``errors`` (n,) that are at most twice their total uncertainty."""
        return float(np.mean(errors <= 2.0 * self.total))

    @property
    def total(self) -> FloatArray:
        """Total standard uncertainty of each difference."""
        return np.asarray(np.sqrt(self.data**2 + self.input**2 + self.numerical**2))

    def missing(self, errors: FloatArray) -> tuple[float, float]:
        """Return the factor on the total, and the additional uncertainty, that explain the expected share."""
        factor = np.quantile(0.5 * errors / self.total, EXPECTED, method="inverted_cdf")
        squared = np.quantile((0.5 * errors) ** 2 - self.total**2, EXPECTED, method="inverted_cdf")
        return float(factor), float(np.sqrt(max(squared, 0.0)))


def median_with_error(values: FloatArray, draws: int = 2000) -> tuple[float, float]:
    """Return the median and its standard error, by resampling."""
    generator = np.random.default_rng(1)
    medians = np.median(generator.choice(values, (draws, len(values))), axis=1)
    return float(np.median(values)), float(medians.std())


def validation_of(
    sizes: FloatArray, uncertain: Uncertainties, quantity: str, unit: str = "degrees"
) -> Validation:
    """Return the validation for comparison errors of these ``sizes``, shape (n,)."""
    median, scatter = median_with_error(sizes)

    def middle(values: FloatArray) -> float:
        found = float(np.median(values))
        return found if found > ROUNDING else 0.0

    explained, (factor, model) = uncertain.share_explained(sizes), uncertain.missing(sizes)
    return Validation(
        quantity=quantity,
        unit=unit,
        error=median,
        error_uncertainty=scatter,
        data=middle(uncertain.data),
        input=middle(uncertain.input),
        numerical=middle(uncertain.numerical),
        explained=explained,
        factor=factor,
        model=model,
        count=len(sizes),
    )
