"""Ensembles of pins: this package compared with handwritten C and with libraries, on the basin of Fig. 5.

Run with ``make -C benchmarks/limit && python benchmarks/ensemble.py``; takes about two minutes and reports missing
libraries. All run on all processors, to t = 300 s unless a trajectory may end early, at a tolerance of 1e-9 per step.

Measured on two cores with AVX-512. Rates are by processor time; ratios are more reproducible than rates:

| way | trajectories/s | |
|---|---|---|
| handwritten C, the same scheme, FMA | 96,000 | the limit |
| this package, full length | 87,000 | 0.90 of it |
| this package, early end | 278,000 | 3.2 times that |
| heyoka, regularised law | 1,800 | |
| CyRK, regularised law | 750 | |
| numbalsoda, regularised law | 4,000 | measured once elsewhere; it needs a Fortran compiler |

Reasons for the scheme, in numbers per core:

- Exact Coulomb friction in stretched time dτ = dt·(s + s₀)/s takes 730 steps per trajectory, uses one right-hand side
  for fast and slow slip, and has an error of 1.5e-8 at t = 100. We chose s₀ = g·T/2 (T/4: 716 steps, but stiffer
  starts of slip, T: 759, 2T: 833, 4T: 902).
- A step costs 25 ns per lane with 16 lanes, 29 ns with 8, 25 ns with 32, and about 200 ns for a single trajectory.
- On some processors with 512-bit vectors, compilers use only 256 bits. Compiled for one of them, emulated by
  ``NUMBA_CPU_NAME=icelake-server``, pins at full length reach 0.51 of handwritten C, and 0.88 with 512 bits, with
  identical results. If the compiler prefers 512 bits itself, they reach 0.89. So the widest vectors are always used.
- Contraction to FMA would save 12 %, but workers with and without FMA would give different results; it is off.
- The exact law in handwritten C computes 52,000/s per core; the regularised law, with DOP853 and Rodas5P, 37,000/s.
"""

from __future__ import annotations

import ctypes
import importlib.util
import math
import os
import time
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy as np
from rich.console import Console
from rich.table import Table

from compare.claims.parameters import FIG5
from reference_model.ensemble import simulate_ensemble
from reference_model.ensemble.core.stepping.runge_kutta import LOCAL
from reference_model.ensemble.task import CHUNK
from reference_model.systems import FloatArray

STARTS = 20_000
MILLION = 1_000_000
UNTIL = 300.0
TOLERANCE = 1e-9
"""Tolerance of a step; that of an ensemble is ten times larger."""
REPEATS = 3
THREADS = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
LIMIT = Path(__file__).parent / "limit" / "pin.so"
LIBRARY_STARTS = 500
"""Number of starts for libraries, whose cost per trajectory is constant."""

Way = Callable[[FloatArray], object]


def starts(n: int) -> FloatArray:
    """Return initial states for Fig. 5: x0 in [−0.3, 0.5], vx0 in [−0.4, 0.4], shape (n, 4)."""
    rng = np.random.default_rng(5)
    x, vx = rng.uniform(-0.3, 0.5, n), rng.uniform(-0.4, 0.4, n)
    return np.column_stack((x, np.zeros(n), vx, np.zeros(n)))


def full_length(states: FloatArray) -> object:
    """Run this package to the end."""
    return simulate_ensemble(FIG5, states, duration=UNTIL, tolerance=TOLERANCE / LOCAL, early_end=False)


def early_end(states: FloatArray) -> object:
    """Run this package until the end states are certain."""
    return simulate_ensemble(FIG5, states, duration=UNTIL, tolerance=TOLERANCE / LOCAL)


def by_hand() -> Way | None:
    """Return the C program; None if it has not been built."""
    if not LIMIT.exists():
        return None
    rows = np.ctypeslib.ndpointer(dtype=float, flags="C")
    run = ctypes.CDLL(str(LIMIT)).run_pins
    run.argtypes = [rows, rows, ctypes.c_long, ctypes.c_long, ctypes.c_double, ctypes.c_double, rows]
    run.restype = None
    pin = np.array(
        [FIG5.mass, FIG5.stiffness, FIG5.damping, FIG5.friction_force, FIG5.disc_speed, FIG5.offset]
    )

    def simulate(states: FloatArray) -> FloatArray:
        ends = np.empty_like(states)
        n = len(states)
        with ThreadPoolExecutor(THREADS) as pool:
            list(
                pool.map(
                    lambda first: run(pin, states, first, min(first + CHUNK, n), UNTIL, TOLERANCE, ends),
                    range(0, n, CHUNK),
                )
            )
        return ends

    return simulate


def _rates(x: float, y: float, vx: float, vy: float) -> tuple[float, float, float, float]:
    """Return the rates of eq. 1 with the law v/√(v² + ε²), ε = 1e-6 m/s; no library supports the set-valued law."""
    wx, wy = vx + 1.5 * y, vy - 1.5 * x
    f = 0.09 / math.sqrt(wx * wx + wy * wy + 1e-12)
    return vx, vy, 0.1 - x - 0.1 * vx - f * wx, -y - 0.1 * vy - f * wy


def with_cyrk() -> Way:
    """Return a function that runs CyRK's DOP853, compiled."""
    import numba
    from CyRK import nbsolve_ivp

    rates = numba.njit(_rates)

    @numba.njit  # type: ignore[untyped-decorator]
    def function(t, u):  # type: ignore[no-untyped-def]
        return np.array(rates(u[0], u[1], u[2], u[3]))

    @numba.njit(parallel=True)  # type: ignore[untyped-decorator]
    def simulate(states):  # type: ignore[no-untyped-def]
        ends = np.empty_like(states)
        for i in numba.prange(len(states)):
            solution = nbsolve_ivp(
                function, (0.0, UNTIL), states[i], rk_method=2, rtol=TOLERANCE, atol=TOLERANCE, warnings=False
            )
            ends[i] = solution.y[:, -1]
        return ends

    simulate(starts(2))
    return simulate  # type: ignore[no-any-return]


def with_heyoka() -> Way:
    """Return a function that runs heyoka's Taylor series in batches of eight, compiled, in threads."""
    import heyoka as hy

    x, y, vx, vy = hy.make_vars("x", "y", "vx", "vy")
    wx, wy = vx + 1.5 * y, vy - 1.5 * x
    f = 0.09 / hy.sqrt(wx * wx + wy * wy + 1e-12)
    system = [(x, vx), (y, vy), (vx, 0.1 - x - 0.1 * vx - f * wx), (vy, -y - 0.1 * vy - f * wy)]
    batch = 8
    pattern = hy.taylor_adaptive_batch(system, np.zeros((4, batch)), tol=TOLERANCE)

    def simulate(states: FloatArray) -> None:
        def part(eight: FloatArray) -> None:
            integrator = pattern.__copy__()
            integrator.set_time(0.0)
            integrator.state[:] = eight.T
            integrator.propagate_until(UNTIL)

        with ThreadPoolExecutor(THREADS) as pool:
            list(pool.map(part, states[: len(states) // batch * batch].reshape(-1, batch, 4)))

    return simulate


LIBRARIES = {"CyRK": with_cyrk, "heyoka": with_heyoka}


def seconds(way: Way, states: FloatArray) -> float:
    """Return the shortest processor time of a few runs per thread, in s, which other processes hardly affect."""
    times = []
    for _ in range(REPEATS):
        began = time.process_time()
        way(states)
        times.append(time.process_time() - began)
    return min(times) / THREADS


def main() -> None:
    """Print the tables."""
    console = Console()
    table = Table(title=f"{STARTS:,} starts of Fig. 5 to t = {UNTIL:g} s, {THREADS} threads")
    for column in ("way", "trajectories/s", "of C by hand", "of this at full length"):
        table.add_column(column, justify="left" if column == "way" else "right")
    states = starts(STARTS)
    limit = by_hand()
    full_length(states[:100])  # compiled, or loaded
    rates = {}
    if limit is None:
        console.print("C by hand is not built: make -C benchmarks/limit")
    else:
        rates["C by hand"] = STARTS / seconds(limit, states)
    rates["full length"] = STARTS / seconds(full_length, states)
    rates["early end"] = STARTS / seconds(early_end, states)
    for name, prepare in LIBRARIES.items():
        if importlib.util.find_spec(name) is None:
            console.print(f"{name} is not installed")
            continue
        rates[name] = LIBRARY_STARTS / seconds(prepare(), states[:LIBRARY_STARTS])
    for name, rate in rates.items():
        shares = [
            f"{rate / rates[base]:.2f}" if base in rates else "" for base in ("C by hand", "full length")
        ]
        table.add_row(name, f"{rate:,.0f}", *shares)
    console.print(table)

    began, spent = time.perf_counter(), time.process_time()
    early_end(starts(MILLION))
    took, spent = time.perf_counter() - began, (time.process_time() - spent) / THREADS
    console.print(f"{MILLION:,} starts with early end: {took:.1f} s; {spent:.1f} s on processors of its own")
    if limit is not None:
        ours = simulate_ensemble(
            FIG5, states, duration=UNTIL, tolerance=TOLERANCE / LOCAL, early_end=False
        ).states
        theirs = limit(states)
        difference = float(np.median(np.max(np.abs(ours - theirs), axis=1)))
        console.print(f"median difference from C by hand at the end: {difference:.1e}")


if __name__ == "__main__":
    main()
