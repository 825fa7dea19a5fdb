"""Sweeps on Dask clusters of real processes on this machine."""

import json
import signal
import socket
import subprocess
import sys
import time
from contextlib import contextmanager, suppress
from dataclasses import dataclass

import pytest
from long_sweeps import LONG, assert_same, content, finished_by, long_sweep, marks, resumed
from processes import environment

from compare.claims.paper_parameters import FIG5
from compare.cli import app as cli
from compare.sweep.compute import executors
from compare.sweep.compute.executors import Cluster, ClusterError
from compare.sweep.compute.run import OtherCodeError, run
from compare.sweep.compute.store import SweepStore
from compare.sweep.compute.work import Chunk
from compare.sweep.define.axes import Axis
from compare.sweep.define.plan import RandomBasin

DASK = [sys.executable, "-m", "dask"]


@dataclass
class LocalCluster:
    address: str
    scheduler: subprocess.Popen
    workers: list[subprocess.Popen]


def started(*arguments):
    return subprocess.Popen(
        [*DASK, *arguments, "--no-dashboard"],
        env=environment(),
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
    )


@contextmanager
def cluster(folder, workers):
    file = folder / "scheduler.json"
    processes = [started("scheduler", "--host", "127.0.0.1", "--port", "0", "--scheduler-file", str(file))]
    try:
        address = None
        while address is None:
            assert processes[0].poll() is None
            with suppress(OSError, ValueError):
                address = json.loads(file.read_text())["address"]
            time.sleep(0.05)
        for _ in range(workers):
            processes.append(started("worker", address, "--nthreads", "1", "--no-nanny"))
        yield LocalCluster(address, processes[0], processes[1:])
    finally:
        for process in processes:
            process.kill()
            process.wait()


def test_killed_driver_and_killed_worker_leave_the_results_as_they_are(undisturbed, tmp_path):
    with cluster(tmp_path, workers=2) as local:
        driver = long_sweep(tmp_path, "--scheduler", local.address, signalled=("SIGKILL", 0, 11))
        assert finished_by(driver)[0] == -signal.SIGKILL
        written = marks(tmp_path)

        killed = ("SIGKILL", local.workers[0].pid, 10)
        driver = long_sweep(tmp_path, "--scheduler", local.address, "--resume", signalled=killed)
        code, out, err = finished_by(driver)
    assert (code, err) == (0, ""), out
    assert written <= marks(tmp_path)
    assert_same(content(tmp_path / "sweep.zarr"), undisturbed)


def test_a_lost_scheduler_is_told_and_the_sweep_goes_on_without_it(undisturbed, tmp_path):
    with cluster(tmp_path, workers=1) as local:
        killed = ("SIGKILL", local.scheduler.pid, 10)
        driver = long_sweep(tmp_path, "--scheduler", local.address, signalled=killed)
        code, out, err = finished_by(driver)
    assert (code, out) == (1, "")
    assert err.startswith(f"lost the cluster at {local.address}")
    assert err.count("\n") == 1
    assert resumed(tmp_path) == 0
    assert_same(content(tmp_path / "sweep.zarr"), undisturbed)


def test_a_scheduler_that_is_not_there_is_told_in_time(tmp_path, capsys):
    with socket.socket() as other:
        other.bind(("127.0.0.1", 0))  # so that nobody else listens there
        address = f"tcp://127.0.0.1:{other.getsockname()[1]}"
        clock = time.monotonic()
        code = cli.status([*LONG, "--scheduler", address, "--output", str(tmp_path)])
    assert time.monotonic() - clock < 10.0
    assert code == 2
    assert capsys.readouterr() == ("", f"no Dask scheduler answers at {address}: start one, dask scheduler\n")
    assert not (tmp_path / "sweep.zarr").exists()


def test_who_listens_but_says_nothing_is_no_scheduler(monkeypatch):
    monkeypatch.setattr(executors, "WAIT", 0.5)
    with socket.socket() as mute:
        mute.bind(("127.0.0.1", 0))
        mute.listen()
        clock = time.monotonic()
        with pytest.raises(ClusterError, match="no Dask scheduler answers"):
            Cluster(f"tcp://127.0.0.1:{mute.getsockname()[1]}")
    assert time.monotonic() - clock < 5.0


def test_a_scheduler_without_workers_is_told(tmp_path, monkeypatch):
    monkeypatch.setattr(executors, "WAIT", 2.0)
    with (
        cluster(tmp_path, workers=0) as local,
        pytest.raises(ClusterError, match="has no workers: start some"),
    ):
        Cluster(local.address)


@pytest.mark.parametrize("address", ["here", "127.0.0.1", "tcp://here", "tcp://here:port"])
def test_what_is_no_address_is_refused(address, capsys, tmp_path):
    assert cli.status(["sweep", "basin", "pin", "--scheduler", address, "--output", str(tmp_path)]) == 2
    assert capsys.readouterr().err == f"scheduler = {address!r}: write it as tcp://HOST:PORT\n"


def test_a_worker_with_other_code_is_refused(tmp_path):
    class OtherWorker:
        threads = 1

        def run(self, tasks):
            for task in tasks:
                found = task.function(*task.arguments)
                yield task.key, Chunk("other", found.results)

    x, y = Axis("x", -0.3, 0.5, 2), Axis("vx", -0.4, 0.4, 2)
    common = {"system": FIG5, "duration": 1.0, "tolerance": 1e-6, "seed": 1}
    store = SweepStore.create(tmp_path / "s", RandomBasin(**common, start=(0.0,) * 4, x=x, y=y, samples=3), 2)
    with pytest.raises(OtherCodeError, match=r"other code or libraries \(other\) than this process"):
        run(store, OtherWorker(), lambda what, done, total: None)
