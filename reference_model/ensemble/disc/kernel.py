"""The kernel of discs on rings or points."""

import math
from typing import Any

import numpy as np

from reference_model.ensemble.core.jit import called_from_python, inlined, scalar, written_out
from reference_model.ensemble.core.lanes import row_of, run, store_end
from reference_model.ensemble.core.laws import ROUNDING_OF_SLIP, STRETCHING_TIME, DiscLaw, units
from reference_model.ensemble.core.records import LANES, clear, layout, put
from reference_model.ensemble.core.stepping.implicit import Collocation, collocate_points, collocate_ring
from reference_model.ensemble.core.stepping.runge_kutta import Tuple
from reference_model.ensemble.disc.events import Attracts, Slow, disc_stride_with, handle_flag_with
from reference_model.ensemble.disc.lanes import (
    RADII,
    TURNS,
    DiscLanes,
    DiscMemory,
    DiscSettings,
    Edge,
    Rates,
    advance_with,
    put_slipping,
    put_state,
)
from reference_model.ensemble.disc.rest import points_rest, points_slow, ring_rests, ring_slow
from reference_model.ensemble.disc.slip import no_edge, points_rates, ring_edge, ring_rates
from reference_model.ensemble.disc.stability import attracts
from reference_model.ensemble.end_states import Results
from reference_model.ensemble.task import Task
from reference_model.systems import FloatArray

LANES_LAYOUT, MEMORY_LAYOUT = layout(DiscLanes), layout(DiscMemory)

WATCHED_STEP = 1e-3
"""Step below which points of a disc may be about to rest."""


@inlined
def _scaled_law(parameters: FloatArray, around: Tuple, length: float, rate: float) -> DiscLaw:
    mass, stiffness, damping, force, omega, offset, inertia, radius, shaft, shaft_speed = parameters
    kappa, speed = math.sqrt(inertia / mass), length * rate
    friction = force / mass / (speed * rate)
    return DiscLaw(
        around,
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


@written_out
def load_with(
    lanes: DiscLanes,
    memory: DiscMemory,
    lane: int,
    number: int,
    task: Task,
    settings: DiscSettings,
    rest: Slow,
    rates: Rates,
) -> bool:
    parameters = row_of(task.parameters, number)
    mass, stiffness, damping, force, omega, offset, inertia, _, shaft, _ = parameters
    x, y, angle, vx, vy, spin = row_of(task.starts, number)
    k, decay, g = math.sqrt(stiffness / mass), max(damping / mass, shaft / inertia), force / mass
    length, rate = units(k, decay, g, omega, offset, math.hypot(x, y), math.hypot(vx, vy))
    law = _scaled_law(parameters, settings.around, length, rate)
    clear(memory)
    duration = float(row_of(task.durations, number)) * rate
    memory.number, memory.length, memory.rate = number, length, rate
    memory.tick = 2.0 * math.pi / math.sqrt(law.stiffness) if law.stiffness > 0.0 else math.inf
    put(lanes.law, lane, law)
    lanes.tolerance[lane], lanes.duration[lane], lanes.due[lane] = settings.tolerance, duration, memory.tick
    lanes.watch[lane] = RADII if law.offset == 0.0 else TURNS
    lanes.usual[lane] = lanes.flag[lane] = lanes.steps[lane] = lanes.short[lane] = 0.0

    speed, kappa = length * rate, math.sqrt(inertia / mass)
    u = complex(vx + omega * y, vy - omega * x) / speed
    r = kappa * (spin - omega) / speed
    if abs(u) <= ROUNDING_OF_SLIP * abs(omega) * math.hypot(x, y) / speed:
        u = 0j
    if abs(spin - omega) <= ROUNDING_OF_SLIP * abs(omega):
        r = 0.0
    put(lanes.trial.state, lane, (x / length, y / length, u.real, u.imag, r, angle, 0.0, 0.0))
    if u == 0j and r == 0.0 and force > 0.0:
        return bool(rest(lanes, memory, lane, law, settings))
    put_slipping(lanes, lane, law, rates)
    return bool(duration <= 0.0)


@scalar
def store(lanes: DiscLanes, memory: DiscMemory, lane: int, results: Results) -> None:
    put_state(results.states[memory.number], lanes, lanes.trial, memory, lane)
    store_end(lanes, memory, lane, results)


@scalar
def _points_attract(z: complex, v: complex, r: float, law: DiscLaw, circle: bool, near: float) -> bool:
    """Return whether a motion of a disc on points attracts; known only without friction."""
    return law.friction == 0.0 and law.damping > 0.0 and law.stiffness > 0.0


def _functions(
    rest: Slow, slow: Slow, attracts: Attracts, rates: Rates, edge: Edge, collocate: Collocation, small_step: float
) -> tuple[Any, Any, Any, Any]:  # fmt: skip
    """Return the functions of ``core.lanes.run`` for one kind of contact: load, advance (one or all), handle flag.

    The compiler accepts functions as arguments only if they are global or enclosed like these.
    """

    @written_out
    def load(
        lanes: DiscLanes, memory: DiscMemory, lane: int, number: int, task: Task, settings: DiscSettings
    ) -> bool:
        return load_with(lanes, memory, lane, number, task, settings, rest, rates)

    @scalar
    def advance(lanes: DiscLanes, around: Tuple) -> None:
        advance_with(lanes, around, rates, edge, small_step, LANES)

    @scalar
    def advance_alone(lanes: DiscLanes, around: Tuple) -> None:
        advance_with(lanes, around, rates, edge, small_step, 1)

    @written_out
    def stride(lanes: DiscLanes, memory: DiscMemory, lane: int, law: DiscLaw) -> None:
        disc_stride_with(lanes, memory, lane, law, rates, edge, collocate)

    @written_out
    def handle_flag(lanes: DiscLanes, memory: DiscMemory, lane: int, settings: DiscSettings) -> bool:
        return handle_flag_with(lanes, memory, lane, settings, stride, slow, attracts)

    return load, advance, advance_alone, handle_flag


_load_ring, _advance_rings, _advance_ring_alone, _handle_ring = _functions(
    ring_rests, ring_slow, attracts, ring_rates, ring_edge, collocate_ring, 0.0
)
_load_points, _advance_points, _advance_points_alone, _handle_points = _functions(
    points_rest, points_slow, _points_attract, points_rates, no_edge, collocate_points, WATCHED_STEP
)


@called_from_python
def run_rings(task: Task, settings: DiscSettings, results: Results, first: int, last: int) -> None:
    run(
        _load_ring, _advance_rings, _advance_ring_alone, _handle_ring, store,
        np.zeros(1, LANES_LAYOUT), np.zeros(LANES, MEMORY_LAYOUT), first, last,
        settings.around, task, settings, results,
    )  # fmt: skip


@called_from_python
def run_points(task: Task, settings: DiscSettings, results: Results, first: int, last: int) -> None:
    _run_points(task, settings, results, first, last)


@inlined
def _run_points(task: Task, settings: DiscSettings, results: Results, first: int, last: int) -> None:
    """Separate for the same reason as ``pin.kernel._run_pins``."""
    run(
        _load_points, _advance_points, _advance_points_alone, _handle_points, store,
        np.zeros(1, LANES_LAYOUT), np.zeros(LANES, MEMORY_LAYOUT), first, last,
        settings.around, task, settings, results,
    )  # fmt: skip
