"""Unknowns of a motion, and the end of slip, which all descriptions of slip share."""

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
"""Negligible slip speed that still gives friction a direction."""

DIFFERENCE = 1e-7
"""Change of unknowns of order one for numerical derivatives."""

TIGHTEST_IMPLICIT = 3e-13
"""Smallest error of an implicit step, on unknowns of order one, above rounding noise."""

LOOSEST_IMPLICIT = 0.03
"""Largest error of an implicit step in ln s."""

SHARE = 1e-5
"""Relative change of a relative velocity for numerical derivatives, if smaller than ``DIFFERENCE``."""


@dataclass(frozen=True)
class Coordinates:
    """The unknowns of a motion, the last ``slip`` of them a slip velocity, and functions of them.

    Parameters
    ----------
    rates
        Returns the rates in 1/T, never at zero slip.
    slow
        Returns the speed limit of slow slip.
    pace
        Largest rate of everything except the slip, in 1/T.
    standard
        Converts unknowns (k, n) to the standard unknowns of the body, (unknowns, n).
    angle
        Index of an angle, which has an absolute tolerance.
    turning
        Index of another relative velocity, which may be the scale of friction.
    leverage
        Derivative of the centre's velocity with respect to the slip.
    grip
        Returns the margin of a held friction force; the motion ends at zero.
    surfaces
        Surfaces where friction or support is continuous but not smooth.

    """

    rates: Rates
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
        """Return the rates of many states, shape (n, k); nan if trial states of Newton's method overflow."""
        try:
            return np.transpose([self.rates(y) for y in unknowns.T.tolist()])
        except (ArithmeticError, ValueError):
            return np.full(unknowns.shape, math.nan)

    def speed(self, y: Sequence[float]) -> float:
        return math.hypot(*y[-self.slip :])

    def differences(self, unknowns: FloatArray) -> FloatArray:
        """Return the changes of ``unknowns`` (k, n or more) for numerical derivatives."""
        changes = np.full(unknowns.shape, DIFFERENCE)
        if self.turning is not None:
            own = SHARE * abs(unknowns[:, self.turning]) + LEAST_SLIP
            changes[:, self.turning] = np.minimum(DIFFERENCE, own)
        return changes

    def tolerated(self, run: Run, unknowns: int, polar: int = 0, implicit: bool = False) -> Tolerated:
        """Return a function for the allowed errors of a step in the first ``unknowns`` unknowns.

        ``polar`` more may follow, with absolute tolerances: the ``slip`` components of a direction, ln s and so on.
        An implicit step bounds the error of s instead of ln s, which would need many steps in a long decay.
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
    """Return the surface where the stop begins, if any, for unknowns that start with x and y."""
    if support.stop_stiffness == 0.0 or support.stop_gap == 0.0:
        return ()

    def beyond(y: list[float]) -> float:
        return math.hypot(y[0] - support.offset, y[1]) - support.stop_gap

    def outward(y: list[float], rates: list[float]) -> float:
        return (y[0] - support.offset) * rates[0] + y[1] * rates[1]

    return (SwitchingSurface(beyond, outward),)


class Outcome(NamedTuple):
    """Time and unknowns where a description of the motion ended; ``released`` if the grip was lost."""

    t: float
    y: list[float]
    released: bool = False


Leave = Callable[[list[float]], bool]
"""Takes unknowns and returns whether the motion needs another description."""


FAST_AGAIN = 1.2
"""Ratio to the slow slip speed above which slip is fast again."""

NO_WAY, LEAST_WAY = 0.1, 1e-12
"""Largest distance that remains when slip has ended: as a share of the local tolerance, and scaled."""

LONG = 0.01
"""Smallest scaled time to rest of lingering slip."""


def slip_ends(run: Run, motion: Coordinates, t: float, y: list[float]) -> Outcome | None:
    """Follow slow slip to its end if it is about to end; otherwise return None."""
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
        # Slip is over to rounding error, head-on or at the friction limit.
        return Outcome(t, [*y[:others], *[0.0] * motion.slip])
    return None


def come_to_rest(run: Run, motion: Coordinates, t: float, left: float, y: list[float]) -> list[float]:
    """Follow the last ``left`` of slip, which falls linearly, by the midpoint rule; return the unknowns."""
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
    """Return where in the last step the grip falls to zero, or None; ``unknowns`` converts those of the solver."""
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
"""Number of checks of the grip per step, which is short compared with its changes."""
