"""Slips of all contacts along their locks, as functions of the velocities."""

from collections.abc import Sequence
from itertools import pairwise
from typing import Any

import exudyn as exu
import numpy as np
from numpy.typing import NDArray

from exudyn_models.solver.items import CURRENT
from exudyn_models.solver.rows.active_set import unloaded
from exudyn_models.solver.stick.complementarity import DEPENDENT, Sets, independent_rows
from exudyn_models.solver.stick.dynamics import Dynamics, mobilities
from exudyn_models.solver.stick.sticking_contacts import STILL, PlanarContact, StickingContact
from reference_model.systems import FloatArray

NOISE = 1e-9
"""Rounding error of slip accelerations, relative to the terms in their sum."""


class Slips:
    """Slips at the state of ``dynamics``.

    ``to_rates``, shape (k, k), relates their accelerations to the forces along all locks. ``sets`` contains the rows
    of each contact, and ``prescribed``, shape (contacts,), is True if no force changes its slip.
    """

    def __init__(self, mbs: Any, dynamics: Dynamics, contacts: Sequence[StickingContact]) -> None:
        self._data, self._dynamics = mbs.systemData, dynamics
        state = self._data.GetODE2Coordinates(), self._data.GetODE2Coordinates_t()
        size, self._velocities = len(state[0]), state[1]
        own = [contact.rows_and_bias(state) for contact in contacts]
        ends = np.cumsum([0, *(len(bias) for _, bias in own)]).tolist()
        self.sets = Sets([slice(*pair) for pair in pairwise(ends)], [contact.law for contact in contacts])
        self.rows, self._bias = (
            np.zeros((ends[-1], size)),
            np.concatenate([np.empty(0), *(bias for _, bias in own)]),
        )
        columns = [contact.places for contact, (rows, _) in zip(contacts, own, strict=True) for _ in rows]
        owner = np.repeat(np.arange(len(columns)), list(map(len, columns)))
        none = np.empty(0, dtype=int)
        self.rows[owner, np.concatenate([none, *columns])] = np.concatenate(
            [none, *(g.ravel() for g, _ in own)]
        )
        #: Slips (m/s or rad/s) before any change by ``give``.
        self.now = self.rows @ self._velocities
        self._to_velocities = dynamics.inverse[:size, :size] @ self.rows.T
        self.to_rates = self.rows @ self._to_velocities
        lengths = self.rows**2 @ mobilities(dynamics.mass)
        fixed = np.diag(self.to_rates) <= DEPENDENT * lengths
        self.to_rates[fixed] = self.to_rates[:, fixed] = 0.0
        self.prescribed = np.asarray(np.bincount(self.sets.owner, ~fixed, len(contacts)) == 0.0)
        for contact, rows in zip(contacts, self.sets.blocks, strict=True):
            if isinstance(contact, PlanarContact):
                contact.allow(self.to_rates[rows, rows], lengths[rows])
        self._resolution = np.array([contact.resolution for contact in contacts])

    def bounds(self, accelerations: FloatArray, limits: FloatArray) -> FloatArray:
        """Return the largest slip acceleration of each contact under friction up to ``limits``, shape (contacts,)."""
        counts = [rows.stop - rows.start for rows in self.sets.blocks]
        friction = np.abs(self.to_rates) @ np.repeat(limits, counts)
        return self.sets.sizes(np.abs(self.rates(accelerations)) + friction)

    def still(self, step: float, bounds: FloatArray) -> FloatArray:
        """Return the slips that a ``step`` (s) may stop, or that are rounding errors, shape (contacts,)."""
        return np.maximum(self._resolution * (step * bounds + self.terms()), STILL * self.prescribed)

    def terms(self) -> FloatArray:
        """Return the size of the terms in the sum of each slip, which determine its rounding error."""
        return self.sets.sizes(np.abs(self.rows) @ np.abs(self._velocities))

    def rates(self, accelerations: FloatArray) -> FloatArray:
        """Return the slip accelerations."""
        return np.asarray(self.rows @ accelerations + self._bias)

    def noise(self, accelerations: FloatArray) -> FloatArray:
        """Return the rounding errors of slip accelerations, which contain a difference over time."""
        speeds = np.abs(self._velocities) * (1e-5 / self._dynamics.difference)
        return np.asarray(NOISE * np.abs(self.rows) @ (np.abs(accelerations) + speeds))

    def to_loads(self, places: NDArray[Any]) -> FloatArray:
        """Return the moments of constraints at ``places`` by unit forces along all locks, shape (m, k)."""
        size = len(self._velocities)
        return -np.asarray(self._dynamics.inverse[size + places, :size] @ self.rows.T)

    def hold(self, held: Sequence[int], forces: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Return the forces that hold rows under generalised ``forces``, accelerations and constraint forces."""
        accelerations, constraints = self._dynamics.solution(forces)
        if not held:
            return np.empty(0), accelerations, constraints
        holding = np.linalg.solve(self.to_rates[np.ix_(held, held)], -self.rates(accelerations)[held])
        return np.asarray(holding, float), *self._dynamics.solution(forces + holding @ self.rows[held])

    def collide(self) -> None:
        """Give one-way clutches, the only contacts, slips >= 0 by an impact."""
        if self.now.min() < 0.0:
            limits = np.tile([0.0, np.inf], (len(self.now), 1))
            self.give(dict(enumerate(unloaded(len(self.now)).forces(self.to_rates, self.now, limits)[1])), [])

    def give(self, wanted: dict[int, float], first: Sequence[int]) -> None:
        """Give rows the slips ``wanted`` at the least kinetic energy; if rows conflict, only the rows ``first``."""
        rows = list(wanted)
        gram = self.to_rates[np.ix_(rows, rows)]
        places = [i for i, row in enumerate(rows) if row in first]
        independent, _ = independent_rows(gram, places)
        changed = [rows[i] for i in independent]
        change = np.array([wanted[row] for row in changed]) - self.now[changed]
        impulses = np.linalg.solve(self.to_rates[np.ix_(changed, changed)], change)
        velocities = self._velocities + self._to_velocities[:, changed] @ impulses
        for configuration in (CURRENT, exu.ConfigurationType.Initial):
            self._data.SetODE2Coordinates_t(velocities, configuration)
