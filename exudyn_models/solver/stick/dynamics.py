"""Equations of motion of an assembled model at its present state.

The accelerations a and constraint forces λ satisfy M·a + Jᵀ·λ = h and J·a = c. Here c contains prescribed motions and
the rate of J, which Exudyn's own initial accelerations neglect: TrapezoidalIndex2 would carry that error from step to
step, as forces that alternate.
"""

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from exudyn_models.solver.items import CURRENT
from exudyn_models.solver.starting_rates import initialised_solver
from exudyn_models.solver.stick.slip_motion import rate_of_rotation_vector
from reference_model.systems import FloatArray

DIFFERENCE = 1e-2
"""Share of a step between the times of a forward difference of third order; later times see no kink before them."""

SINGULAR = 1e10
"""Largest element of the inverse of scaled equations whose constraints are independent."""

LIGHT = 1e-7
"""Largest mass of an Euler parameter, relative to its coupling with others, that may be a rounding error."""

CONSISTENT = 1e-6
"""Largest violation of a constraint by velocities, relative to the terms in its sum."""

KEPT = 8
"""Number of inverses to keep; rotors need only one for each set of constraints."""


class Dynamics:
    """Equations of motion of a model in a run with steps of ``step`` (s).

    ``evaluate`` stores the mass matrix M, shape (n, n), the gradients J of all active constraints, shape (m, n), the
    rates c that they prescribe, shape (m,), and the inverse of the equations, shape (n + m, n + m).
    """

    def __init__(self, mbs: Any, t: float, step: float) -> None:
        self._mbs, self._data, self.difference = mbs, mbs.systemData, DIFFERENCE * step
        with initialised_solver(mbs, t) as solver:
            self.solver = solver
        self._size, self._count = self._data.ODE2Size(), self._data.AEsize()
        self._rotations = [
            (self._data.GetNodeLTGODE2(node)[3:6], mbs.GetNode(node)["referenceCoordinates"][3:])
            for node in range(self._data.NumberOfNodes())
            if mbs.GetNode(node)["nodeType"] == "RigidBodyRotVecLG"
        ]
        self.mass = self.inverse = np.empty((0, 0))
        self._inverses: dict[tuple[bytes, bytes], FloatArray] = {}
        self.gradients, self.rates = np.empty((0, self._size)), np.empty(0)

    def evaluate(self, t: float, without: Sequence[int] | NDArray[Any] = ()) -> None:
        """Evaluate M, J, c and the inverse at the present state and the time t (s), ``without`` some constraints."""
        data, size, solver = self._data, self._size, self.solver
        data.SetTime(t)
        solver.ComputeMassMatrix(self._mbs)
        self.mass = np.array(solver.GetSystemMassMatrix())[:size, :size]
        if len(without) < self._count:
            solver.SetSystemJacobian(np.zeros((data.SystemSize(), data.SystemSize())))
            solver.ComputeJacobianAE(self._mbs, 1.0, 1.0, 1.0)
            self.gradients = np.array(solver.GetSystemJacobian())[-self._count :, :size]
            self.gradients[list(without)] = 0.0
            self.rates = self._prescribed_rates(t) if self.gradients.any() else np.zeros(self._count)
        else:
            self.gradients, self.rates = np.zeros((self._count, size)), np.zeros(self._count)
        key = self.mass.tobytes(), self.gradients.tobytes()
        if key not in self._inverses:
            if len(self._inverses) == KEPT:
                self._inverses.clear()
            self._inverses[key] = inverse_of(self.mass, self.gradients)
        self.inverse = self._inverses[key]

    def _prescribed_rates(self, t: float) -> FloatArray:
        """Return c, from the slips of all constraints a little later at the present velocities."""
        data = self._data
        q, velocities = data.GetODE2Coordinates(), self.coordinate_rates()
        slips = []
        for i in range(4):
            data.SetODE2Coordinates(q + i * self.difference * velocities)
            data.SetTime(t + i * self.difference)
            slips.append(self._slips_of_constraints())
            if i == 1 and (slips[0] == slips[1]).all():  # bit by bit, so they depend on nothing
                break
        data.SetODE2Coordinates(q)
        data.SetTime(t)
        if len(slips) == 2:
            return np.zeros(self._count)
        rates = np.array([11.0, -18.0, 9.0, -2.0]) @ np.array(slips) / (6.0 * self.difference)
        return np.where(self.gradients.any(axis=1), rates, 0.0)

    def _slips_of_constraints(self) -> FloatArray:
        self.solver.ComputeAlgebraicEquations(self._mbs, True)
        return np.array(self.solver.GetSystemResidual())[-self._count :]

    def prescribed_speeds(self, times: FloatArray) -> FloatArray:
        """Return the speeds that constraints prescribe at ``times`` in s, shape (len(times), m)."""
        data = self._data
        velocities, now = data.GetODE2Coordinates_t(), data.GetTime(CURRENT)
        data.SetODE2Coordinates_t(np.zeros(self._size))
        speeds = []
        for t in times:
            data.SetTime(t)
            speeds.append(-self._slips_of_constraints())
        data.SetODE2Coordinates_t(velocities)
        data.SetTime(now)
        return np.array(speeds)

    def violation(self) -> FloatArray:
        """Return the change of the velocities, shape (n,), that lets them satisfy all constraints, or zeros.

        Bodies change their velocities as in an impact on these constraints.
        """
        if not self.gradients.any():
            return np.zeros(self._size)
        slips = self._slips_of_constraints()
        rounding = CONSISTENT * np.abs(self.gradients) @ np.abs(self._data.GetODE2Coordinates_t())
        if (np.abs(slips) <= rounding).all():
            return np.zeros(self._size)
        return self.inverse[: self._size, self._size :] @ -slips

    def coordinate_rates(self) -> FloatArray:
        """Return the derivatives of the coordinates, which differ from the velocities for rotation vectors."""
        q, rates = self._data.GetODE2Coordinates(), self._data.GetODE2Coordinates_t()
        for places, reference in self._rotations:
            rates[places] = rate_of_rotation_vector(q[places] + reference, rates[places])
        return np.asarray(rates)

    def forces(self) -> FloatArray:
        """Return h, shape (n,), at the present state, constraint forces and time."""
        self.solver.ComputeODE2RHS(self._mbs)
        return np.array(self.solver.GetSystemResidual())[: self._size]

    def solution(self, forces: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return accelerations, shape (n,), and constraint forces, shape (m,), under generalised ``forces``."""
        found = self.inverse @ np.concatenate((forces, self.rates))
        return found[: self._size], found[self._size :]

    def store(self, accelerations: FloatArray, constraints: FloatArray) -> None:
        """Take accelerations and constraint forces as the present ones."""
        self._data.SetODE2Coordinates_tt(accelerations)
        self._data.SetAECoordinates(constraints)


def inverse_of(mass: FloatArray, gradients: FloatArray) -> FloatArray:
    """Return the inverse of [[M, Jᵀ], [J, 0]]; constraints without a gradient have no force.

    If constraints depend on each other, it is the pseudoinverse of the scaled equations, whose forces are smallest.
    """
    active = gradients.any(axis=1)
    scale = np.sqrt(mobilities(mass))
    slips = gradients[active] * scale
    lengths = np.linalg.norm(slips, axis=1)
    slips /= lengths[:, None]
    size, masses = len(mass), scale[:, None] * mass * scale
    system = np.zeros((size + len(slips), size + len(slips)))
    system[:size, :size], system[size:, :size], system[:size, size:] = masses, slips, slips.T
    try:
        found = np.linalg.inv(system)
    except np.linalg.LinAlgError:
        found = np.full((1, 1), np.inf)
    if not np.abs(found).max(initial=0.0) < SINGULAR:
        found = np.linalg.pinv(system, rcond=1.0 / SINGULAR, hermitian=True)
    places = np.concatenate((np.ones(size, dtype=bool), active))
    scale = np.concatenate((scale, 1.0 / lengths))
    inverse = np.zeros((len(places), len(places)))
    inverse[np.ix_(places, places)] = scale[:, None] * found * scale
    return inverse


def mobilities(mass: FloatArray) -> FloatArray:
    """Return the inverse of each mass, shape (n,); the smallest mass replaces masses that are zero."""
    masses = np.diag(mass)
    heavy = masses > LIGHT * np.abs(mass).max(axis=1, initial=0.0)
    return np.asarray(1.0 / np.where(heavy, masses, np.min(masses, where=heavy, initial=np.inf)))
