"""Sweeps on local Dask clusters."""

import json
import signal
import socket
import subprocess
import sys
import time
from contextlib import contextmanager, suppress
from types import SimpleNamespace

import pytest
from distributed import Client, LocalCluster
from long_sweeps import (
    CHUNKS,
    LONG,
    SIGNALLING,
    assert_same,
    content,
    marks,
    resumed,
    silent,
    status_of_signalled,
)
from processes import PATIENCE, environment
from signalling_sweep import signalling_here

from compare.claims.parameters import FIG5
from compare.cli import app as cli
from compare.sweep.arrays import DESCRIPTION
from compare.sweep.compute import executors
from compare.sweep.compute.executors import Cluster, ClusterError, InProcess
from compare.sweep.compute.run import finished, run
from compare.sweep.compute.work import OtherCodeError
from compare.sweep.files import StoreError
from compare.sweep.plan import RandomBasin
from compare.sweep.quantities import Axis
from compare.sweep.store import SweepStore

DASK = [sys.executable, "-m", "dask"]


def started(*arguments, signalled=""):
    return subprocess.Popen(
        [*DASK, *arguments, "--no-dashboard"],
        env=environment() | {"SIGNALLED": signalled},
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
    )


@contextmanager
def cluster(folder, workers, signalled=""):
    """Yield the address, a scheduler and workers of one thread each; the first is ``signalled`` while it writes.

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
        yield address, *processes
    finally:
        for process in processes:
            process.kill()
            process.wait()


def test_results_survive_a_killed_driver_a_killed_worker_and_a_lost_scheduler(
    undisturbed, undrawn, tmp_path, monkeypatch, capsys
):
    monkeypatch.setattr("compare.sweep.store.SMALL", 0)  # prevents packing
    first, other = tmp_path / "first", tmp_path / "other"
    first.mkdir()
    url = f"file://{first}"
    with cluster(tmp_path, workers=2, signalled="SIGKILL 0 1") as (address, scheduler, worker, _):
        on_cluster = ("--scheduler", address)
        assert status_of_signalled("SIGKILL", 4, url, *on_cluster) == -signal.SIGKILL
        written = marks(first)
        assert len(written) >= 4  # workers continue for a moment
        code = resumed(url, *on_cluster)
        assert worker.poll() == -signal.SIGKILL
        out, err = capsys.readouterr()
        assert (code, err) == (0, ""), out

        with signalling_here("SIGKILL", scheduler.pid, 3):
            code = cli.status([*LONG, *CHUNKS, "--output", str(other), *on_cluster])
    assert f"Results: {url}/sweep.zarr" in out
    assert written <= marks(first)
    assert_same(content(first / "sweep.zarr"), undisturbed)
    store = SweepStore.open(f"{url}/sweep.zarr")
    assert finished(store)
    store.files.write({"round-0/end/c/3": store.files.read("round-0/end/c/4") + b"more"})
    assert not finished(store)
    assert store.broken == ["round-0: chunk 3 (of 9)"]

    out, err = capsys.readouterr()
    assert (code, out, err.count("\n")) == (1, "", 1)
    assert err.startswith(f"lost the cluster at {address}")
    assert resumed(other) == 0
    assert_same(content(other / "sweep.zarr"), undisturbed)


@pytest.mark.parametrize("listens", [False, True], ids=["no server", "a silent server"])
def test_a_missing_scheduler_is_reported_in_time(listens, tmp_path, monkeypatch, capsys):
    monkeypatch.setattr(executors, "WAIT", 0.5)
    with socket.socket() as other:
        other.bind(("127.0.0.1", 0))  # reserves the port
        if listens:
            other.listen()
        address = f"tcp://127.0.0.1:{other.getsockname()[1]}"
        clock = time.monotonic()
        code = cli.status([*LONG, "--scheduler", address, "--output", str(tmp_path)])
    assert time.monotonic() - clock < 10.0
    sentence = f"no Dask scheduler answers at {address}; start one with: dask scheduler\n"
    assert (code, *capsys.readouterr()) == (2, "", sentence)
    assert not (tmp_path / "sweep.zarr").exists()


def test_a_scheduler_without_workers_is_reported(monkeypatch):
    monkeypatch.setattr(executors, "WAIT", 1.0)
    with (
        # Its web server warns if the default port is taken.
        LocalCluster(n_workers=0, processes=False, protocol="tcp", dashboard_address="127.0.0.1:0") as local,
        pytest.raises(ClusterError, match="has no workers; start one"),
    ):
        Cluster(local.scheduler_address)


class Elsewhere(InProcess):
    def __init__(self, otherwise):
        self.otherwise = otherwise

    def run(self, tasks):
        for task in tasks:
            self.otherwise()
            yield task.key, task.function(*task.arguments)


@pytest.mark.parametrize(
    ("other", "error", "sentence"),
    [
        ("code", OtherCodeError, "a different version of the code or libraries"),
        ("store", StoreError, r"--output is not a shared folder or an object store"),
    ],
)
def test_a_worker_with_other_code_or_store_writes_nothing(other, error, sentence, tmp_path, monkeypatch):
    x, y = Axis("x", -0.3, 0.5, 2), Axis("vx", -0.4, 0.4, 2)
    common = {"system": FIG5, "duration": 1.0, "tolerance": 1e-6, "seed": 1}
    plan = RandomBasin(**common, start=(0.0,) * 4, x=x, y=y, samples=3)
    store = SweepStore.create(tmp_path / "sweep.zarr", plan, 2)

    def otherwise():
        if other == "code":
            monkeypatch.setattr("compare.sweep.compute.work.stamp", lambda: "other")
        else:
            (tmp_path / "sweep.zarr" / DESCRIPTION).write_text("{}")

    with pytest.raises(error, match=sentence):
        run(store, Elsewhere(otherwise), silent)
    assert marks(tmp_path) == set()


def test_a_task_of_a_frozen_worker_is_given_to_another_one():
    held = SimpleNamespace(processing=lambda: {"frozen": ("late",), "other": ()})
    one = Cluster.__new__(Cluster)
    one._client = held
    now = time.monotonic()
    sent = {"late": (None, now - 100.0), "young": (None, now)}
    assert one._late(sent, 60.0) == [("late", ["other"])]
    assert one._late(sent, 200.0) == []
