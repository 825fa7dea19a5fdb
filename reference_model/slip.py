"""Slip, fast and near to rest, by SciPy's eighth-order Runge–Kutta method with the unregularised law.

While slip is fast, or grows, its components are unknowns. While it comes near to zero it is written s·n with a
unit vector n, and the unknowns are n and ln s, in the stretched time dτ = dt·√(s²+s₀²)/s. Friction depends on n
only, so that there these equations are smooth and not stiff down to s = 0, where n tends to a limit direction of the
discontinuity (Antali and Stépán 2019; of a pin, the direction of the pull) and the time that is left is s over
the rate at which s falls. No event has to be located.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial
from itertools import pairwise
from typing import NamedTuple

import numpy as np
from scipy.integrate import DenseOutput
from scipy.optimize import brentq

from reference_model.stepping import TIGHTEST, Edge, Run, Sampler, Stepper
from reference_model.support import Support
from reference_model.systems import FloatArray

Rates = Callable[[Sequence[float]], Sequence[float]]


@dataclass(frozen=True)
class Coordinates:
    """Unknowns in which a motion is written, and what it takes to follow it in them.

    The last ``slip`` of the unknowns are a relative velocity that friction may bring to rest.

    Parameters
    ----------
    rates : callable
        Takes the unknowns and returns their rates in 1/T, friction included; it is asked neither where the slip is
        zero.
    slip : int
        Number of components of the slip.
    slow : callable
        Takes the unknowns and returns the slip speed below which slip is slow.
    pace : float
        The largest rate at which anything but the slip changes, in 1/T.
    standard : callable
        Takes unknowns of shape (k, n) and returns the standard unknowns of the body, (unknowns, n).
    angle : int or None
        Which unknown is an angle, if one is: it counts by its absolute error.
    grip : callable or None
        How much more could be held of what friction holds in this motion, which ends when that falls to zero.
    edges : tuple of Edge
        Where friction or support are continuous but not smooth.

    """

    rates: Rates
    slip: int
    slow: Callable[[Sequence[float]], float]
    pace: float
    standard: Callable[[FloatArray], FloatArray] = lambda y: y
    angle: int | None = None
    grip: Callable[[Sequence[float]], float] | None = None
    edges: tuple[Edge, ...] = ()

    def speed(self, y: Sequence[float]) -> float:
        """Return the slip speed."""
        return math.hypot(*y[-self.slip :])

    def tolerances(self, run: Run, unknowns: int) -> FloatArray:
        """Return the relative tolerances of the first ``unknowns``."""
        result = np.full(unknowns, run.local_tolerance)
        if self.angle is not None:
            result[self.angle] = TIGHTEST
        return result


def stop_edges(support: Support) -> tuple[Edge, ...]:
    """Return where the stop of a support begins, for unknowns of which x and y are the first; none without one."""
    if support.stop_stiffness == 0.0 or support.stop_gap == 0.0:
        return ()

    def beyond(y: list[float]) -> float:
        return math.hypot(y[0] - support.offset, y[1]) - support.stop_gap

    def outward(y: list[float], rates: list[float]) -> float:
        return (y[0] - support.offset) * rates[0] + y[1] * rates[1]

    return (Edge(beyond, outward),)


class Outcome(NamedTuple):
    """When and where one description of the motion ended; ``let_go`` if that is because the grip was lost."""

    t: float
    y: list[float]
    let_go: bool = False


Leave = Callable[[list[float]], bool]
"""Tells of some unknowns whether the motion is to be described in another way from there on."""


def never(_: list[float]) -> bool:
    """Leave a description in its own time only."""
    return False


def slide(run: Run, motion: Coordinates, t: float, y: list[float], leave: Leave) -> Outcome:
    """Integrate until slip is slow and becomes slower, to the end, or until ``leave`` says so."""

    def rates(_: float, y: FloatArray) -> Sequence[float]:
        return motion.rates(y.tolist())

    solver = Stepper(run, rates, y, (t, run.end), motion.tolerances(run, len(y)), motion.edges)
    lost = None
    while t < run.end:
        solver.step(t)
        lost = _grip_lost(motion, solver, lambda y: y)
        t = solver.t if lost is None else lost
        if run.pending(t):
            run.record(t, partial(_standard, motion, solver.dense_output()))
        if lost is not None:
            y = solver.dense_output()(lost).tolist()
            break
        y = solver.y.tolist()
        falling = float(np.dot(solver.y[-motion.slip :], solver.rates[-motion.slip :])) < 0.0
        if (falling and motion.speed(y) < motion.slow(y)) or leave(y):
            break
    return Outcome(t, y, let_go=lost is not None)


def _standard(motion: Coordinates, dense: DenseOutput, times: FloatArray) -> FloatArray:
    """Return the standard unknowns in a step."""
    return motion.standard(dense(times))


def slide_slowly(run: Run, motion: Coordinates, start: float, y: list[float], leave: Leave) -> Outcome:
    """Integrate in slip-polar coordinates and stretched time until slip is fast again or zero."""
    d = motion.slip
    others = len(y) - d
    thresholds, s0 = run.thresholds, run.thresholds.stretching * motion.slow(y)

    def unknowns(stretched: list[float]) -> tuple[list[float], list[float], float]:
        """Return the unknowns, the direction n and the slip speed s."""
        n = stretched[others : others + d]
        size = math.hypot(*n)
        n = [part / size for part in n]
        # A trial step may overshoot wildly before it is rejected: exp() must not overflow there.
        s = math.exp(min(stretched[-2], 50.0))
        return stretched[:others] + [s * part for part in n], n, s

    def rates(_: float, stretched: FloatArray) -> Sequence[float]:
        y, n, s = unknowns(stretched.tolist())
        dy = motion.rates(y)
        growth = dy[others:]
        along = sum(a * b for a, b in zip(n, growth, strict=True))
        pace = math.hypot(s, s0)
        dt = s / pace  # dt/dτ
        return [
            *[rate * dt for rate in dy[:others]],
            *[(a - along * b) / pace for a, b in zip(growth, n, strict=True)],
            along / pace,
            dt,
        ]

    def sampler(dense: DenseOutput) -> Sampler:
        def sample(times: FloatArray) -> FloatArray:
            stretched = dense(_stretched_times(dense, times - start, s0))
            n = stretched[others : others + d]
            slip = np.exp(stretched[-2]) * n / np.linalg.norm(n, axis=0)
            return motion.standard(np.vstack((stretched[:others], slip)))

        return sample

    def stretched(edge: Edge) -> Edge:
        # Time goes on with the stretched time and x and y are unknowns themselves, so that the trend is the same.
        return Edge(lambda stretched: edge.value(unknowns(stretched)[0]), edge.trend)

    speed = motion.speed(y)
    # n, ln s and t count by their absolute error: that of t must not grow with the length of the run.
    relative = np.concatenate((motion.tolerances(run, others), np.full(d + 2, TIGHTEST)))
    initial = [*y[:others], *[part / speed for part in y[others:]], math.log(speed), 0.0]
    solver = Stepper(
        run, rates, initial, (0.0, math.inf), relative, [stretched(edge) for edge in motion.edges]
    )
    t = start
    while True:
        solver.step(t)
        lost = _grip_lost(motion, solver, lambda stretched: unknowns(stretched)[0])
        ending = solver.y.tolist() if lost is None else solver.dense_output()(lost).tolist()
        t = start + ending[-1]
        if run.pending(t):
            run.record(min(t, run.end), sampler(solver.dense_output()))
        y, n, s = unknowns(ending)
        if lost is not None or t >= run.end or s > 1.2 * motion.slow(y) or leave(y):
            break
        growth = motion.rates(y)[others:]
        falling = -sum(a * b for a, b in zip(n, growth, strict=True))
        if falling > 0.0:
            across = math.hypot(*(a + falling * b for a, b in zip(growth, n, strict=True)))
            left = s / falling
            if left * across / falling + left**2 * motion.pace < thresholds.rest_time:
                y = come_to_rest(run, motion, t, left, y)
                t += left
                break
            if s < thresholds.reversal_slip:
                y[others:] = [
                    0.0
                ] * d  # head-on, or at the limit of what friction holds: over within rounding
                break
    return Outcome(t, y, let_go=lost is not None)


def come_to_rest(run: Run, motion: Coordinates, t: float, left: float, y: list[float]) -> list[float]:
    """Follow the last ``left`` of slip, which falls linearly; return where it ends.

    The other unknowns go by the midpoint rule, whose error is of the order left³.
    """
    others = len(y) - motion.slip
    first = motion.rates(y)[:others]

    def after(delay: float) -> list[float]:
        share = 1.0 - 0.5 * delay / left
        middle = [a + 0.5 * delay * b for a, b in zip(y[:others], first, strict=True)]
        rates = motion.rates([*middle, *[share * part for part in y[others:]]])[:others]
        slip = [(1.0 - delay / left) * part for part in y[others:]]
        return [*[a + delay * b for a, b in zip(y[:others], rates, strict=True)], *slip]

    def sample(times: FloatArray) -> FloatArray:
        return motion.standard(np.array([after(float(time) - t) for time in times]).T)

    run.record(t + left, sample)
    return after(left)


def _grip_lost(
    motion: Coordinates, solver: Stepper, unknowns: Callable[[list[float]], list[float]]
) -> float | None:
    """Return where in the last step the grip falls to zero, or None if it holds throughout.

    ``unknowns`` turns what the solver integrates into the unknowns of the motion.
    """
    if motion.grip is None:
        return None
    grip, dense = motion.grip, solver.dense_output()

    def margin(tau: float) -> float:
        return grip(unknowns(dense(tau).tolist()))

    places = np.linspace(dense.t_min, dense.t_max, CHECKS_OF_GRIP + 1).tolist()
    for before, after in pairwise(places):
        if margin(after) < 0.0:
            lost: float = (
                brentq(margin, before, after, xtol=1e-15, rtol=TIGHTEST) if margin(before) > 0.0 else before
            )
            return lost
    return None


CHECKS_OF_GRIP = 8
"""Places in a step at which the grip is looked at; steps are short against the time in which it changes."""


def _stretched_times(dense: DenseOutput, delays: FloatArray, s0: float) -> FloatArray:
    """Return τ at which the last unknown of ``dense``, the time, takes the values ``delays``, by Newton's method.

    Time grows monotonically with τ inside of a step; where Newton's method would leave the step it is stopped
    at its end.
    """
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
