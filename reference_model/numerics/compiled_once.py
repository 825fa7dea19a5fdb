"""Functions called from Python, compiled once per machine and kept on disk until their sources change.

numba's cache checks only the file of the function itself, although it compiles functions and constants of other files
into it. So each package keeps compiled functions in a folder named after a digest of its sources, or of the bytecode
and the constants of the functions that are compiled.
"""

import gc
import hashlib
import multiprocessing
import shutil
import sys
import tempfile
import threading
import time
import types
from collections.abc import Callable, Iterable, Iterator
from contextlib import ExitStack, contextmanager, suppress
from functools import cache
from pathlib import Path
from typing import Any

import numba
import numpy as np

with suppress(ImportError):  # on Windows
    import fcntl

LONG = 1.0
"""Time in s before a line on standard error announces the compilation; loading takes less."""

VERSIONS = 4
"""Number of source versions whose compiled functions are kept."""

UNUSED = 86_400.0
"""Age in s of versions that are deleted; a running process may still need a younger one."""

config: Any = numba.config  # built from the environment, so type checkers do not know its names

_one_at_a_time = threading.Lock()
_announced = threading.Lock()


class CompiledOnce:
    """A function without result, called from Python and compiled when argument types first occur.

    It runs without the interpreter lock. ``package`` is the folder of all sources compiled into it, and ``digest``
    that of :func:`digest_of_text` if it is known.
    """

    def __init__(self, function: Callable[..., None], package: Path, digest: str = "") -> None:
        self.py_func, self.package, self.digest = function, package, digest or digest_of(package)
        self.kinds: dict[tuple[Any, ...], Any] = {}
        self.__doc__ = function.__doc__

    def __call__(self, *arguments: Any) -> None:
        """Call the function, compiled or loaded for new argument types."""
        kind = tuple(map(numba.typeof, arguments))
        if kind not in self.kinds:
            self.kinds[kind] = compiled_for(kind, self.py_func, self.package, nogil=True, digest=self.digest)
        self.kinds[kind](*arguments)


def compiled_for(
    kind: tuple[Any, ...],
    function: Callable[..., Any],
    package: Path,
    nogil: bool = False,
    digest: str = "",
) -> Any:
    """Return numba's dispatcher of a function for these types; other threads and processes wait for it."""
    with _one_at_a_time, ExitStack() as stack:
        folder = folder_of(package, digest or digest_of(package))
        if folder:
            function = _placed(function, Path(folder))
            stack.enter_context(_locked(Path(folder) / f"{function.__name__}.lock"))
        timer = threading.Timer(LONG, _announce)
        timer.daemon = True
        timer.start()
        stack.callback(timer.cancel)
        if gc.isenabled():  # garbage collection takes a tenth of the compile time
            gc.disable()
            stack.callback(gc.enable)
        if folder:
            stack.callback(setattr, config, "CACHE_DIR", config.CACHE_DIR)
            config.CACHE_DIR = folder
            try:
                with _whole_files(Path(folder), function.__name__):
                    return numba.njit(kind, error_model="numpy", nogil=nogil, cache=True)(function)
            except Exception as error:  # a full disk, or a damaged file that nobody noticed
                _say(f"Cannot use the compiled functions in {folder!r} ({error}); compiling without them ...")
        return numba.njit(kind, error_model="numpy", nogil=nogil)(function)


@contextmanager
def _whole_files(folder: Path, name: str) -> Iterator[None]:
    """Delete the damaged files of a function, which numba would execute."""
    kept = folder / f"{name}.sha256"
    try:
        known = set(kept.read_text(encoding="utf-8").splitlines())
    except (OSError, ValueError):
        known = set()
    for file in folder.rglob(f"*.{name}-*.nb?"):
        if _fingerprint(file) not in known:
            _say(f"The file {str(file)!r} is damaged; compiling its function again ...")
            file.unlink()
    yield
    new = {_fingerprint(file) for file in folder.rglob(f"*.{name}-*.nb?")}
    if new != known:
        kept.write_text("\n".join(sorted(new)), encoding="utf-8")


def _fingerprint(file: Path) -> str:
    return f"{hashlib.sha256(file.read_bytes()).hexdigest()} {file.name}"


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
    """Return a digest of the bytecode of functions, and of the constants that they use."""
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
    """Return the value of a constant; functions and modules are known by their names."""
    if isinstance(value, np.ndarray):
        return value.shape, value.tobytes()
    return value if isinstance(value, int | float | str | tuple) else getattr(value, "_fields", "")


def _placed(function: Callable[..., Any], folder: Path) -> Callable[..., Any]:
    """Return ``function`` as if it stood in a file of ``folder``: numba compares the stamps of source files."""
    file = folder / f"{function.__name__}.py"
    if not file.exists():
        file.touch()
    code = function.__code__.replace(co_filename=str(file), co_firstlineno=1)
    placed = types.FunctionType(
        code, function.__globals__, function.__name__, function.__defaults__, function.__closure__
    )
    placed.__module__, placed.__qualname__ = function.__module__, function.__qualname__
    return placed


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
    if config.CACHE_DIR:
        yield Path(config.CACHE_DIR)
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


@contextmanager
def _locked(lock: Path) -> Iterator[None]:
    """Hold a lock between processes, or none where there are no locks and work may be done twice."""
    with ExitStack() as held:
        with suppress(OSError, NameError):
            file = held.enter_context(lock.open("w"))
            fcntl.flock(file, fcntl.LOCK_EX)
        yield


def _announce() -> None:
    """Report a long compilation, once per process; worker processes are silent."""
    if multiprocessing.parent_process() is None and _announced.acquire(blocking=False):
        _say("Compiling for this machine, once for each kind of system (about 20 s of processor time) ...")


def _say(sentence: str) -> None:
    if sys.stderr is not None:
        with suppress(OSError):
            print(sentence, file=sys.stderr, flush=True)
