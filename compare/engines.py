"""Engines: whatever can simulate a system takes part in the comparison, with the systems that it promises.

A study of a single system just calls ``engine.simulate``: where the engine never promised that system, the report
says "not simulated" in place of its claims, which is neither a pass nor a failure. A study of several systems
measures those that the engine simulates and hands on what is missing::

    mine = [disc for disc in discs if engine.simulates(disc)]
    return Findings(claims_of(mine), data_of(mine), not_simulated=engine.lacking(discs))
"""

from __future__ import annotations

import difflib
import importlib
import os
import sys
from collections.abc import Iterable
from dataclasses import dataclass
from typing import Protocol

from numpy.typing import ArrayLike

from reference_model.systems import PinOnDisc, System
from reference_model.trajectory import Trajectory

KINDS = {"pin": "a pin", "points": "a disc on single points", "ring": "a disc on a continuous ring"}
"""The kinds of systems that an engine may promise, and what they are in words."""

EVERY_KIND = tuple(KINDS)


class Simulate(Protocol):
    """The one function that an engine implements.

    ``tolerance`` is the accuracy to aim at: whatever the engine approximates (step, iteration, a smoothed
    friction law) must get better when it gets smaller, because errors are estimated by tightening it.
    """

    def __call__(
        self, system: System, initial_state: ArrayLike, times: ArrayLike, *, tolerance: float = 1e-9
    ) -> Trajectory:
        """Return the motion of ``system`` from ``initial_state`` (at ``times[0]``) at all ``times``."""
        ...


class UnsupportedSystemError(ValueError):
    """An engine was asked for a system that it never promised to simulate; the message says which."""


@dataclass(frozen=True)
class Engine:
    """A name, a simulate() and the systems that it is for.

    Parameters
    ----------
    name : str
        As on the command line.
    function : callable
        The engine's ``simulate``; to take part in work on several cores, a function of an importable module.
    kinds : tuple of str
        What ``function`` promises to simulate: "pin", "points" (a disc on single points), "ring" (a disc on the
        continuous ring).

    Raises
    ------
    ValueError
        For a kind that there is not.

    """

    name: str
    function: Simulate
    kinds: tuple[str, ...] = ("pin",)

    def __post_init__(self) -> None:
        """Refuse a promise that no study could ask for."""
        for kind in self.kinds:
            known("kind of system", kind, KINDS)

    def simulate(
        self, system: System, initial_state: ArrayLike, times: ArrayLike, *, tolerance: float = 1e-9
    ) -> Trajectory:
        """Do as ``function``; raise ``UnsupportedSystemError`` for a system that it does not promise."""
        if not self.simulates(system):
            raise UnsupportedSystemError(self.lacking([system]))
        return self.function(system, initial_state, times, tolerance=tolerance)

    def simulates(self, system: System) -> bool:
        """Return whether the engine promises to simulate ``system``."""
        return _kind(system) in self.kinds

    def lacking(self, systems: Iterable[System]) -> str:
        """Return in a sentence what of ``systems`` the engine does not simulate, "" if it simulates all."""
        kinds = dict.fromkeys(_kind(system) for system in systems)
        words = [KINDS[kind] for kind in kinds if kind not in self.kinds]
        return f"{self.name} does not simulate {' or '.join(words)}" if words else ""


def _kind(system: System) -> str:
    if isinstance(system, PinOnDisc):
        return "pin"
    return "ring" if system.contact_points is None else "points"


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
    """Return the engine of "module:function", named so; raise ``ValueError`` if there is none.

    It is taken for an engine of the pin only, unless the function has an attribute ``kinds`` that says more::

        simulate.kinds = ("pin", "points", "ring")
    """
    module_name, _, function_name = name.partition(":")
    if os.getcwd() not in sys.path:  # a console script does not look into the current folder
        sys.path.insert(0, os.getcwd())
    try:
        simulate = getattr(importlib.import_module(module_name), function_name)
    except Exception as error:  # whatever a module may do when it is imported
        kind = "" if isinstance(error, ImportError | AttributeError) else f"{type(error).__name__}: "
        raise ValueError(f"engine {name!r} can't be imported: {kind}{error}") from None
    if not callable(simulate):
        raise ValueError(f"engine {name!r} is no function")
    kinds = getattr(simulate, "kinds", ("pin",))
    try:
        return Engine(name, simulate, tuple(kinds))
    except (TypeError, ValueError) as error:
        raise ValueError(f"engine {name!r}, attribute kinds = {kinds!r}: {error}") from None


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
    system: System, initial_state: ArrayLike, times: ArrayLike, *, tolerance: float = 1e-9
) -> Trajectory:
    import reference_model

    return reference_model.simulate(system, initial_state, times, tolerance=tolerance)


def _simulate_exudyn(
    system: System, initial_state: ArrayLike, times: ArrayLike, *, tolerance: float = 1e-9
) -> Trajectory:
    import exudyn_models

    return exudyn_models.simulate(system, initial_state, times, tolerance=tolerance)


def _simulate_exudyn_native(
    system: System, initial_state: ArrayLike, times: ArrayLike, *, tolerance: float = 1e-9
) -> Trajectory:
    from exudyn_models.native_contact import simulate_with_native_contact

    return simulate_with_native_contact(system, initial_state, times, tolerance=tolerance)


reference = register(Engine("reference", _simulate_reference, EVERY_KIND))
exudyn = register(Engine("exudyn", _simulate_exudyn, EVERY_KIND))
exudyn_native = register(Engine("exudyn-native", _simulate_exudyn_native, ("pin", "points")))
