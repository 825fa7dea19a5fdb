"""End of slip, rest and beginning of slip of a disc; a disc on points is handed over.

A disc on a ring sticks like a pin with the friction that the shaft's moment leaves (eq. 7). Functions of type bool
return whether the trajectory ends.
"""

import math

from reference_model.ensemble.core.jit import inlined, scalar
from reference_model.ensemble.core.laws import SPENT_SHARE, DiscLaw, creeps_by_turns, sticking_radius
from reference_model.ensemble.core.records import fill, put
from reference_model.ensemble.core.recurrence import Measures, compared
from reference_model.ensemble.disc.events import found
from reference_model.ensemble.disc.lanes import (
    AT_END,
    LEAST_SLIP,
    NEAR_REST,
    OF_PEAK,
    UNWATCHED,
    DiscLanes,
    DiscMemory,
    DiscSettings,
    begin_slip,
    comes_to_rest,
    put_slipping,
    rates_at,
    slip_left,
    state_at,
)
from reference_model.ensemble.disc.slip import centre_of, held_friction, ring_rates, stuck_for
from reference_model.ensemble.end_states import HANDED_OVER, STICK_SLIP, STUCK, UNDECIDED

LINGERS = 0.01
"""Shortest scaled time to rest of slow slip of a creeping disc or point."""

SOON = 3e-4
"""Longest scaled time to rest of a point whose stop can be predicted."""


@scalar
def ring_slow(lanes: DiscLanes, memory: DiscMemory, lane: int, law: DiscLaw, settings: DiscSettings) -> bool:
    """Bring a disc on a ring to rest if the end of slip is known."""
    if not slip_left(lanes, lane)[0] < NEAR_REST * law.friction:
        return False
    if _creeps_out(lanes, memory, lane, law, settings):
        return True
    return comes_to_rest(lanes, lane, law) and ring_rests(lanes, memory, lane, law, settings)


@scalar
def _creeps_out(
    lanes: DiscLanes, memory: DiscMemory, lane: int, law: DiscLaw, settings: DiscSettings
) -> bool:
    """End the trajectory if the disc slips ever more slowly forever.

    This requires a pull that only rotates with the master disc, as for a pin in ``pin.slip.creeps_steadily``.
    """
    s, left = slip_left(lanes, lane)
    steady = (law.offset == 0.0 or law.disc_speed == 0.0) and law.stiffness > law.disc_speed**2
    least = max(SPENT_SHARE * lanes.tolerance[lane], LEAST_SLIP)
    spent = s * max(left, 1.0) < least or s <= LEAST_SLIP
    if not (steady and LINGERS < left < math.inf and spent):
        return False
    x, y, _, _, _, angle, t, way = state_at(lanes.trial, lane)
    z = complex(x, y)
    if memory.end == UNDECIDED:
        memory.end = STUCK
        fill(memory.found, Measures(abs(z), abs(z), 0.0))
    if not settings.early:
        delay = lanes.duration[lane] - t
        turn = law.disc_speed * delay
        z *= complex(math.cos(turn), math.sin(turn))
        put(lanes.trial.state, lane, (z.real, z.imag, 0.0, 0.0, 0.0, angle + turn, t + delay, way))
    return True


@scalar
def ring_rests(lanes: DiscLanes, memory: DiscMemory, lane: int, law: DiscLaw, settings: DiscSettings) -> bool:
    """Follow a disc on a ring from rest until it slips."""
    ended = _held(lanes, memory, lane, law, settings)
    if not ended:
        put_slipping(lanes, lane, law, ring_rates)
    return ended


@scalar
def points_slow(
    lanes: DiscLanes, memory: DiscMemory, lane: int, law: DiscLaw, settings: DiscSettings
) -> bool:
    s, left = slip_left(lanes, lane)
    slow = s < NEAR_REST * law.friction
    if slow and _creeps_out(lanes, memory, lane, law, settings):
        return True
    goes_on = not slow or (left > LINGERS and s > LEAST_SLIP)
    if goes_on and not _point_rests(lanes, lane, law):
        return False
    return points_rest(lanes, memory, lane, law, settings)


@inlined
def points_rest(
    lanes: DiscLanes, memory: DiscMemory, lane: int, law: DiscLaw, settings: DiscSettings
) -> bool:
    memory.end = HANDED_OVER
    return True


@scalar
def _held(lanes: DiscLanes, memory: DiscMemory, lane: int, law: DiscLaw, settings: DiscSettings) -> bool:
    x, y, _, _, _, angle, t, way = state_at(lanes.trial, lane)
    z, end = complex(x, y), lanes.duration[lane]
    if t >= end - AT_END:
        return True
    memory.checks.count = memory.turns.count = 0
    friction = held_friction(law)
    held = stuck_for(z, friction, law)
    if held == math.inf:
        memory.end = STUCK
        fill(memory.found, Measures(abs(z), abs(z), 0.0))
        if settings.early:
            return True
    delay = min(held, end - t)
    turn = law.disc_speed * delay
    z *= complex(math.cos(turn), math.sin(turn))
    t, angle = t + delay, angle + turn
    put(lanes.trial.state, lane, (z.real, z.imag, 0.0, 0.0, 0.0, angle, t, way))
    if t >= end - AT_END:
        return True
    if held > 0.0 and memory.end == UNDECIDED and lanes.watch[lane] != UNWATCHED:
        # The centre slips no farther than an equally held pin, and creeps inward where such a pin does.
        centre, last = centre_of(law, friction), memory.peaks.values[0]
        if memory.peaks.count > 0 and creeps_by_turns(abs(z), last, centre):
            memory.end, radius = STUCK, sticking_radius(centre)
            fill(memory.found, Measures(radius, radius, 0.0))
            if settings.early:
                return True
        elif compared(memory.peaks, (abs(z), 0.0, 0.0, 0.0, 0.0), abs(z)) and found(
            lanes, memory, lane, OF_PEAK, STICK_SLIP, t, way, abs(z), law, settings
        ):
            return True
    return not begin_slip(lanes, lane, z, angle, t, law)


@scalar
def _point_rests(lanes: DiscLanes, lane: int, law: DiscLaw) -> bool:
    """Return whether a contact point slips slowly, decelerates, and could be held at rest."""
    _, _, ux, uy, r, angle, _, _ = state_at(lanes.trial, lane)
    k = rates_at(lanes.trial, lane)
    most = law.friction / (len(law.around) // 2)
    eta, spin = law.leverage, law.disc_speed + law.curling * r
    for j in range(0, len(law.around), 2):
        arm = complex(math.cos(angle), math.sin(angle)) * complex(law.around[j], law.around[j + 1])
        v = complex(ux, uy) + 1j * eta * r * arm
        if 0.0 < abs(v) < SOON * most:
            rate = (1.0 / k.time) * complex(k.ux, k.uy) + 1j * eta * arm * (k.r / k.time + 1j * r * spin)
            # Acceleration without its own friction, and the friction that would hold it, as in
            # reference_model.core.forces.pivot.
            free = rate + (most / abs(v)) * (v + 1j * eta * arm * (eta * (arm.conjugate() * v).imag))
            holding = 1j * arm * ((arm.conjugate() * free).imag * eta**2 / (1.0 + eta**2)) - free
            falling = -(v.conjugate() * rate).real / abs(v)
            if abs(v) < LINGERS * falling and abs(holding) < most:
                return True
    return False
