"""Checkpoints of a trajectory; :mod:`recording` computes the motion from them.

A kernel takes one where slip begins or ends, and at the start of each step that contains a requested time.
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
"""Indices of the pace of a trajectory, which lets a continuation take the same steps as the original.

They are the unit of length in m, the inverse unit of time in 1/s (> 0), the step, the number of recent short steps,
and the length of an implicit step, all as in lanes.
"""

Checkpoints = NDArray[Any]
"""Records, shape (n,), of ``kind``, ``time`` in s, ``state`` in SI units and ``pace``, zeros where a phase begins.

Independently of these, they store the increasing ``requested`` times.
"""


def empty_checkpoints(n: int, state_size: int, requested: FloatArray | tuple[()] = ()) -> Checkpoints:
    """Return ``n`` checkpoints, none of them taken, with up to n ``requested`` times in s."""
    room = np.zeros(n, dtype=_layout(state_size))
    room["requested"] = np.inf
    room["requested"][: len(requested)] = requested
    return room


def from_the_start() -> FloatArray:
    """Return the pace of trajectories that do not begin at a checkpoint, shape (1, 5)."""
    return np.zeros((1, SPAN + 1))


@cache
def _layout(state_size: int) -> np.dtype[Any]:
    fields = [
        ("kind", float), ("time", float), ("state", float, (state_size,)), ("pace", float, (SPAN + 1,)),
        ("requested", float),
    ]  # fmt: skip
    return np.dtype(fields, align=True)
