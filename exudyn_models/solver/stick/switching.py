"""Runs of models whose contacts stick exactly: from one change of mode to the next.

Between two changes the equations are smooth. A step that passes a change is taken back and repeated to end there, and
``mode_choice`` chooses the modes. ``sliding_steps`` chooses the steps of contacts that slide in the plane. One run of
Exudyn's solver contains all of these steps, because each start of a solver costs as much as several steps.
"""

import math
from collections.abc import Callable, Generator, Sequence
from contextlib import nullcontext
from typing import Any

import exudyn as exu
import numpy as np
from numpy.typing import NDArray

from exudyn_models.forces.axial_pairs import Mode
from exudyn_models.solver.items import CURRENT
from exudyn_models.solver.repeated_steps import changed, user_function
from exudyn_models.solver.starting_rates import renew_rates
from exudyn_models.solver.stick.mode_choice import MOST_CHANGES, ModeChoice
from exudyn_models.solver.stick.sliding_steps import APPROACH, ON_GRID, SlidingSteps
from exudyn_models.solver.stick.slip_motion import RESOLVED
from exudyn_models.solver.stick.sticking_contacts import ModeChange, PlanarContact, StickingContact
from reference_model.systems import FloatArray
from reference_model.trajectory import SimulationError

LOCATED = 1e-12
"""Resolution of the time of a change, as a share of a step."""

SOON = 1e-7
"""Largest difference between the time of a change and the end of the step to it, as a share of a step."""

SMALL = 1e-3
"""Largest margin near a change, relative to the margins of the step; margins that jump are larger."""

SOLVER = exu.DynamicSolverType.TrapezoidalIndex2
"""Solver of all steps; constraint forces of GeneralizedAlpha contain errors of positions over the squared step."""

FORCES = 1e-12
"""Residual of Newton's method for contacts in the plane, relative to its first value or to the friction.

Constraint forces, which decide about releases, contain errors of velocities divided by the step.
"""

ITERATIONS = 200
"""Smallest limit of Newton's iterations; loads that depend on forces need many, because the Jacobian omits them."""

BEYOND = 1e-9
"""Time in s from the end of a run to that of Exudyn, which would end 1e-10 s early."""

START = exu.ConfigurationType.StartOfStep

_Point = tuple[float, FloatArray]
"""A time in s, and the margins at this time."""

_Steps = Generator[float, float, Any]
"""Requests steps to times in s, and receives the times where they end, which are earlier if Newton's method fails."""


def run_switching(
    mbs: Any,
    settings: Any,
    contacts: list[StickingContact],
    update_initial_values: bool,
    before: Sequence[Mode] = (),
) -> list[ModeChange]:
    """Run TrapezoidalIndex2; return the changes of modes of the ``contacts``, which had the modes ``before``.

    Raises ``SimulationError`` if the modes change without end at one time.
    """
    run = _Run(mbs, settings, contacts)
    run.run(before, update_initial_values)
    return run.changes


class _Run:
    def __init__(self, mbs: Any, settings: Any, contacts: list[StickingContact]) -> None:
        self._mbs, self._data, self._settings, self._contacts = mbs, mbs.systemData, settings, contacts
        self._options = options = settings.timeIntegration
        self._start, self._end, self._steps = options.startTime, options.endTime, options.numberOfSteps
        self._step = (self._end - self._start) / self._steps
        outputs = settings.solution
        wanted = [kind for kind in (_Rows, _FileRows) if kind.chosen(outputs)]
        self._rows = [kind(outputs, self._start, self._step) for kind in wanted]
        self._reached = self._start
        self._size, self._ends = 0.0, False
        self._announced, self._settled = -math.inf, list[float]()
        self._ended_at_once = -math.inf
        self._planar = [contact for contact in contacts if isinstance(contact, PlanarContact)]
        self._slides = SlidingSteps(mbs, self._planar, self._step)
        self._modes = ModeChoice(mbs, self._start, contacts, self._slides, self._step)
        self._solver: Any = None
        self._own: Callable[[Any, float], bool] = lambda mbs, t: True
        self.changes: list[ModeChange] = []

    def run(self, before: Sequence[Mode], update_initial_values: bool) -> None:
        """Run to the end of the settings."""
        mbs, options, outputs = self._mbs, self._options, self._settings.solution
        calls_before = bool(self._planar) or bool(mbs.GetPreStepUserFunction())
        steps = self._motion(before)
        with (
            changed(options, endTime=self._end + self._step + BEYOND),
            # ``dynamics`` finds better accelerations.
            changed(options.generalizedAlpha, computeInitialAccelerations=False),
            changed(options.newton, **self._accuracy()),
            changed(outputs.sensors, writePeriod=0.0, active=outputs.sensors.active),
            changed(outputs.file, writePeriod=0.0),
            user_function(mbs, "PreStep", self._before_step) if calls_before else nullcontext(),
            user_function(mbs, "PostStep", lambda own: self._after_step(own, steps)),
        ):
            mbs.SolveDynamic(self._settings, SOLVER, update_initial_values)

    def _accuracy(self) -> dict[str, Any]:
        """Return settings of Newton's method that friction requires."""
        newton = self._options.newton
        values: dict[str, Any] = {"maxIterations": max(newton.maxIterations, ITERATIONS)}
        if self._planar:
            self._tolerances = newton.relativeTolerance, min(newton.relativeTolerance, FORCES)
            friction = max(contact.strength(self._start)[0] for contact in self._planar)
            values["absoluteTolerance"] = min(newton.absoluteTolerance, FORCES * friction)
            # The direction of friction turns too fast for the Jacobian of an earlier step.
            values["useModifiedNewton"] = values["modifiedNewtonJacUpdatePerStep"] = True
        return values

    def _before_step(self, own: Callable[[Any, float], bool]) -> Callable[[Any, float], bool]:
        def prepare(mbs: Any, t: float) -> bool:
            for contact in self._planar:
                contact.start_step(mbs)
            if t <= self._announced + ON_GRID * self._step:  # this step replaces one that passed a change
                return True
            self._announced = t
            return own(mbs, t)

        return prepare

    def _after_step(self, own: Callable[[Any, float], bool], steps: _Steps) -> Callable[[Any, float], bool]:
        self._own = own

        def look(mbs: Any, t: float) -> bool:
            begins = self._solver is None
            if begins:
                self._solver = mbs.sys["dynamicSolver"]
            try:
                self._aim(next(steps) if begins else steps.send(t))
                goes_on = True
            except StopIteration:
                goes_on = False
            for rows in self._rows:  # Exudyn writes them after this function
                rows.switch(self._solver)
            return goes_on

        return look

    def _aim(self, t: float) -> None:
        """Let the next step end at the time t (s)."""
        if t <= self._reached:
            raise SimulationError(
                f"steps that resolve how contacts slide fell to zero at t = {self._reached:.9g} s: use smaller "
                "steps, or give the contacts a regularisation"
            )
        step = t - self._reached
        if abs(step - self._size) > LOCATED * step:
            it, self._size = self._solver.it, step
            it.currentStepSize = it.maxStepSize = step
            self._renew_jacobian()
            if not self._options.adaptiveStep:  # Exudyn counts steps of one size then
                it.adaptiveStep, it.minStepSize = True, step
        if self._planar:
            small = any(one.free_to_slide for one in self._planar) and self._slides.longest < self._step
            self._solver.newton.relativeTolerance = self._tolerances[not small]

    def _renew_jacobian(self) -> None:
        self._solver.conv.jacobianUpdateRequested = True

    def _motion(self, before: Sequence[Mode]) -> _Steps:
        """Generate all steps of the run."""
        self._modes.begin(self._reached)
        self._settle(before)
        self._keep(self._reached)
        while not self._ends:
            passed = yield from self._go_on()
            if passed is None and not self._slides.rests:
                continue
            modes = [contact.stick.visible_mode for contact in self._contacts]
            yield from self._land(*passed) if passed is not None else self._stop()
            self._settle(modes)

    def _settle(self, before: Sequence[Mode]) -> None:
        """Choose the modes after those ``before``."""
        self._modes.settle(self._reached)
        renew_rates(self._mbs, self._reached, self._modes.solver)
        self._renew_jacobian()
        self._note(before)
        for rows in self._rows:
            rows.note(self._reached, True)

    def _keep(self, t: float) -> None:
        """Accept a step to the time t (s)."""
        if ends := t >= self._end - ON_GRID * self._step:
            t = self._end  # steps add up to it only within rounding errors
            self._data.SetTime(t)
        self._reached = t
        self._ends = not self._own(self._mbs, t) or ends
        for rows in self._rows:
            rows.note(t, self._ends)

    def _go_on(self) -> _Steps:
        """Step to the end of the run, or until contacts in the plane rest; return None.

        If a step passes a change, take it back, and return its end and the margins at both of its ends.
        """
        longest, recovery = math.inf, self._options.adaptiveStepRecoverySteps
        while not self._ends:
            start = self._reached
            self._modes.first_slips.take_back(start)
            done = math.floor((start - self._start) / self._step + ON_GRID) + 1
            end = self._end if done >= self._steps else self._start + done * self._step
            end = min(end, start + longest, start + self._slides.longest)
            t = yield end
            recovery -= 1
            if end - t > ON_GRID * self._step:  # Exudyn has shortened the step
                longest, recovery = t - start, self._options.adaptiveStepRecoverySteps
            elif recovery == 0:
                longest, recovery = 2.0 * longest, self._options.adaptiveStepRecoverySteps
            if not self._modes.hold(t):
                now = self._modes.margins(t)
                if now.min() < 0.0:
                    self._take_back()
                    return t, (self._modes.margins(start), now)
            if not self._slides.resolves(t - start):
                self._take_back()
                continue
            self._keep(t)
            if self._slides.rests:
                break
        return None

    def _take_back(self) -> None:
        data = self._data
        data.SetSystemState(data.GetSystemState(START), CURRENT)
        data.SetODE2Coordinates_tt(data.GetODE2Coordinates_tt(START))
        if data.ODE1Size():
            data.SetODE1Coordinates_t(data.GetODE1Coordinates_t(START))
        data.SetTime(self._reached)
        self._solver.it.currentTime, self._size = self._reached, 0.0

    def _land(self, high: float, margins: Sequence[FloatArray]) -> _Steps:
        """Step to the first change before ``high`` (s), and leave the modes that end there.

        Inverse interpolation through the latest points finds it, or the Illinois method within the interval (Dowell &
        Jarratt, BIT 11 (1971) 168).
        """
        low, (above, below) = self._reached, margins
        points: list[_Point] = [(low, above), (high, below)]
        least = max(LOCATED * self._step, 4.0 * np.spacing(abs(high)))
        side, large = 0, np.abs(below) + np.abs(above)
        # A slip that has just begun is zero at the start of the step, and may turn back within the step.
        start, turns_back, at_once = low, self._ended_at_once == low, False
        t, now = low, above
        for tried in range(MOST_CHANGES):
            ended = below < 0.0
            within = [(low, np.maximum(above, 0.0)), (high, below)]
            trials = (_roots(some, ended) for some in (points[-3:], points[-2:], within))
            roots = next((root for root in trials if low < root.min() < high), np.where(ended, low, np.inf))
            found = float(roots.min())
            is_small = (np.abs(points[-1][1]) <= SMALL * large)[roots.argmin()]
            if tried and is_small and abs(found - t) <= SOON * self._step:
                break
            if tried:
                self._take_back()
            if high - low <= least:  # a margin jumps here
                t = yield high
                now = self._modes.margins(t)
                break
            bisects = tried % 4 == 3 or (turns_back and low == start)
            aim = (low + high) / 2.0 if bisects else found
            at_once = tried == 0 and aim - low <= least
            if at_once:
                break
            t = yield min(max(aim, low) + least / 2.0, high - least / 2.0)
            now = self._modes.margins(t)
            points.append((t, now))
            if (now < 0.0).any():
                high, below, above, side = t, now, above if side <= 0 else above / 2.0, 1
            else:
                low, above, below, side = t, now, below if side >= 0 else below / 2.0, -1
        self._ended_at_once = low if at_once else -math.inf
        if not at_once:
            self._keep(t)
        ends = np.flatnonzero((now < 0.0) | (roots - t <= SOON * self._step)).tolist()
        self._modes.end([self._contacts[i] for i in ends])

    def _stop(self) -> _Steps:
        """Step under constant friction until contacts in the plane rest.

        A slip that a prescribed motion reverses passes through zero, until it has a direction again.
        """
        motions = [(contact, contact.motion(self._mbs)) for contact in self._planar if contact.free_to_slide]
        time = min(motion.remaining for contact, motion in motions if self._slides.stops(contact, motion))
        # Others stop too if their slip would not resolve this step.
        stopping = [(contact, motion) for contact, motion in motions if APPROACH * motion.remaining <= time]
        self._modes.survey(self._reached)
        passing = [motion for contact, motion in stopping if contact.passes(motion)]
        shortest = PlanarContact.resolution * self._step
        time += max(
            (max(shortest, 2.0 * RESOLVED * one.largest_term / one.rate_potential) for one in passing),
            default=0.0,
        )
        end = min(self._reached + time, self._end)
        for contact, _ in stopping:
            contact.planar.frozen = True
        try:
            while self._reached < end and not self._ends:
                self._keep((yield end))
        finally:
            for contact, _ in stopping:
                contact.planar.frozen = False
        self._modes.end(contact for contact, _ in stopping)

    def _note(self, before: Sequence[Mode]) -> None:
        """Record the changes of mode; raise ``SimulationError`` if they do not end."""
        for contact, mode in zip(self._contacts, before, strict=bool(before)):
            after = contact.stick.visible_mode
            if after != mode:
                self.changes.append(ModeChange(self._reached, contact.item, mode, after, contact.stick.point))
        self._settled = [*self._settled[1 - MOST_CHANGES :], self._reached]
        least = MOST_CHANGES * SOON * self._step  # a step to a change may end this late
        if len(self._settled) == MOST_CHANGES and self._reached - self._settled[0] < least:
            raise SimulationError(
                f"friction contacts changed their modes {MOST_CHANGES} times at t = {self._reached:.9g} s; "
                "contacts between the same bodies may hold each other"
            )


def _roots(points: Sequence[_Point], ended: NDArray[Any]) -> FloatArray:
    """Return the times (s) where margins vanish, by inverse interpolation; infinite unless the mode has ``ended``."""
    times = np.full(len(ended), np.inf)
    for i in np.flatnonzero(ended).tolist():
        pairs = [(t, float(margins[i])) for t, margins in points]
        if len({margin for _, margin in pairs}) == len(pairs):
            times[i] = sum(
                t * math.prod(other / (other - margin) for _, other in pairs if other != margin)
                for t, margin in pairs
            )
        else:
            times[i] = math.nan
    return times


class _Rows:
    """Rows of all sensors: one a period, and one at each change of mode."""

    def __init__(self, outputs: Any, start: float, step: float) -> None:
        self._settings = settings = self.chosen(outputs)
        self._next, self._step, self._period = start, step, max(settings.writePeriod, step)
        self._due, self._on = False, True

    @staticmethod
    def chosen(outputs: Any) -> Any:
        """Return the settings of the rows, or None without rows."""
        return outputs.sensors if outputs.sensors.active else None

    def note(self, t: float, always: bool) -> None:
        """Note that the state at the time t (s) is one of the motion, with a row if one is due or ``always``."""
        if t >= self._next - ON_GRID * self._step:
            self._next += self._period * (1 + math.floor((t - self._next) / self._period + ON_GRID))
            always = True
        self._due |= always

    def switch(self, solver: Any) -> None:
        """Let the ``solver`` write a row of the present state, or not."""
        if self._due != self._on:
            self._on = self._due
            self._write(solver)
        self._due = False

    def _write(self, solver: Any) -> None:
        self._settings.active = self._on


class _FileRows(_Rows):
    """The same of the solution file."""

    @staticmethod
    def chosen(outputs: Any) -> Any:
        """Return the settings of the rows, or None without rows."""
        return outputs.file if outputs.file.write else None

    def _write(self, solver: Any) -> None:
        solver.output.writeToSolutionFile = self._on
