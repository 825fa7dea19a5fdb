"""Workers in this process, and one report of the fake studies for all tests."""

from __future__ import annotations

import io
import subprocess
from collections.abc import Iterator
from contextlib import redirect_stderr, redirect_stdout
from pathlib import Path

import fake_studies
import pytest
from processes import work_here

from compare.cli import app as cli
from compare.engines import registry

Process = subprocess.CompletedProcess[str]


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
        work_here(patch)
        patch.setattr(registry, "_REGISTRY", registered)
        with redirect_stdout(io.StringIO()) as out, redirect_stderr(io.StringIO()) as err:
            status = cli.status(arguments, fake_studies.ALL)
    return Process(arguments, status, out.getvalue(), err.getvalue()), folder
