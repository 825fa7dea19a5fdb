"""Decorators for compiled functions.

Results must be bitwise identical in any lane, on any number of threads, and on machines with and without FMA, so the
compiler must not reorder or contract operations.
"""

import math
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any, TypeVar, cast

import numba
import numba.extending

from reference_model.numerics.cache_folders import digest_of
from reference_model.numerics.compiled_once import CompiledOnce

extending: Any = numba.extending  # not fully typed

PART: Any = {"error_model": "numpy", "no_cpython_wrapper": True, "no_cfunc_wrapper": True}
"""Options of functions that only compiled code calls: wrappers take time to compile."""

INLINED: Any = {**PART, "forceinline": True}
"""Options of overloads."""

SOURCES = Path(__file__).parents[2]

DIGEST = "-".join(digest_of(SOURCES / package) for package in ("ensemble", "core", "trajectory"))
"""Digests of all sources with compiled functions or constants."""

Function = TypeVar("Function", bound=Callable[..., Any])


def inlined(function: Function) -> Function:
    """Compile ``function`` into each caller, so that loops over lanes can be vectorised."""
    return cast(Function, extending.register_jitable(**INLINED)(function))


def scalar(function: Function) -> Function:
    """Compile ``function`` to be called, not inlined, because it is large or has several callers.

    LLVM optimises it again in each direct or indirect caller, so few functions in a chain of calls should be scalar.
    """
    return cast(Function, extending.register_jitable(**PART)(function))


def written_out(function: Function) -> Function:
    """Insert ``function`` into its only caller before compilation, with the functions passed to it.

    numba copies all variables for each block, so the time grows with the square of the size of ``function``.
    """
    return cast(Function, numba.njit(error_model="numpy", inline="always")(function))


def called_from_python(function: Callable[..., None]) -> CompiledOnce:
    return CompiledOnce(function, SOURCES, DIGEST)


def generated(arguments: str, lines: Sequence[str]) -> Callable[..., Any]:
    """Return a function with these ``arguments`` and ``lines``, for code that must be unrolled."""
    namespace: dict[str, Any] = {"math": math}
    exec("\n    ".join([f"def function({arguments}):", *lines]), namespace)
    function: Callable[..., Any] = namespace["function"]
    return function


@extending.intrinsic  # type: ignore[untyped-decorator]
def wide_vectors(typing: Any) -> Any:
    """Let the calling function use the widest vectors of the processor, without effect on results.

    LLVM uses 256 bits on many processors that have 512.
    """

    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        set.add(builder.function.attributes, '"prefer-vector-width"="512"')  # ``add`` accepts no value
        return context.get_dummy_value()

    return numba.void(), generate
