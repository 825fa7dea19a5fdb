"""The sequence of slip and stick phases of one body, in calls of bounded length."""

import numpy as np

from reference_model.core.explicit import EXTENDED, SIZE, TERMS
from reference_model.core.forces import rates, unpacked
from reference_model.core.memory import (
    ENDS,
    FAILS,
    FULL,
    PATIENCE,
    PHASE,
    PHASES,
    RUNS,
    SHORT,
    SLIPS,
    STATUS,
    STEPS,
    STICKS,
    WORK,
    enter,
    speed_of,
)
from reference_model.core.recording import record_carried, record_falling
from reference_model.core.rest import holds_for
from reference_model.core.slip import creep_from, slide, time_left
from reference_model.core.stiff import begin_slip, slip_stiffly
from reference_model.core.surfaces import sides
from reference_model.systems import FloatArray


def advance(
    state: FloatArray, memory: FloatArray, tolerance: float, end: float, times: FloatArray, out: FloatArray,
    phases: FloatArray, most_work: float, parameters: FloatArray,
) -> None:  # fmt: skip
    """Continue a run from ``state``, shape (7,), for about ``most_work`` explicit steps.

    The result does not depend on ``most_work``. ``times`` are the requested times, (n,), ``out`` the unknowns without
    the time, (n, 6), and ``phases``, (k, 8), contain kind, start and these unknowns. All is scaled; the run starts at
    time 0 and takes steps with errors of ``tolerance``. ``parameters`` are those of the law.
    """
    law = unpacked(parameters)
    y = (state[0], state[1], state[2], state[3], state[4], state[5], state[6])
    K, F = np.empty((EXTENDED, SIZE)), np.empty((TERMS + 1, SIZE))
    none = (0.0, 0.0, 0.0, 0.0)
    work = memory[WORK] + most_work
    if memory[PHASE] == 0.0:
        sides(y, memory, law)
        sticks = speed_of(y) == 0.0 and law.friction > 0.0 and holds_for(y[0], y[1], law) > 0.0
        enter(memory, phases, STICKS if sticks else SLIPS, y)
    while y[6] < end and memory[WORK] < work and memory[STATUS] == RUNS:
        if memory[PHASES] > len(phases) - 2:
            memory[STATUS] = FULL
            break
        if speed_of(y) == 0.0 and law.friction > 0.0:
            held = holds_for(y[0], y[1], law)
            memory[WORK] += 1.0
            if held > 0.0:
                enter(memory, phases, STICKS, y)
                y = record_carried(y, min(y[6] + held, end), none, memory, times, out, law)
                memory[STEPS] += 1.0
                if y[6] >= end:
                    break
            enter(memory, phases, SLIPS, y)
            y = begin_slip(y, memory, tolerance, end, times, out, law)
            sides(y, memory, law)
            continue
        f = rates(y[0], y[1], y[2], y[3], y[4], law)
        left = time_left(y, f, law)
        if left >= 0.0:
            memory[STEPS] += 1.0
            y = record_falling(y, left, end, memory, times, out, law)
            continue
        creep = creep_from(y, tolerance, law)
        if creep[0] > 0.0:
            memory[STEPS] += 1.0
            y = record_carried(y, end, creep, memory, times, out, law)
        elif law.friction > 0.0 and memory[SHORT] >= memory[PATIENCE]:
            y = slip_stiffly(y, memory, tolerance, end, times, out, law)
        else:
            y = slide(y, memory, tolerance, end, work, times, out, law, K, F)
    for v in range(SIZE):
        state[v] = y[v]
        if not np.isfinite(y[v]):
            memory[STATUS] = FAILS
    if y[6] >= end and memory[STATUS] == RUNS:
        memory[STATUS] = ENDS
