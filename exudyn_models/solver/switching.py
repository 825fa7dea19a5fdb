"""Runs of models whose contacts stick exactly: from one change of mode to the next.

Between two changes the equations of motion are smooth. A step that passes a change is taken back and repeated with
the length at which the change happens. There the modes are chosen so that all contacts obey Coulomb's law at once: a
locked contact transmits no more than it can hold, and a sliding one does not reverse.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from typing import Any

import exudyn as exu
import numpy as np

from exudyn_models.forces.axial_pairs import Mode, spanned
from exudyn_models.solver.repeated_steps import user_function
from exudyn_models.solver.starting_rates import initialised_solver, starting_rates
from exudyn_models.solver.sticking_contacts import ModeChange, StickingContact
from reference_model.systems import FloatArray
from reference_model.trajectory import SimulationError

LOCATED = 1e-12
"""Share of a step within which the time of a change is found."""

AT_REST = 1e-9
"""Share of a step within which friction stops a contact that counts as resting."""

ON_GRID = 1e-9
"""Share of a step by which the end of a step may miss a multiple of the step."""

ROUNDING = 1e-12
"""Share by which rounding may put the load of a locked contact above what it can hold."""

MOST_CHANGES = 100
"""Largest number of changes at one time."""


@contextmanager
def first_modes(mbs: Any, contacts: Sequence[StickingContact], t: float) -> Iterator[None]:
    """Let contacts have modes, at first those of load and slip at the start t (s) of a run."""
    try:
        for contact in contacts:
            contact.stick.running = True
            contact.enter_first(mbs, t)
        yield
    finally:
        for contact in contacts:
            contact.stick.running = False


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


def _constraint_rows(mbs: Any, t: float, locks: Sequence[int]) -> tuple[dict[int, FloatArray], FloatArray]:
    """Return the gradient of each of the ``locks``, shape (n,), and those of all other constraints, shape (m, n).

    They are derivatives by the n velocities of an assembled model at its initial values and the time t (s), up to
    factors.
    """
    data = mbs.systemData
    active = [mbs.GetObjectParameter(lock, "activeConnector") for lock in locks]
    for lock in locks:
        mbs.SetObjectParameter(lock, "activeConnector", True)
    with initialised_solver(mbs, t) as solver:
        solver.SetSystemJacobian(np.zeros((data.SystemSize(), data.SystemSize())))
        solver.ComputeJacobianAE(mbs, 1.0, 1.0, 1.0)
        gradients = np.array(solver.GetSystemJacobian())[-data.AEsize() :, : data.ODE2Size()]
    for lock, was_active in zip(locks, active, strict=True):
        mbs.SetObjectParameter(lock, "activeConnector", was_active)
    places = {lock: int(data.GetObjectLTGAE(lock)[0]) for lock in locks}
    rows = {lock: gradients[place] for lock, place in places.items()}
    return rows, np.delete(gradients, list(places.values()), axis=0)


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
        self._rows, self._others = _constraint_rows(mbs, self._start, [contact.lock for contact in contacts])
        coordinates = mbs.systemData.GetODE2Coordinates(exu.ConfigurationType.Initial)
        for contact in contacts:
            if not contact.stick.held_by(self._others, contact.places, coordinates[contact.places]):
                raise ValueError(
                    f"object {contact.item}: this contact has no regularisation, but no joints hold its bodies on "
                    "one axis; give add_ring_friction a regularisation"
                )
        self._look: Callable[[float], bool] = lambda t: True
        #: All changes of modes so far.
        self.changes: list[ModeChange] = []

    def run(self) -> None:
        """Run from the start to the end of the settings; leave the end as the initial values."""
        with self._kept_settings(), user_function(self._mbs, "PostStep", self._after_step):
            self._settle()
            while self._reached < self._end - ON_GRID * self._step and not self._stopped:
                passed = self._go_on()
                if passed is not None:
                    before = [contact.stick.visible_mode for contact in self._contacts]
                    self._land(*passed)
                    self._settle()
                    self._note(before)

    @contextmanager
    def _kept_settings(self) -> Iterator[None]:
        options, file, sensors = self._options, self._settings.solution.file, self._settings.solution.sensors
        kept = file.append, sensors.append, file.writeInitialValues
        try:
            yield
        finally:
            options.startTime, options.endTime, options.numberOfSteps = self._start, self._end, self._steps
            file.append, sensors.append, file.writeInitialValues = kept
            file.write = self._writes_file
            self._sensors.restore()

    def _after_step(self, own: Callable[[Any, float], bool]) -> Callable[[Any, float], bool]:
        def look(mbs: Any, t: float) -> bool:
            if not self._look(t):
                return False
            if t <= self._reached and self._begun:  # Exudyn calls it at the start of each part as well
                return True
            self._reached, self._begun = t, True
            self._stopped = not own(mbs, t)
            return not self._stopped

        return look

    def _part(
        self, end: float, steps: int, look: Callable[[float], bool], *, write: bool, keep: bool
    ) -> None:
        """Run from the last time reached to ``end`` (s); ``write`` sensors and files, ``keep`` the end."""
        options, solution = self._options, self._settings.solution
        options.startTime, options.endTime, options.numberOfSteps = self._reached, end, steps
        self._sensors.switch(write)
        solution.file.write = write and self._writes_file
        self._look = look
        with starting_rates(self._mbs, self._reached):
            self._mbs.SolveDynamic(self._settings, self._solver, keep)
        if write:
            solution.file.append = solution.sensors.append = True

    def _go_on(self) -> tuple[float, Sequence[FloatArray]] | None:
        """Run to the end, or to the next multiple of the step if the last part has ended between two.

        Return None, or the end of a step that has passed a change and was taken back, with the margins at both of
        its ends.
        """
        data, start = self._mbs.systemData, self._reached
        whole = (start - self._start) / self._step
        on_grid = abs(whole - round(whole)) < ON_GRID
        done = round(whole) if on_grid else math.floor(whole)
        end = self._end if on_grid or done + 1 == self._steps else self._start + (done + 1) * self._step
        steps = self._steps - done if on_grid else 1
        self._sensors.is_due(start)  # the part begins with a row
        margins, passed = self._margins_at(start), None

        def look(t: float) -> bool:
            nonlocal margins, passed
            if t == start:
                return True
            now = self._margins_at(t)
            if (now < 0.0).any():
                passed = t, (margins, now)
                state = data.GetSystemState(exu.ConfigurationType.StartOfStep)
                data.SetSystemState(state, exu.ConfigurationType.Current)
                data.SetTime(self._reached)
                self._sensors.switch(False)
                return False
            margins = now
            self._sensors.switch(self._sensors.is_due(t) or t >= self._end - ON_GRID * self._step)
            return True

        self._part(end, steps, look, write=True, keep=True)
        self._settings.solution.file.writeInitialValues = passed is not None  # sensors follow it too
        return passed

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
                contact.leave(self._mbs, high)

    def _settle(self) -> None:
        """Choose the modes with which all contacts obey Coulomb's law from the time reached on."""
        for contact in self._contacts:
            contact.stick.idle = False
            if contact.mode == Mode.LOCKED and self._is_held(contact):
                contact.enter(self._mbs, Mode.FORWARD)
        for _ in range(MOST_CHANGES):
            chosen = self._contradiction()
            if chosen is None:
                for contact in self._contacts:
                    contact.stick.idle = contact.stick.slides and self._is_held(contact)
                return
            contact, mode = chosen
            contact.enter(self._mbs, mode)
        raise SimulationError(
            f"found no modes of the friction contacts that satisfy Coulomb's law at t = {self._reached:.9g} s"
        )

    def _is_held(self, contact: StickingContact) -> bool:
        """Return whether the other constraints of the model and the other locks fix the slip of a contact."""
        locked = [
            other.lock for other in self._contacts if other.mode == Mode.LOCKED and other is not contact
        ]
        given = np.vstack([self._others, *(self._rows[lock] for lock in locked)])
        return spanned(self._rows[contact.lock][None], given)

    def _contradiction(self) -> tuple[StickingContact, Mode] | None:
        """Return a contact that violates Coulomb's law in its present mode, and the mode that it enters.

        The most overloaded locked contact comes first, then sliding contacts that reverse.
        """
        found: tuple[StickingContact, Mode] | None = None

        def look(t: float) -> bool:
            nonlocal found
            mbs, found = self._mbs, None
            most = max(self._contacts, key=lambda contact: contact.overload(mbs, t))
            if most.overload(mbs, t) > 1.0 + ROUNDING:
                found = most, most.driven(mbs)
            for contact in self._contacts:
                reversing = found is None and contact.reverses(mbs, AT_REST * self._step)
                if reversing and not self._is_held(contact):
                    found = contact, Mode.LOCKED
            return False

        self._part(self._reached + self._step, 1, look, write=False, keep=False)
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
