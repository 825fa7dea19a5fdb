"""Files that are never incomplete, and folders that one process writes at a time."""

import errno
import json
import math
import os
import platform
import secrets
import shutil
import stat
import tempfile
import weakref
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import IO, Any

from compare.output.outside_text import all_printable

with suppress(ImportError):  # on Windows
    import fcntl

PART = ".part"

LOCK = ".lock"

LARGEST = 1 << 28
"""Largest size in bytes of a file that is read as a whole."""


@contextmanager
def replacing(path: Path, mode: str = "w") -> Iterator[IO[Any]]:
    """Yield a stream for the new contents of a file; an exception inside leaves the old contents.

    An ``OSError`` gets the file's name if it has none. Several processes may replace one file at a time: the last
    process wins. Pipes and devices are written directly.
    """
    path = _target(path)
    text: dict[str, Any] = {} if "b" in mode else {"encoding": "utf-8", "newline": "\n"}
    if path.exists() and not path.is_file():
        with open(path, mode, **text) as stream:
            yield stream
        return
    part = path.with_name(f".{secrets.token_hex(8)}{PART}")
    try:
        with open(part, mode.replace("w", "x"), **text) as stream:
            weakref.finalize(stream, _remove, part)  # if the process ends while it writes
            yield stream
        with suppress(FileNotFoundError):
            shutil.copymode(path, part)
        os.replace(part, path)
    except BaseException as error:
        _remove(part)
        if isinstance(error, OSError) and error.filename in (None, str(part)):
            error.filename = str(path)
        raise


def write_text(path: Path, text: str) -> None:
    """Write a file atomically."""
    with replacing(path) as stream:
        stream.write(text)


def check_writable(path: Path) -> None:
    """Raise ``OSError`` if a file cannot be written; touch nothing that exists."""
    path = _target(path)
    try:
        mode = path.stat().st_mode  # a name may be too long
    except FileNotFoundError:
        mode = stat.S_IFREG
    else:
        code = errno.EISDIR if stat.S_ISDIR(mode) else 0 if os.access(path, os.W_OK) else errno.EACCES
        if code:
            raise OSError(code, os.strerror(code), str(path))
    if stat.S_ISREG(mode):
        tempfile.TemporaryFile(dir=path.parent).close()


def read_file(path: Path, most: int = LARGEST) -> bytes:
    """Return the contents of a regular file of up to ``most`` bytes; raise ``OSError`` for any other file."""

    def opened(name: str, flags: int) -> int:  # opening a pipe would wait for a writer
        return os.open(name, flags | getattr(os, "O_NONBLOCK", 0))

    with open(path, "rb", opener=opened) as stream:
        if not stat.S_ISREG(os.fstat(stream.fileno()).st_mode):
            raise OSError(errno.EINVAL, "not a regular file", str(path))
        content = stream.read(most + 1)
    if len(content) > most:
        raise OSError(errno.EFBIG, f"larger than {most} bytes", str(path))
    return content


def read_json(path: Path) -> Any:
    """Return the JSON value in a file, with printable texts.

    Raises ``OSError`` if the file cannot be read, and ``ValueError`` for other text and infinite numbers.
    """
    try:
        numbers: dict[str, Any] = {"parse_int": _whole, "parse_float": _finite, "parse_constant": _finite}
        return all_printable(json.loads(read_file(path), **numbers))
    except RecursionError:
        raise ValueError("its brackets are nested too deeply") from None


def _whole(text: str) -> int:
    _finite(text)
    return int(text)


def _finite(text: str) -> float:
    if not math.isfinite(number := float(text)):
        raise ValueError(f"{text} is not a finite number")
    return number


@contextmanager
def locked(folder: Path) -> Iterator[None]:
    """Hold a folder in this context, at most until the process ends.

    Raises ``BlockingIOError`` with the process that holds it. File systems without locks do not protect the folder.
    """
    path = folder / LOCK
    while True:
        with open(path, "a+", encoding="utf-8", opener=_not_a_link) as file:
            try:
                fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
            except BlockingIOError as error:
                file.seek(0)
                holder = file.read(100) or "another process"
                reason = f"{holder} is writing to it; wait until it ends, or choose another folder"
                raise BlockingIOError(error.errno, reason, str(path)) from None
            except (NameError, OSError):
                pass
            if not (path.exists() and os.path.samestat(os.fstat(file.fileno()), path.stat())):
                continue  # the last holder has just removed it
            remove = weakref.finalize(file, _remove, path)  # also if the process ends
            try:
                file.truncate(0)
                print(f"process {os.getpid()} on {platform.node()}", end="", file=file, flush=True)
                yield
            finally:
                remove()
                with suppress(OSError):
                    file.close()
            return


def _remove(path: Path) -> None:
    with suppress(OSError):
        path.unlink()


def _not_a_link(path: str, flags: int) -> int:
    return os.open(path, flags | getattr(os, "O_NOFOLLOW", 0), 0o666)


def _target(path: Path) -> Path:
    """Return the target of a link, which is replaced instead of the link."""
    return Path(os.path.realpath(path))
