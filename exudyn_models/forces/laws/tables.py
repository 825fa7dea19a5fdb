"""Tables of numbers for compiled code, which reads them at an address.

Addresses are passed as floats, whose 53 bits exceed the 48 bits of an address.
"""

from functools import cache
from typing import Any

import numba.extending
import numpy as np
from llvmlite import ir
from numba.core import types

from reference_model.systems import FloatArray

extending: Any = numba.extending  # not fully typed

_WORD, _DOUBLE = ir.IntType(64), ir.DoubleType()


@extending.intrinsic  # type: ignore[untyped-decorator]
def number_at(typing: Any, address: Any, place: Any) -> Any:
    """Return element ``place`` of a contiguous array of floats at an address."""

    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        where, index = arguments
        start = builder.inttoptr(builder.fptoui(where, _WORD), _DOUBLE.as_pointer())
        return builder.load(builder.gep(start, [index]))

    return types.float64(types.float64, types.int64), generate


@cache
def kept(numbers: tuple[float, ...]) -> float:
    """Return the address of a copy of ``numbers`` that stays there."""
    array = np.array(numbers)
    _KEPT[float(array.ctypes.data)] = array
    return float(array.ctypes.data)


def kept_at(address: float) -> FloatArray:
    """Return the numbers at the result of ``kept``, shape (n,)."""
    return _KEPT[address]


_KEPT: dict[float, FloatArray] = {}
