"""Files that are never incomplete: written under a temporary name and then renamed."""

import os
import shutil
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import IO, Any

PART = ".part"


@contextmanager
def replacing(path: Path, mode: str = "w") -> Iterator[IO[Any]]:
    """Yield a stream for the new contents of a file; an exception inside leaves the old contents.

    Pipes and devices are written directly.
    """
    path = _target(path)
    text: dict[str, Any] = {} if "b" in mode else {"encoding": "utf-8", "newline": "\n"}
    if path.exists() and not path.is_file():
        with open(path, mode, **text) as stream:
            yield stream
        return
    part = path.with_name(path.name + PART)
    try:
        with open(part, mode, **text) as stream:
            yield stream
        with suppress(FileNotFoundError):
            shutil.copymode(path, part)
        os.replace(part, path)
    except BaseException:
        part.unlink(missing_ok=True)
        raise


def write_text(path: Path, text: str) -> None:
    """Write a file atomically."""
    with replacing(path) as stream:
        stream.write(text)


def check_writable(path: Path) -> None:
    """Raise ``OSError`` if a file cannot be written; change no existing file."""
    path = _target(path)
    if path.is_file() or path.is_dir():
        with open(path, "ab"):
            pass
    if path.is_file() or not path.exists():
        part = path.with_name(path.name + PART)
        with open(part, "wb"):
            pass
        part.unlink()


def _target(path: Path) -> Path:
    """Return the target of a link, which is replaced instead of the link."""
    return Path(os.path.realpath(path))
