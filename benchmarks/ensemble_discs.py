"""Ensembles of discs: this package's lanes compared with the same method in C, one trajectory at a time and in lanes.

Run with ``make -C benchmarks/limit && python benchmarks/ensemble_discs.py``; takes half a minute. All run on one
core to t = 100 s at a tolerance of 1e-9, from starts without any point coming to rest. They alternate, so other load
on the machine hardly affects their ratios. The last column is the largest difference of the end states.

Measured on a core with AVX-512, in ns per step of one trajectory:

| | C | C in lanes | here | C : here | C in lanes : here |
|---|---|---|---|---|---|
| ring, Figs. 8, 9, 11 | 800–930 | 127–141 | 147–177 | 4.8–5.9 | 0.76–0.88 |
| six points | 970–1020 | 92–129 | 115–169 | 5.7–8.6 | 0.67–0.95 |

Reasons for the method:

- Friction of the ring costs 4 ns per lane (always 7 means; a single trajectory 35 ns with as many as necessary), that
  of six points 4.4 ns, including cosine and sine of the angle.
- The error of a step across the rest of a point of the ring exceeds its estimate. With steps that end there, the
  largest error at t = 100 of Fig. 9 is 2e-9 instead of 2e-7, for the same number of steps.
- There are 16 lanes because the compiler unrolls loops over 8 before it vectorises them.
"""

from __future__ import annotations

import ctypes
import time
from dataclasses import replace
from pathlib import Path

import numpy as np
from rich.console import Console
from rich.table import Table

from compare.claims.parameters import FIG8, FIG9, FIG11
from reference_model.ensemble import simulate_ensemble
from reference_model.ensemble.core.stepping.runge_kutta import LOCAL
from reference_model.ensemble.disc.kernel import PARAMETERS
from reference_model.systems import DiscOnDisc, FloatArray

STARTS = 2000
UNTIL = 100.0
TOLERANCE = 1e-9
REPEATS = 3
LIMIT = Path(__file__).parent / "limit"


def starts(disc: DiscOnDisc) -> FloatArray:
    """Return random initial states, shape (n, 6), whose motions compiled code simulates without the reference."""
    rng = np.random.default_rng(8)
    states = np.zeros((STARTS, 6))
    states[:, 0], states[:, 3] = rng.uniform(-0.3, 0.5, STARTS), rng.uniform(-0.4, 0.4, STARTS)
    states[:, 5] = rng.uniform(0.0, 1.5, STARTS)
    if disc.contact_points is None:
        return states
    followed, _, _ = by_hand(disc, states, "disc")
    return states[np.all(np.isfinite(followed), axis=1)]


def by_hand(disc: DiscOnDisc, states: FloatArray, program: str) -> tuple[FloatArray, int, float]:
    """Return the end states by a C program, NaN if a point comes to rest, the number of steps and the time in s."""
    rows = np.ctypeslib.ndpointer(dtype=float, flags="C")
    library = ctypes.CDLL(str(LIMIT / f"{program}.so"))
    run = library.run_discs if program == "disc" else library.run_discs_in_lanes
    run.argtypes = [ctypes.c_int, rows, rows, ctypes.c_long, ctypes.c_double, ctypes.c_double, rows]
    run.restype = ctypes.c_long
    ends = np.empty_like(states)
    row = np.array([getattr(disc, name) for name in PARAMETERS])
    clock = time.process_time()
    steps = run(disc.contact_points or 0, row, states, len(states), UNTIL, LOCAL * TOLERANCE, ends)
    return ends, steps, time.process_time() - clock


def in_lanes(disc: DiscOnDisc, states: FloatArray) -> tuple[FloatArray, int, float]:
    """Return end states, number of steps and time in s of this package."""
    clock = time.process_time()
    found = simulate_ensemble(disc, states, duration=UNTIL, tolerance=TOLERANCE, early_end=False, threads=1)
    return found.states, int(found.steps.sum()), time.process_time() - clock


def main() -> None:
    """Print the table."""
    columns = ("C", "C in lanes", "here", "C : here", "C in lanes : here", "differences")
    table = Table(
        "disc", "contact", *columns, title="ns a step, ratios of times, largest differences of states"
    )
    for points in (None, 6):
        for name, paper in (("Fig. 8", FIG8), ("Fig. 9", FIG9), ("Fig. 11", FIG11)):
            disc = replace(paper, contact_points=points)
            states = starts(disc)
            in_lanes(disc, states[:32])  # compiles
            runs = [
                (by_hand(disc, states, "disc"), by_hand(disc, states, "disc_lanes"), in_lanes(disc, states))
                for _ in range(REPEATS)
            ]
            quickest = [min((run[i] for run in runs), key=lambda run: run[2]) for i in range(3)]
            here = quickest[-1]
            table.add_row(
                name,
                "ring" if points is None else f"{points} points",
                *(f"{1e9 * seconds / steps:.0f}" for _, steps, seconds in quickest),
                *(f"{np.median([run[i][2] / run[-1][2] for run in runs]):.2f}" for i in (0, 1)),
                ", ".join(f"{np.max(np.abs(other[0] - here[0])):.1e}" for other in quickest[:2]),
            )
    Console().print(table)


if __name__ == "__main__":
    main()
