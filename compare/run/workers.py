"""Processes that stay alive for one piece of work after the other, and may crash alone.

``concurrent.futures`` gives up its whole pool when one process dies, as an engine of compiled code may.
"""

from __future__ import annotations

import errno
import multiprocessing
import os
import pickle
import signal
import sys
import tempfile
import threading
import time
import traceback
from collections import deque
from collections.abc import Callable, Hashable, Iterator
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from multiprocessing.connection import Connection, wait
from pathlib import Path
from types import TracebackType
from typing import Any

from compare.output.outside_text import printable

ONE_THREAD = dict.fromkeys(
    ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "VECLIB_MAXIMUM_THREADS"), "1"
)
"""The cores are busy with one process each: threads of the linear algebra would only get in their way."""

SAFE_PATH = {"PYTHONSAFEPATH": "1"}
"""Until it has been told this process's path, a new one would look into the current folder first."""


STANDARD_OUTPUT, STANDARD_ERROR = 1, 2
"""Their file descriptors."""


MOST_ERRORS = 100_000
"""Characters of a process's standard error that are handed on after a piece of work."""

NO_MEMORY = ("failed to map segment", "annot allocate memory")
"""How the loader of shared libraries says it."""


@dataclass(frozen=True)
class Failure:
    """Why a piece of work has no result: a sentence, and where it went wrong ("pin.py:12 in simulate")."""

    reason: str
    where: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        """Make its text printable: most of it is an engine's."""
        object.__setattr__(self, "reason", printable(self.reason))
        object.__setattr__(self, "where", tuple(map(printable, self.where)))

    def __str__(self) -> str:
        """Return the sentence with the innermost place in brackets."""
        return f"{self.reason} ({self.where[-1]})" if self.where else self.reason


@dataclass(frozen=True)
class Done:
    """A finished piece of work: ``value`` is what the function returned, or a ``Failure``."""

    key: Hashable
    value: Any
    seconds: float


class Workers:
    """``jobs`` processes, or this very process for ``jobs=1``; use as a context manager.

    With a ``limit`` in s a piece of work that takes longer has failed, and one job has a process of its own too,
    since only a process can be ended. Leaving the context ends the processes at once, whatever they do.
    """

    def __init__(self, jobs: int, limit: float | None = None) -> None:
        self._jobs = jobs
        self._limit = limit
        self._queue: deque[tuple[Hashable, Callable[..., Any], tuple[Any, ...]]] = deque()
        self._processes: list[_Worker] = []
        self._refused: list[Done] = []

    def __enter__(self) -> Workers:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        for worker in self._processes:
            worker.end()

    def submit(
        self, key: Hashable, function: Callable[..., Any], *arguments: Any, first: bool = False
    ) -> None:
        """Put ``function(*arguments)`` into the queue, at its end unless ``first``."""
        work = (key, function, arguments)
        if first:
            self._queue.appendleft(work)
        else:
            self._queue.append(work)

    def begin(self) -> None:
        """Let other processes begin with what is submitted; whoever calls this has something else to do first."""
        if self._jobs > 1 or self._limit is not None:
            self._refused += self._start()

    def finished(self) -> Iterator[Done]:
        """Yield what is finished as it finishes, until nothing is left; more may be submitted meanwhile."""
        yield from self._refused
        self._refused.clear()
        while self._queue or any(worker.key is not None for worker in self._processes):
            if self._jobs == 1 and self._limit is None:
                key, function, arguments = self._queue.popleft()
                yield Done(key, *_timed(function, arguments))
            else:
                yield from self._start()
                yield from self._collect()

    def _start(self) -> Iterator[Done]:
        """Give work to all that are idle; what can't be sent to another process has failed."""
        while self._queue:
            worker = next((worker for worker in self._processes if worker.key is None), None)
            if worker is None:
                if len(self._processes) == self._jobs:
                    return
                worker = _Worker()
                self._processes.append(worker)
            key, function, arguments = self._queue.popleft()
            try:
                message = pickle.dumps((function, arguments))
            except (pickle.PicklingError, AttributeError, TypeError) as error:
                reason = (
                    f"it can't be sent to another process ({error}): use --jobs 1 or functions of a module"
                )
                yield Done(key, Failure(reason), 0.0)
                continue
            worker.start(key, message)

    def _collect(self) -> Iterator[Done]:
        """Wait for the first result, or for the first limit to be reached, and yield what is there by then."""
        busy = {worker.connection: worker for worker in self._processes if worker.key is not None}
        left = None
        if self._limit is not None and busy:
            oldest = min(worker.started for worker in busy.values())
            left = max(0.0, oldest + self._limit - time.monotonic())
        ready = wait(list(busy), left) if busy else []
        for connection, worker in busy.items():
            if connection in ready:
                done = worker.result()
            elif self._limit is not None and time.monotonic() >= worker.started + self._limit:
                done = Done(worker.key, Failure(f"not finished within {self._limit:g} s"), self._limit)
                worker.end()
            else:
                continue
            if worker.dead:
                self._processes.remove(worker)
            yield done


class _Worker:
    """One process and the connection to it; ``key`` is that of its present work, None while it is idle.

    ``started`` is when that work was given to it, in s of the monotonic clock.
    """

    def __init__(self) -> None:
        context = multiprocessing.get_context("spawn")  # the same on every platform, no inherited state
        self.connection, other_end = context.Pipe()
        self.key: Hashable | None = None
        self.started = 0.0
        self.dead = False
        self._process = context.Process(target=_serve, args=(other_end,), daemon=True)
        self._errors = _Errors()
        # Ctrl-C is this process's to handle
        with interrupts_ignored(), _environment(ONE_THREAD | SAFE_PATH), self._errors.written():
            self._process.start()
        other_end.close()

    def start(self, key: Hashable, message: bytes) -> None:
        self.key, self.started = key, time.monotonic()
        with suppress(BrokenPipeError):  # its end shows in result()
            self.connection.send_bytes(message)

    def result(self) -> Done:
        key, self.key = self.key, None
        try:
            value, seconds = pickle.loads(self.connection.recv_bytes())
            self._errors.hand_on()
        except (EOFError, OSError):
            self.dead = True
            self._process.join()
            code = self._process.exitcode or 0
            cause = signal.Signals(-code).name if code < 0 else f"exit status {code}"
            said = self._errors.hand_on().strip().splitlines()
            self._errors.close()
            reason = ": ".join([f"its process came to a sudden end ({cause})", *said[-1:]])
            value, seconds = Failure(reason), 0.0
        return Done(key, value, seconds)

    def end(self) -> None:
        self.dead = True
        self._process.kill()  # compiled code may not listen to less
        self._process.join()
        self._errors.close()
        self.connection.close()


class _Errors:
    """What a process writes to its standard error: it may be all that tells why it ended, before it even began."""

    def __init__(self) -> None:
        self._file = tempfile.TemporaryFile()  # noqa: SIM115
        self._handed_on = 0

    @contextmanager
    def written(self) -> Iterator[None]:
        """Let a process that starts inside write its errors here; on Windows it writes where this one does."""
        try:
            own = os.dup(STANDARD_ERROR)
        except OSError:  # closed by the caller
            own = -1
        if own < 0 or not hasattr(os, "pread"):
            yield
            return
        os.dup2(self._file.fileno(), STANDARD_ERROR)
        try:
            yield
        finally:
            os.dup2(own, STANDARD_ERROR)
            os.close(own)

    def close(self) -> None:
        """Hand on what is left, and let go of the file."""
        self.hand_on()
        self._file.close()

    def hand_on(self) -> str:
        """Write what is new to the standard error of this process, and return it."""
        size = os.fstat(self._file.fileno()).st_size
        if size == self._handed_on:
            return ""
        # Both processes share one place in the file, where the other one writes.
        new = os.pread(self._file.fileno(), size - self._handed_on, self._handed_on)
        self._handed_on += len(new)
        text = printable(new.decode(errors="replace"), MOST_ERRORS)
        if text and sys.stderr is not None:
            sys.stderr.write(text)
            sys.stderr.flush()
        return text


def _serve(connection: Connection) -> None:
    """Work until the other end of the connection is closed."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # not inherited on Windows
    threading.Thread(target=_end_with_parent, daemon=True).start()
    sys.stdout = sys.stderr  # what an engine prints is handed on as its errors are
    with suppress(OSError):  # closed by the caller
        os.dup2(STANDARD_ERROR, STANDARD_OUTPUT)
    with suppress(EOFError):
        while True:
            message = connection.recv_bytes()
            value, seconds = _timed(_unpickled_call, (message,))
            try:
                answer = pickle.dumps((value, seconds))
            except Exception as error:
                answer = pickle.dumps((Failure(f"its result can't be sent back: {error}"), seconds))
            connection.send_bytes(answer)


def _end_with_parent() -> None:
    """End this process in the middle of its work when the one that started it is no more, killed perhaps."""
    parent = multiprocessing.parent_process()
    if parent is not None:
        wait([parent.sentinel])
        os._exit(1)


def _unpickled_call(message: bytes) -> Any:
    function, arguments = pickle.loads(message)
    return function(*arguments)


def _timed(function: Callable[..., Any], arguments: tuple[Any, ...]) -> tuple[Any, float]:
    """Return the result of the call, or its failure, and the seconds that it took."""
    start = time.perf_counter()
    try:
        value = function(*arguments)
    except Exception as error:  # whatever an engine raises: the others go on
        value = failure(error)
    return value, time.perf_counter() - start


def failure(error: Exception) -> Failure:
    """Return what an exception says as a sentence, and the lines of code on its way, innermost last."""
    lines = printable(error).strip().splitlines()
    # ValueError and RuntimeError carry sentences; what a KeyError says is understood only with its name
    named = not isinstance(error, (ValueError, RuntimeError)) or not lines
    reason = ": ".join(([type(error).__name__] if named else []) + lines[:1])
    if lacks_memory(error):
        reason = f"there is not enough memory ({reason})"
    frames = traceback.extract_tb(error.__traceback__)
    # file names only: a report says nothing about the machine that it was made on
    where = tuple(f"{Path(frame.filename).name}:{frame.lineno} in {frame.name}" for frame in frames)
    return Failure(reason, tuple(line for line in where if not line.startswith("workers.py:")))


def lacks_memory(error: BaseException | None) -> bool:
    """Return whether an exception, or one behind it, says so: a library that can't be loaded for that reason too."""
    while error is not None:
        if isinstance(error, MemoryError) or getattr(error, "errno", None) == errno.ENOMEM:
            return True
        if any(words in printable(error) for words in NO_MEMORY):
            return True
        error = error.__cause__ or error.__context__
    return False


@contextmanager
def interrupts_ignored() -> Iterator[None]:
    """Ignore Ctrl-C inside; what starts there inherits it. Without effect outside of the main thread."""
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    before = signal.signal(signal.SIGINT, signal.SIG_IGN)
    try:
        yield
    finally:
        signal.signal(signal.SIGINT, before)


@contextmanager
def _environment(variables: dict[str, str]) -> Iterator[None]:
    before = {name: os.environ.get(name) for name in variables}
    os.environ.update(variables)
    try:
        yield
    finally:
        for name, value in before.items():
            if value is None:
                del os.environ[name]
            else:
                os.environ[name] = value
