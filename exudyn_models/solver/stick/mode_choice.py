"""Modes that let all contacts of a model obey Coulomb's law at one time of a run.

A contact in the plane begins to slide normal to the limit surface, with the slip that its load reaches within a
millionth of a step or Newton's method can resolve. ``take_back`` removes this slip when the contact slides faster.
"""

from collections.abc import Callable, Sequence
from typing import Any

import exudyn as exu
import numpy as np

from exudyn_models.forces.axial_pairs import Mode
from exudyn_models.solver.stick.locked_contacts import LockedContacts
from exudyn_models.solver.stick.sliding_steps import SlidingSteps
from exudyn_models.solver.stick.slip_motion import RESOLVED, SlipMotion
from exudyn_models.solver.stick.sticking_contacts import PlanarContact, StickingContact
from reference_model.trajectory import SimulationError

ROUNDING = 1e-12
"""Relative rounding error of the load of a locked contact."""

SETTLED = 1e-10
"""Largest relative change of a settled load."""

GROWN = 10.0
"""Least slip for ``take_back``, relative to the first slip."""

MOST_CHANGES = 100
"""Largest number of changes of mode at one time."""


class ModeChoice:
    """Choice of the modes of contacts in an assembled model at its initial values.

    ``at_start`` computes the initial accelerations, and calls a function with the time (s) before the first step of
    the length ``step`` (s).
    """

    def __init__(
        self,
        mbs: Any,
        t: float,
        contacts: Sequence[StickingContact],
        slides: SlidingSteps,
        step: float,
        at_start: Callable[[Callable[[float], None]], None],
    ) -> None:
        self._mbs, self._contacts, self._slides = mbs, contacts, slides
        self._step, self._at_start = step, at_start
        self._planar = [contact for contact in contacts if isinstance(contact, PlanarContact)]
        self._locked = LockedContacts(mbs, t, contacts)
        self._first_slips: dict[PlanarContact, float] = {}

    def survey(self, t: float) -> None:
        """Find the directions of slip that joints and locks hold."""
        if self._planar:  # slip on one axis has a constant direction
            forces = np.array(self._mbs.systemData.GetAECoordinates())
            self._locked = LockedContacts(self._mbs, t, self._contacts)
            self._mbs.systemData.SetAECoordinates(forces)

    def begin(self) -> None:
        """Remove the slip of contacts that start locked."""
        for contact in self._planar:
            if contact.mode == Mode.LOCKED:
                self._locked.set_slip(contact, np.zeros(3))

    def take_back(self, t: float) -> None:
        """Subtract the first slip of contacts that slide much faster at the time t (s).

        Friction keeps this excess of speed in the direction of the slip, so subtract it in this direction.
        """
        for contact, first in list(self._first_slips.items()):
            motion = contact.motion(self._mbs, exu.ConfigurationType.Initial)
            if contact.free_to_slide and motion.potential < GROWN * first:
                continue
            del self._first_slips[contact]
            if contact.free_to_slide:
                self.survey(t)
                self._locked.set_slip(contact, (1.0 - first / motion.potential) * motion.slip)
        self._slides.starts = bool(self._first_slips)

    def margins(self, t: float) -> list[float]:
        """Return the margins of all contacts, after redistributing loads that would end a rest."""
        margins = [contact.margin(self._mbs, t) for contact in self._contacts]
        if min(margins) < 0.0 and self._locked.balance(t):
            margins = [contact.margin(self._mbs, t) for contact in self._contacts]
        return margins

    def leave(self, t: float, contact: StickingContact, mode: Mode) -> None:
        """Let a contact enter its next mode; if several share a load, the most loaded one."""
        if isinstance(contact, PlanarContact) and contact.planar.rests and mode != Mode.OPEN:
            locked = [one for one in self._planar if one.mode == Mode.LOCKED]
            contact = self._most_loaded(t, locked or [contact])
            mode = contact.driven(self._mbs)
        self.enter(contact, mode)

    def settle(self, t: float) -> None:
        """Choose modes that let all contacts obey Coulomb's law."""
        self._locked.share_directions()
        for contact in self._contacts:
            contact.stick.idle = False
            if contact.mode == Mode.LOCKED and self._locked.is_held(contact):
                contact.enter(self._mbs, Mode.FORWARD)
        for _ in range(MOST_CHANGES):
            self._locked.share_directions()
            for planar in self._planar:
                planar.stick.idle = planar.stick.slides and self._locked.is_held(planar)
                planar.planar.taken_over = np.zeros(3)  # other contacts may rest now
            settled, chosen = self._examined()
            if chosen is not None:
                self.leave(t, *chosen)
            elif settled:
                for contact in self._contacts:
                    contact.stick.idle = contact.stick.slides and self._locked.is_held(contact)
                return
        raise SimulationError(
            f"found no modes of the friction contacts that satisfy Coulomb's law at t = {t:.9g} s"
        )

    def enter(self, contact: StickingContact, mode: Mode) -> None:
        """Switch the mode of a contact; in the plane, also set its slip."""
        released = contact.mode == Mode.LOCKED and mode != Mode.OPEN
        if not isinstance(contact, PlanarContact) or not (released or mode == Mode.LOCKED):
            contact.enter(self._mbs, mode)
            return
        slip = np.zeros(3)
        if released:
            contact.enter(self._mbs, Mode.OPEN)
            self._locked.share_directions()
            free = self._free_motion(contact)
            shortest = contact.rest_share * self._step
            speed = 2.0 * max(shortest * free.rate_potential, RESOLVED * free.largest_term)
            slip = speed * contact.planar.direction
            self._slides.begin(max(shortest, speed / free.rate_potential))
            self._first_slips[contact] = speed
        contact.enter(self._mbs, Mode.OPEN)
        self._locked.set_slip(contact, slip)
        contact.enter(self._mbs, mode)

    def _free_motion(self, contact: PlanarContact) -> SlipMotion:
        found: SlipMotion | None = None

        def look(t: float) -> None:
            nonlocal found
            self._locked.correct()
            found = contact.motion(self._mbs)

        self._at_start(look)
        assert found is not None
        return found

    def _examined(self) -> tuple[bool, tuple[StickingContact, Mode] | None]:
        """Return whether loads have settled, and the change of mode that the initial forces require."""
        settled, found = False, None

        def look(t: float) -> None:
            nonlocal settled, found
            self._locked.correct()
            settled = self._start_with_forces(t)
            if settled:
                found = self._contradiction(t)
                self._slides.survey()

        self._at_start(look)
        return settled, found

    def _contradiction(self, t: float) -> tuple[StickingContact, Mode] | None:
        """Return a contact that violates Coulomb's law, and its next mode.

        Opening and closing come first, then the most overloaded locked contact, then contacts that reverse.
        """
        mbs = self._mbs
        for contact in self._contacts:
            if contact.opens_or_closes(contact.holding(t)):
                return contact, contact.following(mbs, t)
        most = self._most_loaded(t, self._contacts)
        if most.overload(mbs, t) > 1.0 + ROUNDING and self._locked.balance(t):
            most = self._most_loaded(t, self._contacts)
        if most.overload(mbs, t) > 1.0 + ROUNDING:
            return most, most.driven(mbs)
        for contact in self._contacts:
            if contact.reverses(mbs, contact.rest_share * self._step) and not self._locked.is_held(contact):
                return contact, Mode.LOCKED
        return None

    def _most_loaded(self, t: float, contacts: Sequence[StickingContact]) -> StickingContact:
        return max(contacts, key=lambda contact: contact.overload(self._mbs, t))

    def _start_with_forces(self, t: float) -> bool:
        """Take accelerations and constraint forces as initial values; return whether dependent loads agree."""
        data, initial = self._mbs.systemData, exu.ConfigurationType.Initial
        forces = np.array(data.GetAECoordinates())
        loads = [contact.holding(t) for contact in self._contacts]
        data.SetAECoordinates(data.GetAECoordinates(initial))
        before = [contact.holding(t) for contact in self._contacts]
        data.SetAECoordinates(forces)
        data.SetAECoordinates(forces, initial)
        data.SetODE2Coordinates_tt(data.GetODE2Coordinates_tt(), initial)
        return np.allclose(loads, before, rtol=SETTLED, atol=0.0)
