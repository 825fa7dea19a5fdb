"""The times that a trajectory is asked for, and with which pace it goes on from the step in which one of them lies.

Of pins and of discs alike: their lanes and memories call by the same names what is taken from them here.
"""

from __future__ import annotations

import math
from typing import Any

from reference_model.ensemble.checkpoints import LENGTH, RATE, SHORT, SPAN, STEP
from reference_model.ensemble.core.jit import inlined, scalar


@inlined
def recorded(aims: Any) -> bool:
    """Tell whether checkpoints are asked for."""
    asked: bool = aims.checkpoints.size > 0
    return asked


@scalar
def next_asked(memory: Any, aims: Any) -> float:
    """Return the next time that is asked for, in units; inf if there is none."""
    if memory.passed < aims.checkpoints.size:
        asked: float = aims.checkpoints[memory.passed].asked * memory.rate
        return asked
    return math.inf


@scalar
def passes_asked(lanes: Any, moment: Any, memory: Any, lane: int, until: float, aims: Any) -> bool:
    """Tell whether times are asked for up to the time ``until``, and pass them.

    The pace of ``moment`` is kept for the checkpoint that is to be taken next, if there is room for it.
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
