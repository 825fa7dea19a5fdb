"""Processes that work for others: what they import, and what is known of their end."""

import os
import sys
import tempfile

import pytest
from processes import wait_until

from compare.engines import engines
from compare.run.workers import Failure, Workers


def last_words(status):
    """End this process suddenly, with two lines on its standard error."""
    os.write(2, "what comes before\nthe last word: 1 µm\n".encode())
    os._exit(status)


def speak(text):
    os.write(1, f"raw {text}\n".encode())
    print(text, flush=True)
    print(text, file=sys.stderr, flush=True)


def warn(text):
    print(text, file=sys.stderr, flush=True)
    return len(text)


def done(function, *arguments):
    with Workers(2) as workers:
        workers.submit("key", function, *arguments)
        (one,) = workers.finished()
    return one.value


def test_work_begins_before_it_is_waited_for_if_asked_and_what_can_not_be_sent_is_told(tmp_path):
    place = tmp_path / "begun"
    with Workers(2) as workers:
        workers.submit("refused", lambda: None)
        workers.submit("begun", place.touch)
        workers.begin()
        wait_until(place.exists)
        found = {one.key: one.value for one in workers.finished()}
    assert found["begun"] is None
    assert "it can't be sent to another process" in found["refused"].reason


@pytest.fixture
def folder(tmp_path, monkeypatch):
    """The current folder, with an engine that has been imported from there."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(sys, "path", list(sys.path))
    (tmp_path / "engine_of_this_folder.py").write_text("def simulate(): return 42\n")
    (engine,) = engines(["engine_of_this_folder:simulate"])
    yield tmp_path, engine.function
    del sys.modules["engine_of_this_folder"]


def test_a_worker_imports_from_the_folder_of_the_engine(folder):
    assert done(folder[1]) == 42


@pytest.mark.parametrize(
    "stray",
    [
        "random",
        pytest.param("socket", marks=pytest.mark.skipif(sys.version_info < (3, 11), reason="no safe path")),
    ],
)
def test_a_stray_module_does_not_take_the_place_of_one_of_the_library(stray, folder):
    (folder[0] / f"{stray}.py").write_text("raise SystemExit('the stray one was imported')\n")
    assert done(tempfile.gettempdir) == tempfile.gettempdir()


def test_a_sudden_end_is_told_with_the_last_line_of_the_standard_error(capfd):
    assert done(last_words, 3) == Failure(
        "its process came to a sudden end (exit status 3): the last word: 1 µm"
    )
    assert capfd.readouterr().err == "what comes before\nthe last word: 1 µm\n"


def test_nothing_that_a_worker_writes_reaches_the_terminal_as_it_is(capfd):
    assert done(speak, "\x1b[31m \x9b") is None
    assert capfd.readouterr() == ("", "raw \\x1b[31m \\x9b\n" + 2 * "\\x1b[31m \\x9b\n")


def test_what_a_worker_writes_to_its_standard_error_is_not_lost(capfd):
    assert done(warn, "once") == 4
    assert capfd.readouterr().err == "once\n"
