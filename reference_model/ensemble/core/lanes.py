"""Many trajectories at once in lanes that are refilled as trajectories finish.

A processor takes a step in eight lanes in the time of one. One record holds all numbers of all lanes, each number in
its own row (:mod:`records`), so a loop over the lanes that loads, steps and stores becomes vector instructions. For
this the loop needs its own function, and may call only inlined functions of numbers and tuples. The step is also
compiled for one lane, with bit-identical results, because a single trajectory would pay for all lanes.

A round is one trial step in every lane, each with its own step size. A lane raises a flag at rare events (rest,
release, the end), which scalar code handles lane by lane. Lanes are independent: the result of a trajectory is the
same bit by bit wherever and next to whichever others it runs.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Protocol, TypeVar

import numpy as np
from numpy.typing import NDArray

from reference_model.ensemble.core.jit import inlined, scalar, wide_vectors, written_out
from reference_model.ensemble.core.records import LANES
from reference_model.systems import FloatArray


class _Lanes(Protocol):
    """Required fields of the record of all lanes.

    They are the current motion ``now``, the motion after the ``trial`` step, and a flag that is positive if a lane
    needs attention.
    """

    now: Any
    trial: Any
    flag: FloatArray


Lanes = TypeVar("Lanes", bound=_Lanes)
Memory = TypeVar("Memory")
Task = TypeVar("Task")
Aims = TypeVar("Aims")
Results = TypeVar("Results")
Kind = TypeVar("Kind")


@written_out
def run(
    load: Callable[[Lanes, Memory, int, int, Task, Aims], bool],
    advance: Callable[[Lanes, Kind], None],
    alone: Callable[[Lanes, Kind], None],
    attend: Callable[[Lanes, Memory, int, Aims], bool],
    store: Callable[[Lanes, Memory, int, Results], None],
    idle: Callable[[Lanes, int], None],
    room: NDArray[Any],
    memory: NDArray[Any],
    first: int,
    last: int,
    kind: Kind,
    task: Task,
    aims: Aims,
    results: Results,
) -> None:
    """Run the trajectories ``first`` to ``last`` (excluded) of ``task`` to their ends.

    It has many arguments because compiled code has no methods: all functions of a kind of system are passed in.

    Parameters
    ----------
    load, advance, alone, attend, store, idle : compiled functions
        ``load(lanes, memory, lane, number, task, aims)`` writes the start of a trajectory to the trial of a lane.
        ``advance(lanes, kind)`` makes a trial step in all lanes and ``alone`` in the first one only. ``attend(lanes,
        memory, lane, aims)`` handles a lane with a flag and may change its trial. ``store(lanes, memory, lane,
        results)`` writes the result from the trial. ``idle(lanes, lane)`` fills a lane with harmless numbers.
        ``load`` and ``attend`` return whether the trajectory has ended.
    room : array of shape (1,)
        The record of all lanes, initially zeros.
    memory : array of shape (LANES,)
        Records of scalar code, for data that no vector needs.
    first, last
        Numbers of trajectories.
    kind
        Properties of the system that must be known when ``advance`` is compiled, as a type.
    task, aims, results : tuples
        Parameters and starts; the settings for ``attend``, which is called often and should receive few arrays; the
        output arrays.

    """
    wide_vectors()
    busy = np.zeros(LANES, dtype=np.bool_)
    number = first
    active = 0
    for lane in range(LANES):
        idle(room[0], lane)
    while True:
        # The record is taken from its room in every round, because it exists only while something refers to the room.
        lanes = room[0]
        for lane in range(LANES):
            ended = False
            if busy[lane] and lanes.flag[lane] > 0.0:
                ended = attend(lanes, memory[lane], lane, aims)
            while ended or (not busy[lane] and number < last):
                if busy[lane]:
                    store(lanes, memory[lane], lane, results)
                    busy[lane] = False
                    active -= 1
                if number == last:
                    idle(lanes, lane)
                    break
                ended = load(lanes, memory[lane], lane, number, task, aims)
                busy[lane] = True
                active += 1
                number += 1
        if active == 0:
            break
        _accept(lanes)
        if last - first == 1:
            alone(lanes, kind)
        else:
            advance(lanes, kind)


@inlined
def row_of(values: FloatArray, number: int) -> FloatArray:
    """Return the row of a trajectory in an array with a row for each, or a single one for all."""
    row: FloatArray = values[number if values.shape[0] > 1 else 0]
    return row


@scalar
def _accept(lanes: _Lanes) -> None:
    lanes.now = lanes.trial
