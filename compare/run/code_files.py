"""What code depends on: one's own modules by the contents of their files, whatever is installed by its version.

Imports are followed as they stand in the source, also those inside of functions. What can't be followed that way,
an import by a name that is only known at run time or a program that is started, is told. What a file of data says
when it is read can't be seen at all.
"""

from __future__ import annotations

import ast
import hashlib
import importlib.util
import json
import re
import sys
import sysconfig
from collections.abc import Collection, Iterator
from functools import cached_property
from importlib.machinery import SOURCE_SUFFIXES, PathFinder
from importlib.metadata import PackageNotFoundError, distribution, packages_distributions
from pathlib import Path
from types import ModuleType
from typing import NamedTuple


class UnknownCodeError(Exception):
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
    covered : collection of str
        Packages that are taken care of elsewhere.

    """

    def __init__(self, covered: Collection[str] = ()) -> None:
        self._covered = frozenset(covered)
        self._facts: dict[str, str] = {}

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
            if name in self._facts or self.covers(name):
                continue
            place = located(name)
            if place is None:
                self._facts[name] = "is not there"
            elif _is_python(name, place):
                self._facts["python"] = sys.version
            elif not self._add_installed(name, place):
                waiting += self._add_own(name, place)
        return module in self._facts

    @cached_property
    def _packages(self) -> dict[str, list[str]]:
        """The names of the distributions that brought each package that can be imported."""
        return {package: sorted(set(names)) for package, names in packages_distributions().items()}

    def covers(self, module: str) -> bool:
        """Return whether a module is taken care of elsewhere."""
        return module.partition(".")[0] in self._covered

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
        return tuple(_imports(name, place, content))

    def _add_installed(self, name: str, place: Place) -> bool:
        """Take in the distribution that a module came with, if it came with any."""
        places = [*filter(None, [place.file]), *map(Path, place.submodules or ())]
        if not any(SITES & set(one.parts) for one in places):
            return False
        distributions = self._packages.get(name.partition(".")[0], [])
        for one in distributions:
            self._add_distribution(one)
        return bool(distributions)

    def _add_distribution(self, name: str) -> None:
        """Take in version and contents of a distribution and of all that it requires."""
        key = f"distribution {re.sub(r'[-_.]+', '-', name).lower()}"
        if key in self._facts:
            return
        try:
            found = distribution(name)
        except PackageNotFoundError:
            self._facts[key] = "is not there"
            return
        # the list of its files has a checksum of each: a version may be installed once more with other contents
        files = hashlib.sha256((found.read_text("RECORD") or "").encode()).hexdigest()
        self._facts[key] = f"{found.version} {files}"
        if json.loads(found.read_text("direct_url.json") or "{}").get("dir_info", {}).get("editable"):
            for module in (one for one, names in self._packages.items() if name in names):
                self.add(module)
        for requirement in found.requires or ():
            self._add_distribution(re.split(r"[^\w.-]", requirement, maxsplit=1)[0])


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


def _is_python(name: str, place: Place) -> bool:
    """Return whether a module belongs to Python itself, and is not one's own of the same name."""
    if name.partition(".")[0] not in sys.stdlib_module_names:
        return False
    library = {Path(sysconfig.get_path(kind)).resolve() for kind in ("stdlib", "platstdlib")}
    return place.file is None or bool(library & set(place.file.resolve().parents))


def _imports(name: str, place: Place, content: bytes) -> Iterator[str]:
    """Yield the modules that the source of a module imports, with the packages that they are in."""
    file = place.file.name if place.file is not None else name
    try:
        tree = ast.parse(content)
    except (SyntaxError, ValueError):
        raise UnknownCodeError(f"{file} is no Python") from None
    for node in ast.walk(tree):
        hidden = _hides(node)
        if hidden:
            raise UnknownCodeError(f"{file}:{node.lineno} uses {hidden}, which may run any code")  # type: ignore[attr-defined]
        if isinstance(node, ast.Import):
            for alias in node.names:
                yield from _with_packages(alias.name)
        elif isinstance(node, ast.ImportFrom):
            base = _absolute(name, place, node)
            yield from _with_packages(base)
            for alias in node.names:  # which may be modules
                within = f"{base}.{alias.name}"
                if alias.name != "*" and located(within) is not None:
                    yield within


def _hides(node: ast.AST) -> str:
    """Return what in a piece of source lets code run that no import names, "" if nothing does."""
    if isinstance(node, ast.Name):
        names = {node.id} & HIDING_NAMES
    elif isinstance(node, ast.Attribute):
        os_runs = isinstance(node.value, ast.Name) and node.value.id == "os" and node.attr in _OF_OS
        names = {f"os.{node.attr}"} if os_runs else {node.attr} & (HIDING_NAMES - {"eval", "exec"})
    elif isinstance(node, ast.Import):
        names = {part for alias in node.names for part in _with_packages(alias.name)} & HIDING_MODULES
    elif isinstance(node, ast.ImportFrom) and node.level == 0:
        module = node.module or ""
        inside = {alias.name for alias in node.names}
        names = {*_with_packages(module), *(f"{module}.{one}" for one in inside)} & HIDING_MODULES
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


def _with_packages(name: str) -> tuple[str, ...]:
    """Return "a", "a.b", "a.b.c" for "a.b.c"."""
    parts = name.split(".")
    return tuple(".".join(parts[: i + 1]) for i in range(len(parts)))
