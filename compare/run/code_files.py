"""What code depends on: one's own modules by the contents of their files, whatever is installed by its version.

Imports are followed as they stand in the source, also those inside of functions. What can't be followed that way,
an import by a name that is only known at run time or a program that is started, is told. What a file of data says
when it is read can't be seen at all.

Of packages that are trusted (this project's) less is asked: what they import by name is taken in where the name is
known, see ``compare.engines.ByName``; files of data stand beside the modules that read them; and a package around a
module that is imported is taken in by its file, not with all that it imports.
"""

from __future__ import annotations

import ast
import functools
import hashlib
import importlib.util
import json
import re
import sys
import sysconfig
from collections.abc import Collection, Iterator
from importlib.machinery import SOURCE_SUFFIXES, PathFinder
from importlib.metadata import PackageNotFoundError, distribution, packages_distributions
from pathlib import Path
from types import ModuleType
from typing import NamedTuple


class UnknownCodeError(RuntimeError):
    """What some code depends on can't be seen; the message says why."""


HIDING_MODULES = {"cffi", "ctypes", "importlib.machinery", "importlib.util", "runpy", "subprocess"}
"""Whoever imports one of them runs code that no import names."""

HIDING_NAMES = {"__import__", "eval", "exec", "import_module", "load_library"}
"""So does whoever uses one of these names."""

SITES = {"site-packages", "dist-packages"}
"""Folders of what is installed."""


class Place(NamedTuple):
    """The file of a module, if it has one, and where its submodules are, if it is a package."""

    file: Path | None
    submodules: tuple[str, ...] | None


class CodeFiles:
    """Collects what code depends on.

    Parameters
    ----------
    trusted : collection of str
        Packages that run nothing else than what they import.

    """

    def __init__(self, trusted: Collection[str] = ()) -> None:
        self._trusted = frozenset(trusted)
        self._facts: dict[str, str] = {}
        self._unfollowed: dict[str, tuple[str, ...]] = {}

    @property
    def facts(self) -> tuple[str, ...]:
        """All of it, in an order that does not depend on how it was found."""
        return tuple(f"{name} {fact}" for name, fact in sorted(self._facts.items()))

    def add(self, module: str) -> bool:
        """Take in a module with all that it imports; return whether it is one's own code.

        Raises
        ------
        UnknownCodeError
            If what it is or imports can't be seen.

        """
        waiting = [module]
        while waiting:
            name = waiting.pop()
            waiting += self._unfollowed.pop(name, ())
            waiting += self._add_module(name)
            for package in _packages_around(name):
                imports = self._add_module(package)
                if not self.trusts(name):
                    waiting += imports
                elif imports:
                    self._unfollowed[package] = imports
        return module in self._facts

    def _add_module(self, name: str) -> tuple[str, ...]:
        """Take in a module by itself and return what it imports."""
        if name in self._facts:
            return ()
        place = located(name)
        if place is None:
            self._facts[name] = "is not there"
        elif _is_python(name, place):
            self._facts["python"] = sys.version
        elif not self._add_installed(name, place):
            return self._add_own(name, place)
        return ()

    def trusts(self, module: str) -> bool:
        """Return whether a module is of a package that runs nothing else than what it imports."""
        return module.partition(".")[0] in self._trusted

    def _add_own(self, name: str, place: Place) -> tuple[str, ...]:
        """Take in the file of a module and return the modules that it imports."""
        if place.file is None:
            if place.submodules is None:
                raise UnknownCodeError(f"{name} was not read from a file")
            self._facts[name] = "has no file"  # a folder that is a package all the same
            return ()
        try:
            content = place.file.read_bytes()
        except OSError as error:
            raise UnknownCodeError(f"{place.file.name} can't be read: {error.strerror}") from None
        self._facts[name] = hashlib.sha256(content).hexdigest()
        if place.file.suffix not in SOURCE_SUFFIXES:  # compiled
            return ()
        if not self.trusts(name):
            return _imports(name, place, content)
        for data in sorted(place.file.parent.glob("*.json")):
            self._facts[f"{name} {data.name}"] = hashlib.sha256(data.read_bytes()).hexdigest()
        return _trusted_imports(name, place, content)

    def _add_installed(self, name: str, place: Place) -> bool:
        """Take in the distribution that a module came with, if it came with any."""
        distributions = _distributions(name, place)
        for one in distributions:
            self._add_distribution(one)
        return bool(distributions)

    def _add_distribution(self, name: str) -> None:
        """Take in version and contents of a distribution and of all that it requires."""
        key = f"distribution {re.sub(r'[-_.]+', '-', name).lower()}"
        if key in self._facts:
            return
        found = _installed(name)
        if found is None:
            self._facts[key] = "is not there"
            return
        self._facts[key] = found.fact
        for module in found.editable:
            self.add(module)
        for required in found.requires:
            self._add_distribution(required)


class Installed(NamedTuple):
    """Version and contents of a distribution, what it requires, and its modules if they can be edited in place."""

    fact: str
    requires: tuple[str, ...]
    editable: tuple[str, ...]


@functools.cache
def _installed(name: str) -> Installed | None:
    """Return what is installed under the name of a distribution; None if nothing is."""
    try:
        found = distribution(name)
    except PackageNotFoundError:
        return None
    # the list of its files has a checksum of each: a version may be installed once more with other contents
    files = hashlib.sha256((found.read_text("RECORD") or "").encode()).hexdigest()
    editable = json.loads(found.read_text("direct_url.json") or "{}").get("dir_info", {}).get("editable")
    return Installed(
        f"{found.version} {files}",
        tuple(re.split(r"[^\w.-]", requirement, maxsplit=1)[0] for requirement in found.requires or ()),
        tuple(one for one, names in _installed_packages().items() if name in names) if editable else (),
    )


@functools.cache
def _distributions(name: str, place: Place) -> tuple[str, ...]:
    """Return what a module came with; nothing for one's own."""
    places = [*filter(None, [place.file]), *map(Path, place.submodules or ())]
    if not any(SITES & set(one.parts) for one in places):
        return ()
    return _installed_packages().get(name.partition(".")[0], ())


@functools.cache
def _installed_packages() -> dict[str, tuple[str, ...]]:
    """Return the names of the distributions that brought each package that can be imported."""
    return {package: tuple(sorted(set(names))) for package, names in packages_distributions().items()}


def located(name: str) -> Place | None:
    """Return where a module is, without running any of it; None if there is none."""
    module = sys.modules.get(name)
    if module is not None:
        file, paths = getattr(module, "__file__", None), getattr(module, "__path__", None)
    else:
        parent = name.rpartition(".")[0]
        above = located(parent) if parent else None
        if parent and (above is None or above.submodules is None):
            return None
        try:
            spec = (
                importlib.util.find_spec(name)
                if above is None
                else PathFinder.find_spec(name, list(above.submodules or ()))
            )
        except (ImportError, ValueError):
            return None
        if spec is None:
            return None
        file, paths = spec.origin if spec.has_location else None, spec.submodule_search_locations
    return Place(None if file is None else Path(file), None if paths is None else tuple(paths))


@functools.cache
def _is_python(name: str, place: Place) -> bool:
    """Return whether a module belongs to Python itself, and is not one's own of the same name."""
    if name.partition(".")[0] not in sys.stdlib_module_names:
        return False
    return place.file is None or bool(_standard_library() & set(place.file.resolve().parents))


@functools.cache
def _standard_library() -> frozenset[Path]:
    return frozenset(Path(sysconfig.get_path(kind)).resolve() for kind in ("stdlib", "platstdlib"))


def _imports(name: str, place: Place, content: bytes, trusted: bool = False) -> tuple[str, ...]:
    """Return the modules that the source of a module imports, without the packages around them."""
    file = place.file.name if place.file is not None else name
    try:
        tree = ast.parse(content)
    except (SyntaxError, ValueError):
        raise UnknownCodeError(f"{file} is no Python") from None
    found: list[str] = []
    for node in _statements(tree) if trusted else ast.walk(tree):
        hidden = "" if trusted else _hides(node)
        if hidden:
            raise UnknownCodeError(f"{file}:{node.lineno} uses {hidden}, which may run any code")  # type: ignore[attr-defined]
        if isinstance(node, ast.Import):
            found += (alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            base = _absolute(name, place, node)
            # some may be modules
            names = (f"{base}.{alias.name}" for alias in node.names if alias.name != "*")
            found += (base, *(one for one in names if located(one) is not None))
    return tuple(found)


def _statements(tree: ast.Module) -> Iterator[ast.AST]:
    """Yield all statements, and what holds some, without the expressions in them: no import stands there."""
    waiting: list[ast.AST] = [tree]
    while waiting:
        node = waiting.pop()
        yield node
        for field in ("body", "handlers", "orelse", "finalbody", "cases"):
            inside = getattr(node, field, ())
            waiting += inside if isinstance(inside, list) else ()


_trusted_imports = functools.cache(functools.partial(_imports, trusted=True))
"""As ``_imports``, for modules that don't change while the program runs."""


def _hides(node: ast.AST) -> str:
    """Return what in a piece of source lets code run that no import names, "" if nothing does."""
    if isinstance(node, ast.Name):
        names = {node.id} & HIDING_NAMES
    elif isinstance(node, ast.Attribute):
        os_runs = isinstance(node.value, ast.Name) and node.value.id == "os" and node.attr in _OF_OS
        names = {f"os.{node.attr}"} if os_runs else {node.attr} & (HIDING_NAMES - {"eval", "exec"})
    elif isinstance(node, ast.Import):
        names = {part for alias in node.names for part in (alias.name, *_packages_around(alias.name))}
        names &= HIDING_MODULES
    elif isinstance(node, ast.ImportFrom) and node.level == 0:
        module = node.module or ""
        inside = {alias.name for alias in node.names}
        names = {module, *_packages_around(module), *(f"{module}.{one}" for one in inside)} & HIDING_MODULES
        names |= inside & (HIDING_NAMES | (_OF_OS if module == "os" else set()))
    else:
        return ""
    return ", ".join(sorted(names))


_OF_OS = {"popen", "posix_spawn", "system"}


def _absolute(name: str, place: Place, node: ast.ImportFrom) -> str:
    """Return the module that ``from ... import`` takes names from."""
    if node.level == 0:
        return node.module or ""
    loaded = sys.modules.get(name)
    package = _package_of(loaded) or (name if place.submodules is not None else name.rpartition(".")[0])
    base = package.rsplit(".", node.level - 1)[0] if node.level > 1 else package
    return f"{base}.{node.module}" if node.module else base


def _package_of(module: ModuleType | None) -> str:
    return getattr(module, "__package__", None) or ""


def _packages_around(name: str) -> tuple[str, ...]:
    """Return "a", "a.b" for "a.b.c"."""
    parts = name.split(".")
    return tuple(".".join(parts[:i]) for i in range(1, len(parts)))
