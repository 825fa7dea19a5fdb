"""The command line as a process: with the paper's studies (REAL) or with the fake ones (FAKE)."""

from __future__ import annotations

import os
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
FAKE = [sys.executable, str(Path(__file__).with_name("fake_studies.py"))]
REAL = [sys.executable, "-m", "compare.cli"]


def environment(**more: str) -> dict[str, str]:
    """Return the environment in which the packages are found without being installed."""
    return os.environ | {"PYTHONPATH": str(ROOT), "PYTHONIOENCODING": "utf-8"} | more
