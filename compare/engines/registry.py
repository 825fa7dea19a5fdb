"""Engines by name: this project's, those of installed packages, and functions of modules."""

from __future__ import annotations

import functools
import importlib
import os
import sys
from collections import Counter
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, replace
from importlib.metadata import entry_points
from typing import Any, NamedTuple

from compare.engines.engine import EVERY_KIND, Engine
from compare.output.outside_text import one_of
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


ENTRY_POINTS = "friction_discs.engines"
"""The group of entry points in which an installed package names its engines: ``mine = "package.module:simulate"``."""

DECLARED = ("kinds", "sticks", "nonlinear", "phases", "precision", "step", "order", "version")
"""Attributes of a function that say what it is for, named like the parameters of ``Engine``."""

_REGISTRY: dict[str, Engine] = {}
_ON_REQUEST: set[str] = set()


class Scheme(NamedTuple):
    """What names of the form "scheme:REST" mean: the engine of REST, and a quick check of it.

    Both raise ``ValueError`` for a REST that is none. One that may stand ``alone`` is asked for "" then.
    """

    engine: Callable[[str], Engine]
    check: Callable[[str], object]
    alone: bool = False


_SCHEMES: dict[str, Scheme] = {}


def register_scheme(name: str, scheme: Scheme) -> None:
    """Let engines be named "name:REST"."""
    _SCHEMES[name] = scheme


def register(engine: Engine, *, on_request: bool = False) -> Engine:
    """Add ``engine`` to those that every study runs, or that are only run where they are named.

    Raises ``ValueError`` if its name is taken.
    """
    if engine.name in _REGISTRY or engine.name == "theory":
        raise ValueError(f"engine {engine.name!r}: the name is taken")
    _REGISTRY[engine.name] = engine
    if on_request:
        _ON_REQUEST.add(engine.name)
    return engine


def engines(names: Iterable[str] = ()) -> tuple[Engine, ...]:
    """Return the engines of the given names, or all that are registered but those on request.

    One that is named is measured in all that it promises, see ``Engine.contact_only``.
    A name of the form "module:function" is imported (from the current folder too) and needs no registration, nor
    does "exec:COMMAND", see ``compare.engines.outside``, nor one of the entry points "friction_discs.engines" of an
    installed package.
    Raises ``ValueError`` for a name that is unknown or can't be imported.
    """
    names = list(names)
    return told_apart(names, [_named(name) for name in names]) or tuple(
        engine for name, engine in _REGISTRY.items() if name not in _ON_REQUEST
    )


def is_registered(name: str) -> bool:
    """Return whether an engine of that name needs no import of anything else."""
    return name in _REGISTRY


def owner_of(engine: Engine | None) -> str:
    """Return the name of a foreign engine, or "" for the engines of this project, which may share a process."""
    return "" if engine is None or is_registered(engine.name) else engine.name


def told_apart(names: Sequence[str], found: Sequence[Engine]) -> tuple[Engine, ...]:
    """Return the engines, called as they were asked for where a shorter name of theirs is another's too."""
    taken = Counter([engine.name for engine in found]) + Counter([*_REGISTRY, "theory"])
    return tuple(
        replace(engine, name=name) if engine.name != name and taken[engine.name] > 1 else engine
        for name, engine in zip(names, found, strict=True)
    )


def on_request() -> tuple[Engine, ...]:
    """Return the registered engines that take part only where they are named."""
    return tuple(_REGISTRY[name] for name in sorted(_ON_REQUEST))


def shares_code(name: str, other: str) -> bool:
    """Return whether the engine called ``name`` is the one called ``other``, or shares code with it."""
    return name == other or (name in _REGISTRY and _REGISTRY[name].kin == other)


def repeated_by(name: str) -> str:
    """Return the engine that the one called ``name`` repeats in all but its contact, "" if there is none."""
    engine = _REGISTRY.get(name)
    return engine.kin if engine is not None and engine.contact_only else ""


def _named(name: str) -> Engine:
    if scheme := _scheme(name):
        return scheme.engine(name.partition(":")[2])
    if ":" in name:
        return imported(name, name)
    if name in _REGISTRY:
        return replace(_REGISTRY[name], contact_only=False)
    return imported(name, _installed()[known_name(name)])


def known_name(name: str) -> str:
    """Return ``name`` if an engine can be looked for by it; raise ``ValueError`` that suggests one otherwise."""
    if scheme := _scheme(name):
        scheme.check(name.partition(":")[2])
        return name
    alone = [name for name, scheme in _SCHEMES.items() if scheme.alone]
    return name if ":" in name else one_of("engine", name, [*_REGISTRY, *alone, *_installed()])


def _scheme(name: str) -> Scheme | None:
    """Return what ``name`` is an engine of by its part before a colon; None where that says nothing."""
    first, colon, _ = name.partition(":")
    scheme = _SCHEMES.get(first)
    return scheme if scheme and (colon or scheme.alone) and first not in _installed() else None


def _installed() -> dict[str, str]:
    """Return "module:function" of the engines of installed packages, by name."""
    return {point.name: point.value for point in entry_points(group=ENTRY_POINTS)}


def imported(name: str, place: str) -> Engine:
    """Return the engine of the function at ``place``, "module:function"; raise ``ValueError`` if there is none.

    It is taken for an engine of the pin only, which need not tell stick, unless attributes of the function, named
    like the parameters of ``Engine``, say something else::

        simulate.kinds = ("pin", "points", "ring")
        simulate.sticks = False
        simulate.nonlinear = False
        simulate.phases = True
        simulate.step = 1e-3
    """
    module_name, _, function_name = place.partition(":")
    function = ByName(module_name, function_name, os.getcwd())  # where a console script does not look
    try:
        simulate = function.imported
    except (Exception, SystemExit) as error:  # whatever a module may do when it is imported
        kind = "" if isinstance(error, ImportError | AttributeError) else f"{type(error).__name__}: "
        raise ValueError(f"engine {name!r} cannot be imported: {kind}{error}") from None
    if not callable(simulate):
        raise ValueError(
            f"engine {name!r} is not callable: expected simulate(system, initial_state, times, *, tolerance)"
        )
    declared = {key: getattr(simulate, key) for key in DECLARED if hasattr(simulate, key)}
    if "version" in declared:
        declared["version"] = str(declared["version"])
    try:
        return Engine(name, function, **{"phases": False, **declared})
    except (TypeError, ValueError) as error:
        attributes = ", ".join(f"{key} = {value!r}" for key, value in declared.items())
        raise ValueError(f"engine {name!r}, attribute {attributes}: {error}") from None


# --- The engines of this project.

_simulate_reference = ByName("reference_model", "simulate")

reference = register(Engine("reference", _simulate_reference, EVERY_KIND))
exudyn = register(Engine("exudyn", ByName("exudyn_models", "simulate"), EVERY_KIND))
exudyn_native = register(
    Engine(
        "exudyn-native",
        ByName("exudyn_models", "simulate_with_native_contact"),
        ("pin", "points"),
        kin="exudyn",
        contact_only=True,
        about="exudyn-native is Exudyn with its built-in contact in place of the connector of exudyn_models. "
        "Integrator, support and the smoothing of friction are the same, so it is asked only where the contact's own "
        "code decides: the contact by itself, a motion of each kind, a whirl, and free bodies. With --engine "
        "exudyn-native it is measured in all that it simulates.",
    )
)
compiled = register(
    Engine(
        "compiled",
        functools.partial(_simulate_reference, compiled=True),
        EVERY_KIND,
        nonlinear=False,
        kin="reference",
    ),
    on_request=True,
)
plain = register(
    Engine(
        "plain",
        ByName("reference_model.plain", "simulate"),
        EVERY_KIND,
        sticks=False,
        about="plain is the equations as the paper prints them, integrated by SciPy, with friction that is viscous "
        "at slow slip: what sticks creeps, and it tells no stick from slip. It takes only the parameters from the "
        "reference.",
    ),
    on_request=True,
)
