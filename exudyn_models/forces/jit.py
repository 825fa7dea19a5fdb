"""Compiled functions, kept on disk, that Exudyn calls with little overhead.

For a list of 14 coordinates, numba spends 180 ns on finding types, and Python 60 ns on unpacking and packing.
``taking_lists`` avoids both.
"""

from __future__ import annotations

from collections.abc import Callable
from contextlib import suppress
from functools import cache
from pathlib import Path
from typing import Any, TypeVar, cast

import numba
import numba.extending

from reference_model.numerics.compiled_once import compiled_for, digest_of

extending: Any = numba.extending  # not fully typed

SOURCES = Path(__file__).parents[1]

digest_of(SOURCES)

Function = TypeVar("Function", bound=Callable[..., Any])


def compiled(function: Function) -> Function:
    """Compile ``function`` for calls from compiled code."""
    return cast(Function, numba.njit(error_model="numpy")(function))


def inlined(function: Function) -> Function:
    """Compile ``function`` into its callers, which saves copies of a large result."""
    return cast(Function, numba.njit(error_model="numpy", forceinline=True)(function))


class Floats(numba.types.UniTuple):
    """A list of floats, which compiled code sees as a tuple."""


def _tuple_of_list(kind: Floats, argument: Any, context: Any) -> Any:
    api = context.pyapi
    # A missing item or one that is not a float sets an error, which is checked after all items.
    items = [api.float_as_double(api.list_getitem(argument, i)) for i in range(len(kind))]
    value = context.context.make_tuple(context.builder, kind, items)
    return extending.NativeValue(value, is_error=api.c_api_error())


extending.register_model(Floats)(extending.models.UniTupleModel)
extending.unbox(Floats)(_tuple_of_list)


@cache
def taking_lists(function: Callable[..., Any], *sizes: Any) -> Callable[..., Any]:
    """Return a compiled function of tuples as a function of lists of floats, without numba's dispatch by type.

    ``sizes`` contains for each argument the length of its list, ``float``, a numba type, or None if it is unused. The
    function raises ``TypeError`` for an argument that is not a list of numbers or is too short.
    """
    floats: Any = Floats
    kinds = {None: numba.none, float: numba.float64}
    signature = tuple(
        floats(numba.float64, size) if isinstance(size, int) else kinds.get(size, size) for size in sizes
    )
    dispatcher = compiled_for(signature, cast(Any, function).py_func, SOURCES)
    return cast(Callable[..., Any], dispatcher.get_overload(signature))


class KeptOnDisk:
    """A ``compiled`` function for calls from Python, compiled once per machine for each set of argument types.

    Numba would spend 20 to 50 μs on the types of nested tuples, and a millisecond on a version for other types. So it
    remembers the version for each combination of Python types.
    """

    def __init__(self, function: Callable[..., Any]) -> None:
        self._function = cast(Any, function).py_func
        self._compiled: list[Callable[..., Any]] = []
        self._known: dict[tuple[Any, ...], Callable[..., Any]] = {}

    def __call__(self, *arguments: Any) -> Any:
        """Return the result of the function."""
        kinds = tuple(map(_python_types, arguments)) if len(self._compiled) > 1 else ()
        if kinds in self._known:
            with suppress(TypeError):
                return self._known[kinds](*arguments)
        for compiled_function in self._compiled:
            with suppress(TypeError):
                result = compiled_function(*arguments)
                if kinds:
                    self._known[kinds] = compiled_function
                return result
        self._compiled.append(compiled_for(tuple(map(numba.typeof, arguments)), self._function, SOURCES))
        return self._compiled[-1](*arguments)


def _python_types(argument: Any) -> Any:
    return tuple(map(type, argument)) if type(argument) is tuple else type(argument)
