"""What is rare in a lane of pins: rest and release, crossings of the section, the end, and what they tell."""

from __future__ import annotations

import math
from typing import Any, NamedTuple

from reference_model.ensemble.checkpoints import ON_THE_WAY, SLIPS, STICKS
from reference_model.ensemble.core.convergence import converged
from reference_model.ensemble.core.dense_output import (
    Arc,
    place_on,
    velocity_on,
    way_along,
    where_radius_turns,
    where_rightmost,
)
from reference_model.ensemble.core.jit import inlined, scalar
from reference_model.ensemble.core.lanes import LANES
from reference_model.ensemble.core.laws import PinLaw, pull, release_delay
from reference_model.ensemble.end_states import EndState
from reference_model.ensemble.pin.end_states import Form, Well, depth
from reference_model.ensemble.pin.lanes import (
    DUE,
    EXTREME,
    FLAG,
    IS_DUE,
    LANDING,
    LOST,
    MOST_STEPS,
    RADII,
    REST,
    RIGHTMOST,
    STEPS,
    STIFF,
    TIME,
    TRIAL,
    TURNS,
    UNWATCHED,
    WATCH,
    WAY,
    landed,
    last_arc,
    law_of,
    place_of,
    put_place,
    put_slipping,
    slip_of,
)
from reference_model.ensemble.pin.memory import (
    DURATION,
    END,
    FORM,
    KNOWN_LARGEST,
    KNOWN_LEAST,
    KNOWN_METRIC,
    KNOWN_REACH,
    KNOWN_SLIP,
    KNOWN_TURN,
    LENGTH,
    LEVEL,
    MEASURED,
    NO_WINDOW,
    OF_RELEASE,
    OF_TURN,
    RATE,
    RELEASE,
    RELEASE_BEFORE,
    RELEASE_COUNT,
    RELEASE_LAST,
    SINCE,
    TICK,
    TURN_BEFORE,
    TURN_COUNT,
    TURN_LAST,
    TURN_V,
    TURN_X,
    TURN_Y,
    WELL_X,
    WELL_Y,
    close_window,
    keep,
    note,
    note_radius,
    open_window,
    takes_notes,
)
from reference_model.ensemble.pin.slip import (
    begin_slip,
    creeping_ends,
    creeps_by_turns,
    creeps_steadily,
    sticking_radius,
    time_to_rest,
)
from reference_model.ensemble.pin.stability import orbit_attracts
from reference_model.ensemble.pin.stride import stride
from reference_model.systems import FloatArray

UNDECIDED, SELF_CENTRED, WHIRL, STUCK, STICK_SLIP = (
    int(EndState.UNDECIDED),
    int(EndState.SELF_CENTRED),
    int(EndState.WHIRL),
    int(EndState.STUCK),
    int(EndState.STICK_SLIP),
)

SERIES_SHARE = 0.1
"""Of the tolerance, for the last terms of the series by which slip begins."""

SPENT_SHARE = 0.1
"""Of the tolerance, for what is left of the slip, and of the way, of a pin that creeps to its place for ever."""

REVERSAL_SLIP = 1e-13
"""Slip, in units, below which slip that friction can't hold counts as turned."""

AFTER_START = 1e-3
"""In units of time: a crossing before it is the start itself, on the section but for rounding."""


class Aims(NamedTuple):
    """What scalar code must know of the task; few arrays, since each costs time in every call.

    ``early`` ends a trajectory as soon as its end state is certain, ``once`` at its first crossing of the section;
    ``known`` (KNOWN,) is what is known of end states beforehand; ``series`` is room for how slip begins.
    """

    tolerance: float
    early: bool
    once: bool
    known: FloatArray
    series: Any


@scalar
def attend(scratch: Any, book: Any, lane: int, aims: Aims) -> bool:
    """See to what the flag of a lane says; return whether its trajectory ends here."""
    page = book[lane]
    law = law_of(scratch, lane)
    if int(scratch[FLAG * LANES + lane]) & STIFF:
        stride(scratch, page, lane, law)
    flag = int(scratch[FLAG * LANES + lane])
    later = scratch[(TRIAL + TIME) * LANES + lane]
    if flag & LOST:
        page[END] = UNDECIDED
        return True
    if flag & IS_DUE and later >= page[DURATION] - LANDING:
        if not landed(scratch, lane, page[DURATION]):
            return False
        settle(scratch, page, lane, law)
        return True
    if flag & IS_DUE and watch_well(scratch, page, lane, later, law, aims):
        return True
    if flag & (RIGHTMOST | EXTREME):
        arc = last_arc(scratch, lane, law)
        turns, u = where_radius_turns(arc), 1.0
        if flag & RIGHTMOST:
            u = where_rightmost(arc)
        if turns <= u:
            note_radius(page, abs(place_on(arc, turns)))
        if flag & RIGHTMOST:
            z, v = place_on(arc, u), velocity_on(arc, u)
            if turn_made(scratch, page, lane, arc, u, law, aims):
                put_place(scratch, lane, z, v - 1j * law.disc_speed * z)
                scratch[(TRIAL + TIME) * LANES + lane] = scratch[TIME * LANES + lane] + u * arc.span
                return True
            if watch_well(scratch, page, lane, later, law, aims):
                return True
        if u < turns <= 1.0:
            note_radius(page, abs(place_on(arc, turns)))  # of a window that opened at u
    if flag & REST:
        return maybe_rest(scratch, page, lane, law, aims)
    return False


@scalar
def watch_well(scratch: Any, page: Any, lane: int, later: float, law: PinLaw, aims: Aims) -> bool:
    """Look whether the motion is captured by the equilibrium, and say when to look again."""
    if scratch[WATCH * LANES + lane] == UNWATCHED and law.friction > 0.0 and page[END] == UNDECIDED:
        scratch[WATCH * LANES + lane] = TURNS
    scratch[DUE * LANES + lane] = min(later + page[TICK], page[DURATION] - LANDING)
    if takes_notes(page):
        note(page, ON_THE_WAY, later, place_of(scratch, lane, TRIAL), slip_of(scratch, lane, TRIAL), law)
    if page[END] != UNDECIDED or not in_well(scratch, page, lane, law):
        return False
    scratch[WATCH * LANES + lane] = UNWATCHED
    page[END] = SELF_CENTRED
    radius = math.hypot(page[WELL_X], page[WELL_Y])
    keep(page, radius, radius, abs(law.disc_speed) * radius)
    return aims.early


@scalar
def in_well(scratch: Any, page: Any, lane: int, law: PinLaw) -> bool:
    """Tell whether the motion is captured by the equilibrium."""
    level: float = page[LEVEL]
    if level <= 0.0:
        return False
    form = Form(
        page[FORM], page[FORM + 1], page[FORM + 2], page[FORM + 3], page[FORM + 4],
        page[FORM + 5], page[FORM + 6], page[FORM + 7], page[FORM + 8], page[FORM + 9],
    )  # fmt: skip
    well = Well(complex(page[WELL_X], page[WELL_Y]), form, level)
    return depth(place_of(scratch, lane, TRIAL), slip_of(scratch, lane, TRIAL), law, well) <= level


@scalar
def turn_made(scratch: Any, page: Any, lane: int, arc: Arc, u: float, law: PinLaw, aims: Aims) -> bool:
    """Take note of a crossing of the section at u on an arc; return whether the trajectory ends."""
    if page[END] != UNDECIDED:
        return False
    z, speed = place_on(arc, u), velocity_on(arc, u).imag
    t = scratch[TIME * LANES + lane] + u * arc.span
    if aims.once:
        if t < AFTER_START:
            return False
        page[END] = WHIRL
        return True
    if in_reach(page, z, speed, law, aims):
        page[END] = WHIRL
        scratch[WATCH * LANES + lane] = UNWATCHED
        return aims.early
    distance = math.sqrt(
        (z.real - page[TURN_X]) ** 2 + (z.imag - page[TURN_Y]) ** 2 + (speed - page[TURN_V]) ** 2
    )
    before, first = page[TURN_LAST], page[TURN_BEFORE]
    page[TURN_X], page[TURN_Y], page[TURN_V] = z.real, z.imag, speed
    page[TURN_LAST], page[TURN_BEFORE] = distance, before
    page[TURN_COUNT] += 1.0
    if page[TURN_COUNT] < 5.0 or not converged(distance, before, first, abs(speed)):
        return False
    way = scratch[WAY * LANES + lane] + way_along(arc, u, law.disc_speed)
    if page[MEASURED] == OF_TURN:
        if not orbit_attracts(z, velocity_on(arc, u), t - page[SINCE], law):
            forget_turns(scratch, page, lane)
            return False
        close_window(page, WHIRL, t, way, abs(z))
        scratch[WATCH * LANES + lane] = UNWATCHED
        return aims.early
    open_window(page, OF_TURN, t, way, abs(z))
    scratch[WATCH * LANES + lane] = RADII
    return False


@scalar
def in_reach(page: Any, z: complex, speed: float, law: PinLaw, aims: Aims) -> bool:
    """Tell whether the motion crosses the section where the known whirl attracts."""
    known, length = aims.known, page[LENGTH]
    if known[KNOWN_REACH] <= 0.0:
        return False
    x, y = z.real * length - known[KNOWN_TURN], z.imag * length - known[KNOWN_TURN + 1]
    v = speed * length / math.sqrt(law.stiffness) - known[KNOWN_TURN + 2]
    square = (
        x * (known[KNOWN_METRIC] * x + 2.0 * (known[KNOWN_METRIC + 1] * y + known[KNOWN_METRIC + 2] * v))
        + y * (known[KNOWN_METRIC + 3] * y + 2.0 * known[KNOWN_METRIC + 4] * v)
        + known[KNOWN_METRIC + 5] * v * v
    )
    if square > known[KNOWN_REACH]:
        return False
    pace = length * page[RATE]
    keep(page, known[KNOWN_LEAST] / length, known[KNOWN_LARGEST] / length, known[KNOWN_SLIP] / pace)
    return True


@scalar
def maybe_rest(scratch: Any, page: Any, lane: int, law: PinLaw, aims: Aims) -> bool:
    """Bring the pin to rest if what is left of slip can be told; return whether the trajectory ends."""
    z, w = place_of(scratch, lane, TRIAL), slip_of(scratch, lane, TRIAL)
    t, s = scratch[(TRIAL + TIME) * LANES + lane], abs(w)
    creeps = creeps_steadily(z, w, law)
    if creeps:
        place = creeping_ends(z, law)
        if page[END] == UNDECIDED:
            page[END] = STUCK
            radius = sticking_radius(law) if law.offset == 0.0 else abs(place)
            keep(page, radius, radius, 0.0)
            if aims.early:
                return True
        creeps = max(s, abs(place - z)) < max(SPENT_SHARE * aims.tolerance, REVERSAL_SLIP)
    left = time_to_rest(z, w, law, aims.tolerance)
    if creeps or (left == math.inf and s < REVERSAL_SLIP):
        left = 0.0
    if not t + left < page[DURATION]:
        return False
    middle = z + 0.5 * left * (0.75 * w + 1j * law.disc_speed * z)
    z += left * (0.5 * w + 1j * law.disc_speed * middle)
    scratch[(TRIAL + WAY) * LANES + lane] += 0.5 * s * left
    return rest(scratch, page, lane, z, t + left, law, aims, creeps)


@scalar
def rest(
    scratch: Any, page: Any, lane: int, z: complex, t: float, law: PinLaw, aims: Aims, creeps: bool
) -> bool:
    """Follow a pin from rest at ``z`` until it slips; return whether its trajectory ends before.

    One that ``creeps`` slips so slowly that it might as well rest, for ever.
    """
    end: float = page[DURATION]
    w = 0j
    forget_turns(scratch, page, lane)
    if aims.once:
        page[END] = STUCK
        return True
    while w == 0j and t < end:
        scratch[STEPS * LANES + lane] += 1.0
        if scratch[STEPS * LANES + lane] > scratch[MOST_STEPS * LANES + lane]:
            page[END], end = UNDECIDED, t  # given up
        if creeps or abs(pull(z, 0j, law)) <= law.friction:
            held = math.inf if creeps else release_delay(z, law)
            if held > 0.0 and not creeps and takes_notes(page):
                note(page, STICKS, t, z, w, law)
            if held == math.inf:
                if page[END] == UNDECIDED or not creeps:
                    page[END] = STUCK
                    keep(page, abs(z), abs(z), 0.0)
                if aims.early:
                    end = t
            turn = law.disc_speed * min(held, end - t)
            z *= complex(math.cos(turn), math.sin(turn))
            t += held
            if t < end and held > 0.0 and takes_notes(page):
                note(page, SLIPS, t, z, w, law)
            if t < end and held > 0.0 and released(scratch, page, lane, z, t, law, aims):
                end = t
        if t < end:
            z, w, took, way = begin_slip(z, law, SERIES_SHARE * aims.tolerance, end - t, aims.series)
            t += took
            scratch[(TRIAL + WAY) * LANES + lane] += way
    scratch[(TRIAL + TIME) * LANES + lane] = min(t, end)
    if w == 0j:
        put_place(scratch, lane, z, w)
    else:
        put_slipping(scratch, lane, z, w, law)
    return t >= end  # one that has just begun to slip at the very end has ended too


@inlined
def forget_turns(scratch: Any, page: Any, lane: int) -> None:
    """Begin anew with crossings of the section."""
    page[TURN_COUNT] = 0.0
    if scratch[WATCH * LANES + lane] == RADII and page[MEASURED] == OF_TURN:
        page[MEASURED] = NO_WINDOW
        scratch[WATCH * LANES + lane] = TURNS


@inlined
def watched(scratch: Any, lane: int) -> bool:
    """Tell whether a lane is watched."""
    watch: float = scratch[WATCH * LANES + lane]
    return watch != UNWATCHED


@scalar
def released(scratch: Any, page: Any, lane: int, z: complex, t: float, law: PinLaw, aims: Aims) -> bool:
    """Take note of a release at ``z``; return whether the trajectory ends."""
    if page[END] == STUCK:
        return False
    if page[END] == UNDECIDED and not watched(scratch, lane) and t < scratch[DUE * LANES + lane]:
        return False
    if not watched(scratch, lane) and page[END] != STICK_SLIP:
        page[END] = UNDECIDED  # what it was, if anything, was not the end
        scratch[WATCH * LANES + lane] = TURNS
    radius, largest = abs(z), sticking_radius(law)
    if page[RELEASE_COUNT] > 0.0 and creeps_by_turns(radius, page[RELEASE], law):
        page[END] = STUCK
        keep(page, largest, largest, 0.0)
        return aims.early
    distance, before, first = abs(radius - page[RELEASE]), page[RELEASE_LAST], page[RELEASE_BEFORE]
    page[RELEASE], page[RELEASE_LAST], page[RELEASE_BEFORE] = radius, distance, before
    page[RELEASE_COUNT] += 1.0
    if page[RELEASE_COUNT] < 5.0 or not converged(distance, before, first, radius):
        return False
    way = scratch[(TRIAL + WAY) * LANES + lane]
    if page[MEASURED] == OF_RELEASE:
        close_window(page, STICK_SLIP, t, way, radius)
        scratch[WATCH * LANES + lane] = TURNS
        return aims.early
    open_window(page, OF_RELEASE, t, way, radius)
    scratch[WATCH * LANES + lane] = RADII
    return False


@scalar
def settle(scratch: Any, page: Any, lane: int, law: PinLaw) -> None:
    """Say at the very end what can be said."""
    if page[END] == UNDECIDED and in_well(scratch, page, lane, law):
        radius = math.hypot(page[WELL_X], page[WELL_Y])
        page[END] = SELF_CENTRED
        keep(page, radius, radius, abs(law.disc_speed) * radius)
