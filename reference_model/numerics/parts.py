"""Registration of plain functions, which run interpreted until compiled code is asked for."""

from collections.abc import Callable
from typing import Any, TypeVar

from reference_model.numerics.cache_folders import digest_of_text

Function = TypeVar("Function", bound=Callable[..., Any])

PARTS: list[Callable[..., Any]] = []
"""Functions that compiled code calls."""

INLINED: list[Callable[..., Any]] = []
"""Functions that are small and called often."""

REPLACED: dict[Callable[..., Any], Callable[..., Any]] = {}
"""Functions that need Python, and their replacements in compiled code."""


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


def replaced_by(other: Callable[..., Any]) -> Callable[[Function], Function]:
    """Register a function that needs Python, and ``other`` with the same arguments for compiled code."""

    def register(function: Function) -> Function:
        REPLACED[function] = other
        return function

    return register


def register_parts() -> None:
    """Make numba compile parts into their callers."""
    from numba.extending import overload, register_jitable

    for each in PARTS:
        inline = {"forceinline": True, "_nrt": False} if each in INLINED else {}
        register_jitable(error_model="numpy", no_cpython_wrapper=True, no_cfunc_wrapper=True, **inline)(each)
    for each, other in REPLACED.items():
        overload(each, strict=False)(_always(other))


def _always(other: Callable[..., Any]) -> Callable[..., Any]:
    return lambda *_: other


def digest_with_parts(function: Callable[..., None]) -> str:
    """Return a digest of the text of ``function`` and of all parts, and of the constants in it."""
    parts = sorted(
        [*PARTS, *INLINED, *REPLACED.values()], key=_name_of
    )  # independent of the order of imports
    return digest_of_text([*parts, function, register_parts])


def _name_of(function: Callable[..., Any]) -> tuple[str, str]:
    return str(function.__module__), function.__name__
