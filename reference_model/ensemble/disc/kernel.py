"""An ensemble of discs: how a lane is loaded, attended and stored, and how its end state shows itself.

At rest
    A disc on a ring sticks as a whole, and its centre as a pin with the friction that the moment of the shaft leaves:
    it is stuck for ever if the pull, a constant part and one that turns, never exceeds that (eq. 7). Exact.

Self-centred
    Once in every free period the motion is looked at: the places, velocities and spins of a motion that goes to an
    equilibrium go to a fixed point. With d the distance from one look to the next and q the larger of its last two
    ratios, d·q/(1 − q) is what is left to go (``pin_ends.converged``). Since a motion may come close to one that is
    unstable and leave it later (some of Fig. 11 begin so), it must attract, too (:mod:`disc_stability`).

Whirl
    The same from one place to the next where x is largest; without an offset the whirl is a circle, on which radius,
    velocities along it and across it, and spin have a fixed point of their own: from look to look.

Modulated
    Without an offset, the same from one largest radius to the next, where the radius goes on swinging.

What is known of the basins beforehand (:mod:`disc_regions`) ends the trajectories that come into it earlier.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

from reference_model.ensemble.checkpoints import EVERY, KIND, ON_THE_WAY, SLIPS, STATE, STICKS
from reference_model.ensemble.checkpoints import TIME as NOTE_TIME
from reference_model.ensemble.core.convergence import ACCURACY, converged
from reference_model.ensemble.core.dense_output import (
    outward,
    place_on,
    velocity_on,
    where_radius_turns,
    where_rightmost,
)
from reference_model.ensemble.core.implicit import collocate_points, collocate_ring
from reference_model.ensemble.core.jit import inlined, outermost, scalar, written_out
from reference_model.ensemble.core.lanes import LANES, run
from reference_model.ensemble.core.laws import DiscLaw
from reference_model.ensemble.core.nondimensional import ROUNDING, units
from reference_model.ensemble.disc.lanes import (
    AT_END,
    BOTH,
    CONSTANTS,
    DUE,
    DURATION,
    EXTREME,
    FLAG,
    IS_DUE,
    LAW,
    LEAST_SLIP,
    LOST,
    NEAR_REST,
    RADII,
    RATES,
    REST,
    RIGHTMOST,
    SLOTS,
    STEPS,
    STIFF,
    TIME,
    TOLERANCE,
    TRIAL,
    TURNS,
    UNWATCHED,
    WATCH,
    WAY,
    R,
    advance_with,
    begin_slip,
    comes_to_rest,
    eight_of,
    idle,
    last_arc,
    law_of,
    put,
    put_slipping,
    slip_left,
)
from reference_model.ensemble.disc.slip import (
    held_friction,
    no_edge,
    points_rates,
    ring_edge,
    ring_rates,
    stuck_for,
)
from reference_model.ensemble.disc.stability import attracts
from reference_model.ensemble.disc.stride import disc_stride_with
from reference_model.ensemble.end_states import HANDED_OVER, EndState, Results
from reference_model.systems import FloatArray

UNDECIDED, SELF_CENTRED, WHIRL, MODULATED, STUCK, STICK_SLIP = (
    int(EndState.UNDECIDED),
    int(EndState.SELF_CENTRED),
    int(EndState.WHIRL),
    int(EndState.MODULATED),
    int(EndState.STUCK),
    int(EndState.STICK_SLIP),
)

PARAMETERS = (
    "mass", "polar_inertia", "stiffness", "damping", "friction_force", "disc_speed", "offset", "contact_radius",
    "shaft_damping", "shaft_speed",
)  # fmt: skip
"""Of a disc, in the order in which they are taken here."""

STRETCHING_TIME = 0.5
"""s₀ over g, in units of time."""

WATCHED_STEP = 1e-3
"""Step below which the points of a disc are looked at for one that comes to rest."""

LINGERS = 0.01
"""Time, in units, that slow slip of a disc or of a point lasts at least, at its pace, if it creeps."""

SPENT_SHARE = 0.1
"""Of the tolerance, for what is left of slip that dies out for ever."""

SOON = 3e-4
"""Time, in units, in which a point must come to rest for that to be foreseen."""

STILL = 1e-2
"""Share of its radius or of ω times it by which a motion may swing that goes to a point or to a circle."""

LOOKS, TURNS_OF, PEAKS = 0, 1, 2
"""Kinds of what is compared: the motion once in a period, where x is largest, where the radius is largest."""

NUMBER, LENGTH, RATE, END, TICK, MEASURED, SINCE, WAY_BEFORE, LEAST, LARGEST = range(10)
FOUND, SERIES = 10, 13
LAST, BEFORE, COUNT, SERIES_ITEMS = 5, 6, 7, 8
SPAN = SERIES + 3 * SERIES_ITEMS
NOTED = SPAN + 1
ITEMS = NOTED + 1
"""Items of a page of the book: number, units of length and of time's inverse, end state so far, the period of looks;
the window of the kind MEASURED (−1: none) in which measures of the end state are taken: since when, from which way
on, radii so far; the measures found; of each kind what was seen last (5), the last two distances, and how often;
how long an implicit step may be; where the next note goes."""

CIRCLE = 1.0
"""Marks a region about a whirl, in the coordinates that turn with the centre; 0 is one about an equilibrium."""


class DiscTask(NamedTuple):
    """Parameters (1 or n, 10), in the order of PARAMETERS; starts (1 or n, 6); durations (1 or n,)."""

    parameters: FloatArray
    starts: FloatArray
    durations: FloatArray


class DiscAims(NamedTuple):
    """What a disc needs to be attended: ``around`` of its law, and ``regions`` (m, 25) of :mod:`disc_regions`."""

    tolerance: float
    early: bool
    around: tuple[float, ...]
    regions: FloatArray


@inlined
def _row(values: Any, number: int) -> Any:
    return values[number if values.shape[0] > 1 else 0]


@written_out
def load_with(
    scratch: Any, book: Any, lane: int, number: int, task: DiscTask, aims: DiscAims, rest: Any, slip: Any
) -> bool:
    """Put the start of a trajectory into the slots of the trial; return whether it ends there."""
    mass, inertia, stiffness, damping, force, omega, offset, radius, shaft, shaft_speed = _row(
        task.parameters, number
    )
    x, y, angle, vx, vy, spin = _row(task.starts, number)
    k2, c, g, kappa = stiffness / mass, damping / mass, force / mass, math.sqrt(inertia / mass)
    decay = max(c, shaft / inertia)
    length, rate = units(math.sqrt(k2), decay, g, omega, offset, math.hypot(x, y), math.hypot(vx, vy))
    speed = length * rate
    friction = g / (speed * rate)
    law = DiscLaw(
        k2 / rate**2,
        c / rate,
        friction,
        omega / rate,
        offset / length,
        STRETCHING_TIME * friction if g > 0.0 else 1.0,
        0.0 if g > 0.0 else 1.0,
        radius / kappa,
        shaft / inertia / rate,
        kappa * (omega - shaft_speed) / speed,
        length / kappa,
        aims.around,
    )
    page = book[lane]
    page[:] = 0.0
    duration = _row(task.durations, number) * rate
    page[NUMBER], page[LENGTH], page[RATE], page[MEASURED] = number, length, rate, -1.0
    page[TICK] = 2.0 * math.pi / math.sqrt(law.stiffness) if law.stiffness > 0.0 else math.inf
    for i in range(LAW, SLOTS):
        scratch[i * LANES + lane] = 0.0
    constants = law[:CONSTANTS]
    for i in range(CONSTANTS):
        scratch[(LAW + i) * LANES + lane] = constants[i]
    scratch[TOLERANCE * LANES + lane], scratch[DURATION * LANES + lane] = aims.tolerance, duration
    scratch[WATCH * LANES + lane] = RADII if law.offset == 0.0 else TURNS
    noted = takes_notes(page)
    if noted:
        page[TICK], page[NOTED] = EVERY, ITEMS
    scratch[DUE * LANES + lane] = page[TICK]

    u = complex(vx + omega * y, vy - omega * x) / speed
    r = kappa * (spin - omega) / speed
    if abs(u) <= ROUNDING * abs(omega) * math.hypot(x, y) / speed:
        u = 0j
    if abs(spin - omega) <= ROUNDING * abs(omega):
        r = 0.0
    put(scratch, lane, (x / length, y / length, u.real, u.imag, r, angle, 0.0, 0.0))
    if noted:
        note(scratch, page, lane, SLIPS)
    if u == 0j and r == 0.0 and friction > 0.0:
        return bool(rest(scratch, page, lane, law, aims))
    slip(scratch, lane, law)
    return bool(duration <= 0.0)


@written_out
def attend_with(
    scratch: Any, book: Any, lane: int, aims: DiscAims, stride: Any, slow: Any, shows: Any
) -> bool:
    """See to what the flag of a lane says; return whether its trajectory ends here."""
    page = book[lane]
    law = law_of(scratch, lane, aims.around)
    if int(scratch[FLAG * LANES + lane]) & STIFF:
        stride(scratch, page, lane, law)
    flag = int(scratch[FLAG * LANES + lane])
    if flag & LOST:
        page[END] = UNDECIDED
        return True
    passed = scratch[(TRIAL + TIME) * LANES + lane] > scratch[TIME * LANES + lane]  # more than rounding
    if flag & IS_DUE and passed and _looked(scratch, page, lane, law, aims, shows):
        return True
    if scratch[(TRIAL + TIME) * LANES + lane] >= scratch[DURATION * LANES + lane] - AT_END:
        return True
    if flag & (RIGHTMOST | EXTREME) and passed and _section(scratch, page, lane, flag, law, aims):
        return True
    return bool(flag & REST) and slow(scratch, page, lane, law, aims)


@scalar
def _ring_shows(z: complex, v: complex, r: float, law: DiscLaw, circle: bool) -> bool:
    """Tell whether the steady motion attracts that a disc on a ring has come to."""
    return attracts(z, v, r, law, circle)


@scalar
def _points_show(z: complex, v: complex, r: float, law: DiscLaw, circle: bool) -> bool:
    """Tell that of a disc on points, whose friction changes with the angle, nothing is known at a single look.

    But without friction all that is damped attracts.
    """
    return law.friction == 0.0 and law.damping > 0.0 and law.stiffness > 0.0


@scalar
def _ring_strides(scratch: Any, page: Any, lane: int, law: DiscLaw) -> None:
    disc_stride_with(scratch, page, SPAN, lane, law, ring_rates, ring_edge, collocate_ring)


@scalar
def _points_stride(scratch: Any, page: Any, lane: int, law: DiscLaw) -> None:
    disc_stride_with(scratch, page, SPAN, lane, law, points_rates, no_edge, collocate_points)


@scalar
def _ring_slow(scratch: Any, page: Any, lane: int, law: DiscLaw, aims: DiscAims) -> bool:
    """Bring a disc on a ring to rest if what is left of slip can be told; return whether the trajectory ends."""
    if not slip_left(scratch, lane)[0] < NEAR_REST * law.friction:
        return False
    if _creeps_out(scratch, page, lane, law, aims):
        return True
    return comes_to_rest(scratch, lane, law) and _ring_rests(scratch, page, lane, law, aims)


@scalar
def _creeps_out(scratch: Any, page: Any, lane: int, law: DiscLaw, aims: DiscAims) -> bool:
    """Tell whether a disc all but rests that slips ever more slowly for ever, and end its trajectory.

    That it can only where its pull does nothing but turn with the master disc. As a pin, see
    ``pin_slip.creeps_steadily``: what is left of speed and way is far below the tolerance.
    """
    s, left = slip_left(scratch, lane)
    steady = (law.offset == 0.0 or law.disc_speed == 0.0) and law.stiffness > law.disc_speed**2
    least = max(SPENT_SHARE * scratch[TOLERANCE * LANES + lane], LEAST_SLIP)
    spent = s * max(left, 1.0) < least or s <= LEAST_SLIP
    if not (steady and LINGERS < left < math.inf and spent):
        return False
    x, y, _, _, _, angle, t, way = eight_of(scratch, lane, TRIAL)
    z = complex(x, y)
    if page[END] == UNDECIDED:
        page[END] = STUCK
        _keep(page, abs(z), abs(z), 0.0)
    if not aims.early:
        delay = scratch[DURATION * LANES + lane] - t
        turn = law.disc_speed * delay
        z *= complex(math.cos(turn), math.sin(turn))
        put(scratch, lane, (z.real, z.imag, 0.0, 0.0, 0.0, angle + turn, t + delay, way))
    return True


@scalar
def _ring_rests(scratch: Any, page: Any, lane: int, law: DiscLaw, aims: DiscAims) -> bool:
    """Follow a disc on a ring from rest until it slips; return whether its trajectory ends before."""
    ended = _held(scratch, page, lane, law, aims)
    if not ended:
        _ring_slips(scratch, lane, law)
    return ended


@scalar
def _ring_slips(scratch: Any, lane: int, law: DiscLaw) -> None:
    put_slipping(scratch, lane, law, ring_rates)


@scalar
def _points_slow(scratch: Any, page: Any, lane: int, law: DiscLaw, aims: DiscAims) -> bool:
    """Hand over a disc on points that is about to rest, or one of whose points is."""
    s, left = slip_left(scratch, lane)
    slow = s < NEAR_REST * law.friction
    if slow and _creeps_out(scratch, page, lane, law, aims):
        return True
    goes_on = not slow or (left > LINGERS and s > LEAST_SLIP)
    if goes_on and not _point_rests(scratch, lane, law):
        return False
    return _points_rest(scratch, page, lane, law, aims)


@inlined
def _points_rest(scratch: Any, page: Any, lane: int, law: DiscLaw, aims: DiscAims) -> bool:
    """Hand over a disc on points that rests."""
    page[END] = HANDED_OVER
    return True


@scalar
def _points_slip(scratch: Any, lane: int, law: DiscLaw) -> None:
    put_slipping(scratch, lane, law, points_rates)


@scalar
def _held(scratch: Any, page: Any, lane: int, law: DiscLaw, aims: DiscAims) -> bool:
    """Let a disc on a ring rest as long as friction holds it, and begin to slip; return whether that is the end."""
    x, y, _, _, _, angle, t, way = eight_of(scratch, lane, TRIAL)
    z, end = complex(x, y), scratch[DURATION * LANES + lane]
    if t >= end - AT_END:
        return True
    for kind in range(2):  # turns and looks begin anew
        page[SERIES + kind * SERIES_ITEMS + COUNT] = 0.0
    held = stuck_for(z, held_friction(law), law)
    if held == math.inf:
        page[END] = STUCK
        _keep(page, abs(z), abs(z), 0.0)
        if aims.early:
            return True
    if held > 0.0 and takes_notes(page):
        note(scratch, page, lane, STICKS)
    delay = min(held, end - t)
    turn = law.disc_speed * delay
    z *= complex(math.cos(turn), math.sin(turn))
    t, angle = t + delay, angle + turn
    put(scratch, lane, (z.real, z.imag, 0.0, 0.0, 0.0, angle, t, way))
    if t >= end - AT_END:
        return True
    if held > 0.0 and takes_notes(page):
        note(scratch, page, lane, SLIPS)
    if held > 0.0 and page[END] == UNDECIDED and scratch[WATCH * LANES + lane] != UNWATCHED:
        met = _compared(page, PEAKS, (abs(z), 0.0, 0.0, 0.0, 0.0), abs(z))
        if met and _found(scratch, page, lane, PEAKS, STICK_SLIP, t, way, abs(z), law, aims):
            return True
    return not begin_slip(scratch, lane, z, angle, t, law)


@inlined
def _keep(page: Any, least: float, largest: float, slip: float) -> None:
    """Keep the measures of the end state: radii and mean slip speed."""
    page[FOUND], page[FOUND + 1], page[FOUND + 2] = least, largest, slip


@scalar
def _compared(page: Any, kind: int, values: Any, scale: float) -> bool:
    """Compare with what was seen before of the same kind; tell whether less than ACCURACY·scale is left to go."""
    series = page[SERIES + kind * SERIES_ITEMS :]
    square = 0.0
    for i in range(5):
        square += (values[i] - series[i]) ** 2
        series[i] = values[i]
    distance, before, first = math.sqrt(square), series[LAST], series[BEFORE]
    series[LAST], series[BEFORE] = distance, before
    series[COUNT] += 1.0
    return series[COUNT] >= 5.0 and converged(distance, before, first, scale)


@scalar
def _found(
    scratch: Any, page: Any, lane: int, kind: int, end: int, t: float, way: float, radius: float, law: DiscLaw,
    aims: DiscAims,
) -> bool:  # fmt: skip
    """Take the measures of an end state from here to the next like place; return whether that is the end."""
    if page[MEASURED] != kind:
        page[MEASURED], page[SINCE], page[WAY_BEFORE] = kind, t, way
        page[LEAST] = page[LARGEST] = radius
        scratch[WATCH * LANES + lane] = RADII if law.offset == 0.0 else BOTH
        return False
    _note(page, radius)
    _keep(page, page[LEAST], page[LARGEST], (way - page[WAY_BEFORE]) / (t - page[SINCE]))
    swings = page[LARGEST] - page[LEAST] > STILL * page[LARGEST]
    page[END] = MODULATED if end == WHIRL and law.offset == 0.0 and swings else end
    page[MEASURED] = -1.0
    scratch[WATCH * LANES + lane] = UNWATCHED
    return aims.early


@inlined
def _spin_at(scratch: Any, lane: int, u: float, span: float) -> float:
    """Return r within the last step, by the cubic through it and its rate at both ends."""
    r0, r1 = scratch[R * LANES + lane], scratch[(TRIAL + R) * LANES + lane]
    k0, k1 = eight_of(scratch, lane, RATES), eight_of(scratch, lane, TRIAL + RATES)
    d0, d1 = span * k0[4] / k0[6], span * k1[4] / k1[6]
    rest = u - 1.0
    spin: float = r0 + u * (d0 + u * (r1 - r0 - d0 + rest * (d0 + d1 - 2.0 * (r1 - r0))))
    return spin


@scalar
def _section(scratch: Any, page: Any, lane: int, flag: int, law: DiscLaw, aims: DiscAims) -> bool:
    """Take note of where x or the radius is largest, or the latter smallest; return whether that is the end."""
    if page[END] != UNDECIDED:
        return False
    arc = last_arc(scratch, lane)
    turns, radius = where_radius_turns(arc), 0.0
    centred = law.offset == 0.0
    ended = False
    if turns <= 1.0:
        z, v = place_on(arc, turns), velocity_on(arc, turns)
        radius = abs(z)
        _note(page, radius)
        if centred and outward(arc, 0.0) > 0.0:
            values = (
                radius,
                (v * z.conjugate()).imag / radius,
                _spin_at(scratch, lane, turns, arc.span),
                0.0,
                0.0,
            )
            ended = _met(scratch, page, lane, PEAKS, values, radius, turns, radius, law, aims)
    if flag & RIGHTMOST and not centred and not ended:
        u = where_rightmost(arc)
        z, v = place_on(arc, u), velocity_on(arc, u)
        values = (z.real, z.imag, v.imag, _spin_at(scratch, lane, u, arc.span), 0.0)
        ended = _met(scratch, page, lane, TURNS_OF, values, abs(v), u, abs(z), law, aims)
        if turns <= 1.0:
            _note(page, radius)  # again: what comes after this place belongs to a window that opens here
    return ended


@inlined
def _note(page: Any, radius: float) -> None:
    """Take a radius into the window."""
    page[LEAST], page[LARGEST] = min(page[LEAST], radius), max(page[LARGEST], radius)


@scalar
def _met(
    scratch: Any, page: Any, lane: int, kind: int, values: Any, scale: float, u: float, radius: float,
    law: DiscLaw, aims: DiscAims,
) -> bool:  # fmt: skip
    """Compare a place in the last step with the one before; return whether the trajectory ends, on a whirl."""
    if not _compared(page, kind, values, scale):
        return False
    t0, t1 = scratch[TIME * LANES + lane], scratch[(TRIAL + TIME) * LANES + lane]
    way0, way1 = scratch[WAY * LANES + lane], scratch[(TRIAL + WAY) * LANES + lane]
    t, way = t0 + u * (t1 - t0), way0 + u * (way1 - way0)
    return _found(scratch, page, lane, kind, WHIRL, t, way, radius, law, aims)


@written_out
def _looked(scratch: Any, page: Any, lane: int, law: DiscLaw, aims: DiscAims, shows: Any) -> bool:
    """Look at the motion, as once in every free period and at the end; return whether the trajectory ends here."""
    t, due = scratch[(TRIAL + TIME) * LANES + lane], scratch[DUE * LANES + lane]
    if takes_notes(page):
        note(scratch, page, lane, ON_THE_WAY)
        scratch[DUE * LANES + lane] = t + page[TICK]
        return False
    x, y, _, _, r, _, _, _ = eight_of(scratch, lane, TRIAL)
    k = eight_of(scratch, lane, TRIAL + RATES)
    if page[END] == UNDECIDED and _in_region(
        page, complex(x, y), (1.0 / k[6]) * complex(k[0], k[1]), r, aims
    ):
        scratch[WATCH * LANES + lane] = UNWATCHED
        return aims.early
    if t < due:
        return False  # the end
    scratch[DUE * LANES + lane] = due + page[TICK]
    if page[END] != UNDECIDED:
        return False
    arc = last_arc(scratch, lane)
    u = (due - scratch[TIME * LANES + lane]) / arc.span
    z, v, r = place_on(arc, u), velocity_on(arc, u), _spin_at(scratch, lane, u, arc.span)
    if law.offset == 0.0:
        radius = max(abs(z), 1e-300)
        along = (1.0 / radius) * v * z.conjugate()
        values = (abs(z), along.real, along.imag, r, 0.0)
        swing, centred = abs(along.real), max(abs(z), abs(v)) < ACCURACY
    else:
        values = (z.real, z.imag, v.real, v.imag, r)
        swing, centred = abs(v), False
    met = _compared(page, LOOKS, values, 1.0 if centred else abs(z))
    if not met or (swing > STILL * abs(law.disc_speed * z) and not centred):
        return False
    if not shows(z, v, r, law, law.offset == 0.0 and not centred):
        return False
    page[END] = WHIRL if law.offset == 0.0 and not centred else SELF_CENTRED
    _keep(page, abs(z), abs(z), k[7] / k[6])
    scratch[WATCH * LANES + lane] = UNWATCHED
    return aims.early


@scalar
def _in_region(page: Any, z: complex, v: complex, r: float, aims: DiscAims) -> bool:
    """Tell whether the motion is where it is known beforehand what comes of it, and keep that."""
    length, speed = page[LENGTH], page[LENGTH] * page[RATE]
    for row in aims.regions:
        if row[0] == CIRCLE:
            radius = max(abs(z), 1e-300)
            along = (1.0 / radius) * v * z.conjugate()
            a, b, c, d, e = length * radius, speed * along.real, speed * along.imag, speed * r, 0.0
        else:
            a, b, c, d, e = length * z.real, length * z.imag, speed * v.real, speed * v.imag, speed * r
        a, b, c, d, e = a - row[1], b - row[2], c - row[3], d - row[4], e - row[5]
        level = a * (row[6] * a + 2.0 * (row[7] * b + row[8] * c + row[9] * d + row[10] * e))
        level += b * (row[11] * b + 2.0 * (row[12] * c + row[13] * d + row[14] * e))
        level += c * (row[15] * c + 2.0 * (row[16] * d + row[17] * e))
        level += d * (row[18] * d + 2.0 * row[19] * e) + e * row[20] * e
        if level < row[21]:
            page[END] = WHIRL if row[0] == CIRCLE else SELF_CENTRED
            _keep(page, row[22] / length, row[23] / length, row[24] / speed)
            return True
    return False


@scalar
def _point_rests(scratch: Any, lane: int, law: DiscLaw) -> bool:
    """Tell whether a point of contact slips slowly, ever more so, and could be held at rest."""
    _, _, ux, uy, r, angle, _, _ = eight_of(scratch, lane, TRIAL)
    k = eight_of(scratch, lane, TRIAL + RATES)
    most = law.friction / (len(law.around) // 2)
    eta, spin = law.leverage, law.disc_speed + law.curling * r
    for j in range(0, len(law.around), 2):
        arm = complex(math.cos(angle), math.sin(angle)) * complex(law.around[j], law.around[j + 1])
        v = complex(ux, uy) + 1j * eta * r * arm
        if 0.0 < abs(v) < SOON * most:
            rate = (1.0 / k[6]) * complex(k[2], k[3]) + 1j * eta * arm * (k[4] / k[6] + 1j * r * spin)
            # Without its own friction, and what that must be to hold it: see reference_model.motion.pivot.
            free = rate + (most / abs(v)) * (v + 1j * eta * arm * (eta * (arm.conjugate() * v).imag))
            holding = 1j * arm * ((arm.conjugate() * free).imag * eta**2 / (1.0 + eta**2)) - free
            falling = -(v.conjugate() * rate).real / abs(v)
            if abs(v) < LINGERS * falling and abs(holding) < most:
                return True
    return False


@inlined
def takes_notes(page: Any) -> bool:
    """Tell whether there is room for notes, see :mod:`notes`: behind the other items."""
    return bool(page.shape[0] > ITEMS)


@scalar
def note(scratch: Any, page: Any, lane: int, kind: float) -> None:
    """Take a note of what stands in the slots of the trial, while there is room."""
    place = int(page[NOTED])
    if place < page.shape[0]:
        page[NOTED] += STATE + 6.0
        page[place + KIND] = kind
        page[place + NOTE_TIME] = scratch[(TRIAL + TIME) * LANES + lane] / page[RATE]
        put_state(page[place + STATE :], scratch, page, lane)


@scalar
def put_state(state: Any, scratch: Any, page: Any, lane: int) -> None:
    """Put x, y, angle, vx, vy and spin of what stands in the slots of the trial into ``state`` (6,), in SI units."""
    length, rate = page[LENGTH], page[RATE]
    x, y, ux, uy, r, angle, _, _ = eight_of(scratch, lane, TRIAL)
    omega, curling = scratch[(LAW + 3) * LANES + lane], scratch[(LAW + 10) * LANES + lane]
    state[0], state[1], state[2] = x * length, y * length, angle
    state[3], state[4] = (ux - omega * y) * length * rate, (uy + omega * x) * length * rate
    state[5] = (omega + curling * r) * rate


@scalar
def store(scratch: Any, book: Any, lane: int, results: Results) -> None:
    """Write down the result of a lane in SI units."""
    page = book[lane]
    number, length, rate = int(page[NUMBER]), page[LENGTH], page[RATE]
    put_state(results.states[number], scratch, page, lane)
    results.times[number] = scratch[(TRIAL + TIME) * LANES + lane] / rate
    results.ends[number], results.steps[number] = int(page[END]), int(scratch[STEPS * LANES + lane])
    known = page[END] != UNDECIDED and page[END] != HANDED_OVER
    for i in range(3):
        measure = page[FOUND + i] * length if known else math.nan
        results.measures[number, i] = measure * rate if i == 2 else measure
    if takes_notes(page):
        results.notes[:] = page[ITEMS:]


# The compiler takes functions from globals only: so there are those of rings and of points.


@scalar
def _load_ring(scratch: Any, book: Any, lane: int, number: int, task: DiscTask, aims: DiscAims) -> bool:
    return load_with(scratch, book, lane, number, task, aims, _ring_rests, _ring_slips)


@scalar
def _advance_rings(scratch: Any, around: Any) -> None:
    advance_with(scratch, around, ring_rates, ring_edge, 0.0, LANES)


@scalar
def _advance_ring_alone(scratch: Any, around: Any) -> None:
    advance_with(scratch, around, ring_rates, ring_edge, 0.0, 1)


@scalar
def _attend_ring(scratch: Any, book: Any, lane: int, aims: DiscAims) -> bool:
    return attend_with(scratch, book, lane, aims, _ring_strides, _ring_slow, _ring_shows)


@scalar
def _load_points(scratch: Any, book: Any, lane: int, number: int, task: DiscTask, aims: DiscAims) -> bool:
    return load_with(scratch, book, lane, number, task, aims, _points_rest, _points_slip)


@scalar
def _advance_points(scratch: Any, around: Any) -> None:
    advance_with(scratch, around, points_rates, no_edge, WATCHED_STEP, LANES)


@scalar
def _advance_points_alone(scratch: Any, around: Any) -> None:
    advance_with(scratch, around, points_rates, no_edge, WATCHED_STEP, 1)


@scalar
def _attend_points(scratch: Any, book: Any, lane: int, aims: DiscAims) -> bool:
    return attend_with(scratch, book, lane, aims, _points_stride, _points_slow, _points_show)


@outermost
def run_rings(task: DiscTask, aims: DiscAims, results: Results, first: int, last: int) -> None:
    """Run the trajectories ``first`` to ``last`` (excluded) of discs on rings."""
    run(
        _load_ring, _advance_rings, _advance_ring_alone, _attend_ring, store, idle, SLOTS, TRIAL,
        ITEMS + results.notes.size, FLAG, first, last, aims.around, task, aims, results,
    )  # fmt: skip


@outermost
def run_points(task: DiscTask, aims: DiscAims, results: Results, first: int, last: int) -> None:
    """Run the trajectories ``first`` to ``last`` (excluded) of discs on points."""
    run(
        _load_points, _advance_points, _advance_points_alone, _attend_points, store, idle, SLOTS, TRIAL,
        ITEMS + results.notes.size, FLAG, first, last, aims.around, task, aims, results,
    )  # fmt: skip
