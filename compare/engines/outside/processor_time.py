"""Processor time of this process and of the programs that it runs.

Unlike the time on a clock, it does not depend on other work of the machine.
"""

import ctypes
import functools
import os
import time
from collections.abc import Callable

PROGRAMS: set[int] = set()
"""Numbers of the running programs."""

IDLE = 0.02
"""Share of the time on a clock below which a process waits, or hangs."""


def processor_time() -> float:
    """Return the processor time in s of this process, of its ended child processes and of the ``PROGRAMS``."""
    times = os.times()
    ended = times.children_user + times.children_system
    return time.process_time() + ended + sum(map(processor_time_of, tuple(PROGRAMS)))


def processor_time_of(process: int | None) -> float:
    """Return the processor time in s of a process; 0 if it does not run, or if the system lacks such a clock."""
    if not process:
        return 0.0
    clock = ctypes.c_int()
    try:
        return time.clock_gettime(clock.value) if _clock_of()(process, ctypes.byref(clock)) == 0 else 0.0
    except (AttributeError, OSError, TypeError):  # no such function, for example on Windows and macOS
        return 0.0


@functools.cache
def _clock_of() -> Callable[..., int]:
    function: Callable[..., int] = ctypes.CDLL(None).clock_getcpuclockid
    return function


def is_over(limit: float, spent: float, waited: float) -> bool:
    """Return whether work has ``spent`` its ``limit`` of processor time, or hangs after having ``waited`` (s)."""
    return spent >= limit or (waited >= limit and spent < IDLE * waited)
