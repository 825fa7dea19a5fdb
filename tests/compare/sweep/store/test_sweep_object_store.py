"""Sweeps in object stores of fsspec that need no server."""

import fsspec
import pytest
from long_sweeps import LONG, assert_same, content

from compare.cli import app as cli
from compare.sweep.files import Files


def test_a_sweep_in_memory_is_stored_and_drawn(undisturbed, tmp_path, capsys):
    url = "memory://swept"
    assert cli.status([*LONG, "--output", url]) == 0
    fsspec.filesystem("memory").get("/swept/sweep.zarr", str(tmp_path / "sweep.zarr"), recursive=True)
    assert_same(content(tmp_path / "sweep.zarr"), undisturbed)
    assert cli.status(["sweep", "figures", url]) == 0
    assert f"figures: {url}/basin.svg" in capsys.readouterr().out
    assert cli.status([*LONG, "--output", url]) == 2
    assert "already exists; use --resume to continue it" in capsys.readouterr().err


@pytest.mark.parametrize("url", ["memory://claimed", "file://{}/claimed", "{}/claimed"])
def test_only_one_process_creates_a_store(url, tmp_path):
    files = Files.at(url.format(tmp_path))
    files.claim("name", b"first")
    with pytest.raises(FileExistsError):
        files.claim("name", b"second")
    assert files.read("name") == b"first"


def test_a_missing_server_gives_a_message_of_one_line(monkeypatch, capsys):
    def refuse(*arguments, **options):
        raise OSError("Could not connect\nto the endpoint")

    monkeypatch.setattr(fsspec.get_filesystem_class("memory"), "cat_file", refuse)
    assert cli.status(["sweep", "figures", "memory://there"]) == 2
    sentence = "cannot read from 'memory://there/sweep.zarr': Could not connect to the endpoint\n"
    assert capsys.readouterr() == ("", sentence)


def test_a_missing_library_is_named(monkeypatch, capsys):
    def missing(url, **options):
        raise ImportError("Install s3fs to access S3")

    monkeypatch.setattr("fsspec.core.url_to_fs", missing)
    assert cli.status([*LONG, "--output", "s3://sweeps/new"]) == 2
    assert capsys.readouterr().err == ("'s3://sweeps/new' needs s3fs; install it with: pip install s3fs\n")
