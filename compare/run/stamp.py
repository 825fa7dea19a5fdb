"""What findings and reports depend on: versions, the contents of code, and the kind of machine."""

from __future__ import annotations

import hashlib
import json
import os
import platform
import subprocess
import sys
from collections.abc import Sequence
from contextlib import suppress
from datetime import UTC, datetime
from functools import cache
from importlib.metadata import PackageNotFoundError, distribution, version
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
"""Where the packages are."""

PACKAGES = ("reference_model", "exudyn_models", "compare")
LIBRARIES = ("numpy", "scipy", "exudyn", "numba")


def stamp(*fingerprints: str, code: Sequence[str] = (), libraries: Sequence[str] = LIBRARIES) -> str:
    """Return what findings depend on: packages or modules ``code``, libraries, and what else has a fingerprint."""
    digest = hashlib.sha256("".join([_digest(ROOT, tuple(code)), *fingerprints]).encode())
    versions = " ".join(f"{name}-{version_of(name)}" for name in libraries)
    if "exudyn" in libraries:
        versions += f" exudyn-user-settings-{exudyn_user_settings()}"
    return f"{version_of('friction-discs')} {digest.hexdigest()[:16]} {versions}"


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


@cache
def _digest(root: Path, code: tuple[str, ...]) -> str:
    """Return what the files below ``root`` of the packages or modules ``code`` come to."""
    digest = hashlib.sha256()
    for name in code:
        place = root.joinpath(*name.split("."))
        files = [path for kind in ("*.py", "*.json") for path in place.rglob(kind)]
        for path in sorted(files) if place.is_dir() else [place.with_suffix(".py")]:
            digest.update(path.relative_to(root).as_posix().encode())
            digest.update(path.read_bytes())
    return digest.hexdigest()
