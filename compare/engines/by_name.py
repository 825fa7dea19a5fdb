"""Names that a user types, and functions that are known by the name of their module."""

from __future__ import annotations

import difflib
import importlib
import sys
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import Any

from reference_model.trajectory import Trajectory


@dataclass(frozen=True)
class ByName:
    """Calls a function of a module that is imported then: the command line must start without SciPy and Exudyn.

    The module is looked for in ``folder``, if there is one, after all other places.
    """

    module: str
    function: str
    folder: str = ""

    def __call__(self, *arguments: Any, **options: Any) -> Trajectory:
        """Call it."""
        trajectory: Trajectory = self.imported(*arguments, **options)
        return trajectory

    @property
    def simulate_many(self) -> Callable[..., Any] | None:
        """What the function has under this name, if anything, see ``compare.engines.engine.SimulateMany``."""
        return getattr(self.imported, "simulate_many", None)

    @property
    def imported(self) -> Callable[..., Any]:
        """The function itself."""
        if self.folder and self.folder not in sys.path:
            # last, or a file of the user's would take the place of a library's module
            sys.path.append(self.folder)
        function: Callable[..., Any] = getattr(importlib.import_module(self.module), self.function)
        return function


def one_of(kind: str, name: str, names: Iterable[str]) -> str:
    """Return ``name`` if it is among ``names``; raise ``ValueError`` that suggests the nearest otherwise."""
    names = list(names)
    if name in names:
        return name
    nearest = difflib.get_close_matches(name, names, n=1, cutoff=0.4)
    hint = f"did you mean {nearest[0]!r}?" if nearest else f"known are {', '.join(names)}"
    raise ValueError(f"unknown {kind} {name!r}: {hint}")
