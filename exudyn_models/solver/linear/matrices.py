"""Mass, stiffness and damping matrices of an assembled model, from Exudyn's derivatives."""

from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

import exudyn as exu
import numpy as np

from exudyn_models.solver.solver_run import quiet
from reference_model.systems import FloatArray


def state_matrix(mbs: Any, own: slice = slice(None)) -> FloatArray:
    """Return A of d(x, ẋ)/dt = A·(x, ẋ) for small motions about the initial values of an assembled model.

    x are its second-order coordinates, or only the coordinates in ``own``. Loads that read the motion themselves
    count as constant.
    """
    mass, stiffness, damping = (part[own, own] for part in matrices_of_model(mbs))
    lower = -np.linalg.solve(mass, np.hstack((stiffness, damping)))
    upper = np.hstack((np.zeros_like(mass), np.eye(len(mass))))
    return np.vstack((upper, lower))


def matrices_of_model(mbs: Any, t: float = 0.0) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Return M, K and D of M·ẍ + D·ẋ + K·x = 0 for small motions about the initial values at the time t in s.

    x are all second-order coordinates of the assembled ``mbs``. Sensors record nothing.
    """
    size = mbs.systemData.ODE2Size()
    with _mass_and_solver(mbs, t) as (mass, solver):

        def jacobian(**factors: float) -> FloatArray:
            zero = {"scalarFactor_ODE2": 0.0, "scalarFactor_ODE2_t": 0.0, "scalarFactor_ODE1": 0.0}
            solver.ComputeJacobianODE2RHS(mbs, **(zero | factors))
            return np.array(solver.GetSystemJacobian())[:size, :size]

        return mass, jacobian(scalarFactor_ODE2=-1.0), jacobian(scalarFactor_ODE2_t=-1.0)


@contextmanager
def _mass_and_solver(mbs: Any, t: float) -> Iterator[tuple[FloatArray, Any]]:
    solver: Any = exu.MainSolverStatic()  # without terms of time integration in its Jacobian
    settings = exu.SimulationSettings()
    settings.solution.file.write = settings.solution.sensors.active = False
    settings.staticSolver.loadStepStart = t
    size = mbs.systemData.ODE2Size()
    with quiet():
        solver.InitializeSolver(mbs, settings)
        solver.ComputeMassMatrix(mbs)
        yield np.array(solver.GetSystemMassMatrix())[:size, :size], solver
        solver.FinalizeSolver(mbs, settings)


def singular_mass(mbs: Any) -> str:
    """Return a message about coordinates without mass, or ""."""
    with _mass_and_solver(mbs, 0.0) as (mass, _):
        pass
    for node in range(mbs.systemData.NumberOfNodes()):
        if mbs.GetNode(node)["nodeType"] == "RigidBodyEP":  # a constraint, not inertia, fixes the norm
            first = mbs.GetNodeODE2Index(node) + 3
            rotation = mass[first : first + 4, first : first + 4]
            rotation += rotation.any() * np.eye(4)
    massless = np.flatnonzero(~mass.any(axis=1))
    if not len(massless):
        return ""
    told = ", ".join(f"coordinate {place} of node {node}" for node, place in _nodes_of(mbs, massless))
    return f"the mass matrix is singular: {told} has neither mass nor inertia"


def _nodes_of(mbs: Any, coordinates: Any) -> list[tuple[int, int]]:
    starts = [
        (mbs.GetNodeODE2Index(node), node)
        for node in range(mbs.systemData.NumberOfNodes())
        if len(mbs.systemData.GetNodeLTGODE2(node))
    ]
    found = []
    for coordinate in coordinates:
        start, node = max(pair for pair in starts if pair[0] <= coordinate)
        found.append((int(node), int(coordinate - start)))
    return found
