"""Mass, stiffness and damping of an assembled model, by Exudyn's own derivatives."""

from __future__ import annotations

from typing import Any

import exudyn as exu
import numpy as np

from exudyn_models.solver.solver_run import quiet
from reference_model.systems import FloatArray


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


def singular_mass(mbs: Any) -> str:
    """Return in words which coordinates of an assembled model have no mass, an empty string if all have."""
    solver: Any = exu.MainSolverStatic()
    settings = exu.SimulationSettings()
    settings.solution.file.write = settings.solution.sensors.active = False
    size = mbs.systemData.ODE2Size()
    with quiet():
        solver.InitializeSolver(mbs, settings)
        solver.ComputeMassMatrix(mbs)
        mass = np.array(solver.GetSystemMassMatrix())[:size, :size]
        solver.FinalizeSolver(mbs, settings)
    for node in range(mbs.systemData.NumberOfNodes()):
        if mbs.GetNode(node)["nodeType"] == "RigidBodyEP":  # a constraint holds the norm, in place of inertia
            first = mbs.GetNodeODE2Index(node) + 3
            rotation = mass[first : first + 4, first : first + 4]
            rotation += rotation.any() * np.eye(4)
    massless = np.flatnonzero(~mass.any(axis=1))
    if not len(massless):
        return ""
    told = ", ".join(f"coordinate {place} of node {node}" for node, place in _nodes_of(mbs, massless))
    return f"the mass matrix is singular: {told} has neither mass nor inertia"


def _nodes_of(mbs: Any, coordinates: Any) -> list[tuple[int, int]]:
    """Return the node of each of a model's coordinates of second order, and which of its own it is."""
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
