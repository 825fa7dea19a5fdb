import os
import shutil
import subprocess
import sys

import numpy as np
import pytest

from exudyn_models import compiled
from exudyn_models.compiled import forget_outdated, taking_lists


def test_what_is_older_than_any_module_is_forgotten_and_what_is_newer_is_kept(tmp_path):
    sources, folder = tmp_path / "package", tmp_path / "cache"
    ages = {sources / "a.py": 100, sources / "b.py": 200, folder / "old.nbi": 150, folder / "new.nbi": 250}
    for path, age in ages.items():
        path.parent.mkdir(exist_ok=True)
        path.write_text("")
        os.utime(path, (age, age))
    forget_outdated(str(folder), str(sources))
    assert [path.name for path in folder.iterdir()] == ["new.nbi"]


def test_a_function_follows_a_change_of_one_that_it_calls_in_another_module(tmp_path):
    package = tmp_path / "package"
    package.mkdir()
    shutil.copy(compiled.__file__, package / "compiled.py")
    head = "from package.compiled import compiled\n"
    (package / "caller.py").write_text(
        f"{head}from package.called import value\n\n@compiled\ndef twice():\n    return 2.0 * value()\n"
    )
    for number in ("3.0", "4.25"):  # of another length, since Python itself looks at seconds and sizes only
        (package / "called.py").write_text(f"{head}\n@compiled\ndef value():\n    return {number}\n")
        code = "from package.caller import twice; print(twice())"
        run = subprocess.run([sys.executable, "-c", code], cwd=tmp_path, capture_output=True, text=True)
        assert run.stdout == f"{2.0 * float(number)}\n", run.stderr
        assert list((package / "__pycache__").glob("*.nbi"))


@compiled.compiled
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
