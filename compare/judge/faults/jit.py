"""Compiled functions of the plain engine, kept on disk."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, TypeVar, cast

import numba

from reference_model.numerics.compiled_cache import known_by_content

Function = TypeVar("Function", bound=Callable[..., Any])


def compiled(function: Function) -> Function:
    """Compile ``function`` at its first call, or take what an earlier process left."""
    dispatcher = numba.njit(cache=True, error_model="numpy")(function)
    known_by_content(dispatcher)
    return cast(Function, dispatcher)
