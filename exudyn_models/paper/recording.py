"""The recorded states of a motion, and the steps that determine its phases."""

import numpy as np

from exudyn_models.paper.creep import RegularisedContact
from exudyn_models.paper.dense_output import states_at
from exudyn_models.paper.phase_detection import detected_phases, essential_steps
from exudyn_models.paper.turning_axes import Axes
from exudyn_models.solver.solver_run import Steps
from reference_model.systems import FloatArray
from reference_model.trajectory import Phase

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
        """Record a run in ``axes``, which starts where the previous one ended."""
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
