"""The motion of a single trajectory at any times, from the checkpoints of a compiled run.

The state at some time is that of a short trajectory of its own, from the last checkpoint before it, that of the step
in which it lies: it goes on with the pace of the whole, so that it takes no more than that step, cut short. Those of
all times run side by side in lanes, and end where they should as every trajectory does. So the motion does not depend
on the times that are asked for, and its error is the same at all of them.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np

from reference_model.ensemble.checkpoints import (
    NONE,
    ON_THE_WAY,
    SLIPS,
    Checkpoints,
    from_the_start,
    room_for,
)
from reference_model.ensemble.end_states import HANDED_OVER, Results
from reference_model.motion.stepper import Kind
from reference_model.systems import FloatArray
from reference_model.trajectory import SimulationError, Trajectory

Runs = Callable[[FloatArray, FloatArray, FloatArray, Checkpoints], Results]
"""Takes starts (n, 4 or 6), paces (n, 5) as of checkpoints, durations in s (n,) and room for checkpoints of a single
one; runs them all."""

ROOM_TO_SPARE = 64
"""Checkpoints that there is room for at first besides those of all times: where phases begin."""

ROUNDED = 1e-12
"""Share of a duration, or of the unit of time if that is longer, that is rounding of times."""

STAGES = 12
"""Evaluations of the equations of motion in a step."""


@dataclass
class Recording:
    """A motion under way from t = 0 on.

    Parameters
    ----------
    times : array of shape (n,)
        Those that are asked for, in s, not negative.
    states : array of shape (n, 4) or (n, 6)
        At these times, as far as the motion has come.
    duration, unit : float
        Of the motion, and of time, in s.
    phases : list of (kind, start, state)
        So far.
    steps, evaluations : int
        So far, as in ``Solution``, with rejected steps and legs of stick.

    """

    times: FloatArray
    states: FloatArray
    duration: float
    unit: float
    phases: list[tuple[Kind, float, FloatArray]] = field(default_factory=list)
    steps: int = 0
    evaluations: int = 0

    @property
    def _rounding(self) -> float:
        """Of times, in s."""
        return ROUNDED * max(self.duration, self.unit)

    def follow(self, one: Runs, many: Runs, state: FloatArray, since: float) -> Results:
        """Take up the motion from ``state`` at ``since`` as far as ``one`` goes; return what that comes to.

        ``many`` goes from checkpoints to times. Raises ``SimulationError`` if one of them is given up.
        """
        # A copy, which may be written to: the kernel is compiled for such arrays, and not once more for others.
        start, left = state.copy()[np.newaxis], np.array([self.duration - since])
        asked = self.times[self.times >= since] - since
        room = len(asked) + ROOM_TO_SPARE
        while True:
            checkpoints = room_for(room, len(state), asked)
            end = one(start, from_the_start(), left, checkpoints)
            taken = int(np.count_nonzero(checkpoints["kind"] != NONE))
            if taken < room:
                break
            room *= 2  # once more from the start: the motion does not depend on the room
        until = since + float(end.times[0])
        if end.ends[0] != HANDED_OVER:
            self._require_end(end, left, since)
            until = self.duration
        checkpoints = checkpoints[:taken]
        checkpoints["time"] += since
        self._sample(many, checkpoints, until)
        for checkpoint in checkpoints[checkpoints["kind"] != ON_THE_WAY]:
            kind: Kind = "slip" if checkpoint["kind"] == SLIPS else "stick"
            self._enter(kind, float(checkpoint["time"]), checkpoint["state"])
        self._count(end)
        return end

    def take(self, motion: Trajectory) -> None:
        """Take over a part of the motion as the plain reference has it, at all times of this in its span."""
        asked = (self.times >= motion.times[0]) & (self.times <= motion.times[-1])
        self.states[asked] = motion.states[np.searchsorted(motion.times, self.times[asked])]
        for phase in motion.phases:
            self._enter(phase.kind, phase.start, phase.initial_state)
        self.steps += motion.solution.steps
        self.evaluations += motion.solution.evaluations

    def _sample(self, many: Runs, checkpoints: Checkpoints, until: float) -> None:
        """Find the states at the times from the first checkpoint up to ``until``."""
        asked = (self.times >= checkpoints["time"][0]) & (self.times <= until)
        if not np.any(asked):
            return
        before = checkpoints[np.searchsorted(checkpoints["time"], self.times[asked], side="right") - 1]
        durations = self.times[asked] - before["time"]
        starts, paces = np.ascontiguousarray(before["state"]), np.ascontiguousarray(before["pace"])
        ends = many(starts, paces, durations, checkpoints[:0])
        self._require_end(ends, durations, until)
        self.states[asked] = ends.states
        self.evaluations += STAGES * int(np.sum(ends.steps))

    def _require_end(self, results: Results, durations: FloatArray, since: float) -> None:
        short = results.times < durations - self._rounding
        if np.any(short):
            raise SimulationError(
                f"the compiled run gave up {since + float(np.min(results.times[short])):g} s after its start: too "
                "many steps, or the state is not finite; leave out compiled=True, or take a larger tolerance"
            )

    def _enter(self, kind: Kind, t: float, state: FloatArray) -> None:
        """Begin a phase of this kind, unless it is under way; one that lasts for no more than rounding is none.

        The reference begins with such a slip where it takes over a disc that already turns about a point.
        """
        if self.phases and t - self.phases[-1][1] <= self._rounding:
            t = self.phases.pop()[1]
        if not self.phases or self.phases[-1][0] != kind:
            self.phases.append((kind, t, state))

    def _count(self, results: Results) -> None:
        self.steps += int(results.steps[0])
        self.evaluations += STAGES * int(results.steps[0])
