"""Sweeps into an object store: a server of S3's protocol on this machine."""

import signal
import threading
import time

import fsspec
import pytest
from local_cluster import cluster
from long_sweeps import LONG, assert_same, content
from moto.moto_server.werkzeug_app import DomainDispatcherApplication, create_backend_app
from processes import PATIENCE, wait_until
from werkzeug.serving import make_server

from compare.cli import app as cli
from compare.sweep.compute.run import finished
from compare.sweep.store.files import OPTIONS, Files
from compare.sweep.store.store import SweepStore

GONE = 5.0
"""In s."""


class Server:
    """What it holds outlives that it is gone."""

    def __init__(self):
        self.app, self.port, self.marks = DomainDispatcherApplication(create_backend_app), 0, 0
        self.begin()

    def answer(self, request, start):
        if request["REQUEST_METHOD"] == "PUT" and "/checksum/" in request["PATH_INFO"]:
            self.marks += 1
        return self.app(request, start)

    def begin(self):
        self.server = make_server("127.0.0.1", self.port, self.answer, threaded=True)
        self.port = self.server.port
        threading.Thread(target=self.server.serve_forever, daemon=True).start()

    def end(self):
        self.server.shutdown()
        self.server.server_close()


@pytest.fixture(scope="module")
def server():
    """Where ``s3://`` leads to, with the bucket "sweeps", for this process and those it starts."""
    found, s3 = Server(), fsspec.get_filesystem_class("s3")
    s3.clear_instance_cache()  # which may lead to a server of before: tests are handed out in any order
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("AWS_ENDPOINT_URL", f"http://127.0.0.1:{found.port}")
        for name in ("AWS_ACCESS_KEY_ID", "AWS_SECRET_ACCESS_KEY"):
            patch.setenv(name, "test")
        patch.setenv("AWS_DEFAULT_REGION", "us-east-1")
        fsspec.filesystem("s3").makedirs("sweeps", exist_ok=True)  # it outlives the server
        yield found
    s3.clear_instance_cache()
    found.end()


def test_workers_write_into_it_though_one_is_killed_and_it_is_gone_for_a_while(
    server, undisturbed, tmp_path, capsys
):
    url = "s3://sweeps/killed"
    arguments = [*LONG, "--chunk", "150", "--output", url]

    def interrupted():
        before = server.marks  # that of the array itself
        wait_until(lambda: server.marks > before + 3)
        server.end()
        time.sleep(GONE)
        server.begin()

    with cluster(tmp_path, workers=2, signalled="SIGKILL 0 1") as local:
        thread = threading.Thread(target=interrupted, daemon=True)
        thread.start()
        assert cli.status([*arguments, "--scheduler", local.address]) == 0, capsys.readouterr().err
        thread.join(PATIENCE)
        assert local.workers[0].poll() == -signal.SIGKILL
    out = capsys.readouterr().out
    assert f"Results: {url}/sweep.zarr; figures: {url}/basin.svg" in out
    fsspec.filesystem("s3").get(f"{url}/sweep.zarr", str(tmp_path / "sweep.zarr"), recursive=True)
    assert_same(content(tmp_path / "sweep.zarr"), undisturbed)
    assert cli.status(arguments) == 2
    assert "is there already: --resume goes on with it" in capsys.readouterr().err

    store = SweepStore.open(f"{url}/sweep.zarr")
    assert finished(store)
    store.files.write({"round-0/end/3": store.files.read("round-0/end/4") + b"more"})
    assert not finished(store)
    assert store.broken == ["of 8 chunks of round-0 these: 3"]


def test_only_one_makes_a_store_there(server):
    files = Files("s3://sweeps/claimed")
    files.claim("name", b"first")
    with pytest.raises(FileExistsError):
        files.claim("name", b"second")
    assert files.read("name") == b"first"


@pytest.mark.parametrize(
    ("url", "words"),
    [
        ("s3://nowhere/sweep", "can't write to 's3://nowhere/sweep': The specified bucket does not exist\n"),
        ("s4://sweeps/sweep", "'s4://sweeps/sweep': Protocol not known: s4\n"),
    ],
)
def test_what_can_not_be_written_is_refused_in_one_sentence(url, words, server, capsys):
    assert cli.status([*LONG, "--output", url]) == 2
    assert capsys.readouterr() == ("", words)


def test_a_server_that_is_not_there_is_told_in_one_sentence(server, monkeypatch, capsys):
    once = {"retries": {"total_max_attempts": 1}}
    monkeypatch.setitem(OPTIONS, "s3", {"endpoint_url": "http://127.0.0.1:1", "config_kwargs": once})
    assert cli.status(["sweep", "figures", "s3://sweeps/there"]) == 2
    out, err = capsys.readouterr()
    assert (out, err.count("\n")) == ("", 1)
    assert err.startswith(
        "can't read from 's3://sweeps/there/sweep.zarr': Could not connect to the endpoint URL"
    )


def test_a_library_that_is_missing_is_named(monkeypatch, capsys):
    def missing(url, **options):
        raise ImportError("Install s3fs to access S3")

    monkeypatch.setattr("fsspec.core.url_to_fs", missing)
    assert cli.status([*LONG, "--output", "s3://sweeps/new"]) == 2
    assert capsys.readouterr().err == (
        "'s3://sweeps/new' needs s3fs: pip install 'friction-discs[cluster]'\n"
    )
