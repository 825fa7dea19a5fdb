"""Many trajectories at once in lanes that are refilled as trajectories finish.

A processor takes a step in eight lanes in the time of one. All numbers of all lanes stand in one flat array,
``scratch[slot * LANES + lane]``, so that a loop over the lanes which loads, steps and stores becomes a loop of vector
instructions. (It must be a function of its own that calls nothing but inlined functions of numbers and tuples.)

A trajectory by itself would pay for all lanes: its step is compiled for one lane besides, to the same bits.

A round is one trial step in every lane, each with a step size of its own. What is rare (rest, release, the end) is
seen to lane by lane in scalar code: the lane raises a flag. What happens in a lane does not depend on the others: a
trajectory comes out the same bit by bit wherever and beside whichever others it runs.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from reference_model.ensemble.core.jit import scalar, written_out

LANES = 16
"""Two vectors of eight: while one waits for a square root the other goes on (measured: 25 ns a step, with eight
29)."""


@written_out
def run(
    load: Any, advance: Any, alone: Any, attend: Any, store: Any, idle: Any,
    slots: int, trial: int, items: int, flag: int, first: int, last: int, kind: Any,
    task: Any, aims: Any, results: Any,
) -> None:  # fmt: skip
    """Run the trajectories ``first`` to ``last`` (excluded) of ``task`` to their ends.

    Parameters
    ----------
    load, advance, alone, attend, store, idle : compiled functions
        ``load(scratch, book, lane, number, task, aims)`` puts the start of a trajectory into the trial slots of a
        lane, ``advance(scratch, kind)`` makes a trial step in all lanes and ``alone`` in the first one only,
        ``attend(scratch, book, lane, aims)`` sees to a lane with a flag and may change its trial,
        ``store(scratch, book, lane, results)`` writes down what stands in the trial slots, and
        ``idle(scratch, lane)`` puts something harmless into a lane. ``load`` and ``attend`` return whether the
        trajectory has ended.
    slots, trial : int
        Length of a lane in the scratch array; how many of these slots, the first, make up the motion. As many that
        follow are those of the trial.
    items : int
        Length of its page in the book, where scalar code keeps what no vector needs.
    flag : int
        The slot of the flag, which is positive if it is raised.
    first, last : int
        Numbers of trajectories.
    kind
        What about the system must be known when ``advance`` is compiled, as a type.
    task, aims, results : tuples
        Parameters and starts; what ``attend`` must know, which is called often, so that it should hold few arrays;
        where results go.

    """
    scratch = np.zeros(slots * LANES)
    book = np.empty((LANES, items))
    busy = np.zeros(LANES, dtype=np.bool_)
    number = first
    active = 0
    for lane in range(LANES):
        idle(scratch, lane)
    while True:
        for lane in range(LANES):
            ended = False
            if busy[lane] and scratch[flag * LANES + lane] > 0.0:
                ended = attend(scratch, book, lane, aims)
            while ended or (not busy[lane] and number < last):
                if busy[lane]:
                    store(scratch, book, lane, results)
                    busy[lane] = False
                    active -= 1
                if number == last:
                    idle(scratch, lane)
                    break
                ended = load(scratch, book, lane, number, task, aims)
                busy[lane] = True
                active += 1
                number += 1
        if active == 0:
            break
        _accept(scratch, trial)
        if last - first == 1:
            alone(scratch, kind)
        else:
            advance(scratch, kind)


@scalar
def _accept(scratch: Any, trial: int) -> None:
    """Take over the trial of every lane."""
    for i in range(trial * LANES):
        scratch[i] = scratch[trial * LANES + i]
