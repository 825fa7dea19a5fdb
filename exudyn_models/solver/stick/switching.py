"""Runs of models whose contacts stick exactly: from one change of mode to the next.

Between two changes the equations of motion are smooth. The driver takes back a step that passes a change and repeats
it with a length that ends at the change. There it chooses modes that let all contacts obey Coulomb's law at once: a
locked contact transmits no more than it can hold, and a sliding one does not reverse. ``sliding_steps`` chooses the
steps of contacts that slide in the plane. Such a contact begins to slide normal to the limit surface, with the slip
that its load reaches within a millionth of a step.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from typing import Any

import exudyn as exu
import numpy as np

from exudyn_models.forces.axial_pairs import Mode
from exudyn_models.solver.repeated_steps import user_function
from exudyn_models.solver.starting_rates import starting_rates
from exudyn_models.solver.stick.locked_contacts import LockedContacts
from exudyn_models.solver.stick.sensor_rows import ON_GRID, SensorRows
from exudyn_models.solver.stick.sliding_steps import SlidingSteps
from exudyn_models.solver.stick.slip_motion import RESOLVED, SlipMotion
from exudyn_models.solver.stick.sticking_contacts import ModeChange, PlanarContact, StickingContact
from reference_model.systems import FloatArray
from reference_model.trajectory import SimulationError

LOCATED = 1e-12
"""Share of a step within which the time of a change is found."""

ROUNDING = 1e-12
"""Relative rounding error of the load of a locked contact."""

FORCES = 1e-12
"""Relative residual of Newton's method for contacts in the plane.

Errors of velocities enter constraint forces divided by the step, and these decide when a contact is released.
"""

MOST_CHANGES = 100
"""Largest number of changes at one time."""


def run_switching(
    mbs: Any,
    settings: Any,
    solver: Any,
    contacts: list[StickingContact],
    update_initial_values: bool,
    before: Sequence[Mode] = (),
) -> list[ModeChange]:
    """Run an implicit ``solver`` over an assembled model; return the changes of modes of its ``contacts``.

    They have their first modes. ``before`` are the modes at the end of the preceding run, and are empty if there is
    none. Raises ``SimulationError`` if the modes change without end at one time.
    """
    data, initial = mbs.systemData, exu.ConfigurationType.Initial
    state = data.GetSystemState(initial)
    run = _Run(mbs, settings, solver, contacts)
    try:
        run.run(before)
    finally:
        if not update_initial_values:
            data.SetSystemState(state, initial)
    return run.changes


class _Run:
    """Run of ``run_switching``."""

    def __init__(self, mbs: Any, settings: Any, solver: Any, contacts: list[StickingContact]) -> None:
        self._mbs, self._settings, self._solver, self._contacts = mbs, settings, solver, contacts
        self._options = options = settings.timeIntegration
        self._start, self._end, self._steps = options.startTime, options.endTime, options.numberOfSteps
        self._step = (self._end - self._start) / self._steps
        self._sensors = SensorRows(settings.solution.sensors, self._start, self._step)
        self._writes_file = settings.solution.file.write
        self._reached, self._stopped, self._begun = self._start, False, False
        self._planar = [contact for contact in contacts if isinstance(contact, PlanarContact)]
        self._locked = LockedContacts(mbs, self._start, contacts)
        self._accelerations = np.empty(0)  # at the start of the present step
        self._starting = np.empty(0), np.empty(0)  # accelerations and constraint forces of the next part
        self._slides = SlidingSteps(mbs, self._planar, self._step)
        self._look: Callable[[float], bool] = lambda t: True
        #: All changes of modes so far.
        self.changes: list[ModeChange] = []

    def run(self, before: Sequence[Mode]) -> None:
        """Run from the start to the end of the settings; leave the end as the initial values.

        ``before`` are the modes at the end of the preceding run. They are empty if there is none.
        """
        mbs = self._mbs
        with (
            self._kept_settings(),
            user_function(mbs, "PreStep", self._before_step),
            user_function(mbs, "PostStep", self._after_step),
        ):
            for contact in self._planar:
                if contact.mode == Mode.LOCKED:
                    self._locked.set_slip(contact, np.zeros(3))
            self._settle()
            self._note(before)
            while self._reached < self._end - ON_GRID * self._step and not self._stopped:
                passed = self._go_on()
                if passed is not None or self._slides.rests:
                    modes = [contact.stick.visible_mode for contact in self._contacts]
                    if passed is not None:
                        self._land(*passed)
                    else:
                        self._stop()
                    self._settle()
                    self._note(modes)

    @contextmanager
    def _kept_settings(self) -> Iterator[None]:
        options, file, sensors = self._options, self._settings.solution.file, self._settings.solution.sensors
        alpha, newton = options.generalizedAlpha, options.newton
        kept = file.append, sensors.append, file.writeInitialValues
        computes = alpha.computeInitialAccelerations
        modified, tolerance = newton.useModifiedNewton, newton.relativeTolerance
        if self._planar:
            newton.useModifiedNewton = False  # the direction of friction turns too fast for an old Jacobian
            self._tolerances = tolerance, min(tolerance, FORCES)
        try:
            yield
        finally:
            options.startTime, options.endTime, options.numberOfSteps = self._start, self._end, self._steps
            file.append, sensors.append, file.writeInitialValues = kept
            alpha.computeInitialAccelerations = computes
            newton.useModifiedNewton, newton.relativeTolerance = modified, tolerance
            file.write = self._writes_file
            self._sensors.restore()

    def _before_step(self, own: Callable[[Any, float], bool]) -> Callable[[Any, float], bool]:
        def prepare(mbs: Any, t: float) -> bool:
            for contact in self._planar:
                contact.start_step(mbs)
            return own(mbs, t)

        return prepare if self._planar else own

    def _after_step(self, own: Callable[[Any, float], bool]) -> Callable[[Any, float], bool]:
        def look(mbs: Any, t: float) -> bool:
            if not self._look(t):
                return False
            if t <= self._reached and self._begun:  # Exudyn calls it at the start of each part as well
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
        settles: bool = False,
    ) -> None:
        """Run from the last time reached to ``end`` (s); ``write`` sensors and files, ``keep`` the end.

        If contacts are in the plane, Exudyn computes the initial accelerations only for a part that ``settles``.
        """
        options, solution = self._options, self._settings.solution
        options.startTime, options.endTime, options.numberOfSteps = self._reached, end, steps
        self._sensors.switch(write)
        solution.file.write = write and self._writes_file
        if self._planar:
            options.generalizedAlpha.computeInitialAccelerations = settles
            small = (
                any(contact.free_to_slide for contact in self._planar) and self._slides.longest < self._step
            )
            options.newton.relativeTolerance = self._tolerances[not small]
        self._look = look
        with starting_rates(self._mbs, self._reached):
            self._mbs.SolveDynamic(self._settings, self._solver, keep)
        if write:
            solution.file.append = solution.sensors.append = True

    def _go_on(self) -> tuple[float, Sequence[FloatArray]] | None:
        """Run to the end, or to the next multiple of the step if the last part has ended between two.

        Contacts in the plane may need shorter steps. Return None, or the end of a step that has passed a change and
        was taken back, with the margins at both of its ends.
        """
        data, start = self._mbs.systemData, self._reached
        whole = (start - self._start) / self._step
        on_grid = abs(whole - round(whole)) < ON_GRID
        done = round(whole) if on_grid else math.floor(whole)
        end = self._end if on_grid or done + 1 == self._steps else self._start + (done + 1) * self._step
        steps = self._steps - done if on_grid else 1
        if (longest := self._slides.longest) < self._step:
            end, steps = min(end, start + longest), 1
        self._sensors.is_due(start)  # the part begins with a row
        margins, passed = self._margins_at(start), None
        self._slides.pauses = self._slides.rests = False

        def look(t: float) -> bool:
            nonlocal margins, passed
            if t == start:
                self._accelerations = data.GetODE2Coordinates_tt()
                return True
            now = self._margins_at(t)
            if (now < 0.0).any():
                passed = t, (margins, now)
            if passed is not None or not self._slides.resolves(t - self._reached):
                self._take_back()
                return False
            margins = now
            if self._planar:
                self._accelerations = data.GetODE2Coordinates_tt()
            self._sensors.switch(self._sensors.is_due(t) or t >= self._end - ON_GRID * self._step)
            return True

        self._part(end, steps, look, write=True, keep=True)
        self._settings.solution.file.writeInitialValues = passed is not None  # sensors follow it too
        return passed

    def _take_back(self) -> None:
        """Return to the start of the step."""
        data = self._mbs.systemData
        state = data.GetSystemState(exu.ConfigurationType.StartOfStep)
        data.SetSystemState(state, exu.ConfigurationType.Current)
        if self._planar:  # Exudyn would compute the accelerations again
            data.SetODE2Coordinates_tt(self._accelerations)
        data.SetTime(self._reached)
        self._sensors.switch(False)

    def _margins_at(self, t: float) -> FloatArray:
        return np.array([contact.margin(self._mbs, t) for contact in self._contacts])

    def _try(self, t: float) -> FloatArray:
        """Return the margins after one step to the time t (s) that is not kept."""
        found = np.empty(0)

        def look(time: float) -> bool:
            nonlocal found
            if time > self._reached:
                found = self._margins_at(time)
                return False
            return True

        self._part(t, 1, look, write=False, keep=False)
        return found

    def _land(self, high: float, margins: Sequence[FloatArray]) -> None:
        """Step to the first change before ``high`` (s), and leave the modes that end there.

        The Illinois method finds it: a secant that halves the margin at an end which stays (Dowell & Jarratt, BIT 11
        (1971) 168).
        """
        low, (above, below) = self._reached, margins
        tolerance = max(LOCATED * self._step, 4.0 * np.spacing(abs(high)))
        side = tried = 0
        while high - low > tolerance:
            ended, tried = below < 0.0, tried + 1
            rest = np.maximum(above[ended], 0.0)
            share = 0.5 if tried % 4 == 0 else np.min(rest / (rest - below[ended]))
            t = min(max(low + share * (high - low), low + tolerance / 2.0), high - tolerance / 2.0)
            now = self._try(t)
            if (now < 0.0).any():
                high, below, above, side = t, now, above if side <= 0 else above / 2.0, 1
            else:
                low, above, below, side = t, now, below if side >= 0 else below / 2.0, -1

        self._step_to(high)
        leaving = [contact for contact, margin in zip(self._contacts, below, strict=True) if margin < 0.0]
        following = [contact.following(self._mbs, high) for contact in leaving]  # loads of this step
        self._survey_locks()
        for contact, mode in zip(leaving, following, strict=True):
            was_locked = contact.mode == Mode.LOCKED and mode != Mode.OPEN
            if not (was_locked and self._locked.support(contact)):
                self._enter(contact, mode)

    def _stop(self) -> None:
        """Step under constant friction until contacts in the plane rest, and lock them."""
        motions = [(contact, contact.motion(self._mbs)) for contact in self._planar if contact.free_to_slide]
        resting = [
            (contact, motion.remaining)
            for contact, motion in motions
            if motion.rests_within(contact.rest_share * self._step)
        ]
        time = min(remaining for _, remaining in resting)
        if self._reached + time > self._reached:
            for contact, _ in resting:
                contact.planar.frozen = True
            try:
                self._step_to(self._reached + time)
            finally:
                for contact, _ in resting:
                    contact.planar.frozen = False
        self._survey_locks()
        for contact, _ in resting:
            self._enter(contact, Mode.LOCKED)

    def _step_to(self, t: float) -> None:
        """Step to the time t (s) of a change."""
        self._part(t, 1, lambda time: True, write=False, keep=True)

    def _survey_locks(self) -> None:
        """Find the directions of slip that joints and locks hold; this changes the current constraint forces."""
        if self._planar:  # on one axis the directions of slip stay
            self._locked = LockedContacts(self._mbs, self._reached, self._contacts)

    def _settle(self) -> None:
        """Choose modes that let all contacts obey Coulomb's law from the present time on."""
        for contact in self._contacts:
            contact.stick.idle = False
            if contact.mode == Mode.LOCKED and self._locked.is_held(contact):
                contact.enter(self._mbs, Mode.FORWARD)
        for _ in range(MOST_CHANGES):
            self._locked.share_directions()
            for planar in self._planar:
                planar.stick.idle = planar.stick.slides and self._locked.is_held(planar)
            chosen = self._contradiction()
            if chosen is None:
                for contact in self._contacts:
                    contact.stick.idle = contact.stick.slides and self._locked.is_held(contact)
                if self._planar:
                    accelerations, forces = self._starting
                    data, initial = self._mbs.systemData, exu.ConfigurationType.Initial
                    data.SetODE2Coordinates_tt(accelerations, initial)
                    data.SetAECoordinates(forces, initial)
                return
            contact, mode = chosen
            if mode == Mode.LOCKED or not self._locked.support(contact):
                self._enter(contact, mode)
        raise SimulationError(
            f"found no modes of the friction contacts that satisfy Coulomb's law at t = {self._reached:.9g} s"
        )

    def _enter(self, contact: StickingContact, mode: Mode) -> None:
        """Switch the mode of a contact, and set its first slip if it is in the plane."""
        if not isinstance(contact, PlanarContact):
            contact.enter(self._mbs, mode)
            return
        slip = np.zeros(3)
        if mode != Mode.LOCKED:
            contact.enter(self._mbs, Mode.OPEN)
            free = self._free_motion(contact)
            shortest = contact.rest_share * self._step
            speed = 2.0 * max(shortest * free.rate_potential, RESOLVED * free.largest_term)
            slip = speed * contact.planar.direction
            self._slides.begin(max(shortest, speed / free.rate_potential))
        contact.enter(self._mbs, Mode.OPEN)
        self._locked.set_slip(contact, slip)
        contact.enter(self._mbs, mode)

    def _free_motion(self, contact: PlanarContact) -> SlipMotion:
        """Return the motion of a contact at its start in the present modes."""
        found: SlipMotion | None = None

        def look(t: float) -> bool:
            nonlocal found
            self._locked.correct()
            found = contact.motion(self._mbs)
            return False

        self._part(self._reached + self._step, 1, look, write=False, keep=False, settles=True)
        assert found is not None
        return found

    def _contradiction(self) -> tuple[StickingContact, Mode] | None:
        """Return a contact that violates Coulomb's law in its present mode, and the mode that it enters.

        The most overloaded locked contact comes first, then sliding contacts that reverse.
        """
        found: tuple[StickingContact, Mode] | None = None

        def look(t: float) -> bool:
            nonlocal found
            mbs, found = self._mbs, None
            self._locked.correct()
            most = max(self._contacts, key=lambda contact: contact.overload(mbs, t))
            if most.overload(mbs, t) > 1.0 + ROUNDING:
                found = most, most.driven(mbs)
            for contact in self._contacts:
                reversing = found is None and contact.reverses(mbs, contact.rest_share * self._step)
                if reversing and not self._locked.is_held(contact):
                    found = contact, Mode.LOCKED
            self._slides.survey()
            data = mbs.systemData
            self._starting = np.array(data.GetODE2Coordinates_tt()), np.array(data.GetAECoordinates())
            return False

        self._part(self._reached + self._step, 1, look, write=False, keep=False, settles=True)
        return found

    def _note(self, before: Sequence[Mode]) -> None:
        """Add the changes at the time reached; raise ``SimulationError`` if they do not end."""
        for contact, mode in zip(self._contacts, before, strict=bool(before)):
            after = contact.stick.visible_mode
            if after != mode:
                self.changes.append(ModeChange(self._reached, contact.item, mode, after))
        latest = self.changes[-MOST_CHANGES:]
        if len(latest) == MOST_CHANGES and self._reached - latest[0].time < ON_GRID * self._step:
            raise SimulationError(
                f"friction contacts changed their modes {MOST_CHANGES} times at t = {self._reached:.9g} s; "
                "contacts between the same bodies may hold each other"
            )
