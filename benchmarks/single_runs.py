"""Time saved by ``simulate(..., compiled=True)`` on single motions.

Run with ``python benchmarks/single_runs.py``; takes about 30 s, more if the core is not compiled yet. Times are
the shortest processor times of several calls, in ms, at a tolerance of 1e-9.

Measured on a core with AVX-512:

| motion | requested times | in Python, ms | compiled, ms | ratio |
|---|---|---|---|---|
| Fig. 5, sticks nine times, to t = 500 s | 2 | 262 | 2.28 | 115 |
| | 501 | 409 | 2.66 | 154 |
| | 5,001 | 928 | 3.96 | 234 |
| Fig. 11, ring, to t = 100 s | 2 | 18.3 | 0.38 | 48 |
| | 501 | 71.2 | 0.54 | 131 |
| | 5,001 | 177 | 0.86 | 206 |
| the same with a hard stop | 5,001 | 177 | 0.90 | 197 |
| Fig. 11, six points, to t = 100 s | 2 | 32.3 | 0.66 | 49 |
| | 501 | 91.3 | 0.86 | 107 |
| | 5,001 | 199 | 1.19 | 168 |
| the same, starting with a point at rest | 501 | 371 | 2.42 | 153 |
"""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import replace
from functools import partial
from typing import NamedTuple

import numpy as np
from rich.console import Console
from rich.table import Table

from compare.claims.parameters import FIG5, FIG5_STARTS, FIG11
from reference_model import simulate
from reference_model.systems import System


class Motion(NamedTuple):
    """A system, its initial state and the duration in s."""

    system: System
    start: tuple[float, ...]
    duration: float


SLIPPING, STUCK = (
    (0.1, 0.0, 0.0, 0.0, 0.0, 1.0),
    (0.1, 0.0, 0.0, 0.0, 0.1 * FIG11.disc_speed, FIG11.disc_speed),
)
SIX = replace(FIG11, contact_points=6)
HARD = replace(FIG11, hardening=2.0, stop_gap=0.3, stop_stiffness=5.0)
MOTIONS = {
    "Fig. 5, sticks nine times": Motion(FIG5, tuple(FIG5_STARTS.values())[1], 500.0),
    "Fig. 11, ring": Motion(FIG11, SLIPPING, 100.0),
    "the same with a hard stop": Motion(HARD, SLIPPING, 100.0),
    "Fig. 11, six points": Motion(SIX, SLIPPING, 100.0),
    "Fig. 11, a point at rest": Motion(SIX, STUCK, 100.0),
}
TIMES = 2, 501, 5001
SPENT = 1.0
"""Total time of the calls in s."""


def milliseconds(call: Callable[[], object]) -> float:
    """Return the shortest processor time of a warm call."""
    call()
    times: list[float] = []
    while sum(times) < SPENT:
        began = time.process_time()
        call()
        times.append(time.process_time() - began)
    return 1e3 * min(times)


def main() -> None:
    """Print the table."""
    table = Table(title="One motion at a tolerance of 1e-9")
    for column in ("motion", "times", "in Python, ms", "compiled, ms", "ratio"):
        table.add_column(column, justify="left" if column == "motion" else "right")
    for name, (system, start, duration) in MOTIONS.items():
        for n in TIMES:
            times = np.linspace(0.0, duration, n)
            plain = milliseconds(partial(simulate, system, start, times, compiled=False))
            fast = milliseconds(partial(simulate, system, start, times, compiled=True))
            table.add_row(name, f"{n:,}", f"{plain:.1f}", f"{fast:.2f}", f"{plain / fast:.0f}")
    Console().print(table)


if __name__ == "__main__":
    main()
