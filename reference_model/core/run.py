"""The sequence of slip and stick phases of one body, in calls of bounded length."""

import math

import numpy as np

from reference_model.core.collocation import at, series, solve
from reference_model.core.collocation import error_of as error_of_series
from reference_model.core.explicit import Unknowns, error_of, factor_of, take
from reference_model.core.forces import Law, growth, rates
from reference_model.core.parts import part
from reference_model.core.rest import begun, creep_of, direction, holds_for
from reference_model.numerics.collocation import NODES, POINTS
from reference_model.systems import FloatArray

SLIPS, STICKS = 1.0, 2.0

STEP, SPAN, SHORT, PATIENCE, SIDE_OF_STOP, SIDE_OF_RIM, PHASE, STEPS, EVALUATIONS, RECORDED, PHASES, STATUS = range(12)
"""Indices into the memory of a run, which continues from it in the next call."""

RUNS, ENDS, FAILS, FULL = 0.0, 1.0, 2.0, 3.0

REST_TIME = 1e-12
"""Largest error of the closed form for the time of coming to rest."""

REVERSAL = 1e-13
"""Slip below which slip that friction cannot hold counts as reversed."""

FIRST_SPAN = 0.01
"""First step of collocation from rest, which shrinks until the motion is resolved."""

LEAST_SPAN = 1e-12

BRIEF = 1e-5
"""Longest slip from rest in closed form; its relative error is of this order."""

FEW, USUAL = 15.0, 0.02
"""Number of steps shorter than ``USUAL``, in slip and time, before collocation is tried."""

COST = 4.0
"""Work of a step of collocation relative to an explicit one."""

RISING = 10.0
"""Rate of relaxation times the step below which an explicit method is as efficient."""


@part
def speed_of(y: Unknowns) -> float:
    return math.sqrt(y[2] * y[2] + y[3] * y[3] + y[4] * y[4])


@part
def put(row: FloatArray, y: Unknowns) -> None:
    for v in range(6):
        row[v] = y[v]


@part
def carried(y: Unknowns, delay: float, way: float, slip: float, law: Law) -> Unknowns:
    """Return the unknowns of a body that sticks or creeps; ``way`` and ``slip`` in units of the slip of ``y``."""
    c, s = math.cos(law.omega * delay), math.sin(law.omega * delay)
    x, z = y[0] + way * y[2], y[1] + way * y[3]
    ux, uy = slip * y[2], slip * y[3]
    return (
        c * x - s * z, s * x + c * z, c * ux - s * uy, s * ux + c * uy, slip * y[4],
        y[5] + law.omega * delay + way * y[4] / law.gyration, y[6] + delay,
    )  # fmt: skip


@part
def enter(memory: FloatArray, phases: FloatArray, kind: float, y: Unknowns) -> None:
    """Begin a phase unless it is of the current kind."""
    if memory[PHASE] != kind:
        memory[PHASE] = kind
        row = phases[int(memory[PHASES])]
        row[0], row[1] = kind, y[6]
        put(row[2:], y)
        memory[PHASES] += 1.0


@part
def beyond_stop(y: Unknowns, law: Law) -> float:
    wx = y[0] - law.offset
    return math.sqrt(wx * wx + y[1] * y[1]) - law.gap


@part
def outward(y: Unknowns, law: Law) -> float:
    return (y[0] - law.offset) * (y[2] - law.omega * y[1]) + y[1] * (y[3] + law.omega * y[0])


@part
def lead(y: Unknowns, law: Law) -> float:
    """Return U − W, zero where a point of the ring rests."""
    return math.sqrt(y[2] * y[2] + y[3] * y[3]) - law.rim * abs(y[4])


@part
def value_of(which: int, y: Unknowns, law: Law) -> float:
    return beyond_stop(y, law) if which == SIDE_OF_STOP else lead(y, law)


@part
def crossing(which: int, side: float, y: Unknowns, new: Unknowns, h: float, law: Law) -> float:
    """Return the part of the step ``h`` after which a surface is crossed, or ``h``."""
    crossed = side * value_of(which, new, law) < 0.0
    dips = which == SIDE_OF_STOP and side * outward(y, law) < 0.0 < side * outward(new, law)
    if not crossed and not dips:
        return h
    inside, outside, seen = 0.0, h, False
    for i in range(1, 17):
        place = h * i / 16.0
        value = side * value_of(which, take(y, place, law)[0] if i < 16 else new, law)
        if value > 0.0:
            inside, seen = place, True
        elif seen or side * value_of(which, y, law) > 1e-12:
            outside = place
            break
    else:
        return h
    while True:
        middle = 0.5 * (inside + outside)
        if middle <= inside or middle >= outside or outside - inside < 1e-15 * h:
            return outside
        if side * value_of(which, take(y, middle, law)[0], law) > 0.0:
            inside = middle
        else:
            outside = middle


@part
def record_step(y: Unknowns, new: Unknowns, h: float, memory: FloatArray, times: FloatArray, out: FloatArray, law: Law) -> None:
    """Record requested times within a step by shorter steps from its start."""
    while memory[RECORDED] < len(times) and times[int(memory[RECORDED])] <= new[6]:
        t = times[int(memory[RECORDED])]
        tau = h * min(max((t - y[6]) / (new[6] - y[6]), 0.0), 1.0)
        there = y
        for _ in range(20):
            there = take(y, tau, law)[0]
            memory[EVALUATIONS] += 12.0
            pace = rates(there[0], there[1], there[2], there[3], there[4], law)[6]
            late = t - there[6]
            if abs(late) < 1e-8 * pace:
                break
            tau = min(max(tau + late / pace, 0.0), h)
        f = rates(there[0], there[1], there[2], there[3], there[4], law)
        late = (t - there[6]) / f[6]
        row = out[int(memory[RECORDED])]
        for v in range(6):
            row[v] = there[v] + late * f[v]
        memory[RECORDED] += 1.0


@part
def record_carried(
    y: Unknowns, until: float, creep: tuple[float, float, float, float], memory: FloatArray, times: FloatArray, out: FloatArray, law: Law
) -> Unknowns:
    """Record a body that sticks or creeps until a time; return its unknowns then."""
    while memory[RECORDED] < len(times) and times[int(memory[RECORDED])] <= until:
        put(out[int(memory[RECORDED])], creeping(y, times[int(memory[RECORDED])] - y[6], creep, law))
        memory[RECORDED] += 1.0
    end = creeping(y, until - y[6], creep, law)
    return (end[0], end[1], end[2], end[3], end[4], end[5], until)


@part
def creeping(y: Unknowns, delay: float, creep: tuple[float, float, float, float], law: Law) -> Unknowns:
    share, slow, rest, fast = creep
    if share == 0.0:
        return carried(y, delay, 0.0, 0.0, law)
    s = share + rest
    slip = share * math.exp(-slow * delay) + rest * math.exp(-fast * delay)
    way = -share / slow * math.expm1(-slow * delay) - rest / fast * math.expm1(-fast * delay)
    return carried(y, delay, way / s, slip / s, law)


@part
def record_falling(y: Unknowns, left: float, end: float, memory: FloatArray, times: FloatArray, out: FloatArray, law: Law) -> Unknowns:
    """Follow the last ``left`` of slip, which falls linearly; return the body at rest."""
    until = min(y[6] + left, end)
    while memory[RECORDED] < len(times) and times[int(memory[RECORDED])] <= until:
        delay = times[int(memory[RECORDED])] - y[6]
        share = delay / left if left > 0.0 else 1.0
        put(out[int(memory[RECORDED])], carried(y, delay, delay * (1.0 - 0.5 * share), 1.0 - share, law))
        memory[RECORDED] += 1.0
    if y[6] + left <= end:
        rest = carried(y, left, 0.5 * left, 0.0, law)
        return (rest[0], rest[1], 0.0, 0.0, 0.0, rest[5], rest[6])
    share = (end - y[6]) / left
    rest = carried(y, share * left, share * left * (1.0 - 0.5 * share), 1.0 - share, law)
    return (rest[0], rest[1], rest[2], rest[3], rest[4], rest[5], end)


@part
def record_series(
    t: float, h: float, end: float, coefficients: FloatArray, memory: FloatArray, times: FloatArray, out: FloatArray
) -> None:
    while memory[RECORDED] < len(times) and times[int(memory[RECORDED])] <= end:
        put_row = at(coefficients, (times[int(memory[RECORDED])] - t) / h)
        for v in range(6):
            out[int(memory[RECORDED]), v] = put_row[v]
        memory[RECORDED] += 1.0


@part
def time_left(y: Unknowns, law: Law) -> float:
    """Return the time to rest if slip is about to end, 0 if it has ended to rounding error, -1 otherwise."""
    s = speed_of(y)
    a = growth(y[0], y[1], y[2], y[3], y[4], law)
    falling = -(a[0] * y[2] + a[1] * y[3] + a[2] * y[4]) / s
    if falling <= 0.0:
        return -1.0
    left = s / falling
    across = 0.0
    for v in range(3):
        across += (a[v] + falling * y[2 + v] / s) ** 2
    pace = abs(law.omega) + law.shaft + 1.0
    if left * math.sqrt(across) / falling + left * left * pace < REST_TIME:
        return left
    return 0.0 if s < REVERSAL else -1.0


@part
def slip_explicitly(
    y: Unknowns, memory: FloatArray, tolerance: float, end: float, times: FloatArray, out: FloatArray, law: Law
) -> Unknowns:
    """Take one step in stretched time."""
    h = memory[STEP]
    if h <= 0.0:
        h = 0.01
    most = 10.0
    while True:
        new, third, fifth = take(y, h, law)
        memory[STEPS] += 1.0
        memory[EVALUATIONS] += 12.0
        error = h * error_of(y, new, third, fifth, tolerance, law)
        if new[2] * y[2] + new[3] * y[3] + new[4] * y[4] < 0.0 and speed_of(y) < 1e-3:
            error = max(error, 256.0)
        if error <= 1.0:
            break
        h *= factor_of(error)
        most = 1.0
        if h < 1e-14:
            memory[STATUS] = FAILS
            return y
    usual = h * min(most, factor_of(error))
    part_of = h
    if law.stop > 0.0 and law.gap > 0.0:
        part_of = crossing(SIDE_OF_STOP, memory[SIDE_OF_STOP], y, new, h, law)
    which = SIDE_OF_STOP
    if law.rim > 0.0 and law.friction > 0.0:
        other = crossing(SIDE_OF_RIM, memory[SIDE_OF_RIM], y, new, h, law)
        if other < part_of:
            part_of, which = other, SIDE_OF_RIM
    if part_of < h:
        h = part_of
        new = take(y, h, law)[0]
        memory[which] = -memory[which]
    if new[6] > end:
        # The last step ends at the end of the run.
        tau = h * (end - y[6]) / (new[6] - y[6])
        for _ in range(20):
            new = take(y, tau, law)[0]
            pace = rates(new[0], new[1], new[2], new[3], new[4], law)[6]
            if abs(end - new[6]) < 1e-15 * (1.0 + end):
                break
            tau = min(max(tau + (end - new[6]) / pace, 0.0), h)
        h = tau
        new = (new[0], new[1], new[2], new[3], new[4], new[5], end)
    record_step(y, new, h, memory, times, out, law)
    memory[STEP] = usual
    s = speed_of(new)
    change = math.sqrt((new[2] - y[2]) ** 2 + (new[3] - y[3]) ** 2 + (new[4] - y[4]) ** 2)
    short = new[6] - y[6] + change / (s + 1e-300) < USUAL
    memory[SHORT] = max(0.0, memory[SHORT] + (1.0 if short else -1.0))
    memory[SPAN] = new[6] - y[6]
    return new


@part
def five(y: Unknowns) -> FloatArray:
    result = np.empty(5)
    for v in range(5):
        result[v] = y[v]
    return result


@part
def slip_stiffly(
    y: Unknowns, memory: FloatArray, tolerance: float, end: float, times: FloatArray, out: FloatArray, law: Law
) -> Unknowns:
    """Take steps by collocation while they pay."""
    first_s, explicit = speed_of(y), memory[SPAN]
    h, known, coefficients, taken = 4.0 * explicit, False, np.zeros((NODES + 1, 6)), 0
    before = h
    memory[SHORT] = 0.0
    while taken < 100 and y[6] < end:
        start = five(y)
        h = min(h, end - y[6])
        guess = np.empty((NODES, 5))
        f = growth(y[0], y[1], y[2], y[3], y[4], law)
        for i in range(NODES):
            place = 0.5 * h * (POINTS[i] + 1.0)
            if known:
                guess[i] = at(coefficients, 1.0 + place / before)[:5]
            else:
                guess[i, 0] = y[0] + place * (y[2] - law.omega * y[1])
                guess[i, 1] = y[1] + place * (y[3] + law.omega * y[0])
                for v in range(3):
                    guess[i, 2 + v] = y[2 + v] + 0.0 * place * f[v]
        memory[STEPS] += 1.0
        memory[EVALUATIONS] += 40.0
        solved, values = solve(start, h, guess, tolerance, law)
        error = math.inf
        found = coefficients
        if solved:
            found = series(start, y[5], h, values, law)
            error = error_of_series(found, tolerance)
        taken += 1
        if not error <= 1.0:
            h *= max(0.1, 0.8 * error**-0.125) if solved else 0.3
            if h < explicit:
                memory[PATIENCE] *= 2.0
                return y
            continue
        coefficients, known, before = found, True, h
        new = at(coefficients, 1.0)
        until = y[6] + h if h < end - y[6] else end
        record_series(y[6], h, until, coefficients, memory, times, out)
        y = (new[0], new[1], new[2], new[3], new[4], new[5], until)
        s = speed_of(y)
        if crossed_any(y, memory, law):
            return y
        a = growth(y[0], y[1], y[2], y[3], y[4], law)
        falling = -(a[0] * y[2] + a[1] * y[3] + a[2] * y[4]) / s
        h *= min(2.0, 0.8 * max(error, 1e-16) ** -0.125)
        if s > law.friction or (falling > 0.0 and s < falling * h) or creep_of(y[0], y[1], y[2], y[3], y[4], law, 0.01 * tolerance)[0] > 0.0:
            return y
        if h < COST * explicit * s / first_s:
            memory[PATIENCE] *= 2.0
            return y
    return y


@part
def crossed_any(y: Unknowns, memory: FloatArray, law: Law) -> bool:
    """Return whether a surface was crossed, and remember the new side."""
    result = False
    if law.stop > 0.0 and law.gap > 0.0 and memory[SIDE_OF_STOP] * beyond_stop(y, law) < 0.0:
        memory[SIDE_OF_STOP] *= -1.0
        result = True
    if law.rim > 0.0 and memory[SIDE_OF_RIM] * lead(y, law) < 0.0:
        memory[SIDE_OF_RIM] *= -1.0
        result = True
    return result


@part
def begin_slip(
    y: Unknowns, memory: FloatArray, tolerance: float, end: float, times: FloatArray, out: FloatArray, law: Law
) -> Unknowns:
    """Follow slip from rest until an explicit method can continue."""
    n = direction(y[0], y[1], law)
    first, gain, tx, ty, tr = begun(y[0], y[1], n, law)
    h, start = FIRST_SPAN, five(y)
    if first > 0.0 > gain and -2.0 * first / gain < BRIEF:
        last = -2.0 * first / gain
        way = first * last * last / 6.0
        memory[STEPS] += 1.0
        until = min(y[6] + last, end)
        moved = (y[0], y[1], n[0], n[1], n[2], y[5], y[6])
        while memory[RECORDED] < len(times) and times[int(memory[RECORDED])] <= until:
            delay = times[int(memory[RECORDED])] - y[6]
            gone = (0.5 * first + gain * delay / 6.0) * delay * delay
            slip = (first + 0.5 * gain * delay) * delay
            put(out[int(memory[RECORDED])], carried(moved, delay, gone, slip, law))
            memory[RECORDED] += 1.0
        return carried(moved, until - y[6], way, 0.0, law)
    known, coefficients, before, taken = False, np.zeros((NODES + 1, 6)), h, 0
    while y[6] < end:
        guess = np.empty((NODES, 5))
        for i in range(NODES):
            place = 0.5 * h * (POINTS[i] + 1.0)
            if known:
                guess[i] = at(coefficients, 1.0 + place / before)[:5]
                continue
            s = (first + 0.5 * gain * place) * place
            guess[i, 0] = start[0] - place * law.omega * start[1]
            guess[i, 1] = start[1] + place * law.omega * start[0]
            guess[i, 2] = s * (n[0] + place * tx)
            guess[i, 3] = s * (n[1] + place * ty)
            guess[i, 4] = s * (n[2] + place * tr)
        memory[STEPS] += 1.0
        memory[EVALUATIONS] += 40.0
        solved, values = solve(start, h, guess, tolerance, law)
        error = math.inf
        found = coefficients
        if solved:
            found = series(start, y[5], h, values, law)
            error = error_of_series(found, 0.1 * tolerance)
        taken += 1
        if not error <= 1.0:
            h *= max(0.25, 0.8 * error**-0.125) if solved else 0.25
            if known and taken > 40:
                return y
            if h < LEAST_SPAN:
                memory[STATUS] = FAILS
                return y
            continue
        coefficients, known, before = found, True, h
        until = min(y[6] + h, end)
        new = at(coefficients, (until - y[6]) / h)
        record_series(y[6], h, until, coefficients, memory, times, out)
        y = (new[0], new[1], new[2], new[3], new[4], new[5], until)
        start = five(y)
        s = speed_of(y)
        a = growth(y[0], y[1], y[2], y[3], y[4], law)
        falling = a[0] * y[2] + a[1] * y[3] + a[2] * y[4] <= 0.0
        if falling or law.friction * h < RISING * s:
            break
        h *= min(4.0, 0.8 * max(error, 1e-16) ** -0.125)
    memory[STEP], memory[SHORT] = 0.1, 0.0
    return y


@part
def sides(y: Unknowns, memory: FloatArray, law: Law) -> None:
    memory[SIDE_OF_STOP] = math.copysign(1.0, beyond_stop(y, law))
    memory[SIDE_OF_RIM] = math.copysign(1.0, lead(y, law))


def advance(
    state: FloatArray, memory: FloatArray, tolerance: float, end: float, times: FloatArray, out: FloatArray,
    phases: FloatArray, most_steps: int, law: Law,
) -> None:  # fmt: skip
    """Continue a run for about ``most_steps`` steps; ``memory[STATUS]`` tells whether it has ended."""
    y = (state[0], state[1], state[2], state[3], state[4], state[5], state[6])
    stop_at = memory[STEPS] + most_steps
    while y[6] < end and memory[STEPS] < stop_at and memory[STATUS] == RUNS:
        if memory[PHASES] > len(phases) - 3:
            memory[STATUS] = FULL
            break
        s = speed_of(y)
        none = (0.0, 0.0, 0.0, 0.0)
        if s == 0.0 and law.friction > 0.0:
            held = holds_for(y[0], y[1], law)
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
        if memory[PHASE] == 0.0:
            sides(y, memory, law)
        enter(memory, phases, SLIPS, y)
        if law.friction > 0.0:
            left = time_left(y, law)
            if left >= 0.0:
                y = record_falling(y, left, end, memory, times, out, law)
                continue
            creep = creep_of(y[0], y[1], y[2], y[3], y[4], law, 0.01 * tolerance)
            if creep[0] > 0.0:
                y = record_carried(y, end, creep, memory, times, out, law)
                break
            if memory[SHORT] >= memory[PATIENCE]:
                y = slip_stiffly(y, memory, tolerance, end, times, out, law)
                continue
        y = slip_explicitly(y, memory, tolerance, end, times, out, law)
    for v in range(7):
        state[v] = y[v]
    if y[6] >= end and memory[STATUS] == RUNS:
        memory[STATUS] = ENDS
