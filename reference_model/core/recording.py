"""Unknowns at the requested times, within steps and in closed form."""

import math

from reference_model.core.forces.law import CENTRE, Law
from reference_model.core.forces.rates import rates
from reference_model.core.memory import EVALUATIONS, RECORDED, carried, pending, put
from reference_model.core.steps.collocation import at
from reference_model.core.steps.explicit import (
    SIZE,
    Unknowns,
    component,
    error_of,
    factor_of,
    inside,
    interpolate,
    take,
)
from reference_model.numerics.parts import part
from reference_model.systems import FloatArray

MARGIN, MOST_PIECES = 1.2, 32.0
"""Safety factor of the number of parts of a step, and its largest value."""

NEAR = 1e-8
"""Last correction in Newton's method, before the next one is rounding error."""

MOST_CORRECTIONS = 20

Creep = tuple[float, float, float, float]


@part
def defect(h: float, F: FloatArray, tolerance: float, law: Law) -> float:
    """Return the defect of the interpolant in the middle of a step, over half of it, in tolerances."""
    y = inside(F, 0.5)
    found = rates(y[0], y[1], y[2], y[3], y[4], y[5], law)
    error = 0.0
    for v in range(SIZE):
        scale = tolerance * (1.0 + abs(y[v]) if v < 5 else 1.0)
        error = max(error, 0.5 * abs(component(F, 0.5, v)[1] - h * found[v]) / scale)
    return error


@part
def record(
    y: Unknowns, f: Unknowns, new: Unknowns, last: Unknowns, h: float, tolerance: float, memory: FloatArray,
    times: FloatArray, out: FloatArray, law: Law, K: FloatArray, F: FloatArray,
) -> None:  # fmt: skip
    """Record times within an explicit step from ``y`` to ``new``, where the rates are ``f`` and ``last``.

    If the interpolant is less accurate than the step, shorter steps and their interpolants replace it.
    """
    interpolate(y, new, last, h, law, K, F)
    memory[EVALUATIONS] += 4.0
    error = defect(h, F, tolerance, law)
    if error <= 1.0:
        record_step(y, new, F, memory, times, out, law)
        return
    left, step = h, h / int(min(1.0 + MARGIN * error**0.125, MOST_PIECES))
    while pending(memory, times, new[6]):
        step = min(step, left)
        there, third, fifth = take(y, f, step, law, K)
        memory[EVALUATIONS] += 11.0
        error = step * error_of(y, there, third, fifth, tolerance, law)
        if not error <= 1.0 and step > h / MOST_PIECES:
            step *= factor_of(error)
            continue
        then = last
        if step < left:
            then = rates(there[0], there[1], there[2], there[3], there[4], there[5], law)
        else:
            there = new
        if pending(memory, times, there[6]):
            interpolate(y, there, then, step, law, K, F)
            memory[EVALUATIONS] += 4.0
            record_step(y, there, F, memory, times, out, law)
        y, f, left = there, then, left - step


@part
def record_step(
    y: Unknowns,
    new: Unknowns,
    F: FloatArray,
    memory: FloatArray,
    times: FloatArray,
    out: FloatArray,
    law: Law,
) -> None:
    """Record times within an explicit step by its interpolant."""
    while pending(memory, times, new[6]):
        t = times[int(memory[RECORDED])]
        place = (t - y[6]) / (new[6] - y[6])
        for _ in range(MOST_CORRECTIONS):
            reached, pace = component(F, place, 6)
            change = (t - reached) / pace if pace > 0.0 else 0.0
            place = min(max(place + change, 0.0), 1.0)
            if abs(change) < NEAR:
                break
        put(out[int(memory[RECORDED])], inside(F, place), law)
        memory[RECORDED] += 1.0


@part
def record_series(
    t: float,
    h: float,
    end: float,
    coefficients: FloatArray,
    memory: FloatArray,
    times: FloatArray,
    out: FloatArray,
    law: Law,
) -> None:
    """Record times within a step of collocation that begins at ``t``."""
    while pending(memory, times, end):
        found = at(coefficients, (times[int(memory[RECORDED])] - t) / h)
        put(
            out[int(memory[RECORDED])], (found[0], found[1], found[2], found[3], found[4], found[5], 0.0), law
        )
        memory[RECORDED] += 1.0


@part
def creeping(y: Unknowns, delay: float, creep: Creep, law: Law) -> Unknowns:
    """Return the unknowns of a body that creeps, or sticks if the first number of ``creep`` is zero."""
    share, slow, rest, fast = creep
    if share == 0.0:
        return carried(y, delay, 0.0, 0.0, law)
    s = share + rest
    slip = share * math.exp(-slow * delay) + rest * math.exp(-fast * delay)
    way = -share / slow * math.expm1(-slow * delay) - rest / fast * math.expm1(-fast * delay)
    return carried(y, delay, way / s, slip / s, law)


@part
def record_carried(
    y: Unknowns, until: float, creep: Creep, memory: FloatArray, times: FloatArray, out: FloatArray, law: Law
) -> Unknowns:
    """Record a body that sticks or creeps until a time; return its unknowns then."""
    while pending(memory, times, until):
        put(out[int(memory[RECORDED])], creeping(y, times[int(memory[RECORDED])] - y[6], creep, law), law)
        memory[RECORDED] += 1.0
    end = creeping(y, until - y[6], creep, law)
    return (end[0], end[1], end[2], end[3], end[4], end[5], until)


@part
def record_falling(
    y: Unknowns, left: float, end: float, memory: FloatArray, times: FloatArray, out: FloatArray, law: Law
) -> Unknowns:
    """Follow the last ``left`` of slip, which falls linearly; return the body at rest, or at the end of the run."""
    until = min(y[6] + left, end)
    while pending(memory, times, until):
        put(out[int(memory[RECORDED])], falling(y, times[int(memory[RECORDED])] - y[6], left, law), law)
        memory[RECORDED] += 1.0
    last = falling(y, until - y[6], left, law)
    if y[6] + left <= end:
        return (last[0], last[1], 0.0, 0.0, 0.0 if law.point == CENTRE else last[4], last[5], until)
    return (last[0], last[1], last[2], last[3], last[4], last[5], until)


@part
def falling(y: Unknowns, delay: float, left: float, law: Law) -> Unknowns:
    """Return the unknowns after ``delay`` of slip that falls linearly to zero within ``left``."""
    share = delay / left if left > 0.0 else 1.0
    if law.point == CENTRE:
        return carried(y, delay, delay * (1.0 - 0.5 * share), 1.0 - share, law)
    # The disc turns about a point that comes to rest; the midpoint rule gives its motion.
    f = rates(y[0], y[1], y[2], y[3], y[4], y[5], law)
    first, half = 0.5 * delay / f[6], 1.0 - 0.5 * share
    f = rates(
        y[0] + first * f[0], y[1] + first * f[1], half * y[2], half * y[3], y[4] + first * f[4], y[5] + first * f[5],
        law,
    )  # fmt: skip
    whole = delay / f[6]
    return (
        y[0] + whole * f[0], y[1] + whole * f[1], (1.0 - share) * y[2], (1.0 - share) * y[3], y[4] + whole * f[4],
        y[5] + whole * f[5], y[6] + delay,
    )  # fmt: skip
