"""The requested times of a trajectory, and its pace in the steps that contain them.

The functions serve pins and discs, whose lanes and memories use the same names for these fields.
"""

from __future__ import annotations

import math
from typing import Any

from reference_model.ensemble.checkpoints import LENGTH, RATE, SHORT, SPAN, STEP
from reference_model.ensemble.core.jit import inlined, scalar


@inlined
def recorded(aims: Any) -> bool:
    """Return whether checkpoints are requested."""
    asked: bool = aims.checkpoints.size > 0
    return asked


@scalar
def next_asked(memory: Any, aims: Any) -> float:
    """Return the next requested time in units; inf if there is none."""
    if memory.passed < aims.checkpoints.size:
        asked: float = aims.checkpoints[memory.passed].asked * memory.rate
        return asked
    return math.inf


@scalar
def passes_asked(lanes: Any, moment: Any, memory: Any, lane: int, until: float, aims: Any) -> bool:
    """Return whether times up to ``until`` are requested, and mark them as passed.

    The pace of ``moment`` is stored for the next checkpoint, if there is room for it.
    """
    before = memory.passed
    while memory.passed < aims.checkpoints.size and next_asked(memory, aims) <= until:
        memory.passed += 1
    if memory.passed == before:
        return False
    if memory.checkpoints < aims.checkpoints.size:
        pace = aims.checkpoints[memory.checkpoints].pace
        pace[LENGTH], pace[RATE], pace[STEP] = memory.length, memory.rate, moment.step[lane]
        pace[SHORT], pace[SPAN] = lanes.short[lane], memory.span
    return True
