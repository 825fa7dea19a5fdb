"""Checkpoints of a trajectory: where slip begins or ends, and before requested times.

:mod:`reference_model.ensemble.recording` computes the motion from them.
"""

import math
from functools import cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from reference_model.ensemble.core.jit import inlined, scalar
from reference_model.ensemble.task import LENGTH, PACE_SIZE, RATE, SHORT, SPAN, STEP
from reference_model.systems import FloatArray

NONE, ON_THE_WAY, SLIPS, STICKS = 0.0, 1.0, 2.0, 3.0
"""Kinds: unused; within a phase; slip begins; stick begins."""

Checkpoints = NDArray[Any]
"""Records, shape (n,), of ``kind``, ``time`` in s, ``state`` in SI units and ``pace`` (zeros where a phase begins).

They also store the increasing ``requested`` times.
"""


def empty_checkpoints(n: int, state_size: int, requested: FloatArray | tuple[()] = ()) -> Checkpoints:
    """Return ``n`` unused checkpoints with the ``requested`` times in s."""
    room = np.zeros(n, dtype=_layout(state_size))
    room["requested"] = np.inf
    room["requested"][: len(requested)] = requested
    return room


@cache
def _layout(state_size: int) -> np.dtype[Any]:
    fields = [
        ("kind", float), ("time", float), ("state", float, (state_size,)), ("pace", float, (PACE_SIZE,)),
        ("requested", float),
    ]  # fmt: skip
    return np.dtype(fields, align=True)


@inlined
def recorded(settings: Any) -> bool:
    requested: bool = settings.checkpoints.size > 0
    return requested


@scalar
def next_requested(memory: Any, settings: Any) -> float:
    if memory.passed < settings.checkpoints.size:
        requested: float = settings.checkpoints[memory.passed].requested * memory.rate
        return requested
    return math.inf


@scalar
def mark_requested(lanes: Any, moment: Any, memory: Any, lane: int, until: float, settings: Any) -> bool:
    """Return whether times up to ``until`` are requested; mark them as passed and store the pace of ``moment``."""
    before = memory.passed
    while memory.passed < settings.checkpoints.size and next_requested(memory, settings) <= until:
        memory.passed += 1
    if memory.passed == before:
        return False
    if memory.checkpoints < settings.checkpoints.size:
        pace = settings.checkpoints[memory.checkpoints].pace
        pace[LENGTH], pace[RATE], pace[STEP] = memory.length, memory.rate, moment.step[lane]
        pace[SHORT], pace[SPAN] = lanes.short[lane], memory.span
    return True
