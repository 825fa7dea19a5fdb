"""An independent, sound engine whose parts can be made wrong one by one.

It integrates eq. 1 or 19 with LSODA, which handles the stiffness of stick. Velocities are relative to the master disc
to preserve the digits of creep. Friction is viscous below a small slip speed ε, and a contact sticks while its
friction is below the limit. ε falls with the tolerance, so one estimate covers both errors. The engine shares only
parameters, results and the disk cache with the two engines of the project.
"""

import math
import time
from dataclasses import dataclass, field
from typing import Literal

import numpy as np
from scipy.integrate import LSODA
from scipy.optimize import brentq

from faults.equations import carried, fixed_steps, rates, rotated, slip_speed, turning_rates
from faults.make import RIGHT, Make, Numbers, steepest
from reference_model.systems import FloatArray, checked_state, checked_times, checked_tolerance
from reference_model.trajectory import Phase, SimulationError, Solution, Trajectory

TIGHTEST = 1e-13
"""Smallest relative tolerance of LSODA."""

MOST_STEPS = 45_000
"""Twice the number of steps of the longest sound motion; a wrong equation may be singular."""

MOST_ALIKE = 200
"""Number of equal steps before LSODA is restarted.

LSODA bounds its steps by the last stiffness that it computed. On a straight path its predictor is exact, so it never
computes the stiffness again, and a released block would keep the steps of its first moment.
"""

SAFETY = 1e-3
"""Ratio of the tolerance of a step to the requested one, which applies to the end of the motion."""

ACCURACY_IN_STICK = 1e-7
"""Error of the slip relative to ε, and so of the friction force, during stick."""


def anywhere(_):
    """Return infinity: the phase has no bound."""
    return math.inf


@dataclass
class _Run:
    """State of a running simulation."""

    numbers: Numbers
    make: Make
    times: FloatArray
    unknowns: FloatArray
    epsilon: float
    tolerance: float
    recorded: int = 1
    evaluations: int = 0
    steps: int = 0
    phases: list[tuple[Literal["slip", "stick"], float, FloatArray]] = field(default_factory=list)

    def speed(self, y):
        """Return the slip speed."""
        return float(slip_speed(y, self.numbers, self.make))

    @property
    def glance(self):
        """Return the longest step in s during stick; the load on friction changes little in it."""
        frequency = math.sqrt(self.numbers.stiffness / self.numbers.mass)
        return 0.02 / max(frequency, abs(self.numbers.omega), 1e-3)

    def time_to_rest(self, t, y):
        """Return the time in s until slip at the speed ε would end under full friction."""
        numbers, make, speed = self.numbers, self.make, self.speed(y)
        least = self.epsilon / steepest(numbers)
        step = 1e-2 * least
        moved = self.speed(y + step * rates(t, y, self.epsilon, 1.0, numbers, make))
        slowest = 1e-3 * speed / least  # if friction can hardly hold
        return speed / max((speed - moved) / step, slowest)

    def go(self):
        """Simulate the motion to its end."""
        make, t, y, end = self.make, float(self.times[0]), self.unknowns[0].copy(), float(self.times[-1])
        creep = max(self.epsilon, make.creep_speed)
        release = creep * make.static_ratio
        stuck = self.speed(y) < self.epsilon and self.numbers.friction > 0.0
        while True:
            self.phases.append(("stick" if stuck else "slip", t, y))
            if t >= end:
                return
            if stuck:
                since = t
                t, y = self.follow(
                    t, y, end, creep, make.static_ratio, lambda y: release - self.speed(y), self.glance
                )
                delay = make.release_delay + make.release_late * (t - since)
                if t < end and delay > 0.0:
                    t, y = self.follow(t, y, min(t + delay, end), creep, math.inf)
            else:
                t, y = self.follow(t, y, end, self.epsilon, 1.0, lambda y: self.speed(y) - self.epsilon)
                if t < end:  # full friction ends the remaining slip, unlike viscous friction
                    t, y = self.follow(t, y, min(t + self.time_to_rest(t, y), end), self.epsilon, 1.0)
            if t >= end:
                return
            stuck = not stuck

    def follow(self, t, y, end, width, strength, inside=anywhere, longest=math.inf):
        """Integrate until ``inside`` falls below zero, or to ``end``; return the time and the unknowns there.

        Steps are at most ``longest``.
        """
        local = max(SAFETY * self.tolerance, TIGHTEST)
        half = len(y) // 2
        # During stick the displacement in the rotating frame is small and accurate; during slip it only costs steps.
        turning = longest < math.inf
        omega = self.numbers.omega if turning else 0.0
        start, base = t, np.concatenate((y[:half], np.zeros(half))) if turning else np.zeros(2 * half)
        law = (start, base, width, strength, self.numbers, self.make)
        slipping = law[2:]

        def started(t, x):
            return LSODA(
                (lambda t, x: turning_rates(t, x, *law))
                if turning
                else (lambda t, x: rates(t, x, *slipping)),
                t,
                x,
                end,
                rtol=local,
                atol=[0.1 * local] * half + [min(0.1 * local, ACCURACY_IN_STICK * self.epsilon)] * half,
                first_step=min(1e-6, end - t),
                max_step=longest,
            )

        def at(t, x):
            return rotated(x, omega * (t - start), base)

        left = False
        solver, size, alike = started(start, y - base), 0.0, 0
        while solver.status == "running" and not left:
            self.step(solver)
            t, y = float(solver.t), at(solver.t, solver.y)
            left = inside(y) < 0.0
            alike = alike + 1 if math.isclose(solver.step_size, size, rel_tol=1e-6) else 0
            size = solver.step_size
            if left or self.pending(t):
                dense = solver.dense_output()
                if left:
                    t, y = self.crossing(lambda t: at(t, dense(t)), solver.t_old, t, inside)  # noqa: B023
                self.record(t, lambda t: at(t, dense(t)))  # noqa: B023
            if alike == MOST_ALIKE and size < 0.99 * longest and solver.status == "running":
                self.evaluations += solver.nfev
                solver, alike = started(t, solver.y), 0
        self.evaluations += solver.nfev
        return t, y

    def step(self, solver):
        """Take a step; raise ``SimulationError`` if it fails."""
        message = solver.step()
        self.steps += 1
        if self.steps > MOST_STEPS:
            raise SimulationError(f"more than {MOST_STEPS:,} steps up to t = {solver.t:g} s")
        if solver.status == "failed" or not all(map(math.isfinite, solver.y.tolist())):
            raise SimulationError(f"LSODA gave up at t = {solver.t:g} s: {message}")

    def record(self, until, at):
        """Store the unknowns at the requested times up to ``until``."""
        stop = int(np.searchsorted(self.times, until, side="right"))
        for i in range(self.recorded, stop):
            self.unknowns[i] = at(self.times[i])
        self.recorded = max(self.recorded, stop)

    @staticmethod
    def crossing(at, before, after, inside):
        """Return time and unknowns at the sign change of ``inside``; without one, at the end of the step."""
        t = after
        if inside(at(before)) > 0.0 > inside(at(after)):
            t = brentq(lambda t: inside(at(t)), before, after, xtol=1e-15, rtol=1e-14)
        return t, at(t)

    def pending(self, t):
        """Return whether a requested time up to ``t`` is not yet recorded."""
        return self.recorded < len(self.times) and bool(self.times[self.recorded] <= t)


def simulate(system, initial_state, times, *, tolerance=1e-9, make=RIGHT):
    """Return the motion of a pin or a disc from ``initial_state`` at all ``times``.

    ``make`` selects the fault of the engine. Raises ``ValueError`` for an invalid system, state or times, and
    ``SimulationError`` if LSODA fails.
    """
    clock = time.perf_counter()
    start, times = checked_state(system, initial_state), checked_times(times)
    tolerance = checked_tolerance(tolerance)
    numbers = Numbers.of(system)
    # An explicit method cannot resolve the end of slip within a step.
    epsilon = max(10.0 * tolerance, make.step * steepest(numbers))
    half = len(start) // 2
    unknowns = np.empty((len(times), 2 * half))
    unknowns[0] = start
    unknowns[0, half:] -= carried(start[:half], numbers.omega)
    run = _Run(numbers, make, times, unknowns, epsilon, tolerance)
    if make.order > 0:
        unknowns[:] = fixed_steps(times, unknowns[0], epsilon, numbers, make)
        run.phases.append(("slip", float(times[0]), unknowns[0]))
    else:
        run.go()

    def state_of(unknowns):
        places, relative = np.split(unknowns, 2, axis=-1)
        return np.concatenate((places, relative + carried(places, numbers.omega)), axis=-1)

    states = state_of(unknowns)
    states[0] = start
    starts = [t for _, t, _ in run.phases]
    phases = tuple(
        Phase(kind, t, end, state_of(y))
        for (kind, t, y), end in zip(run.phases, [*starts[1:], float(times[-1])], strict=True)
    )
    solution = Solution(
        "LSODA, friction viscous below ε",
        tolerance,
        run.evaluations,
        run.steps,
        time.perf_counter() - clock,
        epsilon,
    )
    return Trajectory(system, times, states, phases, solution)
