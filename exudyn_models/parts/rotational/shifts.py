"""Shift sequences of clutches and brakes."""

from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from reference_model.systems import finite_number, positive_number, shown


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
    times = [finite_number("shifts", time) for time, _ in shifts]
    if any(later - time < duration for time, later in pairwise(times)):
        raise ValueError(
            f"shifts = {shown(shifts)}: each must begin at least {duration:g} s after the previous one"
        )
    used = [start, *(gear for _, gear in shifts)]
    for known, names in ((gears, used), (full_loads, [name for gear in gears.values() for name in gear])):
        if unknown := [name for name in names if name not in known]:
            raise ValueError(f"{unknown[0]!r} is not one of {', '.join(map(repr, known))}")
    edges = [edge for time in times for edge in (time, time + duration)]

    def load_of(name: str) -> Callable[[float], float]:
        levels = [full_loads[name] if name in gears[gear] else 0.0 for gear in used]
        values = [level for level in levels for _ in range(2)][1:-1]
        return lambda time: float(np.interp(time, edges, values)) if edges else levels[0]

    return ShiftSequence({name: load_of(name) for name in full_loads}, edges)
