"""Reusable worker processes; a crash of one process does not affect the others.

``concurrent.futures`` gives up its whole pool when one process dies, and compiled engines may crash.
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
from multiprocessing import resource_tracker
from multiprocessing.connection import Connection, wait
from pathlib import Path
from types import TracebackType
from typing import Any

from compare.engines.outside.processor_time import is_over, processor_time, processor_time_of
from compare.output.outside_text import Failure as Failure
from compare.output.outside_text import cause_of_end, printable
from compare.run.interrupts import ignored, postponed

ONE_THREAD = dict.fromkeys(
    ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "VECLIB_MAXIMUM_THREADS"), "1"
)
"""Environment without threads of linear algebra, because each core runs a process."""

SAFE_PATH = {"PYTHONSAFEPATH": "1"}
"""Environment that keeps a new process from importing from the current folder too early."""

STANDARD_OUTPUT, STANDARD_ERROR = 1, 2

MOST_ERRORS = 100_000
"""Largest number of characters of standard error that are forwarded at once."""

NO_MEMORY = ("failed to map segment", "annot allocate memory")

FAREWELL = 1.0
"""Longest wait in s for the exit code of a process whose connection has closed."""

TICK = 0.005

LOOKS_EVERY = 0.1
"""Time in s between two looks at the processor time of a process."""


@dataclass(frozen=True)
class Done:
    """A finished piece of work with its result or ``Failure``, its duration and its processor time in s."""

    key: Hashable
    value: Any
    seconds: float
    spent: float = 0.0


@dataclass(frozen=True, eq=False)
class _Work:
    key: Hashable
    function: Callable[..., Any]
    arguments: tuple[Any, ...]
    owner: str
    limit: float | None


class Workers:
    """A pool of at most ``jobs`` processes, used as a context manager; leaving it kills all processes.

    Work that takes more processor time than ``limit`` (s), or hangs that long, has no result. ``watch`` gets the keys
    of the running work when they may have changed.
    """

    def __init__(self, jobs: int = 1, limit: float | None = None) -> None:
        self._jobs = jobs
        self.limit = limit
        self.watch: Callable[[list[Hashable]], None] = lambda running: None
        self._queue: deque[_Work] = deque()
        self._processes: list[_Worker] = []
        self._temporary = tempfile.TemporaryDirectory(prefix="friction-discs-", ignore_cleanup_errors=True)

    def __enter__(self) -> Workers:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        for worker in self._processes:
            worker.end()
        self._temporary.cleanup()  # killed processes leave files behind

    def submit(
        self,
        key: Hashable,
        function: Callable[..., Any],
        *arguments: Any,
        first: bool = False,
        owner: str = "",
        limit: float | None = None,
    ) -> None:
        """Queue ``function(*arguments)``, at the front if ``first``; ``limit`` replaces the usual limit.

        A process that has worked for an ``owner`` never works for another owner, because a foreign engine may have
        changed its modules.
        """
        work = _Work(key, function, arguments, owner, self.limit if limit is None else limit)
        if first:
            self._queue.appendleft(work)
        else:
            self._queue.append(work)

    def finished(self) -> Iterator[Done]:
        """Yield each result as soon as it is available, until no work is left; you may submit more meanwhile."""
        while self._queue or any(worker.key is not None for worker in self._processes):
            yield from self._start()
            self.watch([worker.key for worker in self._processes if worker.key is not None])
            yield from self._collect()

    def ask(self, function: Callable[..., Any], *arguments: Any, owner: str = "") -> Any:
        """Return the result of ``function(*arguments)`` or its ``Failure``; no other work may be pending."""
        self.submit("", function, *arguments, owner=owner)
        (done,) = self.finished()
        return done.value

    def _start(self) -> Iterator[Done]:
        """Give work to idle processes, and yield a failure for work that cannot be pickled."""
        while self._queue:
            worker = next((worker for worker in self._processes if worker.key is None), None)
            if worker is None and len(self._processes) == self._jobs:
                return
            work = next((one for one in self._queue if worker and one.owner == worker.owner), self._queue[0])
            self._queue.remove(work)
            try:
                message = pickle.dumps((work.function, work.arguments))
            except Exception as error:  # pickling may raise anything
                reason = f"cannot be sent to another process ({error}); use functions of a module"
                yield Done(work.key, Failure(reason), 0.0)
                continue
            if worker and worker.owner not in ("", work.owner):
                worker.end()
                self._processes.remove(worker)
                worker = None
            if worker is None:
                worker = _Worker(self._temporary.name)
                self._processes.append(worker)
            worker.limit = work.limit
            worker.start(work.key, message, work.owner)

    def _collect(self) -> Iterator[Done]:
        """Wait for the first result or time limit, and yield all up to then."""
        busy = {worker.connection: worker for worker in self._processes if worker.key is not None}
        ends = [worker.limit - worker.spent() for worker in busy.values() if worker.limit is not None]
        left = max(LOOKS_EVERY, min(*ends, 3600.0)) if ends else None  # systems limit a wait
        ready = wait(list(busy), left) if busy else []
        for connection, worker in busy.items():
            if connection in ready:
                done = worker.result()
            elif worker.limit is not None and is_over(worker.limit, worker.spent(), worker.waited()):
                late = Failure(f"not finished within {worker.limit:g} s", unfinished=True)
                done = Done(worker.key, late, worker.limit, max(worker.limit, worker.spent()))
                worker.end()
            else:
                continue
            if worker.dead:
                self._processes.remove(worker)
            yield done


class _Worker:
    """A process and the connection to it; ``key`` identifies its current work, None while it is idle.

    It received the work at ``started``, in s of the monotonic clock, and has ``limit`` (s) of processor time for it.
    """

    def __init__(self, temporary: str) -> None:
        context = multiprocessing.get_context("spawn")  # no inherited state
        self.connection, other_end = context.Pipe()
        self._spending, spending = context.Pipe(duplex=False)
        self._published = self._before = 0.0
        self.key: Hashable | None = None
        self.owner = ""
        self.started = 0.0
        self.limit: float | None = None
        self.dead = False
        self._process = context.Process(target=_serve, args=(other_end, spending), daemon=True)
        self._errors = _Errors()
        environment = ONE_THREAD | SAFE_PATH | {"TMPDIR": temporary}
        resource_tracker.ensure_running()  # which unblocks signals
        with postponed(), _environment(environment), self._errors.written():
            self._process.start()
        other_end.close()
        spending.close()

    def start(self, key: Hashable, message: bytes, owner: str) -> None:
        self.key, self.owner, self.started, self._before = key, owner, time.monotonic(), self._total()
        with suppress(BrokenPipeError):  # result() reports the end of the process
            self.connection.send_bytes(message)

    def waited(self) -> float:
        """Return the time in s since the work was received."""
        return time.monotonic() - self.started

    def spent(self) -> float:
        """Return the processor time in s of the work so far."""
        return self._total() - self._before

    def _total(self) -> float:
        with suppress(OSError, EOFError):  # the process has ended
            while self._spending.poll():
                self._published = max(self._published, float(self._spending.recv_bytes()))
        # while compiled code holds the interpreter, the process publishes nothing
        return max(self._published, processor_time_of(self._process.pid))

    def result(self) -> Done:
        key, self.key = self.key, None
        try:
            value, self._published = pickle.loads(self.connection.recv_bytes())
            self._errors.forward()
        except Exception:  # the engine has ended the process, or used its connection
            code = self._exit_code()
            cause = "it closed its connection" if code is None else cause_of_end(code)
            said = self._errors.forward().strip().splitlines()
            self.end()
            reason = ": ".join([f"its process ended unexpectedly ({cause})", *said[-1:]])
            value = Failure(reason)
        return Done(key, value, self.waited(), self.spent())

    def end(self) -> None:
        self.dead = True
        if self._process.pid is not None and hasattr(os, "killpg"):
            with suppress(ProcessLookupError, PermissionError):  # it does not lead a group yet, or has ended
                os.killpg(self._process.pid, signal.SIGKILL)  # includes processes of an engine
        self._process.kill()  # compiled code may ignore weaker signals
        self._process.join()
        self._errors.close()
        self.connection.close()
        self._spending.close()

    def _exit_code(self) -> int | None:
        """Return the exit code of the process, None if it has none after ``FAREWELL``.

        ``join`` could block, because a process without open descriptors appears to have ended.
        """
        deadline = time.monotonic() + FAREWELL
        while self._process.exitcode is None and time.monotonic() < deadline:
            time.sleep(TICK)
        return self._process.exitcode


class _Errors:
    """The standard error of a process, which may be the only record of why it ended."""

    def __init__(self) -> None:
        self._file = tempfile.TemporaryFile()  # noqa: SIM115
        self._forwarded = 0

    @contextmanager
    def written(self) -> Iterator[None]:
        """Capture the standard error of processes started in this context, except on Windows."""
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
        """Forward the remaining text and close the file."""
        self.forward()
        self._file.close()

    def forward(self) -> str:
        size = os.fstat(self._file.fileno()).st_size
        if size == self._forwarded:
            return ""
        # Reading must not move the shared file position.
        new = os.pread(self._file.fileno(), size - self._forwarded, self._forwarded)
        self._forwarded += len(new)
        text = printable(new.decode(errors="replace"), MOST_ERRORS)
        if text and sys.stderr is not None:
            sys.stderr.write(text)
            sys.stderr.flush()
        return text


def _serve(connection: Connection, spending: Connection) -> None:
    ignored()  # only the main process handles Ctrl-C
    if hasattr(os, "setsid"):
        os.setsid()  # signals to the group of an engine's process stay there
    here = os.getpid()
    threading.Thread(target=_end_with_parent, daemon=True).start()
    threading.Thread(target=_publish, args=(spending,), daemon=True).start()
    sys.stdout = sys.stderr  # forwards the output of engines like their errors
    with suppress(OSError):  # closed by the caller
        os.dup2(STANDARD_ERROR, STANDARD_OUTPUT)
    try:
        while True:
            value = attempted(pickle.loads, connection.recv_bytes())
            if not isinstance(value, Failure):
                function, arguments = value
                value = attempted(function, *arguments)
            if os.getpid() != here:  # a copy that an engine has forked must not answer too
                os._exit(1)
            try:
                answer = pickle.dumps((value, processor_time()))
            except Exception as error:
                answer = pickle.dumps((Failure(f"cannot send its result back: {error}"), processor_time()))
            connection.send_bytes(answer)
    except EOFError:
        pass
    except OSError:  # an engine has closed the connection
        os._exit(1)


def _publish(spending: Connection) -> None:
    with suppress(OSError):  # an engine has closed the connection, or the parent has ended
        while True:
            spending.send_bytes(str(processor_time()).encode())
            time.sleep(LOOKS_EVERY)


def _end_with_parent() -> None:
    parent = multiprocessing.parent_process()
    if parent is not None:
        wait([parent.sentinel])
        os._exit(1)


def attempted(function: Callable[..., Any], *arguments: Any, **options: Any) -> Any:
    """Return the result of the call, or a ``Failure`` if it raises."""
    try:
        return function(*arguments, **options)
    except BaseException as error:  # including SystemExit, so the process survives
        return failure(error)


def failure(error: BaseException) -> Failure:
    """Return the message of an exception and its traceback, innermost location last."""
    lines = printable(error).strip().splitlines()
    # ValueError and RuntimeError carry sentences; others need their names
    named = not isinstance(error, (ValueError, RuntimeError)) or not lines
    reason = ": ".join(([type(error).__name__] if named else []) + lines[:1])
    if lacks_memory(error):
        reason = f"not enough memory ({reason})"
    frames = traceback.extract_tb(error.__traceback__)
    # file names only, because a report must not reveal folders
    where = tuple(f"{Path(frame.filename).name}:{frame.lineno} in {frame.name}" for frame in frames)
    return Failure(reason, tuple(line for line in where if not line.startswith("workers.py:")))


def lacks_memory(error: BaseException | None) -> bool:
    """Return whether an exception or one of its causes reports a lack of memory."""
    while error is not None:
        if isinstance(error, MemoryError) or getattr(error, "errno", None) == errno.ENOMEM:
            return True
        if any(words in printable(error) for words in NO_MEMORY):
            return True
        error = error.__cause__ or error.__context__
    return False


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
