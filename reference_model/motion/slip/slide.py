"""Slip with the unregularised law: fast and slow slip by an explicit method, stiff slip by an implicit one.

While slip is fast or grows, its components are unknowns of a Runge-Kutta method of eighth order. While it approaches
zero, the unknowns are ln s and the unit vector n of slip s·n, in the stretched time dτ = dt·√(s²+s₀²)/s. Friction
depends only on n, so these equations are smooth and not stiff down to s = 0, where n tends to a limit direction
(Antali and Stépán 2019).

If slip stays small, as in creep, n relaxes to the direction of the pull at the rate g/s, which limits explicit steps
to about s/g. As functions of time n and ln s are smooth, so collocation takes steps as long as the motion allows.
"""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial
from operator import mul

import numpy as np
from scipy.integrate import DenseOutput

from reference_model.motion.slip.coordinates import (
    FAST_AGAIN,
    LEAST_SLIP,
    Coordinates,
    Leave,
    Outcome,
    grip_lost,
    slip_ends,
)
from reference_model.motion.stepper import PATIENCE, Run, StepError, Stepper
from reference_model.numerics.collocation import Scales
from reference_model.systems import FloatArray

WORTH = 6.0
"""Smallest product of step and largest rate of an unstable explicit step."""

COST = 4.0
"""Work of an implicit step relative to an explicit one."""


@dataclass(frozen=True)
class _Slip:
    """Slip that ``solver`` follows in its own unknowns, which ``unknowns`` converts to those of ``motion``.

    ``sample`` takes the interpolant of a step and times, and returns standard unknowns. ``clock`` takes the solver's
    time and unknowns and returns the time.
    """

    run: Run
    motion: Coordinates
    solver: Stepper
    unknowns: Callable[[list[float]], list[float]]
    sample: Callable[[DenseOutput, FloatArray], FloatArray]
    clock: Callable[[float, list[float]], float] = lambda tau, _: tau

    def step(self, t: float) -> Outcome:
        """Take and record one step from ``t``, at most to where the grip is lost."""
        solver = self.solver
        solver.step(t)
        lost = grip_lost(self.motion, solver, self.unknowns)
        solved = (solver.y if lost is None else solver.dense_output()(lost)).tolist()
        t = self.clock(solver.t if lost is None else lost, solved)
        if self.run.pending(t):
            self.run.record(t, partial(self.sample, solver.dense_output()))
        return Outcome(t, self.unknowns(solved), released=lost is not None)

    def stiff_for_long(self, before: Outcome, now: Outcome) -> bool:
        d = self.motion.slip
        change = math.dist(before.y[-d:], now.y[-d:]) / max(self.motion.speed(now.y), LEAST_SLIP)
        return self.solver.stiff_for_long(change + now.t - before.t)


def slide(run: Run, motion: Coordinates, t: float, y: list[float], leave: Leave) -> Outcome:
    """Integrate until slip is slow and decelerates, the run ends, or ``leave`` returns True."""
    solver = Stepper(run, motion.rates, y, (t, run.end), motion.tolerated(run, len(y)), motion.surfaces)
    slip = _Slip(run, motion, solver, lambda y: y, lambda dense, times: motion.standard(dense(times)))
    now = Outcome(t, y)
    while now.t < run.end:
        before, now = now, slip.step(now.t)
        y = now.y
        if now.released or (motion.speed(y) < motion.slow(y) and _falling(motion, solver)) or leave(y):
            break
        if slip.stiff_for_long(before, now) and motion.speed(y) > 0.0:
            return _slide_stiffly(run, motion, now.t, y, leave, now.t - before.t)
    return now


def _falling(motion: Coordinates, solver: Stepper) -> bool:
    return float(np.dot(solver.y[-motion.slip :], solver.rates[-motion.slip :])) < 0.0


def slide_slowly(run: Run, motion: Coordinates, start: float, y: list[float], leave: Leave) -> Outcome:
    """Integrate in slip-polar coordinates and stretched time until slip is fast again or zero."""
    d = motion.slip
    others = len(y) - d
    s0 = run.thresholds.stretching * motion.slow(y)

    def parts(stretched: list[float]) -> tuple[list[float], list[float], float]:
        n = stretched[others : others + d]
        size = math.hypot(*n)
        n = [part / size for part in n]
        # A trial step may overshoot by far before it is rejected: exp() must not overflow.
        s = math.exp(min(stretched[-2], 50.0))
        return [*stretched[:others], *[s * part for part in n]], n, s

    def unknowns(stretched: list[float]) -> list[float]:
        return parts(stretched)[0]

    def rates(stretched: list[float]) -> Sequence[float]:
        y, n, s = parts(stretched)
        dy = motion.rates(y)
        growth = dy[others:]
        along = sum(map(mul, n, growth))
        pace = math.hypot(s, s0)
        dt = s / pace  # dt/dτ
        return [
            *[rate * dt for rate in dy[:others]],
            *[(a - along * b) / pace for a, b in zip(growth, n, strict=True)],
            along / pace,
            dt,
        ]

    tolerated = motion.tolerated(run, others, polar=d + 2)
    surfaces = [surface.seen_by(unknowns) for surface in motion.surfaces]
    solver = Stepper(run, rates, [*_polar(motion, y), 0.0], (0.0, math.inf), tolerated, surfaces)
    sample = partial(_stretched, motion, start, s0)
    slip = _Slip(run, motion, solver, unknowns, sample, lambda _, stretched: start + stretched[-1])
    now = Outcome(start, y)
    while True:
        before, now = now, slip.step(now.t)
        t, y = now.t, now.y
        if now.released or t >= run.end or motion.speed(y) > FAST_AGAIN * motion.slow(y) or leave(y):
            return now
        ended = slip_ends(run, motion, t, y)
        if ended is not None:
            return ended
        if slip.stiff_for_long(before, now):
            return _slide_stiffly(run, motion, t, y, leave, t - before.t)


def _polar(motion: Coordinates, y: list[float]) -> list[float]:
    """Return the unknowns with the unit vector and the logarithm of slip in place of its components."""
    others, speed = len(y) - motion.slip, motion.speed(y)
    return [*y[:others], *[part / speed for part in y[others:]], math.log(speed)]


def _stretched(
    motion: Coordinates, start: float, s0: float, dense: DenseOutput, times: FloatArray
) -> FloatArray:
    d = motion.slip
    stretched = dense(_stretched_times(dense, times - start, s0))
    n = stretched[-2 - d : -2]
    slip = np.exp(stretched[-2]) * n / np.linalg.norm(n, axis=0)
    return motion.standard(np.vstack((stretched[: -2 - d], slip)))


def _stretched_times(dense: DenseOutput, delays: FloatArray, s0: float) -> FloatArray:
    """Return τ for ``delays`` of the time, the last unknown of ``dense``, by Newton's method."""
    first, last = dense.t_min, dense.t_max
    t_first, t_last = dense(first)[-1], dense(last)[-1]
    tau: FloatArray = first + (last - first) * (delays - t_first) / (t_last - t_first)
    for _ in range(50):
        y = dense(tau)
        s = np.exp(y[-2])
        correction = (y[-1] - delays) * np.hypot(s, s0) / s
        tau = np.clip(tau - correction, first, last)
        if np.all(np.abs(y[-1] - delays) <= 4.0 * np.finfo(float).eps * max(abs(t_last), 1.0)):
            break
    return tau


def _slide_stiffly(
    run: Run, motion: Coordinates, start: float, y: list[float], leave: Leave, step: float
) -> Outcome:
    """Integrate implicitly while it pays, down to zero slip or ``leave``; ``step`` is that of the explicit method."""
    others = len(y) - motion.slip
    solver = _implicit(run, motion, start, y, 2.0 * step)

    def sample(dense: DenseOutput, times: FloatArray) -> FloatArray:
        return motion.standard(_unknowns(others, dense(times))[0])

    slip, now = _Slip(run, motion, solver, partial(_one, others), sample), Outcome(start, y)
    taken, first = run.steps, motion.speed(y)
    slowly = first < motion.slow(y)
    while now.t < run.end:
        before = now.t
        try:
            now = slip.step(before)
        except StepError:
            run.patience *= 2
            break
        t, y = now.t, now.y
        if now.released:
            break
        if t - start > COST * step * (run.steps - taken):
            run.patience = PATIENCE
        if t >= run.end or leave(y) or (slowly and motion.speed(y) > FAST_AGAIN * motion.slow(y)):
            break
        ended = slip_ends(run, motion, t, y) if motion.slow(y) > 0.0 else None
        if ended is not None:
            return ended
        # Slow slip limits explicit steps in stretched time more than stability does.
        explicit = step * motion.speed(y) / first if slowly else step
        if solver.settled and (t - before < COST * explicit or (solver.stiffness < WORTH and not slowly)):
            run.patience *= 2
            break
    return now


def _implicit(run: Run, motion: Coordinates, start: float, y: list[float], first_step: float) -> Stepper:
    d = motion.slip
    others = len(y) - d

    def rates(polar: FloatArray) -> FloatArray:
        y, n, s = _unknowns(others, polar)
        dy = motion.rates_at(y)
        growth = dy[others:]
        along = (n * growth).sum(axis=0)
        result = np.empty_like(polar)
        result[:others] = dy[:others]
        result[others:-1] = (growth - along * n) / s
        result[-1] = along / s
        return result

    most = np.full(others + d + 1, math.inf)
    most[-1] = 1.0
    surfaces = [surface.seen_by(partial(_one, others)) for surface in motion.surfaces]
    return Stepper(
        run,
        rates,
        _polar(motion, y),
        (start, run.end),
        motion.tolerated(run, others, d + 1, implicit=True),
        surfaces,
        (Scales(motion.differences, most), first_step),
    )


def _one(others: int, polar: list[float]) -> list[float]:
    return list(_unknowns(others, np.array([polar]).T)[0][:, 0].tolist())


def _unknowns(others: int, polar: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
    n = polar[others:-1]
    size = np.sqrt((n * n).sum(axis=0))
    n = n / np.where(size > 0.0, size, 1.0)
    s = np.exp(np.clip(polar[-1], -500.0, 50.0))  # a trial step may overshoot by far
    y = polar[:-1].copy()
    y[others:] = s * n
    return y, n, s
