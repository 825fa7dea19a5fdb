"""Convergence of successive values of a motion, and the motion between them."""

import math
from typing import Annotated, NamedTuple

from reference_model.ensemble.core.jit import inlined, scalar
from reference_model.ensemble.core.records import Record
from reference_model.ensemble.core.stepping.runge_kutta import Tuple
from reference_model.systems import FloatArray

ACCURACY = 1e-4
"""Relative distance that may remain when a motion counts as converged."""

STILL = 1e-2
"""Distance between crossings that is only noise, as a fraction of the distance that ACCURACY allows."""

NO_WINDOW = 0
"""Kind of a window that measures nothing."""


class Series(Record):
    """The last values, the last two distances between values, and their number."""

    values: Annotated[FloatArray, 5]
    last: float
    before: float
    count: int


class Measures(NamedTuple):
    """Smallest and largest radius, and mean slip speed in an end state."""

    least: float
    largest: float
    slip: float


class Window(Record):
    """Kind and start of the measurement, the slip distance there, and the range of the radius so far."""

    kind: int
    since: float
    way: float
    least: float
    largest: float


@scalar
def compared(series: Series, values: Tuple, scale: float) -> bool:
    """Compare with earlier values; return whether less than ACCURACY·scale remains to converge."""
    square = 0.0
    for i in range(5):
        square += (values[i] - series.values[i]) ** 2
        series.values[i] = values[i]
    distance, before, first = math.sqrt(square), series.last, series.before
    series.last, series.before = distance, before
    series.count += 1
    return series.count >= 5 and converged(distance, before, first, scale)


@scalar
def converged(last: float, before: float, first: float, scale: float) -> bool:
    """Return whether three successive distances imply that less than ACCURACY·scale remains."""
    allowed = ACCURACY * scale
    if max(last, before, first) < STILL * allowed and not last > before > first:
        return True  # near a saddle they are small too, but grow
    ratio = max(last / before, before / first) if before > 0.0 and first > 0.0 else 1.0
    return ratio < 1.0 and last * ratio < allowed * (1.0 - ratio)


@inlined
def open_window(window: Window, kind: int, t: float, way: float, radius: float) -> None:
    window.kind, window.since, window.way = kind, t, way
    window.least, window.largest = radius, radius


@inlined
def see_radius(window: Window, radius: float) -> None:
    window.least, window.largest = min(window.least, radius), max(window.largest, radius)


@inlined
def measured(window: Window, t: float, way: float) -> Measures:
    return Measures(window.least, window.largest, (way - window.way) / (t - window.since))
