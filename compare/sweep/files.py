"""Files of a sweep in a folder or an object store, accessed with fsspec."""

from __future__ import annotations

import errno
import os
import stat
import tempfile
import zlib
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any
from zipfile import BadZipFile, ZipFile

from compare.output.outside_text import reason_of
from compare.output.text_files import replacing

OPTIONS: dict[str, dict[str, Any]] = {
    "file": {"auto_mkdir": True},
    "s3": {
        # a cached listing would lack files of other workers
        "use_listings_cache": False,
        # parallel parts of small files would only cost a second request
        "max_concurrency": 1,
        # survive an outage of half a minute
        "config_kwargs": {"retries": {"mode": "standard", "max_attempts": 10}},
    },
}
"""Options of fsspec by protocol."""


class StoreError(RuntimeError):
    """Files cannot be written or reached; the message gives the place and the reason."""


@dataclass(frozen=True)
class Files:
    """Files below ``url``, a local folder or an fsspec URL such as "s3://bucket/name".

    Names are relative, with "/".
    """

    url: str

    @classmethod
    def at(cls, place: str | Path) -> Files:
        """Return the files at a URL or in a folder."""
        return cls(str(place) if is_remote(place) else os.path.abspath(place))

    @cached_property
    def options(self) -> dict[str, Any] | None:
        """Options for Zarr and xarray; None for a folder."""
        protocol = self.url.partition("://")[0]
        return OPTIONS.get(protocol, {}) if is_remote(self.url) else None

    @cached_property
    def _system(self) -> tuple[Any, str]:
        from fsspec.core import url_to_fs

        try:
            system, root = url_to_fs(self.url, **(OPTIONS["file"] if self.options is None else self.options))
        except ImportError as error:
            s3 = "s3fs; install it with: pip install s3fs"
            needed = s3 if self.url.startswith("s3:") else f"a package that is not installed: {error}"
            raise StoreError(f"{self.url!r} needs {needed}") from None
        except ValueError as error:  # unknown protocol
            raise StoreError(f"cannot open {self.url!r}: {error}; use a folder or s3://BUCKET/NAME") from None
        return system, root

    def below(self, name: str) -> str:
        """Return the URL of a file or folder."""
        return f"{self.url}/{name}"

    def read(self, name: str) -> bytes | None:
        """Return the contents of a file, None if it does not exist."""
        system, root = self._system
        with store_errors(self.url, "read from"):
            try:
                return bytes(system.cat_file(f"{root}/{name}"))
            except (FileNotFoundError, NotADirectoryError, IsADirectoryError):
                return None

    def write(self, contents: Mapping[str, bytes]) -> None:
        """Write files, in a folder atomically; replace existing files."""
        system, root = self._system
        with store_errors(self.url):
            if self.options is not None:
                system.pipe({f"{root}/{name}": content for name, content in contents.items()})
                return
            for name, content in contents.items():
                path = Path(self.below(name))
                path.parent.mkdir(parents=True, exist_ok=True)
                with replacing(path, "wb") as stream:
                    stream.write(content)

    def claim(self, name: str, content: bytes) -> None:
        """Write a new file; raise ``FileExistsError`` if it exists."""
        system, root = self._system
        path = f"{root}/{name}"
        with store_errors(self.url):
            system.makedirs(system._parent(path), exist_ok=True)
            try:
                with system.open(path, "xb") as stream:
                    stream.write(content)
            except FileExistsError:
                raise
            except BaseException:  # do not leave an incomplete file
                system.rm(path)
                raise

    def names(self, folder: str) -> list[str]:
        """Return the names of all files below a folder, sorted."""
        system, root = self._system
        with store_errors(self.url, "read from"):
            return sorted(path[len(root) + 1 :] for path in system.find(f"{root}/{folder}"))

    def inside(self, folder: str = "") -> list[str]:
        """Return the names of the files and folders directly in a folder."""
        system, root = self._system
        path = f"{root}/{folder}".rstrip("/")
        with store_errors(self.url, "read from"):
            try:
                found = system.ls(path, detail=False)
            except (FileNotFoundError, NotADirectoryError):
                return []
            return sorted({one.rstrip("/")[len(path) + 1 :] for one in found} - {""})

    def remove(self, folder: str) -> None:
        """Remove a folder and its contents if it exists."""
        system, root = self._system
        with store_errors(self.url):
            if system.exists(f"{root}/{folder}"):
                system.rm(f"{root}/{folder}", recursive=True)


def is_remote(place: str | Path) -> bool:
    """Return whether a place is a URL instead of a local folder."""
    return "://" in str(place)


@contextmanager
def store_errors(url: str, action: str = "write to") -> Iterator[None]:
    """Turn exceptions of a file system into ``StoreError``, except ``FileExistsError`` and ``MemoryError``."""
    try:
        yield
    except (FileExistsError, MemoryError, StoreError):
        raise
    except Exception as error:  # each file system has its own exceptions
        reason = getattr(error, "strerror", None) or reason_of(error)
        raise StoreError(f"cannot {action} {url!r}: {reason}") from error


# --- A small finished store as one ZIP archive, which Zarr opens directly

PARTIAL = ".partial"  # suffix of files that Zarr left when its process was killed
BLOCK = 64  # bytes that count for an empty file
MOST_DESCRIBED = 1_000_000  # bytes of a description
FULL = errno.ENOSPC, errno.EDQUOT


def pack(folder: Path, archive: Path) -> None:
    """Write a store to an archive, which is never incomplete."""
    with replacing(archive, "wb") as stream, ZipFile(stream, "w") as content:  # pieces are already compressed
        for path in files_in(folder):
            if path.suffix != PARTIAL:
                content.write(path, path.relative_to(folder).as_posix())


def files_in(folder: Path) -> list[Path]:
    """Return all files below a folder, sorted; raise ``ValueError`` for links, pipes and devices."""
    found = [(path, path.lstat().st_mode) for path in sorted(folder.rglob("*"))]
    for path, mode in found:
        if not stat.S_ISREG(mode) and not stat.S_ISDIR(mode):
            raise ValueError(
                f"{str(path)!r} is a link, pipe or device; a store contains only files, so remove it"
            )
    return [path for path, mode in found if stat.S_ISREG(mode)]


def member(archive: Path, name: str) -> bytes:
    """Return the contents of a small file in an archive; raise an exception of any kind if it is missing."""
    if not archive.is_file():  # reading a pipe could take for ever
        raise ValueError(f"{str(archive)!r} is not a file")
    with ZipFile(archive) as content, content.open(name) as stream:
        return stream.read(MOST_DESCRIBED)


def unpacked(archive: Path, most: int) -> tempfile.TemporaryDirectory[str]:
    """Return a temporary folder next to the archive with its readable files.

    Raises ``ValueError`` if these have more than ``most`` bytes, and ``StoreError`` if the disk is full.
    """
    with ZipFile(archive) as content:
        if (size := sum(BLOCK + one.file_size for one in content.infolist())) > most:
            raise ValueError(
                f"{str(archive)!r} takes {size} bytes unpacked, but its description allows {most}"
            )
        folder = tempfile.TemporaryDirectory(
            dir=archive.parent, prefix=f"{archive.stem}-", ignore_cleanup_errors=True
        )
        for name in content.namelist():
            try:
                content.extract(name, folder.name)
            except (BadZipFile, zlib.error, EOFError, NotImplementedError, RuntimeError, OSError) as error:
                if isinstance(error, OSError) and error.errno in FULL:  # else the archive is damaged
                    folder.cleanup()
                    raise StoreError(f"cannot write to {folder.name!r}: {error.strerror}") from None
    return folder
