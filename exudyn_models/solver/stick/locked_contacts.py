"""Locked contacts in a model at one time: the slips they hold, velocities that obey them, and their forces."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import exudyn as exu
import numpy as np
import scipy.linalg

from exudyn_models.forces.axial_pairs import Mode, spanned
from exudyn_models.solver.stick.sticking_contacts import (
    PlanarContact,
    StickingContact,
    joints_and_mass,
    lock_places,
)
from reference_model.systems import FloatArray


class LockedContacts:
    """Joints and locked contacts of an assembled model at its initial values and the time t (s).

    All gradients are derivatives with respect to the n velocities of the model.
    """

    def __init__(self, mbs: Any, t: float, contacts: Sequence[StickingContact]) -> None:
        self._mbs, self._contacts = mbs, contacts
        self._planar = [contact for contact in contacts if isinstance(contact, PlanarContact)]
        self._joints, self._mass = joints_and_mass(mbs, t, contacts)

    def is_held(self, contact: StickingContact) -> bool:
        """Return whether the joints of the model and the other locks fix the slip of a contact."""
        others = [other for other in self._contacts if other.mode == Mode.LOCKED and other is not contact]
        return spanned(contact.rows(self._mbs), self._held_rows(others))

    def _held_rows(self, locked: Sequence[StickingContact]) -> FloatArray:
        return np.vstack([self._joints, *(contact.rows(self._mbs) for contact in locked)])

    def share_directions(self) -> None:
        """Let each contact in the plane slip only in directions that joints and contacts locked before it allow."""
        locked: list[StickingContact] = []
        for contact in self._contacts:
            if isinstance(contact, PlanarContact):
                held = self._held_rows(locked)
                # SciPy 1.12 fails for a matrix without rows
                free = scipy.linalg.null_space(held) if held.size else np.eye(held.shape[1])
                contact.allow(self._mbs, free)
                contact.enter(self._mbs, contact.mode)
            if contact.mode == Mode.LOCKED:
                locked.append(contact)

    def set_slip(self, contact: PlanarContact, slip: FloatArray) -> None:
        """Change the initial velocities so that a contact has the ``slip``."""
        data, initial = self._mbs.systemData, exu.ConfigurationType.Initial
        velocities = np.array(data.GetODE2Coordinates_t(initial))
        velocities += self._velocities_of(contact, slip - contact.slip_rows(self._mbs) @ velocities)
        data.SetODE2Coordinates_t(velocities, initial)

    def _velocities_of(self, contact: PlanarContact, slip: FloatArray) -> FloatArray:
        """Return velocities that give only this contact a slip; heavy bodies move the least."""
        others = [other for other in self._contacts if other.mode == Mode.LOCKED and other is not contact]
        held, weights = self._held_rows(others), self._mobilities()
        resisted = slice(3 if contact.planar.mean_radius > 0.0 else 2)  # a pin may spin
        rows = np.vstack([held, contact.slip_rows(self._mbs)[resisted]]) * weights
        wanted = np.concatenate([np.zeros(len(held)), slip[resisted]])
        return np.asarray(weights * np.linalg.lstsq(rows, wanted, rcond=None)[0])

    def support(self, overloaded: StickingContact) -> bool:
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

    def correct(self) -> None:
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
        joints = np.setdiff1d(np.arange(len(forces)), lock_places(self._mbs, self._contacts))
        forces[joints] += change[size : size + len(self._joints)]
        places = [data.GetObjectLTGAE(lock)[0] for contact in locked for lock in contact.active_locks()]
        forces[places] += change[size + len(self._joints) :]
        data.SetAECoordinates(forces)
