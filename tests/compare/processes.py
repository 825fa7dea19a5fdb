"""The command line as a process, with the paper's studies or the fake ones."""

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
    """Wait until all files exist or the process has ended."""
    wait_until(lambda: all(path.exists() for path in paths) or process.poll() is not None)
