"""From which commit, versions and machine a report is."""

from __future__ import annotations

import json
import os
import platform
import subprocess
import sys
from contextlib import suppress
from datetime import UTC, datetime
from importlib.metadata import PackageNotFoundError, distribution, version
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
"""Where the packages are."""

LIBRARIES = ("numpy", "scipy", "exudyn", "numba")


def platform_stamp() -> dict[str, str]:
    """Return versions, operating system, number of cores and date, ready to print; no name of a machine or folder."""
    return {
        "friction-discs": version_of("friction-discs"),
        "commit": commit() or "not known",
        "Python": platform.python_version(),
        **{name: version_of(name) for name in LIBRARIES},
        "user settings of Exudyn": exudyn_user_settings(),
        "system": f"{platform.system()} {platform.machine()}",
        "processor": processor(),
        "cores": str(os.cpu_count()),
        "date": datetime.now(UTC).strftime("%Y-%m-%d %H:%M UTC"),
    }


ENGINES = {"reference": "friction-discs", "plain": "friction-discs", "exudyn": "exudyn"}
"""Distributions that bring this project's engines, or those whose code they share."""


def engine_version(name: str, kin: str, own: str) -> str:
    """Return an engine's version, its ``own`` or that of the distribution it is from; "" where none is known."""
    source = ENGINES.get(kin or name)
    return own or (version_of(source) if source else "")


def commit() -> str:
    """Return the commit of this project's code, with "-dirty" where files differ from it; "" where none is known."""
    if (ROOT / ".git").exists():
        try:
            found = subprocess.run(
                ["git", "-C", str(ROOT), "describe", "--always", "--dirty", "--abbrev=40", "--exclude=*"],
                capture_output=True,
                encoding="utf-8",
            )
        except OSError:
            return ""
        return found.stdout.strip()
    try:
        source = distribution("friction-discs").read_text("direct_url.json") or "{}"
    except PackageNotFoundError:
        return ""
    return str(json.loads(source).get("vcs_info", {}).get("commit_id", ""))


def processor() -> str:
    """Return what the processor calls itself, else its kind."""
    with suppress(OSError):
        for line in Path("/proc/cpuinfo").read_text(encoding="utf-8", errors="replace").splitlines():
            if line.startswith("model name"):
                return line.partition(":")[2].strip()
    return platform.processor() or platform.machine()


def version_of(name: str) -> str:
    """Return the installed version, "none" where it isn't installed."""
    try:
        return version(name)
    except PackageNotFoundError:
        return "none"


def exudyn_user_settings() -> str:
    """Return "off", or "on" where Exudyn was imported before a study and has found a user's own settings."""
    found = sys.modules.get("exudyn.misc.overrideSettings")
    return "on" if found is not None and found.Applied() else "off"
