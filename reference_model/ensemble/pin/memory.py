"""What scalar code keeps of each lane of pins: a page of the book, and the window that measures an end state."""

from __future__ import annotations

from typing import Any

from reference_model.ensemble.checkpoints import KIND, STATE, TIME
from reference_model.ensemble.core.jit import inlined, scalar
from reference_model.ensemble.core.laws import PinLaw

FORM_SIZE = 10
"""Coefficients of the form V, upper half."""

KNOWN_LEVEL, KNOWN_FORM, KNOWN_REACH, KNOWN_TURN, KNOWN_METRIC, KNOWN_LEAST, KNOWN_LARGEST, KNOWN_SLIP, KNOWN = (
    0, 1, 11, 12, 15, 21, 22, 23, 24,
)  # fmt: skip
"""Places in what is known beforehand, if the parameters are the same for all: level in m² and form of the
equilibrium's neighbourhood; that of the whirl in m², where it crosses the section (x, y, ẏ/k in m) and the form
there, upper half; its radii in m and mean slip speed in m/s. Level or reach are 0 where nothing is known."""

(
    NUMBER, LENGTH, RATE, DURATION, END, WELL_X, WELL_Y, LEVEL, FORM, TICK,
    TURN_X, TURN_Y, TURN_V, TURN_LAST, TURN_BEFORE, TURN_COUNT,
    RELEASE, RELEASE_LAST, RELEASE_BEFORE, RELEASE_COUNT, MEASURED,
    SINCE, WAY_BEFORE, LEAST, LARGEST, FOUND_LEAST, FOUND_LARGEST, FOUND_SLIP, SPAN, NOTED, ITEMS,
) = (*range(9), *range(8 + FORM_SIZE, 30 + FORM_SIZE))  # fmt: skip
"""Items of a page of the book: number, unit of length, duration in units and end state so far; the equilibrium and
when to look next; the last crossing and the distances of the last three; the same of releases; what the window is
from which the measures of the end state are taken: since when, from which way on, radii so far; what was found; how
long an implicit step may be; and where the next note goes."""

NO_WINDOW, OF_TURN, OF_RELEASE = 0.0, 1.0, 2.0
"""What is MEASURED: nothing yet, a turn from crossing to crossing, or a cycle from release to release."""


@inlined
def keep(page: Any, least: float, largest: float, slip: float) -> None:
    """Keep the measures of the end state: radii and mean slip speed."""
    page[FOUND_LEAST], page[FOUND_LARGEST], page[FOUND_SLIP] = least, largest, slip


@inlined
def note_radius(page: Any, radius: float) -> None:
    """Take a radius into the window."""
    page[LEAST], page[LARGEST] = min(page[LEAST], radius), max(page[LARGEST], radius)


@inlined
def open_window(page: Any, kind: float, t: float, way: float, radius: float) -> None:
    """Begin to take the measures of what may be the end state."""
    page[MEASURED], page[SINCE], page[WAY_BEFORE] = kind, t, way
    page[LEAST], page[LARGEST] = radius, radius


@scalar
def close_window(page: Any, end: int, t: float, way: float, radius: float) -> None:
    """Take the end state as found, with its measures."""
    note_radius(page, radius)
    keep(page, page[LEAST], page[LARGEST], (way - page[WAY_BEFORE]) / (t - page[SINCE]))
    page[END], page[MEASURED] = end, NO_WINDOW


@inlined
def takes_notes(page: Any) -> bool:
    """Tell whether there is room for notes, see :mod:`notes`: behind the other items."""
    return bool(page.shape[0] > ITEMS)


@scalar
def note(page: Any, kind: float, t: float, z: complex, w: complex, law: PinLaw) -> None:
    """Take a note of where a trajectory is, while there is room."""
    place = int(page[NOTED])
    if place < page.shape[0]:
        page[NOTED] += STATE + 4.0
        page[place + KIND], page[place + TIME] = kind, t / page[RATE]
        put_state(page[place + STATE :], page, z, w, law)


@scalar
def put_state(state: Any, page: Any, z: complex, w: complex, law: PinLaw) -> None:
    """Put x, y, vx, vy into ``state`` (4,), in SI units."""
    length, rate = page[LENGTH], page[RATE]
    state[0], state[1] = z.real * length, z.imag * length
    state[2] = (w.real - law.disc_speed * z.imag) * length * rate
    state[3] = (w.imag + law.disc_speed * z.real) * length * rate
