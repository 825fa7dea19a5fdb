"""Compiled functions of the plain engine, kept on disk."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, TypeVar, cast

import numba

from reference_model.numerics.compiled_once import Kept

Function = TypeVar("Function", bound=Callable[..., Any])


def compiled(function: Function) -> Function:
    """Compile ``function`` at its first call, or take what an earlier process left."""
    return cast(Function, Kept(function, targetoptions={"error_model": "numpy"}))


def for_types_of(function: Function, *arguments: Any) -> Function:
    """Return a compiled ``function`` that takes arguments of the types of these and of no others.

    numba spends three times as long on finding out the types of parameters as the functions of this engine take.
    """
    return cast(Function, cast(Any, function).compile(tuple(map(numba.typeof, arguments))))
