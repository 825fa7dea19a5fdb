"""A program that answers questions line by line until this process ends.

A program that does not answer in time, or answers nonsense, is ended, and the next question starts a new process.
"""

from __future__ import annotations

import atexit
import multiprocessing
import os
import shutil
import signal
import subprocess
import threading
import time
from collections.abc import Sequence
from contextlib import suppress
from pathlib import Path
from typing import IO

from numpy.typing import ArrayLike

from compare.engines.outside.commands import own_name
from compare.engines.outside.json_lines import (
    BadLineError,
    Greeting,
    RefusedError,
    answered,
    greeting,
    most_bytes,
    question,
)
from compare.engines.outside.processor_time import PROGRAMS, is_over, processor_time_of
from compare.output.outside_text import cause_of_end, printable
from reference_model.systems.joint import AnySystem
from reference_model.trajectory import Trajectory

GREETING_LIMIT = 60.0  # time limit in s for the first line; includes compilation
GREETING_BYTES = 100_000
TICK = 0.1  # shortest time in s between two looks at a program's processor time
FAREWELL = 1.0  # time in s for a program to end after its input is closed
AT_ONCE = 1 << 18
LAST_LINES, LAST_BYTES = 3, 4000  # lines shown and bytes kept of a program's standard error
POSIX = os.name == "posix"

END_WITH_US = 'read -r _; kill -s KILL -- "-$0"'
"""Shell command that kills the program when its standard input ends, because this process ended or was killed."""


class ProgramError(RuntimeError):
    """A program did not answer; the message says why, with its last lines of standard error."""


def simulate(
    command: tuple[str, ...],
    folder: str,
    system: AnySystem,
    state: ArrayLike,
    times: ArrayLike,
    **accuracy: float,
) -> Trajectory:
    """Return the motion computed by the program ``command``, which is started in ``folder`` if necessary.

    Raises ``UnsupportedSystemError``, ``OSError`` if the program cannot be started, and ``ProgramError``.
    """
    conversation = conversation_with(command, folder)
    line = conversation.ask(question(system, state, times, accuracy), most_bytes(system, times))
    try:
        return answered(line, system, times)
    except RefusedError as error:
        raise ProgramError(conversation.sentence(f"says: {error}")) from None
    except BadLineError as error:
        conversation.end()
        raise ProgramError(conversation.sentence(str(error))) from None


def greeting_of(command: tuple[str, ...], folder: str) -> Greeting:
    """Return the program's greeting; raise ``ValueError`` if it is missing."""
    check_command(command, folder)
    try:
        return conversation_with(command, folder).greeting
    except OSError as error:
        raise ValueError(f"{command[0]} cannot be started: {error.strerror}") from None
    except ProgramError as error:
        raise ValueError(str(error)) from None


def check_command(command: tuple[str, ...], folder: str) -> None:
    """Raise ``ValueError`` unless the program exists and is executable."""
    program = command[0]
    if os.path.dirname(program):
        found = Path(folder, program)
        reason = (
            "" if os.access(found, os.X_OK) else "not executable" if found.exists() else "command not found"
        )
        reason = "this is a folder, not a program" if found.is_dir() else reason
    else:
        reason = "" if shutil.which(program) else "command not found in PATH"
        if reason and Path(folder, program).is_file():
            reason += f"; use ./{program} for the program in this folder"
    if reason:
        raise ValueError(f"{program}: {reason}")


_OPEN: dict[tuple[int, tuple[str, ...], str], Conversation] = {}


def conversation_with(command: tuple[str, ...], folder: str) -> Conversation:
    """Return this process's conversation with the program; start a new conversation if the last has ended."""
    key = os.getpid(), command, folder  # a forked process needs its own
    found = _OPEN.get(key)
    if found is None or found.over:
        found = _OPEN[key] = Conversation(command, folder)
    return found


@atexit.register
def end_all() -> None:
    """End all programs that this process has started."""
    for (process, _, _), conversation in list(_OPEN.items()):
        if process == os.getpid():
            conversation.end(FAREWELL)
    _OPEN.clear()


class Conversation:
    """One process of a program in a working directory."""

    def __init__(self, command: Sequence[str], folder: str) -> None:
        self._name = own_name(command)
        self.over = False
        self._asking = threading.Lock()
        # Its own session: Ctrl-C does not reach the program, and its children can be ended with it.
        self._process = subprocess.Popen(
            command,
            cwd=folder,
            env=_environment(),
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            bufsize=0,
            start_new_session=True,
        )
        streams = self._process.stdin, self._process.stdout, self._process.stderr
        self._input, self._output, errors = (stream for stream in streams if stream is not None)
        PROGRAMS.add(self._process.pid)
        self._guard = _guard_of(self._process.pid) if POSIX else None
        self._errors = _LastWords(errors)
        try:
            self.greeting = greeting(self._exchanged(b"", GREETING_BYTES, GREETING_LIMIT, "greeting"))
        except ValueError as error:
            self.end()
            raise ProgramError(self.sentence(str(error))) from None

    def ask(self, line: bytes, most: int) -> bytes:
        """Write ``line`` and return the answer, a line of at most about ``most`` bytes."""
        with self._asking:
            return self._exchanged(line, most, self.greeting.limit, "answer")

    def sentence(self, what: str) -> str:
        """Return a sentence of the program's name, ``what``, and the end of its standard error."""
        said = self._errors.text(ended=self.over)
        return f"{self._name} {what}" + (f"; its standard error ends with: {said}" if said else "")

    def end(self, patience: float = 0.0) -> None:
        """Close the program's input, and kill it if it does not end within ``patience`` (s)."""
        if self.over:
            return
        self.over = True
        with suppress(OSError):
            self._input.close()
        if patience > 0.0:
            with suppress(subprocess.TimeoutExpired):
                self._process.wait(patience)
        self._kill()
        PROGRAMS.discard(self._process.pid)  # from now on, its time counts as the time of an ended process
        self._process.wait()
        self._output.close()
        if self._guard is not None:
            self._guard.kill()
            self._guard.communicate()

    def _kill(self) -> None:
        with suppress(OSError):
            if POSIX:
                os.killpg(self._process.pid, signal.SIGKILL)
            else:
                self._process.kill()

    def _exchanged(self, line: bytes, most: int, limit: float, what: str) -> bytes:
        """Write ``line`` and return the next line; end the program unless it writes exactly one line."""
        here, late = threading.Event(), threading.Event()
        began, before = time.monotonic(), processor_time_of(self._process.pid)

        def spent() -> float:
            return processor_time_of(self._process.pid) - before

        def watched() -> None:
            while not here.wait(min(max(TICK, limit - spent()), threading.TIMEOUT_MAX)):
                if is_over(limit, spent(), time.monotonic() - began):
                    late.set()
                    self._kill()
                    return

        watch = threading.Thread(target=watched, daemon=True)
        watch.start()
        try:
            with suppress(BrokenPipeError):  # _read detects the end of the program
                _write(self._input, line)
            answer = _read(self._output, most)
        except BaseException:  # e.g. Ctrl-C; a late answer would count as the next one
            self.end()
            raise
        finally:
            here.set()
        watch.join()
        in_time = not late.is_set()
        if answer.endswith(b"\n") and in_time and answer.count(b"\n") == 1:
            return answer
        if not in_time:
            why = f"gave no {what} within {limit:g} s"
        elif len(answer) > most:
            why = f"wrote {len(answer)} bytes as its {what} without a newline"
        elif b"\n" in answer:
            why = f"wrote more than one line as its {what}"
        else:
            why = f"ended without {what} ({self._cause()})"
        self.end()
        raise ProgramError(self.sentence(why))

    def _cause(self) -> str:
        try:
            code = self._process.wait(FAREWELL)
        except subprocess.TimeoutExpired:
            return "it closed its output"
        return cause_of_end(code)


def _environment() -> dict[str, str]:
    """Return this process's environment without a variable of workers."""
    environment = dict(os.environ)
    if multiprocessing.parent_process() is not None:
        environment.pop("PYTHONSAFEPATH", None)  # a Python program may import from its folder
    return environment


def _guard_of(group: int) -> subprocess.Popen[bytes]:
    """Start a process that kills the processes of ``group`` after the end of this process."""
    return subprocess.Popen(
        ("/bin/sh", "-c", END_WITH_US, str(group)),
        stdin=subprocess.PIPE,
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
        start_new_session=True,
    )


def _write(stream: IO[bytes], line: bytes) -> None:
    """Write all of ``line``; a pipe may accept less at once."""
    rest = memoryview(line)
    while rest:
        rest = rest[stream.write(rest) :]


def _read(stream: IO[bytes], most: int) -> bytes:
    """Return a line, the rest of the stream, or slightly more than ``most`` bytes."""
    parts: list[bytes] = []
    length = 0
    while length <= most:
        part = stream.read(AT_ONCE)
        parts.append(part)
        length += len(part)
        if not part or b"\n" in part:
            break
    return b"".join(parts)


class _LastWords:
    """Thread that reads a program's standard error and keeps the end."""

    def __init__(self, stream: IO[bytes]) -> None:
        self._stream = stream
        self._kept = b""
        self._reader = threading.Thread(target=self._run, daemon=True)
        self._reader.start()

    def text(self, *, ended: bool) -> str:
        """Return the last lines as one line; if the program has ``ended``, wait for the rest."""
        if ended:
            self._reader.join(FAREWELL)  # other processes may hold the stream open
        lines = self._kept.decode(errors="replace").split("\n")
        return printable(" / ".join([line.strip() for line in lines if line.strip()][-LAST_LINES:]))

    def _run(self) -> None:
        with self._stream:
            while part := self._stream.read(AT_ONCE):
                self._kept = (self._kept + part)[-LAST_BYTES:]
