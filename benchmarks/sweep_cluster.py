"""What a Dask cluster costs a sweep: 100 chunks of random starts of Fig. 5, in this process and on local workers.

Run with ``python benchmarks/sweep_cluster.py``; takes about a minute. Needs the extra ``cluster``.
"""

from __future__ import annotations

import tempfile
import time
from pathlib import Path
from typing import NamedTuple

import psutil
from distributed import LocalCluster
from rich.console import Console
from rich.table import Table

from compare.claims.paper_parameters import FIG5
from compare.cli.options import cores
from compare.sweep.compute.executors import Cluster, Executor, InProcess
from compare.sweep.compute.run import simulated
from compare.sweep.compute.store import SweepStore
from compare.sweep.define.axes import Axis
from compare.sweep.define.plan import RandomBasin

CHUNKS = 100
SIZES = (2000, 8000, 32768)


def plan_of(size: int) -> RandomBasin:
    """Return 100 chunks of the starts of the basin of Fig. 5."""
    return RandomBasin(
        system=FIG5,
        duration=300.0,
        tolerance=1e-9,
        seed=1,
        start=(0.0, 0.0, 0.0, 0.0),
        x=Axis("x", -0.3, 0.5, 2),
        y=Axis("vx", -0.4, 0.4, 2),
        samples=CHUNKS * size,
    )


class Cost(NamedTuple):
    """Seconds by the clock, and of all processors together."""

    clock: float
    processors: float


def cost(executor: Executor, size: int) -> Cost:
    """Return what the simulation of all chunks takes, with their way to the disk."""
    with tempfile.TemporaryDirectory() as folder:
        store = SweepStore.create(Path(folder) / "sweep.zarr", plan_of(size), size)
        clock, processors = time.perf_counter(), used()
        simulated(store, executor, lambda what, done, total: None)
        return Cost(time.perf_counter() - clock, used() - processors)


def used() -> float:
    """Return the seconds that this process, which is also the scheduler's, and the workers have had a processor."""
    here = psutil.Process()
    times = [process.cpu_times() for process in (here, *here.children(recursive=True))]
    return sum(time.user + time.system for time in times)


def main() -> None:
    """Print the table."""
    table = Table(
        "starts a chunk", "in process", "Dask", "of processors: in process", "Dask", "overhead", "a chunk"
    )
    with (
        LocalCluster(n_workers=cores(), threads_per_worker=1, dashboard_address=None) as local,
        Cluster(local.scheduler_address) as cluster,
    ):
        executors = (InProcess(), cluster)
        for executor in executors:  # compiled, or loaded, everywhere
            cost(executor, 10)
        for size in SIZES:
            here, there = (cost(executor, size) for executor in executors)
            overhead = there.processors - here.processors
            table.add_row(
                str(size),
                *(
                    f"{seconds:.2f} s"
                    for seconds in (here.clock, there.clock, here.processors, there.processors)
                ),
                f"{100.0 * overhead / here.processors:.1f} %",
                f"{1e3 * overhead / CHUNKS:.1f} ms",
            )
    Console(width=120).print(table)
    print(
        f"{cores()} cores, {CHUNKS} chunks; with other work on the machine only processor times can be compared"
    )


if __name__ == "__main__":
    main()
