"""The whirl with an offset and the whirl whose radius oscillates (Fig. 11), by shooting."""

import math
from dataclasses import replace

import numpy as np

from reference_model.orbits.shooting import (
    PERIOD,
    REFERENCE,
    SPIN,
    TURN,
    VX,
    VY,
    Orbit,
    ShootingProblem,
    Simulate,
    X,
    Y,
    hold_crossing,
    require_start,
    rotated,
    shoot,
    size_of,
    without_angle,
)
from reference_model.steady.steady_states import Whirl, whirls, why_no_whirl
from reference_model.systems import FloatArray, System
from reference_model.trajectory import Trajectory

RECURRENCE = 0.05
"""Largest relative difference of two recurrent states."""

LEAST_MODULATION = 1e-6
"""Smallest relative oscillation of the radius of a modulated cycle; a converged whirl has less."""


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

    Newton's method solves Φ_T(x, y, vx, vy) = (x, y, vx, vy) for x, vx, vy, the spin of a disc and the period T, at
    the y of the guess. Orbits may have stick phases.

    Raises ``ValueError`` if a circle to start from does not exist, or a disc rests on single points; ``RuntimeError``
    if Newton's method does not converge.

    Parameters
    ----------
    system
        A system with a whirl without offset: |ω| > k on a linear support.
    simulate
        The engine, such as ``functools.partial(simulate, contact=...)`` for another friction law.
    guess
        Start of the iteration, such as the orbit for a nearby load; by default the largest circle without offset. For
        a whirl that does not cross the x axis, use :meth:`Orbit.from_the_right` for a nearby offset.
    at_crossing
        Fixed value of x at y = 0, in m, with the load μN as an unknown, so a branch can turn at folds.
    tolerance, samples
        That of ``simulate``, and number of intervals of the trajectory.
    precision
        Relative noise of the engine's states, such as 1e-6 in single precision.

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


def modulated_cycle(
    system: System,
    guess: Trajectory | Orbit,
    *,
    simulate: Simulate = REFERENCE,
    at_crossing: float | None = None,
    tolerance: float = 1e-12,
    samples: int = 1024,
    precision: float = 0.0,
) -> Orbit:
    """Return the cycle of a whirl whose radius oscillates, X0 = 0 only, by shooting (Fig. 11).

    After the period T of the modulation the motion repeats, rotated by an angle θ. The orbit starts at an extreme of
    the radius, y = 0 and vx = 0, and Newton's method solves for x, vy, spin, T and θ.

    ``guess`` is the cycle for nearby parameters, or a simulation that ends close to the cycle, covers more than a
    period of the modulation and resolves a revolution. Other arguments are those of :func:`whirl_orbit`.

    Raises ``ValueError`` if the offset is not zero, a disc rests on single points, or ``guess`` does not recur;
    ``RuntimeError`` without convergence, or if the radius turns out to be constant.
    """
    require_start(system, guess, (Orbit, Trajectory), at_crossing, samples)
    if system.offset != 0.0:
        raise ValueError(
            f"offset = {system.offset:g} m: a modulated cycle repeats up to a rotation about the axis, which "
            "needs an offset of 0"
        )
    if isinstance(guess, Trajectory):
        state, period, turn = _recurrence(guess)
    else:
        state, period, turn = guess.state, guess.period, guess.turn
    problem = ShootingProblem(simulate, system, tolerance, precision)
    unknowns = problem.unknowns(state, period, system.friction_force, turn)
    unknowns[[Y, VX]] = 0.0
    sought = [X, *range(VY, len(unknowns[:PERIOD])), PERIOD, TURN]
    if at_crossing is not None:
        hold_crossing(at_crossing, guess, unknowns, sought)
    orbit = shoot(problem, unknowns, sought, samples, "modulated cycle")
    radius = orbit.trajectory.radius
    if np.ptp(radius) < LEAST_MODULATION * np.max(radius):
        raise RuntimeError(
            f"no modulated cycle near the guess for friction_force = {system.friction_force:g} N: shooting found a "
            f"whirl of constant radius {radius[0]:g} m"
        )
    return orbit


def _recurrence(trajectory: Trajectory) -> tuple[FloatArray, float, float]:
    """Return state on the x axis, period and rotation of the last recurrence of a largest radius."""
    states, times = trajectory.states, trajectory.times
    velocities = trajectory.system.state_size // 2
    z = states[:, 0] + 1j * states[:, 1]
    v = states[:, velocities] + 1j * states[:, velocities + 1]
    outward = (z.conjugate() * v).real
    maxima = np.flatnonzero((outward[:-1] > 0.0) & (outward[1:] <= 0.0))
    angles = np.unwrap(np.angle(z))
    if len(maxima):
        last = rotated(without_angle(states[maxima[-1]]), -float(angles[maxima[-1]]))
        for i in maxima[-2::-1]:
            before = rotated(without_angle(states[i]), -float(angles[i]))
            if np.all(np.abs(last - before) < RECURRENCE * size_of(trajectory.system, last)):
                period = float(times[maxima[-1]] - times[i])
                state = np.insert(last, 2, 0.0) if len(last) > SPIN else last
                return state, period, float(angles[maxima[-1]] - angles[i])
    raise ValueError(
        f"the trajectory does not recur by t = {times[-1]:g} s: no two of {len(maxima)} maxima of its radius "
        "are similar; simulate longer or start closer to the cycle"
    )
