"""Registration of plain functions, which run interpreted until compiled code is asked for."""

from collections.abc import Callable
from types import FunctionType
from typing import Any, TypeVar, cast

from reference_model.numerics.cache_folders import digest_of_text

Function = TypeVar("Function", bound=Callable[..., Any])

PARTS: list[Callable[..., Any]] = []
"""Functions that compiled code calls."""

INLINED: list[Callable[..., Any]] = []
"""Functions that are small and called often."""

WRITTEN_OUT: list[Callable[..., Any]] = []
"""Those that are large and have one caller."""

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


def written_out(function: Function) -> Function:
    """Register a part for insertion into its caller, because LLVM optimises a called part again with each caller."""
    WRITTEN_OUT.append(part(function))
    return function


def replaced_by(other: Callable[..., Any]) -> Callable[[Function], Function]:
    """Register a function that needs Python, and ``other`` with the same arguments for compiled code."""

    def register(function: Function) -> Function:
        REPLACED[function] = other
        return function

    return register


def prepared(function: Function) -> Function:
    """Return ``function`` for numba, which then compiles parts into their callers."""
    from numba.extending import overload, register_jitable

    for each in PARTS:
        inline = {"forceinline": True, "_nrt": False} if each in INLINED else {}
        register_jitable(error_model="numpy", no_cpython_wrapper=True, no_cfunc_wrapper=True, **inline)(each)
    for each, other in REPLACED.items():
        overload(each, strict=False)(_always(other))
    return _with_written_out(function)


def _with_written_out(function: Function) -> Function:
    from numba import njit

    names, code = function.__globals__, function.__code__
    inserted = {
        name: njit(inline="always", error_model="numpy")(_with_written_out(names[name]))
        for name in code.co_names
        if any(names.get(name) is each for each in WRITTEN_OUT)
    }
    whole = FunctionType(code, {**names, **inserted}, function.__name__)
    whole.__module__, whole.__qualname__ = function.__module__, function.__qualname__
    return cast(Function, whole)


def _always(other: Callable[..., Any]) -> Callable[..., Any]:
    return lambda *_: other


def digest_with_parts(function: Callable[..., None]) -> str:
    """Return a digest of the text of ``function`` and of all parts, and of the constants in it."""
    parts = sorted(
        [*PARTS, *INLINED, *REPLACED.values()], key=_name_of
    )  # independent of the order of imports
    return digest_of_text([*parts, function, prepared])


def _name_of(function: Callable[..., Any]) -> tuple[str, str]:
    return str(function.__module__), function.__name__
