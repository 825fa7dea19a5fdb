"""Locked contacts of a model at one time: the slips they hold, and their forces."""

from collections.abc import Callable, Sequence
from typing import Any

import exudyn as exu
import numpy as np
import scipy.linalg
from scipy.optimize import minimize

from exudyn_models.forces.axial_pairs import Mode, spanned
from exudyn_models.solver.stick.dynamics import Dynamics, mobilities
from exudyn_models.solver.stick.slip_motion import SlipMotion
from exudyn_models.solver.stick.sticking_contacts import (
    AHEAD,
    STILL,
    PlanarContact,
    StickingContact,
    joints_of,
)
from reference_model.systems import FloatArray
from reference_model.trajectory import SimulationError


class LockedContacts:
    """Joints and locked contacts of an assembled model at the state where ``dynamics`` was evaluated.

    Gradients refer to the n velocities of the model.
    """

    def __init__(self, mbs: Any, dynamics: Dynamics, contacts: Sequence[StickingContact]) -> None:
        self._mbs, self._contacts = mbs, contacts
        self._planar = [contact for contact in contacts if isinstance(contact, PlanarContact)]
        self._joints, self._mass = joints_of(mbs, dynamics, contacts), dynamics.mass

    def is_held(self, contact: StickingContact) -> bool:
        """Return whether joints and the other locks fix the slip of a contact."""
        others = [other for other in self._contacts if other.mode == Mode.LOCKED and other is not contact]
        return spanned(contact.rows(self._mbs), self._held_rows(others))

    def _held_rows(self, locked: Sequence[StickingContact]) -> FloatArray:
        return np.vstack([self._joints, *(contact.rows(self._mbs) for contact in locked)])

    def is_held_from_the_plane(self, contact: StickingContact) -> bool:
        """Return whether contacts at rest in the plane hold a contact on an axis that the others leave free."""
        on_axes = [
            one
            for one in self._contacts
            if one.mode == Mode.LOCKED and one is not contact and one not in self._planar
        ]
        row, held = contact.rows(self._mbs), self._held_rows(on_axes)
        in_plane = [one.slip_rows(self._mbs) for one in self._planar if one.planar.rests]
        return bool(in_plane) and spanned(row, np.vstack([held, *in_plane])) and not spanned(row, held)

    def _check_axes(self, t: float, on_axes: Sequence[StickingContact], forces: FloatArray) -> None:
        """Raise ``SimulationError`` if generalised ``forces``, shape (n,), from the plane exceed a capacity."""
        reactions = np.linalg.lstsq(self._held_rows(on_axes).T, -forces, rcond=None)[0]
        for contact, more in zip(on_axes, reactions[len(self._joints) :].tolist(), strict=True):
            moment = contact.stick.held_moment(self._mbs) + more
            if contact.stick.unused(contact.capacities(t), moment) < 0.0:
                raise undecided(t)

    def share_directions(self) -> None:
        """Let each contact slip only in directions that joints and contacts locked before it allow."""
        if not self._planar:
            return
        locked: list[StickingContact] = []
        on_axis = [contact for contact in self._contacts if contact not in self._planar]
        by_joints = _null_space(self._held_rows([one for one in on_axis if one.mode == Mode.LOCKED]))
        for contact in self._contacts:
            if isinstance(contact, PlanarContact):
                contact.allow(self._mbs, by_joints, _null_space(self._held_rows(locked)))
                contact.enter(self._mbs, contact.mode)
            if contact.mode == Mode.LOCKED:
                locked.append(contact)

    def passes(self, contact: PlanarContact, motion: SlipMotion) -> bool:
        """Return whether joints and prescribed motions accelerate a slip, so it may only pass through zero."""
        locked = [one for one in self._contacts if one.mode == Mode.LOCKED and one not in self._planar]
        slips = contact.slip_rows(self._mbs) @ _null_space(self._held_rows(locked))
        imposed = motion.rate - slips @ np.linalg.lstsq(slips, motion.rate, rcond=None)[0]
        return AHEAD * contact.planar.potential_of(imposed) > STILL

    def set_slip(self, contact: PlanarContact, slip: FloatArray) -> None:
        """Give a contact the ``slip``, as far as joints allow, by a change of the initial velocities."""
        data, initial = self._mbs.systemData, exu.ConfigurationType.Initial
        velocities = np.array(data.GetODE2Coordinates_t(initial))
        change, allowed = slip - contact.slip_rows(self._mbs) @ velocities, contact.planar.allowed
        change = allowed @ np.linalg.lstsq(allowed, change, rcond=None)[0]
        velocities += self._velocities_of(contact, change)
        data.SetODE2Coordinates_t(velocities, initial)

    def _velocities_of(self, contact: PlanarContact, slip: FloatArray) -> FloatArray:
        """Return velocities that give only this contact a slip; heavy bodies move least."""
        others = [other for other in self._contacts if other.mode == Mode.LOCKED and other is not contact]
        held, weights = self._held_rows(others), np.sqrt(mobilities(self._mass))
        resisted = slice(3 if contact.planar.mean_radius > 0.0 else 2)  # a pin may spin
        rows = np.vstack([held, contact.slip_rows(self._mbs)[resisted]]) * weights
        wanted = np.concatenate([np.zeros(len(held)), slip[resisted]])
        return np.asarray(weights * np.linalg.lstsq(rows, wanted, rcond=None)[0])

    def balance(self, t: float) -> bool:
        """Distribute the load at the time t (s) over the contacts that rest on the same bodies.

        The largest share of its capacity that a contact holds becomes as small as possible. Return whether the
        distribution is statically undetermined.
        """
        mbs = self._mbs
        resting = [contact for contact in self._planar if contact.planar.rests and contact.holding(t) > 0.0]
        others = [
            contact for contact in self._contacts if contact.mode == Mode.LOCKED and contact not in resting
        ]
        if len(resting) < 2:
            return False
        capacities = [contact.holding(t) for contact in resting]
        sizes = np.array([[1.0, 1.0, contact.planar.mean_radius] for contact in resting])
        sizes = (sizes * np.array(capacities)[:, None]).ravel()
        slips = np.vstack([contact.slip_rows(mbs) for contact in resting])
        on_bodies = _null_space(self._held_rows(others)).T @ (slips.T * sizes)
        undetermined = sizes[:, None] * _null_space(on_bodies)
        undetermined = undetermined[
            :, np.linalg.norm(undetermined, axis=0) > 0.0
        ]  # a pin transmits no moment
        if not undetermined.size:
            return False
        present = np.concatenate([contact.planar.held_wrench(mbs) for contact in resting])

        def shares(x: FloatArray) -> tuple[FloatArray, FloatArray]:
            found = [
                contact.planar.load_share(wrench, capacity)
                for contact, wrench, capacity in zip(
                    resting, (present + undetermined @ x).reshape(-1, 3), capacities, strict=True
                )
            ]
            gradients = [
                -slip / capacity @ undetermined[3 * i : 3 * i + 3]
                for i, ((_, slip), capacity) in enumerate(zip(found, capacities, strict=True))
            ]
            return np.array([share for share, _ in found]), np.array(gradients)

        moved = undetermined @ least_maximum(shares, undetermined.shape[1])
        for contact, change in zip(resting, moved.reshape(-1, 3), strict=True):
            contact.planar.taken_over = contact.planar.taken_over + change
        taken = slips.T @ np.concatenate([contact.planar.taken_over for contact in resting])
        self._check_axes(t, [contact for contact in others if contact not in self._planar], taken)
        return True


def undecided(t: float) -> SimulationError:
    """Return an error at the time t (s) about contacts on an axis and in the plane that share a load."""
    return SimulationError(
        f"contacts on an axis and in the plane share a load at t = {t:.9g} s that releases one on the axis: exact "
        "stick cannot distribute this load; give one of these contacts a regularisation"
    )


def least_maximum(functions: Callable[[FloatArray], tuple[FloatArray, FloatArray]], size: int) -> FloatArray:
    """Return the minimiser, shape (size,), of the maximum of convex functions.

    ``functions`` returns their values, shape (n,), and derivatives, shape (n, size).
    """

    def above(z: FloatArray) -> FloatArray:
        return np.asarray(z[0] - functions(z[1:])[0])

    def slopes(z: FloatArray) -> FloatArray:
        gradients = functions(z[1:])[1]
        return np.hstack((np.ones((len(gradients), 1)), -gradients))

    start = np.zeros(size)
    found = minimize(
        lambda z: z[0],
        [np.max(functions(start)[0]), *start],
        jac=lambda z: np.eye(size + 1)[0],
        constraints={"type": "ineq", "fun": above, "jac": slopes},
        method="SLSQP",
        options={"ftol": 1e-13, "maxiter": 200},
    )
    return np.asarray(found.x[1:])


def _null_space(rows: FloatArray) -> FloatArray:
    # SciPy 1.12 fails for a matrix without rows
    return np.asarray(scipy.linalg.null_space(rows) if rows.size else np.eye(rows.shape[1]))
