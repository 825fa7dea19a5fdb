"""Dask clusters of processes on this machine."""

import json
import subprocess
import sys
import time
from contextlib import contextmanager, suppress
from dataclasses import dataclass

from distributed import Client
from long_sweeps import SIGNALLING
from processes import PATIENCE, environment

DASK = [sys.executable, "-m", "dask"]


@dataclass
class LocalCluster:
    address: str
    scheduler: subprocess.Popen
    workers: list[subprocess.Popen]


def started(*arguments, signalled=""):
    return subprocess.Popen(
        [*DASK, *arguments, "--no-dashboard"],
        env=environment() | {"SIGNALLED": signalled},
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
    )


@contextmanager
def cluster(folder, workers, signalled=""):
    """Yield a scheduler with workers of one thread each; the first is ``signalled`` while it writes.

    Only its first chunk is certain, because other workers may take over later ones.
    """
    file = folder / "scheduler.json"
    processes = [started("scheduler", "--host", "127.0.0.1", "--port", "0", "--scheduler-file", str(file))]
    try:
        address = None
        while address is None:
            assert processes[0].poll() is None
            with suppress(OSError, ValueError):
                address = json.loads(file.read_text())["address"]
            time.sleep(0.05)
        options = ("--nthreads", "1", "--no-nanny", "--preload", str(SIGNALLING))
        for i in range(workers):
            processes.append(started("worker", address, *options, signalled="" if i else signalled))
        with Client(address, set_as_default=False) as client:
            client.wait_for_workers(workers, timeout=PATIENCE)
        yield LocalCluster(address, processes[0], processes[1:])
    finally:
        for process in processes:
            process.kill()
            process.wait()
