"""Calls of functions from compiled code: of Python, and of what numba has compiled by itself.

Compiled code that needs one number from Python need not return to it: it calls the function as the interpreter does,
which costs as much as the function itself. Where a function is, and where numbers are in memory, is told by its
address as a float, which has 53 bits where addresses have 48.
"""

from __future__ import annotations

from typing import Any

import numba.core.cgutils
import numba.core.datamodel.models
import numba.extending
from llvmlite import ir
from numba.core import types

extending: Any = numba.extending  # not typed throughout
cgutils: Any = numba.core.cgutils

ARGUMENTS = 4
"""That a function may take, all of them floats."""

_WORD, _DOUBLE = ir.IntType(64), ir.DoubleType()


class PythonFunction(types.Type):
    """Anything that Python can call, which compiled code does not look into."""

    def __init__(self) -> None:
        super().__init__("PythonFunction")


python_function = PythonFunction()

extending.register_model(PythonFunction)(numba.core.datamodel.models.OpaqueModel)


@extending.unbox(PythonFunction)  # type: ignore[untyped-decorator]
def _as_it_is(kind: Any, argument: Any, context: Any) -> Any:
    return extending.NativeValue(argument)


@extending.intrinsic  # type: ignore[untyped-decorator]
def result_of_python(typing: Any, function: Any, places: Any, a: Any, b: Any, c: Any, d: Any) -> Any:
    """Return what a Python function returns for those of four numbers whose bits are set in ``places``.

    That is NaN for anything but a number. What the function raises is raised.
    """
    floats = [types.float64] * ARGUMENTS

    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        api = context.get_python_api(builder)
        callee, chosen, *numbers = arguments
        # The first place is for the function that is called to use.
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
            builder.store(_DOUBLE(float("nan")), value)  # −1 is as wrong
        return builder.load(value)

    return types.float64(function, types.int64, *floats), generate


@extending.intrinsic  # type: ignore[untyped-decorator]
def result_at(typing: Any, address: Any, a: Any, b: Any, c: Any, d: Any) -> Any:
    """Return what the compiled function at ``address_of`` returns for four numbers, or raise what it raises."""
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
    """Return number ``place`` of a contiguous array of floats at an address."""

    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        where, index = arguments
        start = builder.inttoptr(builder.fptoui(where, _WORD), _DOUBLE.as_pointer())
        return builder.load(builder.gep(start, [index]))

    return types.float64(types.float64, types.int64), generate


def address_of(function: Any) -> float:
    """Return where the machine code of a function of four floats is that numba has compiled for these alone."""
    (found,) = function.overloads.values()
    return float(found.library.get_pointer_to_function(found.fndesc.llvm_func_name))
