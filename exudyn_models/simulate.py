"""simulate(): the same call and the same result as the reference, computed by Exudyn."""

from __future__ import annotations

import math
import time
from dataclasses import replace
from typing import Literal

from numpy.typing import ArrayLike

from exudyn_models.dense_output import states_at
from exudyn_models.phases import phases
from exudyn_models.pin_on_disc import build_pin_on_disc
from exudyn_models.ring_friction import checked_regularisation
from exudyn_models.solving import FIXED_STEP, Steps, joined, solve
from reference_model.systems import (
    FloatArray,
    PinOnDisc,
    checked_state,
    checked_times,
    checked_tolerance,
    finite_number,
)
from reference_model.trajectory import Solution, Trajectory

REGULARISATION_PER_TOLERANCE = 100.0
"""ε = 100·tolerance: 1e-7 m/s by default (study in ``benchmarks/exudyn_contact.py``)."""

STEP_TOLERANCE = 1e-2
"""Tolerance of DOPRI5 relative to the one asked for: thousands of steps add up."""

SMALLEST_STEP_TOLERANCE = 1e-13
"""Below it rounding makes DOPRI5's error estimate useless, and its step collapses."""

LARGEST_STEP = 6.0
"""DOPRI5's largest step is 6·tolerance^(1/5) time scales: its order is 5, so errors fall where that binds too."""

RELAXATIONS = 40.0
"""A pin that comes to rest settles to its creep like exp(−t·μN/(mε)); after 40 times that nothing is left of it."""

NEWTON_TOLERANCE = 1e-9
"""Residual at which Newton's iteration ends, relative to the forces at the start."""

CREEP_NEWTON_TOLERANCE = 1e-6
"""The same for a creeping pin, relative to μN: a millionth of its creep, and above rounding down to ε ~ 1e-11."""

VISCOUS_RANGE = 2.0**40
"""By how much the viscous part of the friction law is continued in the model of a creeping pin."""

Solver = Literal["explicit", "implicit"]


def simulate(
    pin: PinOnDisc,
    initial_state: ArrayLike,
    times: ArrayLike,
    *,
    tolerance: float = 1e-9,
    regularisation: float | None = None,
    solver: Solver = "explicit",
) -> Trajectory:
    """Return the motion of ``pin`` from ``initial_state`` at ``times[0]`` at all ``times``.

    Parameters
    ----------
    pin : PinOnDisc
        The parameters.
    initial_state : array of shape (4,)
        x, y in m and vx, vy in m/s.
    times : array of shape (n,)
        Increasing, in s. States are interpolated between the solver's own steps, which do not depend on ``times``
        apart from the first and the last.
    tolerance : float
        The accuracy to aim at, in m and m/s, relative for a motion larger than 1. While the pin slips, "explicit"
        keeps the error near it. What sticking adds is of first order in the regularisation.
    regularisation : float, optional
        ε in m/s below which friction is viscous; 100·tolerance if not given. It should stay well above the
        tolerance.
    solver : "explicit" or "implicit"
        "explicit" is DOPRI5, and generalised-α only while the pin sticks, where the regularised law is stiff.
        "implicit" is generalised-α throughout: second order, with a step ~ √tolerance, an error that falls like
        the tolerance but is some thousand times larger.

    Raises
    ------
    ValueError
        If an argument is out of its range.
    SimulationError
        If Exudyn can not compute the motion.

    """
    state = checked_state(pin, initial_state)
    grid = checked_times(times)
    tolerance = checked_tolerance(tolerance)
    epsilon = _regularisation(regularisation, tolerance)
    if solver not in ("explicit", "implicit"):
        raise ValueError(f"solver = {solver!r}: it must be 'explicit' or 'implicit'")
    began = time.perf_counter()
    start, end = float(grid[0]), float(grid[-1])
    scale = _time_scale(pin, end - start)
    if solver == "explicit":
        method, integrator = "Exudyn DOPRI5, generalised-α while sticking", "DOPRI5"
        step = LARGEST_STEP * tolerance**0.2 * scale
        local = max(STEP_TOLERANCE * tolerance, SMALLEST_STEP_TOLERANCE) * _motion_scale(pin, state)
    else:
        method, integrator = "Exudyn generalised-α", "GeneralizedAlpha"
        step = 100.0 * math.sqrt(tolerance) * scale
        local = NEWTON_TOLERANCE * _force_scale(pin, state)
    steps = _solve_with_stick(
        pin, state, start, end, epsilon, integrator=integrator, step=step, tolerance=local
    )
    return _trajectory(pin, grid, steps, method, tolerance, epsilon, began)


def simulate_fixed_step(
    pin: PinOnDisc,
    initial_state: ArrayLike,
    times: ArrayLike,
    *,
    integrator: str = "RK44",
    step: float,
    regularisation: float = 1e-6,
) -> Trajectory:
    """Return the motion computed by one Exudyn integrator with steps of ``step`` (s) throughout.

    For studies of convergence. ``integrator`` is one of "RK44", "RK67" (explicit, order 4 and 6),
    "GeneralizedAlpha", "TrapezoidalIndex2" (implicit, order 2). An explicit integrator needs a step below about
    2·mε/μN wherever the pin sticks. ``solution.tolerance`` is nan. Raises as ``simulate`` does.
    """
    state = checked_state(pin, initial_state)
    grid = checked_times(times)
    epsilon = checked_regularisation(regularisation)
    step = finite_number("step", step)
    if step <= 0.0:
        raise ValueError(f"step = {step:g} s: it must be > 0")
    if integrator not in FIXED_STEP:
        raise ValueError(f"integrator = {integrator!r}: it must be one of {', '.join(FIXED_STEP)}")
    began = time.perf_counter()
    model = build_pin_on_disc(pin, state, regularisation=epsilon)
    start, end = float(grid[0]), float(grid[-1])
    newton = NEWTON_TOLERANCE * _force_scale(pin, state)
    steps = solve(model, start, end, integrator=integrator, step=step, tolerance=newton)
    return _trajectory(pin, grid, steps, f"Exudyn {integrator}, step {step:.3g} s", math.nan, epsilon, began)


def _solve_with_stick(
    pin: PinOnDisc,
    state: FloatArray,
    start: float,
    end: float,
    epsilon: float,
    *,
    integrator: str,
    step: float,
    tolerance: float,
) -> Steps:
    """Solve with ``integrator`` where the pin slips, and with generalised-α where it has settled to its creep.

    There an explicit method would need steps of 3·mε/μN. The implicit one is of second order: its step makes its
    error, a phase error of the rotation with the disc of (ωh)²/12, one per cent of the creep that the
    regularisation itself makes, so that both fall together.

    A creeping pin feels the viscous part of the law only, so there the model is one in which that part has no end:
    it is linear, and Newton's iteration can not be thrown off by the bend of the law at ε.
    """
    omega = pin.disc_speed
    settling = RELAXATIONS * pin.mass * epsilon / pin.friction_force if pin.friction_force > 0.0 else math.inf
    viscous = replace(pin, friction_force=VISCOUS_RANGE * pin.friction_force)
    slow_since = math.inf

    def slip_speed(x: float, y: float, vx: float, vy: float) -> float:
        return math.hypot(vx + omega * y, vy - omega * x)

    def not_settled(t: float, x: float, y: float, vx: float, vy: float) -> bool:
        nonlocal slow_since
        slow_since = min(slow_since, t) if slip_speed(x, y, vx, vy) < epsilon else math.inf
        return t - slow_since < settling

    def creeps(t: float, x: float, y: float, vx: float, vy: float) -> bool:
        return slip_speed(x, y, vx, vy) < epsilon

    parts: list[Steps] = []
    while True:
        model = build_pin_on_disc(pin, state, regularisation=epsilon)
        steps = solve(
            model, start, end, integrator=integrator, step=step, tolerance=tolerance, watch=not_settled
        )
        parts.append(steps)
        state, start, slow_since = steps.states[-1], float(steps.times[-1]), math.inf
        if start >= end:
            return joined(parts)
        creep_step = min(step, 0.01 * _time_scale(pin, end - start))
        rotation = abs(omega) ** 3 * math.hypot(state[0], state[1])
        if rotation > 0.0:
            creep_step = min(creep_step, math.sqrt(0.12 * epsilon / rotation))
        model = build_pin_on_disc(viscous, state, regularisation=VISCOUS_RANGE * epsilon)
        steps = solve(
            model,
            start,
            end,
            integrator="GeneralizedAlpha",
            step=creep_step,
            tolerance=CREEP_NEWTON_TOLERANCE * pin.friction_force,
            watch=creeps,
        )
        parts.append(steps)
        state, start = steps.states[-1], float(steps.times[-1])
        if start >= end:
            return joined(parts)


def _time_scale(pin: PinOnDisc, span: float) -> float:
    """Return the time in s in which the motion changes: the shortest of 1/k, 1/|ω|, m/β, or all of ``span``."""
    rate = max(pin.natural_frequency, abs(pin.disc_speed), pin.damping / pin.mass)
    return min(1.0 / rate, span) if rate > 0.0 else span


def _motion_scale(pin: PinOnDisc, state: FloatArray) -> float:
    """Return the number by which DOPRI5's error, in m and m/s, is measured: 1, or the motion's size above that."""
    x, y, vx, vy = state.tolist()
    return max(1.0, math.hypot(x, y), abs(pin.offset), math.hypot(vx, vy))


def _force_scale(pin: PinOnDisc, state: FloatArray) -> float:
    """Return the size in N of the forces on the pin, > 0."""
    x, y, vx, vy = state.tolist()
    spring = pin.stiffness * (math.hypot(x, y) + abs(pin.offset))
    return pin.friction_force + spring + pin.damping * math.hypot(vx, vy) or pin.mass


def _regularisation(value: float | None, tolerance: float) -> float:
    return REGULARISATION_PER_TOLERANCE * tolerance if value is None else checked_regularisation(value)


def _trajectory(
    pin: PinOnDisc,
    times: FloatArray,
    steps: Steps,
    method: str,
    tolerance: float,
    epsilon: float,
    began: float,
) -> Trajectory:
    states = states_at(steps, times)
    found = phases(pin, steps, epsilon)
    solution = Solution(
        method=method,
        tolerance=tolerance,
        evaluations=steps.evaluations,
        steps=len(steps.times) - 1,
        wall_time=time.perf_counter() - began,
        regularisation=epsilon,
    )
    return Trajectory(pin, times, states, found, solution)
