"""Compiled functions: those that are taken over into their callers, and the outermost ones, which Python calls.

Results must be the same bit by bit in any lane, on any number of threads, and on workers with and without FMA: so
nothing here may be reordered or contracted (``fastmath`` stays off; FMA would make the steps faster by a tenth).
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cached_property
from typing import Any, TypeVar, cast

import numba

from reference_model.numerics.compiled_once import Kept
from reference_model.numerics.compiled_parts import Part, PartCompiler
from reference_model.numerics.machine_code import kind_of, machine_code

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


class Outermost:
    """A function that Python calls: as it came with the package, or else compiled at its first call and kept.

    Attributes
    ----------
    py_func : function
        As it was written.
    kinds : dict
        What it is compiled to, for each kind of arguments with which it was called.

    """

    def __init__(self, function: Callable[..., None]) -> None:
        self.py_func = function
        self.kinds: dict[str, Callable[..., None]] = {}
        self.__doc__ = function.__doc__

    def __call__(self, *arguments: Any) -> None:
        """Call it without Python's lock; the arguments are numbers, C-contiguous arrays, and tuples of these."""
        kind = kind_of(arguments)
        if kind not in self.kinds:
            self.kinds[kind] = machine_code(self.py_func, kind) or self.compiled_here
        self.kinds[kind](*arguments)

    @cached_property
    def compiled_here(self) -> Kept:
        """The function, compiled for this machine, or taken from what an earlier process left."""
        return Kept(self.py_func, targetoptions={"error_model": "numpy", "nogil": True})


def outermost(function: Callable[..., None]) -> Outermost:
    """Let Python call ``function``, compiled."""
    return Outermost(function)
