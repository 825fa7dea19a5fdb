"""Compiled functions: kept on disk, and called from Exudyn in the cheapest way.

Exudyn passes coordinates to a user function as lists of floats. Of a call with 14 numbers numba spends 180 ns on
finding out their types, and Python 60 ns on unpacking and packing lists: ``taking_lists`` does without both.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import Any, TypeVar, cast

import numba
import numba.extending

from reference_model.numerics.compiled_once import compiled_for, digest_of

extending: Any = numba.extending  # not typed throughout

SOURCES = Path(__file__).parents[1]
"""The folder of all sources of a compiled function."""

digest_of(SOURCES)

Function = TypeVar("Function", bound=Callable[..., Any])


def compiled(function: Function) -> Function:
    """Compile ``function`` into compiled functions that call it; ``taking_lists`` compiles it for Python."""
    return cast(Function, numba.njit(error_model="numpy")(function))


class Floats(numba.types.UniTuple):
    """A list of floats, which compiled code sees as a tuple."""


def _tuple_of_list(kind: Floats, argument: Any, context: Any) -> Any:
    api = context.pyapi
    # What is no list or too short for an item leaves an error behind, also if it goes on from there as no float.
    items = [api.float_as_double(api.list_getitem(argument, i)) for i in range(len(kind))]
    value = context.context.make_tuple(context.builder, kind, items)
    return extending.NativeValue(value, is_error=api.c_api_error())


extending.register_model(Floats)(extending.models.UniTupleModel)
extending.unbox(Floats)(_tuple_of_list)


@cache
def taking_lists(function: Callable[..., Any], *sizes: Any) -> Callable[..., Any]:
    """Return a compiled function of tuples as one of lists of as many floats, without numba's choice by type.

    ``sizes`` says for every argument how long its list is; or it is ``float``, or a type of numba, or None for an
    argument that the function does not look at, which may be anything.

    Raises, when it is called, ``TypeError`` for anything else than lists of numbers, or if one is too short.
    """
    floats: Any = Floats
    kinds = {None: numba.none, float: numba.float64}
    signature = tuple(
        floats(numba.float64, size) if isinstance(size, int) else kinds.get(size, size) for size in sizes
    )
    dispatcher = compiled_for(signature, cast(Any, function).py_func, SOURCES)
    return cast(Callable[..., Any], dispatcher.get_overload(signature))
