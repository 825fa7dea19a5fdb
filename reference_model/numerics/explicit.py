"""Dormand and Prince's explicit method of eighth order: SciPy's DOP853, faster for few unknowns.

Coefficients, step control and interpolant are SciPy's (Hairer, Nørsett and Wanner, Solving Ordinary Differential
Equations I, II.4 and II.5).
"""

import math
from collections.abc import Callable, Sequence

import numpy as np
from scipy.integrate import DOP853

from reference_model.systems import FloatArray

Rates = Callable[[list[float]], Sequence[float]]
"""Takes the unknowns and returns their rates; the equations are autonomous."""

Tolerated = Callable[[FloatArray], FloatArray]
"""Takes the unknowns and returns the allowed errors of a step."""

TIGHTEST = 3e-14
"""Smallest relative tolerance that SciPy's integrators accept."""

SAFETY, LEAST_FACTOR, LARGEST_FACTOR = 0.9, 0.2, 10.0
"""Safety factor, and smallest and largest ratio of successive steps."""

STAGES = DOP853.n_stages
_WEIGHTS = np.zeros((STAGES, STAGES + 1))
"""Row s combines y and h times the earlier rates into the unknowns of stage s + 1; the last row is for the end."""
_WEIGHTS[:-1, 1:] = DOP853.A[1:]
_WEIGHTS[-1, 1:] = DOP853.B
_ERRORS = np.vstack((DOP853.E5, DOP853.E3))


class Explicit(DOP853):  # type: ignore[misc]  # SciPy has no types
    """Steps of the method, with the interface of SciPy's solvers.

    ``first_step`` None chooses a step; ``most`` is the longest step.
    """

    t: float
    y: FloatArray
    f: FloatArray
    h_abs: float
    K_extended: FloatArray

    def __init__(
        self,
        rates: Rates,
        t: float,
        y: FloatArray,
        end: float,
        first_step: float | None,
        tolerated: Tolerated,
        most: float = math.inf,
    ) -> None:
        self._rates, self._tolerated, self._scale = rates, tolerated, tolerated(y)
        super().__init__(
            lambda _, y: rates(y.tolist()),
            t,
            y,
            end,
            first_step=first_step,
            max_step=most,
            rtol=TIGHTEST,
            atol=self._scale,
        )
        known = np.zeros((len(self.K_extended) + 1, self.n))  # y, then the rates at all stages
        self._known, self.K_extended, self.K = known, known[1:], known[1 : STAGES + 2]
        self._scaled = np.ones_like(_WEIGHTS)
        # A bound method with preallocated output takes a third of the time of an operator on such small arrays.
        self._new = np.empty(self.n)
        self._stages = [(self._scaled[s, : s + 2].dot, known[: s + 2], s + 2) for s in range(STAGES)]
        self._last_two: tuple[list[float], Sequence[float]] = [], []

    @property
    def stiffness(self) -> float:
        """Length of the last step times the decay rate by its last two stages (Hairer and Wanner II, IV.2)."""
        unknowns, rates = self._last_two
        apart = math.dist(self.y.tolist(), unknowns)
        return float(self.h_previous * math.dist(self.f.tolist(), rates) / apart) if apart > 0.0 else 0.0

    def _step_impl(self) -> tuple[bool, str | None]:
        t, y, known = self.t, self.y, self._known
        least = 10.0 * math.ulp(t)
        h = max(min(self.h_abs, self.max_step), least)
        most = LARGEST_FACTOR
        known[0], known[1] = y, self.f
        while True:
            if h < least:
                return False, self.TOO_SMALL_STEP
            end = min(t + h, self.t_bound)
            h = end - t
            new = self._take(h)
            scale = self._tolerated(new)
            error = self._size_of_error(h, np.maximum(self._scale, scale))
            if error < 1.0:
                break
            h *= max(LEAST_FACTOR, SAFETY * error**self.error_exponent)  # a NaN error selects LEAST_FACTOR
            most = 1.0
        self.h_previous, self.y_old, self._scale = h, y, scale
        self.t, self.y, self.f = end, new, known[STAGES + 1].copy()
        self.h_abs = h * (min(most, SAFETY * error**self.error_exponent) if error > 0.0 else most)
        return True, None

    def _take(self, h: float) -> FloatArray:
        known, rates, new = self._known, self._rates, self._new
        np.multiply(_WEIGHTS[:, 1:], h, out=self._scaled[:, 1:])
        unknowns: list[float] = []
        for weighted, before, row in self._stages:
            last, unknowns = unknowns, weighted(before, new).tolist()
            known[row] = rates(unknowns)
        self._last_two = last, known[STAGES].tolist()
        self.nfev += STAGES
        return new.copy()

    def _size_of_error(self, h: float, scale: FloatArray) -> float:
        fifth, third = _ERRORS.dot(self.K) / scale
        fifth, third = float(fifth.dot(fifth)), float(third.dot(third))
        if fifth == 0.0:
            return 0.0
        return h * fifth / math.sqrt((fifth + 0.01 * third) * self.n)
