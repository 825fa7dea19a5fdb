"""simulate(): the same call and the same result as the reference, computed by Exudyn."""

from __future__ import annotations

import math
import time
from dataclasses import replace
from typing import Literal

from numpy.typing import ArrayLike

from exudyn_models.dense_output import states_at
from exudyn_models.models import build
from exudyn_models.phases import phases
from exudyn_models.ring_friction import checked_regularisation
from exudyn_models.scales import angle_rounding, force_scale, motion_scale, time_scale
from exudyn_models.slip_and_creep import RING_FRICTION, Friction, solve_in_turns
from exudyn_models.solving import FIXED_STEP, Steps, solve
from reference_model.systems import (
    DiscOnDisc,
    FloatArray,
    System,
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

DISC_STEP_TOLERANCE = 1e-3
"""The same for a disc: where U = W the ring's friction has an infinite slope, and the spin remembers the error."""

STOP_STEP_TOLERANCE = 1e-4
"""The same for a support with a stop: its force has a bend, and what bounces on it passes that many times."""

SMALLEST_STEP_TOLERANCE = 1e-13
"""Below it rounding makes DOPRI5's error estimate useless, and its step collapses."""

LARGEST_STEP = 6.0
"""DOPRI5's largest step is 6·tolerance^(1/5) time scales: its order is 5, so errors fall where that binds too."""

NEWTON_TOLERANCE = 1e-9
"""Residual at which Newton's iteration ends, relative to the forces at the start."""

Solver = Literal["explicit", "implicit"]


def simulate(
    system: System,
    initial_state: ArrayLike,
    times: ArrayLike,
    *,
    tolerance: float = 1e-9,
    regularisation: float | None = None,
    solver: Solver = "explicit",
    friction: Friction = RING_FRICTION,
) -> Trajectory:
    """Return the motion of ``system`` from ``initial_state`` at ``times[0]`` at all ``times``.

    Parameters
    ----------
    system : PinOnDisc or DiscOnDisc
        The parameters.
    initial_state : array of shape (4,) or (6,)
        Of a pin x, y in m and vx, vy in m/s; of a disc x, y, angle (rad), vx, vy, spin (rad/s).
    times : array of shape (n,)
        Increasing, in s. States are interpolated between the solver's own steps, which do not depend on ``times``
        apart from the first and the last.
    tolerance : float
        The accuracy to aim at, in m and m/s (rad and rad/s), relative for a motion larger than 1. While the contact
        slips, "explicit" keeps the error near it. What sticking and pivoting add is of first order in the
        regularisation.
    regularisation : float, optional
        ε in m/s below which friction is viscous; 100·tolerance if not given. It should stay well above the
        tolerance.
    solver : "explicit" or "implicit"
        "explicit" is DOPRI5, and generalised-α only while the contact, or one of several points, sticks: there the
        regularised law is stiff. Its steps there are ~ √ε, so that a second of sticking costs some 4,000 of them at
        the default tolerance and 40,000 at a hundredth of it.
        "implicit" is generalised-α throughout: second order, with a step ~ √tolerance, an error that falls like
        the tolerance but is some thousand times larger.
    friction : Friction, optional
        What adds the friction between the discs to the model.

    Raises
    ------
    ValueError
        If an argument is out of its range.
    SimulationError
        If Exudyn can not compute the motion.

    """
    state = checked_state(system, initial_state)
    grid = checked_times(times)
    tolerance = checked_tolerance(tolerance)
    epsilon = _regularisation(regularisation, tolerance)
    if solver not in ("explicit", "implicit"):
        raise ValueError(f"solver = {solver!r}: it must be 'explicit' or 'implicit'")
    began = time.perf_counter()
    span = float(
        grid[-1] - grid[0]
    )  # Exudyn counts from 0: it takes no negative times, and large ones cost digits
    scale = time_scale(system, state, span)
    if solver == "explicit":
        method, integrator = "Exudyn DOPRI5, generalised-α while sticking", "DOPRI5"
        step = LARGEST_STEP * tolerance**0.2 * scale
        local = max(_step_tolerance(system) * tolerance, SMALLEST_STEP_TOLERANCE)
        local *= motion_scale(system, state)
        local = max(local, 2.0 * angle_rounding(system, state, span))  # the same for large angles
    else:
        method, integrator = "Exudyn generalised-α", "GeneralizedAlpha"
        step = 100.0 * math.sqrt(tolerance) * scale
        local = NEWTON_TOLERANCE * force_scale(system, state)
    steps = solve_in_turns(
        system,
        state,
        span,
        epsilon,
        integrator=integrator,
        step=step,
        tolerance=local,
        friction=friction,
    )
    return _trajectory(system, grid, steps, method, tolerance, epsilon, began)


def simulate_fixed_step(
    system: System,
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
    state = checked_state(system, initial_state)
    grid = checked_times(times)
    epsilon = checked_regularisation(regularisation)
    step = finite_number("step", step)
    if step <= 0.0:
        raise ValueError(f"step = {step:g} s: it must be > 0")
    if integrator not in FIXED_STEP:
        raise ValueError(f"integrator = {integrator!r}: it must be one of {', '.join(FIXED_STEP)}")
    began = time.perf_counter()
    model = build(system, state, regularisation=epsilon)
    newton = NEWTON_TOLERANCE * force_scale(system, state)
    steps = solve(model, 0.0, float(grid[-1] - grid[0]), integrator=integrator, step=step, tolerance=newton)
    return _trajectory(
        system, grid, steps, f"Exudyn {integrator}, step {step:.3g} s", math.nan, epsilon, began
    )


def _step_tolerance(system: System) -> float:
    """Return the tolerance of DOPRI5 relative to the one asked for."""
    if system.stop_stiffness > 0.0:
        return STOP_STEP_TOLERANCE
    return DISC_STEP_TOLERANCE if isinstance(system, DiscOnDisc) else STEP_TOLERANCE


def _regularisation(value: float | None, tolerance: float) -> float:
    return REGULARISATION_PER_TOLERANCE * tolerance if value is None else checked_regularisation(value)


def _trajectory(
    system: System,
    times: FloatArray,
    steps: Steps,
    method: str,
    tolerance: float,
    epsilon: float,
    began: float,
) -> Trajectory:
    counted = phases(system, steps, epsilon)  # from 0 on
    starts = [float(times[0]) + phase.start for phase in counted]
    found = tuple(
        replace(phase, start=start, end=end)
        for phase, start, end in zip(counted, starts, [*starts[1:], float(times[-1])], strict=True)
    )
    solution = Solution(
        method=method,
        tolerance=tolerance,
        evaluations=steps.evaluations,
        steps=len(steps.times) - 1,
        wall_time=time.perf_counter() - began,
        regularisation=epsilon,
    )
    return Trajectory(system, times, states_at(steps, times - times[0]), found, solution)
