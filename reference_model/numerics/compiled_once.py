"""Functions that Python calls: compiled once on a machine, whoever needs them, and kept on disk.

Of several processes that need one at once, the first compiles it and the others wait for that and load it.
"""

from __future__ import annotations

import gc
import multiprocessing
import sys
import threading
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager, suppress
from pathlib import Path
from typing import Any

from numba.core.registry import CPUDispatcher
from numba.core.sigutils import normalize_signature

from reference_model.numerics.compiled_cache import known_by_content
from reference_model.numerics.vector_width import WideCompiler

LONG = 1.0
"""Time in s after which a terminal is told that something is being compiled, here or by another process."""


with suppress(ImportError):  # of Windows
    import fcntl


class Kept(CPUDispatcher):
    """A compiled function that is taken from disk if all that it is made of is as it was."""

    def __init__(
        self,
        py_func: Callable[..., Any],
        locals: dict[str, Any] | None = None,
        targetoptions: dict[str, Any] | None = None,
    ) -> None:
        super().__init__(
            py_func,
            locals or {},
            {"nopython": True, "boundscheck": None, **(targetoptions or {})},
            WideCompiler,
        )
        self.enable_caching()
        known_by_content(self)

    def compile(self, sig: Any) -> Any:
        """Return the compiled function for arguments of these types."""
        arguments, _ = normalize_signature(sig)
        if arguments in self.overloads or self._is_kept(sig):  # looking at the disk takes a millisecond
            return super().compile(sig)
        folder = Path(self._files.cache_path)
        lock = folder / f"{self._files._cache_file._index_name}.lock"
        with _told(folder), _locked(lock), _without_garbage_collection():
            return super().compile(sig)  # or what another process has kept by now

    def _is_kept(self, sig: Any) -> bool:
        target: Any = self.targetctx
        return self._files._index_key(sig, target.codegen()) in self._files._cache_file._load_index()

    @property
    def _files(self) -> Any:
        """The cache, numba's own."""
        return self._cache  # type: ignore[attr-defined]


@contextmanager
def _locked(lock: Path) -> Iterator[None]:
    """Hold a lock between processes, which ends with its owner. Where there is none, work may be done twice."""
    with ExitStack() as held:
        with suppress(OSError, NameError):
            lock.parent.mkdir(parents=True, exist_ok=True)
            file = held.enter_context(lock.open("w"))
            fcntl.flock(file, fcntl.LOCK_EX)
        yield


@contextmanager
def _told(folder: Path) -> Iterator[None]:
    """Tell a terminal, once, if compiling takes long, or waiting for a process that compiles."""
    timer = threading.Timer(LONG, _tell, (folder,))
    timer.daemon = True
    timer.start()
    try:
        yield
    finally:
        timer.cancel()


_told_already = threading.Lock()


def _tell(folder: Path) -> None:
    if (
        sys.stderr.isatty()
        and multiprocessing.parent_process() is None
        and _told_already.acquire(blocking=False)
    ):
        print(f"Compiling for this machine, once: it is kept in {folder}", file=sys.stderr)


@contextmanager
def _without_garbage_collection() -> Iterator[None]:
    """Leave garbage for later: looking for it again and again takes a tenth of the time that compiling does."""
    enabled = gc.isenabled()
    gc.disable()
    try:
        yield
    finally:
        if enabled:
            gc.enable()
