"""The result of a simulation, the same for every engine."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np

from reference_model.systems import FloatArray, System


class SimulationError(RuntimeError):
    """An engine gave up or returned numbers that are not finite; the message says when and what to change."""


MOST_STEPS = 5_000_000
"""Some minutes' work; a motion that takes more is hardly meant."""

LOOK_BACK, MOST_AHEAD = 20_000, 4 * MOST_STEPS
"""A motion is given up early if, at the pace of this many steps, it needs more than that many others."""


@dataclass
class StepCount:
    """Counts the steps of a motion from the time 0 to ``end``, in any unit of time.

    This is bookkeeping, no physics: every engine gives up at the same number of steps.
    """

    end: float
    steps: int = 0
    _looked_back: tuple[float, int] = (0.0, 0)

    def look_from(self, t: float) -> None:
        """Judge the pace from the time ``t`` on: what went before, or comes now, is slow for a short while only."""
        self._looked_back = t, self.steps

    def count(self, t: float) -> str:
        """Count one more step, to the time ``t``; return what is wrong if there are, or will be, too many."""
        self.steps += 1
        if self.steps > MOST_STEPS:
            return f"more than {MOST_STEPS:,} steps"
        since, counted = self._looked_back
        if self.steps == counted + LOOK_BACK:
            self.look_from(t)
            if (self.end - t) * LOOK_BACK > MOST_AHEAD * (t - since):
                return f"more than {MOST_AHEAD:,} steps ahead after {self.steps:,}"
        return ""


@dataclass(frozen=True)
class Phase:
    """A span of time in which the contact slips or sticks.

    ``initial_state`` is the state at ``start``; a phase ends where the next one starts. In a "pivot" phase one
    of several contact points rests on the master disc and the disc turns about it.
    """

    kind: Literal["slip", "pivot", "stick"]
    start: float
    end: float
    initial_state: FloatArray


def phases_of(
    begun: Sequence[tuple[Literal["slip", "pivot", "stick"], float, FloatArray]], end: float
) -> tuple[Phase, ...]:
    """Return the phases from their kinds, starts in s and first states; each lasts to the next one or to ``end``."""
    ends = [*(start for _, start, _ in begun[1:]), end]
    return tuple(
        Phase(kind, start, until, state) for (kind, start, state), until in zip(begun, ends, strict=True)
    )


@dataclass(frozen=True)
class Solution:
    """How a trajectory was computed.

    Parameters
    ----------
    method : str
        The integrator in words.
    tolerance : float
        The tolerance that was asked for.
    evaluations, steps : int
        Evaluations of the equations of motion, and accepted steps.
    wall_time : float
        In s.
    regularisation : float
        Slip speed ε in m/s below which friction is not full but μN·|w|/ε; 0 for exact Coulomb friction.

    """

    method: str
    tolerance: float
    evaluations: int
    steps: int
    wall_time: float
    regularisation: float = 0.0


NOT_TOLD = Solution("not told", tolerance=math.nan, evaluations=0, steps=0, wall_time=math.nan)
"""Of an engine that says nothing of how it computes."""


@dataclass(frozen=True, eq=False)
class Trajectory:
    """The motion of a system at the times that were asked for.

    Parameters
    ----------
    system : PinOnDisc or DiscOnDisc
        The parameters.
    times : array of shape (n,)
        In s.
    states : array of shape (n, 4) or (n, 6)
        Of a pin x, y in m and vx, vy in m/s; of a disc x, y, angle (rad), vx, vy, spin (rad/s).
    phases : tuple of Phase
        From ``times[0]`` to ``times[-1]``, without gaps; () where an engine does not tell them.
    solution : Solution
        How it was computed.

    """

    system: System
    times: FloatArray
    states: FloatArray
    phases: tuple[Phase, ...] = ()
    solution: Solution = NOT_TOLD

    def __post_init__(self) -> None:
        """Make the arrays read-only: a result does not change."""
        for array in (self.times, self.states):
            array.flags.writeable = False

    @property
    def at_end(self) -> FloatArray:
        """The last state, shape (4,) or (6,)."""
        return np.asarray(self.states[-1])

    @property
    def radius(self) -> FloatArray:
        """ρ of eq. 2 in m, shape (n,)."""
        return np.asarray(np.hypot(self.states[:, 0], self.states[:, 1]))

    @property
    def slip_velocity(self) -> FloatArray:
        """Velocity of the centre relative to the disc below, (ẋ + ωy, ẏ − ωx) in m/s, shape (n, 2)."""
        velocities = self.system.state_size // 2
        x, y = self.states.T[:2]
        vx, vy = self.states.T[velocities : velocities + 2]
        omega = self.system.disc_speed
        return np.column_stack((vx + omega * y, vy - omega * x))

    @property
    def slip_speed(self) -> FloatArray:
        """Magnitude of the slip velocity in m/s, shape (n,)."""
        return np.asarray(np.hypot(*self.slip_velocity.T))

    @property
    def stick_phases(self) -> tuple[Phase, ...]:
        """The phases in which pin or disc turn with the disc below."""
        return tuple(phase for phase in self.phases if phase.kind == "stick")

    @property
    def stick_times(self) -> FloatArray:
        """Times in s at which stick phases begin and end, one after the other, shape (2·phases,)."""
        return np.array([time for phase in self.stick_phases for time in (phase.start, phase.end)])
