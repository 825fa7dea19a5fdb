"""The pin in lanes: what stands where, the step of all lanes, and what a single lane does at rest and at its end."""

from __future__ import annotations

from typing import Any

from reference_model.ensemble.core.dense_output import Arc, Motion, arc_between, size_of
from reference_model.ensemble.core.jit import inlined, scalar, written_out
from reference_model.ensemble.core.lanes import LANES
from reference_model.ensemble.core.laws import PinLaw
from reference_model.ensemble.core.runge_kutta import error_of, factor_of, step
from reference_model.ensemble.pin.slip import pin_rates

X, Y, WX, WY, TIME, WAY, KX, KY, KWX, KWY, SHARE, KWAY, STEP = range(13)
"""Slots of a lane: place, slip velocity, time, way slipped; their rates; the step that comes. All scaled, as in a
unit."""

TRIAL = STEP + 1
"""How much further on the same stands after the step on trial."""

(
    STIFFNESS, DAMPING, FRICTION, DISC_SPEED, OFFSET, STRETCHING, FREE,
    TOLERANCE, SLOW, DUE, WATCH, FLAG, STEPS, MOST_STEPS, SHORT, SLOTS,
) = range(2 * TRIAL, 2 * TRIAL + 16)  # fmt: skip
"""The law; the tolerance of a step; the slip speed below which rest may be near; the time at which the lane wants to
be attended; how closely it is watched; why it wants to be attended; steps so far and at most; how many of the last
were short; the number of slots."""

UNWATCHED, TURNS, RADII = 0.0, 1.0, 2.0
"""A lane may be attended whenever x is largest, and also whenever the radius is largest or smallest."""

REST, IS_DUE, RIGHTMOST, EXTREME, LOST, STIFF = 1, 2, 4, 8, 16, 32
"""Flags, which add up: slip is about to end; the time has come; x was largest; so was the radius, or smallest; step
size or number of steps are beyond what is sensible; an implicit step may be worth its while."""

STEPS_TO_SPARE, STEPS_A_TIME = 50_000.0, 2000.0
"""A motion that takes more steps than these, the second in a unit of time, is given up, undecided."""

SHORT_STEP, MANY = 5e-3, 40.0
"""Time, in its unit, below which a step is short, and so many of them one after the other are more than coming to
rest or letting go takes: it is stability that limits them. One implicit step costs as much as some 50 of a single
trajectory, or a thousand of one among others in lanes."""

SMALLEST_STEP = 1e-13

LANDING = 1e-9
"""Distance from the end, in units of time, that is bridged by the rates: the error is of its square."""

FIRST_STEP = 0.3
"""Of a trajectory and after a rest, in units of time where slip is fast."""


@written_out
def _advance_in(scratch: Any, lanes: int) -> None:
    """Make a trial step in the first ``lanes``; where its error is too large the trial is the old state."""
    for lane in range(lanes):
        y = (
            scratch[X * LANES + lane],
            scratch[Y * LANES + lane],
            scratch[WX * LANES + lane],
            scratch[WY * LANES + lane],
        )
        k = (
            scratch[KX * LANES + lane],
            scratch[KY * LANES + lane],
            scratch[KWX * LANES + lane],
            scratch[KWY * LANES + lane],
            scratch[SHARE * LANES + lane],
            scratch[KWAY * LANES + lane],
        )
        law = PinLaw(
            scratch[STIFFNESS * LANES + lane],
            scratch[DAMPING * LANES + lane],
            scratch[FRICTION * LANES + lane],
            scratch[DISC_SPEED * LANES + lane],
            scratch[OFFSET * LANES + lane],
            scratch[STRETCHING * LANES + lane],
            scratch[FREE * LANES + lane],
        )
        h, t, way = scratch[STEP * LANES + lane], scratch[TIME * LANES + lane], scratch[WAY * LANES + lane]
        mean, third, fifth = step(pin_rates, law, y, k, h)
        x, y_ = y[0] + h * mean[0], y[1] + h * mean[1]
        wx, wy = y[2] + h * mean[2], y[3] + h * mean[3]
        new = pin_rates((x, y_, wx, wy), law)
        later = t + h * mean[4]
        error = error_of(y, (x, y_, wx, wy), h, third, fifth, scratch[TOLERANCE * LANES + lane])
        good = error < 1.0
        shorter = h * factor_of(error)

        slow, watch = scratch[SLOW * LANES + lane], scratch[WATCH * LANES + lane]
        count = scratch[STEPS * LANES + lane] + 1.0
        flag = reasons(y, k, (x, y_, wx, wy), new, later, scratch[DUE * LANES + lane], slow, watch)
        flag = flag if good else 0.0
        lost = (shorter < SMALLEST_STEP) | (count > scratch[MOST_STEPS * LANES + lane])
        short = scratch[SHORT * LANES + lane] + 1.0 if later - t < SHORT_STEP else 0.0
        flag += STIFF if short > MANY else 0.0

        scratch[SHORT * LANES + lane] = short
        scratch[FLAG * LANES + lane] = flag + (LOST if lost else 0.0)
        scratch[STEPS * LANES + lane] = count
        scratch[(TRIAL + X) * LANES + lane] = x if good else y[0]
        scratch[(TRIAL + Y) * LANES + lane] = y_ if good else y[1]
        scratch[(TRIAL + WX) * LANES + lane] = wx if good else y[2]
        scratch[(TRIAL + WY) * LANES + lane] = wy if good else y[3]
        scratch[(TRIAL + TIME) * LANES + lane] = later if good else t
        scratch[(TRIAL + WAY) * LANES + lane] = way + h * mean[5] if good else way
        scratch[(TRIAL + KX) * LANES + lane] = new[0] if good else k[0]
        scratch[(TRIAL + KY) * LANES + lane] = new[1] if good else k[1]
        scratch[(TRIAL + KWX) * LANES + lane] = new[2] if good else k[2]
        scratch[(TRIAL + KWY) * LANES + lane] = new[3] if good else k[3]
        scratch[(TRIAL + SHARE) * LANES + lane] = new[4] if good else k[4]
        scratch[(TRIAL + KWAY) * LANES + lane] = new[5] if good else k[5]
        scratch[(TRIAL + STEP) * LANES + lane] = shorter


@scalar
def advance(scratch: Any, _: None) -> None:
    """Make a trial step in every lane."""
    _advance_in(scratch, LANES)


@scalar
def advance_alone(scratch: Any, _: None) -> None:
    """Make a trial step in the first lane."""
    _advance_in(scratch, 1)


@inlined
def reasons(
    y: Any, k: Any, after: Any, rates: Any, later: float, due: float, slow: float, watch: float
) -> float:
    """Return the flags of a step from ``y`` with the rates ``k`` to what is ``after``, at the time ``later``."""
    x, y_, wx, wy = after
    resting = (wx * wx + wy * wy < slow * slow) & (wx * rates[2] + wy * rates[3] < 0.0)
    rightmost = (k[0] > 0.0) & (rates[0] <= 0.0) & (watch >= TURNS)
    extreme = ((y[0] * k[0] + y[1] * k[1] > 0.0) != (x * rates[0] + y_ * rates[1] > 0.0)) & (watch >= RADII)
    flag = REST if resting else 0.0
    flag += IS_DUE if later >= due else 0.0
    flag += RIGHTMOST if rightmost else 0.0
    flag += EXTREME if extreme else 0.0
    return flag


@scalar
def idle(scratch: Any, lane: int) -> None:
    """Put into a lane what goes on for ever without being attended."""
    for slot in range(SLOTS):
        scratch[slot * LANES + lane] = 0.0
    for slot in (STRETCHING, TOLERANCE, DUE, TRIAL + STEP):
        scratch[slot * LANES + lane] = 1.0


@scalar
def law_of(scratch: Any, lane: int) -> PinLaw:
    """Return the law of a lane."""
    return PinLaw(
        scratch[STIFFNESS * LANES + lane],
        scratch[DAMPING * LANES + lane],
        scratch[FRICTION * LANES + lane],
        scratch[DISC_SPEED * LANES + lane],
        scratch[OFFSET * LANES + lane],
        scratch[STRETCHING * LANES + lane],
        scratch[FREE * LANES + lane],
    )


@inlined
def place_of(scratch: Any, lane: int, block: int) -> complex:
    """Return z; ``block`` is 0 before the step and TRIAL after it."""
    return complex(scratch[(block + X) * LANES + lane], scratch[(block + Y) * LANES + lane])


@inlined
def slip_of(scratch: Any, lane: int, block: int) -> complex:
    """Return w; ``block`` as for :func:`place_of`."""
    return complex(scratch[(block + WX) * LANES + lane], scratch[(block + WY) * LANES + lane])


@scalar
def put_slipping(scratch: Any, lane: int, z: complex, w: complex, law: PinLaw) -> None:
    """Put a slipping pin into the slots of the trial, with a first step."""
    put_motion(scratch, lane, z, w, law)
    scratch[SHORT * LANES + lane] = 0.0
    h = FIRST_STEP
    if law.friction > 0.0:
        h = min(h, (abs(w) + law.stretching) / law.friction)  # the direction of slip is slaved no faster
    scratch[(TRIAL + STEP) * LANES + lane] = h


@inlined
def put_motion(scratch: Any, lane: int, z: complex, w: complex, law: PinLaw) -> None:
    """Put a slipping pin and its rates into the slots of the trial."""
    k = pin_rates((z.real, z.imag, w.real, w.imag), law)
    put_place(scratch, lane, z, w)
    for i in range(6):
        scratch[(TRIAL + KX + i) * LANES + lane] = k[i]


@inlined
def put_place(scratch: Any, lane: int, z: complex, w: complex) -> None:
    """Put place and slip velocity into the slots of the trial."""
    scratch[(TRIAL + X) * LANES + lane] = z.real
    scratch[(TRIAL + Y) * LANES + lane] = z.imag
    scratch[(TRIAL + WX) * LANES + lane] = w.real
    scratch[(TRIAL + WY) * LANES + lane] = w.imag


@scalar
def landed(scratch: Any, lane: int, end: float) -> bool:
    """Tell whether the step ends at the time ``end``, and put it there; else take it back, to be done shorter.

    By Newton's method on the step: its rate of time at the end is known.
    """
    beyond, share = scratch[(TRIAL + TIME) * LANES + lane] - end, scratch[(TRIAL + SHARE) * LANES + lane]
    if beyond > LANDING:
        h = scratch[STEP * LANES + lane]
        for i in range(TRIAL):
            scratch[(TRIAL + i) * LANES + lane] = scratch[i * LANES + lane]
        shorter = h - beyond / share
        scratch[(TRIAL + STEP) * LANES + lane] = shorter if 0.0 < shorter < h else 0.5 * h
        return False
    for i in range(4):
        rate = scratch[(TRIAL + KX + i) * LANES + lane] / share
        scratch[(TRIAL + X + i) * LANES + lane] -= beyond * rate
    scratch[(TRIAL + TIME) * LANES + lane] = end
    return True


@inlined
def motion(z: complex, w: complex, law: PinLaw) -> Motion:
    """Return place, velocity, acceleration and jerk of a slipping pin."""
    s = size_of(w)
    n = w / s
    turn = complex(0.0, law.disc_speed)
    v = w + turn * z
    a = -law.stiffness * (z - law.offset) - law.damping * v - law.friction * n
    growth = a - turn * v  # ẇ
    turning = (growth - n * (n.conjugate() * growth).real) / s
    return Motion(z, v, a, -law.stiffness * v - law.damping * a - law.friction * turning)


@scalar
def last_arc(scratch: Any, lane: int, law: PinLaw) -> Arc:
    """Return the motion in the last step."""
    span = scratch[(TRIAL + TIME) * LANES + lane] - scratch[TIME * LANES + lane]
    first = motion(place_of(scratch, lane, 0), slip_of(scratch, lane, 0), law)
    last = motion(place_of(scratch, lane, TRIAL), slip_of(scratch, lane, TRIAL), law)
    return arc_between(span, first, last)
