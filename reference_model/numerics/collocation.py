"""Radau IIA collocation: an implicit method of high order for stiff motions, with a dense polynomial.

A polynomial passes through the start of a step and solves the equations of motion at its nodes, the last of them at
the end (Hairer and Wanner, Solving Ordinary Differential Equations II, IV.5). Tolerances down to 1e-14 need its order
15; SciPy's ``Radau`` has order 5.
"""

import math
from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from numpy.polynomial import legendre
from scipy.integrate import DenseOutput
from scipy.special import roots_jacobi

from reference_model.numerics.explicit import Tolerated
from reference_model.systems import FloatArray

NODES = 8
POINTS = np.append(roots_jacobi(NODES - 1, 1.0, 0.0)[0], 1.0)
"""Radau nodes in [−1, 1], the last at 1."""

TO_SERIES = np.linalg.inv(legendre.legvander(POINTS, NODES - 1))
"""Matrix from values at the nodes to Legendre coefficients."""

INTEGRAL = 0.5 * legendre.legval(POINTS, legendre.legint(TO_SERIES, lbnd=-1)).T
"""Matrix from values at the nodes to integrals from 0 to the nodes, scaled to [0, 1]."""

FROM_START = np.linalg.inv(legendre.legvander(np.append(-1.0, POINTS), NODES))
"""Matrix from values at the start and the nodes to Legendre coefficients."""

MOST_ITERATIONS, MOST_JACOBIANS = 10, 3
"""Largest numbers of Newton iterations and of Jacobians, which take most of the work."""

CONVERGED = 0.01
"""Change of the unknowns in a converged Newton iteration, as a share of their tolerances."""

STALLED = 0.3
"""Ratio of successive changes above which Newton's method needs a new Jacobian."""

LARGEST_GROWTH = 2.0

SETTLED = 5
"""Number of successive steps with little growth that count as settled."""

LEAST_SHARE = 1e-8
"""Smallest step as a share of the first."""


def newton_matrix(jacobians: FloatArray, step: float) -> FloatArray:
    """Return the Newton matrix for Jacobians at the nodes, shape (NODES, n, n)."""
    size = NODES * jacobians.shape[1]
    coupling = np.einsum("ij,jkl->ikjl", INTEGRAL, jacobians).reshape(size, size)
    return np.asarray(np.eye(size) - step * coupling)


RatesAt = Callable[[FloatArray], FloatArray]
"""Takes the unknowns of many states, shape (n, k), and returns their rates."""


def jacobians_at(rates: RatesAt, values: FloatArray, found: FloatArray, changes: FloatArray) -> FloatArray:
    """Return the Jacobians of the rates at the nodes by differences, shape (NODES, n, n).

    ``values``, their rates ``found`` and their ``changes`` have the shape (NODES, n).
    """
    nodes, n = values.shape
    moved = values[:, np.newaxis] + changes[:, np.newaxis] * np.eye(n)
    rates_moved = rates(moved.reshape(-1, n).T).T.reshape(nodes, n, n)
    quotients = (rates_moved - found[:, np.newaxis]) / changes[:, :, np.newaxis]
    return np.asarray(quotients.transpose(0, 2, 1))


class Scales(NamedTuple):
    """Scales of the unknowns of a motion.

    ``differences`` takes unknowns (k, n) and returns their changes for numerical derivatives. ``most``, shape (n,),
    are the largest changes in a Newton iteration.
    """

    differences: Callable[[FloatArray], FloatArray]
    most: FloatArray


class Polynomial(DenseOutput):  # type: ignore[misc]  # SciPy has no types
    """The motion in a step as a Legendre series with ``coefficients`` (NODES + 1, n)."""

    def __init__(self, first: float, last: float, coefficients: FloatArray) -> None:
        super().__init__(first, last)
        self.coefficients = coefficients

    def beyond(self, t: FloatArray, noise: FloatArray) -> FloatArray:
        """Return the extrapolation to ``t`` (k,) without terms below ``noise`` (n,), shape (k, n)."""
        seen = np.where(abs(self.coefficients) > noise, self.coefficients, 0.0)
        return np.asarray(legendre.legval(self._place(t), seen).T)

    def _call_impl(self, t: FloatArray) -> FloatArray:
        return np.asarray(legendre.legval(self._place(t), self.coefficients))

    def _place(self, t: FloatArray) -> FloatArray:
        return np.asarray((2.0 * t - (self.t_old + self.t)) / (self.t - self.t_old))


class Radau:
    """Steps by collocation, with an interface like that of SciPy's solvers.

    ``tolerated`` takes the unknowns, shape (n,), and returns the allowed errors of a step.
    """

    def __init__(
        self,
        rates: RatesAt,
        t: float,
        y: FloatArray,
        end: float,
        first_step: float,
        tolerated: Tolerated,
        scales: Scales,
    ) -> None:
        self._fun, self.t_bound, self._tolerance_at, self._scales = rates, end, tolerated, scales
        self.t, self.y = t, np.asarray(y)
        self.status, self.nfev = "running", 0
        self.f = self._rates(self.y[:, np.newaxis])[:, 0]
        self._tolerated = tolerated(self.y)
        self._next = first_step
        self._least = LEAST_SHARE * first_step
        self._polynomial: Polynomial | None = None
        self._jacobian = np.zeros((len(y), len(y)))
        self._unchanged = 0

    @property
    def settled(self) -> bool:
        """True if the step size has settled."""
        return self._unchanged >= SETTLED

    @property
    def stiffness(self) -> float:
        """Length of the last step times the largest rate at its end."""
        polynomial = self.dense_output()
        return float((polynomial.t - polynomial.t_old) * np.max(abs(np.linalg.eigvals(self._jacobian))))

    def dense_output(self) -> Polynomial:
        """Return the polynomial of the last step."""
        assert self._polynomial is not None
        return self._polynomial

    def step(self) -> str | None:
        """Take one step; return an error message, or None."""
        h, most = self._next, LARGEST_GROWTH
        while True:
            h = min(h, self.t_bound - self.t)
            if h < self._least and self.t + h < self.t_bound:
                self.status = "failed"
                return "the equations of a step could not be solved"
            polynomial = self._collocate(h)
            if polynomial is None:
                h *= 0.5
                most = 1.0
                continue
            tail = abs(polynomial.coefficients[-2:]) / self._tolerated
            error = max(float(tail[1].max()), 0.1 * float(tail[0].max()))
            change = 0.8 * max(error, 1e-16) ** (-1.0 / NODES)
            if error <= 1.0:
                break
            h *= max(0.1, change)
        before = self._next if self._polynomial is None else self._polynomial.t - self._polynomial.t_old
        self.t = self.t_bound if h == self.t_bound - self.t else self.t + h
        self.y = polynomial(self.t)
        self.f = self._rates(self.y[:, np.newaxis])[:, 0]
        self._tolerated = self._tolerance_at(self.y)
        self._unchanged = self._unchanged + 1 if h < 1.5 * before else 0
        self._next = h * min(most, change)
        self._polynomial = polynomial
        if self.t == self.t_bound:
            self.status = "finished"
        return None

    @np.errstate(over="ignore", divide="ignore", invalid="ignore")
    def _collocate(self, h: float) -> Polynomial | None:
        places = self.t + 0.5 * h * (POINTS + 1.0)
        if self._polynomial is None:
            values = self.y + np.outer(places - self.t, self.f)
        else:
            values = self._polynomial.beyond(places, CONVERGED * self._tolerated)
        inverse = None
        last, found = math.inf, 0
        for _ in range(MOST_ITERATIONS):
            rates = self._rates(values.T).T
            if not np.all(np.isfinite(rates)):
                return None
            if inverse is None:
                if found == MOST_JACOBIANS:
                    return None
                found += 1
                jacobians = jacobians_at(self._rates, values, rates, self._scales.differences(values))
                try:
                    matrix = newton_matrix(jacobians, h)
                    rows = 1.0 / np.max(abs(matrix), axis=1)
                    inverse = np.linalg.inv(matrix * rows[:, np.newaxis]) * rows
                except np.linalg.LinAlgError:
                    return None
            residual = values - self.y - h * (INTEGRAL @ rates)
            change = (inverse @ residual.ravel()).reshape(values.shape)
            values = values - np.clip(change, -self._scales.most, self._scales.most)
            size = float(np.max(abs(change) / self._tolerated))
            if not math.isfinite(size):
                return None
            if size < CONVERGED or STALLED * last < size < 0.5:
                self._jacobian = jacobians[-1]
                coefficients = FROM_START @ np.vstack((self.y, values))
                return Polynomial(self.t, self.t + h, coefficients)
            if size > STALLED * last:
                inverse = None
            last = size
        return None

    def _rates(self, values: FloatArray) -> FloatArray:
        self.nfev += values.shape[1]
        return self._fun(values)
