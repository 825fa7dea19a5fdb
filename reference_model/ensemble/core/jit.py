"""Compiled functions: those that are taken over into their callers, and the outermost ones, kept on disk.

Results must be the same bit by bit in any lane, on any number of threads, and on workers with and without FMA: so
nothing here may be reordered or contracted (``fastmath`` stays off; FMA would make the steps faster by a tenth).
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, TypeVar, cast

import numba

from reference_model.numerics.compiled_once import Kept
from reference_model.numerics.compiled_parts import Part, PartCompiler

PART: Any = {"error_model": "numpy", "pipeline_class": PartCompiler}
INLINED: Any = {**PART, "forceinline": True}
"""Of overloads, to be compiled as what is ``scalar`` or ``inlined``."""

Function = TypeVar("Function", bound=Callable[..., Any])


def inlined(function: Function) -> Function:
    """Compile ``function`` into each of its callers, so that a loop over lanes that calls it can be vectorised."""
    return cast(Function, Part(function, targetoptions={"error_model": "numpy", "forceinline": True}))


def scalar(function: Function) -> Function:
    """Compile ``function`` as one that its callers call: it is rare, and large."""
    return cast(Function, Part(function, targetoptions={"error_model": "numpy"}))


def written_out(function: Function) -> Function:
    """Write ``function`` into its one caller before that is compiled, with the functions that it is handed over.

    So it is compiled once, where one that is called would be compiled by itself and then again with its caller.
    """
    return cast(Function, numba.njit(error_model="numpy", inline="always")(function))


def outermost(function: Function) -> Function:
    """Compile ``function``, which Python calls, at its first call, or take what an earlier process left."""
    return cast(Function, Kept(function, targetoptions={"error_model": "numpy", "nogil": True}))
