"""The window for measuring a possible end state, from one crossing to the next."""

from __future__ import annotations

from typing import NamedTuple

from reference_model.ensemble.core.jit import inlined
from reference_model.ensemble.core.records import Record

NO_WINDOW = 0
"""Kind of a window that measures nothing."""


class Measures(NamedTuple):
    """Measures of an end state: smallest and largest radius, and mean slip speed."""

    least: float
    largest: float
    slip: float


class Window(Record):
    """Kind of the measurement, its start, the slip distance at the start, and the range of the radius so far."""

    kind: int
    since: float
    way: float
    least: float
    largest: float


@inlined
def open_window(window: Window, kind: int, t: float, way: float, radius: float) -> None:
    """Begin to measure."""
    window.kind, window.since, window.way = kind, t, way
    window.least, window.largest = radius, radius


@inlined
def see_radius(window: Window, radius: float) -> None:
    """Include a radius in the window."""
    window.least, window.largest = min(window.least, radius), max(window.largest, radius)


@inlined
def measured(window: Window, t: float, way: float) -> Measures:
    """Return the measures of the window up to the time ``t``."""
    return Measures(window.least, window.largest, (way - window.way) / (t - window.since))
