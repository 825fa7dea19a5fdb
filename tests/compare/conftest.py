"""Workers in this process, and one report of the fake studies for all tests."""

from __future__ import annotations

import io
import math
import subprocess
from collections.abc import Hashable, Iterator
from contextlib import redirect_stderr, redirect_stdout
from pathlib import Path
from types import SimpleNamespace

import fake_studies
import pytest

from compare.cli import app as cli
from compare.engines import registry
from compare.run import workers

Process = subprocess.CompletedProcess[str]


class WorkerHere:
    """A worker without a process, which needs no time to start."""

    def __init__(self, temporary: str) -> None:
        self.key, self.owner, self.started, self.dead, self.connection = None, "", math.inf, False, self

    def start(self, key: Hashable, message: bytes, owner: str) -> None:
        self.key, self.message = key, message

    def result(self) -> workers.Done:
        key, self.key = self.key, None
        return workers.Done(key, workers.attempted(workers._unpickled_call, self.message), 0.0)

    def end(self) -> None:
        pass


def work_here(patch: pytest.MonkeyPatch) -> None:
    """Run workers in this process, where a test's patches apply to them."""
    patch.setattr(workers, "_Worker", WorkerHere)
    patch.setattr(workers, "wait", lambda connections, left: connections)
    patch.setattr(workers, "pickle", SimpleNamespace(dumps=lambda work: work, loads=lambda work: work))


@pytest.fixture
def in_this_process(monkeypatch) -> None:
    work_here(monkeypatch)


@pytest.fixture(scope="module")
def all_in_this_process() -> Iterator[None]:
    """Like ``in_this_process``, for a module."""
    with pytest.MonkeyPatch.context() as patch:
        work_here(patch)
        yield


@pytest.fixture(scope="session")
def reported(tmp_path_factory) -> tuple[Process, Path]:
    """Process and folder of a report with every verdict, a failed engine and figures."""
    folder = tmp_path_factory.mktemp("report")
    registered = {engine.name: engine for engine in (fake_studies.GOOD, fake_studies.FAILING)}
    arguments = ["report", "verdicts", "agreement", "--jobs", "1", "--output", str(folder)]
    for name in registered:
        arguments += ["--engine", name]
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(registry, "_REGISTRY", registered)
        with redirect_stdout(io.StringIO()) as out, redirect_stderr(io.StringIO()) as err:
            status = cli.status(arguments, fake_studies.ALL)
    return Process(arguments, status, out.getvalue(), err.getvalue()), folder
