"""What builds the package: setuptools, after the kernels of ensembles have been compiled for the wheel.

A wheel brings them for all levels of x86-64 on Linux; elsewhere it brings none, and fits all machines. What is
installed to be edited brings none either: ``make`` compiles them for this machine, and without it the first run does.
"""

from __future__ import annotations

import platform
import subprocess
import sys
from pathlib import Path
from typing import Any

from setuptools import build_meta
from setuptools.build_meta import *  # noqa: F403  all hooks but those below

PLATFORM = "manylinux_2_17_x86_64"
"""Of a wheel with kernels: they call memory and mathematics of the C library, as it has been since long before."""

NEEDED = ["numba>=0.68", "numpy>=1.26", "scipy>=1.12"]
"""What compiles them."""


def _has_kernels() -> bool:
    return sys.platform == "linux" and platform.machine() == "x86_64"


def get_requires_for_build_wheel(config_settings: Any = None) -> list[str]:
    """Return what must be there to build a wheel."""
    return [*build_meta.get_requires_for_build_wheel(config_settings), *(NEEDED if _has_kernels() else ())]


def build_wheel(wheel_directory: str, config_settings: Any = None, metadata_directory: Any = None) -> str:
    """Build it, with kernels where they are made; return its name."""
    settings = dict(config_settings or {})
    if _has_kernels():
        subprocess.run([sys.executable, Path(__file__).with_name("kernels.py"), "--all-levels"], check=True)
        settings["--build-option"] = [f"--plat-name={PLATFORM}"]
    return build_meta.build_wheel(wheel_directory, settings, metadata_directory)
