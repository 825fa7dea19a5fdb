"""Steps of a disc by the core: rest, release, and stiff slip.

A disc rests permanently if it sticks for a whole turn of the master disc, because the pull then repeats.
"""

import math

from reference_model.core.forces.law import HARDENING, HOLD, STOP
from reference_model.core.memory import CREEPS, PATIENCE, PHASE, SHORT, STEP, STICKS
from reference_model.core.steps.explicit import SIZE
from reference_model.ensemble.core.by_core import (
    count_after,
    go_on,
    is_done,
    next_span,
    prepare,
    released,
    rests,
    sample,
    see_samples,
    slip_of,
    way_of,
)
from reference_model.ensemble.core.jit import inlined, scalar, written_out
from reference_model.ensemble.core.lanes import IS_DUE, STIFF
from reference_model.ensemble.core.laws import DiscLaw, PinLaw, creeps_by_turns, sticking_radius
from reference_model.ensemble.core.records import fill, put
from reference_model.ensemble.core.recurrence import NO_WINDOW, Measures, compared
from reference_model.ensemble.core.stepping.runge_kutta import Tuple
from reference_model.ensemble.disc.events import found
from reference_model.ensemble.disc.lanes import (
    AT_END,
    FIRST_STEP,
    MANY,
    MOST_STEPS,
    NEAR_REST,
    OF_PEAK,
    UNWATCHED,
    DiscLanes,
    DiscMemory,
    DiscState,
    RatesInRoom,
    Setup,
    flags_of,
    rates_at,
    state_at,
    take_in,
)
from reference_model.ensemble.end_states import STICK_SLIP, STUCK, UNDECIDED

TURNS = 1.1
"""A stick phase is permanent if it lasts for this number of turns of the master disc."""

GOES_ON, ENDS, FAILS = 0, 1, 2


@written_out
def step_by_core_with(
    lanes: DiscLanes, memory: DiscMemory, lane: int, law: DiscLaw, setup: Setup, rates: RatesInRoom
) -> bool:
    """Replace the trial step by a step of the core; return whether the trajectory ends."""
    room, before = setup.room, state_at(lanes.now, lane)
    take_in(memory, law, setup)
    end = lanes.duration[lane]
    until = min(before.time + memory.span, end)
    if lanes.due[lane] > before.time:
        until = min(until, lanes.due[lane])
    short, enough = memory.short, NEAR_REST * law.friction
    if int(lanes.flag[lane]) & STIFF and not setup.by_core:
        short, enough = math.inf, law.friction
    y: Tuple = (before.x, before.y, before.ux, before.uy, before.r, before.angle, before.time)
    pace = lanes.now.rates.time[lane]
    prepare(room, y, lanes.now.step[lane], pace, short, memory.patience, until - before.time)
    way, status, rested, done = before.way, GOES_ON, False, False
    while not done and status == GOES_ON and (room.state[6] < until or (rests(room) and room.state[6] < end)):
        lanes.steps[lane] += 1.0
        if rests(room):
            rested = True
            way += way_of(room, y)
            status = _leave_rest(lanes, memory, lane, law, setup, way)
            y = _unknowns(setup)
            way += 0.5 * slip_of(room) * (y[6] - memory.since)
            sample(room, y[6], until - y[6])
        else:
            sound = go_on(room, lanes.tolerance[lane], until)
            status = _creeps(memory, setup) if sound else FAILS
            if room.memory[CREEPS] > 0.0:
                until = end
        if lanes.steps[lane] > MOST_STEPS:
            status = FAILS
        done = is_done(room, enough, memory.patience) and not setup.by_core
    last = _unknowns(setup)
    new = DiscState(last[0], last[1], last[2], last[3], last[4], last[5], last[6], way + way_of(room, y))
    put(lanes.trial.state, lane, new)
    if status == FAILS:
        memory.end = UNDECIDED
    if status != GOES_ON or rests(room):
        return True
    k = rates(new[:6], law, room)
    put(lanes.trial.rates, lane, k)
    lanes.trial.step[lane], lanes.usual[lane] = room.memory[STEP], 0.0
    memory.patience, memory.short = room.memory[PATIENCE], room.memory[SHORT]
    lanes.short[lane] = count_after(room, MANY) if done else MANY
    here, there = complex(before.x, before.y), complex(new.x, new.y)
    memory.span = next_span(memory.span, here, there, not done and not rested)
    due = new.time >= min(lanes.due[lane], end - AT_END)
    flag = IS_DUE if due else 0.0
    if not rested:
        flag = flags_of(
            before, rates_at(lanes.now, lane), new, DiscState(*k), 0.0, due, False, lanes.watch[lane]
        )
    lanes.flag[lane] = flag
    return False


@inlined
def _unknowns(setup: Setup) -> Tuple:
    """Return x, y, the slip of the centre, r, the angle and the time."""
    state = setup.room.state
    return state[0], state[1], state[SIZE], state[SIZE + 1], state[4], state[5], state[6]


@scalar
def _creeps(memory: DiscMemory, setup: Setup) -> int:
    """Return whether the trajectory ends because slip decays forever."""
    room = setup.room
    if room.memory[CREEPS] > 0.0 and memory.end == UNDECIDED:
        memory.end, radius = STUCK, math.hypot(room.state[0], room.state[1])
        fill(memory.found, Measures(radius, radius, 0.0))
    return ENDS if room.memory[CREEPS] > 0.0 and setup.settings.early else GOES_ON


@scalar
def _leave_rest(
    lanes: DiscLanes, memory: DiscMemory, lane: int, law: DiscLaw, setup: Setup, way: float
) -> int:
    """Follow the disc from rest through its release, or to the end of the trajectory."""
    room, end, tolerance = setup.room, lanes.duration[lane], lanes.tolerance[lane]
    y = _unknowns(setup)
    turn = 2.0 * math.pi / abs(law.disc_speed) if law.disc_speed != 0.0 else 1.0
    memory.since = y[6]
    if not go_on(room, tolerance, y[6] + TURNS * turn):
        return FAILS
    stuck = room.memory[PHASE] == STICKS
    if stuck:
        memory.end, radius = STUCK, math.hypot(y[0], y[1])
        fill(memory.found, Measures(radius, radius, 0.0))
    i, status = released(room), GOES_ON
    if i >= 0 and room.phases[i, 1] < end:
        memory.since = room.phases[i, 1]
        radius = math.hypot(room.phases[i, 2], room.phases[i, 3])
        status = _decides(lanes, memory, lane, law, setup, way, radius)
    if i >= 0 and status == GOES_ON and memory.window.kind != NO_WINDOW:
        last = min(room.state[6], end)
        prepare(room, y, FIRST_STEP, 1.0, 0.0, 0.0, 0.0)  # again, with samples after the release
        sample(room, memory.since, last - memory.since)
        go_on(room, tolerance, last)
        see_samples(room, memory.window)
    elif stuck or room.state[6] > end:  # again, up to the end
        prepare(room, y, FIRST_STEP, 1.0, 0.0, 0.0, end - y[6])
        if not (stuck and setup.settings.early):
            go_on(room, tolerance, end)
        status = ENDS
    return status


@scalar
def _decides(
    lanes: DiscLanes, memory: DiscMemory, lane: int, law: DiscLaw, setup: Setup, way: float, radius: float
) -> int:  # fmt: skip
    """Judge the radius of a release; return whether the trajectory ends."""
    memory.checks.count = memory.turns.count = 0
    if memory.end != UNDECIDED or lanes.watch[lane] == UNWATCHED:
        return GOES_ON
    if memory.peaks.count > 0 and _creeps_by_turns(memory, law, radius):
        memory.end, largest = STUCK, sticking_radius(_held_pin(memory, law))
        fill(memory.found, Measures(largest, largest, 0.0))
        return ENDS if setup.settings.early else GOES_ON
    ends = compared(memory.peaks, (radius, 0.0, 0.0, 0.0, 0.0), radius) and found(
        lanes, memory, lane, OF_PEAK, STICK_SLIP, memory.since, way, radius, law, setup.settings
    )
    return ENDS if ends else GOES_ON


@inlined
def _held_pin(memory: DiscMemory, law: DiscLaw) -> PinLaw:
    """Return the pin that sticks where the disc does."""
    return PinLaw(law.stiffness, law.damping, memory.law[HOLD], law.disc_speed, law.offset, 0.0, 0.0)


@scalar
def _creeps_by_turns(memory: DiscMemory, law: DiscLaw, radius: float) -> bool:
    """Return whether the disc creeps inward forever: the centre slips no farther than an equally held pin.

    The criterion holds for linear supports and isotropic contacts.
    """
    known = memory.law[HARDENING] == 0.0 and memory.law[STOP] == 0.0 and len(law.around) == 0
    return known and creeps_by_turns(radius, memory.peaks.values[0], _held_pin(memory, law))
