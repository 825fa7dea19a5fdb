"""What findings and reports depend on: versions, the contents of code, and the kind of machine."""

from __future__ import annotations

import hashlib
import os
import platform
import sys
from collections.abc import Sequence
from datetime import datetime, timezone
from functools import cache
from importlib.metadata import PackageNotFoundError, version
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
        "Python": platform.python_version(),
        **{name: version_of(name) for name in LIBRARIES},
        "user settings of Exudyn": exudyn_user_settings(),
        "system": f"{platform.system()} {platform.machine()}",
        "cores": str(os.cpu_count()),
        "date": datetime.now(timezone.utc).strftime("%Y-%m-%d %H:%M UTC"),
    }


def version_of(distribution: str) -> str:
    """Return the installed version, "none" where it isn't installed."""
    try:
        return version(distribution)
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
