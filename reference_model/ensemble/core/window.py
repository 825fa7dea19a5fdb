"""The window in which what may be the end state is measured, from one place to the next like it."""

from __future__ import annotations

from typing import NamedTuple

from reference_model.ensemble.core.jit import inlined
from reference_model.ensemble.core.records import Record

NO_WINDOW = 0
"""Kind of a window that measures nothing."""


class Measures(NamedTuple):
    """Of an end state: the least and the largest radius, and the mean slip speed."""

    least: float
    largest: float
    slip: float


class Window(Record):
    """What is measured, since when, the way slipped until then, and the radii so far."""

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
    """Take a radius into the window."""
    window.least, window.largest = min(window.least, radius), max(window.largest, radius)


@inlined
def measured(window: Window, t: float, way: float) -> Measures:
    """Return what the window measures up to the time ``t``."""
    return Measures(window.least, window.largest, (way - window.way) / (t - window.since))
