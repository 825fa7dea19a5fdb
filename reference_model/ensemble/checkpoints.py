"""Checkpoints of a trajectory on its way, from which :mod:`recording` finds the motion.

A kernel that is given room for them takes one wherever slip begins or ends, and one at the start of each step in
which a time lies that is asked for: from there that time is no more than a step away.
"""

from __future__ import annotations

from functools import cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from reference_model.systems import FloatArray

NONE, ON_THE_WAY, SLIPS, STICKS = 0.0, 1.0, 2.0, 3.0
"""Kinds: room left over; nothing begins here; slip does; stick does."""

LENGTH, RATE, STEP, SHORT, SPAN = range(5)
"""What is kept of the pace of a trajectory, so that one from a checkpoint takes the steps that it would have taken.

The unit of length in m and one over that of time in 1/s, > 0; the step, how many of the last were short, and how long
an implicit one may be, as lanes have them.
"""

Checkpoints = NDArray[Any]
"""Records, shape (n,), of ``kind``, ``time`` in s, ``state`` in SI units and ``pace``, zeros where a phase begins.

And the times ``asked`` for: they increase, and do not belong to the record in which they stand.
"""


def room_for(n: int, state_size: int, asked: FloatArray | tuple[()] = ()) -> Checkpoints:
    """Return room for ``n`` checkpoints, none of them taken; ``asked``, (up to n,), are the times asked for, in s."""
    room = np.zeros(n, dtype=_layout(state_size))
    room["asked"] = np.inf
    room["asked"][: len(asked)] = asked
    return room


def from_the_start() -> FloatArray:
    """Return the pace of trajectories that do not begin at a checkpoint, shape (1, 5)."""
    return np.zeros((1, SPAN + 1))


@cache
def _layout(state_size: int) -> np.dtype[Any]:
    fields = [
        ("kind", float), ("time", float), ("state", float, (state_size,)), ("pace", float, (SPAN + 1,)),
        ("asked", float),
    ]  # fmt: skip
    return np.dtype(fields, align=True)
