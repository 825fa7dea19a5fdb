"""Compiled functions whose cache on disk forgets them when any module of this package has changed.

numba forgets a function when the file of it changes, but the code of the functions that it calls is part of it too,
and they may come from other files.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import Any, TypeVar, cast

import numba

Function = TypeVar("Function", bound=Callable[..., Any])


def compiled(function: Function) -> Function:
    """Compile ``function`` at its first call, or take what an earlier process left."""
    dispatcher = numba.njit(cache=True, error_model="numpy")(function)
    forget_outdated(dispatcher.stats.cache_path, str(Path(__file__).parent))
    return cast(Function, dispatcher)


@cache
def forget_outdated(folder: str, sources: str) -> None:
    """Delete the indices of numba's cache in ``folder`` that are older than a module in ``sources``."""
    newest = max(path.stat().st_mtime_ns for path in Path(sources).glob("*.py"))
    for index in Path(folder).glob("*.nbi"):
        try:
            if index.stat().st_mtime_ns < newest:
                index.unlink()
        except FileNotFoundError:
            pass  # another process was faster
