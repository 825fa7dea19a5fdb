"""Many trajectories at once in lanes that are refilled as trajectories finish.

A processor takes a step in eight lanes in the time of one. All numbers of all lanes stand in one record, each in a
row of its own (:mod:`records`), so that a loop over the lanes which loads, steps and stores becomes a loop of vector
instructions. (It must be a function of its own that calls nothing but inlined functions of numbers and tuples.)

A trajectory by itself would pay for all lanes: its step is compiled for one lane besides, to the same bits.

A round is one trial step in every lane, each with a step size of its own. What is rare (rest, release, the end) is
seen to lane by lane in scalar code: the lane raises a flag. What happens in a lane does not depend on the others: a
trajectory comes out the same bit by bit wherever and beside whichever others it runs.
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
    """What the record of all lanes must hold.

    The motion as it is ``now`` and after the ``trial`` step; why a lane wants to be attended, positive if it does.
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

    It is long by its arguments: compiled code has no methods, so that all that a kind of system does is handed over.

    Parameters
    ----------
    load, advance, alone, attend, store, idle : compiled functions
        ``load(lanes, memory, lane, number, task, aims)`` puts the start of a trajectory into the trial of a lane,
        ``advance(lanes, kind)`` makes a trial step in all lanes and ``alone`` in the first one only,
        ``attend(lanes, memory, lane, aims)`` sees to a lane with a flag and may change its trial,
        ``store(lanes, memory, lane, results)`` writes down the trial, and ``idle(lanes, lane)`` puts something
        harmless into a lane. ``load`` and ``attend`` return whether the trajectory has ended.
    room : array of shape (1,)
        Of the record of all lanes, with zeros in it.
    memory : array of shape (LANES,)
        Of the records in which scalar code keeps what no vector needs.
    first, last : int
        Numbers of trajectories.
    kind
        What about the system must be known when ``advance`` is compiled, as a type.
    task, aims, results : tuples
        Parameters and starts; what ``attend`` must know, which is called often, so that it should hold few arrays;
        where results go.

    """
    wide_vectors()
    busy = np.zeros(LANES, dtype=np.bool_)
    number = first
    active = 0
    for lane in range(LANES):
        idle(room[0], lane)
    while True:
        # The record is taken from its room in every round: it is there as long as something asks for the room.
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
    """Return the row of a trajectory in what has one for each, or a single one for all."""
    row: FloatArray = values[number if values.shape[0] > 1 else 0]
    return row


@scalar
def _accept(lanes: _Lanes) -> None:
    """Take over the trial of every lane."""
    lanes.now = lanes.trial
