"""Unknowns in which a motion is written, and what all descriptions of slip share: how it ends."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import NamedTuple

import numpy as np
from scipy.optimize import brentq

from reference_model.motion.stepper import Run, Stepper, SwitchingSurface
from reference_model.numerics.explicit import TIGHTEST, Tolerated
from reference_model.support import Support
from reference_model.systems import FloatArray

Rates = Callable[[Sequence[float]], Sequence[float]]

LEAST_SLIP = 1e-100
"""A slip speed that stands for none, but gives friction a direction."""

DIFFERENCE = 1e-7
"""Change of unknowns of order one by which derivatives are found."""

TIGHTEST_IMPLICIT = 3e-13
"""Error of a step, on unknowns of order one, below which rounding is felt in the solution of implicit equations."""

LOOSEST_IMPLICIT = 0.03
"""The largest error of an implicit step in ln s."""

SHARE = 1e-5
"""Change of a relative velocity, as a share of it, by which derivatives are found if that is less."""


@dataclass(frozen=True)
class Coordinates:
    """Unknowns in which a motion is written, and what it takes to follow it in them.

    The last ``slip`` of the unknowns are a relative velocity that friction may bring to rest.

    Parameters
    ----------
    rates : callable
        Takes the unknowns and returns their rates in 1/T, friction included; it is asked neither where the slip is
        zero.
    many : callable
        The same for arrays of shape (k,) in place of numbers.
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
    turning : int or None
        Which unknown besides the slip is a relative velocity, if one is: friction may change with it at its own size,
        however small that is.
    leverage : float
        By how much the velocity of the centre changes with the slip.
    grip : callable or None
        How much more could be held of what friction holds in this motion, which ends when that falls to zero.
    surfaces : tuple of SwitchingSurface
        Where friction or support are continuous but not smooth.

    """

    rates: Rates
    many: Callable[..., Sequence[object]]
    slip: int
    slow: Callable[[Sequence[float]], float]
    pace: float
    standard: Callable[[FloatArray], FloatArray] = lambda y: y
    angle: int | None = None
    turning: int | None = None
    leverage: float = 1.0
    grip: Callable[[Sequence[float]], float] | None = None
    surfaces: tuple[SwitchingSurface, ...] = ()

    def rates_at(self, unknowns: FloatArray) -> FloatArray:
        """Return the rates at many ``unknowns``, shape (unknowns, k)."""
        return np.array(self.many(unknowns))

    def speed(self, y: Sequence[float]) -> float:
        """Return the slip speed."""
        return math.hypot(*y[-self.slip :])

    def differences(self, unknowns: FloatArray) -> FloatArray:
        """Return changes of ``unknowns`` (k, n), of which the first are these, by which derivatives are found."""
        changes = np.full(unknowns.shape, DIFFERENCE)
        if self.turning is not None:
            own = SHARE * abs(unknowns[:, self.turning]) + LEAST_SLIP
            changes[:, self.turning] = np.minimum(DIFFERENCE, own)
        return changes

    def tolerated(self, run: Run, unknowns: int, polar: int = 0, implicit: bool = False) -> Tolerated:
        """Return a function for the error that a step may have in each of the first ``unknowns``.

        ``polar`` more unknowns may follow: the ``slip`` components of a direction, ln s and so on. They count by
        their absolute error. In an implicit step the error of s counts instead of that of ln s, because slip that
        decays for a long time would need many steps otherwise. Explicit steps keep the tighter bound: at each
        reversal they would add the tolerance once more to the error of the run.
        """
        relative = np.full(unknowns + polar, TIGHTEST)
        relative[:unknowns] = run.local_tolerance
        if self.angle is not None:
            relative[self.angle] = TIGHTEST
        tolerance, logarithm = run.local_tolerance, unknowns + self.slip
        loosest = tolerance
        if implicit:
            tolerance, loosest = max(tolerance, TIGHTEST_IMPLICIT), LOOSEST_IMPLICIT

        def errors(y: FloatArray) -> FloatArray:
            result = np.asarray(tolerance + relative * abs(y))
            if polar:
                over_slip = math.exp(min(-float(y[logarithm]), 500.0))
                result[logarithm] = min(tolerance / self.leverage * over_slip, loosest)
            return result

        return errors


def stop_surfaces(support: Support) -> tuple[SwitchingSurface, ...]:
    """Return where the stop of a support begins, for unknowns of which x and y are the first; none without one."""
    if support.stop_stiffness == 0.0 or support.stop_gap == 0.0:
        return ()

    def beyond(y: list[float]) -> float:
        return math.hypot(y[0] - support.offset, y[1]) - support.stop_gap

    def outward(y: list[float], rates: list[float]) -> float:
        return (y[0] - support.offset) * rates[0] + y[1] * rates[1]

    return (SwitchingSurface(beyond, outward),)


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


FAST_AGAIN = 1.2
"""Slip speed over that below which slip is slow, from which it is so no more."""

NO_WAY, LEAST_WAY = 0.1, 1e-12
"""Way that lingering slip may have left, as a share of the local tolerance and in units, for it to count as over."""

LONG = 0.01
"""Time that slip takes to vanish, in units, from which it lingers."""


def slip_ends(run: Run, motion: Coordinates, t: float, y: list[float]) -> Outcome | None:
    """Return where slow slip ends if that is next, followed up to there; None if not."""
    others, s = len(y) - motion.slip, motion.speed(y)
    n = [part / s for part in y[others:]]
    growth = motion.rates(y)[others:]
    falling = -sum(a * b for a, b in zip(n, growth, strict=True))
    if falling <= 0.0:
        return None
    across = math.hypot(*(a + falling * b for a, b in zip(growth, n, strict=True)))
    left = s / falling
    if left * across / falling + left**2 * motion.pace < run.thresholds.rest_time:
        return Outcome(t + left, come_to_rest(run, motion, t, left, y))
    way = s * max(1.0, min(left, run.end - t))
    lingers = left > LONG and way < max(NO_WAY * run.local_tolerance, LEAST_WAY)
    if s < run.thresholds.reversal_slip or lingers:
        # Head-on, or at the limit of what friction holds: over within rounding.
        return Outcome(t, [*y[:others], *[0.0] * motion.slip])
    return None


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


def grip_lost(
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
