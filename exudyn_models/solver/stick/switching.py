"""Runs of models whose contacts stick exactly: from one change of mode to the next.

Between two changes the equations are smooth. A step that passes a change is repeated to end there, and
``mode_choice`` chooses the modes. ``sliding_steps`` chooses the steps of contacts that slide in the plane.
"""

import copy
import math
from collections.abc import Callable, Sequence
from contextlib import nullcontext
from typing import Any

import exudyn as exu
import numpy as np
from numpy.typing import NDArray

from exudyn_models.forces.axial_pairs import Mode
from exudyn_models.solver.repeated_steps import user_function
from exudyn_models.solver.starting_rates import starting_rates
from exudyn_models.solver.stick.mode_choice import MOST_CHANGES, ModeChoice
from exudyn_models.solver.stick.sliding_steps import ON_GRID, SlidingSteps
from exudyn_models.solver.stick.slip_motion import RESOLVED
from exudyn_models.solver.stick.sticking_contacts import ModeChange, PlanarContact, StickingContact
from reference_model.systems import FloatArray
from reference_model.trajectory import SimulationError

LOCATED = 1e-12
"""Resolution of the time of a change, as a share of a step."""

SOON = 1e-5
"""Largest difference between the roots of a line and a parabola, as a share of a step; the second is closer."""

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


_Point = tuple[float, FloatArray]
"""A time in s, and the margins at this time."""


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
    data, initial = mbs.systemData, exu.ConfigurationType.Initial
    state = data.GetSystemState(initial)
    run = _Run(mbs, copy.copy(settings), contacts)
    try:
        run.run(before)
    finally:
        if not update_initial_values:
            data.SetSystemState(state, initial)
    return run.changes


class _Run:
    def __init__(self, mbs: Any, settings: Any, contacts: list[StickingContact]) -> None:
        self._mbs, self._settings, self._contacts = mbs, settings, contacts
        self._options = options = settings.timeIntegration
        self._start, self._end, self._steps = options.startTime, options.endTime, options.numberOfSteps
        self._step = (self._end - self._start) / self._steps
        self._sensors = _SensorRows(settings.solution.sensors, self._start, self._step)
        self._writes_file = settings.solution.file.write
        self._reached, self._stopped, self._begun = self._start, False, False
        self._announced, self._settled = -math.inf, list[float]()
        self._ended_at_once = -math.inf
        self._planar = [contact for contact in contacts if isinstance(contact, PlanarContact)]
        self._accelerations = np.empty(0)
        self._slides = SlidingSteps(mbs, self._planar, self._step)
        self._modes = ModeChoice(mbs, self._start, contacts, self._slides, self._step)
        self._look: Callable[[float], bool] = lambda t: True
        self.changes: list[ModeChange] = []

    def run(self, before: Sequence[Mode]) -> None:
        """Run to the end of the settings and leave it as the initial values."""
        mbs = self._mbs
        calls_before = bool(self._planar) or bool(mbs.GetPreStepUserFunction())
        with (
            user_function(mbs, "PreStep", self._before_step) if calls_before else nullcontext(),
            user_function(mbs, "PostStep", self._after_step),
        ):
            self._choose_accuracy()
            self._modes.begin(self._reached)
            self._modes.settle(self._reached)
            self._note(before)
            while self._reached < self._end - ON_GRID * self._step and not self._stopped:
                passed = self._go_on()
                if passed is not None or self._slides.rests:
                    modes = [contact.stick.visible_mode for contact in self._contacts]
                    if passed is not None:
                        self._land(*passed)
                    else:
                        self._stop()
                    self._modes.settle(self._reached)
                    self._note(modes)

    def _choose_accuracy(self) -> None:
        """Change settings of Newton's method as friction requires."""
        self._options.generalizedAlpha.computeInitialAccelerations = (
            False  # ``dynamics`` finds better accelerations
        )
        newton = self._options.newton
        newton.maxIterations = max(newton.maxIterations, ITERATIONS)
        if self._planar:
            newton.modifiedNewtonJacUpdatePerStep = True
            self._tolerances = newton.relativeTolerance, min(newton.relativeTolerance, FORCES)
            friction = max(contact.strength(self._start)[0] for contact in self._planar)
            newton.absoluteTolerance = min(newton.absoluteTolerance, FORCES * friction)

    def _before_step(self, own: Callable[[Any, float], bool]) -> Callable[[Any, float], bool]:
        def prepare(mbs: Any, t: float) -> bool:
            for contact in self._planar:
                contact.start_step(mbs)
            if t <= self._announced:  # a shorter step replaces a step that passed a change
                return True
            self._announced = t
            return own(mbs, t)

        return prepare

    def _after_step(self, own: Callable[[Any, float], bool]) -> Callable[[Any, float], bool]:
        def look(mbs: Any, t: float) -> bool:
            if not self._look(t):
                return False
            if t <= self._reached and self._begun:  # Exudyn also calls it at the start of each part
                return True
            self._reached, self._begun = t, True
            self._stopped = not own(mbs, t)
            return not self._stopped and not self._slides.pauses

        return look

    def _part(
        self,
        end: float,
        steps: int,
        look: Callable[[float], bool],
        *,
        write: bool,
        keep: bool,
    ) -> None:
        """Run to ``end`` (s); ``write`` sensors and files, ``keep`` the end."""
        if end <= self._reached:
            raise SimulationError(
                f"steps that resolve how contacts slide fell to zero at t = {self._reached:.9g} s: use smaller "
                "steps, or give the contacts a regularisation"
            )
        options, solution = self._options, self._settings.solution
        options.startTime, options.endTime, options.numberOfSteps = self._reached, end, steps
        self._sensors.switch(write)
        solution.file.write = write and self._writes_file
        if self._planar:
            small = (
                any(contact.free_to_slide for contact in self._planar) and self._slides.longest < self._step
            )
            options.newton.relativeTolerance = self._tolerances[not small]
            # The direction of friction turns too fast for an old Jacobian.
            options.newton.useModifiedNewton = not any(one.stick.slides for one in self._planar)
        self._look = look
        with starting_rates(self._mbs, self._reached):
            self._mbs.SolveDynamic(self._settings, SOLVER, keep)
        if write:
            solution.file.append = solution.sensors.append = True

    def _go_on(self) -> tuple[float, Sequence[FloatArray]] | None:
        """Run to the end, or to the next multiple of the step if the last part ended between two.

        Return None, or the end of a step that passed a change, with the margins at both of its ends.
        """
        data, start = self._mbs.systemData, self._reached
        self._modes.take_back(start)
        whole = (start - self._start) / self._step
        on_grid = abs(whole - round(whole)) < ON_GRID
        done = round(whole) if on_grid else math.floor(whole)
        end = self._end if on_grid or done + 1 == self._steps else self._start + (done + 1) * self._step
        steps = self._steps - done if on_grid else 1
        if (longest := self._slides.longest) < self._step:
            end, steps = min(end, start + longest), 1
        self._sensors.is_due(start)  # the part begins with a row
        margins, passed = self._modes.margins(start), None
        self._slides.pauses = self._slides.rests = False

        def look(t: float) -> bool:
            nonlocal margins, passed
            if t == start:
                data.SetAECoordinates(
                    data.GetAECoordinates(exu.ConfigurationType.Initial)
                )  # sensors show them
                self._accelerations = data.GetODE2Coordinates_tt()
                return True
            now = self._modes.margins(t)
            if now.min() < 0.0:
                passed = t, (margins, now)
            if passed is not None or not self._slides.resolves(t - self._reached):
                self._take_back()
                return False
            margins = now
            self._accelerations = data.GetODE2Coordinates_tt()
            self._sensors.switch(self._sensors.is_due(t) or t >= self._end - ON_GRID * self._step)
            return True

        self._part(end, steps, look, write=True, keep=True)
        self._settings.solution.file.writeInitialValues = passed is not None  # also read by sensors
        return passed

    def _take_back(self) -> None:
        data = self._mbs.systemData
        state = data.GetSystemState(exu.ConfigurationType.StartOfStep)
        data.SetSystemState(state, exu.ConfigurationType.Current)
        data.SetODE2Coordinates_tt(self._accelerations)
        data.SetTime(self._reached)
        self._sensors.switch(False)

    def _land(self, high: float, margins: Sequence[FloatArray]) -> None:
        """Step to the first change before ``high`` (s), and leave the modes that end there.

        Inverse interpolation through the latest points finds it, or the Illinois method within the interval (Dowell &
        Jarratt, BIT 11 (1971) 168).
        """
        low, (above, below) = self._reached, margins
        points: list[_Point] = [(low, above), (high, below)]
        least = max(LOCATED * self._step, 4.0 * np.spacing(abs(high)))
        side, large = 0, np.abs(below) + np.abs(above)
        # A slip that has just begun is zero at the start of the step, and may turn back within the step.
        start, turns_back = low, self._ended_at_once == low
        for tried in range(MOST_CHANGES):
            ended = below < 0.0
            within = [(low, np.maximum(above, 0.0)), (high, below)]
            trials = [_roots(pair, ended) for pair in (points[-3:], points[-2:], within)]
            roots = next((root for root in trials if low < root.min() < high), np.where(ended, low, np.inf))
            found = float(roots.min())
            bisects = tried % 4 == 3 or (turns_back and low == start)
            t = (low + high) / 2.0 if bisects else found
            at_once = tried == 0 and t - low <= least
            t = min(max(t, low) + least / 2.0, high - least / 2.0)
            is_close = max(abs(t - found), abs(t - trials[1].min())) <= SOON * self._step
            is_small = (np.abs(points[-1][1]) <= SMALL * large)[roots.argmin()]
            if (tried and is_close and is_small) or at_once or high - low <= least:
                break
            self._step_to(t, keep=False)
            now = self._modes.margins(t)
            points.append((t, now))
            if (now < 0.0).any():
                high, below, above, side = t, now, above if side <= 0 else above / 2.0, 1
            else:
                low, above, below, side = t, now, below if side >= 0 else below / 2.0, -1
        self._ended_at_once = low if at_once else -math.inf
        if not at_once:
            t = high if high - low <= least else t
            self._step_to(t)
        now = self._modes.margins(self._reached)
        ends = (now < 0.0) | (roots - t <= least)
        self._modes.end([self._contacts[i] for i in np.flatnonzero(ends)])

    def _stop(self) -> None:
        """Step under constant friction until contacts in the plane rest.

        A slip that a prescribed motion reverses passes through zero, until it has a direction again.
        """
        motions = [(contact, contact.motion(self._mbs)) for contact in self._planar if contact.free_to_slide]
        stopping = [(contact, motion) for contact, motion in motions if self._slides.stops(contact, motion)]
        time = min(motion.remaining for _, motion in stopping)
        self._modes.survey(self._reached)
        passing = [motion for contact, motion in stopping if contact.passes(motion)]
        shortest = PlanarContact.resolution * self._step
        time += max(
            (max(shortest, 2.0 * RESOLVED * one.largest_term / one.rate_potential) for one in passing),
            default=0.0,
        )
        if self._reached + time > self._reached:
            for contact, _ in stopping:
                contact.planar.frozen = True
            try:
                self._step_to(self._reached + time)
            finally:
                for contact, _ in stopping:
                    contact.planar.frozen = False
        self._modes.end(contact for contact, _ in stopping)

    def _step_to(self, t: float, *, keep: bool = True) -> None:
        start = self._reached
        self._part(t, 1, lambda time: keep or time == start, write=False, keep=keep)

    def _note(self, before: Sequence[Mode]) -> None:
        """Record the changes of mode; raise ``SimulationError`` if they do not end."""
        for contact, mode in zip(self._contacts, before, strict=bool(before)):
            after = contact.stick.visible_mode
            if after != mode:
                self.changes.append(ModeChange(self._reached, contact.item, mode, after, contact.stick.point))
        self._settled = [*self._settled[1 - MOST_CHANGES :], self._reached]
        if len(self._settled) == MOST_CHANGES and self._reached - self._settled[0] < ON_GRID * self._step:
            raise SimulationError(
                f"friction contacts changed their modes {MOST_CHANGES} times at t = {self._reached:.9g} s; "
                "contacts between the same bodies may hold each other"
            )


def _roots(points: Sequence[_Point], ended: NDArray[Any]) -> NDArray[Any]:
    """Return the times (s) where margins vanish, by inverse interpolation; infinite unless the mode has ``ended``."""
    with np.errstate(divide="ignore", invalid="ignore"):
        times = sum(
            t * np.prod([other / (other - margins) for _, other in points if other is not margins], axis=0)
            for t, margins in points
        )
    return np.where(ended, times, np.inf)


class _SensorRows:
    """Switches sensors on only for steps that need a row, because each part of a run would restart the period."""

    def __init__(self, settings: Any, start: float, step: float) -> None:
        self._settings, self._next, self._step = settings, start, step
        self._wanted = self._on = settings.active
        self._period, settings.writePeriod = settings.writePeriod, 0.0

    def switch(self, on: bool) -> None:
        """Switch rows on or off from the next step on, if the user wants any."""
        on = self._wanted and on
        if on != self._on:
            self._settings.active = self._on = on

    def is_due(self, t: float) -> bool:
        """Return whether a row is due at the time t (s); if so, advance to the next row."""
        if t < self._next - ON_GRID * self._step:
            return False
        period = max(self._period, self._step)
        self._next += period * (1 + math.floor((t - self._next) / period + ON_GRID))
        return True
