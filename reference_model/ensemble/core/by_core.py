"""Steps of a lane by :mod:`reference_model.core`, which handles rest, release, pivots and stiff slip.

The compiled core is called, not compiled again, so all kernels share it.
"""

import math
from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np

from reference_model.core.forces.law import FRICTION, SCALARS, WIDTH, Law, unpacked
from reference_model.core.forces.rates import friction
from reference_model.core.memory import (
    ENDS,
    PATIENCE,
    PHASE,
    PHASES,
    POINT,
    RECORDED,
    RUNS,
    SHORT,
    SLIPS,
    SLOTS,
    SPAN,
    STATUS,
    STEP,
    STICKS,
)
from reference_model.core.single import FEW, compiled_advance
from reference_model.core.steps.explicit import SIZE
from reference_model.ensemble.core.jit import inlined, scalar
from reference_model.ensemble.core.laws import STRETCHING_TIME
from reference_model.ensemble.core.recurrence import Window, see_radius
from reference_model.ensemble.core.stepping.runge_kutta import Tuple
from reference_model.systems import FloatArray

SAMPLES = 8
"""Number of samples of slip in a step, for the distance."""

ROWS = 16
"""Room for phases; a call begins at most three."""

USUAL_SPAN = 0.4
"""Usual scaled duration of a step of a lane, within which polynomials describe the motion."""

STEADY = 0.2
"""Share of its distance from the axis that the body moves in a step while longer steps suffice."""

LEAST_STEP = 0.01
"""Explicit step in stretched time below which the core goes on."""

SHARE = 0.5
"""Tolerance of a step of the core as a share of the tolerance of a lane, which is twice as large."""


class Room(NamedTuple):
    """The compiled core with the arrays of a run, for one thread.

    For ``state``, ``memory``, ``times``, ``out`` and ``phases`` see :func:`reference_model.core.run.follow`. For
    ``parameters`` and ``around`` see :func:`reference_model.core.forces.law.unpacked`. ``core`` is a separate
    argument, because compiled code does not accept a tuple with a function from Python.
    """

    state: FloatArray
    memory: FloatArray
    times: FloatArray
    out: FloatArray
    phases: FloatArray
    parameters: FloatArray
    around: FloatArray
    core: Any = 0.0


def room_for(points: int) -> Room:
    """Return room for runs of a body on this number of contact points, without the core."""
    return Room(
        np.zeros(SIZE + 2), np.zeros(SLOTS), np.zeros(SAMPLES), np.zeros((SAMPLES, 6)), np.zeros((ROWS, 8)),
        np.zeros(SCALARS), np.zeros(WIDTH * points),
    )  # fmt: skip


def core_for_kernels() -> Any:
    """Return the compiled core for a kernel, which calls it by its address."""
    state, memory, times, out, phases, parameters, around, _ = room_for(0)
    return compiled_advance().compiled(
        state, memory, 1.0, 1.0, times, out, phases, 1.0, parameters, around
    )  # fmt: skip


@inlined
def with_core(room: Room, core: Callable[..., None]) -> Room:
    return Room(
        room.state, room.memory, room.times, room.out, room.phases, room.parameters, room.around, core
    )  # fmt: skip


@inlined
def put_law(
    place: FloatArray, damping: float, stiffness: float, offset: float, friction: float, hold: float, omega: float,
    rim: float, shaft: float, lag: float, gyration: float,
) -> None:  # fmt: skip
    """Write the parameters of a pin, a ring or points on a linear support in the order of the core."""
    numbers = (
        damping, stiffness, offset, 0.0, 0.0, 0.0, friction, hold, omega, rim, rim, 0.0, shaft, lag, gyration,
        STRETCHING_TIME * friction,
    )  # fmt: skip
    for i in range(len(numbers)):
        place[i] = numbers[i]


@scalar
def law_in(room: Room) -> Law:
    """Return the law of the body that the room is for."""
    law: Law = unpacked(room.parameters, room.around)
    return law


@scalar
def prepare(
    room: Room, y: Tuple, step: float, pace: float, short: float, patience: float, span: float
) -> None:
    """Begin a run of at most ``span`` from the unknowns ``y`` (7,).

    The explicit step is ``step`` in time stretched by ``pace``; of the steps before, ``short`` were short.
    """
    memory = room.memory
    memory[:] = 0.0
    memory[STEP], memory[SPAN], memory[PATIENCE] = step, step * pace, max(patience, FEW)
    memory[SHORT] = min(short, memory[PATIENCE])
    for v in range(SIZE):
        room.state[v] = y[v]
    room.state[SIZE], room.state[SIZE + 1] = y[2], y[3]
    sample(room, y[6], span)


@scalar
def sample(room: Room, start: float, span: float) -> None:
    """Sample the motion from ``start`` on, within ``span``."""
    room.memory[RECORDED] = 0.0
    for i in range(SAMPLES):
        room.times[i] = start + (i + 1) * span / SAMPLES


@scalar
def go_on(room: Room, tolerance: float, end: float) -> bool:
    """Continue a run by one step, or one rest and the slip that follows; return whether it is still sound."""
    room.memory[PHASES], room.memory[STATUS] = 0.0, RUNS
    room.core(
        room.state, room.memory, SHARE * tolerance, end, room.times, room.out, room.phases, 0.5, room.parameters,
        room.around,
    )  # fmt: skip
    return bool(room.memory[STATUS] <= ENDS)


@inlined
def rests(room: Room) -> bool:
    """Return whether the body rests as a whole."""
    state = room.state
    moves = state[2] != 0.0 or state[3] != 0.0 or state[4] != 0.0
    return not moves and room.parameters[FRICTION] > 0.0


@scalar
def is_done(room: Room, enough: float, patience: float) -> bool:
    """Return whether a lane can go on: slip is faster than ``enough``, or implicit steps do not pay.

    A lane's steps would be short at rest, in stiff slip, and while a contact point hardly slips.
    """
    memory = room.memory
    short = memory[SHORT] >= memory[PATIENCE] or memory[STEP] < LEAST_STEP
    if memory[PHASE] != SLIPS or memory[POINT] != 0.0 or short:
        return False
    return bool(slip_of(room) > enough or memory[PATIENCE] > max(patience, FEW))


@inlined
def slip_of(room: Room) -> float:
    """Return the slip of centre and rim together."""
    ux, uy, r = room.state[SIZE], room.state[SIZE + 1], room.state[4]
    return math.sqrt(ux * ux + uy * uy + r * r)


@scalar
def next_span(span: float, before: complex, after: complex, smooth: bool) -> float:
    """Return the duration of the next step by the core: longer while the body hardly moves."""
    return 2.0 * span if smooth and abs(after - before) < STEADY * abs(after) else USUAL_SPAN


@inlined
def count_after(room: Room, many: float) -> float:
    """Return where a lane begins to count short steps, so that at ``many`` it asks the core again."""
    count: float = many * (1.0 - room.memory[PATIENCE] / FEW)
    return count


@scalar
def released(room: Room) -> int:
    """Return the number of the phase that follows a stick phase of the last call, or −1."""
    for i in range(1, int(room.memory[PHASES])):
        if room.phases[i - 1, 0] == STICKS:
            return i
    return -1


@scalar
def way_of(room: Room, start: Tuple) -> float:
    """Return the slip distance of the run from the unknowns ``start``, by the trapezoidal rule."""
    law, state = law_in(room), room.state
    way, t, before = 0.0, start[6], power(start[2], start[3], start[4], start[5], law)
    for i in range(int(room.memory[RECORDED])):
        row = room.out[i]
        now = power(row[2], row[3], row[4], row[5], law)
        way += 0.5 * (room.times[i] - t) * (before + now)
        t, before = room.times[i], now
    now = power(state[SIZE], state[SIZE + 1], state[4], state[5], law)
    whole: float = way + 0.5 * (state[6] - t) * (before + now)
    return whole


@scalar
def see_samples(room: Room, window: Window) -> None:
    """See the extremes of the radius between equidistant samples, by parabolas."""
    for i in range(2, int(room.memory[RECORDED])):
        a, b, c = (
            math.hypot(room.out[i - 2, 0], room.out[i - 2, 1]), math.hypot(room.out[i - 1, 0], room.out[i - 1, 1]),
            math.hypot(room.out[i, 0], room.out[i, 1]),
        )  # fmt: skip
        if (b - a) * (c - b) < 0.0:
            see_radius(window, b - (c - a) ** 2 / (8.0 * (a - 2.0 * b + c)))


@scalar
def power(ux: float, uy: float, r: float, angle: float, law: Law) -> float:
    """Return the mean slip speed of the contact."""
    if law.friction == 0.0:
        return math.sqrt(ux * ux + uy * uy)
    fx, fy, fr, _ = friction(ux, uy, r, angle, law)
    mean: float = -(fx * ux + fy * uy + fr * r) / law.friction
    return mean
