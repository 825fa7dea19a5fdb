"""Functions called from Python, compiled once per machine and kept on disk until their sources change."""

import gc
import hashlib
import multiprocessing
import sys
import threading
import types
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager, suppress
from pathlib import Path
from typing import Any

import numba

from reference_model.numerics.cache_folders import digest_of, folder_of

with suppress(ImportError):  # on Windows
    import fcntl

LONG = 1.0
"""Time in s before a line on standard error announces the compilation; loading takes less."""

typeof: Any = numba.typeof  # not typed
config: Any = numba.config  # built from the environment, so type checkers do not know its names

config.DISABLE_JIT = 0  # despite the user's setting, because plain Python cannot run the compiled functions

_one_at_a_time = threading.Lock()
_announced = threading.Lock()


class CompiledOnce:
    """A function without result, called from Python and compiled when argument types first occur.

    It runs without the interpreter lock. ``package`` is the folder of all sources compiled into it. ``digest`` is the
    result of :func:`reference_model.numerics.cache_folders.digest_of_text` if it is known.
    """

    def __init__(self, function: Callable[..., None], package: Path, digest: str = "") -> None:
        self.py_func, self.package, self.digest = function, package, digest or digest_of(package)
        self.kinds: dict[tuple[Any, ...], Any] = {}
        self.__doc__ = function.__doc__

    def __call__(self, *arguments: Any) -> None:
        """Call the function, compiled or loaded for new argument types."""
        self.compiled(*arguments)(*arguments)

    def compiled(self, *arguments: Any) -> Any:
        """Return the function compiled for the types of ``arguments``; another compiled function may call it."""
        kind = tuple(map(_type_of, arguments))
        if kind not in self.kinds:
            self.kinds[kind] = compiled_for(kind, self.py_func, self.package, nogil=True, digest=self.digest)
        return self.kinds[kind]


def _type_of(argument: Any) -> Any:
    """Return numba's type, of a compiled function by its signature, so that it is called and not compiled again."""
    if hasattr(argument, "nopython_signatures"):
        return numba.types.FunctionType(argument.nopython_signatures[0])
    return typeof(argument)


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


def _placed(function: Callable[..., Any], folder: Path) -> Callable[..., Any]:
    """Return ``function`` as if its file were in ``folder``, because numba compares the stamps of source files."""
    file = folder / f"{function.__name__}.source"  # not a source of the package
    if not file.exists():
        file.touch()
    code = function.__code__.replace(co_filename=str(file), co_firstlineno=1)
    placed = types.FunctionType(
        code, function.__globals__, function.__name__, function.__defaults__, function.__closure__
    )
    placed.__module__, placed.__qualname__ = function.__module__, function.__qualname__
    return placed


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
        _say("Compiling for this machine, once (up to a minute of processor time) ...")


def _say(sentence: str) -> None:
    if sys.stderr is not None:
        with suppress(OSError):
            print(sentence, file=sys.stderr, flush=True)
