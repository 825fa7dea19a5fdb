"""Continuation of orbits in the load, to the fold where whirls end."""

import functools
import math
from collections.abc import Iterator
from dataclasses import replace

from scipy.optimize import minimize_scalar

from reference_model.orbits.shooting import REFERENCE, Orbit, Simulate
from reference_model.orbits.whirl import modulated_cycle, whirl_orbit
from reference_model.systems import System

BRANCH_STEP = 0.08
"""Relative step in x along the branch of whirls."""


def whirl_branch(
    orbit: Orbit, until: float, *, step: float = BRANCH_STEP, samples: int = 64
) -> Iterator[Orbit]:
    """Yield ``orbit``, a whirl or a modulated cycle, and its continuation to other loads, with decreasing crossing x.

    Each orbit is predicted from the two before it. The relative decrease of x is at most ``step``, halved if Newton's
    method fails, down to ``until`` > 0 in m. The load may rise or fall, and stick phases may appear. Raises
    ``RuntimeError`` if even a step of ``step``/64 finds no orbit.
    """
    seek = whirl_orbit if orbit.turn == 0.0 else modulated_cycle
    before, last = None, orbit
    yield last
    fraction = step
    while last.state[0] > until:
        x = max(until, last.state[0] * (1.0 - fraction))
        try:
            found = seek(
                last.system,
                simulate=last.problem.simulate,
                guess=last if before is None else _extrapolated(before, last, x),
                at_crossing=x,
                tolerance=last.problem.tolerance,
                samples=samples,
                precision=last.problem.precision,
            )
        except RuntimeError:
            if fraction < step / 64.0:
                raise
            fraction /= 2.0
            continue
        before, last, fraction = last, found, min(step, 2.0 * fraction)
        yield last


def _extrapolated(before: Orbit, last: Orbit, x: float) -> Orbit:
    ahead = (x - last.state[0]) / (last.state[0] - before.state[0])
    load = last.system.friction_force + ahead * (last.system.friction_force - before.system.friction_force)
    return replace(
        last,
        system=replace(last.system, friction_force=float(load)),
        state=last.state + ahead * (last.state - before.state),
        period=last.period + ahead * (last.period - before.period),
        turn=last.turn + ahead * (last.turn - before.turn),
    )


def last_whirl(
    system: System,
    *,
    simulate: Simulate = REFERENCE,
    tolerance: float = 1e-12,
    precision: float = 0.0,
) -> Orbit:
    """Return the whirl at the smallest load with a whirl: the fold, where it meets the unstable whirl.

    The branch is followed from the load of ``system`` towards the axis, to the minimum of the load against the
    crossing x. Arguments and errors are those of :func:`whirl_orbit`; ``RuntimeError`` also if the branch ends
    before.
    """
    seek = functools.partial(whirl_orbit, system, simulate=simulate, tolerance=tolerance, precision=precision)
    orbit = seek(samples=2)

    def load(x: float) -> float:
        nonlocal orbit
        orbit = seek(guess=orbit, at_crossing=x, samples=2)
        return orbit.system.friction_force

    first = float(orbit.state[0])
    x, loads = [first * (1.0 + BRANCH_STEP)], [math.inf]
    for follower in whirl_branch(orbit, 0.0, samples=2):
        orbit = follower
        x.append(float(orbit.state[0]))
        loads.append(orbit.system.friction_force)
        if loads[-1] > loads[-2]:
            break
    best = minimize_scalar(load, bracket=tuple(x[-3:]), tol=1e-5)
    return seek(guess=orbit, at_crossing=float(best.x))
