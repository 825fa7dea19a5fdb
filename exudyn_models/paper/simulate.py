"""simulate() with Exudyn: the signature and the result of the reference."""

from __future__ import annotations

import math
import time
from dataclasses import dataclass
from typing import Literal

from numpy.typing import ArrayLike

from exudyn_models.paper.alternating_solvers import (
    RING_FRICTION,
    Friction,
    SlipSolver,
    nothing_creeps,
    solve_in_turns,
)
from exudyn_models.paper.creep import RegularisedContact
from exudyn_models.paper.joint import simulate_joint
from exudyn_models.paper.scales import Scales, Units
from exudyn_models.parts.ring_friction import add_ring_friction
from exudyn_models.solver.solver_run import FIXED_STEP
from reference_model.systems import (
    DiscOnDisc,
    FloatArray,
    System,
    checked_state,
    checked_times,
    checked_tolerance,
    positive_number,
    require_choice,
    require_kind,
)
from reference_model.systems.joint import AnySystem, FrictionJoint
from reference_model.trajectory import Solution, Trajectory, phases_of

REGULARISATION_PER_TOLERANCE = 100.0
"""Ratio of ε, in the motion's own unit of speed, to the tolerance (study in ``benchmarks/exudyn_contact.py``)."""

STEP_TOLERANCE = 1e-2
"""Ratio of DOPRI5's tolerance to the requested tolerance, because errors of thousands of steps accumulate."""

DISC_STEP_TOLERANCE = 1e-3
"""The same for a disc: at U = W the ring's friction has an infinite slope, and the spin keeps the error."""

STOP_STEP_TOLERANCE = 1e-4
"""The same for a support with a stop: a bouncing motion passes the kink of its force many times."""

SMALLEST_STEP_TOLERANCE = 1e-13
"""Smallest useful tolerance of DOPRI5; below it rounding spoils the error estimate."""

LARGEST_STEP = 6.0
"""Largest step of DOPRI5 in units of tolerance^(1/5) time scales, for errors ~ tolerance."""

NEWTON_TOLERANCE = 1e-9
"""Tolerance of Newton's residual, relative to the forces at the start."""

Solver = Literal["explicit", "implicit"]

METHODS = {"explicit": "Exudyn DOPRI5, generalised-α while sticking", "implicit": "Exudyn generalised-α"}


def simulate(
    system: AnySystem,
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
    system
        A joint sticks exactly by ``TrapezoidalIndex2``, and the last three parameters do not apply.
    initial_state : array of shape (4,), (6,) or (2,)
        x, y in m and vx, vy in m/s of a pin; x, y, angle (rad), vx, vy, spin (rad/s) of a disc; angle and spin of a
        joint.
    times : array of shape (n,)
        Increasing times in s. States are interpolated between the solver's steps, which depend only on the first and
        the last time.
    tolerance
        Requested accuracy, relative to the motion's own length and speed, see ``scales``. The explicit solver keeps
        the error near it while the contact slips. Stick and pivoting add errors of first order in the regularisation.
    regularisation
        ε in m/s below which friction is viscous; by default 100·tolerance times the motion's own speed, reported as
        ``solution.regularisation``. Keep it well above the tolerance. For very soft springs pass ε explicitly,
        because μN/√(mass·stiffness) then counts as the speed, however slow the motion.
    solver : "explicit" or "implicit"
        "explicit" is DOPRI5, with generalised-α while the contact or one of its points sticks and the law is stiff.
        Stick takes some 40 steps per turn, pivoting about a point steps ~ √ε. "implicit" is generalised-α throughout,
        of second order, with steps ~ √tolerance and an error of about a thousand times the tolerance.
    friction
        Adds the friction between the discs to the model, which is built in the motion's own units.

    Raises
    ------
    ValueError
        If an argument is out of range.
    SimulationError
        If Exudyn fails, or would take more than some millions of steps.

    """
    if isinstance(system, FrictionJoint):
        return simulate_joint(system, initial_state, times, tolerance=tolerance)
    state = checked_state(system, initial_state)
    grid = checked_times(times)
    tolerance = checked_tolerance(tolerance)
    require_choice("solver", solver, METHODS)
    require_kind("friction", friction, Friction)
    epsilon = None if regularisation is None else positive_number("regularisation", regularisation, "m/s")
    run = Run.of(system, state, grid, tolerance, epsilon)
    return run.trajectory(
        METHODS[solver], run.explicit() if solver == "explicit" else run.implicit(), friction
    )


def simulate_fixed_step(
    system: System,
    initial_state: ArrayLike,
    times: ArrayLike,
    *,
    integrator: str = "RK44",
    step: float,
    regularisation: float = 1e-6,
) -> Trajectory:
    """Return the motion by one Exudyn integrator with the constant step ``step`` (s), for convergence studies.

    ``integrator`` is "RK44", "RK67" (explicit, orders 4 and 6), "GeneralizedAlpha" or "TrapezoidalIndex2" (implicit,
    order 2). An explicit integrator needs a step below about 2·mε/μN while the pin sticks. ``solution.tolerance`` is
    nan. Raises as ``simulate``.
    """
    state = checked_state(system, initial_state)
    grid = checked_times(times)
    epsilon = positive_number("regularisation", regularisation, "m/s")
    step = positive_number("step", step, "s")
    require_choice("integrator", integrator, FIXED_STEP)
    run = Run.of(system, state, grid, math.nan, epsilon)
    slip = SlipSolver(integrator, step / run.units.time, NEWTON_TOLERANCE * run.scales.force)
    friction = Friction(add_ring_friction, nothing_creeps)
    return run.trajectory(f"Exudyn {integrator}, step {step:.3g} s", slip, friction)


@dataclass(frozen=True)
class Run:
    """A motion to compute from time 0 on, in units that make it of order 1.

    Exudyn does not allow negative times, loses digits at large times, and has absolute tolerances. ``tolerance`` is
    nan for fixed steps; ``began`` is the start by ``time.perf_counter``.
    """

    given: tuple[System, FloatArray, FloatArray]
    tolerance: float
    units: Units
    contact: RegularisedContact
    state: FloatArray
    times: FloatArray
    scales: Scales
    began: float

    @classmethod
    def of(
        cls,
        system: System,
        state: FloatArray,
        times: FloatArray,
        tolerance: float,
        regularisation: float | None,
    ) -> Run:
        """Return the run for ε in m/s; None for the ε that belongs to ``tolerance``."""
        began = time.perf_counter()
        units = Units.of(system, state)
        epsilon = (
            REGULARISATION_PER_TOLERANCE * tolerance
            if regularisation is None
            else regularisation / units.speed
        )
        own_system, own_state = units.of_system(system), state / units.of_states(len(state))
        own_times = (times - times[0]) / units.time
        return cls(
            (system, state, times),
            tolerance,
            units,
            RegularisedContact(own_system, epsilon),
            own_state,
            own_times,
            Scales.of(own_system, own_state, float(own_times[-1])),
            began,
        )

    def explicit(self) -> SlipSolver:
        """Return DOPRI5 with a step and an error that follow the tolerance."""
        local = max(_step_tolerance(self.contact.system) * self.tolerance, SMALLEST_STEP_TOLERANCE)
        local *= self.scales.motion
        local = max(local, 2.0 * self.scales.angle_rounding)  # rounding of large angles
        return SlipSolver("DOPRI5", LARGEST_STEP * self.tolerance**0.2 * self.scales.time, local)

    def implicit(self) -> SlipSolver:
        """Return generalised-α with a step that follows the tolerance."""
        step = 100.0 * math.sqrt(self.tolerance) * self.scales.time
        return SlipSolver("GeneralizedAlpha", step, NEWTON_TOLERANCE * self.scales.force)

    def trajectory(self, method: str, solver: SlipSolver, friction: Friction) -> Trajectory:
        """Return the motion in SI units; ``method`` is its description."""
        found = solve_in_turns(self.contact, self.state, self.times, solver, friction, self.units.time)
        system, state, times = self.given
        unit = self.units.of_states(len(state))
        states = found.states * unit
        states[0] = state
        begun = [
            (phase.kind, float(times[0]) + phase.start * self.units.time, phase.initial_state * unit)
            for phase in found.phases()
        ]
        solution = Solution(
            method=method,
            tolerance=self.tolerance,
            evaluations=found.evaluations,
            steps=found.steps,
            wall_time=time.perf_counter() - self.began,
            regularisation=self.contact.epsilon * self.units.speed,
        )
        return Trajectory(system, times, states, phases_of(begun, float(times[-1])), solution)


def _step_tolerance(system: System) -> float:
    if system.stop_stiffness > 0.0:
        return STOP_STEP_TOLERANCE
    return DISC_STEP_TOLERANCE if isinstance(system, DiscOnDisc) else STEP_TOLERANCE
