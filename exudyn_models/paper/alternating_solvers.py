"""Motions that alternate between slip and creep, each with its own solver and axes."""

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import NDArray

from exudyn_models.paper.creep import RELAXATIONS, WHOLE, RegularisedContact
from exudyn_models.paper.dense_output import creep_between, creep_until
from exudyn_models.paper.model import build_model
from exudyn_models.paper.recording import FIXED, Axes, Recording
from exudyn_models.paper.scales import time_scale
from exudyn_models.parts.ring_friction import add_ring_friction
from exudyn_models.solver.solver_run import FIRST_STEP, StepCount, Steps, solve
from reference_model.systems import DiscOnDisc, FloatArray, System
from reference_model.trajectory import LOOK_BACK

CREEP_NEWTON_TOLERANCE = 1e-6
"""Residual of Newton's method during creep, relative to μN (and μN·R, if that is smaller).

This error is a millionth of the creep, and exceeds rounding errors down to ε ~ 1e-11.
"""

VISCOUS_RANGE = 2.0**40
"""Factor that extends the viscous part of the friction law of a creeping system."""

CREEP_ANGLE = 0.15
"""Rotation of the ground in rad per step of creep: the error of a step h is (ωh)²/12, 0.2 % of the creep."""

SLOW = 100.0
"""Smallest ratio of slow to fast relaxation time for steps that resolve only the slow relaxation."""

STEPS_OF_RELAXATION = 20.0
"""Steps of creep per slow relaxation time."""

Part = int | frozenset[int]
"""Creeping part of a contact: ``WHOLE``, or some of several points."""

Creeping = Callable[[RegularisedContact, list[float]], Part | None]


@dataclass(frozen=True)
class Friction:
    """Friction between two discs, in the units and the axes of a run.

    ``add`` adds it to a model. ``creeping`` returns the creeping part of the contact, which may be modelled with
    unlimited viscosity (single points by the argument ``held`` of ``add``).
    """

    add: Callable[..., Any]
    creeping: Creeping


def nothing_creeps(contact: RegularisedContact, state: list[float]) -> None:
    """Return None, so that one solver follows the whole motion."""


RING_FRICTION = Friction(add_ring_friction, RegularisedContact.creeping)


@dataclass(frozen=True)
class SlipSolver:
    """Integrator, step and tolerance for slip, as in ``solver_run.solve``."""

    integrator: str
    step: float
    tolerance: float


def solve_in_turns(
    contact: RegularisedContact,
    state: FloatArray,
    times: FloatArray,
    solver: SlipSolver,
    friction: Friction,
    seconds: float,
) -> Recording:
    """Solve up to the last of ``times``, shape (n,), with ``solver`` in slip and generalised-α in creep.

    In creep an explicit method would need steps of 3·mε/μN. In axes that turn with the master disc a creeping body
    almost rests, and steps of a fraction of a turn have an error of a small fraction of the creep.

    For a creeping part (the whole contact or one of several points) the model extends the viscous part of the law
    without limit, so the law's kink cannot disturb Newton's method. The creep ends between two steps.

    All numbers are scaled so that the motion is of order 1; messages need the unit of time, ``seconds``, in s.
    """
    motion = _Turns(
        contact, solver, friction, Recording(contact, times), StepCount(float(times[-1]), seconds=seconds)
    )
    start, part, creep_began, first_step = 0.0, None, 0.0, FIRST_STEP
    while not motion.recording.finished:
        if part is None:
            run, part = motion.slip(state, start, first_step)
            creep_began = float(run.times[-1])
            first_step = float(run.times[-1] - run.times[-2]) if len(run.times) > 1 else FIRST_STEP
        else:
            run, part = motion.creep(run, part, creep_began)
            first_step = FIRST_STEP
        state, start = run.states[-1], float(run.times[-1])
    return motion.recording


@dataclass(frozen=True)
class _Turns:
    contact: RegularisedContact
    solver: SlipSolver
    friction: Friction
    recording: Recording
    count: StepCount

    def slip(self, state: FloatArray, start: float, first_step: float) -> tuple[Steps, Part | None]:
        """Solve from ``state`` until something creeps; return the steps and the creeping part."""
        watch = _Slip(self)
        run = solve(
            build_model(
                self.contact.system, state, regularisation=self.contact.epsilon, friction=self.friction.add
            ),
            start,
            self.count.end,
            integrator=self.solver.integrator,
            step=self.solver.step,
            tolerance=self.solver.tolerance,
            watch=watch,
            first_step=first_step,
            count=self.count,
        )
        self.recording.add(run, FIXED)
        return run, watch.settled

    def creep(self, before: Steps, part: Part, began: float) -> tuple[Steps, Part | None]:
        """Solve from the last of the steps ``before`` while ``part`` creeps, since ``began``.

        Return the steps, and ``part`` if it still creeps. Steps before a release become smaller, because it starts
        gently.
        """
        state, start = before.states[-1], float(before.times[-1])
        step, until = self._creep_step(before, part, began)
        balanced = False
        if part != WHOLE:
            self.count.look_from(start)
        while True:
            axes = Axes(self.contact.system.disc_speed, start)
            run = solve(
                self._creep_model(axes, state, part),
                start,
                until,
                integrator="GeneralizedAlpha",
                step=step,
                tolerance=_newton_tolerance(self.contact.system),
                quasi_static=part == WHOLE,
                balanced=balanced,
                watch=_Creep(self, axes.start(state), part),
                count=self.count,
            )
            crossing = self._end_of_creep(run, part)
            fine = self._fine_up_to(run, step, crossing) if part == WHOLE else None
            if fine is not None:
                run = run.only(np.arange(fine + 1))
            elif crossing is not None:
                run = creep_until(run, crossing)
            if len(run.times) > 1 or fine is None:
                self.recording.add(run, axes)
                before = axes.fixed_steps(run)
            if fine is None:
                return before, part if crossing is None else None
            state, start, step = before.states[-1], float(before.times[-1]), step / REFINEMENT
            until = min(until, start + 2.0 * REFINEMENT * step)
            balanced = balanced or len(run.times) > 1  # only after a step of creep

    def _fine_up_to(self, run: Steps, step: float, crossing: float | None) -> int | None:
        """Return the index of the last step before smaller steps are needed, or None.

        Smaller steps are needed for a release at ``crossing``, or for a load so close to the friction limit that the
        error of the creep could cross the limit.
        """
        error = (self.contact.system.disc_speed * step) ** 2
        unclear = error > GRAZING
        if crossing is not None:
            last = int(np.searchsorted(run.times, crossing)) - 1
            return last if unclear or step > self._release_step(run, last) else None
        if not unclear:
            return None
        grazed = _tops(self.contact.in_master_axes, run, 1.0 - error)
        return max(int(grazed[0]) - 1, 0) if len(grazed) > 0 else None

    def _release_step(self, run: Steps, last: int) -> float:
        """Return the step that lets a released body gain only a fraction of ε."""
        ratio = self.contact.in_master_axes.slip_ratios(run.states[last : last + 2])[:, WHOLE]
        rate = float(ratio[1] - ratio[0]) / float(run.times[last + 1] - run.times[last])
        return math.sqrt(0.12 * self.contact.relaxation_times[0] / rate) if rate > 0.0 else 0.0

    def _creep_step(self, before: Steps, part: Part, began: float) -> tuple[float, float]:
        system, end = self.contact.system, self.count.end
        state, start = before.states[-1], float(before.times[-1])
        speed = abs(system.disc_speed)
        step = CREEP_ANGLE / speed if speed > 0.0 else CREEP_ANGLE * time_scale(system, state, end)
        if part != WHOLE:
            step = min(step, _pivot_step(self.contact, before))
            return step, min(end, start + LOOK_BACK / 2 * step)
        fast, slow = self.contact.relaxation_times
        slow_until = began + RELAXATIONS * slow
        if slow > SLOW * fast and slow < STEPS_OF_RELAXATION * step and start < slow_until < end:
            return slow / STEPS_OF_RELAXATION, slow_until
        return step, end

    def _creep_model(self, axes: Axes, state: FloatArray, part: Part) -> Any:
        system, add = self.contact.system, self.friction.add
        viscous = 1.0
        if part == WHOLE:
            viscous = VISCOUS_RANGE
            system = replace(system, friction_force=viscous * system.friction_force)
        else:
            add = partial(add, held=part)
        return build_model(
            system,
            axes.start(state),
            regularisation=viscous * self.contact.epsilon,
            friction=add,
            axes_speed=axes.speed,
        )

    def _end_of_creep(self, run: Steps, part: Part) -> float | None:
        """Return the first time in ``run`` when another part creeps, or None."""
        seen, states_at = self.contact.in_master_axes, creep_between(run)

        def first_other(times: FloatArray) -> int | None:
            states = enumerate(states_at(times).tolist())
            return next((i for i, state in states if self.friction.creeping(seen, state) != part), None)

        places = _suspects(seen, run) if part == WHOLE else run.times[-1:]
        found = first_other(places)
        if found is None:
            return None
        first = float(places[found])
        if first == run.times[0]:
            return first
        left = float(run.times[np.searchsorted(run.times, first) - 1])
        error = max(CROSSING * float(run.times[-1] - run.times[-2]), PARTS * np.spacing(first))
        while first - left > error:
            inside = np.linspace(left, first, PARTS + 1)
            found = first_other(inside[1:-1])
            after = PARTS if found is None else found + 1
            left, first = float(inside[after - 1]), float(inside[after])
        return first


CROSSING = 1e-9
"""Error of the end of creep, in steps."""

GRAZING = 1e-6
"""(ωh)² of the steps that decide whether friction can hold a load: its error is 1e-7 of the load."""

REFINEMENT = 16.0
"""Ratio of steps before and after a reduction for a release."""

PARTS = 16
"""Number of checks in a step close to the end of creep."""


def _tops(contact: RegularisedContact, run: Steps, above: float) -> NDArray[np.intp]:
    """Return the indices of maxima of creep above ``above``·ε."""
    ratio = np.pad(contact.slip_ratios(run.states)[:, WHOLE], 1, mode="constant", constant_values=-np.inf)
    return np.flatnonzero((ratio[1:-1] > above) & (ratio[1:-1] >= ratio[:-2]) & (ratio[1:-1] > ratio[2:]))


def _suspects(contact: RegularisedContact, run: Steps) -> FloatArray:
    """Return possible ends of creep in ``run``: its last time, and around maxima near ε."""
    steps = _tops(contact, run, 0.99)
    steps = np.union1d(steps[steps > 0] - 1, steps[steps < len(run.times) - 1])
    inside = run.times[steps, None] + np.diff(run.times)[steps, None] * np.linspace(0.0, 1.0, PARTS + 1)[1:]
    return np.append(inside.ravel(), run.times[-1])


class _Slip:
    """Watches whether slip has settled to creep, and measures its pace."""

    def __init__(self, motion: _Turns) -> None:
        self.motion, self.settled = motion, None
        fast, slow = motion.contact.relaxation_times
        self._settling = RELAXATIONS * (slow if slow <= SLOW * fast else fast)
        self._since, self._part, self._steps = math.inf, None, 0

    settled: Part | None
    _part: Part | None

    def __call__(self, t: float, state: list[float]) -> bool:
        self._steps += 1
        now = self.motion.friction.creeping(self.motion.contact, state)
        if now != self._part:
            self._since, self._part = (math.inf if now is None else t), now
        if t - self._since >= self._settling:
            self.settled = now
            return False
        return self._steps < LOOK_BACK or now is not None


class _Creep:
    """Watches whether ``part`` still creeps and, for a point, whether the disc still pivots at a similar speed."""

    def __init__(self, motion: _Turns, state: FloatArray, part: Part) -> None:
        self.creeping, self.seen, self.part = motion.friction.creeping, motion.contact.in_master_axes, part
        self._speed, self._steps = self._slip_ratio(state), 0

    def __call__(self, t: float, state: list[float]) -> bool:
        self._steps += 1
        if self.creeping(self.seen, state) != self.part:
            return False
        if self._steps == LOOK_BACK:
            return False
        return self.part == WHOLE or 0.5 < self._slip_ratio(np.array(state)) / self._speed < 2.0

    def _slip_ratio(self, state: FloatArray) -> float:
        return float(self.seen.slip_ratios(state[None, :])[0, WHOLE])


def _pivot_step(contact: RegularisedContact, steps: Steps) -> float:
    system, epsilon = contact.system, contact.epsilon
    ratio = contact.slip_ratios(steps.states[-1:])[0, WHOLE]
    rate = contact.slip_ratio_rates(steps.states[-1], steps.accelerations[-1])[WHOLE]
    jerk = epsilon * rate**2 / ratio
    if isinstance(system, DiscOnDisc):
        spin, growth = abs(steps.states[-1, 5] - system.disc_speed), abs(steps.accelerations[-1, 2])
        fastest = spin + abs(system.disc_speed)
        jerk += system.contact_radius * fastest * (growth + spin * fastest)
    return math.sqrt(0.12 * epsilon / jerk)


def _newton_tolerance(system: System) -> float:
    """Return the tolerated residual during creep; a moment counts as a force at R, or at 1 if that is smaller."""
    lever = min(1.0, system.contact_radius) if isinstance(system, DiscOnDisc) else 1.0
    return CREEP_NEWTON_TOLERANCE * system.friction_force * lever
