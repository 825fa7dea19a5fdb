"""Build the wheel and the source archive and check their contents: ``python builders/release.py [DIST]``.

The wheel contains exactly the files of the packages that are under version control, including data and templates. The
source archive also contains the tests and the documentation.
"""

from __future__ import annotations

import subprocess
import sys
import tarfile
import zipfile
from collections.abc import Iterable
from pathlib import Path

ROOT = Path(__file__).parents[1]
PACKAGES = ("reference_model", "exudyn_models", "fmu_models", "compare")
REPOSITORY_ONLY = (".ci", ".github", ".gitignore")


def tracked() -> set[str]:
    """Return the existing files under version control."""
    out = subprocess.run(
        ["git", "ls-files", "-z"], cwd=ROOT, capture_output=True, check=True, encoding="utf-8"
    )
    return {name for name in out.stdout.split("\0") if name and (ROOT / name).exists()}


def complaints_of_wheel(names: Iterable[str], files: set[str]) -> list[str]:
    """Return a sentence for each file that a wheel lacks and for each superfluous file."""
    inside = {name for name in names if not name.split("/")[0].endswith(".dist-info")}
    wanted = {name for name in files if name.split("/")[0] in PACKAGES}
    return _complaints("the wheel", wanted - inside, inside - wanted)


def complaints_of_archive(names: Iterable[str], files: set[str]) -> list[str]:
    """Return a sentence for each file that a source archive lacks. The build may add other files."""
    inside = {name.partition("/")[2] for name in names}
    wanted = {name for name in files if name.split("/")[0] not in REPOSITORY_ONLY}
    return _complaints("the source archive", wanted - inside, set())


def _complaints(what: str, lacking: set[str], vain: set[str]) -> list[str]:
    return [f"{what} lacks {name}" for name in sorted(lacking)] + [
        f"{what} has {name}" for name in sorted(vain)
    ]


def main(folder: Path) -> int:
    """Build both into ``folder``, check them, and return the exit status."""
    subprocess.run([sys.executable, "-m", "build", "--outdir", folder, ROOT], check=True)
    (wheel,), (archive,) = folder.glob("*.whl"), folder.glob("*.tar.gz")
    with zipfile.ZipFile(wheel) as opened:
        in_wheel = opened.namelist()
    with tarfile.open(archive) as opened_archive:
        in_archive = [each.name for each in opened_archive if each.isfile()]
    files = tracked()
    complaints = complaints_of_wheel(in_wheel, files) + complaints_of_archive(in_archive, files)
    for path, names in ((wheel, in_wheel), (archive, in_archive)):
        print(f"{path.name}: {len(names)} files, {path.stat().st_size / 1e6:.1f} MB")
    print("\n".join(complaints) or "both are complete")
    return 1 if complaints else 0


if __name__ == "__main__":
    sys.exit(main(Path(sys.argv[1] if len(sys.argv) > 1 else "dist").resolve()))
