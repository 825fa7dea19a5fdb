"""Reuse of stored drawings: only equal data and equal code give the same drawing."""

import fake_studies as fake
import numpy as np
import pytest

from compare.run import provenance, runner, store
from compare.run.store import Drawing, drawing_stamp

pytestmark = pytest.mark.usefixtures("in_this_process")


DRAWING = Drawing({"fake-radius": b"<svg/>"}, {"fake-motion": b"GIF89a"})


@pytest.fixture
def run(tmp_path, monkeypatch):
    drawn = []

    def draw(study, data, partial):
        drawn.append(study.name)
        return store.drawn(study, data) if study is fake.UNDRAWABLE else DRAWING

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


def test_only_equal_data_are_not_drawn_again(run):
    assert run(fake.VERDICTS, fake.GOOD) == (DRAWING, True)
    for resume in (False, True):
        assert run(fake.VERDICTS, fake.GOOD, resume=resume) == (DRAWING, False)
    assert run(fake.VERDICTS, fake.GOOD, fake.ALSO_GOOD) == (DRAWING, True)


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


def test_figures_are_drawn_again_after_a_change_of_style(run, tmp_path, monkeypatch):
    style = tmp_path / "code" / "compare" / "output" / "figures.py"
    style.parent.mkdir(parents=True)
    monkeypatch.setattr(provenance, "ROOT", tmp_path / "code")
    for text, redrawn in (("", True), ("", False), ("# another look", True)):
        style.write_text(text)
        provenance._sources.cache_clear()
        assert run(fake.VERDICTS, fake.GOOD)[1] is redrawn
    provenance._sources.cache_clear()


def test_a_drawing_that_failed_is_drawn_again(run):
    assert [run(fake.UNDRAWABLE, fake.GOOD)[1] for _ in range(2)] == [True, True]
