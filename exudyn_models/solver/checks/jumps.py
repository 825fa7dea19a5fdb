"""Detection of load jumps in an implicit run, by the powers of its energy balance.

Coulomb friction causes no jump of a power, because slip is zero where stick begins or ends. A power that jumps in one
step, but hardly changes in its neighbours, indicates a load jump or motion that the steps do not resolve.
"""

import warnings
from collections.abc import Sequence
from typing import Any

import numpy as np

from exudyn_models.solver.works import works_of
from reference_model.systems import FloatArray

NEIGHBOURS = 2
"""Number of steps on each side to compare a jump with."""

STEEPER = 5.0
"""Smallest ratio of a jump to neighbouring changes, and of their slopes; a smooth curve reaches about 2."""

LEAST = 0.02
"""Smallest reported jump, as a share of the largest power of the run."""


TOGETHER = 4096
"""Number of steps that are checked together."""


class JumpCheck:
    """Checks the powers of a model in an implicit run."""

    def __init__(self, mbs: Any) -> None:
        works = works_of(mbs)
        self.names = works.names if works else []
        self._units = np.array(works.units if works else [])
        self._places = works.places if works else np.empty(0, dtype=int)
        self._times: list[float] = []
        self._rates: list[FloatArray] = []
        self._largest = 0.0
        self._jumps: list[tuple[float, float, int, float]] = []

    def look(self, t: float, rates: FloatArray) -> None:
        """Record all ``rates`` of the model at the time t (s)."""
        self._times.append(t)
        self._rates.append(rates)
        if len(self._times) == TOGETHER:
            self._find()

    def _find(self) -> None:
        times, powers = np.array(self._times), self._units * np.array(self._rates)[:, self._places]
        del self._times[: -2 * NEIGHBOURS - 1], self._rates[: -2 * NEIGHBOURS - 1]
        self._largest = max(self._largest, float(np.abs(powers).max()))
        if len(times) < 2 * NEIGHBOURS + 2:
            return
        changes, spans = (
            np.abs(np.diff(powers, axis=0)),
            np.maximum(np.diff(times), np.spacing(np.abs(times).max()))[:, None],
        )
        middle = slice(NEIGHBOURS, len(changes) - NEIGHBOURS)
        jumps = changes[middle] > LEAST * self._largest
        for measured in (changes, changes / spans):
            for k in range(2 * NEIGHBOURS + 1):
                if k != NEIGHBOURS:
                    jumps &= measured[middle] > STEEPER * measured[k : k + len(jumps)]
        for step, i in np.argwhere(jumps):
            first = step + NEIGHBOURS
            self._jumps.append(
                (float(times[first]), float(times[first + 1]), int(i), float(changes[first, i]))
            )

    def warn(self, changes: Sequence[float] = ()) -> None:
        """Warn about the largest jump, if any, except in steps with ``changes`` of mode, at times in s."""
        if self._times:
            self._find()
        jumps = [
            jump
            for jump in self._jumps
            if jump[3] > LEAST * self._largest and not any(jump[0] <= t <= jump[1] for t in changes)
        ]
        if not jumps:
            return
        start, end, power, size = max(jumps, key=lambda jump: jump[3])
        times = len({jump[0] for jump in jumps})
        warnings.warn(
            f"the power {self.names[power]!r} jumps by {size:.3g} W between t = {start:.9g} s and {end:.9g} s"
            + (f", and powers do so in {times} steps of this run" if times > 1 else "")
            + f": the energy across that step may be wrong by {size * (end - start) / 2.0:.2g} J. If a load jumps "
            "there, pass its time to solve_dynamic, as breaks=[...]; otherwise use shorter steps",
            RuntimeWarning,
            stacklevel=5,
        )
