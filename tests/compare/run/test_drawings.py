"""Reuse of stored drawings: only equal data and equal code give the same drawing."""

import shutil

import fake_studies as fake
import numpy as np
import pytest

from compare.run import provenance as stamp
from compare.run import runner
from compare.run import store as drawings
from compare.run.provenance import PACKAGES
from compare.run.store import drawing_stamp

pytestmark = pytest.mark.usefixtures("in_this_process")


@pytest.fixture
def run(tmp_path, monkeypatch):
    """Run a study in the same folder as before; return its drawing, and whether it was redrawn."""
    drawn = []

    def draw(study, data):
        drawn.append(study.name)
        return drawings.drawn(study, data)

    monkeypatch.setattr(runner, "drawn", draw)

    def of(study, *engines, **more):
        drawn.clear()
        done = []
        result = runner.run(
            (study,), engines, folder=tmp_path, progress=lambda *told: done.append(told[:2]), **more
        )
        assert done[-1] == (len(result.columns(study)) + 1, len(result.columns(study)) + 1)
        return result.drawings[study.name], bool(drawn)

    return of


@pytest.mark.parametrize("resume", [False, True])
def test_equal_data_are_drawn_once(resume, run):
    first, now = run(fake.VERDICTS, fake.GOOD)
    assert now
    assert set(first.figures) == {"fake-radius"}
    assert set(first.animations) == {"fake-motion"}
    assert run(fake.VERDICTS, fake.GOOD, resume=resume) == (first, False)


ZEROS = {"good": {"radius": np.zeros(4)}}


@pytest.mark.parametrize(
    "data",
    [
        {"good": {"radius": np.array([0.0, 0.0, 5e-324, 0.0])}},
        {"good": {"radius": np.zeros(4, dtype=int)}},
        {"good": {"radius": np.zeros((2, 2))}},
        {"good": {"spin": np.zeros(4)}},
        {"also-good": {"radius": np.zeros(4)}},
        {"good": {"radius": np.zeros(4), "spin": np.zeros(0)}},
        {},
    ],
    ids=["last bit", "type", "shape", "name", "engine", "empty array", "nothing"],
)
def test_the_stamp_changes_with_the_data(data):
    assert drawing_stamp(ZEROS) == drawing_stamp({"good": {"radius": np.zeros(4)}})
    assert drawing_stamp(data) != drawing_stamp(ZEROS)


@pytest.mark.parametrize("engines", [(fake.GOOD, fake.ALSO_GOOD), (fake.FAILING,)], ids=len)
def test_other_data_are_drawn_again(engines, run):
    run(fake.VERDICTS, fake.GOOD)
    assert run(fake.VERDICTS, *engines)[1]


def test_figures_are_drawn_again_after_a_change_of_style(run, tmp_path, monkeypatch):
    run(fake.VERDICTS, fake.GOOD)
    for package in PACKAGES:
        skipped = shutil.ignore_patterns("__pycache__", "built")
        shutil.copytree(stamp.ROOT / package, tmp_path / "code" / package, ignore=skipped)
    monkeypatch.setattr(stamp, "ROOT", tmp_path / "code")
    assert not run(fake.VERDICTS, fake.GOOD)[1]
    with open(tmp_path / "code" / "compare" / "output" / "figures.py", "a", encoding="utf-8") as stream:
        stream.write("# another look")
    stamp._sources.cache_clear()
    assert run(fake.VERDICTS, fake.GOOD)[1]


def test_a_drawing_that_failed_is_drawn_again(run):
    assert [run(fake.UNDRAWABLE, fake.GOOD)[1] for _ in range(2)] == [True, True]
