"""Results of an ensemble."""

from __future__ import annotations

from dataclasses import dataclass
from enum import IntEnum
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from reference_model.systems import FloatArray


class EndState(IntEnum):
    """The long-term motion of a trajectory.

    ``SELF_CENTRED``: a sliding equilibrium. ``STUCK``: permanent stick, also as the limit of ever shorter slips.
    ``WHIRL``: a circle about the axis or, with an offset, a closed orbit without stick. ``MODULATED``: a whirl whose
    radius oscillates slowly (discs only). ``STICK_SLIP``: repeated stick and slip.
    """

    UNDECIDED = 0
    SELF_CENTRED = 1
    WHIRL = 2
    MODULATED = 3
    STUCK = 4
    STICK_SLIP = 5


UNDECIDED, SELF_CENTRED, WHIRL, MODULATED, STUCK, STICK_SLIP = (int(end) for end in EndState)
"""The end states as integers, for compiled code."""

HANDED_OVER = 255
"""Marker instead of an end state where compiled code hands the motion over, see :mod:`.disc.driver`."""


@dataclass(frozen=True, eq=False)
class Ensemble:
    """End states of n trajectories, in arrays of shape (n,).

    Parameters
    ----------
    end
        End state, as :class:`EndState`.
    time
        Time in s at which it was certain, or the duration; less for a trajectory that was given up.
    states : array of shape (n, 4) or (n, 6)
        State at that time.
    least_radius, largest_radius
        Range of the radius in the end state, in m; NaN if undecided.
    slip_power
        Mean power of friction in the end state, in W; NaN if undecided.
    steps
        Number of steps, including rejected ones, and of stick phases.

    """

    end: NDArray[np.uint8]
    time: FloatArray
    states: FloatArray
    least_radius: FloatArray
    largest_radius: FloatArray
    slip_power: FloatArray
    steps: NDArray[np.int64]

    def __post_init__(self) -> None:
        for array in vars(self).values():
            array.flags.writeable = False


class Results(NamedTuple):
    """Output arrays of compiled code: ends, times and steps (n,), states (n, 4 or 6), measures (n, 3).

    The measures are the smallest and the largest radius in m and the mean slip speed in m/s.
    """

    ends: NDArray[np.uint8]
    times: FloatArray
    states: FloatArray
    measures: FloatArray
    steps: NDArray[np.int64]

    def ensemble(self, friction_force: float | FloatArray) -> Ensemble:
        """Return the results as an :class:`Ensemble`; ``friction_force`` in N has the shape () or (n,)."""
        least, largest, slip = self.measures.T
        return Ensemble(self.ends, self.times, self.states, least, largest, slip * friction_force, self.steps)

    @classmethod
    def empty(cls, n: int, state_size: int) -> Results:
        """Return arrays for ``n`` trajectories."""
        return cls(
            np.zeros(n, dtype=np.uint8),
            np.zeros(n),
            np.zeros((n, state_size)),
            np.zeros((n, 3)),
            np.zeros(n, dtype=np.int64),
        )
