"""Jumps of a load inside of an implicit run, seen by the powers of its energy balance.

Coulomb friction itself lets no power jump: where a contact comes to stick or leaves it, slip is zero. So a power that
jumps between two steps, while it hardly changes in the steps before and after, tells of a load that does, or of what
the steps don't resolve; either way the step across it is wrong by a share of the jump.
"""

from __future__ import annotations

import warnings
from collections import deque
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from reference_model.systems import FloatArray

_NAMES = "names_of_powers"

NEIGHBOURS = 2
"""Steps before and after a jump that it is compared with."""

STEEPER = 5.0
"""A jump exceeds their changes, and their slopes, by this: twice is usual where a curve bends."""

LEAST = 0.02
"""Of the largest power of the run: less is not told."""


def watch_powers(rates: Callable[..., Any], names: Sequence[str], unit: float = 1.0) -> None:
    """Have jumps looked for in all that ``rates``, a user function of first order, returns: powers in ``unit`` W."""
    setattr(rates, _NAMES, tuple((name, unit) for name in names))


class JumpCheck:
    """Looks at the powers of an assembled model after every step of an implicit run, and warns at its end.

    Parameters
    ----------
    mbs : exudyn MainSystem
        Assembled.

    """

    def __init__(self, mbs: Any) -> None:
        self._names, self._units, self._places = _powers(mbs)
        self._steps: deque[tuple[float, FloatArray]] = deque(maxlen=2 * NEIGHBOURS + 2)
        self._largest = np.zeros(len(self._names))
        self._jumps: list[tuple[float, float, int, float]] = []

    def look(self, t: float, rates: FloatArray) -> None:
        """Take note of all ``rates`` of the model after a step, or at the start, at the time t (s)."""
        if not self._names:
            return
        self._steps.append((t, self._units * np.array(rates)[self._places]))
        self._largest = np.maximum(self._largest, np.abs(self._steps[-1][1]))
        if len(self._steps) < self._steps.maxlen:  # type: ignore[operator]
            return
        times, powers = np.array([time for time, _ in self._steps]), np.array([row for _, row in self._steps])
        changes, spans = np.abs(np.diff(powers, axis=0)), np.diff(times)[:, None]
        if not np.all(spans > 0.0):
            return
        others = np.arange(len(changes)) != NEIGHBOURS
        jumps = np.ones(len(self._names), dtype=bool)
        for measured in (changes, changes / spans):
            jumps &= measured[NEIGHBOURS] > STEEPER * measured[others].max(axis=0)
        for i in np.flatnonzero(jumps & (changes[NEIGHBOURS] > LEAST * self._largest)):
            start, end = times[NEIGHBOURS : NEIGHBOURS + 2]
            self._jumps.append((float(start), float(end), int(i), float(changes[NEIGHBOURS, i])))

    def warn(self) -> None:
        """Warn of the largest jump that has been seen, if there is any."""
        jumps = [jump for jump in self._jumps if jump[3] > LEAST * self._largest[jump[2]]]
        if not jumps:
            return
        start, end, power, size = max(jumps, key=lambda jump: jump[3] / self._largest[jump[2]])
        times = len({jump[0] for jump in jumps})
        warnings.warn(
            f"the power {self._names[power]!r} jumps by {size:.3g} W between t = {start:.9g} s and {end:.9g} s"
            + (f", and powers do so in {times} steps of this run" if times > 1 else "")
            + f": the energy across that step may be wrong by {size * (end - start) / 2.0:.2g} J. If a load jumps "
            "there, give its time to solve_dynamic, as breaks=[...]; if none does, take shorter steps",
            RuntimeWarning,
            stacklevel=4,
        )


def _powers(mbs: Any) -> tuple[list[str], FloatArray, list[int]]:
    """Return names and units (W) of the powers that are watched, and where they are among the rates."""
    found: list[tuple[str, float]] = []
    places: list[int] = []
    objects = mbs.systemData.NumberOfObjects() if mbs.systemData.ODE1Size() else 0
    for item in range(objects):
        rates = mbs.GetObject(item).get("rhsUserFunction")
        own = getattr(rates["function"], _NAMES, ()) if isinstance(rates, dict) else ()
        if own:
            found += own
            places += [int(place) for place in mbs.systemData.GetObjectLTGODE1(item)]
    return [name for name, _ in found], np.array([unit for _, unit in found]), places
