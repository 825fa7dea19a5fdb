"""Threads that end with the thread that waits for them."""

import ctypes
import threading
import time
from collections.abc import Callable
from concurrent.futures import Future, ThreadPoolExecutor, wait
from types import TracebackType
from typing import Any

LOOKS_EVERY = 0.05
"""Time in s between two chances for an exception that another thread has sent."""

AGAIN = 10
"""Number of looks before an exception is sent again, because callbacks of libraries may lose it."""


class Threads(ThreadPoolExecutor):
    """A pool that an exception in its context ends: waiting work is cancelled, running Python code is interrupted.

    Compiled code that releases the interpreter lock needs its own signal.
    """

    def __init__(self, count: int) -> None:
        super().__init__(count)
        self._at_work: set[int] = set()
        self._guard = threading.Lock()

    def submit(self, function: Callable[..., Any], /, *arguments: Any, **more: Any) -> Future[Any]:
        """Submit a call."""
        return super().submit(self._run, function, *arguments, **more)

    def result(self, future: Future[Any]) -> Any:
        """Return the result of a call as soon as it is known; raise its exception."""
        while not future.done():
            wait([future], LOOKS_EVERY)
        return future.result()

    def _run(self, function: Callable[..., Any], *arguments: Any, **more: Any) -> Any:
        try:
            with self._guard:
                self._at_work.add(threading.get_ident())
            return function(*arguments, **more)
        finally:
            with self._guard:
                self._at_work.discard(threading.get_ident())

    def _interrupt(self) -> None:
        with self._guard:  # so that no thread ends its work or begins new work meanwhile
            for thread in self._at_work:
                number, kind = ctypes.c_ulong(thread), ctypes.py_object(KeyboardInterrupt)
                ctypes.pythonapi.PyThreadState_SetAsyncExc(number, kind)

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        """Wait for all threads, after an exception as short as possible."""
        if kind is not None:
            self.shutdown(wait=False, cancel_futures=True)
            looks = 0
            # a thread that is interrupted before it notes the end of its work has ended
            while self._at_work & {thread.ident for thread in threading.enumerate()}:
                if looks % AGAIN == 0:
                    self._interrupt()
                looks += 1
                time.sleep(LOOKS_EVERY)
        super().__exit__(kind, error, trace)
