"""Calls from compiled code to Python functions and to functions that numba compiled separately.

Addresses are passed as floats, whose 53 bits exceed the 48 bits of an address.
"""

from functools import cache
from typing import Any

import numba.core.cgutils
import numba.core.datamodel.models
import numba.extending
import numpy as np
from llvmlite import ir
from numba.core import types

from reference_model.systems import FloatArray

extending: Any = numba.extending  # not fully typed
cgutils: Any = numba.core.cgutils

ARGUMENTS = 4
"""Number of arguments that a function may take."""

_WORD, _DOUBLE = ir.IntType(64), ir.DoubleType()


class PythonObjects(types.Type):
    """A tuple of Python objects, opaque to compiled code."""

    def __init__(self) -> None:
        super().__init__("PythonObjects")


python_objects = PythonObjects()

extending.register_model(PythonObjects)(numba.core.datamodel.models.OpaqueModel)


@extending.unbox(PythonObjects)  # type: ignore[untyped-decorator]
def _as_it_is(kind: Any, argument: Any, context: Any) -> Any:
    return extending.NativeValue(argument)


@extending.intrinsic  # type: ignore[untyped-decorator]
def result_of_python(
    typing: Any, objects: Any, which: Any, places: Any, a: Any, b: Any, c: Any, d: Any
) -> Any:
    """Call a function, one of ``objects``, with the subset of four numbers whose bits are set in ``places``.

    The result is NaN for anything but a number. Errors are passed on.
    """
    floats = [types.float64] * ARGUMENTS

    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        api = context.get_python_api(builder)
        functions, number, chosen, *numbers = arguments
        get_item = ir.FunctionType(api.pyobj, [api.pyobj, _WORD])
        callee = builder.call(api._get_function(get_item, name="PyTuple_GetItem"), [functions, number])
        # The callee may use the first place.
        stack = cgutils.alloca_once(builder, api.pyobj, size=ARGUMENTS + 1)
        count = cgutils.alloca_once_value(builder, _WORD(0))
        for i, number in enumerate(numbers):
            with builder.if_then(builder.trunc(builder.lshr(chosen, _WORD(i)), ir.IntType(1))):
                place = builder.add(builder.load(count), _WORD(1))
                builder.store(api.float_from_double(number), builder.gep(stack, [place]))
                builder.store(place, count)
        call = api._get_function(
            ir.FunctionType(api.pyobj, [api.pyobj, api.pyobj.as_pointer(), _WORD, api.pyobj]),
            name="PyObject_Vectorcall",
        )
        given = builder.load(count)
        flags = builder.or_(given, _WORD(1 << 63))
        nothing = cgutils.get_null_value(api.pyobj)
        result = builder.call(call, [callee, builder.gep(stack, [_WORD(1)]), flags, nothing])
        with cgutils.for_range(builder, given) as loop:
            api.decref(builder.load(builder.gep(stack, [builder.add(loop.index, _WORD(1))])))
        with builder.if_then(cgutils.is_null(builder, result), likely=False):
            context.call_conv.return_exc(builder)
        value = cgutils.alloca_once_value(builder, api.float_as_double(result))
        api.decref(result)
        with builder.if_then(builder.fcmp_ordered("==", builder.load(value), _DOUBLE(-1.0)), likely=False):
            with builder.if_then(api.c_api_error()):
                api.err_clear()
            builder.store(_DOUBLE(float("nan")), value)  # a negative value is invalid anyway
        return builder.load(value)

    return types.float64(objects, types.int64, types.int64, *floats), generate


@extending.intrinsic  # type: ignore[untyped-decorator]
def result_at(typing: Any, address: Any, a: Any, b: Any, c: Any, d: Any) -> Any:
    """Return the result of the compiled function at ``address`` for four numbers, or raise its error."""
    floats = (types.float64,) * ARGUMENTS

    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        where, *numbers = arguments
        kind = context.call_conv.get_function_type(types.float64, floats)
        callee = builder.inttoptr(builder.fptoui(where, _WORD), kind.as_pointer())
        status, result = context.call_conv.call_function(builder, callee, types.float64, floats, numbers)
        with builder.if_then(status.is_error, likely=False):
            context.call_conv.return_status_propagate(builder, status)
        return result

    return types.float64(types.float64, *floats), generate


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


def address_of(function: Any) -> float:
    """Return the address of the machine code of a function of four floats."""
    (found,) = function.overloads.values()
    return float(found.library.get_pointer_to_function(found.fndesc.llvm_func_name))
