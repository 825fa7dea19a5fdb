"""Slip by collocation: where it begins, and where slow slip makes explicit steps short."""

import math

import numpy as np

from reference_model.core.forces.law import CENTRE, Law, seen_from
from reference_model.core.forces.points import centre_slip
from reference_model.core.forces.rates import growth
from reference_model.core.memory import (
    EVALUATIONS,
    FAILS,
    PATIENCE,
    RECORDED,
    SHORT,
    SPAN,
    STATUS,
    STEP,
    STEPS,
    WORK,
    along,
    carried,
    pending,
    put,
    speed_of,
)
from reference_model.core.recording import record_series
from reference_model.core.rest import begun, drift
from reference_model.core.slip import creep_from, point_for
from reference_model.core.steps.collocation import NODES, SHARES, at, error_of, series, solve
from reference_model.core.steps.explicit import Unknowns
from reference_model.core.surfaces import crosses_any, sides
from reference_model.numerics.parts import part, written_out
from reference_model.systems import FloatArray

FIRST_SPAN, LEAST_SPAN = 0.03, 1e-12
"""First step from rest, which shrinks until the motion is resolved, and smallest step."""

BRIEF = 1e-5
"""Longest slip from rest in closed form; its relative error is of this order."""

COST = 4.0
"""Work of a step of collocation in explicit steps, where it replaces several explicit steps."""

WORK_OF_STEP = 50.0
"""Its work in explicit steps, for the length of a call."""

FAST = 2.0 / 3.0
"""Pace of stretched time where slip is so fast that friction turns it at the rate 1."""

DAMPED = 3.0
"""Step times the rates of the dampers, below which the dampers do not limit an explicit step."""

RISING = 10.0
"""Rate of relaxation times the step below which an explicit method is as efficient."""

MOST_STEPS = 100
"""Largest number of steps until another description of slip is tried."""

FIRST_STEP = 0.1
"""First explicit step in stretched time after slip from rest."""


@part
def six(y: Unknowns) -> FloatArray:
    """Return the unknowns without the time, shape (6,)."""
    result = np.empty(6)
    for v in range(6):
        result[v] = y[v]
    return result


@part
def ahead(coefficients: FloatArray, h: float, before: float) -> FloatArray:
    """Return the extrapolation of a step of length ``before`` to the nodes of the next step, shape (NODES, 6)."""
    guess = np.empty((NODES, 6))
    for i in range(NODES):
        there = at(coefficients, 1.0 + h * SHARES[i] / before)
        for v in range(6):
            guess[i, v] = there[v]
    return guess


@part
def attempted(
    start: FloatArray,
    h: float,
    guess: FloatArray,
    least: float,
    tolerance: float,
    memory: FloatArray,
    law: Law,
) -> tuple[float, FloatArray, bool]:
    """Return the error in tolerances and the coefficients of a step by collocation, and whether it meets a kink.

    The error is infinite if Newton's method fails, or if a step longer than ``least`` crosses a kink of the forces.
    """
    memory[WORK] += WORK_OF_STEP
    memory[EVALUATIONS] += 40.0
    solved, values = solve(start, h, guess, law)
    if not solved or (h > least and crosses_any(values, memory, law)):
        return math.inf, values, solved
    found = series(start, values)
    return error_of(found, tolerance, law), found, False


@written_out
def slip_stiffly(
    y: Unknowns,
    memory: FloatArray,
    tolerance: float,
    end: float,
    times: FloatArray,
    out: FloatArray,
    law: Law,
) -> Unknowns:
    """Take steps by collocation while they pay."""
    first_speed, explicit = speed_of(y, law), max(memory[SPAN], LEAST_SPAN)
    h, known, coefficients = 4.0 * explicit, False, np.zeros((NODES + 1, 6))
    before = h
    memory[SHORT] = 0.0
    for _ in range(MOST_STEPS):
        if y[6] >= end:
            break
        start = six(y)
        h = min(h, end - y[6])
        guess = ahead(coefficients, h, before) if known else np.ones((NODES, 1)) * start
        error, found, _ = attempted(start, h, guess, 0.0, tolerance, memory, law)
        if not error <= 1.0:
            h *= max(0.1, 0.8 * error**-0.125) if error < math.inf else 0.3
            if h < explicit:
                memory[PATIENCE] *= 2.0
                return y
            continue
        memory[STEPS] += 1.0
        coefficients, known, before = found, True, h
        new = at(coefficients, 1.0)
        until = y[6] + h if h < end - y[6] else end
        record_series(y[6], h, until, coefficients, memory, times, out, law)
        y = (new[0], new[1], new[2], new[3], new[4], new[5], until)
        s = speed_of(y, law)
        a = growth(y[0], y[1], y[2], y[3], y[4], y[5], law)
        fall = -along((0.0, 0.0, a[0], a[1], a[2], 0.0, 0.0), y, law) / s
        h *= min(2.0, 0.8 * max(error, 1e-16) ** -0.125)
        if (
            (a[3] > FAST and h * (law.damping + law.shaft) < DAMPED)
            or point_for(y, law) != law.point
            or (fall > 0.0 and s < fall * h)
            or creep_from(y, tolerance, law)[0] > 0.0
        ):
            return y
        if h < COST * explicit * s / first_speed:
            memory[PATIENCE] *= 2.0
            return y
    return y


@written_out
def begin_slip(
    y: Unknowns, n: tuple[float, float, float], memory: FloatArray, tolerance: float, end: float, times: FloatArray,
    out: FloatArray, law: Law,
) -> Unknowns:  # fmt: skip
    """Follow slip from rest in the direction ``n`` until an explicit method can continue."""
    first, gain, tx, ty, tr = begun(y, n, law)
    memory[STEP], memory[SHORT] = FIRST_STEP, 0.0
    if first > 0.0 > gain and -2.0 * first / gain < BRIEF and at_rest(y, law):
        return slip_briefly(y, n, first, gain, memory, end, times, out, law)
    if law.sense != 0.0:
        return y
    growing = drift(y, law)[2]
    sides((y[0], y[1], n[0], n[1], n[2] if law.point == CENTRE else y[4], y[5], y[6]), memory, law)
    h, start = FIRST_SPAN, six(y)
    known, coefficients, before = False, np.zeros((NODES + 1, 6)), h
    for _ in range(MOST_STEPS):
        if y[6] >= end:
            break
        if known:
            guess = ahead(coefficients, h, before)
        else:
            guess = np.empty((NODES, 6))
            for i in range(NODES):
                place = h * SHARES[i]
                s = (first + 0.5 * gain * place) * place
                guess[i, 2] = s * (n[0] + place * tx)
                guess[i, 3] = s * (n[1] + place * ty)
                guess[i, 4] = s * (n[2] + place * tr) if law.point == CENTRE else start[4] + place * growing
        error, found, kink = attempted(start, h, guess, BRIEF, 0.1 * tolerance, memory, law)
        if kink and known:
            break
        if not error <= 1.0:
            h *= max(0.25, 0.8 * error**-0.125)
            if h < LEAST_SPAN:
                memory[STATUS] = FAILS
                break
            continue
        memory[STEPS] += 1.0
        coefficients, known, before = found, True, h
        until = min(y[6] + h, end)
        new = at(coefficients, (until - y[6]) / h)
        record_series(y[6], h, until, coefficients, memory, times, out, law)
        y = (new[0], new[1], new[2], new[3], new[4], new[5], until)
        start = six(y)
        a = growth(y[0], y[1], y[2], y[3], y[4], y[5], law)
        falling = along((0.0, 0.0, a[0], a[1], a[2], 0.0, 0.0), y, law) <= 0.0
        if falling or 2.0 * (1.0 - a[3]) * h < RISING * a[3]:
            break
        h *= min(4.0, 0.8 * max(error, 1e-16) ** -0.125)
    return y


@part
def at_rest(y: Unknowns, law: Law) -> bool:
    """Return whether the disc rests as a whole, if the slip is zero."""
    return law.point == CENTRE or y[4] == 0.0


@part
def slip_briefly(
    y: Unknowns, n: tuple[float, float, float], first: float, gain: float, memory: FloatArray, end: float,
    times: FloatArray, out: FloatArray, law: Law,
) -> Unknowns:  # fmt: skip
    """Follow slip s = first·t + ½·gain·t² along ``n`` to its end, where the body rests again."""
    last = -2.0 * first / gain
    ux, uy = centre_slip(n[0], n[1], n[2], y[5], law)
    law = seen_from(CENTRE, 0.0, law)
    moved = (y[0], y[1], ux, uy, n[2], y[5], y[6])
    until = min(y[6] + last, end)
    while pending(memory, times, until):
        put(
            out[int(memory[RECORDED])],
            briefly(moved, times[int(memory[RECORDED])] - y[6], first, gain, law),
            law,
        )
        memory[RECORDED] += 1.0
    memory[WORK] += 1.0
    memory[STEPS] += 1.0
    reached = briefly(moved, until - y[6], first, gain, law)
    if y[6] + last <= end:
        return (reached[0], reached[1], 0.0, 0.0, 0.0, reached[5], until)
    return (reached[0], reached[1], reached[2], reached[3], reached[4], reached[5], until)


@part
def briefly(moved: Unknowns, delay: float, first: float, gain: float, law: Law) -> Unknowns:
    """Return the unknowns after ``delay`` of slip in the direction that takes the place of slip in ``moved``."""
    way = (0.5 * first + gain * delay / 6.0) * delay * delay
    return carried(moved, delay, way, (first + 0.5 * gain * delay) * delay, law)
