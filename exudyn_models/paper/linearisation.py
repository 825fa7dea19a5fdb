"""Small motions about a state, by Exudyn's own linearisation."""

from __future__ import annotations

from typing import Any

import exudyn as exu
import numpy as np
from numpy.typing import ArrayLike, NDArray

from exudyn_models.paper.creep import creep_ratios
from exudyn_models.paper.models.build import build
from exudyn_models.solver.solver_run import quiet
from reference_model.systems import ANGLE, DiscOnDisc, FloatArray, System, checked_state

REGULARISATION = 1e-12
"""ε in m/s: friction is Coulomb's wherever the contact slips by more."""


def eigenvalues(system: System, state: ArrayLike) -> NDArray[np.complex128]:
    """Return the eigenvalues in 1/s of the motion about ``state``, in which the contact slides.

    Four of a pin, five of a disc on a continuous ring, where nothing depends on the angle, and six of one on points.
    Exudyn gives the mass matrix M and the derivatives −K and −D of its forces by coordinates and velocities: they are
    the λ of (λ²M + λD + K)v = 0. (Exudyn's ``ComputeODE2Eigenvalues`` adds those of the master disc and of what else
    moves freely, and can not leave coordinates out of complex ones.)

    Parameters
    ----------
    system : PinOnDisc or DiscOnDisc
        The parameters.
    state : array of shape (4,) or (6,)
        As ``simulate`` takes it: usually that of an equilibrium.

    Raises
    ------
    ValueError
        If the state is none of the system, or the contact or a point of it is at rest.

    """
    start = checked_state(system, state)
    if system.friction_force > 0.0 and creep_ratios(system, start[None, :], REGULARISATION).min() < 1.0:
        raise ValueError(
            f"state = {start.tolist()}: the contact, or a point of it, is at rest, where friction has no derivative"
        )
    model = build(system, start, regularisation=REGULARISATION)
    matrix = state_matrix(model.mbs, slice(model.first, model.first + model.size))
    if isinstance(system, DiscOnDisc) and system.contact_points is None:
        matrix = np.delete(np.delete(matrix, ANGLE, 0), ANGLE, 1)
    return np.asarray(np.linalg.eigvals(matrix), dtype=complex)


def state_matrix(mbs: Any, own: slice = slice(None)) -> FloatArray:
    """Return A of d(x, ẋ)/dt = A·(x, ẋ), small motions about the initial values of an assembled model.

    x are its coordinates of second order, or ``own`` of them. Where loads or a friction's normal load are functions
    of the user's that read the motion by themselves, they are taken as they are at that state.
    """
    mass, stiffness, damping = (part[own, own] for part in matrices_of_model(mbs))
    lower = -np.linalg.solve(mass, np.hstack((stiffness, damping)))
    upper = np.hstack((np.zeros_like(mass), np.eye(len(mass))))
    return np.vstack((upper, lower))


def matrices_of_model(mbs: Any, t: float = 0.0) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Return M, K and D of small motions M·ẍ + D·ẋ + K·x = 0 about the initial values at the time t in s.

    Of an assembled model and all of its coordinates of second order. Its sensors do not notice.
    """
    solver: Any = exu.MainSolverStatic()  # its Jacobian holds no terms of a time integration
    settings = exu.SimulationSettings()
    settings.solution.file.write = settings.solution.sensors.active = False
    settings.staticSolver.loadStepStart = t
    size = mbs.systemData.ODE2Size()

    def part(matrix: Any) -> FloatArray:
        return np.array(matrix)[:size, :size]

    def jacobian(**factors: float) -> FloatArray:
        zero = {"scalarFactor_ODE2": 0.0, "scalarFactor_ODE2_t": 0.0, "scalarFactor_ODE1": 0.0}
        solver.ComputeJacobianODE2RHS(mbs, **(zero | factors))
        return part(solver.GetSystemJacobian())

    with quiet():
        solver.InitializeSolver(mbs, settings)
        solver.ComputeMassMatrix(mbs)
        mass = part(solver.GetSystemMassMatrix())
        stiffness, damping = jacobian(scalarFactor_ODE2=-1.0), jacobian(scalarFactor_ODE2_t=-1.0)
        solver.FinalizeSolver(mbs, settings)
    return mass, stiffness, damping
