"""Fast and slow slip by an explicit Runge-Kutta method of eighth order with the unregularised law.

While slip is fast or grows, its components are unknowns. While it approaches zero, the unknowns are ln s and the unit
vector n of slip s·n, in the stretched time dτ = dt·√(s²+s₀²)/s. Friction depends only on n, so these equations are
smooth and not stiff down to s = 0, where n tends to a limit direction (Antali and Stépán 2019).
"""

import math
from collections.abc import Sequence
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
from reference_model.motion.slip.stiff import slide_stiffly
from reference_model.motion.stepper import Run, Stepper
from reference_model.systems import FloatArray


def slide(run: Run, motion: Coordinates, t: float, y: list[float], leave: Leave) -> Outcome:
    """Integrate until slip is slow and decelerates, the run ends, or ``leave`` returns True."""
    solver = Stepper(run, motion.rates, y, (t, run.end), motion.tolerated(run, len(y)), motion.surfaces)
    lost = None
    while t < run.end:
        before, slip = t, y[-motion.slip :]
        solver.step(t)
        lost = grip_lost(motion, solver, lambda y: y)
        t = solver.t if lost is None else lost
        if run.pending(t):
            run.record(t, partial(_standard, motion, solver.dense_output()))
        if lost is not None:
            y = solver.dense_output()(lost).tolist()
            break
        y = solver.y.tolist()
        if (motion.speed(y) < motion.slow(y) and _falling(motion, solver)) or leave(y):
            break
        if solver.stiff_for_long(_change(slip, y) + t - before) and motion.speed(y) > 0.0:
            return slide_stiffly(run, motion, t, y, leave, t - before)
    return Outcome(t, y, released=lost is not None)


def _change(before: list[float], y: list[float]) -> float:
    after = y[-len(before) :]
    return math.dist(before, after) / max(math.hypot(*after), LEAST_SLIP)


def _falling(motion: Coordinates, solver: Stepper) -> bool:
    return float(np.dot(solver.y[-motion.slip :], solver.rates[-motion.slip :])) < 0.0


def _standard(motion: Coordinates, dense: DenseOutput, times: FloatArray) -> FloatArray:
    return motion.standard(dense(times))


def slide_slowly(run: Run, motion: Coordinates, start: float, y: list[float], leave: Leave) -> Outcome:
    """Integrate in slip-polar coordinates and stretched time until slip is fast again or zero."""
    d = motion.slip
    others = len(y) - d
    s0 = run.thresholds.stretching * motion.slow(y)

    def unknowns(stretched: list[float]) -> tuple[list[float], list[float], float]:
        n = stretched[others : others + d]
        size = math.hypot(*n)
        n = [part / size for part in n]
        # A trial step may overshoot by far before it is rejected: exp() must not overflow.
        s = math.exp(min(stretched[-2], 50.0))
        return [*stretched[:others], *[s * part for part in n]], n, s

    def rates(stretched: list[float]) -> Sequence[float]:
        y, n, s = unknowns(stretched)
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

    speed = motion.speed(y)
    tolerated = motion.tolerated(run, others, polar=d + 2)
    initial = [*y[:others], *[part / speed for part in y[others:]], math.log(speed), 0.0]
    surfaces = [surface.seen_by(lambda stretched: unknowns(stretched)[0]) for surface in motion.surfaces]
    solver = Stepper(run, rates, initial, (0.0, math.inf), tolerated, surfaces)
    t = start
    while True:
        before, slip = t, y[-motion.slip :]
        solver.step(t)
        lost = grip_lost(motion, solver, lambda stretched: unknowns(stretched)[0])
        ending = solver.y.tolist() if lost is None else solver.dense_output()(lost).tolist()
        t = start + ending[-1]
        if run.pending(t):
            run.record(t, partial(_stretched, motion, start, s0, solver.dense_output()))
        y, _, s = unknowns(ending)
        if lost is not None or t >= run.end or s > FAST_AGAIN * motion.slow(y) or leave(y):
            break
        ended = slip_ends(run, motion, t, y)
        if ended is not None:
            return ended
        if solver.stiff_for_long(_change(slip, y) + t - before):
            return slide_stiffly(run, motion, t, y, leave, t - before)
    return Outcome(t, y, released=lost is not None)


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
