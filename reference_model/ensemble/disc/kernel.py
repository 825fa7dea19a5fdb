"""The kernels of discs on rings or points in lanes, and of any body by the core."""

import math
from collections.abc import Callable
from typing import Any

import numpy as np

from reference_model.core.forces.law import HARDENING, SCALARS, STOP, unpacked
from reference_model.core.forces.rates import rates as rates_of
from reference_model.ensemble.core.by_core import USUAL_SPAN, Room, law_in, power, put_law, with_core
from reference_model.ensemble.core.jit import called_from_python, inlined, scalar, written_out
from reference_model.ensemble.core.lanes import STIFF, row_of, run, store_end
from reference_model.ensemble.core.laws import ROUNDING_OF_SLIP, STRETCHING_TIME, DiscLaw, units
from reference_model.ensemble.core.records import LANES, clear, layout, put
from reference_model.ensemble.core.stepping.runge_kutta import Tuple
from reference_model.ensemble.disc.events import handle_flag_with
from reference_model.ensemble.disc.lanes import (
    FIRST_STEP,
    MANY,
    RADII,
    TURNS,
    DiscLanes,
    DiscMemory,
    Edge,
    Rates,
    RatesInRoom,
    Setup,
    advance_with,
    put_state,
    state_at,
    take_in,
)
from reference_model.ensemble.disc.rest import step_by_core_with
from reference_model.ensemble.disc.slip import held_friction, no_edge, points_rates, ring_edge, ring_rates
from reference_model.ensemble.end_states import Results
from reference_model.ensemble.task import Task

LANES_LAYOUT, MEMORY_LAYOUT = layout(DiscLanes), layout(DiscMemory)

WATCHED_STEP = 1e-3
"""Step below which points of a disc may be about to rest."""


Scaling = Callable[[DiscMemory, int, Task, Setup], tuple[DiscLaw, float, float]]
"""Writes units and parameters to the memory; returns the law, the speed of the master disc in rad/s, and κ in m."""


@scalar
def scaled(memory: DiscMemory, number: int, task: Task, setup: Setup) -> tuple[DiscLaw, float, float]:
    """Scale the SI parameters of a disc on a linear support."""
    mass, stiffness, damping, force, omega, offset, inertia, radius, shaft, shaft_speed = row_of(
        task.parameters, number
    )
    x, y, _, vx, vy, _ = row_of(task.starts, number)
    k, decay, g = math.sqrt(stiffness / mass), max(damping / mass, shaft / inertia), force / mass
    length, rate = units(k, decay, g, omega, offset, math.hypot(x, y), math.hypot(vx, vy))
    kappa, speed = math.sqrt(inertia / mass), length * rate
    friction = g / (speed * rate)
    law = DiscLaw(
        setup.settings.around,
        stiffness / mass / rate**2,
        damping / mass / rate,
        friction,
        omega / rate,
        offset / length,
        STRETCHING_TIME * friction if force > 0.0 else 1.0,
        0.0 if force > 0.0 else 1.0,
        radius / kappa,
        shaft / inertia / rate,
        kappa * (omega - shaft_speed) / speed,
        length / kappa,
    )
    memory.length, memory.rate = length, rate
    rim, hold = 0.0, friction
    if len(setup.settings.around) == 0:
        rim, hold = law.leverage, held_friction(law)
    put_law(
        memory.law, law.damping, law.stiffness, law.offset, friction, hold, law.disc_speed, rim, law.shaft_rate,
        law.lag, 1.0 / law.curling,
    )  # fmt: skip
    return law, omega, kappa


@scalar
def scaled_before(memory: DiscMemory, number: int, task: Task, setup: Setup) -> tuple[DiscLaw, float, float]:
    """Read the numbers of ``driver.scaled_for_core``."""
    row = row_of(task.parameters, number)
    for i in range(SCALARS):
        memory.law[i] = row[i]
    memory.length, memory.rate, leverage, omega, kappa = row[-5], row[-4], row[-3], row[-2], row[-1]
    core = unpacked(row, setup.room.around)
    law = DiscLaw(
        setup.settings.around, core.stiffness, core.damping, core.friction, core.omega, core.offset,
        core.stretch if core.friction > 0.0 else 1.0, 0.0 if core.friction > 0.0 else 1.0, leverage, core.shaft,
        core.lag, 1.0 / core.gyration,
    )  # fmt: skip
    return law, omega, kappa


@written_out
def load_with(
    lanes: DiscLanes,
    memory: DiscMemory,
    lane: int,
    number: int,
    task: Task,
    setup: Setup,
    scaling: Scaling,
    rates: RatesInRoom,
) -> bool:
    clear(memory)
    law, omega, kappa = scaling(memory, number, task, setup)
    length, rate = memory.length, memory.rate
    x, y, angle, vx, vy, spin = row_of(task.starts, number)
    duration = float(row_of(task.durations, number)) * rate
    memory.number, memory.span = number, USUAL_SPAN
    memory.tick = math.inf
    if law.stiffness > 0.0:
        memory.tick = 2.0 * math.pi / math.sqrt(law.stiffness)
    elif memory.law[HARDENING] > 0.0 or memory.law[STOP] > 0.0:
        memory.tick = 2.0 * math.pi
    put(lanes.law, lane, law)
    lanes.tolerance[lane], lanes.duration[lane], lanes.due[lane] = (
        setup.settings.tolerance,
        duration,
        memory.tick,
    )
    lanes.watch[lane] = RADII if law.offset == 0.0 else TURNS
    lanes.usual[lane] = lanes.flag[lane] = lanes.steps[lane] = lanes.short[lane] = 0.0

    speed = length * rate
    u = complex(vx + omega * y, vy - omega * x) / speed
    r = kappa * (spin - omega) / speed
    if abs(u) <= ROUNDING_OF_SLIP * abs(omega) * math.hypot(x, y) / speed:
        u = 0j
    if abs(spin - omega) <= ROUNDING_OF_SLIP * abs(omega):
        r = 0.0
    trial = lanes.trial
    put(trial.state, lane, (x / length, y / length, u.real, u.imag, r, angle, 0.0, 0.0))
    take_in(memory, law, setup)
    put(trial.rates, lane, rates(state_at(trial, lane)[:6], law, setup.room))
    trial.step[lane] = FIRST_STEP
    if u == 0j and r == 0.0:
        lanes.short[lane] = MANY  # the core releases it
    return bool(duration <= 0.0)


@scalar
def store(lanes: DiscLanes, memory: DiscMemory, lane: int, results: Results) -> None:
    put_state(results.states[memory.number], lanes, lanes.trial, memory, lane)
    store_end(lanes, memory, lane, results)


def _general_rates(y: Tuple, law: DiscLaw, room: Room) -> Tuple:
    whole = law_in(room)
    found = rates_of(y[0], y[1], y[2], y[3], y[4], y[5], whole)
    x, y_, ux, uy, r, angle, time = found
    return x, y_, ux, uy, r, angle, time, time * power(y[2], y[3], y[4], y[5], whole)


def _functions(rates: Rates, edge: Edge, small_step: float) -> tuple[Any, Any, Any, Any]:
    """Return the functions of ``core.lanes.run`` for one kind of contact: load, advance (one or all), handle flag.

    The compiler accepts functions as arguments only if they are global or enclosed like these.
    """

    @scalar
    def rates_in(y: Tuple, law: DiscLaw, room: Room) -> Tuple:
        return rates(y, law)

    @scalar
    def advance(lanes: DiscLanes, around: Tuple) -> None:
        advance_with(lanes, around, rates, edge, small_step, LANES)

    @scalar
    def advance_alone(lanes: DiscLanes, around: Tuple) -> None:
        advance_with(lanes, around, rates, edge, small_step, 1)

    load, handle_flag = _scalar_functions(scaled, rates_in)
    return load, advance, advance_alone, handle_flag


def _scalar_functions(scaling: Scaling, rates: RatesInRoom) -> tuple[Any, Any]:
    """Return the functions that load a trajectory and handle a flag."""

    @written_out
    def load(lanes: DiscLanes, memory: DiscMemory, lane: int, number: int, task: Task, setup: Setup) -> bool:
        return load_with(lanes, memory, lane, number, task, setup, scaling, rates)

    @scalar
    def step_by_core(lanes: DiscLanes, memory: DiscMemory, lane: int, law: DiscLaw, setup: Setup) -> bool:
        return step_by_core_with(lanes, memory, lane, law, setup, rates)

    @written_out
    def handle_flag(lanes: DiscLanes, memory: DiscMemory, lane: int, setup: Setup) -> bool:
        return handle_flag_with(lanes, memory, lane, setup, step_by_core)

    return load, handle_flag


@scalar
def _ask_the_core(lanes: DiscLanes, around: Tuple) -> None:
    """Raise the flag that asks for a step by the core in each lane."""
    for lane in range(LANES):
        lanes.flag[lane] = STIFF


_load_ring, _advance_rings, _advance_ring_alone, _handle_ring = _functions(ring_rates, ring_edge, 0.0)
_load_points, _advance_points, _advance_points_alone, _handle_points = _functions(
    points_rates, no_edge, WATCHED_STEP
)
_load_any, _handle_any = _scalar_functions(scaled_before, scalar(_general_rates))


@inlined
def _with_core(setup: Setup, core: Callable[..., None]) -> Setup:
    return Setup(setup.settings, setup.points, with_core(setup.room, core), setup.by_core)


@called_from_python
def run_rings(
    task: Task, setup: Setup, core: Callable[..., None], results: Results, first: int, last: int
) -> None:
    run(
        _load_ring, _advance_rings, _advance_ring_alone, _handle_ring, store,
        np.zeros(1, LANES_LAYOUT), np.zeros(LANES, MEMORY_LAYOUT), first, last,
        setup.settings.around, task, _with_core(setup, core), results,
    )  # fmt: skip


@called_from_python
def run_points(
    task: Task, setup: Setup, core: Callable[..., None], results: Results, first: int, last: int
) -> None:
    _run_points(task, _with_core(setup, core), results, first, last)


@inlined
def _run_points(task: Task, setup: Setup, results: Results, first: int, last: int) -> None:
    """Separate for the same reason as ``pin.kernel._run_pins``."""
    run(
        _load_points, _advance_points, _advance_points_alone, _handle_points, store,
        np.zeros(1, LANES_LAYOUT), np.zeros(LANES, MEMORY_LAYOUT), first, last,
        setup.settings.around, task, setup, results,
    )  # fmt: skip


@called_from_python
def run_by_core(
    task: Task, setup: Setup, core: Callable[..., None], results: Results, first: int, last: int
) -> None:
    run(
        _load_any, _ask_the_core, _ask_the_core, _handle_any, store,
        np.zeros(1, LANES_LAYOUT), np.zeros(LANES, MEMORY_LAYOUT), first, last,
        setup.settings.around, task, _with_core(setup, core), results,
    )  # fmt: skip
