"""End states of a disc, detected during its motion.

Self-centred
    The state, checked once per free period, converges: d·q/(1 − q) is small, with the distance d between checks and q
    the larger of its last two ratios (:mod:`.core.recurrence`). A motion may pass close to an unstable equilibrium,
    as in Fig. 11, so the equilibrium must also attract, and Newton's method must confirm the distance
    (:mod:`.stability`).
Whirl
    The same for the states where x is largest. Without an offset the radius, the velocities along and across it, and
    the spin converge from check to check.
Modulated
    Without an offset, the same for the states where the radius is largest, while it continues to oscillate.
Stuck, or stick-slip
    As for a pin, by the radii of a disc on a ring at its releases (:mod:`.pin.end_states`).

Known trapping regions (:mod:`.trapping`) end trajectories earlier. Functions of type bool return whether the
trajectory ends.
"""

from collections.abc import Callable

from reference_model.ensemble.core.by_core import law_in
from reference_model.ensemble.core.jit import inlined, scalar, written_out
from reference_model.ensemble.core.lanes import EXTREME, IS_DUE, LOST, REST, RIGHTMOST, STIFF
from reference_model.ensemble.core.laws import DiscLaw
from reference_model.ensemble.core.records import fill
from reference_model.ensemble.core.recurrence import (
    ACCURACY,
    NO_WINDOW,
    Measures,
    compared,
    measured,
    open_window,
    see_radius,
)
from reference_model.ensemble.core.stepping.dense_output import (
    outward,
    position_on,
    velocity_on,
    where_radius_turns,
    where_rightmost,
)
from reference_model.ensemble.core.stepping.linear import quadratic_form
from reference_model.ensemble.disc.lanes import (
    AT_END,
    BOTH,
    OF_PEAK,
    OF_TURN,
    RADII,
    UNWATCHED,
    DiscLanes,
    DiscMemory,
    DiscSettings,
    Setup,
    last_step,
    law_of,
    rates_at,
    state_at,
    take_in,
)
from reference_model.ensemble.disc.stability import attracts
from reference_model.ensemble.end_states import MODULATED, SELF_CENTRED, UNDECIDED, WHIRL

ByCore = Callable[[DiscLanes, DiscMemory, int, DiscLaw, Setup], bool]
"""Replaces the trial step by a step of the core; returns whether the trajectory ends."""

STILL = 1e-2
"""Largest oscillation of a motion that approaches a point (relative to |ωz|) or a circle (to the radius)."""


@written_out
def handle_flag_with(
    lanes: DiscLanes,
    memory: DiscMemory,
    lane: int,
    setup: Setup,
    step_by_core: ByCore,
) -> bool:
    settings = setup.settings
    law = law_of(lanes, lane, settings.around)
    if int(lanes.flag[lane]) & (STIFF | REST) and step_by_core(lanes, memory, lane, law, setup):
        return True
    flag = int(lanes.flag[lane])
    if flag & LOST:
        memory.end = UNDECIDED
        return True
    passed = lanes.trial.state.time[lane] > lanes.now.state.time[lane]
    if flag & IS_DUE and passed and check_due(lanes, memory, lane, law, setup):
        return True
    if lanes.trial.state.time[lane] >= lanes.duration[lane] - AT_END:
        return True
    return (
        flag & (RIGHTMOST | EXTREME) > 0
        and passed
        and record_extreme(lanes, memory, lane, flag, law, settings)
    )


@scalar
def found(
    lanes: DiscLanes, memory: DiscMemory, lane: int, kind: int, end: int, t: float, way: float, radius: float,
    law: DiscLaw, settings: DiscSettings,
) -> bool:  # fmt: skip
    """Measure an end state from here to the next similar crossing."""
    window = memory.window
    if window.kind != kind:
        open_window(window, kind, t, way, radius)
        lanes.watch[lane] = RADII if law.offset == 0.0 else BOTH
        return False
    see_radius(window, radius)
    fill(memory.found, measured(window, t, way))
    swings = window.largest - window.least > STILL * window.largest
    memory.end = MODULATED if end == WHIRL and law.offset == 0.0 and swings else end
    window.kind = NO_WINDOW
    lanes.watch[lane] = UNWATCHED
    return settings.early


@inlined
def spin_at(lanes: DiscLanes, lane: int, u: float, span: float) -> float:
    """Return r in the last step, by a cubic."""
    r0, r1 = lanes.now.state.r[lane], lanes.trial.state.r[lane]
    k0, k1 = lanes.now.rates, lanes.trial.rates
    d0, d1 = span * k0.r[lane] / k0.time[lane], span * k1.r[lane] / k1.time[lane]
    rest = u - 1.0
    spin: float = r0 + u * (d0 + u * (r1 - r0 - d0 + rest * (d0 + d1 - 2.0 * (r1 - r0))))
    return spin


@scalar
def record_extreme(
    lanes: DiscLanes, memory: DiscMemory, lane: int, flag: int, law: DiscLaw, settings: DiscSettings
) -> bool:
    if memory.end != UNDECIDED:
        return False
    step = last_step(lanes, lane)
    turns, radius = where_radius_turns(step), 0.0
    centred = law.offset == 0.0
    ended = False
    if turns <= 1.0:
        z, v = position_on(step, turns), velocity_on(step, turns)
        radius = abs(z)
        see_radius(memory.window, radius)
        if centred and outward(step, 0.0) > 0.0:
            values = (
                radius,
                (v * z.conjugate()).imag / radius,
                spin_at(lanes, lane, turns, step.span),
                0.0,
                0.0,
            )
            met = compared(memory.peaks, values, radius)
            ended = met and record_turn(lanes, memory, lane, OF_PEAK, turns, radius, law, settings)
    if flag & RIGHTMOST and not centred and not ended:
        u = where_rightmost(step)
        z, v = position_on(step, u), velocity_on(step, u)
        values = (z.real, z.imag, v.imag, spin_at(lanes, lane, u, step.span), 0.0)
        met = compared(memory.turns, values, abs(v))
        ended = met and record_turn(lanes, memory, lane, OF_TURN, u, abs(z), law, settings)
        if turns <= 1.0:
            see_radius(memory.window, radius)  # again, for the window that opens here
    return ended


@scalar
def record_turn(
    lanes: DiscLanes, memory: DiscMemory, lane: int, kind: int, u: float, radius: float, law: DiscLaw,
    settings: DiscSettings,
) -> bool:  # fmt: skip
    t0, t1 = lanes.now.state.time[lane], lanes.trial.state.time[lane]
    way0, way1 = lanes.now.state.way[lane], lanes.trial.state.way[lane]
    t, way = t0 + u * (t1 - t0), way0 + u * (way1 - way0)
    return found(lanes, memory, lane, kind, WHIRL, t, way, radius, law, settings)


@written_out
def check_due(lanes: DiscLanes, memory: DiscMemory, lane: int, law: DiscLaw, setup: Setup) -> bool:
    settings = setup.settings
    t, due = lanes.trial.state.time[lane], lanes.due[lane]
    state, k = state_at(lanes.trial, lane), rates_at(lanes.trial, lane)
    velocity = (1.0 / k.time) * complex(k.x, k.y)
    place = complex(state.x, state.y)
    if memory.end == UNDECIDED and in_region(memory, place, velocity, state.r, settings):
        lanes.watch[lane] = UNWATCHED
        return settings.early
    if t < due:
        return False
    lanes.due[lane] = due + memory.tick
    if memory.end != UNDECIDED:
        return False
    step = last_step(lanes, lane)
    u = (due - lanes.now.state.time[lane]) / step.span
    z, v, r = position_on(step, u), velocity_on(step, u), spin_at(lanes, lane, u, step.span)
    if law.offset == 0.0:
        radius = max(abs(z), 1e-300)
        along = (1.0 / radius) * v * z.conjugate()
        values = (abs(z), along.real, along.imag, r, 0.0)
        swing, centred = abs(along.real), max(abs(z), abs(v)) < ACCURACY
    else:
        values = (z.real, z.imag, v.real, v.imag, r)
        swing, centred = abs(v), False
    scale = 1.0 if centred else abs(z)
    met = compared(memory.checks, values, scale)
    if not met or (swing > STILL * abs(law.disc_speed * z) and not centred):
        return False
    circle = law.offset == 0.0 and not centred
    take_in(memory, law, setup)
    if not attracts(z, v, r, law_in(setup.room), circle, ACCURACY * scale):
        return False
    memory.end = WHIRL if circle else SELF_CENTRED
    radius = 0.0 if centred else abs(z)
    fill(memory.found, Measures(radius, radius, k.way / k.time))
    lanes.watch[lane] = UNWATCHED
    return settings.early


@scalar
def in_region(memory: DiscMemory, z: complex, v: complex, r: float, settings: DiscSettings) -> bool:
    length, speed = memory.length, memory.length * memory.rate
    for region in settings.regions:
        if region.circle:
            radius = max(abs(z), 1e-300)
            along = (1.0 / radius) * v * z.conjugate()
            a, b, c, d, e = length * radius, speed * along.real, speed * along.imag, speed * r, 0.0
        else:
            a, b, c, d, e = length * z.real, length * z.imag, speed * v.real, speed * v.imag, speed * r
        centre = region.centre
        apart = a - centre[0], b - centre[1], c - centre[2], d - centre[3], e - centre[4]
        if quadratic_form(region.form, apart) < region.level:
            memory.end, measures = (WHIRL if region.circle else SELF_CENTRED), region.measures
            fill(
                memory.found,
                Measures(measures.least / length, measures.largest / length, measures.slip / speed),
            )
            return True
    return False
