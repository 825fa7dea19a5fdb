"""Rows of sensors at multiples of their period, in a run of many parts."""

import math
from typing import Any

ON_GRID = 1e-9
"""Tolerance of multiples of a step, as a share of it."""


class SensorRows:
    """Switches the rows of sensors on for the steps that need one; each part of a run would restart the period."""

    def __init__(self, settings: Any, start: float, step: float) -> None:
        self._settings, self._next, self._step = settings, start, step
        self._wanted, self._period = settings.active, settings.writePeriod
        settings.writePeriod = 0.0

    def switch(self, on: bool) -> None:
        """Switch rows on or off from the next step on, if the user wants any."""
        self._settings.active = self._wanted and on

    def is_due(self, t: float) -> bool:
        """Return whether a row is due at the time t (s); if so, advance to the next one."""
        if t < self._next - ON_GRID * self._step:
            return False
        period = max(self._period, self._step)
        self._next += period * (1 + math.floor((t - self._next) / period + ON_GRID))
        return True

    def restore(self) -> None:
        """Restore the settings."""
        self._settings.active, self._settings.writePeriod = self._wanted, self._period
