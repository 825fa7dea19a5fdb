"""Contacts that stick exactly in an assembled model: their modes, and when each mode ends."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import exudyn as exu
import numpy as np
from numpy.typing import NDArray

from exudyn_models.forces.axial_pairs import AxialStick, Mode

CURRENT = exu.ConfigurationType.Current


@dataclass(frozen=True)
class ModeChange:
    """Change of the mode of a contact.

    Parameters
    ----------
    time : float
        In s.
    contact : int
        Object number of the contact's connector.
    before, after : Mode
        Mode until and from that time.

    """

    time: float
    contact: int
    before: Mode
    after: Mode


@dataclass(frozen=True, eq=False)
class StickingContact:
    """Contact of an assembled model that sticks exactly.

    Parameters
    ----------
    item, lock : int
        Object numbers of the connector and of the constraint that locks it.
    stick : AxialStick
        Law of friction and present mode.
    places : array of int
        Positions of its coordinates among those of the model.

    """

    item: int
    lock: int
    stick: AxialStick
    places: NDArray[Any]

    @property
    def mode(self) -> Mode:
        """Present mode."""
        assert self.stick.mode is not None
        return self.stick.mode

    def enter(self, mbs: Any, mode: Mode) -> None:
        """Switch to a mode."""
        self.stick.mode = mode
        mbs.SetObjectParameter(self.lock, "activeConnector", mode == Mode.LOCKED)

    def enter_first(self, mbs: Any, t: float) -> None:
        """Switch to the mode that load and initial slip suggest."""
        slip = self.slip(mbs, configuration=exu.ConfigurationType.Initial)
        self.enter(mbs, Mode.OPEN if self.stick.holding_moment(t) == 0.0 else Mode(int(np.sign(slip))))

    def leave(self, mbs: Any, t: float) -> None:
        """Leave a mode that has ended for the one that follows if no other contact changes."""
        if self.stick.holding_moment(t) == 0.0:
            self.enter(mbs, Mode.OPEN)
        elif self.mode == Mode.OPEN:
            self.enter(mbs, Mode(int(np.sign(self.slip(mbs)))))
        elif self.mode == Mode.LOCKED:
            self.enter(mbs, self.driven(mbs))
        else:
            self.enter(mbs, Mode.LOCKED)

    def driven(self, mbs: Any) -> Mode:
        """Return the direction in which its load drives a locked contact."""
        return Mode.BACKWARD if self.stick.held_moment(mbs) > 0.0 else Mode.FORWARD

    def slip(self, mbs: Any, ahead: float = 0.0, configuration: Any = CURRENT) -> float:
        """Return S in rad/s, or what it will be a short time ``ahead`` (s)."""
        data = mbs.systemData
        q = data.GetODE2Coordinates(configuration)[self.places]
        q_t = data.GetODE2Coordinates_t(configuration)[self.places]
        if ahead > 0.0:
            q += ahead * q_t
            q_t += ahead * data.GetODE2Coordinates_tt(configuration)[self.places]
        return self.stick.slip(q, q_t)

    def margin(self, mbs: Any, t: float) -> float:
        """Return a number that falls below zero when the present mode ends.

        That is the slip in the direction of sliding (rad/s) or what a locked contact could hold in addition (N m),
        and ±1 where load or coefficient is zero.
        """
        holding = self.stick.holding_moment(t)
        if (holding == 0.0) != (self.mode == Mode.OPEN):
            return -1.0
        if self.mode == Mode.OPEN:
            return 1.0
        if self.stick.idle:
            return 1.0
        if self.mode == Mode.LOCKED:
            return holding - abs(self.stick.held_moment(mbs))
        return int(self.mode) * self.slip(mbs)

    def overload(self, mbs: Any, t: float) -> float:
        """Return the moment on a locked contact over the largest one it can hold, 0 for any other."""
        return 0.0 if self.mode != Mode.LOCKED else self.stick.capacity_share(mbs, t)

    def reverses(self, mbs: Any, time: float) -> bool:
        """Return whether a sliding contact stops within a ``time`` (s) so short that it rests."""
        if not self.stick.slides:
            return False
        return int(self.mode) * self.slip(mbs, time) < 0.0


def sticking_contacts(mbs: Any) -> list[StickingContact]:
    """Return all contacts of an assembled model that stick exactly."""
    found = []
    for item in range(mbs.systemData.NumberOfObjects()):
        force = mbs.GetObject(item).get("forceUserFunction")
        stick = getattr(force["function"], "__self__", None) if isinstance(force, dict) else None
        if isinstance(stick, AxialStick):
            places = np.array(mbs.systemData.GetObjectLTGODE2(item))
            found.append(StickingContact(item, stick.lock, stick, places))
    return found
