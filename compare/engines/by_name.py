"""A function that is known by its name, of a module that is imported when it is called, here or elsewhere."""

from __future__ import annotations

import importlib
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from reference_model.trajectory import Trajectory


@dataclass(frozen=True)
class ByName:
    """Calls a function of a module that is imported then: the command line must start without SciPy and Exudyn."""

    module: str
    function: str

    def __call__(self, *arguments: Any, **options: Any) -> Trajectory:
        """Call it."""
        trajectory: Trajectory = self._function(*arguments, **options)
        return trajectory

    @property
    def simulate_many(self) -> Callable[..., Any] | None:
        """What the function has under this name, if anything, see ``compare.engines.engine.SimulateMany``."""
        return getattr(self._function, "simulate_many", None)

    @property
    def _function(self) -> Callable[..., Any]:
        function: Callable[..., Any] = getattr(importlib.import_module(self.module), self.function)
        return function
