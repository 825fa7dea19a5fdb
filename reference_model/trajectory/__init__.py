"""The result of a simulation, in the same form for every engine."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Literal

import numpy as np

from reference_model.systems import FloatArray, require_system

if TYPE_CHECKING:
    from reference_model.trajectory.pictures import Figure, FuncAnimation


Kind = Literal["slip", "pivot", "stick"]
"""Kinds of phases."""


class SimulationError(RuntimeError):
    """An engine failed or returned non-finite numbers."""


MOST_STEPS = 5_000_000
"""Largest number of steps, some minutes of work."""

LOOK_BACK, MOST_AHEAD = 20_000, 4 * MOST_STEPS
"""Number of steps between measurements of the pace, and largest number that may remain at the last pace."""


@dataclass
class StepCount:
    """Count the steps of a motion from time 0 to ``end``; all engines share the limit."""

    end: float
    steps: int = 0
    _looked_back: tuple[float, int] = (0.0, 0)

    def look_from(self, t: float) -> None:
        """Measure the pace from the time ``t`` on."""
        self._looked_back = t, self.steps

    def count(self, t: float) -> str:
        """Count a step that ends at ``t``; return a message if there are or will be too many, else ""."""
        return self.reach(self.steps + 1, t)

    def reach(self, steps: int, t: float) -> str:
        """Like :meth:`count`, for the number of ``steps`` up to ``t``."""
        self.steps = steps
        if steps > MOST_STEPS:
            return f"more than {MOST_STEPS:,} steps are needed"
        since, counted = self._looked_back
        if steps >= counted + LOOK_BACK:
            self.look_from(t)
            if (self.end - t) * (steps - counted) > MOST_AHEAD * (t - since):
                return f"more than {MOST_AHEAD:,} further steps are needed"
        return ""


@dataclass(frozen=True)
class Phase:
    """A time span of slip, stick or pivoting, which ends where the next span starts.

    ``initial_state`` is the state at ``start``. In a "pivot" phase the disc turns about a resting contact point.
    """

    kind: Kind
    start: float
    end: float
    initial_state: FloatArray


def phases_of(begun: Sequence[tuple[Kind, float, FloatArray]], end: float) -> tuple[Phase, ...]:
    """Return the phases for their kinds, starts in s and first states; the last phase lasts until ``end``."""
    ends = [*(start for _, start, _ in begun[1:]), end]
    return tuple(
        Phase(kind, start, until, state) for (kind, start, state), until in zip(begun, ends, strict=True)
    )


@dataclass(frozen=True)
class Solution:
    """How a trajectory was computed.

    ``evaluations`` counts evaluations of the equations of motion, ``steps`` accepted steps, and ``wall_time`` is in
    s. ``regularisation`` is the slip speed ε in m/s below which friction is μN·|w|/ε; 0 for exact Coulomb friction.
    """

    method: str
    tolerance: float
    evaluations: int
    steps: int
    wall_time: float
    regularisation: float = 0.0


NOT_TOLD = Solution("not told", tolerance=math.nan, evaluations=0, steps=0, wall_time=math.nan)
"""Placeholder for an engine that does not report how it computes."""


@dataclass(frozen=True, eq=False)
class Trajectory:
    """The motion of a system at the requested times.

    ``times``, shape (n,), are in s. ``states``, shape (n, 4) or (n, 6), are x, y in m and vx, vy in m/s of a pin, or
    x, y, angle (rad), vx, vy, spin (rad/s) of a disc; a joint has shape (n, 2), its angle and spin. ``phases`` cover
    all times without gaps; () if the engine reports none. Slip velocities and pictures exist for pins and discs only.
    """

    system: Any  # a ``System`` or a ``FrictionJoint``
    times: FloatArray
    states: FloatArray
    phases: tuple[Phase, ...] = ()
    solution: Solution = NOT_TOLD

    def __post_init__(self) -> None:
        for name in ("times", "states"):
            array = np.asarray(getattr(self, name))
            array.flags.writeable = False
            object.__setattr__(self, name, array)

    @property
    def at_end(self) -> FloatArray:
        """Last state, shape (4,) or (6,)."""
        return np.asarray(self.states[-1])

    @property
    def radius(self) -> FloatArray:
        """ρ of eq. 2 in m, shape (n,)."""
        return np.asarray(np.hypot(self.states[:, 0], self.states[:, 1]))

    @property
    def slip_velocity(self) -> FloatArray:
        """Velocity of the centre relative to the master disc, (ẋ + ωy, ẏ − ωx) in m/s, shape (n, 2)."""
        require_system(self.system)
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
        """Phases of rotation with the master disc."""
        return tuple(phase for phase in self.phases if phase.kind == "stick")

    @property
    def stick_times(self) -> FloatArray:
        """Alternating start and end times of the stick phases in s, shape (2·phases,)."""
        return np.array([time for phase in self.stick_phases for time in (phase.start, phase.end)])

    def plot(self, figure: Figure | None = None) -> Figure:
        """Draw the path in the plane and radius, slip speed and spin over time; stick phases are shaded.

        ``figure`` is the matplotlib figure, None for a new figure. Raises ``ModuleNotFoundError`` without matplotlib.
        """
        from reference_model.trajectory.pictures import figure_of

        spans = self.stick_times.reshape(-1, 2)
        return figure_of(self.system, self.times, self.states, self.slip_speed, spans, figure)

    def animate(
        self, *, places: Iterable[tuple[float, ...]] | None = None, speed: float = 1.0
    ) -> FuncAnimation:
        """Return an animation; save it with ``.save("motion.gif")`` or show it in a notebook by ``.to_jshtml()``.

        ``speed`` is in simulated seconds per second. ``places`` are the contact points of :class:`Points`, which a
        trajectory does not store. Raises ``ModuleNotFoundError`` without matplotlib.
        """
        from reference_model.trajectory.pictures import animation_of

        require_system(self.system)
        return animation_of(self.system, self.times, self.states, places, speed)
