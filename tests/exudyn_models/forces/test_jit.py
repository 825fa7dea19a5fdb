import numpy as np
import pytest

from exudyn_models.forces.jit import compiled, taking_lists


@compiled
def sum_and_products(offset, left, right):
    return offset[0] + left[0] + right[1], left[0] * right[0], left[1] * right[1]


def test_a_function_that_takes_lists_returns_what_it_returns_for_tuples():
    rng = np.random.default_rng(0)
    function = taking_lists(sum_and_products, 1, 2, 2)
    for scale in 10.0 ** rng.uniform(-300.0, 300.0, 20):
        lists = [(scale * rng.normal(size=size)).tolist() for size in (1, 2, 2)]
        assert function(*lists) == sum_and_products.py_func(*lists)
    assert function([1], [2, 3], [4, 5]) == (8.0, 8.0, 15.0)  # whole numbers are taken as floats
    assert function([-1.0], [-1.0, 0.0], [-1.0, float("inf")])[:2] == (float("inf"), 1.0)  # −1 is no error


@pytest.mark.parametrize(
    "wrong",
    [[1.0], [], (1.0, 2.0), np.ones(2), None, 1.0, ["1.0", 2.0], [1.0, None], [1.0, 1j]],
    ids=["short", "empty", "tuple", "array", "none", "number", "text", "item none", "complex"],
)
def test_anything_but_a_list_of_numbers_raises_wherever_it_stands(wrong):
    function = taking_lists(sum_and_products, 1, 2, 2)
    good = [1.0], [1.0, 2.0], [3.0, 4.0]
    assert function(*good) == (6.0, 3.0, 8.0)
    for arguments in ((good[0], wrong, good[2]), (good[0], good[1], wrong)):
        with pytest.raises(TypeError):
            function(*arguments)
    assert function(*good) == (6.0, 3.0, 8.0)  # and no error is left behind
    with pytest.raises(TypeError):
        function(*good[:2])
