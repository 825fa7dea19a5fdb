"""The whirl of a pin or disc with an offset, a periodic orbit near to a circle, by shooting."""

from __future__ import annotations

import math
from dataclasses import replace

from reference_model.orbits.shooting import (
    PERIOD,
    REFERENCE,
    VX,
    Orbit,
    ShootingProblem,
    Simulate,
    X,
    hold_crossing,
    require_start,
    shoot,
)
from reference_model.steady.steady_states import Whirl, whirls, why_no_whirl
from reference_model.systems import System


def whirl_orbit(
    system: System,
    *,
    simulate: Simulate = REFERENCE,
    guess: Orbit | Whirl | None = None,
    at_crossing: float | None = None,
    tolerance: float = 1e-12,
    samples: int = 256,
    precision: float = 0.0,
) -> Orbit:
    """Return the whirl of a pin or disc with an offset, a periodic orbit near to a circle, by shooting.

    Newton's method on x, vx, vy, the spin of a disc and the period T for Φ_T(x, y, vx, vy) = (x, y, vx, vy), with
    the derivatives of the flow Φ from differences. The phase is fixed by y, which stays that of the guess: 0 unless
    the guess starts elsewhere. Orbits with stick phases are found as well: nothing but ``simulate`` is asked for.

    Parameters
    ----------
    system : PinOnDisc or DiscOnDisc
        The parameters, with a whirl without offset: |ω| > k on a linear support.
    simulate : callable
        The engine; the reference, compiled where it can be, unless told otherwise.
        ``functools.partial(simulate, contact=...)`` is that of a disc under another law.
    guess : Orbit or Whirl, optional
        Where to start, such as the orbit for a nearby load; unless told otherwise, the largest circle that there
        is without offset. With a large offset the whirl of a disc no longer crosses the x axis: then it takes that
        of a nearby offset, :meth:`Orbit.from_the_right`.
    at_crossing : float, optional
        If given, x at y = 0 is held at this value in m and the load μN is sought in its place. This goes round the
        folds of the branch, where two whirls of the same load meet.
    tolerance : float
        Handed to ``simulate``.
    samples : int
        Intervals of the returned trajectory.
    precision : float
        Relative noise of the engine's states, whatever the tolerance: 1e-6 in single precision.

    Raises
    ------
    ValueError
        If there is no circle to start from, or if a disc rests on single points.
    RuntimeError
        If Newton's method does not converge: there is no such orbit near the guess.

    """
    require_start(system, guess, (Orbit, Whirl, type(None)), at_crossing, samples)
    if guess is None:
        guess = _largest_circle(replace(system, offset=0.0))
    period = guess.period if isinstance(guess, Orbit) else 2.0 * math.pi / abs(guess.frequency)
    problem = ShootingProblem(simulate, system, tolerance, precision)
    unknowns = problem.unknowns(guess.state, period, system.friction_force, 0.0)
    sought = [X, *range(VX, len(unknowns[:PERIOD])), PERIOD]
    if at_crossing is not None:
        hold_crossing(at_crossing, guess, unknowns, sought)
    return shoot(problem, unknowns, sought, samples, "whirl")


def _largest_circle(system: System) -> Whirl:
    found = whirls(system)
    if not found:
        raise ValueError(why_no_whirl(system))
    return found[0]
