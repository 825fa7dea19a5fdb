"""Provenance of results: commit, versions and machine, and one digest of all that they depend on."""

import functools
import hashlib
import importlib.util
import json
import os
import platform
import subprocess
import sys
from collections.abc import Callable, Iterable
from contextlib import suppress
from dataclasses import fields, is_dataclass
from datetime import UTC, datetime
from functools import cache
from importlib.machinery import ModuleSpec
from importlib.metadata import PackageNotFoundError, distribution, distributions, metadata, version
from pathlib import Path
from typing import Any

from compare.engines import ByName, Engine
from compare.engines.outside.program import code_below

# --- Commit, versions and machine of a report.

ROOT = Path(__file__).resolve().parents[2]

LIBRARIES = ("numpy", "scipy", "exudyn", "numba")


def platform_stamp() -> dict[str, str]:
    """Return versions, operating system, number of cores and date."""
    return {
        "friction-discs": version_of("friction-discs"),
        "commit": commit() or "unknown",
        "Python": platform.python_version(),
        **{name: version_of(name) for name in LIBRARIES},
        "user settings of Exudyn": exudyn_user_settings(),
        "system": f"{platform.system()} {platform.machine()}",
        "processor": processor(),
        "cores": str(os.cpu_count()),
        "date": datetime.now(UTC).strftime("%Y-%m-%d %H:%M UTC"),
    }


ENGINES = {"reference": "friction-discs", "plain": "friction-discs", "exudyn": "exudyn"}
"""Distributions with the code of this project's engines."""


def engine_version(name: str, kin: str, own: str) -> str:
    """Return ``own``, or the version of the engine's distribution, or ""."""
    source = ENGINES.get(kin or name)
    return own or (version_of(source) if source else "")


def commit() -> str:
    """Return the commit of the code, with "-dirty" if files differ from it, or ""."""
    if (ROOT / ".git").exists():
        try:
            found = subprocess.run(
                ["git", "-C", str(ROOT), "describe", "--always", "--dirty", "--abbrev=40", "--exclude=*"],
                capture_output=True,
                encoding="utf-8",
            )
        except OSError:
            return ""
        return found.stdout.strip()
    try:
        source = distribution("friction-discs").read_text("direct_url.json") or "{}"
    except PackageNotFoundError:
        return ""
    return str(json.loads(source).get("vcs_info", {}).get("commit_id", ""))


REPOSITORIES = ("Repository", "Source")
"""Labels of the repository's address among the addresses in ``pyproject.toml``."""


def address_of(path: str, line: int) -> str:
    """Return the web address of a line of a source file; "" if no address of a repository is configured."""
    with suppress(PackageNotFoundError):
        for one in metadata("friction-discs").get_all("Project-URL", []):
            label, _, address = one.partition(", ")
            if label in REPOSITORIES:
                revision = commit().removesuffix("-dirty") or "HEAD"
                return f"{address.rstrip('/')}/blob/{revision}/{path}#L{line}"
    return ""


def processor() -> str:
    """Return the model of the processor, or its architecture."""
    with suppress(OSError):
        for line in Path("/proc/cpuinfo").read_text(encoding="utf-8", errors="replace").splitlines():
            if line.startswith("model name"):
                return line.partition(":")[2].strip()
    return platform.processor() or platform.machine()


def version_of(name: str) -> str:
    """Return the installed version, or "none"."""
    try:
        return version(name)
    except PackageNotFoundError:
        return "none"


def exudyn_user_settings() -> str:
    """Return "on" if Exudyn has been imported and applied a user's own settings, else "off"."""
    found = sys.modules.get("exudyn.misc.overrideSettings")
    return "on" if found is not None and found.Applied() else "off"


# --- Files of an engine's code. Modules are located but not imported: foreign code runs only in separate processes.

PACKAGES = ("reference_model", "exudyn_models", "fmu_models", "compare")

SITES = {"site-packages", "dist-packages"}
"""Folders of independent installed packages."""


def files_of(function: Callable[..., Any]) -> list[Path] | None:
    """Return the files of an engine's function and of the modules next to it, sorted.

    The list is empty for functions of this project and of Python, and None if no files are found.
    """
    if (files := getattr(function, "files", None)) is not None:
        return sorted(files) or None
    while isinstance(function, functools.partial):
        function = function.func
    folder = function.folder if isinstance(function, ByName) else ""
    module = function.module if isinstance(function, ByName) else function.__module__
    package = module.partition(".")[0]
    if package in PACKAGES or package in sys.stdlib_module_names:
        return []
    spec = _found(package, folder)
    if spec is None:
        return None
    if spec.submodule_search_locations is not None:
        return sorted(code_below(spec.submodule_search_locations)) or None
    if spec.origin is None or not (file := Path(spec.origin)).is_file():
        return None
    return [file] if file.parent.name in SITES else sorted(code_below([file.parent]))


def _found(package: str, folder: str) -> ModuleSpec | None:
    """Return the location of a top-level module; ``folder`` is searched last, as in its import."""
    before = sys.path.copy()
    sys.path.extend([folder] if folder else [])
    try:
        return importlib.util.find_spec(package)
    except ValueError:  # a module that was not loaded from a file
        return None
    finally:
        sys.path[:] = before


# --- Digest of all that results depend on: sources, the engine's own files, versions of libraries, type of machine.

SOURCES = {".py", ".c", ".h", ".json", ".csv"}

DRAWING_LIBRARIES = ("matplotlib", "pillow")


def stamp(*more: str) -> str:
    """Return the SHA-256 of the project's sources, the versions of its libraries, the machine and ``more``."""
    versions = [(name, version_of(name)) for name in (*LIBRARIES, *DRAWING_LIBRARIES)]
    facts = (platform.python_version(), platform.machine(), versions, exudyn_user_settings())
    return hashlib.sha256(repr((_sources(ROOT), facts, more)).encode()).hexdigest()


def engine_stamp(engine: Engine | None) -> str | None:
    """Return :func:`stamp` with all that an engine's answers depend on; None if its files cannot be read.

    A foreign engine may use any installed package, so the versions of all packages count.
    """
    if engine is None:
        return stamp()
    function = engine.function  # its repr contains an address in memory unless it is a dataclass
    promises = [field.name for field in fields(engine) if field.name != "function" or is_dataclass(function)]
    facts = repr([(name, getattr(engine, name)) for name in promises])
    try:
        files = files_of(function)
        if files is None:
            return None
        if not files:
            return stamp(facts)
        content = _digest((str(path), path) for path in files)
    except OSError:
        return None
    return stamp(facts, content, _installed())


@cache
def _installed() -> str:
    """Return names and versions of all packages, cached because a process keeps its libraries."""
    return repr(sorted((one.name, one.version) for one in distributions()))


@cache
def _sources(root: Path) -> str:
    """Return the digest of the packages, cached because a process keeps its code."""
    paths = (path for name in PACKAGES for path in (root / name).rglob("*") if path.suffix in SOURCES)
    return _digest((path.relative_to(root).as_posix(), path) for path in sorted(paths))


def _digest(files: Iterable[tuple[str, Path]]) -> str:
    contents = [(name, hashlib.sha256(path.read_bytes()).hexdigest()) for name, path in files]
    return hashlib.sha256(repr(contents).encode()).hexdigest()
