import numpy as np
import pytest

from exudyn_models.forces.jit import compiled, taking_lists


@compiled
def sum_and_products(offset, left, right):
    return offset[0] + left[0] + right[1], left[0] * right[0], left[1] * right[1]


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
