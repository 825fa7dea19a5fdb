"""The command line as a process: with the paper's studies (REAL) or with the fake ones (FAKE)."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
FAKE = [sys.executable, str(Path(__file__).with_name("fake_command.py"))]
REAL = [sys.executable, "-m", "compare.cli"]

PATIENCE = 900.0
"""In s: on the slowest of machines only what hangs takes as long."""


def environment(**more: str) -> dict[str, str]:
    """Return the environment in which the packages are found without being installed."""
    return os.environ | {"PYTHONPATH": str(ROOT), "PYTHONIOENCODING": "utf-8"} | more


def interruptible() -> None:
    """Let the process that is about to start listen to Ctrl-C, which is ignored in the background: a preexec_fn."""
    signal.signal(signal.SIGINT, signal.SIG_DFL)


def wait_until(condition: Callable[[], bool]) -> None:
    """Wait until it is true."""
    deadline = time.monotonic() + PATIENCE
    while not condition():
        assert time.monotonic() < deadline
        time.sleep(0.02)


def wait_for(process: subprocess.Popen[str], *paths: Path) -> None:
    """Wait until a process has written the files, or has ended."""
    wait_until(lambda: all(path.exists() for path in paths) or process.poll() is not None)
