"""Which changes of the code make a sweep another one."""

import subprocess
import sys
from shutil import copytree, ignore_patterns

import pytest
from processes import ROOT, environment

from compare.run import stamp
from compare.sweep.store.stamp import CODE, sweep_stamp

BESIDE = {
    "compare.claims.claim",
    "compare.claims.paper_parameters",
    "compare.run.stamp",
    "compare.sweep.compute.executors",
    "compare.sweep.show.figures",
    "compare.sweep.store.stamp",
    "compare.sweep.show.summary",
    "compare.output.text_files",
}
"""Names, where the work is done, what is said and drawn of it, and this stamp itself: they change no number."""


@pytest.fixture
def copied(tmp_path, monkeypatch):
    for package in stamp.PACKAGES:
        copytree(ROOT / package, tmp_path / package, ignore=ignore_patterns("__pycache__"))
    monkeypatch.setattr(stamp, "ROOT", tmp_path)
    return tmp_path


def edited(path):
    """Return the stamps before and after an edit."""
    before = sweep_stamp()
    path.write_text(path.read_text(encoding="utf-8") + "# edited\n", encoding="utf-8")
    stamp._digest.cache_clear()  # a process has the code that it was started with
    return before, sweep_stamp()


@pytest.mark.parametrize(
    "path",
    [
        "reference_model/motion/pin_equations.py",
        "reference_model/ensemble/pin/end_states.py",
        "compare/sweep/define/plan.py",
    ],
)
def test_a_sweep_of_other_equations_or_another_plan_is_another_one(path, copied):
    before, after = edited(copied / path)
    assert before != after


@pytest.mark.parametrize(
    "path",
    [
        "compare/studies/pin/basins/claims.py",
        "compare/output/figures.py",
        "compare/sweep/show/figures.py",
        "compare/cli/sweep/run.py",
        "exudyn_models/paper/simulate.py",
    ],
)
def test_what_no_number_of_a_sweep_depends_on_may_change(path, copied):
    before, after = edited(copied / path)
    assert before == after


def test_the_stamp_of_sweeps_knows_all_that_computes_and_stores_them():
    code = (
        "import sys, compare.sweep.compute.run; print(*(n for n in sys.modules if n.startswith('compare.')))"
    )
    process = subprocess.run([sys.executable, "-c", code], env=environment(), capture_output=True, text=True)
    there = {
        ".".join(path.relative_to(ROOT).with_suffix("").parts)
        for path in (ROOT / "compare" / "sweep").rglob("[!_]*.py")
    }
    packages = {name for name in process.stdout.split() if (ROOT / name.replace(".", "/")).is_dir()}
    used = there | set(process.stdout.split()) - packages
    engines = {name for name in used if name.startswith("compare.engines.")}
    assert "compare.claims.shares" in used
    assert used - BESIDE - engines == set(CODE) - {"reference_model"}
