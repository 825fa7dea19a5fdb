"""Registration of plain functions, which run interpreted until compiled code is asked for."""

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

if TYPE_CHECKING:
    from reference_model.numerics.compiled_once import CompiledOnce

Function = TypeVar("Function", bound=Callable[..., Any])

PARTS: list[Callable[..., Any]] = []
"""Functions that compiled code calls."""

INLINED: list[Callable[..., Any]] = []
"""Those that are small and called often."""


def part(function: Function) -> Function:
    """Register ``function``, plain Python on numbers, tuples and arrays, as a part of compiled code."""
    PARTS.append(function)
    return function


def inlined(function: Function) -> Function:
    """Register a part that is compiled into each caller, because a call would take longer than its work.

    It must neither create nor return arrays: counting references to them would take a third of the time of a step.
    """
    INLINED.append(part(function))
    return function


def compiled(function: Callable[..., None]) -> "CompiledOnce":
    """Return ``function``, which calls parts, as compiled code.

    The cache depends only on the text of these functions and of this one, and on the constants in it.
    """
    from numba.extending import register_jitable

    from reference_model.numerics.compiled_once import CompiledOnce, digest_of_text

    for each in PARTS:
        inline = {"forceinline": True, "_nrt": False} if each in INLINED else {}
        register_jitable(error_model="numpy", no_cpython_wrapper=True, no_cfunc_wrapper=True, **inline)(each)
    parts = sorted([*PARTS, *INLINED], key=_name_of)  # independent of the order of imports
    return CompiledOnce(function, Path(__file__).parent, digest_of_text([*parts, function, compiled]))


def _name_of(function: Callable[..., Any]) -> tuple[str, str]:
    return str(function.__module__), function.__name__
