"""Starts, tolerances, steps and slip speeds at which the engines' errors are measured."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from compare.claims.error_estimates import WORKING
from compare.claims.paper_parameters import FIG5
from reference_model.systems import FloatArray

SLIDING_STARTS = ((0.9, 0.0, 0.0, 0.9), (1.2, 0.0, 0.0, 1.2))
"""Near to the whirl and a third farther out: the pin slides all the time (our choice)."""

SLIDING_TIMES = np.linspace(0.0, 20.0, 26)
"""In s: multiples of every step, so that a solver's own states are looked at and not its interpolation."""

STICKING_STARTS = tuple((0.1, 0.0, float(speed), 0.0) for speed in np.linspace(0.0, 0.06, 12))
"""As those of Fig. 5, where vx is 0 and 0.03 m/s; each pin sticks and lets go once in the first 8 s."""

STICKING_UNTIL = 8.0
"""In s."""


def _tolerances(largest: float, smallest: float, per_decade: int) -> FloatArray:
    return np.geomspace(largest, smallest, round(per_decade * math.log10(largest / smallest)) + 1)


@dataclass(frozen=True)
class Scan:
    """The tolerances at which one engine is measured, and how its error is expected to follow them.

    Parameters
    ----------
    order : int
        Of the integrator. Its error estimate is of the same order in the step, so the step is ~ tolerance^(1/order)
        and the error ~ tolerance; the next term is smaller by one power of the step.
    sliding, sticking, work : array
        Tolerances for both exponents, between a pin's first few steps and rounding, and for error over work.
    sticking_term : float
        Power of the tolerance by which the next term is smaller where the pin sticks.

    """

    order: int
    sliding: FloatArray
    sticking: FloatArray
    sticking_term: float
    work: FloatArray


SCANS = {
    "reference": Scan(
        order=8,
        sliding=_tolerances(1e-4, 10**-10.5, 8),
        sticking=_tolerances(1e-4, 10**-10.5, 2),
        sticking_term=1 / 8,
        work=_tolerances(1e-4, 1e-11, 1),
    ),
    "exudyn": Scan(
        order=5,
        sliding=_tolerances(1e-4, 1e-10, 4),
        sticking=_tolerances(1e-6, 1e-8, 2),
        sticking_term=1.0,  # ε = 100·tolerance outweighs the step: the next term is ε²
        work=_tolerances(1e-4, 1e-9, 1),
    ),
}


REGULARISATIONS = np.geomspace(1e-4, 10**-6.5, 6)
"""ε in m/s for the motion through three stick phases."""

FIRST_REGULARISATIONS = np.geomspace(1e-3, 10**-5.5, 11)
"""ε in m/s for the first stick alone."""

CREEP_REGULARISATIONS = (1.6e-3, 8e-4, 4e-4)
"""ε in m/s for the first release by RK44, whose step must be below 2.8·mε/μN = 31 s²/m·ε."""

TOLERANCE = WORKING / 10
"""Tolerance at which ε dominates all other errors."""

STICK_SLIP_TIMES = np.linspace(0.0, 60.0, 61)
"""In s: past all nine stick phases on the way to the whirl."""

WORK_STEPS = (0.04, 0.02, 0.01, 0.005)
"""In s: fixed steps through stick phases, where ε has to follow the step."""


def smallest_regularisation(step: float) -> float:
    """Return ε in m/s for which RK44, stable up to 2.8·mε/μN, resolves sticking with ``step``."""
    return step * FIG5.friction_force / FIG5.mass / 1.5


SLIDING_SOURCE = "Fig. 5; starts (0.9, 0, 0, 0.9) and (1.2, 0, 0, 1.2) are assumptions: 20 s without sticking"
