"""The motion of a single trajectory at any times, from the checkpoints of a compiled run.

A short trajectory from the last checkpoint, with the same step, gives a requested state, so the motion does not
depend on the requested times.
"""

from collections.abc import Callable
from dataclasses import dataclass, field
from functools import partial

import numpy as np

from reference_model.ensemble.core.checkpoints import NONE, ON_THE_WAY, SLIPS, Checkpoints, empty_checkpoints
from reference_model.ensemble.end_states import HANDED_OVER, Results
from reference_model.ensemble.task import Task, in_threads
from reference_model.motion.stepper import Kind
from reference_model.systems import FloatArray
from reference_model.trajectory import LOOK_BACK, MOST_AHEAD, SimulationError, Trajectory

Runs = Callable[..., Results]
"""Runs a ``Task``, with room for the ``checkpoints`` of one of its trajectories."""

ROOM_TO_SPARE = 64
"""Initial number of checkpoints for the beginnings of phases."""

ROUNDED = 1e-12
"""Rounding error of times, as a share of the duration or the unit of time, whichever is longer."""

STAGES = 12

BRIEF = 200_000
"""Number of steps of a run in the thread of the caller, half a second of work; starting a thread costs a fifth of a
short run."""


@dataclass
class Recording:
    """A motion from t = 0 on, recorded at ``times`` >= 0 in s, shape (n,).

    ``states``, shape (n, 4) or (n, 6), is filled as far as computed. ``phases`` are (kind, start, state). ``steps``
    include rejected steps and stick phases. ``duration`` and ``rounding`` are in s.
    """

    times: FloatArray
    states: FloatArray
    duration: float
    rounding: float
    phases: list[tuple[Kind, float, FloatArray]] = field(default_factory=list)
    steps: int = 0
    evaluations: int = 0

    def follow(
        self, parameters: FloatArray, one: Runs, many: Runs, state: FloatArray, since: float
    ) -> Results:
        """Follow the motion from ``state`` at ``since`` as far as ``one`` goes; return its result.

        ``many`` runs from checkpoints to times. Raises ``SimulationError`` if one is given up.
        """
        # The kernel is compiled for writable arrays only.
        task = Task(parameters, state.copy()[np.newaxis], np.array([self.duration - since]))
        requested = self.times[self.times >= since] - since
        room = len(requested) + ROOM_TO_SPARE
        while True:
            checkpoints = empty_checkpoints(room, len(state), requested)
            brief = task._replace(most_rounds=np.full(1, BRIEF))
            end = one(brief, checkpoints)
            if brief.most_rounds[0] == 0:  # again, in a thread that Ctrl-C can stop
                self._require_few_steps(self.steps + BRIEF, since + float(end.times[0]))
                checkpoints = empty_checkpoints(room, len(state), requested)
                (end,) = in_threads([partial(one, checkpoints=checkpoints)], task, 1)
            taken = int(np.count_nonzero(checkpoints["kind"] != NONE))
            if taken < room:
                break
            room *= 2  # again from the start: the motion does not depend on the room
        until = since + float(end.times[0])
        if end.ends[0] != HANDED_OVER:
            self._require_end(end, task.durations, since)
            until = self.duration
        checkpoints = checkpoints[:taken]
        checkpoints["time"] += since
        self._sample(parameters, many, checkpoints, until)
        for checkpoint in checkpoints[checkpoints["kind"] != ON_THE_WAY]:
            kind: Kind = "slip" if checkpoint["kind"] == SLIPS else "stick"
            self._enter(kind, float(checkpoint["time"]), checkpoint["state"])
        self.steps += int(end.steps[0])
        self.evaluations += STAGES * int(end.steps[0])
        return end

    def take(self, motion: Trajectory) -> None:
        """Insert a part of the motion computed by the plain reference."""
        requested = (self.times >= motion.times[0]) & (self.times <= motion.times[-1])
        self.states[requested] = motion.states[np.searchsorted(motion.times, self.times[requested])]
        for phase in motion.phases:
            self._enter(phase.kind, phase.start, phase.initial_state)
        self.steps += motion.solution.steps
        if self.steps > LOOK_BACK:
            self._require_few_steps(self.steps, float(motion.times[-1]))
        self.evaluations += motion.solution.evaluations

    def _sample(self, parameters: FloatArray, many: Runs, checkpoints: Checkpoints, until: float) -> None:
        requested = (self.times >= checkpoints["time"][0]) & (self.times <= until)
        if not np.any(requested):
            return
        before = checkpoints[np.searchsorted(checkpoints["time"], self.times[requested], side="right") - 1]
        durations = self.times[requested] - before["time"]
        starts, paces = np.ascontiguousarray(before["state"]), np.ascontiguousarray(before["pace"])
        ends = many(Task(parameters, starts, durations, paces), checkpoints[:0])
        self._require_end(ends, durations, until)
        self.states[requested] = ends.states
        self.evaluations += STAGES * int(np.sum(ends.steps))

    def _require_few_steps(self, steps: int, until: float) -> None:
        if (self.duration - until) * steps > MOST_AHEAD * until:
            raise SimulationError(
                f"stopped {until:g} s after its start because more than {MOST_AHEAD:,} further steps are "
                "needed: the parameters are very stiff, or the motion is very long; simulate it in parts, or with a "
                "larger tolerance"
            )

    def _require_end(self, results: Results, durations: FloatArray, since: float) -> None:
        short = results.times < durations - self.rounding
        if np.any(short):
            raise SimulationError(
                f"the compiled run failed {since + float(np.min(results.times[short])):g} s after its start: too "
                "many steps, or a state that is not finite; omit compiled=True or use a larger tolerance"
            )

    def _enter(self, kind: Kind, t: float, state: FloatArray) -> None:
        """Begin a phase unless it is of the current kind; drop one that lasts no longer than rounding."""
        if self.phases and t - self.phases[-1][1] <= self.rounding:
            t = self.phases.pop()[1]
        if not self.phases or self.phases[-1][0] != kind:
            self.phases.append((kind, t, state))
