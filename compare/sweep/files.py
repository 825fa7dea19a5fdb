"""Files of a sweep by their names, in a folder or in an object store, by fsspec."""

from __future__ import annotations

import os
import tempfile
import zlib
from collections.abc import Iterator, Mapping
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any
from zipfile import BadZipFile, ZipFile

from compare.output.text_files import replacing

OPTIONS: dict[str, dict[str, Any]] = {
    "file": {"auto_mkdir": True},
    "s3": {
        # a listing that was kept would not have what others have written since
        "use_listings_cache": False,
        # files are small: to ask for their size first, so as to fetch parts side by side, costs a second request
        "max_concurrency": 1,
        # a server that is gone for half a minute loses nothing
        "config_kwargs": {"retries": {"mode": "standard", "max_attempts": 10}},
    },
}
"""Of the file systems of fsspec, by the protocol."""


class StoreError(RuntimeError):
    """Files can't be written or reached; the message says where and why."""


@dataclass(frozen=True)
class Files:
    """The files below ``url``: a folder of this machine, or what fsspec opens, "s3://bucket/name" for instance.

    Names are relative, with "/". It can be sent to another process, which sees the same files.
    """

    url: str

    @classmethod
    def at(cls, place: str | Path) -> Files:
        """Return the files at a place, of which a folder may be relative to the current one."""
        return cls(str(place) if is_remote(place) else os.path.abspath(place))

    @cached_property
    def options(self) -> dict[str, Any] | None:
        """What Zarr and xarray need besides the URL."""
        protocol = self.url.partition("://")[0]
        return OPTIONS.get(protocol, {}) if is_remote(self.url) else None

    @cached_property
    def _system(self) -> tuple[Any, str]:
        from fsspec.core import url_to_fs

        try:
            system, root = url_to_fs(self.url, **(OPTIONS["file"] if self.options is None else self.options))
        except ImportError:
            needed = "s3fs: pip install 'friction-discs[cluster]'" if self.url.startswith("s3:") else "more"
            raise StoreError(f"{self.url!r} needs {needed}") from None
        except ValueError as error:  # of a protocol that it does not know
            raise StoreError(f"cannot open {self.url!r}: {error}; use a folder or s3://BUCKET/NAME") from None
        return system, root

    def below(self, name: str) -> str:
        """Return the URL of a file or folder."""
        return f"{self.url}/{name}"

    def read(self, name: str) -> bytes | None:
        """Return the contents of a file, None if it is not there."""
        system, root = self._system
        with told(self.url, "read from"):
            try:
                return bytes(system.cat_file(f"{root}/{name}"))
            except (FileNotFoundError, NotADirectoryError, IsADirectoryError):
                return None

    def write(self, contents: Mapping[str, bytes]) -> None:
        """Write files, those that are there too."""
        system, root = self._system
        with told(self.url):
            system.pipe({f"{root}/{name}": content for name, content in contents.items()})

    def claim(self, name: str, content: bytes) -> None:
        """Write a file that nobody else has written; raise ``FileExistsError`` otherwise."""
        system, root = self._system
        path = f"{root}/{name}"
        with told(self.url):
            system.makedirs(system._parent(path), exist_ok=True)
            try:
                with system.open(path, "xb") as stream:
                    stream.write(content)
            except FileExistsError:
                raise
            except BaseException:  # half of it would stay in a folder
                system.rm(path)
                raise

    def names(self, folder: str) -> list[str]:
        """Return the names of all files below a folder, sorted."""
        system, root = self._system
        with told(self.url, "read from"):
            return sorted(path[len(root) + 1 :] for path in system.find(f"{root}/{folder}"))

    def inside(self, folder: str = "") -> list[str]:
        """Return the names, relative to it, of what lies directly in a folder."""
        system, root = self._system
        path = f"{root}/{folder}".rstrip("/")
        with told(self.url, "read from"):
            try:
                found = system.ls(path, detail=False)
            except (FileNotFoundError, NotADirectoryError):
                return []
            return sorted({one.rstrip("/")[len(path) + 1 :] for one in found} - {""})

    def remove(self, folder: str) -> None:
        """Remove a folder with all that is in it; it need not be there."""
        system, root = self._system
        with told(self.url):
            if system.exists(f"{root}/{folder}"):
                system.rm(f"{root}/{folder}", recursive=True)


def is_remote(place: str | Path) -> bool:
    """Return whether a place is a URL, and no folder of this machine."""
    return "://" in str(place)


@contextmanager
def told(url: str, action: str = "write to") -> Iterator[None]:
    """Turn whatever a file system raises inside into a ``StoreError``; what is there already stays what it is."""
    try:
        yield
    except (FileExistsError, MemoryError, StoreError):
        raise
    except Exception as error:  # each file system has its own
        reason = getattr(error, "strerror", None) or " ".join(str(error).split()) or type(error).__name__
        raise StoreError(f"cannot {action} {url!r}: {reason}") from error


# --- A small finished store as one file: a ZIP archive, which Zarr opens as it is.

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
