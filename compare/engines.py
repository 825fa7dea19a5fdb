"""Engines: whatever can simulate a system takes part in the comparison."""

from __future__ import annotations

import difflib
import importlib
import os
import sys
from collections.abc import Iterable
from dataclasses import dataclass
from typing import Protocol

from numpy.typing import ArrayLike

from reference_model.systems import PinOnDisc
from reference_model.trajectory import Trajectory


class Simulate(Protocol):
    """The one function that an engine implements.

    ``tolerance`` is the accuracy to aim at: whatever the engine approximates (step, iteration, a smoothed
    friction law) must get better when it gets smaller, because errors are estimated by tightening it.
    """

    def __call__(
        self, system: PinOnDisc, initial_state: ArrayLike, times: ArrayLike, *, tolerance: float = 1e-9
    ) -> Trajectory:
        """Return the motion of ``system`` from ``initial_state`` (at ``times[0]``) at all ``times``."""
        ...


@dataclass(frozen=True)
class Engine:
    """A name and a simulate(); to take part in work on several cores, a function of an importable module."""

    name: str
    simulate: Simulate


_REGISTRY: dict[str, Engine] = {}


def register(engine: Engine) -> Engine:
    """Add ``engine`` to those that every study runs; raise ``ValueError`` if its name is taken."""
    if engine.name in _REGISTRY or engine.name == "theory":
        raise ValueError(f"engine {engine.name!r}: the name is taken")
    _REGISTRY[engine.name] = engine
    return engine


def engines(names: Iterable[str] = ()) -> tuple[Engine, ...]:
    """Return the engines of the given names, or all that are registered.

    A name of the form "module:function" is imported (from the current folder too) and needs no registration.
    Raises ``ValueError`` for a name that is unknown or can't be imported.
    """
    chosen = tuple(
        imported(name) if ":" in name else _REGISTRY[known("engine", name, _REGISTRY)] for name in names
    )
    return chosen or tuple(_REGISTRY.values())


def imported(name: str) -> Engine:
    """Return the engine of "module:function", named so; raise ``ValueError`` if there is none."""
    module_name, _, function_name = name.partition(":")
    if os.getcwd() not in sys.path:  # a console script does not look into the current folder
        sys.path.insert(0, os.getcwd())
    try:
        simulate = getattr(importlib.import_module(module_name), function_name)
    except (ImportError, AttributeError, ValueError) as error:
        raise ValueError(f"engine {name!r} can't be imported: {error}") from None
    if not callable(simulate):
        raise ValueError(f"engine {name!r} is no function")
    return Engine(name, simulate)


def known(kind: str, name: str, names: Iterable[str]) -> str:
    """Return ``name`` if it is among ``names``; raise ``ValueError`` that suggests the nearest otherwise."""
    names = list(names)
    if name in names:
        return name
    nearest = difflib.get_close_matches(name, names, n=1, cutoff=0.4)
    hint = f"did you mean {nearest[0]!r}?" if nearest else f"known are {', '.join(names)}"
    raise ValueError(f"unknown {kind} {name!r}: {hint}")


# The two packages are imported when they are used: the command line must start without SciPy and Exudyn.
def _simulate_reference(
    system: PinOnDisc, initial_state: ArrayLike, times: ArrayLike, *, tolerance: float = 1e-9
) -> Trajectory:
    import reference_model

    return reference_model.simulate(system, initial_state, times, tolerance=tolerance)


def _simulate_exudyn(
    system: PinOnDisc, initial_state: ArrayLike, times: ArrayLike, *, tolerance: float = 1e-9
) -> Trajectory:
    import exudyn_models

    return exudyn_models.simulate(system, initial_state, times, tolerance=tolerance)


reference = register(Engine("reference", _simulate_reference))
exudyn = register(Engine("exudyn", _simulate_exudyn))
