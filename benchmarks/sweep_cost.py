"""Cost per trajectory of a sweep, and total cost of the command.

Run with ``python benchmarks/sweep_cost.py``; takes a minute and writes its results into ``docs/sweeps.md``. Other
load on the machine increases the numbers, because two processes on one core slow each other down.
"""

from __future__ import annotations

import resource
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
from pages import write_into

from compare.claims.parameters import FIG5, FIG11
from reference_model.ensemble import EndState, Ensemble, simulate_ensemble
from reference_model.systems import FloatArray

LONG, SHORT = 12000.0, 300.0
"""Durations in s: the command's longest wait for an end state, and one too short to decide many of them."""

REPEATS = 3
COMMAND = 1_000_000
"""Number of random starts of the command."""


def starts(n: int, size: int, x: tuple[float, float], vx: tuple[float, float]) -> FloatArray:
    """Return random starts in the plane of x in m and of its velocity in m/s, shape (n, size)."""
    rng = np.random.default_rng(1)
    states = np.zeros((n, size))
    states[:, 0], states[:, size // 2] = rng.uniform(*x, n), rng.uniform(*vx, n)
    return states


def pins(n: int, loads: FloatArray | None = None) -> Ensemble:
    """Run starts in the basin of Fig. 5 on one core, optionally with individual ``loads`` in N."""
    varied = {} if loads is None else {"friction_force": loads[:n]}
    return simulate_ensemble(FIG5, PIN_STARTS[:n], duration=LONG, parameters=varied, threads=1)


def pins_to_the_end(n: int) -> Ensemble:
    """Run them for the full duration, even if their end states are certain."""
    return simulate_ensemble(FIG5, PIN_STARTS[:n], duration=SHORT, early_end=False, threads=1)


def discs(n: int, points: int | None, duration: float) -> Ensemble:
    """Run starts in the basin of Fig. 11 on one core."""
    disc = replace(FIG11, contact_points=points)
    return simulate_ensemble(disc, DISC_STARTS[:n], duration=duration, threads=1)


PIN_STARTS = starts(200_000, 4, (-0.3, 0.5), (-0.4, 0.4))
DISC_STARTS = starts(16_000, 6, (-0.1, 0.1), (-0.1, 0.1))
LOADS = FIG5.friction_force * np.random.default_rng(2).uniform(0.9, 1.1, 50_000)

WAYS: dict[str, tuple[int, Callable[[int], Ensemble]]] = {
    "pin, basin of Fig. 5": (200_000, pins),
    f"the same, each to t = {SHORT:g} s": (50_000, pins_to_the_end),
    "pin, load varied by up to 10 %": (50_000, lambda n: pins(n, LOADS)),
    f"disc on the continuous ring, basin of Fig. 11, t = {SHORT:g} s": (
        16_000,
        lambda n: discs(n, None, SHORT),
    ),
    "the same, until its outcome is certain": (2_000, lambda n: discs(n, None, LONG)),
    f"disc on six points, t = {SHORT:g} s": (8_000, lambda n: discs(n, 6, SHORT)),
}
"""Number of trajectories and function for each row."""


def cost(n: int, run: Callable[[int], Ensemble]) -> tuple[float, float]:
    """Return the least processor time per trajectory in µs, and the share of certain end states."""
    run(64)  # loads compiled code
    spent = []
    for _ in range(REPEATS):
        began = time.process_time()
        found = run(n)
        spent.append(time.process_time() - began)
    return 1e6 * min(spent) / n, 1.0 - float(np.mean(found.end == EndState.UNDECIDED))


def command() -> tuple[float, float]:
    """Return the command's processor time in s, on all cores, and its disk space per trajectory in bytes."""
    with tempfile.TemporaryDirectory() as folder:
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        sweep = ["sweep", "basin", "pin", "--random", str(COMMAND), "--output", folder]
        subprocess.run([sys.executable, "-m", "compare.cli", *sweep], stdout=subprocess.DEVNULL, check=True)
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        size = sum(path.stat().st_size for path in Path(folder).rglob("*") if path.is_file())
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime, size / COMMAND


def main() -> None:
    """Measure, print and write."""
    lines = ["| | µs of one core per trajectory | decided |", "|---|---|---|"]
    for name, (n, run) in WAYS.items():
        each, certain = cost(n, run)
        lines.append(f"| {name} | {each:.{0 if each >= 10.0 else 1}f} | {100.0 * certain:.0f} % |")
    spent, disk = command()
    lines += [
        "",
        f"`friction-discs sweep basin pin --random {COMMAND}` takes {spent:.0f} s of processor time on "
        "all cores together. This includes loading the libraries and the compiled code, the check by the plain "
        f"reference, and writing and drawing the results. It takes {disk:.0f} bytes of disk per trajectory.",
    ]
    text = "\n".join(lines) + "\n"
    print(text)
    write_into("sweeps.md", "sweep_cost.py", text)


if __name__ == "__main__":
    main()
