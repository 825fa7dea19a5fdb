"""What an ensemble comes to."""

from __future__ import annotations

from dataclasses import dataclass
from enum import IntEnum
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from reference_model.systems import FloatArray


class EndState(IntEnum):
    """The motion that a trajectory ends in.

    It is the motion that a trajectory tends to. ``SELF_CENTRED``: an equilibrium that slips (section 2). ``STUCK``:
    turning with the master disc for ever, also where ever shorter slips lead there like one over the time.
    ``WHIRL``: on a circle about the axis or, with an offset, on a closed orbit without stick. ``MODULATED``: a whirl
    whose radius swings slowly (section 4; discs only). ``STICK_SLIP``: it sticks and slips again and again.
    ``UNDECIDED``: none for certain.
    """

    UNDECIDED = 0
    SELF_CENTRED = 1
    WHIRL = 2
    MODULATED = 3
    STUCK = 4
    STICK_SLIP = 5


UNDECIDED, SELF_CENTRED, WHIRL, MODULATED, STUCK, STICK_SLIP = (int(end) for end in EndState)
"""As compiled code takes them."""

HANDED_OVER = 255
"""In place of an end state: compiled code does not follow the motion any further, see :mod:`.disc.driver`."""


@dataclass(frozen=True, eq=False)
class Ensemble:
    """The ends of n trajectories.

    Parameters
    ----------
    end : array of shape (n,)
        :class:`EndState`.
    time : array of shape (n,)
        In s: when that was certain, or the duration; less where a trajectory was given up, undecided.
    states : array of shape (n, 4) or (n, 6)
        At that time.
    least_radius, largest_radius : array of shape (n,)
        Of the end state, in m; NaN where it is undecided.
    slip_power : array of shape (n,)
        Mean power of friction in W in the end state; NaN where it is undecided.
    steps : array of shape (n,)
        Steps of the integrator, rejected ones included, and legs of stick.

    """

    end: NDArray[np.uint8]
    time: FloatArray
    states: FloatArray
    least_radius: FloatArray
    largest_radius: FloatArray
    slip_power: FloatArray
    steps: NDArray[np.int64]

    def __post_init__(self) -> None:
        """Make the arrays read-only: a result does not change."""
        for array in vars(self).values():
            array.flags.writeable = False


class Results(NamedTuple):
    """Where compiled code puts results: arrays (n,), states (n, 4 or 6), measures (n, 3).

    The measures are the least and the largest radius in m and the mean slip speed in m/s: power per friction force.
    """

    ends: NDArray[np.uint8]
    times: FloatArray
    states: FloatArray
    measures: FloatArray
    steps: NDArray[np.int64]

    def ensemble(self, friction_force: float | FloatArray) -> Ensemble:
        """Return them as Python has them; ``friction_force`` in N, shape () or (n,)."""
        least, largest, slip = self.measures.T
        return Ensemble(self.ends, self.times, self.states, least, largest, slip * friction_force, self.steps)

    @classmethod
    def empty(cls, n: int, state_size: int) -> Results:
        """Return room for ``n`` trajectories."""
        return cls(
            np.zeros(n, dtype=np.uint8),
            np.zeros(n),
            np.zeros((n, state_size)),
            np.zeros((n, 3)),
            np.zeros(n, dtype=np.int64),
        )
