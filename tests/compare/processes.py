"""Processes of the tests, and workers in this process instead."""

from __future__ import annotations

import math
import os
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Hashable
from pathlib import Path
from types import SimpleNamespace

import pytest

from compare.run import workers

ROOT = Path(__file__).resolve().parents[2]
FAKE = [sys.executable, str(Path(__file__).with_name("fake_command.py"))]
REAL = [sys.executable, "-m", "compare.cli"]

PATIENCE = 900.0
"""Time limit in s that only a hanging process exceeds, even on slow machines."""


def environment(**more: str) -> dict[str, str]:
    """Return an environment for the packages without installation."""
    return os.environ | {"PYTHONPATH": str(ROOT), "PYTHONIOENCODING": "utf-8"} | more


def interruptible() -> None:
    """Enable Ctrl-C, which background processes ignore."""
    signal.signal(signal.SIGINT, signal.SIG_DFL)


def wait_until(condition: Callable[[], bool]) -> None:
    deadline = time.monotonic() + PATIENCE
    while not condition():
        assert time.monotonic() < deadline
        time.sleep(0.02)


def wait_for(process: subprocess.Popen[str], *paths: Path) -> None:
    wait_until(lambda: all(path.exists() for path in paths) or process.poll() is not None)


def ended(group: int) -> bool:
    """Return whether every process of the group has ended; zombies count as ended."""
    try:
        os.killpg(group, 0)
    except ProcessLookupError:
        return True
    return False


class WorkerHere:
    def __init__(self, temporary: str) -> None:
        self.key, self.owner, self.started, self.dead, self.connection = None, "", math.inf, False, self

    def start(self, key: Hashable, message: bytes, owner: str) -> None:
        self.key, self.message = key, message

    def result(self) -> workers.Done:
        key, self.key = self.key, None
        return workers.Done(key, workers.attempted(self.message[0], *self.message[1]), 0.0)

    def spent(self) -> float:
        return 0.0

    def end(self) -> None:
        pass


def work_here(patch: pytest.MonkeyPatch) -> None:
    """Run workers in this process, where a test's patches apply to them."""
    patch.setattr(workers, "_Worker", WorkerHere)
    patch.setattr(workers, "wait", lambda connections, left: connections)
    patch.setattr(workers, "pickle", SimpleNamespace(dumps=lambda work: work, loads=lambda work: work))
