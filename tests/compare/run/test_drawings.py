"""What is drawn of equal data by equal code is drawn once; anything else is drawn anew."""

import shutil
from zipfile import ZipFile

import fake_studies as fake
import numpy as np
import pytest

from compare.run import provenance as stamp
from compare.run import runner
from compare.run import store as drawings
from compare.run.provenance import PACKAGES
from compare.run.store import Drawing, DrawingStore, drawing_stamp

pytestmark = pytest.mark.usefixtures("in_this_process")

DRAWING = Drawing({"radius": b"<svg/>", "spin": b""}, {"motion": bytes(range(256))})
NAMES = ("radius", "spin", "motion")


@pytest.fixture
def run(tmp_path, monkeypatch):
    """Run one study in the same folder as before; return its drawing, and whether it was drawn now."""
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
def test_other_data_have_another_stamp(data):
    assert drawing_stamp(ZEROS) == drawing_stamp({"good": {"radius": np.zeros(4)}})
    assert drawing_stamp(data) != drawing_stamp(ZEROS)


@pytest.mark.parametrize(
    ("study", "engines"),
    [
        (fake.VERDICTS, [fake.GOOD, fake.ALSO_GOOD]),
        (fake.VERDICTS, [fake.FAILING]),
    ],
    ids=["one engine more", "an engine that fails"],
)
def test_other_data_are_drawn_anew(study, engines, run):
    run(fake.VERDICTS, fake.GOOD)
    assert run(study, *engines)[1]


@pytest.mark.parametrize(("changed", "anew"), [("", False), ("# another look", True)])
def test_all_is_drawn_anew_where_figures_look_different_now(changed, anew, run, tmp_path, monkeypatch):
    run(fake.VERDICTS, fake.GOOD)
    for package in PACKAGES:
        skipped = shutil.ignore_patterns("__pycache__", "built")
        shutil.copytree(stamp.ROOT / package, tmp_path / "code" / package, ignore=skipped)
    with open(tmp_path / "code" / "compare" / "output" / "figures.py", "a", encoding="utf-8") as stream:
        stream.write(changed)
    monkeypatch.setattr(stamp, "ROOT", tmp_path / "code")
    assert run(fake.VERDICTS, fake.GOOD)[1] is anew


def test_a_drawing_that_failed_is_drawn_anew(run):
    assert [run(fake.UNDRAWABLE, fake.GOOD)[1] for _ in range(2)] == [True, True]


def test_drawings_come_back_to_the_last_bit(tmp_path):
    store = DrawingStore(tmp_path / "data")
    store.keep("fig03", "now", DRAWING)
    assert store.find("fig03", "now", NAMES) == DRAWING
    assert store.find("fig03", "then", NAMES) is None
    assert store.find("fig04", "now", NAMES) is None


@pytest.mark.parametrize("resume", [False, True])
def test_only_figures_that_a_study_declares_are_taken(resume, run, tmp_path):
    first, _ = run(fake.VERDICTS, fake.GOOD)
    with ZipFile(tmp_path / "verdicts.zip", "a") as archive:
        archive.writestr("figures/../../escaped", "<svg/>")
    assert run(fake.VERDICTS, fake.GOOD, resume=resume) == (first, True)


@pytest.mark.parametrize("broken", [b"", b"PK\x03\x04", None])
def test_broken_files_are_drawn_again(broken, tmp_path):
    store = DrawingStore(tmp_path)
    store.keep("fig03", "now", DRAWING)
    path = tmp_path / "fig03.zip"
    if broken is None:  # a byte of what was compressed is another one now
        with ZipFile(path) as archive:
            place = archive.infolist()[-1].header_offset
        content = bytearray(path.read_bytes())
        content[place + 60] ^= 0xFF
        path.write_bytes(content)
    else:
        path.write_bytes(broken)
    assert store.find("fig03", "now", NAMES) is None
