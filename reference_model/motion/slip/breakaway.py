"""The beginning of slip from rest, for any law.

Slip that begins at the friction limit grows like ½κt² along the pull, which is stiff but smooth. So implicit
collocation (:mod:`reference_model.numerics.collocation`) needs only a few steps until an explicit method can follow.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial

import numpy as np

from reference_model.motion.slip.coordinates import LEAST_SLIP, Coordinates, Leave, Outcome
from reference_model.motion.stepper import Run
from reference_model.numerics.collocation import (
    FROM_START,
    INTEGRAL,
    NODES,
    POINTS,
    TO_SERIES,
    Polynomial,
    RatesAt,
    jacobians_at,
    newton_matrix,
)
from reference_model.systems import FloatArray
from reference_model.trajectory import SimulationError

FIRST_STEP = 0.01
"""Scaled first step, which shrinks until the motion is resolved."""

LEAST_STEP = 1e-12

MOMENT = 1e-6
"""Scaled time for the difference quotient of the pull."""

TURN = 1e-7
"""Change of direction for the difference quotient of friction."""

STIFF = 10.0
"""Stiffness of a step (rate times length) below which an explicit method is as efficient."""

FASTER = 0.01
"""Relative change of the slip speed for the derivative along the slip."""

MOST_ITERATIONS = 12


def begin_slip(
    run: Run,
    motion: Coordinates,
    t: float,
    y: Sequence[float],
    drift: Sequence[float],
    direction: FloatArray,
    leave: Leave,
) -> Outcome:
    """Follow slip from rest until an explicit method in standard unknowns can continue.

    ``y`` are the initial unknowns without the slip, ``drift`` their rates at rest, and ``direction``, shape (slip,),
    the unit vector of the incipient slip. Raises ``SimulationError`` if the motion cannot be resolved.
    """
    expected = _leading_order(motion, np.array(y), np.array(drift), direction)
    start, step, since = expected(np.zeros(1))[0], FIRST_STEP, t
    while t < run.end:
        run.count_step(t)
        piece = _collocate(run, motion, start, step, expected(step * 0.5 * (POINTS + 1.0)))
        if piece is None and t > since:
            break  # friction changes sharply, as where one point hardly slips
        if piece is None or piece.error > run.thresholds.series:
            step *= 0.25 if piece is None else max(0.25, piece.change_of_step(run.thresholds.series))
            if step < LEAST_STEP:
                raise SimulationError(
                    f"slip that begins at t = {run.seconds(t):g} s could not be resolved: the force is too close to "
                    "the friction limit; change the parameters slightly"
                )
            continue
        stop = min(t + step, run.end)
        run.record(stop, partial(_sample, motion, piece, t))
        start, t = piece.at(np.array([stop - t]))[0], stop
        if piece.falling or step * piece.stiffness < STIFF or leave(start.tolist()):
            break
        step *= min(4.0, piece.change_of_step(run.thresholds.series))
        expected = piece.beyond
    return Outcome(t, start.tolist())


def _leading_order(
    motion: Coordinates, others: FloatArray, carried: FloatArray, direction: FloatArray
) -> Callable[[FloatArray], FloatArray]:
    """Return the unknowns to leading order as a function of times (n,) since slip began, shape (n, unknowns).

    Slip s·e with s = first·t + ½·gain·t² and e = direction + turning·t grows by d(s·e)/dt = at_first + t·(change −
    J·turning), where J need not be symmetric.
    """

    def growth(delay: float, towards: FloatArray) -> FloatArray:
        rates = motion.rates([*(others + delay * carried), *(LEAST_SLIP * towards)])
        return np.array(rates[len(others) :])

    axes, along = np.eye(len(direction)), np.outer(direction, direction)
    at_first = growth(0.0, direction)
    first = max(float(at_first @ direction), 0.0)
    change = (growth(MOMENT, direction) - at_first) / MOMENT
    turned = [growth(0.0, direction + TURN * axis) for axis in axes]
    resistance = (at_first[:, np.newaxis] - np.transpose(turned)) / TURN @ (axes - along)
    solved = np.linalg.solve(resistance + 2.0 * first * (axes - along) + along, change)
    gain = float(solved @ direction)
    turning = solved - gain * direction

    def begun(delays: FloatArray) -> FloatArray:
        after = delays[:, np.newaxis]
        slip = (first * after + 0.5 * gain * after**2) * (direction + turning * after)
        return np.hstack((others + after * carried, slip))

    return begun


@dataclass(frozen=True, eq=False)
class _Piece:
    """A polynomial that solves the equations of motion at the nodes of one step.

    It interpolates the values, because stiffness amplifies the residual of Newton's method in an integral of the
    rates. At the end ``stiffness`` is the relaxation rate of the direction of slip in 1/T, and ``falling`` is True if
    slip decelerates.
    """

    values: Polynomial
    rates: FloatArray
    stiffness: float
    falling: bool

    @property
    def error(self) -> float:
        """Contribution of the last terms of the series of values or rates, whichever contains less noise."""
        sizes = 1.0 + abs(self.values.coefficients[0])
        by_values = abs(self.values.coefficients[-2:]) / sizes
        by_rates = self.values.t * abs(TO_SERIES[-2:] @ self.rates) / sizes
        return float(min(np.max(by_values), np.max(by_rates)))

    def change_of_step(self, tolerance: float) -> float:
        return float(0.8 * (tolerance / max(self.error, 1e-300)) ** (1.0 / NODES))

    def at(self, delays: FloatArray) -> FloatArray:
        return self.values.beyond(delays, np.zeros(1))

    def beyond(self, delays: FloatArray) -> FloatArray:
        return self.at(self.values.t + delays)


def _sample(motion: Coordinates, piece: _Piece, t: float, times: FloatArray) -> FloatArray:
    return motion.standard(piece.at(times - t).T)


@np.errstate(over="ignore", divide="ignore", invalid="ignore")
def _collocate(
    run: Run, motion: Coordinates, start: FloatArray, step: float, values: FloatArray
) -> _Piece | None:
    """Solve for the unknowns at the nodes by Newton's method from ``values``; None without convergence."""
    others = len(start) - motion.slip

    def rates_at(unknowns: FloatArray) -> FloatArray:
        run.evaluations += unknowns.shape[1]
        return motion.rates_at(unknowns)

    for _ in range(MOST_ITERATIONS):
        rates = rates_at(values.T).T
        if not np.all(np.isfinite(rates)):
            return None
        jacobians = _jacobians(motion, rates_at, values, rates)
        residual = values - start - step * (INTEGRAL @ rates)
        try:
            change = np.linalg.solve(newton_matrix(jacobians, step), residual.ravel())
        except np.linalg.LinAlgError:
            return None
        change = change.reshape(values.shape)
        values = values - change
        slip = np.linalg.norm(values[:, others:], axis=1)
        converged = np.linalg.norm(change[:, others:], axis=1) < 1e-9 * slip + 1e-15 * step
        if converged.all() and np.all(abs(change) < 1e-13 * (1.0 + abs(values))):
            rates = rates_at(values.T).T
            return _Piece(
                Polynomial(0.0, step, FROM_START @ np.vstack((start, values))),
                rates,
                stiffness=float(np.linalg.norm(jacobians[-1][others:, others:], 2)),
                falling=bool(np.dot(values[-1][others:], rates[-1][others:]) <= 0.0),
            )
    return None


def _jacobians(motion: Coordinates, rates_at: RatesAt, values: FloatArray, rates: FloatArray) -> FloatArray:
    """Return the Jacobians of the rates at the nodes, shape (NODES, n, n).

    Friction hardly changes with the slip speed, so this derivative needs larger differences.
    """
    slips = values[:, -motion.slip :]
    speeds = np.maximum(np.linalg.norm(slips, axis=1, keepdims=True), LEAST_SLIP)
    changes = motion.differences(values)
    changes[:, -motion.slip :] *= speeds
    jacobians = jacobians_at(rates_at, values, rates, changes)
    faster = values.copy()
    faster[:, -motion.slip :] *= 1.0 + FASTER
    along = (rates_at(faster.T).T - rates) / (FASTER * speeds)
    n = slips / speeds
    by_slip = jacobians[:, :, -motion.slip :]
    by_slip += (along - np.einsum("ijk,ik->ij", by_slip, n))[:, :, np.newaxis] * n[:, np.newaxis]
    return jacobians
