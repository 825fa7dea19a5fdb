"""Which changes of the code make a sweep another one."""

import subprocess
import sys
from shutil import copytree, ignore_patterns

import pytest
from processes import ROOT, environment

from compare import store
from compare.sweep.stamp import CODE, sweep_stamp

BESIDE = {
    "compare.claim",
    "compare.engines",
    "compare.paper",
    "compare.store",
    "compare.study",
    "compare.sweep",
    "compare.sweep.cli",
    "compare.sweep.executors",
    "compare.sweep.figures",
    "compare.sweep.stamp",
    "compare.sweep.summary",
    "compare.text_files",
}
"""Names, where the work is done, what is said and drawn of it, and this stamp itself: they change no number."""


@pytest.fixture
def copied(tmp_path, monkeypatch):
    for package in store.PACKAGES:
        copytree(ROOT / package, tmp_path / package, ignore=ignore_patterns("__pycache__"))
    monkeypatch.setattr(store, "ROOT", tmp_path)
    return tmp_path


def edited(path):
    """Return the stamps before and after an edit."""
    before = sweep_stamp()
    path.write_text(path.read_text(encoding="utf-8") + "# edited\n", encoding="utf-8")
    store._digest.cache_clear()  # a process has the code that it was started with
    return before, sweep_stamp()


@pytest.mark.parametrize(
    "path", ["reference_model/pin.py", "reference_model/ensemble/pin_ends.py", "compare/sweep/plan.py"]
)
def test_a_sweep_of_other_equations_or_another_plan_is_another_one(path, copied):
    before, after = edited(copied / path)
    assert before != after


@pytest.mark.parametrize(
    "path",
    [
        "compare/studies/basins.py",
        "compare/report/style.py",
        "compare/sweep/figures.py",
        "compare/sweep/cli.py",
        "exudyn_models/simulate.py",
    ],
)
def test_what_no_number_of_a_sweep_depends_on_may_change(path, copied):
    before, after = edited(copied / path)
    assert before == after


def test_the_stamp_of_sweeps_knows_all_that_computes_and_stores_them():
    code = "import sys, compare.sweep.run; print(*(n for n in sys.modules if n.startswith('compare.')))"
    process = subprocess.run([sys.executable, "-c", code], env=environment(), capture_output=True, text=True)
    there = {f"compare.sweep.{path.stem}" for path in (ROOT / "compare" / "sweep").glob("[!_]*.py")}
    used = there | set(process.stdout.split())
    assert "compare.export" in used
    assert used - BESIDE == set(CODE) - {"reference_model"}
