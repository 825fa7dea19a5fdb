"""Checkpoints of a trajectory; :mod:`recording` computes the motion from them.

A kernel with room for checkpoints takes one where slip begins or ends, and one at the start of each step that
contains a requested time. So each requested time is at most one step after a checkpoint.
"""

from __future__ import annotations

from functools import cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from reference_model.systems import FloatArray

NONE, ON_THE_WAY, SLIPS, STICKS = 0.0, 1.0, 2.0, 3.0
"""Kinds: unused room; no phase begins; slip begins; stick begins."""

LENGTH, RATE, STEP, SHORT, SPAN = range(5)
"""Indices of the pace of a trajectory, which makes a continuation take the same steps as the original.

They are the unit of length in m, the inverse unit of time in 1/s (> 0), the step, the number of recent short steps,
and the length of an implicit step, all as in lanes.
"""

Checkpoints = NDArray[Any]
"""Records, shape (n,), of ``kind``, ``time`` in s, ``state`` in SI units and ``pace``, zeros where a phase begins.

They also store the increasing times ``asked`` for, which are independent of the other fields of their record.
"""


def room_for(n: int, state_size: int, asked: FloatArray | tuple[()] = ()) -> Checkpoints:
    """Return room for ``n`` checkpoints, none of them taken; ``asked``, up to (n,), are the requested times in s."""
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
