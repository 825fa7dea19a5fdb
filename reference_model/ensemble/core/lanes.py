"""Many trajectories at once in lanes that are refilled as trajectories finish.

Each number has its own row (:mod:`records`), so a loop over the lanes is vectorised if it calls only inlined
functions of numbers and tuples. In a round every lane makes one trial step of its own size. At rare events it raises
a flag, which scalar code handles. Results are bitwise identical in every lane.
"""

import math
from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from reference_model.ensemble.core.jit import inlined, scalar, wide_vectors, written_out
from reference_model.ensemble.core.records import LANES, Record, Row
from reference_model.ensemble.core.recurrence import Measures, Window
from reference_model.ensemble.end_states import HANDED_OVER, UNDECIDED, Results
from reference_model.ensemble.task import Task
from reference_model.systems import FloatArray

REST, IS_DUE, RIGHTMOST, EXTREME, LOST, STIFF = 1, 2, 4, 8, 16, 32
"""Flags, which add up: slip is about to end; the due time has come; x or the radius had an extreme; the step size or
the number of steps is out of bounds; the core should take the step.
"""

SMALLEST_STEP = 1e-13


class Lanes(Record):
    """All lanes; subclasses add the motion ``now`` and after the ``trial`` step, and the ``law``.

    ``due`` is the time of the next check, ``watch`` the degree of watching, ``flag`` positive at an event, and
    ``short`` the number of successive short steps.
    """

    tolerance: Row
    due: Row
    watch: Row
    flag: Row
    steps: Row
    short: Row


class Memory(Record):
    """Scalar data of a lane.

    ``length`` and ``rate`` are the unit of length in m and the inverse unit of time in 1/s, ``tick`` is the time
    between checks. The next step by the core lasts ``span`` and tolerates as many short steps as the last
    (``patience``).
    """

    number: int
    length: float
    rate: float
    end: int
    found: Measures
    tick: float
    window: Window
    span: float
    patience: float


@written_out
def run(
    load: Callable[..., bool],
    advance: Callable[..., None],
    advance_alone: Callable[..., None],
    handle_flag: Callable[..., bool],
    store: Callable[..., None],
    record: NDArray[Any],
    memory: NDArray[Any],
    first: int,
    last: int,
    kind: Any,
    task: Task,
    settings: Any,
    results: Results,
) -> None:
    """Run the trajectories ``first`` to ``last`` (excluded) of ``task``, and write their ends to ``results``.

    The run ends with incomplete results if another thread sets ``task.stop``.

    ``record``, shape (1,), contains all lanes, and ``memory``, shape (LANES,), their scalar data; both are zeros.

    ``load`` writes the start of a trajectory to a lane's trial. ``advance`` makes a trial step in all lanes,
    ``advance_alone`` in the first one only. ``handle_flag`` handles a lane's flag and may change the trial. ``load``
    and ``handle_flag`` return whether the trajectory has ended. ``store`` writes its result.
    """
    wide_vectors()
    busy = np.zeros(LANES, dtype=np.bool_)
    number = first
    active = 0
    while True:
        # Again in every round, because the lanes exist only while something refers to the array.
        lanes = record[0]
        for lane in range(LANES):
            ended = False
            if busy[lane] and lanes.flag[lane] > 0.0:
                ended = handle_flag(lanes, memory[lane], lane, settings)
            while ended or (not busy[lane] and number < last):
                if busy[lane]:
                    store(lanes, memory[lane], lane, results)
                    busy[lane] = False
                    active -= 1
                if number == last:
                    break  # the numbers of the lane do not matter any more
                ended = load(lanes, memory[lane], lane, number, task, settings)
                busy[lane] = True
                active += 1
                number += 1
        if active == 0 or task.stop[0]:
            break
        _accept(lanes)
        if last - first == 1:
            advance_alone(lanes, kind)
        else:
            advance(lanes, kind)


@inlined
def row_of(values: FloatArray, number: int) -> FloatArray:
    row: FloatArray = values[number if values.shape[0] > 1 else 0]
    return row


@scalar
def store_end(lanes: Any, memory: Memory, lane: int, results: Results) -> None:
    number, length, rate, found = memory.number, memory.length, memory.rate, memory.found
    results.times[number] = lanes.trial.state.time[lane] / rate
    results.ends[number], results.steps[number] = memory.end, int(lanes.steps[lane])
    least = largest = slip = math.nan
    if memory.end != UNDECIDED and memory.end != HANDED_OVER:
        least, largest, slip = found.least * length, found.largest * length, found.slip * length * rate
    measures = results.measures[number]
    measures[0], measures[1], measures[2] = least, largest, slip


@scalar
def _accept(lanes: Any) -> None:
    lanes.now = lanes.trial
