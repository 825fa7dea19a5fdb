"""Processor time of the report or of the tests, by study and engine or test file, and by cause.

Run with ``python benchmarks/where_time_goes.py report [STUDY ...]`` or ``... tests [PATH ...]``, with an empty
``NUMBA_CACHE_DIR`` to measure a first run on a machine. Everything runs sequentially in one process; child processes
count as a whole. The stack is sampled every 10 ms of processor time. A sample is weighted by the time since the last
one, so long calls into compiled code (Exudyn's solver, LLVM) count for their callers.
"""

from __future__ import annotations

import resource
import signal
import sys
import time
from collections import defaultdict
from collections.abc import Iterator
from contextlib import contextmanager
from types import FrameType

import pytest

INTERVAL = 0.01  # s of processor time
LARGEST = 40  # rows shown

FIRST = {
    "compilation": ("/numba/core/", "/numba/np/", "/llvmlite/"),
    "imports": ("<frozen importlib._bootstrap>",),
}
"""Causes that count anywhere in the stack, by parts of file names."""

INNERMOST = {
    "drawing": ("/matplotlib/", "/PIL/"),
    "ensembles and compiled runs": ("/reference_model/ensemble/",),
    "reference: orbits and steady motions": ("/reference_model/orbits/", "/reference_model/steady/"),
    "plain reference": ("/reference_model/",),
    "Exudyn": ("/exudyn_models/", "/exudyn/"),
    "page": ("/jinja2/", "/compare/report/"),
    "studies' own": ("/compare/studies/", "/compare/claims/"),
    "the rest of compare": ("/compare/",),
}
"""Causes that count for the innermost matching frame, by parts of file names."""


class Clock:
    """Processor time in s by cause and by a key set with ``count_for``."""

    def __init__(self) -> None:
        self.seconds: dict[tuple[str, str], float] = defaultdict(float)
        self._key = ""
        self._last = time.process_time()
        self._children = _of_children()

    @contextmanager
    def running(self) -> Iterator[None]:
        """Sample the stack within this context."""
        before = signal.signal(signal.SIGPROF, self._sample)
        signal.setitimer(signal.ITIMER_PROF, INTERVAL, INTERVAL)
        try:
            yield
        finally:
            signal.setitimer(signal.ITIMER_PROF, 0.0)
            signal.signal(signal.SIGPROF, before)

    def count_for(self, key: str) -> None:
        """Count the following time for ``key``."""
        self._sample(0, sys._getframe())
        children = _of_children()
        self.seconds[self._key, "other processes"] += children - self._children
        self._key, self._children = key, children

    def _sample(self, _: int, frame: FrameType | None) -> None:
        now = time.process_time()
        self.seconds[self._key, _cause(frame)] += now - self._last
        self._last = now


def _of_children() -> float:
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def _cause(frame: FrameType | None) -> str:
    files = []
    while frame is not None:
        files.append(frame.f_code.co_filename)
        frame = frame.f_back
    for cause, parts in FIRST.items():
        if any(part in file for file in files for part in parts):
            return cause
    for file in files:
        for cause, parts in INNERMOST.items():
            if "/tests/" not in file and any(part in file for part in parts):
                return cause
    return "all else"


def report(clock: Clock, names: list[str]) -> None:
    """Measure and draw all studies, or those with these names."""
    clock.count_for("imports")
    from compare.claims.errata import ERRATA
    from compare.engines import engines
    from compare.run.runner import Run, drawn, measured
    from compare.studies import STUDIES

    studies = tuple(study for study in STUDIES if not names or study.name in names)
    by_name = {engine.name: engine for engine in engines([])}
    run = Run(studies, tuple(by_name), contact_only=tuple(e.name for e in by_name.values() if e.contact_only))
    for study in studies:
        for column in run.columns(study):
            clock.count_for(f"{study.name} {column}")
            run.outcomes[study.name, column] = measured(study, by_name.get(column))
        clock.count_for(f"{study.name} figures")
        drawn(study, run.data(study))
    for erratum in () if names else ERRATA:
        clock.count_for("errata")
        erratum.evidence()


class Files:
    """A pytest plugin that passes the current test file to the clock."""

    def __init__(self, clock: Clock) -> None:
        self._clock = clock

    def pytest_runtest_logstart(self, nodeid: str) -> None:
        """Count the following time for the test's own file, not for that of an inherited harness."""
        self._clock.count_for(nodeid.partition("::")[0])


def table(seconds: dict[str, float]) -> str:
    """Return rows of times in s, the largest first."""
    rows = sorted(seconds.items(), key=lambda row: -row[1])
    shown = [*rows[:LARGEST], *([("the rest", sum(s for _, s in rows[LARGEST:]))] if rows[LARGEST:] else [])]
    return "\n".join(f"{spent:9.1f}  {name}" for name, spent in [*shown, ("all", sum(seconds.values()))])


def main() -> None:
    """Run the report or the tests; print both tables."""
    what, *names = sys.argv[1:] or ["report"]
    clock = Clock()
    began = time.perf_counter()
    with clock.running():
        if what == "tests":
            pytest.main(["-q", "-p", "no:xdist", *names], plugins=[Files(clock)])
        else:
            report(clock, names)
        clock.count_for("")
    taken = time.perf_counter() - began
    by_key: dict[str, float] = defaultdict(float)
    by_cause: dict[str, float] = defaultdict(float)
    for (key, cause), spent in clock.seconds.items():
        by_key[key] += spent
        by_cause[cause] += spent
    print(f"\nProcessor time in s, of {taken:.1f} s on the clock\n\n{table(by_cause)}\n\n{table(by_key)}")


if __name__ == "__main__":
    main()
