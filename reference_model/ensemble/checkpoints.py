"""Checkpoints of a trajectory on its way, from which :mod:`recording` finds the motion.

A kernel that is given room for them takes one every so often, at the end of a step, and wherever slip begins or ends.
"""

from __future__ import annotations

from functools import cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

NONE, ON_THE_WAY, SLIPS, STICKS = 0.0, 1.0, 2.0, 3.0
"""Kinds: room left over; nothing begins here; slip does; stick does."""

EVERY = 1.0
"""From checkpoint to checkpoint, in units of time: a few steps."""

Checkpoints = NDArray[Any]
"""Records of ``kind``, ``time`` in s and ``state`` in SI units, shape (n,)."""


def room_for(n: int, state_size: int) -> Checkpoints:
    """Return room for ``n`` checkpoints, none of them taken."""
    return np.zeros(n, dtype=_layout(state_size))


@cache
def _layout(state_size: int) -> np.dtype[Any]:
    return np.dtype([("kind", float), ("time", float), ("state", float, (state_size,))], align=True)
