"""Sweeps into object stores, by file systems of fsspec that need no server."""

import signal

import fsspec
import pytest
from local_cluster import cluster
from long_sweeps import LONG, assert_same, content

from compare.cli import app as cli
from compare.sweep.compute.run import finished
from compare.sweep.files import Files, StoreError
from compare.sweep.store import SweepStore


def test_workers_write_into_it_though_one_is_killed(undisturbed, tmp_path, capsys):
    url = f"file://{tmp_path}/killed"
    arguments = [*LONG, "--chunk", "150", "--output", url]
    with cluster(tmp_path, workers=2, signalled="SIGKILL 0 1") as local:
        assert cli.status([*arguments, "--scheduler", local.address]) == 0, capsys.readouterr().err
        assert local.workers[0].poll() == -signal.SIGKILL
    out = capsys.readouterr().out
    assert f"Results: {url}/sweep.zarr; figures: {url}/basin.svg" in out
    assert_same(content(tmp_path / "killed" / "sweep.zarr"), undisturbed)
    assert cli.status(arguments) == 2
    assert "is there already: --resume goes on with it" in capsys.readouterr().err

    store = SweepStore.open(f"{url}/sweep.zarr")
    assert finished(store)
    store.files.write({"round-0/end/c/3": store.files.read("round-0/end/c/4") + b"more"})
    assert not finished(store)
    assert store.broken == ["of 8 chunks of round-0 these: 3"]


def test_a_sweep_into_memory_is_there_and_drawn(undisturbed, tmp_path, capsys):
    url = "memory://swept"
    assert cli.status([*LONG, "--output", url]) == 0
    fsspec.filesystem("memory").get("/swept/sweep.zarr", str(tmp_path / "sweep.zarr"), recursive=True)
    assert_same(content(tmp_path / "sweep.zarr"), undisturbed)
    assert cli.status(["sweep", "figures", url]) == 0
    assert f"figures: {url}/basin.svg" in capsys.readouterr().out


@pytest.mark.parametrize("url", ["memory://claimed", "file://{}/claimed", "{}/claimed"])
def test_only_one_makes_a_store_there(url, tmp_path):
    files = Files.at(url.format(tmp_path))
    files.claim("name", b"first")
    with pytest.raises(FileExistsError):
        files.claim("name", b"second")
    assert files.read("name") == b"first"


def test_what_can_not_be_written_is_refused_in_one_sentence(capsys):
    assert cli.status([*LONG, "--output", "s4://sweeps/sweep"]) == 2
    assert capsys.readouterr() == ("", "'s4://sweeps/sweep': Protocol not known: s4\n")


def test_a_server_that_is_not_there_is_told_in_one_sentence(monkeypatch, capsys):
    def refuse(*arguments, **options):
        raise OSError("Could not connect\nto the endpoint")

    monkeypatch.setattr(fsspec.get_filesystem_class("memory"), "cat_file", refuse)
    assert cli.status(["sweep", "figures", "memory://there"]) == 2
    sentence = "can't read from 'memory://there/sweep.zarr': Could not connect to the endpoint\n"
    assert capsys.readouterr() == ("", sentence)
    with pytest.raises(StoreError, match="Could not connect to the endpoint"):
        Files("memory://there").read("name")


def test_a_library_that_is_missing_is_named(monkeypatch, capsys):
    def missing(url, **options):
        raise ImportError("Install s3fs to access S3")

    monkeypatch.setattr("fsspec.core.url_to_fs", missing)
    assert cli.status([*LONG, "--output", "s3://sweeps/new"]) == 2
    assert capsys.readouterr().err == (
        "'s3://sweeps/new' needs s3fs: pip install 'friction-discs[cluster]'\n"
    )
