"""Sweeps on local Dask clusters."""

import signal
import socket
import time

import pytest
from distributed import LocalCluster
from local_cluster import cluster
from long_sweeps import CHUNKS, LONG, assert_same, content, marks, resumed, silent, status_of_signalled
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


def test_results_survive_a_killed_driver_a_killed_worker_and_a_lost_scheduler(
    undisturbed, undrawn, tmp_path, monkeypatch, capsys
):
    monkeypatch.setattr("compare.sweep.store.SMALL", 0)  # prevents packing
    first, other = tmp_path / "first", tmp_path / "other"
    first.mkdir()
    url = f"file://{first}"
    with cluster(tmp_path, workers=2, signalled="SIGKILL 0 1") as local:
        on_cluster = ("--scheduler", local.address)
        assert status_of_signalled("SIGKILL", 4, url, *on_cluster) == -signal.SIGKILL
        written = marks(first)
        assert len(written) >= 4  # workers continue for a moment
        code = resumed(url, *on_cluster)
        assert local.workers[0].poll() == -signal.SIGKILL
        out, err = capsys.readouterr()
        assert (code, err) == (0, ""), out

        with signalling_here("SIGKILL", local.scheduler.pid, 3):
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
    assert err.startswith(f"lost the cluster at {local.address}")
    assert resumed(other) == 0
    assert_same(content(other / "sweep.zarr"), undisturbed)


def test_a_missing_scheduler_is_reported_in_time(tmp_path, monkeypatch, capsys):
    monkeypatch.setattr(executors, "WAIT", 0.5)
    with socket.socket() as other:
        other.bind(("127.0.0.1", 0))  # reserves the port without listening
        address = f"tcp://127.0.0.1:{other.getsockname()[1]}"
        clock = time.monotonic()
        code = cli.status([*LONG, "--scheduler", address, "--output", str(tmp_path)])
    assert time.monotonic() - clock < 10.0
    assert code == 2
    assert capsys.readouterr() == (
        "",
        f"no Dask scheduler answers at {address}; start one with: dask scheduler\n",
    )
    assert not (tmp_path / "sweep.zarr").exists()


def test_a_silent_server_is_not_a_scheduler(monkeypatch):
    monkeypatch.setattr(executors, "WAIT", 0.5)
    with socket.socket() as mute:
        mute.bind(("127.0.0.1", 0))
        mute.listen()
        clock = time.monotonic()
        with pytest.raises(ClusterError, match="no Dask scheduler answers"):
            Cluster(f"tcp://127.0.0.1:{mute.getsockname()[1]}")
    assert time.monotonic() - clock < 5.0


def test_a_scheduler_without_workers_is_reported(monkeypatch):
    monkeypatch.setattr(executors, "WAIT", 1.0)
    with (
        LocalCluster(n_workers=0, processes=False, protocol="tcp", dashboard_address=None) as local,
        pytest.raises(ClusterError, match="has no workers; start one"),
    ):
        Cluster(local.scheduler_address)


@pytest.fixture
def store(tmp_path):
    x, y = Axis("x", -0.3, 0.5, 2), Axis("vx", -0.4, 0.4, 2)
    common = {"system": FIG5, "duration": 1.0, "tolerance": 1e-6, "seed": 1}
    plan = RandomBasin(**common, start=(0.0,) * 4, x=x, y=y, samples=3)
    return SweepStore.create(tmp_path / "sweep.zarr", plan, 2)


class Elsewhere(InProcess):
    def __init__(self, otherwise):
        self.otherwise = otherwise

    def run(self, tasks):
        for task in tasks:
            self.otherwise()
            yield task.key, task.function(*task.arguments)


def test_a_worker_with_different_code_is_rejected_and_writes_nothing(store, tmp_path, monkeypatch):
    other = Elsewhere(lambda: monkeypatch.setattr("compare.sweep.compute.work.stamp", lambda: "other"))
    with pytest.raises(OtherCodeError, match="a different version of the code or libraries"):
        run(store, other, silent)
    assert marks(tmp_path) == set()


def test_a_worker_with_a_different_store_at_that_path_is_rejected(store, tmp_path):
    other = Elsewhere(lambda: (tmp_path / "sweep.zarr" / DESCRIPTION).write_text("{}"))
    with pytest.raises(StoreError, match="--output must be a shared folder or an object store"):
        run(store, other, silent)
    assert marks(tmp_path) == set()
