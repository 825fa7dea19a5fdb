"""Folders of compiled functions, which belong to a state of their sources.

numba's cache checks only the file of the function itself, although it compiles functions and constants of other files
into it. So each package keeps compiled functions in a folder named after a digest of its sources, or of the bytecode
and the constants of the functions that are compiled.
"""

import hashlib
import os
import shutil
import tempfile
import time
from collections.abc import Callable, Iterable, Iterator
from contextlib import suppress
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np

VERSIONS = 4
"""Number of source versions whose compiled functions are kept."""

UNUSED = 86_400.0
"""Age in s of versions that are deleted; a running process may still need a younger version."""


@cache
def digest_of(package: Path) -> str:
    """Return a digest of a package's sources; call it at import, because compiled functions belong to these."""
    digest = hashlib.sha256()
    for file in sorted(package.rglob("*.py")):
        digest.update(
            f"{file.relative_to(package)} {hashlib.sha256(file.read_bytes()).hexdigest()}\n".encode()
        )
    return digest.hexdigest()[:16]


def digest_of_text(functions: Iterable[Callable[..., Any]]) -> str:
    """Return a digest of the bytecode of functions and of the constants in it, which numba compiles."""
    digest = hashlib.sha256()
    for function in functions:
        code = function.__code__
        own = [constant for constant in code.co_consts if constant != function.__doc__]
        outer = [
            (name, _constant(function.__globals__[name]))
            for name in code.co_names
            if name in function.__globals__
        ]
        digest.update(
            repr((function.__name__, code.co_code, code.co_varnames, code.co_names, own, outer)).encode()
        )
    return digest.hexdigest()[:16]


def _constant(value: Any) -> Any:
    """Return the compiled value of a global name, nothing for functions and modules."""
    if isinstance(value, np.ndarray):
        return value.shape, value.tobytes()
    return value if isinstance(value, int | float | str | tuple) else getattr(value, "_fields", "")


@cache
def folder_of(package: Path, digest: str) -> str:
    """Return the folder of compiled functions with this digest, or "" if none is writable.

    It lies in ``NUMBA_CACHE_DIR`` if set, else next to the sources, or in the user's cache if these are read-only.
    """
    for place in _places(package):
        folder = place / f"{package.name}-{digest}"
        with suppress(OSError):
            folder.mkdir(parents=True, exist_ok=True)
            tempfile.TemporaryFile(dir=folder).close()
            folder.touch()
            _delete_old(place, package)
            return str(folder)
    return ""


def _places(package: Path) -> Iterator[Path]:
    if chosen := os.environ.get("NUMBA_CACHE_DIR"):
        yield Path(chosen)
        return
    yield package / "__pycache__"
    with suppress(RuntimeError):  # the user has no home folder
        yield Path.home() / ".cache" / "friction-discs"


def _delete_old(place: Path, package: Path) -> None:
    with suppress(OSError):  # another process may delete them too
        used = sorted((folder.stat().st_mtime, folder) for folder in place.glob(f"{package.name}-*"))
        for last, folder in used[:-VERSIONS]:
            if time.time() - last > UNUSED:
                shutil.rmtree(folder, ignore_errors=True)


def has_files(package: Path, digest: str, name: str) -> bool:
    """Return whether the folder contains the compiled function ``name``."""
    folder = folder_of(package, digest)
    return bool(folder) and any(Path(folder).rglob(f"*.{name}-*.nbi"))
