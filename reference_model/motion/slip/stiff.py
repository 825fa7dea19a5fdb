"""Stiff slip by an implicit method: creep, persistently slow slip, and strong damping.

If slip s stays small, its direction n relaxes to that of the pull at the rate g/s, which limits explicit steps to
about s/g. As functions of time n and ln s are smooth, so collocation takes steps as long as the motion allows.
"""

import math
from functools import partial

import numpy as np
from scipy.integrate import DenseOutput

from reference_model.motion.slip.coordinates import (
    FAST_AGAIN,
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


def slide_stiffly(
    run: Run, motion: Coordinates, start: float, y: list[float], leave: Leave, step: float
) -> Outcome:
    """Integrate implicitly while it pays, down to zero slip or ``leave``; ``step`` is that of the explicit method."""
    others = len(y) - motion.slip
    solver = _stepper(run, motion, start, y, 2.0 * step)
    t, taken, first = start, run.steps, motion.speed(y)
    slowly = first < motion.slow(y)
    while t < run.end:
        before = t
        try:
            solver.step(t)
        except StepError:
            run.patience *= 2
            break
        lost = grip_lost(motion, solver, partial(_one, others))
        t = solver.t if lost is None else lost
        if run.pending(t):
            run.record(t, partial(_standard, motion, others, solver.dense_output()))
        y = _one(others, (solver.y if lost is None else solver.dense_output()(lost)).tolist())
        if lost is not None:
            return Outcome(t, y, released=True)
        if t - start > COST * step * (run.steps - taken):
            run.patience = PATIENCE
        if t >= run.end or leave(y) or (slowly and motion.speed(y) > FAST_AGAIN * motion.slow(y)):
            break
        slow = motion.slow(y) > 0.0
        ended = slip_ends(run, motion, t, y) if slow else None
        if ended is not None:
            return ended
        # Slow slip limits explicit steps in stretched time more than stability does.
        explicit = step * motion.speed(y) / first if slowly else step
        if solver.settled and (t - before < COST * explicit or (solver.stiffness < WORTH and not slowly)):
            run.patience *= 2
            break
    return Outcome(t, y)


def _stepper(run: Run, motion: Coordinates, start: float, y: list[float], first_step: float) -> Stepper:
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
    speed = motion.speed(y)
    initial = [*y[:others], *[part / speed for part in y[others:]], math.log(speed)]
    surfaces = [surface.seen_by(partial(_one, others)) for surface in motion.surfaces]
    return Stepper(
        run,
        rates,
        initial,
        (start, run.end),
        motion.tolerated(run, others, d + 1, implicit=True),
        surfaces,
        (Scales(motion.differences, most), first_step),
    )


def _standard(motion: Coordinates, others: int, dense: DenseOutput, times: FloatArray) -> FloatArray:
    return motion.standard(_unknowns(others, dense(times))[0])


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
