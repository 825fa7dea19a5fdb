"""A small finished store as one file: a ZIP archive, which Zarr opens as it is."""

from __future__ import annotations

import tempfile
import zlib
from contextlib import suppress
from pathlib import Path
from zipfile import BadZipFile, ZipFile

from compare.output.text_files import replacing

PARTIAL = ".partial"
"""Ending of a file that Zarr was writing when the process was killed."""


def pack(folder: Path, archive: Path) -> None:
    """Write all files of a store into an archive; an archive that is there is complete."""
    with replacing(archive, "wb") as stream, ZipFile(stream, "w") as content:  # pieces are compressed already
        for path in sorted(folder.rglob("*")):
            if path.is_file() and path.suffix != PARTIAL:
                content.write(path, path.relative_to(folder).as_posix())


def unpacked(archive: Path) -> tempfile.TemporaryDirectory[str]:
    """Return a folder beside the archive with all that can be read of it, which is removed with this object.

    Raises ``ValueError`` if it is no archive.
    """
    folder = tempfile.TemporaryDirectory(dir=archive.parent, prefix=f"{archive.stem}-")
    try:
        with ZipFile(archive) as content:
            for name in content.namelist():
                with suppress(BadZipFile, zlib.error, EOFError, NotImplementedError, RuntimeError, OSError):
                    content.extract(name, folder.name)
    except (BadZipFile, ValueError) as error:
        folder.cleanup()
        raise ValueError(str(error)) from None
    return folder
