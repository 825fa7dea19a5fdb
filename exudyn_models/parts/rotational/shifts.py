"""Shift sequences of clutches and brakes."""

from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from reference_model.systems import (
    checked_parameter,
    finite_number,
    positive_number,
    require_choice,
    require_kind,
    shown,
)


@dataclass(frozen=True)
class ShiftSequence:
    """Loads of shift elements in N as functions of time, by name, and the ``breaks`` of these functions in s."""

    loads: dict[str, Callable[[float], float]]
    breaks: list[float]


def shift_sequence(
    full_loads: Mapping[str, float],
    gears: Mapping[str, Collection[str]],
    *,
    start: str,
    shifts: Sequence[tuple[float, str]],
    duration: float,
) -> ShiftSequence:
    """Return the loads of clutches and brakes that change gears, for ``normal_load`` of ``add_ring_friction``.

    Parameters
    ----------
    full_loads : mapping of float
        Load in N of each element while it is closed, by its name.
    gears : mapping of collections
        Names of the closed elements of each gear; an empty collection is neutral.
    start : str
        First gear.
    shifts : sequence of (float, str)
        Times in s when a shift begins, and the new gear.
    duration : float
        Time in s > 0 within which loads rise or fall linearly.

    Raises
    ------
    ValueError
        If a gear or an element has no entry, or a shift begins before the previous one ends.

    """
    duration = positive_number("duration", duration, "s")
    require_kind("full_loads", full_loads, Mapping)
    require_kind("gears", gears, Mapping)
    try:
        times = [finite_number("shifts", time) for time, _ in shifts]
    except (TypeError, ValueError):
        raise ValueError(f"shifts = {shown(shifts)}: it must be a list of (time in s, gear)") from None
    if any(later - time < duration for time, later in pairwise(times)):
        raise ValueError(
            f"shifts = {shown(shifts)}: each must begin at least {duration:g} s after the previous one"
        )
    used = [start, *(gear for _, gear in shifts)]
    require_choice("start", start, gears)
    for gear in used[1:]:
        require_choice("shifts", gear, gears)
    for gear, closed in gears.items():
        require_kind(f"gears[{gear!r}]", closed, Collection)
        for name in closed:
            require_choice(f"gears[{gear!r}]", name, full_loads)
    for name, load in full_loads.items():
        checked_parameter(f"full_loads[{name!r}]", load, "N", 0.0)
    edges = [edge for time in times for edge in (time, time + duration)]

    def load_of(name: str) -> Callable[[float], float]:
        levels = [full_loads[name] if name in gears[gear] else 0.0 for gear in used]
        values = [level for level in levels for _ in range(2)][1:-1]
        return lambda time: float(np.interp(time, edges, values)) if edges else levels[0]

    return ShiftSequence({name: load_of(name) for name in full_loads}, edges)
