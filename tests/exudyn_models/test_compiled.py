import os
import shutil
import subprocess
import sys

from exudyn_models import compiled
from exudyn_models.compiled import forget_outdated


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
    for number in ("3.0", "4.0"):
        (package / "called.py").write_text(f"{head}\n@compiled\ndef value():\n    return {number}\n")
        code = "from package.caller import twice; print(twice())"
        run = subprocess.run([sys.executable, "-c", code], cwd=tmp_path, capture_output=True, text=True)
        assert run.stdout == f"{2.0 * float(number)}\n", run.stderr
        assert list((package / "__pycache__").glob("*.nbi"))
