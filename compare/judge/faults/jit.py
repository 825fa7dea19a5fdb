"""Compiled functions of the plain engine, kept on disk."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, TypeVar, cast

from reference_model.numerics.compiled_once import Kept

Function = TypeVar("Function", bound=Callable[..., Any])


def compiled(function: Function) -> Function:
    """Compile ``function`` at its first call, or take what an earlier process left."""
    return cast(Function, Kept(function, targetoptions={"error_model": "numpy"}))
