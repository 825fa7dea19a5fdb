"""Files that are whole at every moment: written beside, and put in place when nothing can go wrong any more."""

from __future__ import annotations

import os
import shutil
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import IO, Any

PART = ".part"
"""What the name of a file that is being written ends in."""


@contextmanager
def replacing(path: Path, mode: str = "w") -> Iterator[IO[Any]]:
    """Yield a stream for the new contents of a file, which keeps the old ones if anything is raised inside.

    What is no ordinary file, a pipe or a device, is written to as it is.
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
    except BaseException:  # Ctrl-C too
        part.unlink(missing_ok=True)
        raise


def write_text(path: Path, text: str) -> None:
    """Write a file that is either the old or the new one, whole, at every moment."""
    with replacing(path) as stream:
        stream.write(text)


def check_writable(path: Path) -> None:
    """Raise ``OSError`` if a file can't be written; leave what is there as it is."""
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
    """Return what a link leads to: it stays, and its target is replaced."""
    return Path(os.path.realpath(path))
