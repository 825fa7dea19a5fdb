"""What only compiled code calls is compiled into it, without machine code of its own; Python may call it too."""

import numba
import pytest
from numba.core.codegen import JITCodeLibrary

from reference_model.numerics.compiled_parts import Part


@Part
def square(x):
    return x * x


@Part
def sum_of_squares(x, y):
    return square(x) + square(y)


@Part
def mean_square(x, y):
    return (sum_of_squares(x, y) + square(0.0)) / 2.0


@Part
def power(x, times):
    result = 1.0
    for _ in range(times):
        result *= x
    return result


def test_parts_become_machine_code_together_and_once(monkeypatch):
    finished, finish = [], JITCodeLibrary._finalize_specific
    monkeypatch.setattr(
        JITCodeLibrary, "_finalize_specific", lambda self: (finished.append(self.name), finish(self))
    )

    @numba.njit
    def both(x, y):
        return mean_square(x, y), sum_of_squares(y, x)

    assert both(3.0, 4.0) == (12.5, 25.0)
    assert [name for name in finished if name != "nrt"] == [both.py_func.__qualname__]  # numba's own besides


def test_a_part_is_compiled_once_for_a_constant_and_any_other_number():
    @numba.njit
    def powers(x, n):
        return power(x, 2), power(x, 3), power(x, n)

    assert powers(2.0, 4) == (4.0, 8.0, 16.0)
    assert list(power.overloads) == [(numba.float64, numba.int64)]


def test_python_may_call_a_part():
    assert mean_square(3.0, 4.0) == 12.5
    assert square(3) == 9


@pytest.mark.parametrize("arguments", [(), (1.0, 2.0)])
def test_wrong_arguments_of_a_part_raise(arguments):
    with pytest.raises(TypeError):
        square(*arguments)
