"""Runs of models whose contacts stick exactly: from one change of mode to the next.

Between two changes the equations of motion are smooth. A step that passes a change is taken back and repeated with
the length at which the change happens. There the modes are chosen so that all contacts obey Coulomb's law at once: a
locked contact transmits no more than it can hold, and a sliding one does not reverse.

The friction of a contact in the plane turns with its slip, ever faster as the slip vanishes. The steps therefore
shrink in proportion to the slip, until the contact counts as resting. A contact that the load releases starts with a
slip normal to the limit surface, as large as its load reaches within a millionth of a step, and the steps grow again.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from typing import Any

import exudyn as exu
import numpy as np
import scipy.linalg

from exudyn_models.forces.axial_pairs import Mode, spanned
from exudyn_models.forces.planar_stick import RESOLVED, SlipMotion
from exudyn_models.solver.repeated_steps import user_function
from exudyn_models.solver.starting_rates import starting_rates
from exudyn_models.solver.sticking_contacts import (
    ModeChange,
    PlanarContact,
    StickingContact,
    joints_and_mass,
)
from reference_model.systems import FloatArray
from reference_model.trajectory import SimulationError

LOCATED = 1e-12
"""Share of a step within which the time of a change is found."""

APPROACH = 0.9
"""Largest share of a contact's slip in the plane that its acceleration could remove within one step."""

TURN = 0.05
"""Largest change of the direction of friction in the plane within one step that a small slip has shortened."""

FULL_TURN = 0.3
"""Largest change of this direction within a step of full length."""

ON_GRID = 1e-9
"""Share of a step by which the end of a step may miss a multiple of the step."""

ROUNDING = 1e-12
"""Share by which rounding may put the load of a locked contact above what it can hold."""

FORCES = 1e-12
"""Relative residual of Newton's method for contacts in the plane.

Errors of velocities enter constraint forces divided by the step, and these decide when a contact is released.
"""

MOST_CHANGES = 100
"""Largest number of changes at one time."""


def run_switching(
    mbs: Any, settings: Any, solver: Any, contacts: list[StickingContact], update_initial_values: bool
) -> list[ModeChange]:
    """Run an implicit ``solver`` over an assembled model; return the changes of modes of its ``contacts``.

    They have their first modes. Raises ``SimulationError`` if the modes change without end at one time.
    """
    data, initial = mbs.systemData, exu.ConfigurationType.Initial
    before = data.GetSystemState(initial)
    run = _Run(mbs, settings, solver, contacts)
    try:
        run.run()
    finally:
        if not update_initial_values:
            data.SetSystemState(before, initial)
    return run.changes


class _SensorRows:
    """Rows of sensors, switched on for the steps whose ends are due.

    Exudyn itself would count their period from the start of each part of a run.
    """

    def __init__(self, settings: Any, start: float, step: float) -> None:
        self._settings, self._next, self._step = settings, start, step
        self._wanted, self._period = settings.active, settings.writePeriod
        settings.writePeriod = 0.0

    def switch(self, on: bool) -> None:
        """Switch rows on or off from the next step on, if they are wanted at all."""
        self._settings.active = self._wanted and on

    def is_due(self, t: float) -> bool:
        """Return whether a row is due at the time t (s), and if so go on to the time of the next one."""
        if t < self._next - ON_GRID * self._step:
            return False
        period = max(self._period, self._step)
        self._next += period * (1 + math.floor((t - self._next) / period + ON_GRID))
        return True

    def restore(self) -> None:
        """Restore the settings."""
        self._settings.active, self._settings.writePeriod = self._wanted, self._period


class _Run:
    """Run of ``run_switching``."""

    def __init__(self, mbs: Any, settings: Any, solver: Any, contacts: list[StickingContact]) -> None:
        self._mbs, self._settings, self._solver, self._contacts = mbs, settings, solver, contacts
        self._options = options = settings.timeIntegration
        self._start, self._end, self._steps = options.startTime, options.endTime, options.numberOfSteps
        self._step = (self._end - self._start) / self._steps
        self._sensors = _SensorRows(settings.solution.sensors, self._start, self._step)
        self._writes_file = settings.solution.file.write
        self._reached, self._stopped, self._begun = self._start, False, False
        self._planar = [contact for contact in contacts if isinstance(contact, PlanarContact)]
        self._joints, self._mass = joints_and_mass(mbs, self._start, contacts)
        locks = [lock for contact in contacts for lock in contact.stick.locks]
        self._lock_places = [int(mbs.systemData.GetObjectLTGAE(lock)[0]) for lock in locks]
        self._starting: tuple[FloatArray, FloatArray] | None = None
        # Longest next step (s) for contacts that slide in the plane, by their slip and after a release.
        self._longest = self._growing = math.inf
        self._slopes: dict[int, FloatArray] = {}
        self._pauses = self._rests = False
        self._look: Callable[[float], bool] = lambda t: True
        #: All changes of modes so far.
        self.changes: list[ModeChange] = []

    def run(self) -> None:
        """Run from the start to the end of the settings; leave the end as the initial values."""
        mbs = self._mbs
        with (
            self._kept_settings(),
            user_function(mbs, "PreStep", self._before_step),
            user_function(mbs, "PostStep", self._after_step),
        ):
            self._settle()
            while self._reached < self._end - ON_GRID * self._step and not self._stopped:
                passed = self._go_on()
                if passed is not None or self._rests:
                    before = [contact.stick.visible_mode for contact in self._contacts]
                    if passed is not None:
                        self._land(*passed)
                    else:
                        self._stop()
                    self._settle()
                    self._note(before)

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
            return not self._stopped and not self._pauses

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

        With contacts in the plane, Exudyn computes the initial accelerations only if they ``settles``.
        """
        options, solution = self._options, self._settings.solution
        options.startTime, options.endTime, options.numberOfSteps = self._reached, end, steps
        self._sensors.switch(write)
        solution.file.write = write and self._writes_file
        if self._planar:
            options.generalizedAlpha.computeInitialAccelerations = settles
            small = any(contact.free_to_slide for contact in self._planar) and self._longest < self._step
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
        if (longest := min(self._longest, self._growing)) < self._step:
            end, steps = min(end, start + longest), 1
        self._sensors.is_due(start)  # the part begins with a row
        margins, passed = self._margins_at(start), None
        self._pauses = self._rests = False

        def look(t: float) -> bool:
            nonlocal margins, passed
            if t == start:
                self._accelerations = data.GetODE2Coordinates_tt()
                return True
            now = self._margins_at(t)
            if (now < 0.0).any():
                passed = t, (margins, now)
            if passed is not None or not self._resolves(t - self._reached):
                self._take_back()
                return False
            margins, self._accelerations = now, data.GetODE2Coordinates_tt()
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

    def _resolves(self, step: float) -> bool:
        """Return whether a ``step`` (s) resolves how contacts slide in the plane; choose the next one."""
        if not self._planar:
            return True
        shortened = step < (1.0 - ON_GRID) * self._step
        before, longest = self._slopes, self._longest
        self._survey()
        turned = max(
            (_change(before[key], now) for key, now in self._slopes.items() if key in before), default=0.0
        )
        if turned > (TURN if shortened else FULL_TURN):
            self._slopes, self._longest, self._rests = before, longest, False
            self._growing = step / 2.0
            return False
        self._growing = 2.0 * max(step, self._growing) if self._growing < self._step else math.inf
        self._pauses = self._rests or min(self._longest, self._growing) < self._step
        return True

    def _survey(self) -> None:
        """Find the directions of friction in the plane, the longest next step, and whether a contact rests."""
        self._slopes, self._longest, self._rests = {}, math.inf, False
        for contact in self._planar:
            if contact.free_to_slide:
                motion = contact.slid(self._mbs)
                self._slopes[contact.item] = contact.scaled(motion.gradient)
                self._rests |= motion.rests_within(contact.rest_share * self._step)
                if motion.rate_potential > 0.0:
                    longest = APPROACH * motion.potential / motion.rate_potential
                    self._longest = min(self._longest, max(longest, contact.rest_share * self._step))

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

        self._part(high, 1, lambda t: True, write=False, keep=True)
        for contact, margin in zip(self._contacts, below, strict=True):
            if margin < 0.0:
                self._leave(contact, high)

    def _stop(self) -> None:
        """Step to the time at which contacts in the plane rest, under constant friction, and lock them."""
        motions = [(contact, contact.motion(self._mbs)) for contact in self._planar if contact.free_to_slide]
        resting = [
            (contact, motion.remaining)
            for contact, motion in motions
            if motion.rests_within(contact.rest_share * self._step)
        ]
        time = min(remaining for _, remaining in resting)
        for contact, _ in resting:
            contact.planar.frozen = True
        if self._reached + time > self._reached:
            self._part(self._reached + time, 1, lambda t: True, write=False, keep=True)
        for contact, _ in resting:
            contact.planar.frozen = False
            self._enter(contact, Mode.LOCKED)

    def _leave(self, contact: StickingContact, t: float) -> None:
        """Switch a contact to the mode that follows if no other contact changes at the time t (s)."""
        was_locked, mode = contact.mode == Mode.LOCKED, contact.following(self._mbs, t)
        if not (was_locked and mode != Mode.OPEN and self._support(contact)):
            self._enter(contact, mode)

    def _settle(self) -> None:
        """Choose the modes with which all contacts obey Coulomb's law from the time reached on."""
        if self._planar:
            self._joints, self._mass = joints_and_mass(self._mbs, self._reached, self._contacts)
        for contact in self._contacts:
            contact.stick.idle = False
            if contact.mode == Mode.LOCKED and self._is_held(contact):
                contact.enter(self._mbs, Mode.FORWARD)
        for _ in range(MOST_CHANGES):
            self._share_directions()
            for planar in self._planar:
                planar.stick.idle = planar.stick.slides and self._is_held(planar)
            chosen = self._contradiction()
            if chosen is None:
                for contact in self._contacts:
                    contact.stick.idle = contact.stick.slides and self._is_held(contact)
                if self._planar and self._starting is not None:
                    accelerations, forces = self._starting
                    data, initial = self._mbs.systemData, exu.ConfigurationType.Initial
                    data.SetODE2Coordinates_tt(accelerations, initial)
                    data.SetAECoordinates(forces, initial)
                return
            contact, mode = chosen
            if mode == Mode.LOCKED or not self._support(contact):
                self._enter(contact, mode)
        raise SimulationError(
            f"found no modes of the friction contacts that satisfy Coulomb's law at t = {self._reached:.9g} s"
        )

    def _is_held(self, contact: StickingContact) -> bool:
        """Return whether the joints of the model and the other locks fix the slip of a contact."""
        others = [other for other in self._contacts if other.mode == Mode.LOCKED and other is not contact]
        return spanned(contact.rows(self._mbs), self._held_rows(others))

    def _held_rows(self, locked: Sequence[StickingContact]) -> FloatArray:
        return np.vstack([self._joints, *(contact.rows(self._mbs) for contact in locked)])

    def _share_directions(self) -> None:
        """Let each contact in the plane slip only in directions that joints and contacts locked before it allow."""
        locked: list[StickingContact] = []
        for contact in self._contacts:
            if isinstance(contact, PlanarContact):
                free = scipy.linalg.null_space(self._held_rows(locked))
                contact.allow(self._mbs, free)
                contact.enter(self._mbs, contact.mode)
            if contact.mode == Mode.LOCKED:
                locked.append(contact)

    def _enter(self, contact: StickingContact, mode: Mode) -> None:
        """Switch the mode of a contact; in the plane, set the slip at which it starts."""
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
            self._growing = max(shortest, speed / free.rate_potential)
        contact.enter(self._mbs, Mode.OPEN)
        self._set_slip(contact, slip)
        contact.enter(self._mbs, mode)

    def _free_motion(self, contact: PlanarContact) -> SlipMotion:
        """Return the motion of a contact at its start in the present modes."""
        found: SlipMotion | None = None

        def look(t: float) -> bool:
            nonlocal found
            self._correct()
            found = contact.motion(self._mbs)
            return False

        self._part(self._reached + self._step, 1, look, write=False, keep=False, settles=True)
        assert found is not None
        return found

    def _set_slip(self, contact: PlanarContact, slip: FloatArray) -> None:
        """Change the initial velocities so that a contact has the ``slip``."""
        data, initial = self._mbs.systemData, exu.ConfigurationType.Initial
        velocities = np.array(data.GetODE2Coordinates_t(initial))
        velocities += self._velocities_of(contact, slip - contact.slip_rows(self._mbs) @ velocities)
        data.SetODE2Coordinates_t(velocities, initial)

    def _velocities_of(self, contact: PlanarContact, slip: FloatArray) -> FloatArray:
        """Return velocities at which only this contact slips; heavy bodies move the least."""
        others = [other for other in self._contacts if other.mode == Mode.LOCKED and other is not contact]
        held, weights = self._held_rows(others), self._mobilities()
        rows = np.vstack([held, contact.slip_rows(self._mbs)]) * weights
        wanted = np.concatenate([np.zeros(len(held)), slip])
        return np.asarray(weights * np.linalg.lstsq(rows, wanted, rcond=None)[0])

    def _support(self, overloaded: StickingContact) -> bool:
        """Let idle contacts in the plane resist the motion that would follow; return whether that is new."""
        idle = [contact for contact in self._planar if contact.stick.idle]
        if not idle or not isinstance(overloaded, PlanarContact):
            return False
        velocities = self._velocities_of(overloaded, overloaded.planar.direction)
        slips = [contact.slip_rows(self._mbs) @ velocities for contact in idle]
        return sum(contact.resist(slip) for contact, slip in zip(idle, slips, strict=True)) > 0

    def _mobilities(self) -> FloatArray:
        """Return the inverse square roots of the diagonal of the mass matrix, or the largest one without mass."""
        masses = np.diag(self._mass)
        light = np.min(masses, where=masses > 0.0, initial=np.inf)
        return np.asarray(1.0 / np.sqrt(np.where(masses > 0.0, masses, light)))

    def _correct(self) -> None:
        """Correct the accelerations and constraint forces at the start of a run for locks in the plane.

        Exudyn computes them as if the gradients of user-defined constraints were constant.
        """
        locked = [contact for contact in self._contacts if contact.mode == Mode.LOCKED]
        bias = np.concatenate([contact.bias(self._mbs) for contact in locked] or [np.zeros(1)])
        if not bias.any():
            return
        data, scale = self._mbs.systemData, self._mobilities()
        rows = self._held_rows(locked) * scale
        size, count = len(scale), len(rows)
        system = np.zeros((size + count, size + count))
        system[:size, :size] = scale[:, None] * self._mass * scale
        system[:size, size:], system[size:, :size] = rows.T, rows
        missing = np.concatenate([np.zeros(size + len(self._joints)), -bias])
        change = np.linalg.lstsq(system, missing, rcond=None)[0]
        data.SetODE2Coordinates_tt(data.GetODE2Coordinates_tt() + scale * change[:size])
        forces = np.array(data.GetAECoordinates())
        joints = np.setdiff1d(np.arange(len(forces)), self._lock_places)
        forces[joints] += change[size : size + len(self._joints)]
        places = [data.GetObjectLTGAE(lock)[0] for contact in locked for lock in contact.active_locks()]
        forces[places] += change[size + len(self._joints) :]
        data.SetAECoordinates(forces)

    def _contradiction(self) -> tuple[StickingContact, Mode] | None:
        """Return a contact that violates Coulomb's law in its present mode, and the mode that it enters.

        The most overloaded locked contact comes first, then sliding contacts that reverse.
        """
        found: tuple[StickingContact, Mode] | None = None

        def look(t: float) -> bool:
            nonlocal found
            mbs, found = self._mbs, None
            self._correct()
            most = max(self._contacts, key=lambda contact: contact.overload(mbs, t))
            if most.overload(mbs, t) > 1.0 + ROUNDING:
                found = most, most.driven(mbs)
            for contact in self._contacts:
                reversing = found is None and contact.reverses(mbs, contact.rest_share * self._step)
                if reversing and not self._is_held(contact):
                    found = contact, Mode.LOCKED
            self._survey()
            data = mbs.systemData
            self._starting = np.array(data.GetODE2Coordinates_tt()), np.array(data.GetAECoordinates())
            return False

        self._part(self._reached + self._step, 1, look, write=False, keep=False, settles=True)
        return found

    def _note(self, before: Sequence[Mode]) -> None:
        """Add the changes at the time reached; raise ``SimulationError`` if they do not end."""
        for contact, mode in zip(self._contacts, before, strict=True):
            after = contact.stick.visible_mode
            if after != mode:
                self.changes.append(ModeChange(self._reached, contact.item, mode, after))
        latest = self.changes[-MOST_CHANGES:]
        if len(latest) == MOST_CHANGES and self._reached - latest[0].time < ON_GRID * self._step:
            raise SimulationError(
                f"friction contacts changed their modes {MOST_CHANGES} times at t = {self._reached:.9g} s; "
                "contacts between the same bodies may hold each other"
            )


def _change(before: FloatArray, after: FloatArray) -> float:
    return float(np.linalg.norm(after - before))
