"""Steps that resolve how contacts slide in the plane.

The direction of friction turns ever faster as the slip vanishes. Steps shrink with the slip until the contact counts
as resting, and grow again after its release.
"""

import math
from collections.abc import Sequence
from typing import Any

from exudyn_models.solver.stick.slip_motion import SlipMotion
from exudyn_models.solver.stick.sticking_contacts import PlanarContact

ON_GRID = 1e-9
"""Tolerance of multiples of a step, as a share of it."""

APPROACH = 0.9
"""Largest share of the slip that its acceleration could remove in a step."""

TURN = 0.02
"""Largest change of the direction of friction in a step; a twelfth of its square is the relative error."""


AIMED = 0.9
"""Largest share of this change that is expected in the next step."""

GROWTH = 2.0
"""Largest ratio of a step and the one before it."""


class SlidingSteps:
    """Choice of the next step, at most ``step`` (s), while contacts slide in the plane.

    A contact ``rests`` at the end of the last step.
    """

    def __init__(self, mbs: Any, contacts: Sequence[PlanarContact], step: float) -> None:
        self._mbs, self._contacts, self._step = mbs, contacts, step
        self._by_motion = self._growing = math.inf
        self._rate = 0.0
        self._directions: dict[PlanarContact, tuple[float, float, float]] = {}
        self.rests = False

    @property
    def longest(self) -> float:
        """Longest next step in s."""
        return min(self._by_motion, self._growing)

    def begin(self, step: float) -> None:
        """Begin to slide with a first ``step`` (s)."""
        self._growing = step

    def stops(self, contact: PlanarContact, motion: SlipMotion) -> bool:
        """Return whether the shortest step might end without slip."""
        return motion.rests_within(contact.resolution * self._step / APPROACH)

    def resolves(self, step: float) -> bool:
        """Return whether a ``step`` (s) was short enough, and choose the next step."""
        if not self._contacts:
            return True
        before, by_motion, rate_before = self._directions, self._by_motion, self._rate
        self.survey()
        turns = [math.dist(now, before[key]) for key, now in self._directions.items() if key in before]
        turned = max(turns, default=0.0)
        rate = turned / step
        growth = min(max(rate / rate_before, 1.0), GROWTH) if rate_before > 0.0 else 1.0
        fits = AIMED * TURN / (rate * growth) if rate > 0.0 else math.inf
        if turned > TURN:
            self._directions, self._by_motion, self._rate, self.rests = before, by_motion, rate_before, False
            self._growing = max(fits, step / GROWTH)
            return False
        self._growing = GROWTH * max(step, self._growing) if self._growing < self._step else math.inf
        self._by_motion, self._rate = min(self._by_motion, fits), rate
        return True

    def survey(self) -> None:
        """Record the directions of friction, the longest next step, and whether a contact rests."""
        self._directions, self._by_motion, self._rate, self.rests = {}, math.inf, 0.0, False
        for contact in self._contacts:
            if contact.free_to_slide:
                motion = contact.slid(self._mbs)
                if motion.potential > 0.0:  # a prescribed motion begins without slip
                    self._directions[contact] = motion.direction
                shortest = contact.resolution * self._step
                self.rests |= self.stops(contact, motion)
                if motion.rate_potential > 0.0:
                    longest = APPROACH * motion.potential / motion.rate_potential
                    self._by_motion = min(self._by_motion, max(longest, shortest))
