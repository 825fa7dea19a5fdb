"""The command line as a process, and one report of the fake studies for all tests that look at it."""

from __future__ import annotations

import subprocess
from collections.abc import Callable
from pathlib import Path

import pytest
from processes import FAKE, PATIENCE, REAL, environment

Process = subprocess.CompletedProcess[str]


@pytest.fixture(scope="session")
def command() -> Callable[..., Process]:
    """Run the command line with the paper's studies, or with the fake ones."""

    def call(*arguments: str, fake: bool = False, cwd: Path | None = None, **variables: str) -> Process:
        return subprocess.run(
            [*(FAKE if fake else REAL), *arguments],
            env=environment(**variables),
            cwd=cwd,
            capture_output=True,
            encoding="utf-8",
            timeout=PATIENCE,
        )

    return call


@pytest.fixture(scope="session")
def reported(command, tmp_path_factory) -> tuple[Process, Path]:
    """A report with every verdict, a failed engine, an array claim, a figure and an animation."""
    folder = tmp_path_factory.mktemp("report")
    engines = ("--engine", "good", "--engine", "failing")
    return command("report", "verdicts", "agreement", *engines, "--output", str(folder), fake=True), folder
