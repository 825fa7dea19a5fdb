"""The kernel of pins."""

import math
from collections.abc import Callable

import numpy as np

from reference_model.ensemble.core.by_core import USUAL_SPAN, core_for_kernels, with_core
from reference_model.ensemble.core.jit import called_from_python, inlined, scalar, written_out
from reference_model.ensemble.core.lanes import row_of, run, store_end
from reference_model.ensemble.core.laws import ROUNDING_OF_SLIP, STRETCHING_TIME, PinLaw, pull, units
from reference_model.ensemble.core.records import LANES, clear, layout, put
from reference_model.ensemble.end_states import SELF_CENTRED, Results
from reference_model.ensemble.pin.end_states import FORM_SIZE, equilibrium_region
from reference_model.ensemble.pin.events import handle_flag, rest
from reference_model.ensemble.pin.lanes import (
    LANDING,
    MANY,
    STEPS_A_TIME,
    STEPS_TO_SPARE,
    TURNS,
    UNWATCHED,
    PinLanes,
    PinMemory,
    Settings,
    advance,
    advance_alone,
    keep,
    law_of,
    position_at,
    put_slipping,
    put_state,
    slip_at,
)
from reference_model.ensemble.task import Task
from reference_model.systems import PinOnDisc
from reference_model.trajectory import MOST_AHEAD

LANES_LAYOUT, MEMORY_LAYOUT = layout(PinLanes), layout(PinMemory)

SLOWNESS = 1e-3
"""Slip speed, in units of g, below which a pin that friction does not stop starts with steps of the core."""

TICK_TURNS = 4.0
"""Number of free periods without a crossing before a check."""

LAST_TICKS = 4.0
"""Number of final ticks watched in a motion without early end."""


@written_out
def load(lanes: PinLanes, memory: PinMemory, lane: int, number: int, task: Task, settings: Settings) -> bool:
    mass, stiffness, damping, force, omega, offset = row_of(task.parameters, number)
    x, y, vx, vy = row_of(task.starts, number)
    duration = float(row_of(task.durations, number))
    k2, c, g = stiffness / mass, damping / mass, force / mass
    length, rate = units(math.sqrt(k2), c, g, omega, offset, math.hypot(x, y), math.hypot(vx, vy))
    speed = length * rate

    clear(memory)
    memory.number, memory.length, memory.rate, memory.duration = number, length, rate, duration * rate
    memory.span = USUAL_SPAN
    friction = g / (speed * rate)
    law = PinLaw(
        k2 / rate**2,
        c / rate,
        friction,
        omega / rate,
        offset / length,
        STRETCHING_TIME * friction if g > 0.0 else 1.0,
        0.0 if g > 0.0 else 1.0,
    )
    put(lanes.law, lane, law)
    lanes.tolerance[lane] = settings.tolerance
    lanes.slow[lane] = 10.0 * friction * math.sqrt(settings.tolerance)
    lanes.steps[lane] = lanes.flag[lane] = 0.0
    lanes.most_steps[lane] = min(STEPS_TO_SPARE + STEPS_A_TIME * memory.duration, MOST_AHEAD)

    expect_ends(memory, law, settings)
    _start_watching(lanes, memory, lane, settings)
    lanes.trial.state.time[lane] = lanes.trial.state.way[lane] = 0.0
    z = complex(x, y) / length
    w = complex(vx + omega * y, vy - omega * x) / speed
    if abs(w) <= ROUNDING_OF_SLIP * abs(law.disc_speed * z):
        w = 0j
    if w == 0j and friction > 0.0:
        return rest(lanes, memory, lane, z, 0.0, law, settings, False)
    put_slipping(lanes, lane, z, w, law)
    if abs(w) < SLOWNESS * friction < SLOWNESS * abs(pull(z, w, law)):
        lanes.short[lane] = MANY
    if memory.level == math.inf:
        memory.end = SELF_CENTRED
        keep(memory, 0.0, 0.0, 0.0)
        return settings.early
    return bool(duration <= 0.0)


@inlined
def _start_watching(lanes: PinLanes, memory: PinMemory, lane: int, settings: Settings) -> None:
    begin_watching = settings.early or settings.once or memory.duration <= LAST_TICKS * memory.tick
    lanes.watch[lane] = TURNS if begin_watching and lanes.law.friction[lane] > 0.0 else UNWATCHED
    if begin_watching:
        lanes.due[lane] = min(memory.tick, memory.duration - LANDING)
    else:
        lanes.due[lane] = memory.duration - LAST_TICKS * memory.tick


@inlined
def expect_ends(memory: PinMemory, law: PinLaw, settings: Settings) -> None:
    well, regions = equilibrium_region(law), settings.regions
    memory.equilibrium, memory.level = well.place, well.level
    if regions.level > 0.0:
        memory.level = regions.level / memory.length**2
    for i in range(FORM_SIZE):
        memory.form[i] = regions.form[i] if regions.level > 0.0 else well.form[i]
    memory.tick = TICK_TURNS * 2.0 * math.pi / math.sqrt(law.stiffness) if law.stiffness > 0.0 else math.inf


@scalar
def store(lanes: PinLanes, memory: PinMemory, lane: int, results: Results) -> None:
    z, w = position_at(lanes.trial, lane), slip_at(lanes.trial, lane)
    put_state(results.states[memory.number], memory, z, w, law_of(lanes, lane))
    store_end(lanes, memory, lane, results)


@called_from_python
def run_pins(
    task: Task, settings: Settings, core: Callable[..., None], results: Results, first: int, last: int
) -> None:
    inside = Settings(
        settings.tolerance,
        settings.early,
        settings.once,
        settings.regions,
        settings.series,
        with_core(settings.room, core),
    )
    _run_pins(task, inside, results, first, last)


@inlined
def _run_pins(task: Task, settings: Settings, results: Results, first: int, last: int) -> None:
    """Run the trajectories in a separate function, which compiles a fifth longer but runs a sixth faster."""
    run(
        load, advance, advance_alone, handle_flag, store,
        np.zeros(1, LANES_LAYOUT), np.zeros(LANES, MEMORY_LAYOUT), first, last, None, task, settings, results,
    )  # fmt: skip


def results_of(task: Task, settings: Settings) -> Results:
    results = Results.empty(task.size, PinOnDisc.state_size)
    run_pins(task, settings, core_for_kernels(), results, 0, task.size)
    return results
