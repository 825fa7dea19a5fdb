"""Units as files: sources, headers of the standard, descriptions, and a library if there is a compiler."""

import importlib.util
import os
import secrets
import shutil
import subprocess
import sys
import sysconfig
import tempfile
import zipfile
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Literal

from fmu_models.description import build_description, description, token_of
from fmu_models.header import header, tables
from fmu_models.variables import Model
from reference_model.systems import require_kind, require_whole

FOLDER = Path(__file__).parent / "sources"

SHARED = ("contact.c", "points.c", "unit.c", "step.c", "integrator.c", "implicit.c")

MADE = "variables.c"

OPTIONS = ("-std=c99", "-O2", "-fPIC", "-shared", "-ffp-contract=off")

Fmi = Literal[2, 3]

NO_COMPILER = "no C compiler found: the unit contains only its sources, which an importer may compile"


class HeadersMissingError(ValueError):
    """FMPy, which provides the headers of the standard, is not installed."""


@dataclass(frozen=True)
class Exported:
    """A unit in ``file``, with a library for ``platform``; if ``platform`` is "", ``remark`` says why."""

    file: Path
    platform: str
    remark: str


def sources_of(model: Model, fmi: Fmi) -> tuple[str, ...]:
    """Return the names of the library's C files."""
    return (model.source, *SHARED, MADE, f"fmi{fmi}.c")


def write_sources(model: Model, folder: Path) -> None:
    """Write all C files and headers except the headers of the standard into ``folder``."""
    folder.mkdir(parents=True, exist_ok=True)
    for path in (*FOLDER.glob("*.h"), *(FOLDER / name for name in (model.source, *SHARED))):
        shutil.copyfile(path, folder / path.name)
    (folder / "variables.h").write_text(header(model, token_of(model)), "utf-8")
    (folder / MADE).write_text(tables(model), "utf-8")


def write_standard(folder: Path, fmi: Fmi) -> None:
    """Write functions and headers of the standard into ``folder``; raise ``HeadersMissingError`` without FMPy."""
    for path in (*standard_headers().glob(f"fmi{fmi}*.h"), FOLDER / f"fmi{fmi}.c"):
        shutil.copyfile(path, folder / path.name)


def standard_headers() -> Path:
    """Return the folder with the headers of the standard; raise ``HeadersMissingError`` without FMPy."""
    found = importlib.util.find_spec("fmpy")
    if found is None or found.origin is None:
        raise HeadersMissingError(
            "FMPy is not installed, which provides the headers of FMI: pip install fmpy"
        )
    return Path(found.origin).parent / "c-code"


def compiler() -> str | None:
    """Return the path of $CC, cc, gcc or clang, or None."""
    return next(filter(None, map(shutil.which, (os.environ.get("CC") or "cc", "gcc", "clang"))), None)


def compile_library(sources: Sequence[Path], library: Path, *more: str) -> None:
    """Compile C files into a library; raise ``RuntimeError`` with the compiler's messages."""
    library.parent.mkdir(parents=True, exist_ok=True)
    command = [str(compiler()), *OPTIONS, *more, "-o", str(library), *map(str, sources), "-lm"]
    done = subprocess.run(command, capture_output=True, text=True)
    if done.returncode:
        raise RuntimeError(f"the compiler failed: {done.stderr.strip()}")


def platform(fmi: Fmi) -> tuple[str, str]:
    """Return the standard's name for this platform and the extension of its libraries."""
    machine = sysconfig.get_platform().rsplit("-", 1)[-1].lower()
    system, ending = {"win32": ("windows", ".dll"), "darwin": ("darwin", ".dylib")}.get(
        sys.platform, ("linux", ".so")
    )
    if fmi == 2:
        bits = "64" if sys.maxsize > 2**32 else "32"
        return {"windows": "win"}.get(system, system) + bits, ending
    return f"{ {'amd64': 'x86_64', 'arm64': 'aarch64'}.get(machine, machine) }-{system}", ending


def export(model: Model, file: Path, fmi: Fmi = 2) -> Exported:
    """Write a model as a unit.

    Raises ``ValueError`` if the file name does not end with .fmu, as the standard requires, ``HeadersMissingError``
    without FMPy, ``RuntimeError`` if the compiler fails, and ``OSError`` if the file cannot be written.
    """
    require_kind("model", model, Model)
    require_kind("file", file, Path)
    require_whole("fmi", fmi, least=2, most=3)
    if file.suffix.lower() != ".fmu":
        raise ValueError(f"output = {str(file)!r}: the name of a unit must end with .fmu")
    sources = sources_of(model, fmi)
    with tempfile.TemporaryDirectory(prefix="friction-discs-") as name:
        folder = Path(name)
        write_sources(model, folder / "sources")
        write_standard(folder / "sources", fmi)
        (folder / "modelDescription.xml").write_bytes(description(model, fmi, sources))
        if fmi == 3:
            (folder / "sources" / "buildDescription.xml").write_bytes(build_description(model, sources))
        machine, ending = platform(fmi)
        remark = "" if compiler() else NO_COMPILER
        if not remark:
            library = folder / "binaries" / machine / f"{model.name}{ending}"
            compile_library([folder / "sources" / one for one in sources], library)
        _replace(Path(os.path.realpath(file)), folder)
    return Exported(file, "" if remark else machine, remark)


def _replace(file: Path, folder: Path) -> None:
    """Replace a file by the archive of a folder; an error leaves the old file."""
    part = file.with_name(f".{secrets.token_hex(8)}.part")
    try:
        with open(part, "xb") as stream, zipfile.ZipFile(stream, "w", zipfile.ZIP_DEFLATED) as archive:
            for path in sorted(folder.rglob("*")):
                if path.is_file():
                    archive.write(path, path.relative_to(folder).as_posix())
        if file.exists():
            shutil.copymode(file, part)
        os.replace(part, file)
    except BaseException:
        part.unlink(missing_ok=True)
        raise
