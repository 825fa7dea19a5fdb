"""Linearisation of a model in its present state, with locked contacts as constraints."""

from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

import exudyn as exu
import numpy as np
from numpy.typing import NDArray
from scipy.linalg import null_space

from exudyn_models.forces.axial_pairs import Mode
from exudyn_models.solver.contacts import find_again
from exudyn_models.solver.items import CURRENT
from exudyn_models.solver.linear.matrices import matrices_of_model
from exudyn_models.solver.rows.laws import GrowingLimit, MeshLaw
from exudyn_models.solver.rows.moment_loads import MomentLoadedStick
from exudyn_models.solver.stick.dynamics import Dynamics
from exudyn_models.solver.stick.mode_choice import ModeChoice
from exudyn_models.solver.stick.sliding_steps import SlidingSteps
from exudyn_models.solver.stick.sticking_contacts import (
    PlanarContact,
    SpringFlanks,
    StickingContact,
    running,
    sticking_contacts,
)
from reference_model.systems import FloatArray, require_kind

STEP = 1e-3
"""Step in s of a run from this state; a slip that friction stops within a billionth of it counts as zero."""

TURN = 1e-5
"""Change of a coordinate in m or rad for the differences of constraint gradients; their errors are about 1e-10."""


@dataclass(frozen=True, eq=False)
class ContactState:
    """Mode and load of a contact with exact stick.

    Parameters
    ----------
    contact : int
        Object number of the contact's connector.
    mode : Mode
        Mode at this state.
    wrench : array of shape (3,)
        Force in N and moment in N m on the disc, in the axes of the master. On one axis only the moment differs
        from zero.
    capacity_share : float
        Share of the static friction in use: 1 while the contact slides, 0 while it is open.
    group : tuple of int
        Object numbers of the locked contacts that share a load with this one, itself included.
    point : int or None
        Number of the point, from 1, of a contact at several points that stick one by one.

    """

    contact: int
    mode: Mode
    wrench: FloatArray
    capacity_share: float
    group: tuple[int, ...]
    point: int | None

    @property
    def moment(self) -> float:
        """Moment on the disc in N m."""
        return float(self.wrench[2])


@dataclass(frozen=True, eq=False)
class Linearisation:
    """Small motions x of a model about a state: M·ẍ + D·ẋ + K·x + Rᵀ·λ = 0 with J·x = 0.

    Parameters
    ----------
    time : float
        Time of the state in s.
    mass, damping, stiffness : arrays of shape (n, n)
        M, D and K of all second-order coordinates.
    constraints : array of shape (m, n)
        J, the gradients of joints and of locked contacts.
    reactions : array of shape (m, n)
        R, the directions of their forces: J, but turned by the friction of sliding gears with losses.
    contacts : tuple of ContactState
        Contacts with exact stick.

    """

    time: float
    mass: FloatArray
    damping: FloatArray
    stiffness: FloatArray
    constraints: FloatArray
    reactions: FloatArray
    contacts: tuple[ContactState, ...] = field(repr=False)

    @property
    def eigenvalues(self) -> NDArray[np.complex128]:
        """Eigenvalues in 1/s, sorted by their magnitude, shape (2k,) for k free coordinates."""
        return self._solution[0]

    @property
    def modes(self) -> NDArray[np.complex128]:
        """Mode shapes in the columns, shape (n, 2k), with a largest element of 1."""
        return self._solution[1]

    @property
    def damping_ratios(self) -> FloatArray:
        """−Re λ/|λ| of the eigenvalues λ, shape (2k,); 0 where λ is zero."""
        sizes = np.abs(self.eigenvalues)
        ratios = np.zeros(len(sizes))
        np.divide(-self.eigenvalues.real, sizes, out=ratios, where=sizes > 0.0)
        return ratios

    @cached_property
    def _solution(self) -> tuple[NDArray[np.complex128], NDArray[np.complex128]]:
        free, unloaded = (_null_space(gradients) for gradients in (self.constraints, self.reactions))
        mass, damping, stiffness = (
            unloaded.T @ matrix @ free for matrix in (self.mass, self.damping, self.stiffness)
        )
        size = len(mass)
        lower = -np.linalg.solve(mass, np.hstack((stiffness, damping)))
        values, vectors = np.linalg.eig(np.vstack((np.hstack((np.zeros((size, size)), np.eye(size))), lower)))
        order = np.lexsort((values.imag, np.abs(values).round(12)))
        shapes = free @ vectors[:size, order]
        shapes /= np.take_along_axis(shapes, np.abs(shapes).argmax(axis=0)[None], axis=0)
        return values[order].astype(complex), shapes.astype(complex)


def _null_space(rows: FloatArray) -> FloatArray:
    """Return an orthonormal basis of the vectors that vanish on all rows, shape (n, k)."""
    if not len(rows):
        return np.eye(rows.shape[1])
    return np.asarray(null_space(rows / np.linalg.norm(rows, axis=1, keepdims=True)))


def linearise(mbs: Any) -> Linearisation:
    """Linearise a model about its present state, the end of its last run or its initial values.

    Contacts with exact stick obey Coulomb's law at this state: locked contacts are constraints, and sliding contacts
    have the slope of their friction. Contacts that are locked together share their load so that the largest share of
    their static friction is as small as possible. Contacts between the same bodies then carry it in proportion to
    their static friction.

    Constraint forces count with the turn of their directions (a pendulum has the stiffness of its weight), and small
    motions turn with constraints that turn. Loads of user functions count as constant.
    First-order coordinates, such as heat and work, do not count. The model is assembled if necessary, and
    its state stays unchanged.

    Parameters
    ----------
    mbs : exudyn MainSystem
        Model.

    Raises
    ------
    ValueError
        If a contact has lost its constraints.
    SimulationError
        If no modes of the contacts satisfy Coulomb's law.

    """
    require_kind("mbs", mbs, exu.MainSystem)
    if not mbs.systemIsConsistent:
        mbs.Assemble()
    find_again(mbs)
    data, initial = mbs.systemData, exu.ConfigurationType.Initial
    configurations = CURRENT, initial
    before = [(data.GetSystemState(one), data.GetODE2Coordinates_tt(one)) for one in configurations]
    t = data.GetTime(CURRENT)
    data.SetSystemState(before[0][0], initial)
    try:
        contacts = sticking_contacts(mbs, t, t + STEP)
        with running(mbs, contacts):
            groups = _settle(mbs, t, contacts)
            states = tuple(
                _state_of(mbs, t, contact, groups)
                for contact in contacts
                if not isinstance(contact, SpringFlanks)
            )
            return _about_initial_values(mbs, t, contacts, states)
    finally:
        for (state, accelerations), configuration in zip(before, configurations, strict=True):
            data.SetSystemState(state, configuration)
            data.SetODE2Coordinates_tt(accelerations, configuration)
        data.SetTime(t)


def _settle(mbs: Any, t: float, contacts: Sequence[StickingContact]) -> list[list[StickingContact]]:
    """Choose the modes of the contacts; return the contacts that share a load."""
    planar = [contact for contact in contacts if isinstance(contact, PlanarContact)]
    choice = ModeChoice(mbs, t, contacts, SlidingSteps(mbs, planar, STEP), STEP)
    data, initial = mbs.systemData, exu.ConfigurationType.Initial
    data.SetAECoordinates(data.GetAECoordinates(initial))  # a load may be a reaction
    choice.settle(t)
    data.SetSystemState(data.GetSystemState(), initial)
    return choice.groups


def _state_of(
    mbs: Any, t: float, contact: StickingContact, groups: list[list[StickingContact]]
) -> ContactState:
    stick, data = contact.stick, mbs.systemData
    slip, radius = np.array([0.0, 0.0, stick.slip(*_coordinates(data, contact))]), 0.0
    if isinstance(contact, PlanarContact):
        motion = contact.motion(mbs)
        slip, radius = motion.slip, motion.radius
    group = next((group for group in groups if contact in group), [contact])
    return ContactState(
        contact.item,
        stick.visible_mode,
        stick.wrench(mbs, t, slip, radius, 0.0),
        stick.capacity_share(mbs, t),
        tuple(one.item for one in group),
        stick.point,
    )


def _coordinates(data: Any, contact: StickingContact) -> tuple[FloatArray, FloatArray]:
    return data.GetODE2Coordinates()[contact.places], data.GetODE2Coordinates_t()[contact.places]


def _turns_of(contacts: Sequence[StickingContact]) -> list[tuple[int, NDArray[Any], FloatArray]]:
    """Return constraints, and coordinates and directions of sliding friction that grows with their forces."""
    found = []
    for contact in contacts:
        law = contact.stick
        if not isinstance(law, GrowingLimit) or not law.slides:
            continue
        part = law.part if isinstance(law, MomentLoadedStick) else law
        if part is not None and (isinstance(part, MeshLaw) or part.mode == Mode.LOCKED):
            item = part.item if isinstance(part, MeshLaw) else part.locks[0]
            slope = law.slope_at(law.load, int(law.mode or 0))
            found.append((item, contact.places, -slope * np.array(law.gradient([]))))
    return found


def _slopes_by_loads(data: Any, contacts: Sequence[StickingContact]) -> FloatArray:
    """Return the stiffness and damping of friction whose load is a moment that the motion determines, (2, n, n)."""
    size = data.ODE2Size()
    found = np.zeros((2, size, size))
    states = (
        (data.GetODE2Coordinates, data.SetODE2Coordinates),
        (
            data.GetODE2Coordinates_t,
            data.SetODE2Coordinates_t,
        ),
    )
    for contact in contacts:
        law = contact.stick
        if not isinstance(law, MomentLoadedStick) or not law.slides:
            continue
        by_load = law.slope_at(law.load, int(law.mode or 0)) * np.array(law.gradient([]))
        for matrix, (read, write) in zip(found, states, strict=True):
            now = read()
            for i, change in enumerate(TURN * np.eye(size)):
                loads = []
                for way in (1.0, -1.0):
                    write(now + way * change)
                    loads.append(law.load)
                matrix[contact.places, i] += by_load * (loads[0] - loads[1]) / (2.0 * TURN)
            write(now)
    return found


def _about_initial_values(
    mbs: Any, t: float, contacts: Sequence[StickingContact], states: tuple[ContactState, ...]
) -> Linearisation:
    data, turns = mbs.systemData, _turns_of(contacts)
    mass, *matrices = matrices_of_model(mbs, t)
    stiffness, damping = _slopes_by_loads(data, contacts) + matrices
    if not data.AEsize():
        none = np.zeros((0, len(mass)))
        return Linearisation(t, mass, damping, stiffness, none, none, states)
    dynamics, q = Dynamics(mbs, t, STEP), data.GetODE2Coordinates()
    forces = data.GetAECoordinates(exu.ConfigurationType.Initial)

    def gradients(coordinates: FloatArray) -> FloatArray:
        data.SetODE2Coordinates(coordinates)
        dynamics.evaluate(t)
        return dynamics.gradients

    rates, moved = dynamics.coordinate_rates(), np.zeros((data.AEsize(), len(q)))
    for i, change in enumerate(TURN * np.eye(len(q))):
        turned = (gradients(q + change) - gradients(q - change)) / (2.0 * TURN)
        stiffness[:, i] += turned.T @ forces
        moved += turned * rates[i]
    constraints = gradients(q)
    reactions, active = constraints.copy(), constraints.any(axis=1)
    for item, places, turn in turns:
        reactions[data.GetObjectLTGAE(item)[0], places] += turn
    stiffness += _stiffness_of_turn(mass, damping, constraints, reactions, moved)
    return Linearisation(t, mass, damping, stiffness, constraints[active], reactions[active], states)


def _stiffness_of_turn(
    mass: FloatArray, damping: FloatArray, constraints: FloatArray, reactions: FloatArray, rates: FloatArray
) -> FloatArray:
    """Return the stiffness due to the ``rates`` of constraints that turn as the model moves.

    Small motions x = Z·y turn with them: J·Ż = −J̇·Z. Their axes do not turn among themselves, so Yᵀ·M·Ż = 0 with
    R·Y = 0. The rate of this equation is Yᵀ·M·Z̈ = −Ẏᵀ·M·Ż. The stiffness Yᵀ·(M·Z̈ + D·Ż) of y cancels the centrifugal
    force in the reactions.
    """
    size, count = len(mass), len(rates)
    system = np.block([[mass, reactions.T], [constraints, np.zeros((count, count))]])
    found = np.linalg.lstsq(system, np.vstack((np.zeros((size, size)), rates)), rcond=None)[0]
    return np.asarray(rates.T @ found[size:] - damping @ found[:size])
