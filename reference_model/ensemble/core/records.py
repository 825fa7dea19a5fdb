"""Records: the data of a lane, by name.

All fields have constant offsets from one address, so loops over lanes can be vectorised. An array of rows or a tuple
of arrays would take four times as long.
"""

from collections.abc import Callable, Iterator
from functools import cache
from typing import Annotated, Any, Generic, TypeVar, get_args, get_origin, get_type_hints

import numpy as np
from numba import types
from numba.extending import overload

from reference_model.ensemble.core.jit import INLINED, PART, generated
from reference_model.systems import FloatArray

LANES = 16
"""Number of trajectories side by side."""

Row = Annotated[FloatArray, LANES]
"""A field with one number per lane."""

Numbers = TypeVar("Numbers")


class Record:
    """Base class of records, whose fields are numbers, arrays of them, named tuples of numbers, or records."""


class Rows(Generic[Numbers]):
    """A structured field with one row per element of a named tuple, named like the element."""

    def __getattr__(self, name: str) -> FloatArray:
        raise NotImplementedError


@cache
def layout(record: type) -> np.dtype[Any]:
    """Return the memory layout of a record or of a named tuple."""
    hints = get_type_hints(record, include_extras=True)
    return np.dtype([(name, *_placed(hint)) for name, hint in hints.items()], align=True)


def _placed(hint: Any) -> tuple[Any, ...]:
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
    """Store numbers in the order of the named tuple in one lane; compiled code only."""
    raise NotImplementedError


def fill(record: Any, numbers: Any) -> None:
    """Store the numbers of a named tuple or record; compiled code only."""
    raise NotImplementedError


def clear(record: Any) -> None:
    raise NotImplementedError


# Unrolled over the fields, because a loop would need to access fields by number.


@overload(at, jit_options=INLINED, strict=False)
def _at(rows: types.Record, lane: Any) -> Callable[..., Any]:
    values = "".join(f"rows.{name}[lane], " for name in rows.fields)
    return generated("rows, lane", [f"return ({values})"])


@overload(put, jit_options=INLINED, strict=False)
def _put(rows: types.Record, lane: Any, numbers: Any) -> Callable[..., Any]:
    named = isinstance(numbers, types.BaseNamedTuple)
    values = [f"numbers.{name}" if named else f"numbers[{i}]" for i, name in enumerate(rows.fields)]
    lines = [f"rows.{name}[lane] = {value}" for name, value in zip(rows.fields, values, strict=True)]
    return generated("rows, lane, numbers", lines)


@overload(fill, jit_options=PART, strict=False)
def _fill(record: types.Record, numbers: Any) -> Callable[..., Any]:
    return generated("record, numbers", [f"record.{name} = numbers.{name}" for name in record.fields])


@overload(clear, jit_options=PART, strict=False)
def _clear(record: types.Record) -> Callable[..., Any]:
    return generated("record", list(_zeros("record", record)))


def _zeros(place: str, record: types.Record) -> Iterator[str]:
    for name, field in record.fields.items():
        if isinstance(field.type, types.Record):
            yield from _zeros(f"{place}.{name}", field.type)
        elif isinstance(field.type, types.NestedArray):
            yield from (f"{place}.{name}[{i}] = 0.0" for i in range(field.type.shape[0]))
        else:
            yield f"{place}.{name} = 0"
