"""Slips of all contacts along their locks, as functions of the velocities."""

from collections.abc import Sequence
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray

from exudyn_models.solver.rows.active_set import unloaded
from exudyn_models.solver.stick.complementarity import DEPENDENT, Sets
from exudyn_models.solver.stick.dynamics import Dynamics, mobilities
from exudyn_models.solver.stick.sticking_contacts import STILL, PlanarContact, StickingContact
from reference_model.systems import FloatArray

NOISE = 1e-9
"""Rounding error of slip accelerations, relative to the terms in their sum."""


class Slips:
    """Slips at the state of ``dynamics``.

    ``to_rates``, shape (k, k), relates their accelerations to the forces along all locks. ``sets`` contains the rows
    of each contact, and ``firsts`` the first of them. ``prescribed``, shape (contacts,), is True if no force changes
    a slip.
    """

    def __init__(self, mbs: Any, dynamics: Dynamics, contacts: Sequence[StickingContact]) -> None:
        self._mbs, self._data, self._dynamics, self.contacts = mbs, mbs.systemData, dynamics, contacts
        self._constant, self._inverse = all(len(one.stick.weights) for one in contacts), dynamics.inverse
        state = self._data.GetODE2Coordinates(), self._data.GetODE2Coordinates_t()
        size = len(state[0])
        own = [contact.rows_and_bias(state) for contact in contacts]
        ends = np.cumsum([0, *(len(bias) for _, bias in own)]).tolist()
        self.firsts = ends[:-1]
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
        self._to_velocities = self._inverse[:size, :size] @ self.rows.T
        self.to_rates = self.rows @ self._to_velocities
        self._lengths = self.rows**2 @ mobilities(dynamics.mass)
        fixed = np.diag(self.to_rates) <= DEPENDENT * self._lengths
        self.to_rates[fixed] = self.to_rates[:, fixed] = 0.0
        self.prescribed = np.asarray(np.bincount(self.sets.owner, ~fixed, len(contacts)) == 0.0)
        self._sizes, self._to_sizes = np.abs(self.rows), np.abs(self.to_rates)
        self._counts = [rows.stop - rows.start for rows in self.sets.blocks]
        self._resolution = np.array([contact.resolution for contact in contacts])
        self._read()

    def _read(self) -> None:
        self._velocities = self._data.GetODE2Coordinates_t()
        #: Slips (m/s or rad/s) before any change by ``give``.
        self.now = self.rows @ self._velocities

    def at_present(self) -> "Slips":
        """Return the slips at the present state of the same ``dynamics``."""
        if not self._constant or self._inverse is not self._dynamics.inverse:
            return Slips(self._mbs, self._dynamics, self.contacts)
        self._read()
        return self

    def allow(self) -> None:
        """Let contacts in the plane know which slips constraints allow."""
        for contact, rows in zip(self.contacts, self.sets.blocks, strict=True):
            if isinstance(contact, PlanarContact):
                contact.allow(self.to_rates[rows, rows], self._lengths[rows])

    def rows_of(self, contacts: Sequence[int]) -> list[int]:
        """Return the numbers of the rows of these contacts."""
        return [row for i in contacts for row in range(self.firsts[i], self.firsts[i] + self._counts[i])]

    def bounds(self, accelerations: FloatArray, limits: FloatArray) -> FloatArray:
        """Return the largest slip acceleration of each contact under friction up to ``limits``, shape (contacts,)."""
        friction = self._to_sizes @ np.repeat(limits, self._counts)
        return self.sets.sizes(np.abs(self.rates(accelerations)) + friction)

    def still(self, step: float, bounds: FloatArray) -> FloatArray:
        """Return the slips that a ``step`` (s) may stop, or that are rounding errors, shape (contacts,)."""
        return np.maximum(self._resolution * (step * bounds + self.terms()), STILL * self.prescribed)

    def terms(self) -> FloatArray:
        """Return the size of the terms in the sum of each slip, which determine its rounding error."""
        return self.sets.sizes(self._sizes @ np.abs(self._velocities))

    def rates(self, accelerations: FloatArray) -> FloatArray:
        """Return the slip accelerations."""
        return np.asarray(self.rows @ accelerations + self._bias)

    def noise(self, accelerations: FloatArray) -> FloatArray:
        """Return the rounding errors of slip accelerations, which contain a difference over time."""
        speeds = np.abs(self._velocities) * (1e-5 / self._dynamics.difference)
        return np.asarray(NOISE * self._sizes @ (np.abs(accelerations) + speeds))

    def to_loads(self, places: NDArray[Any]) -> FloatArray:
        """Return the moments of constraints at ``places`` by unit forces along all locks, shape (m, k)."""
        size = len(self._velocities)
        return -np.asarray(self._inverse[size + places, :size] @ self.rows.T)

    def among(self, rows: Sequence[int]) -> FloatArray:
        """Return the part of ``to_rates`` between these rows."""
        return np.asarray(self.to_rates[rows][:, rows])

    def hold(
        self, held: Sequence[int], to_forces: FloatArray, forces: FloatArray
    ) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Return the forces that hold rows under generalised ``forces``, accelerations and constraint forces.

        ``to_forces``, shape (k, k), is the inverse of ``among(held)``.
        """
        accelerations, constraints = self._dynamics.solution(forces)
        if not held:
            return np.empty(0), accelerations, constraints
        holding = -to_forces @ self.rates(accelerations)[held]
        return np.asarray(holding, float), *self._dynamics.solution(forces + holding @ self.rows[held])

    def collide(self) -> None:
        """Give one-way clutches, the only contacts, slips >= 0 by an impact."""
        if self.now.min() < 0.0:
            limits = np.tile([0.0, np.inf], (len(self.now), 1))
            impulses, _ = unloaded(len(self.now)).forces(self.to_rates, self.now, limits)
            self._data.SetODE2Coordinates_t(self._velocities + self._to_velocities @ impulses)

    def give(self, rows: Sequence[int], to_forces: FloatArray, wanted: FloatArray) -> None:
        """Give rows the slips ``wanted`` at the least kinetic energy; ``to_forces`` is as in ``hold``."""
        impulses = to_forces @ (wanted - self.now[rows])
        self._data.SetODE2Coordinates_t(self._velocities + self._to_velocities[:, rows] @ impulses)
