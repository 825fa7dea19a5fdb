"""Compiled functions: those that are taken over into their callers, and the outermost ones, which Python calls.

Results must be the same bit by bit in any lane, on any number of threads, and on workers with and without FMA: so
nothing here may be reordered or contracted (``fastmath`` stays off; FMA would make the steps faster by a tenth).
"""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any, TypeVar, cast

import numba
import numba.extending

from reference_model.numerics.compiled_once import CompiledOnce

extending: Any = numba.extending  # not typed throughout

PART: Any = {"error_model": "numpy", "no_cpython_wrapper": True, "no_cfunc_wrapper": True}
"""For functions that only compiled code calls: wrappers for Python would take time to compile."""

INLINED: Any = {**PART, "forceinline": True}
"""Of overloads, to be compiled as what is ``scalar`` or ``inlined``."""

SOURCES = Path(__file__).parents[2]
"""The folder of all sources of a kernel; some of its constants stand outside of ``ensemble``."""

Function = TypeVar("Function", bound=Callable[..., Any])


def inlined(function: Function) -> Function:
    """Compile ``function`` into each of its callers, so that a loop over lanes that calls it can be vectorised."""
    return cast(Function, extending.register_jitable(**INLINED)(function))


def scalar(function: Function) -> Function:
    """Compile ``function`` as one that its callers call: it is large, or has several callers.

    numba compiles it again with each function that calls it, directly or through others. So in a chain of calls only
    some functions should be scalar, and the others ``written_out``.
    """
    return cast(Function, extending.register_jitable(**PART)(function))


def written_out(function: Function) -> Function:
    """Write ``function`` into its only caller before numba compiles that, with the functions passed to it.

    So it is compiled once. A function that is called would be compiled by itself and then again with its caller.
    """
    return cast(Function, numba.njit(error_model="numpy", inline="always")(function))


def outermost(function: Callable[..., None]) -> CompiledOnce:
    """Compile ``function`` as one that Python calls."""
    return CompiledOnce(function, SOURCES)


@extending.intrinsic  # type: ignore[untyped-decorator]
def wide_vectors(typing: Any) -> Any:
    """Let the calling function use the widest vectors of the processor.

    LLVM uses 256 bits on many processors that have 512, because wide vectors once slowed their clock. Lanes full of
    arithmetic gain more than that costs (figures: ``benchmarks/ensemble.py``). Results do not depend on the width.
    """

    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        set.add(builder.function.attributes, '"prefer-vector-width"="512"')  # ``add`` takes no value
        return context.get_dummy_value()

    return numba.void(), generate
