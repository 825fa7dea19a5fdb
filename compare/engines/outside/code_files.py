"""Files of other people's code, found by their endings: nothing is imported or run."""

from __future__ import annotations

import os
from collections.abc import Iterable
from importlib.machinery import BYTECODE_SUFFIXES, all_suffixes
from pathlib import Path

MODULES = tuple(set(all_suffixes()) - set(BYTECODE_SUFFIXES))
"""Endings of what Python imports: sources and compiled extensions."""


def code_below(folders: Iterable[str | Path], endings: tuple[str, ...] = MODULES) -> set[Path]:
    """Return the files in folders with one of the ``endings``, and those in packages inside.

    A folder whose name is not an identifier, as ``site-packages`` or ``.venv``, is not a package and is left out.
    """
    found, seen = set[Path](), set[str]()
    for folder in folders:
        for place, inside, names in os.walk(folder, followlinks=True):
            new = os.path.realpath(place) not in seen  # a link may lead back
            seen.add(os.path.realpath(place))
            inside[:] = [name for name in inside if new and name.isidentifier() and name != "__pycache__"]
            found.update(Path(place, name) for name in names if name.endswith(endings))
    return {path for path in found if path.is_file()}
