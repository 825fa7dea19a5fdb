"""First slips of contacts in the plane that begin to slide.

A contact begins with a slip that its acceleration reaches within a millionth of a step, or that Newton's method can
resolve. It loses this slip when it slides faster.
"""

from collections.abc import Sequence
from typing import Any

import numpy as np

from exudyn_models.solver.stick.complementarity import independent_rows, linked
from exudyn_models.solver.stick.dynamics import Dynamics
from exudyn_models.solver.stick.sliding_steps import SlidingSteps
from exudyn_models.solver.stick.slip_motion import RESOLVED
from exudyn_models.solver.stick.slips import Slips
from exudyn_models.solver.stick.sticking_contacts import PlanarContact
from reference_model.systems import FloatArray

GROWN = 10.0
"""Least slip for ``take_back``, relative to the first slip."""


class FirstSlips:
    """First slips in a run with steps of ``step`` (s)."""

    def __init__(self, mbs: Any, dynamics: Dynamics, slides: SlidingSteps, step: float) -> None:
        self._mbs, self._dynamics, self._slides, self._step = mbs, dynamics, slides, step
        self._sizes: dict[PlanarContact, float] = {}

    def of(
        self, begun: Sequence[int], slips: Slips, found: FloatArray, bounds: FloatArray
    ) -> dict[int, float]:
        """Return the slips by row of the contacts that have ``begun`` to slide, in proportion if linked.

        ``found`` are the slip accelerations, shape (k,), and ``bounds`` their largest sizes, shape (contacts,).
        """
        if not begun:
            return {}
        sizes, blocks = slips.sets.sizes(found), slips.sets.blocks
        shortest = RESOLVED * self._step
        speeds = 2.0 * np.maximum(shortest * bounds, RESOLVED * slips.terms())
        links = [[slips.to_rates[blocks[i], blocks[j]].any() for j in begun] for i in begun]
        count, of_group = linked(np.array(links, float))
        wanted: dict[int, float] = {}
        for number in range(count):
            group = [begun[k] for k in np.flatnonzero(of_group == number).tolist()]
            time = max(speeds[i] / sizes[i] for i in group)
            for i in group:
                contact = slips.contacts[i]
                assert isinstance(contact, PlanarContact)
                self._sizes[contact] = float(time * sizes[i])
                self._slides.begin(max(shortest, float(speeds[i] / bounds[i])))
                wanted.update((row, float(time * found[row])) for row in slips.rows_of([i]))
        return wanted

    def take_back(self, t: float) -> None:
        """Subtract the first slips together, as they were given, when all contacts slide much faster.

        Friction keeps these excesses of speed in the directions of the slips, so subtract them in these directions.
        """
        if not self._sizes:
            return
        self._sizes = {contact: first for contact, first in self._sizes.items() if contact.free_to_slide}
        sliding, firsts = list(self._sizes), np.array(list(self._sizes.values()))
        sizes = np.array([contact.motion(self._mbs).potential for contact in sliding])
        if sliding and (sizes >= GROWN * firsts).all():
            self._dynamics.evaluate(t)
            slips = Slips(self._mbs, self._dynamics, sliding)
            rows, to_forces, _ = independent_rows(slips.to_rates, [])
            slips.give(rows, to_forces, ((1.0 - firsts / sizes)[slips.sets.owner] * slips.now)[rows])
            self._sizes.clear()
