"""Ctrl-C and SIGTERM end a command soon, whatever code they meet.

Python raises an exception in the main thread, between two of its instructions. Foreign code may lose this exception,
and compiled code such as a compiler delays it.
"""

import atexit
import gc
import os
import signal
import socket
import sys
import threading
import time
import weakref
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from types import FrameType
from typing import Any, NoReturn

from compare.run.statuses import INTERRUPTED

SIGNALS = signal.SIGINT, signal.SIGTERM

LOOKS_EVERY = 0.1
"""Time in s between two looks at the exception."""

LONGEST, CLEANING = 1.0, 0.3
"""Longest time in s from a signal until the exception is caught, and of the cleaning after that."""

SHOW_CURSOR = "\x1b[?25h"
"""Control sequence after progress bars, which hide the cursor."""


class _Interrupt(KeyboardInterrupt):
    """Has weak references, unlike its base."""


class _Watch(threading.Thread):
    """Waits for the first signal, raises its exception again if it is lost, and ends the process if it is late."""

    numbers: socket.socket
    """Receives the numbers of signals at once, even while the main thread runs compiled code."""

    def __init__(self) -> None:
        super().__init__(daemon=True)
        self.came = self.caught = False
        self._error: Any = lambda: None

    def handle(self, number: int, frame: FrameType | None) -> NoReturn:
        gc.freeze()  # collecting the objects of an interrupted compiler would take seconds
        raise self._new()

    def _new(self) -> _Interrupt:  # a variable of ``handle`` would keep the exception alive
        self.came, error = True, _Interrupt()
        self._error = weakref.ref(error)
        return error

    def run(self) -> None:
        with self.numbers:
            while number := self.numbers.recv(1):  # nothing after the end of the context
                if number[0] in SIGNALS:
                    self._insist(number[0])

    def _insist(self, number: int) -> None:
        self.came, end = True, time.monotonic() + LONGEST
        while not self.caught:
            time.sleep(LOOKS_EVERY)
            if signal.getsignal(number) != self.handle:  # postponed
                end = time.monotonic() + LONGEST
            elif time.monotonic() > end:
                _end()
            elif self._error() is None and not self.caught:
                os.kill(os.getpid(), number)


_watch = _Watch()


def caught() -> None:
    """Note that the exception of a signal has been caught, so that the command may take its time to end."""
    _watch.caught = True


@contextmanager
def ending_soon() -> Iterator[None]:
    """Raise ``KeyboardInterrupt`` at Ctrl-C and SIGTERM in this context until it is :func:`caught`.

    If the main thread does not catch it in time, the process removes its temporary files and ends. Signals that the
    process ignores remain ignored.
    """
    global _watch
    _watch = _Watch()
    before = {number: signal.getsignal(number) for number in SIGNALS}
    for number, handler in before.items():
        if handler in (signal.SIG_DFL, signal.default_int_handler):
            signal.signal(number, _watch.handle)
    _watch.numbers, sender = socket.socketpair()
    sender.setblocking(False)
    others = signal.set_wakeup_fd(sender.fileno(), warn_on_full_buffer=False)
    sys.unraisablehook = _unraisable
    _watch.start()
    try:
        yield
    except BaseException as error:
        if not _watch.came and not isinstance(error, KeyboardInterrupt):
            raise
        for stream in (sys.stdout, sys.stderr):
            with suppress(Exception):  # nobody may read it
                stream.flush()
        if _watch.caught and isinstance(error, SystemExit) and isinstance(error.code, int):
            _end(error.code, "")
        _watch.caught = True
        _end()
    finally:
        signal.set_wakeup_fd(others)
        sender.close()
        for number, handler in before.items():
            signal.signal(number, handler)


def _unraisable(lost: Any) -> None:
    """Say nothing about a lost interrupt, which is raised again."""
    if not issubclass(lost.exc_type, KeyboardInterrupt):
        sys.__unraisablehook__(lost)


def _end(status: int = INTERRUPTED, message: str = "Interrupted.\n") -> NoReturn:
    """Remove temporary files, kill processes and end this process, without waiting for compiled code."""
    cleaning = threading.Thread(target=atexit._run_exitfuncs, daemon=True)
    cleaning.start()
    cleaning.join(CLEANING)
    with suppress(OSError):  # closed by the caller
        os.write(2, (SHOW_CURSOR * os.isatty(2) + message).encode())
    os._exit(status)


@contextmanager
def postponed() -> Iterator[None]:
    """Postpone Ctrl-C and SIGTERM to the end of this context; has no effect outside the main thread.

    Processes started in it block these signals, see :func:`ignored`.
    """
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    came: list[int] = []
    before = {number: signal.signal(number, lambda number, frame: came.append(number)) for number in SIGNALS}
    _mask("SIG_BLOCK")
    try:
        yield
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)
        _mask("SIG_UNBLOCK")
        if came:
            signal.raise_signal(came[0])


def ignored() -> None:
    """Ignore Ctrl-C in a process that was started while it was :func:`postponed`."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    _mask("SIG_UNBLOCK")


def _mask(how: str) -> None:
    if hasattr(signal, "pthread_sigmask"):  # not on Windows
        signal.pthread_sigmask(getattr(signal, how), SIGNALS)
