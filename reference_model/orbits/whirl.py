"""The whirl with an offset and the whirl whose radius oscillates (Fig. 11), by shooting, and their branches.

A branch is a continuation in the load, to the fold where whirls end.
"""

import functools
import math
from collections.abc import Iterator
from dataclasses import replace

import numpy as np
from scipy.optimize import minimize_scalar

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
from reference_model.systems import FloatArray, System, finite_number, require_kind, require_whole
from reference_model.trajectory import Trajectory

RECURRENCE = 0.05
"""Largest relative difference of two recurrent states."""

LEAST_MODULATION = 1e-6
"""Smallest relative oscillation of the radius of a modulated cycle; a converged whirl has less."""

BRANCH_STEP = 0.08
"""Relative step in x along the branch of whirls."""


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
        That of ``simulate``, and number of intervals of the trajectory, at least 1; ``Orbit.mean`` needs more.
    precision
        Relative noise of the engine's states, such as 1e-6 in single precision.

    """
    require_start(system, guess, (Orbit, Whirl, type(None)), at_crossing, samples)
    if guess is None:
        centred = replace(system, offset=0.0)
        circles = whirls(centred)
        if not circles:
            raise ValueError(why_no_whirl(centred))
        guess = circles[0]
    period = guess.period if isinstance(guess, Orbit) else 2.0 * math.pi / abs(guess.frequency)
    problem = ShootingProblem(simulate, system, tolerance, precision)
    unknowns = problem.unknowns(guess.state, period, system.friction_force, 0.0)
    sought = [X, *range(VX, len(unknowns[:PERIOD])), PERIOD]
    if at_crossing is not None:
        hold_crossing(at_crossing, guess, unknowns, sought)
    return shoot(problem, unknowns, sought, samples, "whirl")


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
    period of the modulation and resolves a revolution. Other arguments are the same as in :func:`whirl_orbit`.

    Raises ``ValueError`` if the offset is not zero, a disc rests on single points, or ``guess`` does not recur;
    ``RuntimeError`` without convergence, or if the radius turns out to be constant.
    """
    require_start(system, guess, (Orbit, Trajectory), at_crossing, samples)
    require_whole("samples", samples, least=2)  # one interval has equal radii at both ends
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


def whirl_branch(
    orbit: Orbit, until: float, *, step: float = BRANCH_STEP, samples: int = 64
) -> Iterator[Orbit]:
    """Yield ``orbit``, a whirl or a modulated cycle, and its continuation to other loads, with decreasing crossing x.

    Each orbit is predicted from the two before it. The relative decrease of x is at most ``step``, halved if Newton's
    method fails, down to ``until`` > 0 in m. The load may rise or fall, and stick phases may appear. Raises
    ``RuntimeError`` if even a step of ``step``/64 finds no orbit.
    """
    require_kind("orbit", orbit, Orbit)
    require_whole("samples", samples, least=1)
    if not finite_number("until", until) >= 0.0 < finite_number("step", step) < 1.0:
        raise ValueError(
            f"until = {until:g} m, step = {step:g}: until must be >= 0, and step between 0 and 1"
        )
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
    crossing x. Arguments and errors are the same as in :func:`whirl_orbit`; ``RuntimeError`` also if the branch ends
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
