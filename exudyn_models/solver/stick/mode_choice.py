"""Modes that let all contacts of a model obey Coulomb's law at one time of a run.

Contacts on axes solve one problem together (``complementarity``). A contact in the plane begins to slide normal to
the limit surface, with the slip that its load reaches within a millionth of a step or Newton's method can resolve.
``take_back`` removes this slip when the contact slides faster.
"""

from collections.abc import Sequence
from typing import Any

import exudyn as exu
import numpy as np

from exudyn_models.forces.axial_pairs import Mode
from exudyn_models.solver.stick.dynamics import Dynamics
from exudyn_models.solver.stick.locked_contacts import LockedContacts, undecided
from exudyn_models.solver.stick.resting_axes import RestingAxes
from exudyn_models.solver.stick.sliding_steps import SlidingSteps
from exudyn_models.solver.stick.slip_motion import RESOLVED, SlipMotion
from exudyn_models.solver.stick.sticking_contacts import STILL, PlanarContact, StickingContact
from reference_model.trajectory import SimulationError

ROUNDING = 1e-12
"""Relative rounding error of the load of a locked contact."""

GROWN = 10.0
"""Least slip for ``take_back``, relative to the first slip."""

MOST_CHANGES = 100
"""Largest number of changes of mode at one time."""


class ModeChoice:
    """Choice of the modes of contacts in an assembled model at its initial values, before steps of ``step`` (s)."""

    def __init__(
        self,
        mbs: Any,
        t: float,
        contacts: Sequence[StickingContact],
        slides: SlidingSteps,
        step: float,
    ) -> None:
        self._mbs, self._contacts, self._slides = mbs, contacts, slides
        self._step, self._dynamics = step, Dynamics(mbs, t, step)
        self._planar = [contact for contact in contacts if isinstance(contact, PlanarContact)]
        on_axes = [contact for contact in contacts if not isinstance(contact, PlanarContact)]
        self._axes = RestingAxes(mbs, self._dynamics, on_axes, contacts, step)
        self._dynamics.evaluate(t)
        self._locked = LockedContacts(mbs, self._dynamics, contacts)
        self._first_slips: dict[PlanarContact, float] = {}

    def survey(self, t: float) -> None:
        """Find the directions of slip that joints and locks hold."""
        if self._planar:  # slip on one axis has a constant direction
            self._dynamics.evaluate(t)
            self._locked = LockedContacts(self._mbs, self._dynamics, self._contacts)

    def passes(self, contact: PlanarContact, motion: SlipMotion) -> bool:
        """Return whether a slip may only pass through zero, after ``survey``."""
        return self._locked.passes(contact, motion)

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
        planar = [contact.margin(self._mbs, t) for contact in self._planar]
        if planar and min(planar) < 0.0 and self._locked.balance(t):
            planar = [contact.margin(self._mbs, t) for contact in self._planar]
        own = self._axes.margins(t)
        own.update(zip(self._planar, planar, strict=True))
        return [own[contact] for contact in self._contacts]

    def end(self, t: float, ended: Sequence[StickingContact]) -> None:
        """Leave the modes that end at the time t (s)."""
        following: dict[PlanarContact, Mode] = {
            contact: contact.following(self._mbs, t) for contact in self._planar if contact in ended
        }
        self._axes.end(ended)
        self.survey(t)
        released = False  # ``settle`` decides about others that share its load
        for contact, mode in following.items():
            if mode == Mode.OPEN or not released:
                self._leave(t, contact, mode)
            released |= mode != Mode.OPEN

    def _leave(self, t: float, contact: PlanarContact, mode: Mode) -> None:
        """Let a contact enter its next mode; if several share a load, the most loaded one."""
        if contact.planar.rests and mode != Mode.OPEN:
            locked = [one for one in self._planar if one.mode == Mode.LOCKED]
            contact = self._most_loaded(t, locked or [contact])
            mode = contact.driven(self._mbs)
        self.enter(t, contact, mode)

    def settle(self, t: float) -> None:
        """Choose modes that let all contacts obey Coulomb's law, and store accelerations and constraint forces."""
        self._locked.share_directions()
        for contact in self._planar:
            contact.stick.idle = False
            if contact.mode == Mode.LOCKED and self._locked.is_held(contact):
                contact.enter(self._mbs, Mode.FORWARD)
        for _ in range(MOST_CHANGES):
            self._locked.share_directions()
            held = [contact.stick.slides and self._locked.is_held(contact) for contact in self._planar]
            if any(held):
                self._axes.accelerate(t)
            for contact, is_held in zip(self._planar, held, strict=True):
                contact.hold(self._mbs, is_held)
                contact.planar.taken_over = np.zeros(3)  # other contacts may rest now
            shared = self._held_from_the_plane()
            self._axes.settle(t)
            if any(contact.stick.slides for contact in shared):
                raise undecided(t)
            chosen = self._contradiction(t)
            if chosen is None:
                self._slides.survey()
                self._axes.end(())
                return
            self._leave(t, *chosen)
        raise SimulationError(
            f"found no modes of the friction contacts that satisfy Coulomb's law at t = {t:.9g} s"
        )

    def _held_from_the_plane(self) -> list[StickingContact]:
        """Return the contacts at rest on axes that contacts in the plane hold as well."""
        return [
            contact
            for contact in self._contacts
            if contact.mode == Mode.LOCKED
            and not isinstance(contact, PlanarContact)
            and self._locked.is_held_from_the_plane(contact)
        ]

    def enter(self, t: float, contact: PlanarContact, mode: Mode) -> None:
        """Switch the mode of a contact in the plane at the time t (s), and set its slip."""
        released = contact.mode == Mode.LOCKED and mode != Mode.OPEN
        if not (released or mode == Mode.LOCKED):
            contact.enter(self._mbs, mode)
            return
        slip = np.zeros(3)
        if released:
            contact.enter(self._mbs, Mode.OPEN)
            self._locked.share_directions()
            self._axes.accelerate(t)
            free = contact.motion(self._mbs)
            shortest = contact.rest_share * self._step
            speed = 2.0 * max(shortest * free.rate_potential, RESOLVED * free.largest_term)
            slip = speed * contact.planar.direction
            self._slides.begin(max(shortest, speed / free.rate_potential))
            self._first_slips[contact] = speed
        contact.enter(self._mbs, Mode.OPEN)
        self._locked.set_slip(contact, slip)
        contact.enter(self._mbs, mode)

    def _contradiction(self, t: float) -> tuple[PlanarContact, Mode] | None:
        """Return a contact in the plane that violates Coulomb's law, and its next mode.

        Opening and closing come first, then the most overloaded locked contact, then contacts that reverse.
        """
        mbs = self._mbs
        for contact in self._planar:
            if contact.opens_or_closes(contact.holding(t)):
                return contact, contact.following(mbs, t)
            if contact.carried(mbs)[1] > STILL:
                return contact, contact.driven(mbs)
        if not self._planar:
            return None
        most = self._most_loaded(t, self._planar)
        if most.overload(mbs, t) > 1.0 + ROUNDING and self._locked.balance(t):
            most = self._most_loaded(t, self._planar)
        if most.overload(mbs, t) > 1.0 + ROUNDING:
            return most, most.driven(mbs)
        for contact in self._planar:
            if contact.reverses(mbs, contact.rest_share * self._step) and not self._locked.is_held(contact):
                return contact, Mode.LOCKED
        return None

    def _most_loaded(self, t: float, contacts: Sequence[PlanarContact]) -> PlanarContact:
        return max(contacts, key=lambda contact: contact.overload(self._mbs, t))
