"""Processor time of this process and of the programs that it runs.

Unlike the time on a clock, it does not depend on other work of the machine.
"""

import ctypes
import os
import time

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
        unknown = ctypes.CDLL(None).clock_getcpuclockid(process, ctypes.byref(clock))
        return 0.0 if unknown else time.clock_gettime(clock.value)
    except (AttributeError, OSError, TypeError):  # no such function, for example on Windows and macOS
        return 0.0


def is_over(limit: float, spent: float, waited: float) -> bool:
    """Return whether work has ``spent`` its ``limit`` of processor time, or hangs after having ``waited`` (s)."""
    return spent >= limit or (waited >= limit and spent < IDLE * waited)
