"""The lanes of pins: their data, the step of all lanes, and operations on one lane."""

from typing import Annotated, Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from reference_model.ensemble.core.by_core import Room, room_for
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
from reference_model.ensemble.core.laws import PinLaw
from reference_model.ensemble.core.records import LANES, Record, Row, Rows, at, fill, layout, put
from reference_model.ensemble.core.recurrence import NO_WINDOW, Measures, Series, measured, see_radius
from reference_model.ensemble.core.stepping.dense_output import DenseOutput, Motion, dense_output, size_of
from reference_model.ensemble.core.stepping.runge_kutta import TURNED_BACK, error_of, factor_of, moved, step
from reference_model.ensemble.pin.end_states import FORM_SIZE
from reference_model.ensemble.pin.slip import MOST_TERMS, pin_rates
from reference_model.systems import ComplexArray, FloatArray


class PinState(NamedTuple):
    """Position, slip velocity, time and slip distance, scaled; or their rates in stretched time."""

    x: float
    y: float
    wx: float
    wy: float
    time: float
    way: float


class Moment(Record):
    """The motion at one time, with its rates, and the next step."""

    state: Rows[PinState]
    rates: Rows[PinState]
    step: Row


class PinLanes(Lanes):
    """All lanes; ``slow`` is the slip speed below which rest may be near."""

    now: Moment
    trial: Moment
    law: Rows[PinLaw]
    slow: Row
    most_steps: Row


UNWATCHED, TURNS, RADII = 0.0, 1.0, 2.0
"""Degrees of watching: no flags, flags where x is largest, and flags where the radius is extreme too."""

STEPS_TO_SPARE, STEPS_A_TIME = 50_000.0, 2000.0
"""Largest number of steps of a motion before it is undecided: a constant plus a number per unit of time."""

SHORT_STEP, MANY = 5e-3, 160.0
"""Scaled duration of a short step, and number of successive short steps that calls for the core.

A step of the core costs as much as a thousand steps in shared lanes.
"""

LANDING = 1e-9
"""Scaled time beyond the end that one Euler step takes back, with an error of its square."""

FIRST_STEP = 0.3
"""Scaled first step of fast slip."""


@written_out
def _advance_in(lanes: PinLanes, count: int) -> None:
    """Make a trial step in the first ``count`` lanes; if its error is too large, the trial is the old state."""
    wide_vectors()
    now, trial = lanes.now, lanes.trial
    for lane in range(count):
        state, k, h = state_at(now, lane), rates_at(now, lane), now.step[lane]
        law = PinLaw(*at(lanes.law, lane))
        mean, third, fifth = step(pin_rates, law, state[:4], k, h)
        new = PinState(*moved(state, h, (1.0,), (mean,)))
        k1 = PinState(*pin_rates(new[:4], law))
        error = error_of(state[:4], new[:4], h, third, fifth, lanes.tolerance[lane])
        along = new.wx * state.wx + new.wy * state.wy
        error = error if (along > 0.0) | (law.friction == 0.0) else TURNED_BACK
        good = error < 1.0
        shorter = h * factor_of(error)

        flag = flags_of(state, k, new, k1, lanes.due[lane], lanes.slow[lane], lanes.watch[lane])
        flag = flag if good else 0.0
        steps = lanes.steps[lane] + 1.0
        lost = (shorter < SMALLEST_STEP) | (steps > lanes.most_steps[lane])
        short = lanes.short[lane] + 1.0 if new.time - state.time < SHORT_STEP else 0.0
        flag += STIFF if short > MANY else 0.0

        lanes.short[lane] = short
        lanes.flag[lane] = flag + (LOST if lost else 0.0)
        lanes.steps[lane] = steps
        put(trial.state, lane, new if good else state)
        put(trial.rates, lane, k1 if good else k)
        trial.step[lane] = shorter


@scalar
def advance(lanes: PinLanes, _: None) -> None:
    _advance_in(lanes, LANES)


@scalar
def advance_alone(lanes: PinLanes, _: None) -> None:
    _advance_in(lanes, 1)


@inlined
def flags_of(
    state: PinState, k: PinState, new: PinState, k1: PinState, due: float, slow: float, watch: float
) -> float:
    resting = (new.wx * new.wx + new.wy * new.wy < slow * slow) & (new.wx * k1.wx + new.wy * k1.wy < 0.0)
    rightmost = (k.x > 0.0) & (k1.x <= 0.0) & (watch >= TURNS)
    turns = (state.x * k.x + state.y * k.y > 0.0) != (new.x * k1.x + new.y * k1.y > 0.0)
    flag = REST if resting else 0.0
    flag += IS_DUE if new.time >= due else 0.0
    flag += RIGHTMOST if rightmost else 0.0
    flag += EXTREME if turns & (watch >= RADII) else 0.0
    return flag


@scalar
def law_of(lanes: PinLanes, lane: int) -> PinLaw:
    return PinLaw(*at(lanes.law, lane))


@inlined
def state_at(moment: Moment, lane: int) -> PinState:
    return PinState(*at(moment.state, lane))


@inlined
def rates_at(moment: Moment, lane: int) -> PinState:
    return PinState(*at(moment.rates, lane))


@inlined
def position_at(moment: Moment, lane: int) -> complex:
    return complex(moment.state.x[lane], moment.state.y[lane])


@inlined
def slip_at(moment: Moment, lane: int) -> complex:
    return complex(moment.state.wx[lane], moment.state.wy[lane])


@scalar
def put_slipping(lanes: PinLanes, lane: int, z: complex, w: complex, law: PinLaw) -> None:
    put_motion(lanes.trial, lane, z, w, law)
    lanes.short[lane] = 0.0
    h = FIRST_STEP
    if law.friction > 0.0:
        h = min(
            h, (abs(w) + law.stretching) / law.friction
        )  # the direction of slip follows the pull no faster
    lanes.trial.step[lane] = h


@inlined
def put_motion(moment: Moment, lane: int, z: complex, w: complex, law: PinLaw) -> None:
    put_position(moment, lane, z, w)
    put(moment.rates, lane, pin_rates((z.real, z.imag, w.real, w.imag), law))


@inlined
def put_position(moment: Moment, lane: int, z: complex, w: complex) -> None:
    state = moment.state
    state.x[lane], state.y[lane], state.wx[lane], state.wy[lane] = z.real, z.imag, w.real, w.imag


@scalar
def landed(lanes: PinLanes, lane: int, end: float) -> bool:
    """Move the trial to the time ``end`` if it is close, otherwise reject it; return whether it moved."""
    now, trial = lanes.now, lanes.trial
    state, rates = trial.state, trial.rates
    beyond, share = state.time[lane] - end, rates.time[lane]
    if beyond > LANDING:
        h = now.step[lane]
        put(state, lane, at(now.state, lane))
        put(rates, lane, at(now.rates, lane))
        shorter = h - beyond / share
        trial.step[lane] = shorter if 0.0 < shorter < h else 0.5 * h
        return False
    state.x[lane] -= beyond * (rates.x[lane] / share)
    state.y[lane] -= beyond * (rates.y[lane] / share)
    state.wx[lane] -= beyond * (rates.wx[lane] / share)
    state.wy[lane] -= beyond * (rates.wy[lane] / share)
    state.time[lane] = end
    return True


@inlined
def motion(z: complex, w: complex, law: PinLaw) -> Motion:
    s = size_of(w)
    n = w / s
    turn = complex(0.0, law.disc_speed)
    v = w + turn * z
    a = -law.stiffness * (z - law.offset) - law.damping * v - law.friction * n
    growth = a - turn * v
    turning = (growth - n * (n.conjugate() * growth).real) / s
    return Motion(z, v, a, -law.stiffness * v - law.damping * a - law.friction * turning)


@scalar
def last_step(lanes: PinLanes, lane: int, law: PinLaw) -> DenseOutput:
    now, trial = lanes.now, lanes.trial
    first = motion(position_at(now, lane), slip_at(now, lane), law)
    last = motion(position_at(trial, lane), slip_at(trial, lane), law)
    return dense_output(trial.state.time[lane] - now.state.time[lane], first, last)


# --- Scalar data of each lane, and the window that measures an end state

OF_TURN, OF_RELEASE = 1, 2
"""Kinds of windows: from crossing to crossing, or from release to release."""


class TrappingRegions(Record):
    """Trapping regions in m and s, if all trajectories have the same parameters.

    ``level`` and ``form`` belong to the equilibrium. ``reach`` is the level and ``metric`` the form of the whirl,
    with its crossing ``turn`` (x, y, ẏ/k) and ``measures``. A level of 0 means unknown.
    """

    level: float
    form: Annotated[FloatArray, FORM_SIZE]
    reach: float
    turn: Annotated[FloatArray, 3]
    metric: Annotated[FloatArray, 6]
    measures: Measures


class PinMemory(Memory):
    """Scalar data of a lane, with x, y and ẏ at crossings of the section (``turns``) and radii of ``releases``."""

    duration: float
    equilibrium: complex
    level: float
    form: Annotated[FloatArray, FORM_SIZE]
    turns: Series
    releases: Series


class Settings(NamedTuple):
    """Settings for scalar code.

    ``early`` ends a trajectory as soon as its end state is certain, ``once`` at its first crossing of the section.
    """

    tolerance: float
    early: bool
    once: bool
    regions: TrappingRegions
    series: ComplexArray
    room: Room


def no_regions() -> NDArray[Any]:
    return np.zeros(1, layout(TrappingRegions))


def settings_of(
    tolerance: float,
    early: bool = False,
    once: bool = False,
    regions: NDArray[Any] | None = None,
) -> Settings:
    # The kernel is compiled for writable arrays only.
    known = no_regions() if regions is None else regions.copy()
    series = np.zeros((6, MOST_TERMS + 2), dtype=complex)
    return Settings(tolerance, early, once, known[0], series, room_for(0))


@inlined
def keep(memory: PinMemory, least: float, largest: float, slip: float) -> None:
    fill(memory.found, Measures(least, largest, slip))


@scalar
def close_window(memory: PinMemory, end: int, t: float, way: float, radius: float) -> None:
    see_radius(memory.window, radius)
    fill(memory.found, measured(memory.window, t, way))
    memory.end, memory.window.kind = end, NO_WINDOW


@scalar
def put_state(state: FloatArray, memory: PinMemory, z: complex, w: complex, law: PinLaw) -> None:
    length, rate = memory.length, memory.rate
    state[0], state[1] = z.real * length, z.imag * length
    state[2] = (w.real - law.disc_speed * z.imag) * length * rate
    state[3] = (w.imag + law.disc_speed * z.real) * length * rate
