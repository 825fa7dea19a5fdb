"""One digest of what results depend on: sources, the engine's own files, versions of libraries, kind of machine."""

from __future__ import annotations

import hashlib
import platform
from collections.abc import Iterable
from dataclasses import fields, is_dataclass
from functools import cache
from importlib.metadata import distributions
from pathlib import Path

from compare.engines import Engine
from compare.run.engine_files import PACKAGES, files_of
from compare.run.provenance import LIBRARIES, ROOT, exudyn_user_settings, version_of

SOURCES = {".py", ".c", ".h", ".json", ".csv"}
"""Endings of the project's code, and of the data that it reads: records of other engines, published numbers."""

DRAWING_LIBRARIES = ("matplotlib", "pillow")


def stamp(*more: str) -> str:
    """Return the SHA-256 of the project's sources, the versions of its libraries, the machine and ``more``."""
    versions = [(name, version_of(name)) for name in (*LIBRARIES, *DRAWING_LIBRARIES)]
    facts = (platform.python_version(), platform.machine(), versions, exudyn_user_settings())
    return hashlib.sha256(repr((_sources(ROOT), facts, more)).encode()).hexdigest()


def engine_stamp(engine: Engine | None) -> str | None:
    """Return :func:`stamp` with what the answers of an engine depend on, None if its files cannot be read.

    An engine from elsewhere may use any installed package, so the versions of all packages count.
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
    installed = sorted((one.name, one.version) for one in distributions())
    return stamp(facts, content, repr(installed))


@cache
def _sources(root: Path) -> str:
    """Return the digest of the packages below ``root``; a process has the code that it was started with."""
    paths = (path for name in PACKAGES for path in (root / name).rglob("*") if path.suffix in SOURCES)
    return _digest((path.relative_to(root).as_posix(), path) for path in sorted(paths))


def _digest(files: Iterable[tuple[str, Path]]) -> str:
    """Return the SHA-256 of names and contents of files."""
    contents = [(name, hashlib.sha256(path.read_bytes()).hexdigest()) for name, path in files]
    return hashlib.sha256(repr(contents).encode()).hexdigest()
