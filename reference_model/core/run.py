"""The sequence of slip and stick phases of one body, in calls of bounded length."""

import math

import numpy as np

from reference_model.core.forces.law import CENTRE, Law, seen_from, unpacked
from reference_model.core.forces.pivot import first_slip, turning
from reference_model.core.forces.points import centre_slip
from reference_model.core.forces.rates import pull, rates
from reference_model.core.limit import pivot_from_rest
from reference_model.core.memory import (
    CREEPS,
    ENDS,
    FAILS,
    FULL,
    PATIENCE,
    PHASE,
    PHASES,
    PIVOTS,
    POINT,
    RUNS,
    SENSE,
    SHORT,
    SIDE_OF_GRIP,
    SIDE_OF_SPIN,
    SLIPS,
    STATUS,
    STEP,
    STEPS,
    STICKS,
    WORK,
    enter,
    seen,
    speed_of,
)
from reference_model.core.recording import record_carried, record_falling
from reference_model.core.rest import direction, holds_for
from reference_model.core.slip import creep_from, ends_together, is_frozen, point_for, slide, time_left
from reference_model.core.steps.explicit import EXTENDED, SIZE, TERMS, Unknowns
from reference_model.core.stiff import FIRST_STEP, at_rest, begin_slip, slip_stiffly
from reference_model.core.surfaces import grip, sides
from reference_model.numerics.parts import part, written_out
from reference_model.systems import FloatArray

AT_REST = 1e-15
"""Slip speed of a point that counts as rounding error, as a share of the centre's slip speed."""

NO_CREEP = (0.0, 0.0, 0.0, 0.0)


@part
def followed(y: Unknowns, law: Law) -> tuple[Unknowns, Law]:
    """Choose the slip of the centre or of a slow contact point as the unknown; return the unknowns and the law."""
    point = point_for(y, law)
    if point == law.point:
        return y, law
    new = seen_from(point, 0.0, law)
    return seen(y, law, new), new


@part
def as_started(y: Unknowns, law: Law) -> tuple[Unknowns, Law]:
    """Return the first unknowns, where a point that moves with the master disc to rounding error rests."""
    new, about = followed(y, law)
    if about.point != CENTRE and speed_of(new, about) <= AT_REST * speed_of(y, law):
        new = (new[0], new[1], 0.0, 0.0, new[4], new[5], new[6])
    return new, about


@part
def pivots(y: Unknowns, memory: FloatArray, law: Law) -> bool:
    """Return whether friction holds a point that rests while the disc turns."""
    if at_rest(y, law) or memory[SIDE_OF_GRIP] < 0.0:
        return False
    return grip(y, seen_from(law.point, math.copysign(1.0, y[4]), law)) > 0.0


@part
def departing(y: Unknowns, law: Law) -> tuple[tuple[float, float, float], Law]:
    """Return the direction of the slip that begins: at all points, at all but one, or about a resting point."""
    if at_rest(y, law):
        point, sense = pivot_from_rest(y[0], y[1], y[5], law)
        if point != CENTRE:
            return (0.0, 0.0, sense), seen_from(point, sense, law)
        return direction(y[0], y[1], y[5], law), seen_from(CENTRE, 0.0, law)
    ux, uy = centre_slip(0.0, 0.0, y[4], y[5], law)
    ax, ay = pull(y[0], y[1], ux, uy, law)
    _, bx, by, _, _ = turning(ax, ay, y[4], y[5], seen_from(law.point, math.copysign(1.0, y[4]), law))
    ex, ey = first_slip(bx, by, y[5], law)
    return (ex, ey, 0.0), seen_from(law.point, 0.0, law)


def advance(
    state: FloatArray, memory: FloatArray, tolerance: float, end: float, times: FloatArray, out: FloatArray,
    phases: FloatArray, most_work: float, parameters: FloatArray, around: FloatArray,
) -> None:  # fmt: skip
    """Continue a run like :func:`follow` under the law with ``parameters`` and ``around``."""
    follow(unpacked(parameters, around), state, memory, tolerance, end, times, out, phases, most_work)


@written_out
def follow(
    law: Law, state: FloatArray, memory: FloatArray, tolerance: float, end: float, times: FloatArray,
    out: FloatArray, phases: FloatArray, most_work: float,
) -> None:  # fmt: skip
    """Continue a run from ``state``, shape (9,), for about ``most_work`` explicit steps.

    The state contains the unknowns, and as a result the slip of the centre. The motion does not depend on
    ``most_work``. ``times`` are the requested times, (n,), ``out`` the unknowns without the time, (n, 6), and
    ``phases``, (k, 8), contain kind, start and these unknowns. All values are scaled. The run starts at time 0, and
    ``tolerance`` bounds the error of a step.
    """
    law = seen_from(int(memory[POINT]) - 1, memory[SENSE], law)
    y = (state[0], state[1], state[2], state[3], state[4], state[5], state[6])
    K, F = np.empty((EXTENDED, SIZE)), np.empty((TERMS + 1, SIZE))
    work = memory[WORK] + most_work
    if memory[PHASE] == 0.0:
        y, law = as_started(y, law)
        sides(y, memory, law)
        enter(memory, phases, first_kind(y, memory, law), y, law)
    while y[6] < end and memory[WORK] < work and memory[STATUS] == RUNS:
        if memory[PHASES] > len(phases) - 3:
            memory[STATUS] = FULL
            break
        if memory[SIDE_OF_SPIN] < 0.0:
            y = (y[0], y[1], 0.0, 0.0, 0.0, y[5], y[6])
            memory[SIDE_OF_SPIN] = 1.0
        y, law = followed(y, law)
        if law.friction > 0.0 and (speed_of(y, law) == 0.0 or memory[SIDE_OF_GRIP] < 0.0):
            y, law = leave_rest(y, memory, tolerance, end, work, times, out, phases, law, K, F)
        else:
            y, law = slip_on(y, memory, tolerance, end, work, times, out, law, K, F)
    memory[POINT], memory[SENSE] = law.point + 1.0, law.sense
    state[SIZE], state[SIZE + 1] = centre_slip(y[2], y[3], y[4], y[5], law)
    for v in range(SIZE):
        state[v] = y[v]
        if not np.isfinite(y[v]):
            memory[STATUS] = FAILS
    if y[6] >= end and memory[STATUS] == RUNS:
        memory[STATUS] = ENDS


@part
def first_kind(y: Unknowns, memory: FloatArray, law: Law) -> float:
    """Return the kind of the first phase."""
    if speed_of(y, law) > 0.0 or law.friction == 0.0:
        return SLIPS
    if at_rest(y, law) and holds_for(y[0], y[1], y[5], law) > 0.0:
        return STICKS
    return PIVOTS if pivots(y, memory, law) or departing(y, law)[1].sense != 0.0 else SLIPS


@written_out
def leave_rest(
    y: Unknowns, memory: FloatArray, tolerance: float, end: float, work: float, times: FloatArray, out: FloatArray,
    phases: FloatArray, law: Law, K: FloatArray, F: FloatArray,
) -> tuple[Unknowns, Law]:  # fmt: skip
    """Follow a body that rests, wholly or in one point, until slip or a pivot has begun, or to the end of the run."""
    memory[WORK] += 1.0
    if pivots(y, memory, law):
        law = seen_from(law.point, math.copysign(1.0, y[4]), law)
        enter(memory, phases, PIVOTS, y, law)
        memory[STEP], memory[SHORT] = FIRST_STEP, 0.0
        return y, law
    if at_rest(y, law):
        law = seen_from(CENTRE, 0.0, law)
        y = (y[0], y[1], 0.0, 0.0, 0.0, y[5], y[6])
        held = holds_for(y[0], y[1], y[5], law)
        if held > 0.0:
            enter(memory, phases, STICKS, y, law)
            y = record_carried(y, min(y[6] + held, end), NO_CREEP, memory, times, out, law)
            memory[STEPS] += 1.0
            if y[6] >= end:
                return y, law
    n, law = departing(y, law)
    enter(memory, phases, PIVOTS if law.sense != 0.0 else SLIPS, y, law)
    y = begin_slip(y, n, memory, tolerance, end, times, out, law)
    sides(y, memory, law)
    if law.sense != 0.0 and y[4] == 0.0:
        y = slide(y, memory, tolerance, end, work, times, out, law, K, F)
    return y, law


@written_out
def slip_on(
    y: Unknowns, memory: FloatArray, tolerance: float, end: float, work: float, times: FloatArray, out: FloatArray,
    law: Law, K: FloatArray, F: FloatArray,
) -> tuple[Unknowns, Law]:  # fmt: skip
    """Follow slip to its end in closed form, or by steps of the method that suits it."""
    memory[WORK] += 1.0
    whole = seen_from(CENTRE, 0.0, law)
    if ends_together(y, law):
        y, law = seen(y, law, whole), whole
    f = rates(y[0], y[1], y[2], y[3], y[4], y[5], law)
    left = time_left(y, f, law)
    if left >= 0.0:
        memory[STEPS] += 1.0
        return record_falling(y, left, end, memory, times, out, law), law
    creep = creep_from(y, tolerance, law)
    if creep[0] > 0.0:
        memory[STEPS] += 1.0
        memory[CREEPS] = 1.0
        return record_carried(seen(y, law, whole), end, creep, memory, times, out, whole), whole
    if memory[SHORT] >= memory[PATIENCE] or is_frozen(f, law):
        new = slip_stiffly(y, memory, tolerance, end, times, out, law)
        if new[6] > y[6]:
            return new, law
    return slide(y, memory, tolerance, end, work, times, out, law, K, F), law
