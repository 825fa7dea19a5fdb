"""Compiled functions, kept on disk, that Exudyn calls with little overhead.

For a list of 14 coordinates, numba spends 180 ns on finding types, and Python 60 ns on unpacking and packing.
``entry_point`` and ``FLOATS`` avoid both, and one version serves lists of any length.
"""

from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import Any, TypeVar, cast

import numba
import numba.core.cgutils
import numba.extending
from llvmlite import ir
from numba.core import types

from reference_model.numerics.cache_folders import digest_of
from reference_model.numerics.compiled_once import compiled_for

extending: Any = numba.extending  # not fully typed
cgutils: Any = numba.core.cgutils
_types: Any = types
_numba: Any = numba

SOURCES = Path(__file__).parents[1]

digest_of(SOURCES)

Function = TypeVar("Function", bound=Callable[..., Any])


def compiled(function: Function) -> Function:
    """Compile ``function`` for calls from compiled code."""
    return cast(Function, numba.njit(error_model="numpy")(function))


def inlined(function: Function) -> Function:
    """Compile ``function`` into its callers, which saves copies of a large result."""
    return cast(Function, numba.njit(error_model="numpy", forceinline=True)(function))


LONGEST = 14
"""Number of coordinates of two bodies with Euler parameters."""


class FloatsType(types.Type):
    """A list of at most ``LONGEST`` floats; compiled code sees the address of a copy and its length."""

    def __init__(self) -> None:
        super().__init__("Floats")


FLOATS = FloatsType()

TABLE: Any = _types.float64[::1]
"""A contiguous array of floats."""

TABLES: Any = _types.float64[:, ::1]
"""A contiguous array of floats of two dimensions."""


@extending.register_model(FloatsType)
class _FloatsModel(extending.models.StructModel):  # type: ignore[misc]
    def __init__(self, manager: Any, kind: Any) -> None:
        members = [("start", _types.CPointer(_types.float64)), ("size", _types.intp)]
        super().__init__(manager, kind, members)


for _name in ("start", "size"):
    extending.make_attribute_wrapper(FloatsType, _name, _name)


@extending.unbox(FloatsType)  # type: ignore[untyped-decorator]
def _copy_of_list(kind: Any, argument: Any, context: Any) -> Any:
    api, builder = context.pyapi, context.builder
    copy = cgutils.alloca_once(builder, ir.DoubleType(), size=LONGEST)
    floats = cgutils.create_struct_proxy(kind)(context.context, builder)
    floats.start, floats.size = copy, api.list_size(argument)
    longest = ir.Constant(floats.size.type, LONGEST)
    is_short = builder.icmp_unsigned("<=", floats.size, longest)  # the size is −1 without a list
    with builder.if_else(is_short) as (fits, otherwise):
        with fits, cgutils.for_range(builder, floats.size) as loop:
            item = api.list_getitem(argument, loop.index)
            builder.store(api.float_as_double(item), builder.gep(copy, [loop.index]))
        with otherwise:
            api.err_set_string("PyExc_TypeError", f"it must be a list of at most {LONGEST} floats")
    return extending.NativeValue(floats._getvalue(), is_error=api.c_api_error())


@extending.box(FloatsType)  # type: ignore[untyped-decorator]
def _as_list(kind: Any, value: Any, context: Any) -> Any:
    api, builder = context.pyapi, context.builder
    floats = cgutils.create_struct_proxy(kind)(context.context, builder, value=value)
    result = api.list_new(floats.size)
    with cgutils.for_range(builder, floats.size) as loop:
        number = builder.load(builder.gep(floats.start, [loop.index]))
        api.list_setitem(result, loop.index, api.float_from_double(number))
    return result


@compiled
def as_arrays(q: Any, q_t: Any, size: int) -> Any:
    """Return views of the first ``size`` numbers of two ``FLOATS``."""
    if q.size < size or q_t.size < size:
        raise TypeError("a list of coordinates or velocities is too short")
    return _numba.carray(q.start, size), _numba.carray(q_t.start, size)


@cache
def entry_point(function: Callable[..., Any], *kinds: Any) -> Callable[..., Any]:
    """Return a function for Python, compiled for arguments of these ``kinds`` without numba's dispatch by type.

    They are numba types, ``float``, or None for an unused argument. The function raises ``TypeError`` for other
    arguments.
    """
    by_python: dict[Any, Any] = {None: numba.none, float: _types.float64}
    signature = tuple(by_python.get(kind, kind) for kind in kinds)
    dispatcher = compiled_for(signature, cast(Any, function).py_func, SOURCES)
    return cast(Callable[..., Any], dispatcher.get_overload(signature))


class KeptOnDisk:
    """A ``compiled`` function for calls from Python, compiled once per machine for each set of argument types."""

    def __init__(self, function: Callable[..., Any]) -> None:
        self._function = cast(Any, function).py_func
        self._compiled: list[Callable[..., Any]] = []

    def __call__(self, *arguments: Any) -> Any:
        """Return the result of the function."""
        for compiled_function in self._compiled:
            try:  # faster than a context
                return compiled_function(*arguments)
            except TypeError:
                continue
        self._compiled.append(compiled_for(tuple(map(numba.typeof, arguments)), self._function, SOURCES))
        return self._compiled[-1](*arguments)
