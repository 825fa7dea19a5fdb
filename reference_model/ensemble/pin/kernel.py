"""An ensemble of pins: how a lane is loaded and stored, and all of them run."""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np

from reference_model.ensemble.checkpoints import EVERY, SLIPS
from reference_model.ensemble.core.jit import inlined, outermost, scalar
from reference_model.ensemble.core.lanes import LANES, run
from reference_model.ensemble.core.laws import PinLaw, pull
from reference_model.ensemble.core.nondimensional import ROUNDING, units
from reference_model.ensemble.end_states import Results
from reference_model.ensemble.pin.end_states import well_of
from reference_model.ensemble.pin.events import SELF_CENTRED, UNDECIDED, Aims, attend, rest
from reference_model.ensemble.pin.lanes import (
    DUE,
    FLAG,
    LANDING,
    MANY,
    MOST_STEPS,
    SHORT,
    SLOTS,
    SLOW,
    STEPS,
    STEPS_A_TIME,
    STEPS_TO_SPARE,
    STIFFNESS,
    TIME,
    TOLERANCE,
    TRIAL,
    TURNS,
    UNWATCHED,
    WATCH,
    WAY,
    advance,
    advance_alone,
    idle,
    law_of,
    place_of,
    put_slipping,
    slip_of,
)
from reference_model.ensemble.pin.memory import (
    DURATION,
    END,
    FORM,
    FORM_SIZE,
    FOUND_LEAST,
    ITEMS,
    KNOWN_FORM,
    KNOWN_LEVEL,
    LENGTH,
    LEVEL,
    NOTED,
    NUMBER,
    RATE,
    TICK,
    WELL_X,
    WELL_Y,
    keep,
    note,
    put_state,
    takes_notes,
)
from reference_model.ensemble.pin.slip import MOST_TERMS
from reference_model.systems import FloatArray

STRETCHING_TIME = 0.5
"""s₀ over g, in units of time: measured, more makes steps shorter, less makes rest and release stiffer."""

SLOWNESS = 1e-3
"""Slip speed, in units of g, below which a pin that friction does not bring to rest starts with implicit steps."""

TICK_TURNS = 4.0
"""Free periods after which a motion that is never rightmost is looked at nevertheless."""

LAST_TICKS = 4.0
"""So many ticks before its end a motion that is not to be ended early begins to be watched."""


PARAMETERS = ("mass", "stiffness", "damping", "friction_force", "disc_speed", "offset")
"""Of a pin, in the order in which the kernel takes them."""


class PinTask(NamedTuple):
    """What is to be done.

    ``parameters`` are (1 or n, 6), in the order of PARAMETERS; ``starts`` (1 or n, 4), ``durations`` in s (1 or n,).
    """

    parameters: FloatArray
    starts: FloatArray
    durations: FloatArray


@scalar
def load(scratch: Any, book: Any, lane: int, number: int, task: PinTask, aims: Aims) -> bool:
    """Put the start of a trajectory into the slots of the trial."""
    row = task.parameters[number if task.parameters.shape[0] > 1 else 0]
    mass, omega, offset = row[0], row[4], row[5]
    k2, c, g = row[1] / mass, row[2] / mass, row[3] / mass
    x, y, vx, vy = task.starts[number if task.starts.shape[0] > 1 else 0]
    duration = task.durations[number if task.durations.shape[0] > 1 else 0]
    length, rate = units(math.sqrt(k2), c, g, omega, offset, math.hypot(x, y), math.hypot(vx, vy))
    speed = length * rate

    page = book[lane]
    page[:] = 0.0
    page[NUMBER], page[LENGTH], page[RATE], page[DURATION] = number, length, rate, duration * rate
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
    for i in range(7):
        scratch[(STIFFNESS + i) * LANES + lane] = law[i]
    scratch[TOLERANCE * LANES + lane] = aims.tolerance
    scratch[SLOW * LANES + lane] = 10.0 * friction * math.sqrt(aims.tolerance)
    scratch[STEPS * LANES + lane] = 0.0
    scratch[MOST_STEPS * LANES + lane] = STEPS_TO_SPARE + STEPS_A_TIME * page[DURATION]
    scratch[FLAG * LANES + lane] = 0.0

    well = well_of(law)
    known = aims.known
    page[WELL_X], page[WELL_Y], page[LEVEL] = well.place.real, well.place.imag, well.level
    for i in range(FORM_SIZE):
        page[FORM + i] = well.form[i]
    if known[KNOWN_LEVEL] > 0.0:
        page[LEVEL] = known[KNOWN_LEVEL] / length**2
        for i in range(FORM_SIZE):
            page[FORM + i] = known[KNOWN_FORM + i]
    page[TICK] = TICK_TURNS * 2.0 * math.pi / math.sqrt(law.stiffness) if law.stiffness > 0.0 else math.inf
    noted = takes_notes(page)
    if noted:
        page[TICK], page[NOTED] = EVERY, ITEMS
    begin_watching = noted or aims.early or aims.once or page[DURATION] <= LAST_TICKS * page[TICK]
    scratch[WATCH * LANES + lane] = TURNS if begin_watching and friction > 0.0 else UNWATCHED
    if begin_watching:
        scratch[DUE * LANES + lane] = min(page[TICK], page[DURATION] - LANDING)
    else:
        scratch[DUE * LANES + lane] = page[DURATION] - LAST_TICKS * page[TICK]

    scratch[(TRIAL + TIME) * LANES + lane] = 0.0
    scratch[(TRIAL + WAY) * LANES + lane] = 0.0
    z = complex(x, y) / length
    w = complex(vx + omega * y, vy - omega * x) / speed
    if abs(w) <= ROUNDING * abs(law.disc_speed * z):
        w = 0j
    if noted:
        note(page, SLIPS, 0.0, z, w, law)
    if w == 0j and friction > 0.0:
        return rest(scratch, page, lane, z, 0.0, law, aims, False)
    put_slipping(scratch, lane, z, w, law)
    if abs(w) < SLOWNESS * friction < SLOWNESS * abs(pull(z, w, law)):
        scratch[SHORT * LANES + lane] = MANY
    if page[LEVEL] == math.inf:
        page[END] = SELF_CENTRED
        keep(page, 0.0, 0.0, 0.0)
        return aims.early
    return bool(duration <= 0.0)


@scalar
def store(scratch: Any, book: Any, lane: int, results: Results) -> None:
    """Write down the result of a lane in SI units."""
    page = book[lane]
    number, length, rate = int(page[NUMBER]), page[LENGTH], page[RATE]
    z, w = place_of(scratch, lane, TRIAL), slip_of(scratch, lane, TRIAL)
    put_state(results.states[number], page, z, w, law_of(scratch, lane))
    results.times[number] = scratch[(TRIAL + TIME) * LANES + lane] / rate
    results.ends[number] = int(page[END])
    results.steps[number] = int(scratch[STEPS * LANES + lane])
    if takes_notes(page):
        results.notes[:] = page[ITEMS:]
    for i in range(3):
        measure = page[FOUND_LEAST + i] * length if page[END] != UNDECIDED else math.nan
        results.measures[number, i] = measure * rate if i == 2 else measure


@outermost
def run_pins(
    task: PinTask,
    tolerance: float,
    early: bool,
    once: bool,
    known: FloatArray,
    results: Results,
    first: int,
    last: int,
) -> None:
    """Run the trajectories ``first`` to ``last`` (excluded); the others are the items of :class:`Aims`."""
    aims = Aims(tolerance, early, once, known, np.zeros((6, MOST_TERMS + 2), dtype=np.complex128))
    _run_with(task, aims, results, first, last)


@inlined
def _run_with(task: PinTask, aims: Aims, results: Results, first: int, last: int) -> None:
    """Do so; in a function of its own, which costs time to compile, the rounds of pins are a tenth faster."""
    run(
        load, advance, advance_alone, attend, store, idle, SLOTS, TRIAL, ITEMS + results.notes.size, FLAG,
        first, last, None, task, aims, results,
    )  # fmt: skip
