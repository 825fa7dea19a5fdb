"""The recorded states of a motion in turning and fixed axes, and the steps that determine its phases."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from exudyn_models.paper.creep import RegularisedContact
from exudyn_models.paper.dense_output import states_at
from exudyn_models.paper.phase_detection import detected_phases, essential_steps
from exudyn_models.solver.solver_run import Steps
from reference_model.systems import FloatArray
from reference_model.trajectory import Phase

ComplexArray = NDArray[np.complex128]


@dataclass(frozen=True)
class Axes:
    """Axes that turn with ``speed`` (rad/s) and coincide with the fixed axes at the time ``since`` (s).

    A sticking body rests in axes that turn with the master disc.
    """

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


MOST_KEPT = 50_000
"""Largest number of stored steps; beyond it, steps without information about phases are dropped."""


class Recording:
    """Records consecutive runs of a motion at requested ``times``, shape (n,), from the start on."""

    def __init__(self, contact: RegularisedContact, times: FloatArray) -> None:
        self.times, self.states = times, np.empty((len(times), contact.system.state_size))
        self.steps = self.evaluations = 0
        self._contact, self._recorded = contact, 0
        self._kept: list[Steps] = []

    @property
    def finished(self) -> bool:
        """True if all times are recorded."""
        return self._recorded == len(self.times)

    def add(self, run: Steps, axes: Axes) -> None:
        """Record a run in ``axes``, which starts where the previous run ended."""
        stop = int(np.searchsorted(self.times, run.times[-1], side="right"))
        asked = slice(self._recorded, stop)
        self.states[asked] = axes.fixed_states(self.times[asked], states_at(run, self.times[asked]))
        self._recorded = max(stop, self._recorded)
        self.steps += len(run.times) - 1
        self.evaluations += run.evaluations
        self._kept.append(axes.fixed_steps(run))
        if sum(len(kept.times) for kept in self._kept) > MOST_KEPT:
            whole = _joined(self._kept)
            self._kept = [whole.only(essential_steps(self._contact, whole))]

    def phases(self) -> tuple[Phase, ...]:
        """Return the phases from the first to the last step."""
        return detected_phases(self._contact, _joined(self._kept))


def _joined(runs: list[Steps]) -> Steps:
    first, *rest = runs
    return Steps(
        np.concatenate([first.times, *(run.times[1:] for run in rest)]),
        np.concatenate([first.states, *(run.states[1:] for run in rest)]),
        np.concatenate([first.accelerations, *(run.accelerations[1:] for run in rest)]),
        sum(run.evaluations for run in runs),
    )
