"""Exact motions as references for errors, and the shift of a release by creep."""

import cmath
import functools
import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from compare.claims import WORKING
from compare.claims.parameters import FIG5
from compare.output.figures import BLUE, GREEN, ORANGE, PURPLE
from reference_model import Phase, PinOnDisc, Trajectory
from reference_model.formulas.pin.polar_form import simulate_polar_form
from reference_model.systems import FloatArray

SLIDING_STARTS = ((0.9, 0.0, 0.0, 0.9), (1.2, 0.0, 0.0, 1.2))
"""Near the whirl, and a third farther out; the pin always slides (our choice)."""

SLIDING_TIMES = np.linspace(0.0, 20.0, 26)
"""Times in s, multiples of every step, so the samples are not interpolated."""

STICKING_STARTS = tuple((0.1, 0.0, float(speed), 0.0) for speed in np.linspace(0.0, 0.06, 12))
"""Starts like the starts of Fig. 5, with vx in m/s; each pin sticks and is released once in the first 8 s."""

STICKING_UNTIL = 8.0
"""Duration in s."""


def _tolerances(largest: float, smallest: float, per_decade: int) -> FloatArray:
    return np.geomspace(largest, smallest, round(per_decade * math.log10(largest / smallest)) + 1)


@dataclass(frozen=True)
class Scan:
    """Tolerances for both exponents, and the expected next terms.

    Errors are of this ``order`` in the step, which is ~ tolerance^(1/order). The next term is smaller by one power of
    the step; if the pin sticks, by ``sticking_term`` powers of the tolerance.
    """

    order: int
    sliding: FloatArray
    sticking: FloatArray
    sticking_term: float


SCANS = {
    "reference": Scan(
        order=8,
        sliding=_tolerances(1e-4, 10**-10.5, 8),
        sticking=_tolerances(1e-4, 10**-10.5, 2),
        sticking_term=1 / 8,
    ),
    "exudyn": Scan(
        order=5,
        sliding=_tolerances(1e-4, 1e-10, 4),
        sticking=_tolerances(1e-6, 1e-8, 2),
        sticking_term=1.0,  # ε = 100·tolerance has a larger effect than the step, so the next term is ε²
    ),
}


REGULARISATIONS = np.geomspace(1e-4, 10**-6.5, 6)
"""ε in m/s for three stick phases."""

FIRST_REGULARISATIONS = np.geomspace(1e-3, 10**-5.5, 11)
"""ε in m/s for the first stick phase."""

CREEP_REGULARISATIONS = (1.6e-3, 8e-4, 4e-4)
"""ε in m/s for the first release by RK44, whose step must be below 2.8·mε/μN = 31 s²/m·ε."""

TOLERANCE = WORKING / 10
"""So small that ε dominates all other errors."""

SLIDING_SOURCE = "Fig. 5; starts (0.9, 0, 0, 0.9) and (1.2, 0, 0, 1.2) are our choice: 20 s without stick"


def root_mean_square(values: FloatArray) -> float:
    return float(np.sqrt(np.mean(values**2)))


@functools.cache
def sliding_truth() -> tuple[FloatArray, float]:
    """Return the states of the sliding pins by (10) in polar form, shape (start, time, 4), and their error."""

    def states(tolerance: float) -> FloatArray:
        return np.array(
            [
                simulate_polar_form(FIG5, np.array(start), SLIDING_TIMES, tolerance=tolerance)
                for start in SLIDING_STARTS
            ]
        )

    truth: FloatArray = states(3e-14)
    return truth, root_mean_square(truth - states(2e-13))


def release_shift_by_creep(pin: PinOnDisc, stick: Phase) -> float:
    """Return the shift of the end of a stick phase by creep, in s per m/s of ε.

    A stuck pin under F = −μN·v/ε creeps at w = ε·a/g, where m·a is the force (6) that friction must balance and g =
    μN/m. In the frame of the disc, this moves it by (ε/g)·∫a·exp(−iωt)dt, which has a closed form because a is linear
    in z = z₀·exp(iωt). The release (7) occurs at |a| = g, so the shift is −d|a|/dε divided by d|a|/dt.
    """
    omega = 1j * pin.disc_speed
    spring = pin.stiffness / pin.mass
    slope = -(pin.damping / pin.mass + omega) * omega - spring
    held = stick.end - stick.start
    z = complex(*stick.initial_state[:2])
    turned = cmath.exp(omega * held)
    g = pin.friction_force / pin.mass
    creep = (slope * z * held + spring * pin.offset * (1.0 - 1.0 / turned) / omega) / g * turned
    pull = slope * z * turned + spring * pin.offset
    grows = (pull.conjugate() * slope * omega * z * turned).real
    return -(pull.conjugate() * slope * creep).real / grows


Simulate = Callable[..., Trajectory]


def of_sliding(run: Simulate, **how: Any) -> float:
    """Simulate the sliding pins; return their error (m, m/s)."""
    states = [run(FIG5, start, SLIDING_TIMES, **how).states for start in SLIDING_STARTS]
    return root_mean_square(np.array(states) - sliding_truth()[0])


def gap(found: FloatArray, exact: FloatArray) -> FloatArray:
    """Return the errors of the events, NaN if their number is wrong."""
    return np.abs(found - exact) if found.shape == exact.shape else np.full(exact.shape, np.nan)


STEPS = (0.4, 0.2, 0.1, 0.05, 0.025)


@dataclass(frozen=True)
class Solver:
    """A solver at fixed steps (s)."""

    name: str
    order: int
    steps: tuple[float, ...]
    look: Mapping[str, Any]


SOLVERS = (
    Solver("RK44", 4, STEPS, {"color": BLUE, "marker": "o", "markersize": 6.0}),
    Solver("RK67", 6, (0.8, 0.4, 0.2, 0.1, 0.05), {"color": GREEN, "marker": "s", "markersize": 5.5}),
    Solver("GeneralizedAlpha", 2, STEPS, {"color": ORANGE, "marker": "^", "markersize": 8.0}),
    Solver("TrapezoidalIndex2", 2, STEPS, {"color": PURPLE, "marker": "x", "markersize": 4.5}),
)
