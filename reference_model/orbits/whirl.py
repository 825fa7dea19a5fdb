"""The whirl of a pin or disc with an offset, a periodic orbit close to a circle, by shooting."""

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
    """Return the whirl of a pin or disc with an offset, a periodic orbit close to a circle, by shooting.

    Newton's method solves Φ_T(x, y, vx, vy) = (x, y, vx, vy) for x, vx, vy, the spin of a disc and the period T,
    with differences for the derivatives of the flow Φ. The phase is fixed by y, which is that of the guess. Only
    ``simulate`` is used, so orbits with stick phases are found too.

    Raises ``ValueError`` if a circle to start from does not exist, or a disc rests on single points;
    ``RuntimeError`` if Newton's method does not converge, because such an orbit does not exist near the guess.

    Parameters
    ----------
    system
        Parameters of a system with a whirl without offset: |ω| > k on a linear support.
    simulate
        The engine; by default the reference, compiled if possible. Use ``functools.partial(simulate, contact=...)``
        for a disc with another friction law.
    guess
        Start of the iteration, such as the orbit for a nearby load; by default the largest circle without offset.
        With a large offset the whirl of a disc no longer crosses the x axis: then use :meth:`Orbit.from_the_right`
        of the orbit for a nearby offset.
    at_crossing
        Fixed value of x at y = 0, in m; the load μN becomes unknown in its place. So a branch can be followed
        around its folds, where two whirls of the same load meet.
    tolerance, samples
        Tolerance for ``simulate``, and number of intervals of the returned trajectory.
    precision
        Relative noise of the engine's states, whatever the tolerance, for example 1e-6 in single precision.

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
