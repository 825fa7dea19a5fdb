"""Calibration of error estimates: how far they are from the true errors of motions that are known exactly."""

from __future__ import annotations

import functools
import math
from collections.abc import Callable, Iterable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from compare.claims.error_estimates import refined
from compare.engines import Engine
from compare.studies.engines.error_estimates.parameters import KNOWN
from reference_model.systems import FloatArray, System
from reference_model.trajectory import Trajectory


@dataclass(frozen=True, eq=False)
class Problem:
    """A motion of which the exact value of some numbers is known.

    Parameters
    ----------
    system : PinOnDisc or DiscOnDisc
        The parameters.
    start : array of shape (4,) or (6,)
        State at ``times[0]``.
    times : array of shape (n,)
        In s.
    quantity : callable
        Reads the numbers off a trajectory, shape (m,); fewer where the motion has none of some.
    exact : array of shape (m,)
        What they should be.

    """

    system: System
    start: FloatArray
    times: FloatArray
    quantity: Callable[[Trajectory], FloatArray]
    exact: FloatArray

    def measured(self, engine: Engine, tolerance: float) -> FloatArray:
        """Return the numbers that ``engine`` gives, shape (m,); none where one of them is missing."""
        found = self.quantity(engine.simulate(self.system, self.start, self.times, tolerance=tolerance))
        return found if found.shape == self.exact.shape else np.full(self.exact.shape, math.nan)


@dataclass(frozen=True, eq=False)
class Calibration:
    """True and estimated errors of the n numbers of several motions, as fractions of the largest number of each.

    Parameters
    ----------
    motion : array of shape (n,)
        To which motion a number belongs, from 0 on.
    errors, estimates : array of shape (n,)
        Dimensionless; not a number where the engine gave none.

    """

    motion: NDArray[np.int_]
    errors: FloatArray
    estimates: FloatArray

    @property
    def motions(self) -> int:
        """How many there are."""
        return int(self.motion[-1]) + 1

    @functools.cached_property
    def _covered(self) -> FloatArray:
        """Of each motion, the fraction of its numbers whose true error lies within the estimate."""
        within = np.bincount(self.motion, self.errors <= self.estimates)  # False for NaN
        return np.asarray(within / np.bincount(self.motion))

    @property
    def coverage(self) -> float:
        """Fraction of numbers whose true error lies within the estimate; every motion counts as much."""
        return float(np.mean(self._covered))

    @property
    def coverage_noise(self) -> float:
        """Standard error of the coverage, that of a mean over motions: the numbers of one of them go together."""
        return float(np.std(self._covered, ddof=1) / math.sqrt(self.motions))

    @property
    def ratios(self) -> FloatArray:
        """Estimates over true errors, those at least ``KNOWN``, shape (n,); 0 without a number."""
        ratios = self.estimates / np.maximum(self.errors, KNOWN)
        return np.where(np.isnan(ratios), 0.0, ratios)

    @property
    def over_estimate(self) -> float:
        """Median of estimate over true error."""
        return float(np.median(self.ratios))


def calibrated(engine: Engine, problems: Iterable[tuple[Problem, float]]) -> Calibration:
    """Return true and estimated errors of ``engine`` in problems, each at its tolerance."""
    motion, errors, estimates = [], [], []
    for i, (problem, tolerance) in enumerate(problems):
        measured, estimate = refined(functools.partial(problem.measured, engine), tolerance)
        scale = np.max(np.abs(problem.exact))
        motion.append(np.full(measured.shape, i))
        errors.append(np.abs(measured - problem.exact) / scale)
        estimates.append(estimate / scale)
    return Calibration(np.concatenate(motion), np.concatenate(errors), np.concatenate(estimates))
