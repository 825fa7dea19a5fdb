"""Logs of pushes: known motions and forces give known rows, and invalid logs give one line."""

import cmath
import lzma
import math

import numpy as np
import pytest

from compare.studies.plane.pushes import reduction
from compare.studies.plane.pushes.reduction import check_table, reduce_log, reduced_pushes, table

SAMPLES, OFFSET = 100, (0.3, -0.2)

NOISE = 0.02
"""Deviation in N of every second sample before contact from the first one."""

FORCE = 3.0 * cmath.exp(0.4j)
"""Force on the body in N in the axes of the hand, after a third of the samples."""

START, END, HAND = (100.0 + 200.0j, 0.3), (108.0 + 205.0j, 0.5), 1.1
"""Position (mm) and heading of the body before and after the push, and heading of the hand."""

TOUCHED = 20.0 - 2.0j
"""Place of the hand in mm in the frame of the body, at the start and at the end."""


def pose(place, angle, height=5.0):
    """Return a pose as a line: position in mm and quaternion."""
    return f"{place.real!r} {place.imag!r} {height} {math.cos(angle / 2)!r} 0 0 {math.sin(angle / 2)!r}"


def lines():
    """Return the lines of a log with one push.

    The force on the body in the axes of the hand is minus ((1, 1), (1, -1))/√2 times the sensor's components, and
    this matrix is its own inverse.
    """
    x, y = -(FORCE.real + FORCE.imag) / math.sqrt(2), -(FORCE.real - FORCE.imag) / math.sqrt(2)
    noise = [NOISE * (i % 2) * (i < 20) for i in range(SAMPLES)]
    forces = [
        f"{0.01 * i} {OFFSET[0] + noise[i] + x * (i >= 30)!r} {OFFSET[1] + noise[i] + y * (i >= 30)!r}"
        for i in range(SAMPLES)
    ]
    hand = [
        f"{i} {pose(place + TOUCHED * cmath.exp(1j * angle), HAND)}"
        for i, (place, angle) in enumerate((START, END))
    ]
    return ["1", pose(*START), pose(*END, height=5.2), str(SAMPLES), *forces, "2", *hand]


def written(folder, content, name="patch-exp_1.txt"):
    """Return the path of a log with these lines."""
    path = folder / name
    path.write_bytes(
        lzma.compress("\n".join(content).encode()) if name.endswith("xz") else "\n".join(content).encode()
    )
    return path


@pytest.mark.parametrize(
    ("name", "series"),
    [
        ("patch-exp_1.txt", "patch"),
        ("wood_10_90_10_10_30_130-exp_08_15.txt.xz", "wood_10_90_10_10_30_130"),
        ("wood_patch-exp_08_17_0839_50.txt", "wood_patch"),
    ],
)
def test_a_push_is_seen_in_the_axes_of_the_body_halfway(tmp_path, name, series):
    (push,) = reduce_log(written(tmp_path, lines(), name))
    halfway = cmath.exp(-0.4j)
    assert (push.series, push.number, push.samples) == (series, 1, SAMPLES)
    assert push.turn == pytest.approx(0.2)
    assert push.lift == pytest.approx(0.2)
    assert complex(push.x, push.y) == pytest.approx((END[0] - START[0]) * halfway)
    assert complex(push.force_x, push.force_y) == pytest.approx(FORCE * cmath.exp(1j * HAND) * halfway)
    assert complex(push.start_x, push.start_y) == pytest.approx(TOUCHED)
    assert complex(push.end_x, push.end_y) == pytest.approx(TOUCHED)
    assert (push.noise, push.tilt_x, push.tilt_y) == pytest.approx((NOISE / 2, 0.0, 0.0))


@pytest.mark.parametrize(
    ("line", "text", "message"),
    [
        (0, "0", "line 1: the number of pushes is 0: it must be a whole number >= 1"),
        (0, "1.5", "line 1: the number of pushes is 1.5: it must be a whole number >= 1"),
        (0, "2", r"line 108: '' is not a pose of the body: expected 7 numbers"),
        (1, "1 2 3", "line 2: '1 2 3' is not a pose of the body: expected 7 numbers"),
        (3, "-4", "line 4: the number of samples of the force is -4: it must be a whole number >= 21"),
        (3, "99", "line 104: '0.99 "),
        (50, "0.4 nan 1", "line 51: '0.4 nan 1' is not a sample of the force: expected 3 numbers"),
        (50, "0.4 one 1", "line 51: '0.4 one 1' is not a sample of the force: expected 3 numbers"),
        (104, "1", "line 105: the number of poses of the hand is 1: it must be a whole number >= 2"),
        (106, "\n".join([lines()[106], "7"]), "line 107: more lines follow the last of 1 pushes"),
    ],
)
def test_an_invalid_line_is_reported_with_its_place(tmp_path, line, text, message):
    content = lines()
    content[line] = text
    with pytest.raises(ValueError, match=message) as raised:
        reduce_log(written(tmp_path, content))
    assert str(tmp_path / "patch-exp_1.txt") in str(raised.value)
    assert "\n" not in str(raised.value)


def test_invalid_files_are_refused(tmp_path):
    with pytest.raises(
        ValueError, match=r"the name of a log is like 10_90_10_10_30_130-exp_08_15_50\.txt\.xz"
    ):
        reduce_log(written(tmp_path, lines(), "feet.txt"))
    path = tmp_path / "patch-exp_2.txt.xz"
    path.write_bytes(lzma.compress("\n".join(lines()).encode())[:-9])
    with pytest.raises(ValueError, match=r"patch-exp_2\.txt\.xz: Compressed data ended"):
        reduce_log(path)
    with pytest.raises(ValueError, match=r"--data .*: no such folder, or it contains no logs"):
        check_table(tmp_path / "missing")


def test_the_table_has_fifty_pushes_a_series_and_is_written_as_it_is_read():
    pushes = reduced_pushes()
    series = [push.series for push in pushes]
    assert [series.count(name) for name in dict.fromkeys(series)] == [50] * 7
    assert table(pushes) == (reduction.Path(reduction.__file__).with_name("reduced.csv")).read_text("utf-8")
    assert "Apache-2.0" in table(())


def test_logs_are_checked_against_the_table(tmp_path, monkeypatch):
    known = reduce_log(written(tmp_path, lines()))
    monkeypatch.setattr(reduction, "reduced_pushes", lambda: tuple(known))
    (new,) = reduce_log(written(tmp_path, lines(), "wood_patch-exp_1.txt"))
    assert check_table(tmp_path) == (["patch"], [new])
    content = lines()
    content[2] = pose(END[0] + 1e-4, END[1], height=5.2)
    written(tmp_path, content)
    with pytest.raises(
        ValueError, match=r"patch-exp_1\.txt: push 1 differs from the table of reduced pushes"
    ):
        check_table(tmp_path)
    monkeypatch.setattr(reduction, "reduced_pushes", lambda: (*known, *known))
    with pytest.raises(ValueError, match="has 1 pushes, but the table of reduced pushes has 2"):
        check_table(tmp_path)


def test_the_mean_force_excludes_the_first_samples(tmp_path, monkeypatch):
    (push,) = reduce_log(written(tmp_path, lines()))
    monkeypatch.setattr(reduction, "SETTLING", 0.0)
    (whole,) = reduce_log(written(tmp_path, lines()))
    without = np.hypot(whole.force_x, whole.force_y) / np.hypot(push.force_x, push.force_y)
    assert without == pytest.approx(0.7, abs=NOISE / 10)


@pytest.mark.parametrize(("axis", "expected"), [(4, (0.02, 0.0)), (5, (0.0, 0.02)), (6, (0.0, 0.0))])
def test_the_tilt_is_the_rotation_about_horizontal_axes(axis, expected):
    rotated = np.zeros(7)
    rotated[3], rotated[axis] = math.cos(0.01), math.sin(0.01)
    assert reduction.tilt(rotated) == pytest.approx(np.array(expected), abs=2e-6)
