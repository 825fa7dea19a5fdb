"""Motions from a folder of files: missing ones are named, invalid ones are reported."""

import json

import numpy as np
import pytest

from compare.claims.parameters import FIG5, FIG11
from compare.cli.trajectory_files import write_csv
from compare.engines import BadTrajectoryError, UnsupportedSystemError, engines, known_name
from compare.engines.outside.json_lines import question
from compare.engines.outside.motion_files import POINTS, BadFileError
from compare.run.plan import write_plan
from reference_model import simulate

START = (0.1, 0.0, 0.03, 0.0)
TIMES = (0.0, 1.0 / 3.0, 1.0)


@pytest.fixture
def folder(tmp_path):
    folder = tmp_path / "motions"
    folder.mkdir()
    write_plan(folder, ["pin"], [question(FIG5, START, TIMES, {"tolerance": 1e-9})])
    return folder


@pytest.fixture
def answer(folder):
    """Return a function that writes a changed answer and simulates with the engine of the folder."""
    exact = simulate(FIG5, START, TIMES)
    (asked,) = (path for path in folder.glob("*.json") if path.name != "plan.json")
    path = asked.with_suffix(".csv")

    def ask(change=lambda text: text):
        with open(path, "w", encoding="utf-8") as stream:
            write_csv(exact, "mine", stream)
        path.write_text(change(path.read_text("utf-8")), "utf-8")
        (engine,) = engines([f"files:{folder}"])
        return engine.simulate(FIG5, START, TIMES)

    ask.exact, ask.path = exact, path
    return ask


def without_header(text):
    return text.partition("\n")[2].replace("\n", "\r\n\r\n")


def backwards(text):
    rows = (",".join(reversed(row.split(","))) for row in text.splitlines())
    return "\n".join(rows).replace(" [s]", "", 1)


@pytest.mark.parametrize("change", [str, without_header, backwards, "# {}".format])
def test_a_motion_is_read_back_to_the_last_bit_with_without_or_with_another_header_and_empty_lines(
    answer, change
):
    np.testing.assert_array_equal(answer(change).states, answer.exact.states)


def with_two_rows_at_the_event(text):
    rows = text.splitlines()
    return "\n".join([*rows[:2], rows[2].replace(",", ",9"), *rows[2:]])


def with_12_digits(text):
    head, *rows = text.splitlines()
    rounded = (",".join(f"{float(word):.12g}" for word in row.split(",")) for row in rows)
    return "\n".join([head, *rounded])


@pytest.mark.parametrize(("change", "digits"), [(with_two_rows_at_the_event, 0.0), (with_12_digits, 5e-12)])
def test_what_simulators_write_is_accepted(change, digits, answer):
    found = answer(change)
    np.testing.assert_array_equal(found.times, TIMES)
    np.testing.assert_allclose(found.states, answer.exact.states, rtol=digits)


def test_the_engine_is_named_after_its_folder_and_supports_the_planned_kinds(folder, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (engine,) = engines(["files:motions"])
    assert (engine.name, engine.kinds, engine.phases) == ("motions", ("pin",), False)
    assert engine.lacking([FIG11]) == "motions does not simulate a disc on a continuous ring"


def with_line(place, *new):
    """Return a function of a text that replaces the line at an index by none or one."""
    return lambda text: "\n".join([*(rows := text.splitlines())[:place], *new, *rows[place + 1 :], ""])


@pytest.mark.parametrize(
    ("change", "reason"),
    [
        (with_line(3), "ends after 2 of 3 times, before t = 1 s"),
        (lambda text: "", "ends after 0 of 3 times, before t = 0 s"),
        (lambda text: text[: text.rindex(",")], "ends after 2 of 3 times, before t = 1 s"),
    ],
)
def test_a_missing_motion_is_unsupported_not_wrong(change, reason, answer, folder):
    with pytest.raises(UnsupportedSystemError) as error:
        answer(change)
    assert str(error.value) == f"motions/{answer.path.name} {reason}"
    answer.path.unlink()
    (engine,) = engines([f"files:{folder}"])
    with pytest.raises(UnsupportedSystemError, match=f"^motions/{answer.path.name} is missing$"):
        engine.simulate(FIG5, START, TIMES)
    with pytest.raises(UnsupportedSystemError, match=r"^motions does not contain this motion"):
        engine.simulate(FIG5, START, TIMES, tolerance=1e-8)


@pytest.mark.parametrize(
    ("change", "kind", "reason"),
    [
        (
            with_line(0, "t,x,y,vx"),
            BadFileError,
            "'t,x,y,vx': it must name t [s], x [m], y [m], vx [m/s], vy [m/s], in any order",
        ),
        (with_line(0, "time,x,y,vx,vy"), BadFileError, "'time,x,y,vx,vy': it must name …"),
        (with_line(0, "t [ms],x,y,vx,vy"), BadFileError, "'t [ms],x,y,vx,vy': it must name …"),
        (with_line(0, "t,x,x,vx,vy"), BadFileError, "'t,x,x,vx,vy': it must name …"),
        (with_line(4, "1,2,3,4,5"), BadFileError, " has 4 rows: expected 3, one per time"),
        (
            with_line(2, "1,2,3,4,5,6"),
            BadFileError,
            f", line 3, has 6 numbers: it must have 5, t, x, y, vx, vy; {POINTS}",
        ),
        (lambda text: text.replace(",", ";"), BadFileError, f", line 1, contains a semicolon: {POINTS}"),
        (with_line(2, "1,2,3,4,x"), BadFileError, ", line 3, does not consist of numbers: '1,2,3,4,x'"),
        (with_line(2, "0.3,2,nan,4,5"), BadFileError, ", line 3, has a number that is not finite"),
        (with_line(2, "0,2,3,4,5"), BadTrajectoryError, "times[1] = 0.0 s: expected 0.3333333333333333 s"),
    ],
)
def test_an_invalid_file_is_reported_with_its_line(change, kind, reason, answer):
    with pytest.raises(kind) as error:
        answer(change)
    words, cut, _ = reason.partition("…")
    assert words in str(error.value) if cut else str(error.value).endswith(reason)
    assert kind is BadTrajectoryError or str(error.value).startswith(f"motions/{answer.path.name}")


@pytest.mark.parametrize(
    ("index", "reason"),
    [
        (None, "No such file or directory; create it with friction-discs plan"),
        ("{", "it is not a plan of this version"),
        (json.dumps({"format": 0, "kinds": [], "motions": []}), "it is not a plan of this version"),
        (json.dumps({"format": 1, "kinds": ["sphere"], "motions": []}), "it is not a plan of this version"),
    ],
)
def test_a_folder_without_a_valid_plan_is_rejected(index, reason, folder):
    if index is None:
        (folder / "plan.json").unlink()
    else:
        (folder / "plan.json").write_text(index)
    for look in (lambda name: engines([name]), known_name):
        with pytest.raises(ValueError, match=f"^motions/plan.json cannot be read: {reason}$"):
            look(f"files:{folder}")
