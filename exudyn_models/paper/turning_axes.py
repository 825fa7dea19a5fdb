"""Axes that turn about the master disc's axis. A sticking body rests in axes that turn with the disc."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from exudyn_models.solver.solver_run import Steps
from reference_model.systems import FloatArray

ComplexArray = NDArray[np.complex128]


@dataclass(frozen=True)
class Axes:
    """Axes that turn with ``speed`` (rad/s) and coincide with the fixed ones at the time ``since`` (s)."""

    speed: float
    since: float = 0.0

    def start(self, state: FloatArray) -> FloatArray:
        """Transform a state, shape (4,) or (6,), at the time ``since`` to these axes."""
        return np.asarray(self._added(np.zeros(1), state[None, :], -self.speed)[0])

    def fixed_states(self, times: FloatArray, states: FloatArray) -> FloatArray:
        """Transform ``states``, shape (n, 4 or 6), at ``times``, shape (n,), to fixed axes."""
        return self._added(self.speed * (times - self.since), states, self.speed)

    def fixed_steps(self, steps: Steps) -> Steps:
        """Transform ``steps`` to fixed axes."""
        z, v, a = (_complex(part) for part in (*np.split(steps.states, 2, axis=1), steps.accelerations))
        turn = np.exp(1j * self.speed * (steps.times - self.since))
        accelerations = steps.accelerations.copy()
        fixed = turn * (a + 2j * self.speed * v - self.speed**2 * z)
        accelerations[:, 0], accelerations[:, 1] = fixed.real, fixed.imag
        return Steps(
            steps.times, self.fixed_states(steps.times, steps.states), accelerations, steps.evaluations
        )

    def _added(self, angles: FloatArray, states: FloatArray, speed: float) -> FloatArray:
        """Return ``states`` with an added rotation through ``angles``, shape (n,), at ``speed`` (rad/s)."""
        positions, velocities = (part.copy() for part in np.split(states, 2, axis=1))
        turn = np.exp(1j * angles)
        z, v = turn * _complex(positions), turn * _complex(velocities)
        v = v + 1j * speed * z
        positions[:, 0], positions[:, 1], velocities[:, 0], velocities[:, 1] = z.real, z.imag, v.real, v.imag
        positions[:, 2:] += angles[:, None]
        velocities[:, 2:] += speed
        return np.hstack((positions, velocities))


FIXED = Axes(0.0)


def _complex(vectors: FloatArray) -> ComplexArray:
    return np.asarray(vectors[:, 0] + 1j * vectors[:, 1])
