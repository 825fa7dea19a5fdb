"""The disc in lanes: what stands where, the step of all lanes, and how slip of one of them ends and begins."""

from __future__ import annotations

import math
from typing import Any

from reference_model.ensemble.core.contact_shares import LEAST
from reference_model.ensemble.core.dense_output import Arc, Motion, arc_between
from reference_model.ensemble.core.jit import inlined, scalar, written_out
from reference_model.ensemble.core.lanes import LANES
from reference_model.ensemble.core.laws import DiscLaw
from reference_model.ensemble.core.runge_kutta import factor_of, moved, step
from reference_model.ensemble.disc.breakaway import grown
from reference_model.ensemble.disc.slip import direction

X, Y, UX, UY, R, ANGLE, TIME, WAY = range(8)
"""Slots of a lane: place, slip velocity, r, angle, time and way slipped, the mean over the contact. All scaled."""

RATES, STEP = 8, 16
"""Where their rates by stretched time begin; the step that comes."""

TRIAL = STEP + 1
"""How much further on the same stands after the step on trial."""

LAW = 2 * TRIAL
"""Where the constants of a disc begin."""

CONSTANTS = len(DiscLaw._fields) - 1
(TOLERANCE, USUAL, DURATION, DUE, WATCH, FLAG, STEPS, SHORT, SLOTS) = range(
    LAW + CONSTANTS, LAW + CONSTANTS + 9
)
"""The tolerance of a step; the step before the edge was in the way; when it ends, and when it wants to be attended
before; how closely it is watched; why it wants to be attended; steps so far; how many of the last were short; the
number of slots."""

UNWATCHED, TURNS, BOTH, RADII = 0.0, 1.0, 2.0, 3.0
"""A lane may be attended whenever x is largest, whenever the radius is largest or smallest, or both."""

REST, IS_DUE, RIGHTMOST, EXTREME, LOST, STIFF = 1, 2, 4, 8, 16, 32
"""Flags, which add up: slip may be about to end; the time has come; x was largest; so was the radius, or smallest;
step size or number of steps are beyond what is sensible; an implicit step may be worth its while."""

SHORT_STEP, MANY = 0.1, 40.0
"""As in :mod:`pin_lanes`; explicit steps of discs cost more."""

MOST_STEPS = 5_000_000.0
SMALLEST_STEP = 1e-13
FIRST_STEP = 0.1

ON_EDGE = 1e-4
"""Share of a step within which the edge lies when the step counts as landing on it."""

AT_END = 1e-13
"""Time, in its unit, that is passed over at the end."""

SLOW, NEAR_REST = 0.01, 1e-4
"""Slip speeds, in units of g: below the first the tolerance of slip is relative, below the second slip may end."""

REST_TIME = 1e-12
"""Error, in units of time and length, up to which the closed form of coming to rest is taken."""

LEAST_SLIP = 1e-13
"""Slip speed, in units, that is none."""

LONGEST_GROWTH = 10.0
"""Time, in units, for which slip that grows is followed from rest: as any slip after, so that notes can be taken."""

SUDDEN = 0.05
"""Share of friction that the pull must have left over for slip that grows like time and is not stiff."""


@written_out
def advance_with(scratch: Any, around: Any, rates: Any, edge: Any, small_step: float, lanes: int) -> None:
    """Make a trial step in the first ``lanes``; where it does not do the old state goes into the slots of the trial.

    Where the step crosses the ``edge`` of friction, an error estimate would tell little: it is to end there. The same
    at the end. A lane wants to be attended, too, where steps are smaller than ``small_step``.
    """
    for lane in range(lanes):
        q = (
            scratch[X * LANES + lane],
            scratch[Y * LANES + lane],
            scratch[UX * LANES + lane],
            scratch[UY * LANES + lane],
            scratch[R * LANES + lane],
            scratch[ANGLE * LANES + lane],
            scratch[TIME * LANES + lane],
            scratch[WAY * LANES + lane],
        )
        k = (
            scratch[RATES * LANES + lane],
            scratch[(RATES + 1) * LANES + lane],
            scratch[(RATES + 2) * LANES + lane],
            scratch[(RATES + 3) * LANES + lane],
            scratch[(RATES + 4) * LANES + lane],
            scratch[(RATES + 5) * LANES + lane],
            scratch[(RATES + 6) * LANES + lane],
            scratch[(RATES + 7) * LANES + lane],
        )
        law = DiscLaw(
            scratch[LAW * LANES + lane],
            scratch[(LAW + 1) * LANES + lane],
            scratch[(LAW + 2) * LANES + lane],
            scratch[(LAW + 3) * LANES + lane],
            scratch[(LAW + 4) * LANES + lane],
            scratch[(LAW + 5) * LANES + lane],
            scratch[(LAW + 6) * LANES + lane],
            scratch[(LAW + 7) * LANES + lane],
            scratch[(LAW + 8) * LANES + lane],
            scratch[(LAW + 9) * LANES + lane],
            scratch[(LAW + 10) * LANES + lane],
            around,
        )
        h, end = scratch[STEP * LANES + lane], scratch[DURATION * LANES + lane]
        mean, third, fifth = step(rates, law, q[:6], k, h)
        new = moved(q, h, (1.0,), (mean,))
        k1 = rates(new[:6], law)

        # Slip counts by its own size once it is small, if there is friction: its direction decides when it ends.
        slip = math.sqrt(q[2] * q[2] + q[3] * q[3] + q[4] * q[4])
        small = (slip + law.free) / (SLOW * law.friction + LEAST)
        high = low = 0.0
        for j in range(7):
            size = 1.0 + (max(abs(q[j]), abs(new[j])) if j < 5 else 0.0)
            size = max(min(size, small), LEAST) if 2 <= j < 5 else size
            high += (fifth[j] / size) ** 2
            low += (third[j] / size) ** 2
        tolerance = scratch[TOLERANCE * LANES + lane]
        error = h * high / (math.sqrt((high + 0.01 * low) * 7.0 + 1e-300) * tolerance)
        good = error < 1.0
        next_step = h * factor_of(error)

        # The distance from the edge goes about by a parabola.
        before, approach = edge(q[:6], k, law)
        after, _ = edge(new[:6], k1, law)
        slope = approach * h
        bend = after - before - slope
        root = math.sqrt(max(slope * slope - 4.0 * bend * before, 0.0))
        share = abs(2.0 * before) / (abs(slope) + root + LEAST)
        share = min(max(share if approach * before < 0.0 else 0.5, 0.01), 0.99)
        far = min(abs(before), abs(after)) > ON_EDGE * abs(after - before)
        crossed = good & (before * after < 0.0) & far
        late = good & (new[6] > end + AT_END)
        share = (end - q[6]) / (new[6] - q[6]) if late else share
        taken = good & (not crossed) & (not late)
        usual = scratch[USUAL * LANES + lane]
        resumed = min(max(next_step, usual), (end - new[6]) / max(k1[6], LEAST))
        scratch[USUAL * LANES + lane] = 0.0 if taken else (max(h, usual) if crossed else usual)
        scratch[(TRIAL + STEP) * LANES + lane] = resumed if taken else (h * share if good else next_step)

        count = scratch[STEPS * LANES + lane] + 1.0
        done = new[6] >= end - AT_END
        flag = reasons(
            q, k, new, k1, NEAR_REST * law.friction, (new[6] >= scratch[DUE * LANES + lane]) | done, h < small_step,
            scratch[WATCH * LANES + lane],
        )  # fmt: skip
        flag = flag if taken else 0.0
        short = scratch[SHORT * LANES + lane] + 1.0 if new[6] - q[6] < SHORT_STEP else 0.0
        flag += STIFF if short > MANY else 0.0
        scratch[SHORT * LANES + lane] = short
        lost = (not h > SMALLEST_STEP) | (count > MOST_STEPS)
        flag += LOST if lost & (not (taken & done)) else 0.0
        scratch[FLAG * LANES + lane] = flag
        scratch[STEPS * LANES + lane] = count
        for j in range(8):
            scratch[(TRIAL + j) * LANES + lane] = new[j] if taken else q[j]
            scratch[(TRIAL + RATES + j) * LANES + lane] = k1[j] if taken else k[j]


@inlined
def reasons(q: Any, k: Any, new: Any, k1: Any, nearly: float, due: bool, fine: bool, watch: float) -> float:
    """Return the flags of a step from ``q`` with the rates ``k`` to what is ``new``."""
    s2 = new[2] * new[2] + new[3] * new[3] + new[4] * new[4]
    extreme = (q[0] * k[0] + q[1] * k[1] > 0.0) != (new[0] * k1[0] + new[1] * k1[1] > 0.0)
    flag = REST if (s2 < nearly * nearly) | fine else 0.0
    flag += IS_DUE if due else 0.0
    flag += RIGHTMOST if (k[0] > 0.0) & (k1[0] <= 0.0) & ((watch == TURNS) | (watch == BOTH)) else 0.0
    flag += EXTREME if extreme & (watch >= BOTH) else 0.0
    return flag


@scalar
def idle(scratch: Any, lane: int) -> None:
    """Put into a lane what goes on for ever without being attended."""
    for slot in range(SLOTS):
        scratch[slot * LANES + lane] = 0.0
    for slot in (LAW + 5, LAW + 6, TOLERANCE, TRIAL + STEP):
        scratch[slot * LANES + lane] = 1.0
    scratch[DURATION * LANES + lane] = scratch[DUE * LANES + lane] = math.inf


@inlined
def law_of(scratch: Any, lane: int, around: Any) -> DiscLaw:
    """Return the law of a lane."""
    at = LAW * LANES + lane
    return DiscLaw(
        scratch[at],
        scratch[at + LANES],
        scratch[at + 2 * LANES],
        scratch[at + 3 * LANES],
        scratch[at + 4 * LANES],
        scratch[at + 5 * LANES],
        scratch[at + 6 * LANES],
        scratch[at + 7 * LANES],
        scratch[at + 8 * LANES],
        scratch[at + 9 * LANES],
        scratch[at + 10 * LANES],
        around,
    )


@inlined
def eight_of(scratch: Any, lane: int, slot: int) -> Any:
    """Return what stands in eight slots from ``slot`` on."""
    at = slot * LANES + lane
    return (
        scratch[at],
        scratch[at + LANES],
        scratch[at + 2 * LANES],
        scratch[at + 3 * LANES],
        scratch[at + 4 * LANES],
        scratch[at + 5 * LANES],
        scratch[at + 6 * LANES],
        scratch[at + 7 * LANES],
    )


@inlined
def put(scratch: Any, lane: int, values: Any) -> None:
    """Put place, slip, angle, time and way into the slots of the trial."""
    for j in range(8):
        scratch[(TRIAL + j) * LANES + lane] = values[j]


@inlined
def put_slipping(scratch: Any, lane: int, law: DiscLaw, rates: Any) -> None:
    """Make ready the lane whose place stands in the slots of the trial, with a first step."""
    k = rates(eight_of(scratch, lane, TRIAL)[:6], law)
    for j in range(8):
        scratch[(TRIAL + RATES + j) * LANES + lane] = k[j]
    scratch[(TRIAL + STEP) * LANES + lane] = FIRST_STEP
    scratch[USUAL * LANES + lane] = scratch[SHORT * LANES + lane] = 0.0


@scalar
def last_arc(scratch: Any, lane: int) -> Arc:
    """Return the motion of the centre in the last step, of fifth order: by what it is at both ends."""
    h = scratch[(TRIAL + TIME) * LANES + lane] - scratch[TIME * LANES + lane]
    omega = scratch[(LAW + 3) * LANES + lane]
    z0, v0, a0 = _motion(eight_of(scratch, lane, X), eight_of(scratch, lane, RATES), omega)
    z1, v1, a1 = _motion(eight_of(scratch, lane, TRIAL), eight_of(scratch, lane, TRIAL + RATES), omega)
    way, scale = 60.0 * (z1 - z0), 1.0 / h**3
    j0 = scale * (way - h * (36.0 * v0 + 24.0 * v1) - h * h * (9.0 * a0 - 3.0 * a1))
    j1 = scale * (way - h * (24.0 * v0 + 36.0 * v1) - h * h * (3.0 * a0 - 9.0 * a1))
    return arc_between(h, Motion(z0, v0, a0, j0), Motion(z1, v1, a1, j1))


@inlined
def _motion(q: Any, k: Any, omega: float) -> Any:
    """Return place, velocity and acceleration of the centre."""
    pace, v = 1.0 / k[6], complex(k[0], k[1])
    return complex(q[0], q[1]), pace * v, pace * (complex(k[2], k[3]) + 1j * omega * v)


@inlined
def slip_left(scratch: Any, lane: int) -> Any:
    """Return slip speed, and the time that it would last if it went on falling as it does; inf if it does not."""
    _, _, ux, uy, r, _, _, _ = eight_of(scratch, lane, TRIAL)
    k = eight_of(scratch, lane, TRIAL + RATES)
    s = math.sqrt(ux * ux + uy * uy + r * r)
    falling = -(ux * k[2] + uy * k[3] + r * k[4]) / (s * k[6])
    return s, (s / falling if falling > 0.0 else math.inf)


@scalar
def comes_to_rest(scratch: Any, lane: int, law: DiscLaw) -> bool:
    """Tell whether slip ends within a moment, and let it: it falls linearly. As slow as rounding, it ends at once."""
    x, y, ux, uy, r, angle, t, way = eight_of(scratch, lane, TRIAL)
    k = eight_of(scratch, lane, TRIAL + RATES)
    s = math.sqrt(ux * ux + uy * uy + r * r)
    falling = -(ux * k[2] + uy * k[3] + r * k[4]) / (s * k[6])
    if not falling > 0.0:
        return False
    left = s / falling
    across = (k[2] / k[6] + falling * ux / s, k[3] / k[6] + falling * uy / s, k[4] / k[6] + falling * r / s)
    bend = left * math.sqrt(across[0] ** 2 + across[1] ** 2 + across[2] ** 2) / falling
    pace = abs(law.disc_speed) + law.shaft_rate + 1.0
    if bend + left * left * pace >= REST_TIME:
        if s <= LEAST_SLIP:
            put(scratch, lane, (x, y, 0.0, 0.0, 0.0, angle, t, way))
        return bool(s <= LEAST_SLIP)
    delay = min(left, scratch[DURATION * LANES + lane] - t)
    remains = 1.0 - delay / left
    mean = 0.5 * (1.0 + remains) * delay
    middle = complex(x, y) + (0.5 * delay / k[6]) * complex(k[0], k[1])
    z = complex(x, y) + mean * complex(ux, uy) + delay * 1j * law.disc_speed * middle
    angle += law.disc_speed * delay + law.curling * r * mean
    slip = remains * ux, remains * uy, remains * r
    put(
        scratch, lane, (z.real, z.imag, slip[0], slip[1], slip[2], angle, t + delay, way + k[7] / k[6] * mean)
    )
    return True


@scalar
def begin_slip(scratch: Any, lane: int, z: complex, angle: float, t: float, law: DiscLaw) -> bool:
    """Let a disc on a ring slip from rest at ``z``; tell whether the motion could be resolved."""
    n, turning, first, taken = direction(z, law)
    way = scratch[(TRIAL + WAY) * LANES + lane]
    if first > SUDDEN * taken:
        u = LEAST_SLIP * n
        put(scratch, lane, (z.real, z.imag, u.real, u.imag, LEAST_SLIP * turning, angle, t, way))
        return True
    left = min(scratch[DURATION * LANES + lane] - t, LONGEST_GROWTH)
    z, u, r, took, curl, work = grown(z, n, turning, max(first, 0.0), left, law)
    angle += law.disc_speed * took + law.curling * curl
    put(scratch, lane, (z.real, z.imag, u.real, u.imag, r, angle, t + took, way + work))
    return bool(took > 0.0)
