"""Eigenvalues of small motions about a state, by Exudyn's linearisation."""

import numpy as np
from numpy.typing import ArrayLike, NDArray

from exudyn_models.paper.creep import RegularisedContact
from exudyn_models.paper.model import build_model
from exudyn_models.solver.linear.matrices import state_matrix
from reference_model.systems import ANGLE, DiscOnDisc, System, checked_state

REGULARISATION = 1e-12
"""ε in m/s, small enough for exact Coulomb friction at any actual slip."""


def eigenvalues(system: System, state: ArrayLike) -> NDArray[np.complex128]:
    """Return the eigenvalues in 1/s of the motion about ``state`` with a sliding contact.

    There are four for a pin, five for a disc on a continuous ring, where nothing depends on the angle, and six for a
    disc on points: the λ of (λ²M + λD + K)v = 0. Exudyn's ``ComputeODE2Eigenvalues`` includes the master disc and
    other free motions.

    ``state``, shape (4,) or (6,) as in ``simulate``, is usually an equilibrium. Raises ``ValueError`` if it does not
    fit the system, or if the contact or a point of it is at rest.
    """
    start = checked_state(system, state, "state")
    contact = RegularisedContact(system, REGULARISATION)
    if system.friction_force > 0.0 and contact.slip_ratios(start[None, :]).min() < 1.0:
        raise ValueError(
            f"state = {start.tolist()}: the contact, or a point of it, is at rest, where friction has no derivative"
        )
    model = build_model(system, start, regularisation=REGULARISATION)
    matrix = state_matrix(model.mbs, slice(model.first, model.first + model.size))
    if isinstance(system, DiscOnDisc) and system.contact_points is None:
        matrix = np.delete(np.delete(matrix, ANGLE, 0), ANGLE, 1)
    return np.asarray(np.linalg.eigvals(matrix), dtype=complex)
