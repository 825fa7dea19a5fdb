"""Overhead of a Dask cluster in a sweep of random starts of Fig. 5, and memory of the command.

Run with ``python benchmarks/sweep_cluster.py``; takes fifteen minutes on two cores and writes the throughputs into
``docs/sweeps.md``. Needs the extra ``cluster``. Throughputs are per processor time of all processes, because wall
times are not comparable under other load.
"""

from __future__ import annotations

import subprocess
import sys
import tempfile
from pathlib import Path

import psutil
from distributed import LocalCluster
from pages import write_into

from compare.claims.parameters import FIG5
from compare.cli.options import cores
from compare.sweep.compute.executors import Cluster, Executor, InProcess
from compare.sweep.compute.run import run
from compare.sweep.plan import RandomBasin
from compare.sweep.quantities import Axis
from compare.sweep.store import SweepStore

ROOT = Path(__file__).parents[1]

SWEEPS = ((50, 2000), (306, 32768))
"""Numbers of chunks and of starts per chunk; the last is a sweep of ten million."""

LARGE = (1_000_000, 10_000_000)
"""Numbers of trajectories in the sweeps for the command's memory."""

NODES, CORES, PROJECTED = 64, 64, 10**9

MEASURED = """
import re, sys, time
from compare.cli import app
status = app.status(sys.argv[1:])
print(re.search(r"VmHWM:\\s+(\\d+)", open("/proc/self/status").read())[1], time.process_time())
sys.exit(status)
"""
"""The command, which prints its own memory; the value reported to its parent would include the parent's."""


def plan_of(samples: int) -> RandomBasin:
    """Return a plan with random starts in the basin of Fig. 5."""
    return RandomBasin(
        system=FIG5,
        duration=300.0,
        tolerance=1e-9,
        seed=1,
        start=(0.0, 0.0, 0.0, 0.0),
        x=Axis("x", -0.3, 0.5, 2),
        y=Axis("vx", -0.4, 0.4, 2),
        samples=samples,
    )


def cost(executor: Executor, chunks: int, size: int) -> float:
    """Return the total processor time in s of a sweep of ``chunks`` of ``size``, written and labelled."""
    with tempfile.TemporaryDirectory() as folder:
        store = SweepStore.create(Path(folder) / "sweep.zarr", plan_of(chunks * size), size)
        before = used()
        run(store, executor, lambda what, done, total: None)
        return used() - before


def used() -> float:
    """Return the processor time in s of this process, which is also the scheduler's, and of the workers."""
    here = psutil.Process()
    times = [process.cpu_times() for process in (here, *here.children(recursive=True))]
    return sum(time.user + time.system for time in times)


def memory(scheduler: str | None, samples: int) -> tuple[float, float]:
    """Return the peak memory of the command in MB, and its own processor time in s."""
    with tempfile.TemporaryDirectory() as folder:
        more = [] if scheduler is None else ["--scheduler", scheduler]
        command = ["sweep", "basin", "pin", "--random", str(samples), "--output", folder, *more]
        process = subprocess.run(
            [sys.executable, "-c", MEASURED, *command],
            stdout=subprocess.PIPE,
            text=True,
            check=True,
            cwd=ROOT,
        )
        kilobytes, seconds = process.stdout.splitlines()[-1].split()
        return float(kilobytes) / 1000.0, float(seconds)


def measured() -> tuple[str, str]:
    """Return the table of throughputs for docs/sweeps.md, and the memory of the command with a projection."""
    lines = [
        f"On {cores()} workers, with starts of Fig. 5, in total processor seconds:",
        "",
        "| chunks | starts per chunk | in process | workers | throughput |",
        "|---|---|---|---|---|",
    ]
    with (
        LocalCluster(n_workers=cores(), threads_per_worker=1, dashboard_address=None) as local,
        Cluster(local.scheduler_address) as cluster,
    ):
        executors = (InProcess(), cluster)
        for executor in executors:  # compile or load the kernels in all processes
            cost(executor, 50, 10)
        for chunks, size in SWEEPS:
            here, there = (cost(executor, chunks, size) for executor in executors)
            lines.append(f"| {chunks} | {size:,} | {here:.1f} s | {there:.1f} s | {here / there:.3f} |")
        each = there / (chunks * size)
        found = [(samples, *memory(local.scheduler_address, samples)) for samples in LARGE]
    more = ["| starts | memory of the command | its own processor time |", "|---|---|---|"]
    more += [f"| {samples:,} | {most:.0f} MB | {own:.0f} s |" for samples, most, own in found]
    (few, _, short), (many, _, long) = found
    own = (long - short) / (many - few)
    busy, command = each * PROJECTED / (NODES * CORES), own * PROJECTED
    more += [
        "",
        f"Projected from these numbers, not measured, for {PROJECTED:,} such trajectories on {NODES} nodes of "
        f"{CORES} cores: the workers take {busy:.0f} s ({1e6 * each:.1f} µs of one core per trajectory), and the "
        f"command takes another {command:.0f} s ({1e6 * own:.2f} µs per trajectory, from the difference between "
        f"{many:,} and {few:,}).",
    ]
    return "\n".join(lines) + "\n", "\n".join(more)


def main() -> None:
    """Measure, print and write."""
    throughputs, projection = measured()
    print(throughputs, projection, sep="\n")
    write_into("sweeps.md", "sweep_cluster.py", throughputs)


if __name__ == "__main__":
    main()
