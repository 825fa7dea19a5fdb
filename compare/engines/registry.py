"""Engines by name: engines of this project and of installed packages, and functions of modules."""

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
from reference_model.systems import require_flag, require_kind
from reference_model.trajectory import Trajectory


@dataclass(frozen=True)
class ByName:
    """A function of a module, imported on the first call because SciPy and Exudyn load slowly.

    The ``folder``, if given, is searched after all others.
    """

    module: str
    function: str
    folder: str = ""

    def __call__(self, *arguments: Any, **options: Any) -> Trajectory:
        """Call the function."""
        trajectory: Trajectory = self.imported(*arguments, **options)
        return trajectory

    @property
    def simulate_many(self) -> Callable[..., Any] | None:
        """The function's attribute of this name, or None."""
        return getattr(self.imported, "simulate_many", None)

    @property
    def imported(self) -> Callable[..., Any]:
        """The function."""
        if self.folder and self.folder not in sys.path:
            # last, so that a user's file cannot replace a library's module
            sys.path.append(self.folder)
        function: Callable[..., Any] = getattr(importlib.import_module(self.module), self.function)
        return function


ENTRY_POINTS = "friction_discs.engines"
"""Group of entry points for the engines of an installed package: ``mine = "package.module:simulate"``."""

DECLARED = ("kinds", "sticks", "nonlinear", "phases", "precision", "step", "order", "version", "ranges")
"""Attributes of a ``simulate`` function that override parameters of ``Engine``."""

_REGISTRY: dict[str, Engine] = {}
_ON_REQUEST: set[str] = set()


class Scheme(NamedTuple):
    """Meaning of names "scheme:REST": a function that returns the engine of REST, and a quick check of REST.

    Both functions raise ``ValueError`` if REST is invalid. If ``alone``, REST may be missing and is then "".
    """

    engine: Callable[[str], Engine]
    check: Callable[[str], object]
    alone: bool = False


_SCHEMES: dict[str, Scheme] = {}


def register_scheme(name: str, scheme: Scheme) -> None:
    """Register ``scheme`` for engines named "name:REST"."""
    _SCHEMES[name] = scheme


def register(engine: Engine, *, on_request: bool = False) -> Engine:
    """Register ``engine`` for every study, or for runs that request it by name; return it.

    Raises ``ValueError`` if its name is taken.
    """
    require_kind("engine", engine, Engine)
    require_flag("on_request", on_request)
    if engine.name in _REGISTRY or engine.name == "theory":
        raise ValueError(f"engine {engine.name!r}: the name is taken")
    _REGISTRY[engine.name] = engine
    if on_request:
        _ON_REQUEST.add(engine.name)
    return engine


def engines(names: Iterable[str] = ()) -> tuple[Engine, ...]:
    """Return the engines of the given names, or by default all registered engines except those that must be named.

    A named engine is measured in all that it simulates, whatever its ``Engine.contact_only``. Raises ``ValueError``
    if a name is unknown or cannot be imported.
    """
    require_kind("names", names, Iterable)
    names = list(names)
    for name in names:
        require_kind("names", name, str)
    return told_apart(names, [_named(name) for name in names]) or tuple(
        engine for name, engine in _REGISTRY.items() if name not in _ON_REQUEST
    )


def is_registered(name: str) -> bool:
    """Return whether an engine of this name is registered."""
    return name in _REGISTRY


def owner_of(engine: Engine | None) -> str:
    """Return the name of a foreign engine, or "" for this project's engines, which may share a process."""
    return "" if engine is None or is_registered(engine.name) else engine.name


def told_apart(names: Sequence[str], found: Sequence[Engine]) -> tuple[Engine, ...]:
    """Return the engines, with the requested names where their own names are ambiguous."""
    taken = Counter([engine.name for engine in found]) + Counter([*_REGISTRY, "theory"])
    return tuple(
        replace(engine, name=name) if engine.name != name and taken[engine.name] > 1 else engine
        for name, engine in zip(names, found, strict=True)
    )


def on_request() -> tuple[Engine, ...]:
    """Return the registered engines that run only on request."""
    return tuple(_REGISTRY[name] for name in sorted(_ON_REQUEST))


def shares_code(name: str, other: str) -> bool:
    """Return whether the engine ``name`` is the engine ``other`` or shares code with it."""
    return name == other or (name in _REGISTRY and _REGISTRY[name].kin == other)


def repeated_by(name: str) -> str:
    """Return the name of the engine from which ``name`` differs only in its contact, or ""."""
    engine = _REGISTRY.get(name)
    return engine.kin if engine is not None and engine.contact_only else ""


def _named(name: str) -> Engine:
    if scheme := _scheme(name):
        return scheme.engine(name.partition(":")[2])
    if ":" in name:
        return imported(name, name)
    if name in _REGISTRY:
        return replace(_REGISTRY[name], contact_only=False)
    return imported(name, packaged()[known_name(name)])


def known_name(name: str) -> str:
    """Return ``name`` if it may name an engine; otherwise raise ``ValueError`` with a suggestion."""
    if scheme := _scheme(name):
        scheme.check(name.partition(":")[2])
        return name
    alone = [name for name, scheme in _SCHEMES.items() if scheme.alone]
    return name if ":" in name else one_of("engine", name, [*_REGISTRY, *alone, *packaged()])


def _scheme(name: str) -> Scheme | None:
    first, colon, _ = name.partition(":")
    scheme = _SCHEMES.get(first)
    return scheme if scheme and (colon or scheme.alone) and first not in packaged() else None


def packaged() -> dict[str, str]:
    """Return "module:function" of installed packages' engines by name."""
    return {point.name: point.value for point in entry_points(group=ENTRY_POINTS)}


def imported(name: str, place: str) -> Engine:
    """Return the engine of the function at ``place``, "module:function"; raise ``ValueError`` if it is missing.

    By default it simulates the pin only, without reporting phases. The attributes ``DECLARED`` of the function
    override parameters of ``Engine``.
    """
    module_name, _, function_name = place.partition(":")
    function = ByName(module_name, function_name, os.getcwd())  # not on a console script's path
    try:
        simulate = function.imported
    except (Exception, SystemExit) as error:  # importing a user's module may raise anything
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


reference = register(Engine("reference", ByName("reference_model", "simulate"), (*EVERY_KIND, "joint")))
exudyn = register(Engine("exudyn", ByName("exudyn_models", "simulate"), (*EVERY_KIND, "joint")))
exudyn_native = register(
    Engine(
        "exudyn-native",
        ByName("exudyn_models", "simulate_with_native_contact"),
        ("pin", "points", "joint"),
        kin="exudyn",
        contact_only=True,
        about="exudyn-native is Exudyn with its built-in contact in place of the connector of exudyn_models. The "
        "integrator, the support and the regularisation of friction are the same, so it is measured only in studies "
        "that depend on the contact's own code: the contact alone, a motion of each kind, a whirl, and free bodies. "
        "With --engine exudyn-native it is measured in every study that it can simulate.",
    )
)
plain = register(
    Engine(
        "plain",
        ByName("reference_model.plain", "simulate"),
        EVERY_KIND,
        sticks=False,
        about="plain integrates the equations of the paper by SciPy, with friction that is viscous at slow slip. "
        "A sticking body therefore creeps, and plain does not distinguish stick from slip. It takes only the "
        "parameters from the reference.",
    ),
    on_request=True,
)
