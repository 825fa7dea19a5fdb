"""Rare events of a pin: rest and release, crossings of the section, and end states.

Functions that return a bool return whether the trajectory ends, unless stated otherwise.
"""

import math

from reference_model.core.memory import PATIENCE, STEP
from reference_model.ensemble.core.by_core import (
    count_after,
    go_on,
    is_done,
    next_span,
    prepare,
    put_law,
    slip_of,
    way_of,
)
from reference_model.ensemble.core.jit import inlined, scalar, written_out
from reference_model.ensemble.core.lanes import EXTREME, IS_DUE, LOST, REST, RIGHTMOST, STIFF
from reference_model.ensemble.core.laws import (
    SPENT_SHARE,
    PinLaw,
    creeps_by_turns,
    pull,
    release_delay,
    sticking_radius,
)
from reference_model.ensemble.core.recurrence import ACCURACY, NO_WINDOW, compared, open_window, see_radius
from reference_model.ensemble.core.stepping.dense_output import (
    DenseOutput,
    position_on,
    velocity_on,
    way_along,
    where_radius_turns,
    where_rightmost,
)
from reference_model.ensemble.core.stepping.linear import quadratic_form
from reference_model.ensemble.end_states import SELF_CENTRED, STICK_SLIP, STUCK, UNDECIDED, WHIRL
from reference_model.ensemble.pin.end_states import depth, orbit_attracts
from reference_model.ensemble.pin.lanes import (
    LANDING,
    MANY,
    OF_RELEASE,
    OF_TURN,
    RADII,
    TURNS,
    UNWATCHED,
    PinLanes,
    PinMemory,
    Settings,
    close_window,
    flags_of,
    keep,
    landed,
    last_step,
    law_of,
    position_at,
    put_motion,
    put_position,
    put_slipping,
    rates_at,
    slip_at,
    state_at,
)
from reference_model.ensemble.pin.slip import (
    begin_slip,
    creeping_ends,
    creeps_slaved,
    creeps_steadily,
    time_to_rest,
)

SERIES_SHARE = 0.1
"""Share of the tolerance for the last terms of the series of slip."""

REVERSAL_SLIP = 1e-13
"""Scaled slip below which slip that friction cannot hold counts as reversed."""

AFTER_START = 1e-3
"""Earliest scaled time of a crossing; an earlier crossing is the start itself."""


@written_out
def handle_flag(lanes: PinLanes, memory: PinMemory, lane: int, settings: Settings) -> bool:
    law = law_of(lanes, lane)
    if int(lanes.flag[lane]) & STIFF and step_by_core(lanes, memory, lane, law, settings):
        return True
    flag = int(lanes.flag[lane])
    later = lanes.trial.state.time[lane]
    if flag & LOST:
        memory.end = UNDECIDED
        return True
    if flag & IS_DUE and later >= memory.duration - LANDING:
        if not landed(lanes, lane, memory.duration):
            return False
        settle(lanes, memory, lane, law)
        return True
    if flag & IS_DUE and check_region(lanes, memory, lane, later, law, settings):
        return True
    if flag & (RIGHTMOST | EXTREME):
        step = last_step(lanes, lane, law)
        turns, u = where_radius_turns(step), 1.0
        if flag & RIGHTMOST:
            u = where_rightmost(step)
        if turns <= u:
            see_radius(memory.window, abs(position_on(step, turns)))
        if flag & RIGHTMOST:
            z, v = position_on(step, u), velocity_on(step, u)
            if record_crossing(lanes, memory, lane, step, u, law, settings):
                put_position(lanes.trial, lane, z, v - 1j * law.disc_speed * z)
                lanes.trial.state.time[lane] = lanes.now.state.time[lane] + u * step.span
                return True
            if check_region(lanes, memory, lane, later, law, settings):
                return True
        if u < turns <= 1.0:
            see_radius(memory.window, abs(position_on(step, turns)))
    if flag & REST:
        return maybe_rest(lanes, memory, lane, law, settings)
    return False


@scalar
def check_region(
    lanes: PinLanes, memory: PinMemory, lane: int, later: float, law: PinLaw, settings: Settings
) -> bool:
    if lanes.watch[lane] == UNWATCHED and law.friction > 0.0 and memory.end == UNDECIDED:
        lanes.watch[lane] = TURNS
    lanes.due[lane] = min(later + memory.tick, memory.duration - LANDING)
    if memory.end != UNDECIDED or not centres(lanes, memory, lane, law):
        return False
    lanes.watch[lane] = UNWATCHED
    return settings.early


@scalar
def centres(lanes: PinLanes, memory: PinMemory, lane: int, law: PinLaw) -> bool:
    """End the motion in the trapping region of the equilibrium; return whether it is there."""
    level, z, w = memory.level, position_at(lanes.trial, lane), slip_at(lanes.trial, lane)
    if not (level > 0.0 and depth(z, w, law, memory.equilibrium, memory.form) <= level):
        return False
    memory.end = SELF_CENTRED
    radius = math.hypot(memory.equilibrium.real, memory.equilibrium.imag)
    keep(memory, radius, radius, abs(law.disc_speed) * radius)
    return True


@written_out
def record_crossing(
    lanes: PinLanes,
    memory: PinMemory,
    lane: int,
    step: DenseOutput,
    u: float,
    law: PinLaw,
    settings: Settings,
) -> bool:
    if memory.end != UNDECIDED:
        return False
    z, speed = position_on(step, u), velocity_on(step, u).imag
    t = lanes.now.state.time[lane] + u * step.span
    if settings.once:
        if t < AFTER_START:
            return False
        memory.end = WHIRL
        return True
    if in_reach(memory, z, speed, law, settings):
        memory.end = WHIRL
        lanes.watch[lane] = UNWATCHED
        return settings.early
    turns = memory.turns
    came = z.real - turns.values[0], z.imag - turns.values[1], speed - turns.values[2]
    first = turns.before
    if not compared(turns, (z.real, z.imag, speed, 0.0, 0.0), abs(speed)):
        return False
    way = lanes.now.state.way[lane] + way_along(step, u, law.disc_speed)
    if memory.window.kind == OF_TURN:
        # Near convergence the last distance may be small by chance.
        share = turns.last / max(turns.last, turns.before, first, 1e-300)
        period, near = t - memory.window.since, ACCURACY * abs(speed) * share
        if not orbit_attracts(z, velocity_on(step, u), period, law, came, near):
            forget_turns(lanes, memory, lane)
            return False
        close_window(memory, WHIRL, t, way, abs(z))
        lanes.watch[lane] = UNWATCHED
        return settings.early
    open_window(memory.window, OF_TURN, t, way, abs(z))
    lanes.watch[lane] = RADII
    return False


@scalar
def in_reach(memory: PinMemory, z: complex, speed: float, law: PinLaw, settings: Settings) -> bool:
    """Return whether the motion crosses the section in the trapping region of the whirl."""
    regions, turn, length = settings.regions, settings.regions.turn, memory.length
    if regions.reach <= 0.0:
        return False
    x, y = z.real * length - turn[0], z.imag * length - turn[1]
    v = speed * length / math.sqrt(law.stiffness) - turn[2]
    if quadratic_form(regions.metric, (x, y, v)) > regions.reach:
        return False
    measures, pace = regions.measures, length * memory.rate
    keep(memory, measures.least / length, measures.largest / length, measures.slip / pace)
    return True


@written_out
def maybe_rest(lanes: PinLanes, memory: PinMemory, lane: int, law: PinLaw, settings: Settings) -> bool:
    """Bring the pin to rest if the end of slip is known."""
    z, w = position_at(lanes.trial, lane), slip_at(lanes.trial, lane)
    t, s = lanes.trial.state.time[lane], abs(w)
    creeps = creeps_steadily(z, w, law)
    if creeps:
        place = creeping_ends(z, law)
        if memory.end == UNDECIDED:
            memory.end = STUCK
            radius = sticking_radius(law) if law.offset == 0.0 else abs(place)
            keep(memory, radius, radius, 0.0)
            if settings.early:
                return True
        creeps = max(s, abs(place - z)) < max(SPENT_SHARE * settings.tolerance, REVERSAL_SLIP)
    left = time_to_rest(z, w, law, settings.tolerance)
    if creeps or (left == math.inf and s < REVERSAL_SLIP):
        left = 0.0
    if not t + left < memory.duration:
        return False
    middle = z + 0.5 * left * (0.75 * w + 1j * law.disc_speed * z)
    z += left * (0.5 * w + 1j * law.disc_speed * middle)
    lanes.trial.state.way[lane] += 0.5 * s * left
    return rest(lanes, memory, lane, z, t + left, law, settings, creeps)


@scalar
def rest(
    lanes: PinLanes,
    memory: PinMemory,
    lane: int,
    z: complex,
    t: float,
    law: PinLaw,
    settings: Settings,
    creeps: bool,
) -> bool:
    """Follow a pin from rest at ``z`` until it slips, or forever if it ``creeps``."""
    end = memory.duration
    w = 0j
    forget_turns(lanes, memory, lane)
    if settings.once:
        memory.end = STUCK
        return True
    while w == 0j and t < end:
        lanes.steps[lane] += 1.0
        if lanes.steps[lane] > lanes.most_steps[lane]:
            memory.end, end = UNDECIDED, t
        if creeps or abs(pull(z, 0j, law)) <= law.friction:
            held = math.inf if creeps else release_delay(z, law)
            if held == math.inf:
                if memory.end == UNDECIDED or not creeps:
                    memory.end = STUCK
                    keep(memory, abs(z), abs(z), 0.0)
                if settings.early:
                    end = t
            turn = law.disc_speed * min(held, end - t)
            z *= complex(math.cos(turn), math.sin(turn))
            t += held
            if t < end and held > 0.0 and released(lanes, memory, lane, z, t, law, settings):
                end = t
        if t < end:
            z, w, took, way = begin_slip(z, law, SERIES_SHARE * settings.tolerance, end - t, settings.series)
            t += took
            lanes.trial.state.way[lane] += way
    lanes.trial.state.time[lane] = min(t, end)
    if w == 0j:
        put_position(lanes.trial, lane, z, w)
    else:
        put_slipping(lanes, lane, z, w, law)
    return t >= end  # also a pin that begins to slip at the very end


@inlined
def forget_turns(lanes: PinLanes, memory: PinMemory, lane: int) -> None:
    memory.turns.count = 0
    if lanes.watch[lane] == RADII and memory.window.kind == OF_TURN:
        memory.window.kind = NO_WINDOW
        lanes.watch[lane] = TURNS


@scalar
def released(
    lanes: PinLanes, memory: PinMemory, lane: int, z: complex, t: float, law: PinLaw, settings: Settings
) -> bool:
    if memory.end == STUCK:
        return False
    unwatched = lanes.watch[lane] == UNWATCHED
    if memory.end == UNDECIDED and unwatched and t < lanes.due[lane]:
        return False
    if unwatched and memory.end != STICK_SLIP:
        memory.end = UNDECIDED
        lanes.watch[lane] = TURNS
    radius, largest = abs(z), sticking_radius(law)
    releases = memory.releases
    if releases.count > 0 and creeps_by_turns(radius, releases.values[0], law):
        memory.end = STUCK
        keep(memory, largest, largest, 0.0)
        return settings.early
    if not compared(releases, (radius, 0.0, 0.0, 0.0, 0.0), radius):
        return False
    way = lanes.trial.state.way[lane]
    if memory.window.kind == OF_RELEASE:
        close_window(memory, STICK_SLIP, t, way, radius)
        lanes.watch[lane] = TURNS
        return settings.early
    open_window(memory.window, OF_RELEASE, t, way, radius)
    lanes.watch[lane] = RADII
    return False


@scalar
def settle(lanes: PinLanes, memory: PinMemory, lane: int, law: PinLaw) -> None:
    """Decide the end state at the very end, also while slip is too fast for a closed form."""
    z = position_at(lanes.trial, lane)
    if memory.end == UNDECIDED and law.offset == 0.0 and creeps_slaved(z, slip_at(lanes.trial, lane), law):
        radius = sticking_radius(law)
        memory.end = STUCK
        keep(memory, radius, radius, 0.0)
    if memory.end == UNDECIDED:
        centres(lanes, memory, lane, law)


@scalar
def step_by_core(lanes: PinLanes, memory: PinMemory, lane: int, law: PinLaw, settings: Settings) -> bool:
    """Replace the trial step of stiff slip by a step of the core, up to rest; return whether the trajectory ends."""
    now, trial, room = lanes.now, lanes.trial, settings.room
    t, pace, z, w = now.state.time[lane], now.rates.time[lane], position_at(now, lane), slip_at(now, lane)
    until = min(t + memory.span, memory.duration)
    if lanes.due[lane] > t:
        until = min(until, lanes.due[lane])
    g = law.friction
    put_law(
        room.parameters, law.damping, law.stiffness, law.offset, g, g, law.disc_speed, 0.0, 0.0, 0.0, 1.0,
    )  # fmt: skip
    start = (z.real, z.imag, w.real, w.imag, 0.0, 0.0, t)
    prepare(room, start, now.step[lane], pace, math.inf, memory.patience, until - t)
    sound, done, slow = True, False, False
    while sound and not done and not slow and room.state[6] < until:
        lanes.steps[lane] += 1.0
        sound = go_on(room, lanes.tolerance[lane], until)
        done, slow = is_done(room, g, memory.patience), slip_of(room) < lanes.slow[lane]
    there, slip = complex(room.state[0], room.state[1]), complex(room.state[2], room.state[3])
    trial.state.time[lane] = room.state[6]
    trial.state.way[lane] = now.state.way[lane] + way_of(room, start)
    if not sound or lanes.steps[lane] > lanes.most_steps[lane]:
        memory.end = UNDECIDED
        put_position(trial, lane, there, slip)
        return True
    if slip == 0j:
        return rest(lanes, memory, lane, there, room.state[6], law, settings, False)
    put_motion(trial, lane, there, slip, law)
    trial.step[lane], memory.patience = room.memory[STEP], room.memory[PATIENCE]
    lanes.short[lane] = count_after(room, MANY) if done else MANY
    memory.span = next_span(memory.span, z, there, not done)
    lanes.flag[lane] = flags_of(
        state_at(now, lane), rates_at(now, lane), state_at(trial, lane), rates_at(trial, lane),
        lanes.due[lane], lanes.slow[lane], lanes.watch[lane],
    )  # fmt: skip
    return False
