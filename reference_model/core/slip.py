"""Slip by explicit steps in stretched time, and how it ends."""

import math

from reference_model.core.forces.law import CENTRE, Law, seen_from
from reference_model.core.forces.points import centre_slip, point_to_follow
from reference_model.core.forces.rates import growth, rates
from reference_model.core.limit import LEAST_SLIP
from reference_model.core.memory import (
    EVALUATIONS,
    FAILS,
    PATIENCE,
    SHORT,
    SIDE_OF_HOLE,
    SIDE_OF_SPIN,
    SIDE_OF_STOP,
    SPAN,
    STATUS,
    STEP,
    STEPS,
    WORK,
    along,
    carried,
    pending,
    seen,
    speed_of,
)
from reference_model.core.recording import Creep, record
from reference_model.core.rest import NOISE, creep_of
from reference_model.core.steps.explicit import Unknowns, component, error_of, factor_of, interpolate, take
from reference_model.core.surfaces import crossing, grip, may_cross
from reference_model.numerics.parts import inlined, part
from reference_model.systems import FloatArray

REST_TIME = 1e-12
"""Largest error of the closed form for the time of coming to rest."""

REVERSAL = 1e-13
"""Slip below which slip that friction cannot hold counts as reversed; less for a point if the spin is slow too."""

SOON = 0.1
"""Longest time to the end of slip below REVERSAL while slip is a parabola; the body moves by 1e-14 in it."""

FROZEN = 1e-9
"""Pace of stretched time below which explicit steps are so short that time hardly grows."""

USUAL = 0.02
"""A step is short if relative change of slip plus time are below this."""

LEAST_STEP = 1e-14
"""Smallest explicit step in stretched time."""

SLOW, TURNED_BACK = 1e-3, 256.0
"""Slip speed below which slip must not turn back in a step, and the error assigned if it does."""

COMMON_REST = 1e-11
"""Slip speed below which all points of a disc come to rest together."""

CREEP_SHARE = 0.01
"""Largest error of creep in closed form, as a share of the tolerance of a step."""

NOWHERE, AT_END = -1, -2
"""Events of a step in addition to the indices of the surfaces."""


@part
def time_left(y: Unknowns, f: Unknowns, law: Law) -> float:
    """Return the time to rest if slip is about to end, 0 if only rounding error is left of it, -1 otherwise.

    ``f`` are the rates in stretched time. A pivot ends at a surface instead.
    """
    s = speed_of(y, law)
    if law.friction == 0.0 or law.sense != 0.0 or not s > 0.0:
        return -1.0
    fall = -along(f, y, law) / (s * f[6])
    if fall <= 0.0:
        return -1.0
    left = s / fall
    reversal = REVERSAL if law.point == CENTRE else REVERSAL * min(1.0, abs(y[4]) / SLOW)
    near = left * left < REST_TIME
    ends = s < reversal and (near or (law.point == CENTRE and left < SOON))
    if law.point == CENTRE and (near or ends):
        growing = (fall_after(y, s, left, law) - fall) / left
        left = 2.0 * s / (fall + math.sqrt(max(fall * fall + 2.0 * growing * s, 0.0)))
    if near and not ends:
        across, pace = 0.0, abs(law.omega) + law.shaft + 1.0
        for v in range(2, 5 if law.point == CENTRE else 4):
            across += (f[v] / f[6] + fall * y[v] / s) ** 2
        if law.point != CENTRE:
            pace += abs(y[4]) / law.gyration
        together = len(law.around) > 0 and law.point == CENTRE and s < COMMON_REST
        # The fall is stationary if slip is aligned with it, so the error is quadratic in the misalignment.
        ends = together or left * across / (fall * fall) + left * left * pace < REST_TIME
    if ends:
        return left
    return 0.0 if s < reversal and max(s, fall) < 10.0 * NOISE * law.friction else -1.0


@part
def fall_after(y: Unknowns, s: float, left: float, law: Law) -> float:
    """Return how fast the slip of the centre falls when it ends, ``left`` after it had the speed ``s``."""
    share = LEAST_SLIP / s
    end = carried(y, left, 0.5 * left, share, law)
    a = growth(end[0], end[1], end[2], end[3], end[4], end[5], law)
    return -(a[0] * end[2] + a[1] * end[3] + a[2] * end[4]) / LEAST_SLIP


@part
def ends_together(y: Unknowns, law: Law) -> bool:
    """Return whether a disc with a slowly slipping point comes to rest as a whole."""
    if law.point == CENTRE or law.sense != 0.0 or abs(y[4]) > SLOW:
        return False
    whole = seen_from(CENTRE, 0.0, law)
    y = seen(y, law, whole)
    return time_left(y, rates(y[0], y[1], y[2], y[3], y[4], y[5], whole), whole) >= 0.0


@part
def creep_from(y: Unknowns, tolerance: float, law: Law) -> Creep:
    """Return :func:`creep_of` of these unknowns, seen from the centre unless the disc turns about a point."""
    if law.point != CENTRE and law.sense == 0.0:
        whole = seen_from(CENTRE, 0.0, law)
        return creep_of(seen(y, law, whole), whole, CREEP_SHARE * tolerance)
    creep = creep_of(y, law, CREEP_SHARE * tolerance)
    if creep[0] > 0.0 and law.sense != 0.0 and grip(y, law) <= 0.0:
        return (0.0, 0.0, 0.0, 0.0)
    return creep


@inlined
def is_frozen(f: Unknowns, law: Law) -> bool:
    """Return whether explicit steps of a body with the rates ``f`` would hardly let the time grow."""
    return law.point == CENTRE and f[6] < FROZEN


@part
def slip_ends(y: Unknowns, f: Unknowns, memory: FloatArray, tolerance: float, law: Law) -> bool:
    """Return whether explicit steps should not go on."""
    return (
        memory[SHORT] >= memory[PATIENCE] or is_frozen(f, law) or time_left(y, f, law) >= 0.0
        or creep_from(y, tolerance, law)[0] > 0.0
        or point_for(y, law) != law.point or ends_together(y, law)
    )  # fmt: skip


@inlined
def point_for(y: Unknowns, law: Law) -> int:
    """Return the contact point whose slip should be an unknown, or the centre."""
    if len(law.around) == 0 or law.sense != 0.0:
        return law.point
    ux, uy = centre_slip(y[2], y[3], y[4], y[5], law)
    return point_to_follow(ux, uy, y[4], y[5], law)


@part
def first_event(
    y: Unknowns,
    new: Unknowns,
    h: float,
    end: float,
    memory: FloatArray,
    law: Law,
    K: FloatArray,
    F: FloatArray,
) -> tuple[float, int]:
    """Return the share of a step up to the first crossing of a surface or the end of the run, and which it is."""
    reached = new[6] > end
    for which in range(SIDE_OF_STOP, SIDE_OF_SPIN + 1):
        reached = reached or may_cross(which, memory[which], y, new, law)
    if not reached:
        return 1.0, NOWHERE
    place, event = 1.0, NOWHERE
    last = rates(new[0], new[1], new[2], new[3], new[4], new[5], law)
    interpolate(y, new, last, h, law, K, F)
    memory[EVALUATIONS] += 4.0
    if new[6] > end:
        place, event = (end - y[6]) / (new[6] - y[6]), AT_END
        for _ in range(20):
            moment, pace = component(F, place, 6)
            change = (end - moment) / pace if pace > 0.0 else 0.0
            place = min(max(place + change, 0.0), 1.0)
            if abs(change) < 1e-15:
                break
    for which in range(SIDE_OF_STOP, SIDE_OF_SPIN + 1):
        if may_cross(which, memory[which], y, new, law):
            share = crossing(which, memory[which], y, F, law)
            if share < place:
                place, event = share, which
    return place, event


@part
def slide(
    y: Unknowns, memory: FloatArray, tolerance: float, end: float, most_work: float, times: FloatArray,
    out: FloatArray, law: Law, K: FloatArray, F: FloatArray,
) -> Unknowns:  # fmt: skip
    """Take explicit steps until slip ends or is stiff, or the work of this call is done."""
    f = rates(y[0], y[1], y[2], y[3], y[4], y[5], law)
    while True:
        h, most, event = memory[STEP], 10.0, NOWHERE
        usual = h
        while True:
            new, third, fifth = take(y, f, h, law, K)
            memory[WORK] += 1.0
            memory[EVALUATIONS] += 11.0
            error = h * error_of(y, new, third, fifth, tolerance, law)
            if law.sense == 0.0 and along(new, y, law) < 0.0 and speed_of(y, law) < SLOW:
                error = max(error, TURNED_BACK)
            if not error <= 1.0:
                h *= factor_of(error)
                most, event = 1.0, NOWHERE
                if h < LEAST_STEP:
                    memory[STATUS] = FAILS
                    return y
                continue
            if event != NOWHERE:
                break
            usual = h * min(most, factor_of(error))
            place, event = first_event(y, new, h, end, memory, law, K, F)
            if event == NOWHERE:
                break
            h *= place
        last = rates(new[0], new[1], new[2], new[3], new[4], new[5], law)
        memory[EVALUATIONS] += 1.0
        if event == AT_END:
            late = (end - new[6]) / last[6]
            new = (
                new[0] + late * last[0], new[1] + late * last[1], new[2] + late * last[2], new[3] + late * last[3],
                new[4] + late * last[4], new[5] + late * last[5], end,
            )  # fmt: skip
        elif event != NOWHERE:
            memory[event] = -memory[event]
        if pending(memory, times, new[6]):
            record(y, f, new, last, h, tolerance, memory, times, out, law, K, F)
        memory[STEP] = usual
        memory[STEPS] += 1.0
        apart = (0.0, 0.0, new[2] - y[2], new[3] - y[3], new[4] - y[4], 0.0, 0.0)
        memory[SPAN] = new[6] - y[6]
        short = memory[SPAN] + speed_of(apart, law) / (speed_of(new, law) + 1e-300) < USUAL
        memory[SHORT] = max(0.0, memory[SHORT] + (1.0 if short and law.sense == 0.0 else -1.0))
        y, f = new, last
        if (
            y[6] >= end
            or memory[WORK] >= most_work
            or event > SIDE_OF_HOLE
            or slip_ends(y, f, memory, tolerance, law)
        ):
            return y
