"""The lanes of discs: their data, the step of all lanes, and the end and beginning of slip in one lane."""

import math
from collections.abc import Callable
from typing import Annotated, Any, NamedTuple

from numpy.typing import NDArray

from reference_model.core.forces.law import SCALARS, WIDTH
from reference_model.ensemble.core.by_core import Room
from reference_model.ensemble.core.contact_shares import LEAST
from reference_model.ensemble.core.jit import inlined, scalar, wide_vectors, written_out
from reference_model.ensemble.core.lanes import (
    EXTREME,
    IS_DUE,
    LOST,
    REST,
    RIGHTMOST,
    SMALLEST_STEP,
    STIFF,
    Lanes,
    Memory,
)
from reference_model.ensemble.core.laws import DiscLaw
from reference_model.ensemble.core.records import Record, Row, Rows, at, put
from reference_model.ensemble.core.recurrence import Measures, Series
from reference_model.ensemble.core.stepping.dense_output import DenseOutput, Motion, dense_output
from reference_model.ensemble.core.stepping.runge_kutta import TURNED_BACK, Tuple, factor_of, moved, step
from reference_model.systems import FloatArray


class DiscState(NamedTuple):
    """Position, slip velocity, r, angle, time and mean slip distance, scaled; or their rates in stretched time."""

    x: float
    y: float
    ux: float
    uy: float
    r: float
    angle: float
    time: float
    way: float


class Moment(Record):
    """The motion at one time, with its rates, and the next step."""

    state: Rows[DiscState]
    rates: Rows[DiscState]
    step: Row


class DiscLanes(Lanes):
    """All lanes; ``usual`` is the step before the edge shortened it, ``duration`` the end of the motion."""

    now: Moment
    trial: Moment
    law: Rows[DiscLaw]
    usual: Row
    duration: Row


Rates = Callable[[Tuple, DiscLaw], Tuple]
"""Returns the rates of the unknowns, as :func:`reference_model.ensemble.disc.slip.ring_rates`."""

RatesInRoom = Callable[[Tuple, DiscLaw, Room], Tuple]
"""Returns them, perhaps by the law in the room."""

Edge = Callable[[Tuple, Tuple, DiscLaw], tuple[float, float]]
"""Returns the distance from where friction is not smooth, as :func:`reference_model.ensemble.disc.slip.ring_edge`."""

UNWATCHED, TURNS, BOTH, RADII = 0.0, 1.0, 2.0, 3.0
"""Degrees of watching: no flags; flags where x is largest; flags there and where the radius is extreme; only the
last."""

SHORT_STEP, MANY = 0.1, 40.0
"""As for pins; explicit steps of discs cost more."""

MOST_STEPS = 5_000_000.0
FIRST_STEP = 0.1

ON_EDGE = 1e-4
"""Share of a step within which its start or end counts as lying on the edge."""

AT_END = 1e-13
"""Scaled time that is neglected at the end."""

SLOW, NEAR_REST = 0.01, 1e-4
"""Slip speeds in units of g: below the first the tolerance of slip is relative, below the second slip may end."""


@written_out
def advance_with(
    lanes: DiscLanes, around: Tuple, rates: Rates, edge: Edge, small_step: float, count: int
) -> None:
    """Make a trial step in the first ``count`` lanes; where it is rejected the trial is the old state.

    A step across the ``edge`` of friction or the end is repeated up to it, because its error estimate is unreliable.
    A step smaller than ``small_step`` also raises a flag.
    """
    wide_vectors()
    now, trial = lanes.now, lanes.trial
    for lane in range(count):
        state, k = state_at(now, lane), rates_at(now, lane)
        law = DiscLaw(around, *at(lanes.law, lane))
        h, end = now.step[lane], lanes.duration[lane]
        mean, third, fifth = step(rates, law, state[:6], k, h)
        new = DiscState(*moved(state, h, (1.0,), (mean,)))
        k1 = DiscState(*rates(new[:6], law))
        error = error_of_slip(state, new, h, third, fifth, lanes.tolerance[lane], law)
        along = new.ux * state.ux + new.uy * state.uy + new.r * state.r
        error = error if (along > 0.0) | (law.friction == 0.0) else TURNED_BACK
        good = error < 1.0
        next_step = h * factor_of(error)

        before, approach = edge(state[:6], k, law)
        after, _ = edge(new[:6], k1, law)
        far = min(abs(before), abs(after)) > ON_EDGE * abs(after - before)
        crossed = good & (before * after < 0.0) & far
        late = good & (new.time > end + AT_END)
        to_edge = share_to_edge(before, after, approach, h)
        share = (end - state.time) / (new.time - state.time) if late else to_edge
        taken = good & (not crossed) & (not late)
        usual = lanes.usual[lane]
        resumed = min(max(next_step, usual), (end - new.time) / max(k1.time, LEAST))
        lanes.usual[lane] = 0.0 if taken else (max(h, usual) if crossed else usual)
        trial.step[lane] = resumed if taken else (h * share if good else next_step)

        done = new.time >= end - AT_END
        due = (new.time >= lanes.due[lane]) | done
        flag = flags_of(state, k, new, k1, NEAR_REST * law.friction, due, h < small_step, lanes.watch[lane])
        flag = flag if taken else 0.0
        steps = lanes.steps[lane] + 1.0
        short = lanes.short[lane] + 1.0 if new.time - state.time < SHORT_STEP else 0.0
        flag += STIFF if short > MANY else 0.0
        lost = (not h > SMALLEST_STEP) | (steps > MOST_STEPS)
        flag += LOST if lost & (not (taken & done)) else 0.0
        lanes.short[lane], lanes.flag[lane], lanes.steps[lane] = short, flag, steps
        put(trial.state, lane, new if taken else state)
        put(trial.rates, lane, k1 if taken else k)


@inlined
def error_of_slip(
    state: DiscState, new: DiscState, h: float, third: Tuple, fifth: Tuple, tolerance: float, law: DiscLaw
) -> float:
    """Return a step's error in tolerances. It is relative for small slip, whose direction decides its end."""
    slip = math.sqrt(state.ux * state.ux + state.uy * state.uy + state.r * state.r)
    small = (slip + law.free) / (SLOW * law.friction + LEAST)
    high = low = 0.0
    for j in range(7):
        size = 1.0 + (max(abs(state[j]), abs(new[j])) if j < 5 else 0.0)
        size = max(min(size, small), LEAST) if 2 <= j < 5 else size
        high += (fifth[j] / size) ** 2
        low += (third[j] / size) ** 2
    return h * high / (math.sqrt((high + 0.01 * low) * 7.0 + 1e-300) * tolerance)


@inlined
def share_to_edge(before: float, after: float, approach: float, h: float) -> float:
    """Return the share of a step up to the edge, by a parabola."""
    slope = approach * h
    bend = after - before - slope
    root = math.sqrt(max(slope * slope - 4.0 * bend * before, 0.0))
    share = abs(2.0 * before) / (abs(slope) + root + LEAST)
    return min(max(share if approach * before < 0.0 else 0.5, 0.01), 0.99)


@inlined
def flags_of(
    state: DiscState, k: DiscState, new: DiscState, k1: DiscState, nearly: float, due: bool, fine: bool, watch: float
) -> float:  # fmt: skip
    s2 = new.ux * new.ux + new.uy * new.uy + new.r * new.r
    turns = (state.x * k.x + state.y * k.y > 0.0) != (new.x * k1.x + new.y * k1.y > 0.0)
    flag = REST if (s2 < nearly * nearly) | fine else 0.0
    flag += IS_DUE if due else 0.0
    flag += RIGHTMOST if (k.x > 0.0) & (k1.x <= 0.0) & ((watch == TURNS) | (watch == BOTH)) else 0.0
    flag += EXTREME if turns & (watch >= BOTH) else 0.0
    return flag


@inlined
def law_of(lanes: DiscLanes, lane: int, around: Tuple) -> DiscLaw:
    return DiscLaw(around, *at(lanes.law, lane))


@inlined
def state_at(moment: Moment, lane: int) -> DiscState:
    return DiscState(*at(moment.state, lane))


@inlined
def rates_at(moment: Moment, lane: int) -> DiscState:
    return DiscState(*at(moment.rates, lane))


@inlined
def put_slipping(lanes: DiscLanes, lane: int, law: DiscLaw, rates: Rates) -> None:
    trial = lanes.trial
    put(trial.rates, lane, rates(state_at(trial, lane)[:6], law))
    trial.step[lane] = FIRST_STEP
    lanes.usual[lane] = lanes.short[lane] = 0.0


@scalar
def last_step(lanes: DiscLanes, lane: int) -> DenseOutput:
    now, trial = lanes.now, lanes.trial
    h, omega = trial.state.time[lane] - now.state.time[lane], lanes.law.disc_speed[lane]
    z0, v0, a0 = _motion(state_at(now, lane), rates_at(now, lane), omega)
    z1, v1, a1 = _motion(state_at(trial, lane), rates_at(trial, lane), omega)
    way, scale = 60.0 * (z1 - z0), 1.0 / h**3
    j0 = scale * (way - h * (36.0 * v0 + 24.0 * v1) - h * h * (9.0 * a0 - 3.0 * a1))
    j1 = scale * (way - h * (24.0 * v0 + 36.0 * v1) - h * h * (3.0 * a0 - 9.0 * a1))
    return dense_output(h, Motion(z0, v0, a0, j0), Motion(z1, v1, a1, j1))


@inlined
def _motion(state: DiscState, k: DiscState, omega: float) -> tuple[complex, complex, complex]:
    pace, v = 1.0 / k.time, complex(k.x, k.y)
    return complex(state.x, state.y), pace * v, pace * (complex(k.ux, k.uy) + 1j * omega * v)


# --- Scalar data of each lane

OF_TURN, OF_PEAK = 1, 2
"""Kinds of windows: from one largest x, or one largest radius, to the next."""


class Region(Record):
    """A neighbourhood that no motion leaves, in m and s: where a quadratic form is below its level.

    ``circle`` is 1 about a whirl, in coordinates that turn with the centre (ρ, v along and across the radius, r, 0),
    and 0 about an equilibrium, in (x, y, vx, vy, r). ``form`` is the upper half of the form, row by row.
    """

    circle: int
    centre: Annotated[FloatArray, 5]
    form: Annotated[FloatArray, 15]
    level: float
    measures: Measures


class DiscMemory(Memory):
    """Scalar data of a lane, with the motion at ``checks``, at the largest x (``turns``) and the largest radius.

    ``law`` are the parameters for the core. In its last step, ``short`` steps were short, and a
    rest ended at ``since``.
    """

    law: Annotated[FloatArray, SCALARS]
    short: float
    since: float
    checks: Series
    turns: Series
    peaks: Series


class DiscSettings(NamedTuple):
    """Settings for scalar code."""

    tolerance: float
    early: bool
    around: tuple[float, ...]
    regions: NDArray[Any]


class Setup(NamedTuple):
    """Settings, and the parameters of steps by the core.

    ``points`` is ``Law.around`` of the core, with lengths in units of κ/η. If ``by_core`` is set, the core takes all
    steps.
    """

    settings: DiscSettings
    points: FloatArray
    room: Room
    by_core: bool


@scalar
def put_state(state: FloatArray, lanes: DiscLanes, moment: Moment, memory: DiscMemory, lane: int) -> None:
    length, rate = memory.length, memory.rate
    there = state_at(moment, lane)
    omega, curling = lanes.law.disc_speed[lane], lanes.law.curling[lane]
    state[0], state[1], state[2] = there.x * length, there.y * length, there.angle
    state[3] = (there.ux - omega * there.y) * length * rate
    state[4] = (there.uy + omega * there.x) * length * rate
    state[5] = (omega + curling * there.r) * rate


@scalar
def take_in(memory: DiscMemory, law: DiscLaw, setup: Setup) -> None:
    """Write the law of a trajectory to the room of the core."""
    room = setup.room
    for i in range(SCALARS):
        room.parameters[i] = memory.law[i]
    for i in range(len(room.around)):
        is_length = i % WIDTH < 2 or i % WIDTH > 4
        room.around[i] = setup.points[i] * (law.leverage if is_length else 1.0)
