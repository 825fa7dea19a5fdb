"""Requested times of a trajectory of a pin or a disc, and its pace in the steps that contain them."""

from __future__ import annotations

import math
from typing import Any

from reference_model.ensemble.checkpoints import LENGTH, RATE, SHORT, SPAN, STEP
from reference_model.ensemble.core.jit import inlined, scalar


@inlined
def recorded(settings: Any) -> bool:
    """Return whether checkpoints are requested."""
    requested: bool = settings.checkpoints.size > 0
    return requested


@scalar
def next_requested(memory: Any, settings: Any) -> float:
    """Return the next requested time in units, or inf."""
    if memory.passed < settings.checkpoints.size:
        requested: float = settings.checkpoints[memory.passed].requested * memory.rate
        return requested
    return math.inf


@scalar
def mark_requested(lanes: Any, moment: Any, memory: Any, lane: int, until: float, settings: Any) -> bool:
    """Return whether times up to ``until`` are requested, and mark them as passed.

    Store the pace of ``moment`` for the next checkpoint, if there is room for it.
    """
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
