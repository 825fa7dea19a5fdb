"""Records: what a lane knows, by name.

A record is declared as a class whose annotations say what it holds, and laid out from them: so code reads
``memory.level`` and ``lanes.now.state.x[lane]``, and a type checker knows these names. For the compiler a record is
a single address and all of its fields stand at constant distances from it. That is why loops over lanes can be
vectorised: it sees that no two rows overlap. (In an array of rows, or a tuple of arrays, it would not: such loops
take four times as long.)
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from functools import cache
from typing import Annotated, Any, Generic, TypeVar, get_args, get_origin, get_type_hints

import numpy as np
from numba import types
from numba.extending import overload

from reference_model.ensemble.core.jit import INLINED, PART
from reference_model.systems import FloatArray

LANES = 16
"""Trajectories side by side. Two vectors of eight: while one waits for a square root the other goes on (measured: 25
ns a step, with eight 29)."""

Row = Annotated[FloatArray, LANES]
"""A field that is a number of each lane."""

Numbers = TypeVar("Numbers")


class Record:
    """What declares a record: fields are numbers, rows or arrays of them, named tuples of numbers, and records."""


class Rows(Generic[Numbers]):
    """A field that is the numbers of a named tuple of each lane: a row for each of them, under its name."""

    def __getattr__(self, name: str) -> FloatArray:
        """Return a row; compiled code only, as all about rows."""
        raise NotImplementedError


@cache
def layout(record: type) -> np.dtype[Any]:
    """Return how a record, or a named tuple as part of one, lies in memory."""
    hints = get_type_hints(record, include_extras=True)
    return np.dtype([(name, *_placed(hint)) for name, hint in hints.items()], align=True)


def _placed(hint: Any) -> tuple[Any, ...]:
    """Return type and, of an array, shape of a field."""
    if get_origin(hint) is Annotated:
        return np.float64, (get_args(hint)[1],)
    if get_origin(hint) is Rows:
        numbers = [name for name, kind in get_type_hints(get_args(hint)[0]).items() if kind is float]
        return (np.dtype([(name, np.float64, (LANES,)) for name in numbers], align=True),)
    return (hint if hint in (float, int, complex) else layout(hint),)


def at(rows: Rows[Any], lane: int) -> tuple[float, ...]:
    """Return the numbers of one lane; compiled code only."""
    raise NotImplementedError


def put(rows: Rows[Numbers], lane: int, numbers: Numbers | tuple[float, ...]) -> None:
    """Put the numbers of a named tuple, or in its order, into one lane; compiled code only."""
    raise NotImplementedError


def fill(record: Any, numbers: Any) -> None:
    """Put the numbers of a named tuple, or of a record like it, into a record; compiled code only."""
    raise NotImplementedError


def clear(record: Any) -> None:
    """Put zeros into all fields; compiled code only."""
    raise NotImplementedError


# All are written out for the fields of the record: a loop over them would have to know them by number.


@overload(at, jit_options=INLINED, strict=False)
def _at(rows: types.Record, lane: Any) -> Callable[..., Any]:
    values = "".join(f"rows.{name}[lane], " for name in rows.fields)
    return _written_out("rows, lane", [f"return ({values})"])


@overload(put, jit_options=INLINED, strict=False)
def _put(rows: types.Record, lane: Any, numbers: Any) -> Callable[..., Any]:
    named = isinstance(numbers, types.BaseNamedTuple)
    values = [f"numbers.{name}" if named else f"numbers[{i}]" for i, name in enumerate(rows.fields)]
    lines = [f"rows.{name}[lane] = {value}" for name, value in zip(rows.fields, values, strict=True)]
    return _written_out("rows, lane, numbers", lines)


@overload(fill, jit_options=PART, strict=False)
def _fill(record: types.Record, numbers: Any) -> Callable[..., Any]:
    return _written_out("record, numbers", [f"record.{name} = numbers.{name}" for name in record.fields])


@overload(clear, jit_options=PART, strict=False)
def _clear(record: types.Record) -> Callable[..., Any]:
    return _written_out("record", list(_zeros("record", record)))


def _zeros(place: str, record: types.Record) -> Iterator[str]:
    for name, field in record.fields.items():
        if isinstance(field.type, types.Record):
            yield from _zeros(f"{place}.{name}", field.type)
        elif isinstance(field.type, types.NestedArray):
            yield from (f"{place}.{name}[{i}] = 0.0" for i in range(field.type.shape[0]))
        else:
            yield f"{place}.{name} = 0"


def _written_out(arguments: str, lines: list[str]) -> Callable[..., Any]:
    namespace: dict[str, Any] = {}
    exec("\n    ".join([f"def written({arguments}):", *lines]), namespace)
    function: Callable[..., Any] = namespace["written"]
    return function
