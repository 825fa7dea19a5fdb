"""Worker processes: their imports, and the reasons for their end."""

import os
import signal
import subprocess
import sys
import tempfile
import time
from functools import partial
from pathlib import Path

import pytest
from processes import wait_until

from compare.engines import engines
from compare.run.workers import Failure, Workers


def last_words(status):
    """End this process abruptly, after two lines on its standard error."""
    os.write(2, "what comes before\nthe last word: 1 µm\n".encode())
    os._exit(status)


def speak(text):
    os.write(1, f"raw {text}\n".encode())
    print(text, flush=True)
    print(text, file=sys.stderr, flush=True)


def kill(number):
    os.kill(os.getpid(), number)


def raise_it(error):
    raise error


def close_all_descriptors(then, *arguments):
    os.closerange(0, 200)
    then(*arguments)


SUDDEN = "its process ended unexpectedly"

ENDS = [
    (sys.exit, 0, "SystemExit: 0"),
    (raise_it, KeyboardInterrupt(), "KeyboardInterrupt"),
    (os._exit, 0, f"{SUDDEN} (exit status 0)"),
]

POSIX_ENDS = [
    (kill, signal.SIGSEGV, f"{SUDDEN} (SIGSEGV)"),
    (kill, 37, f"{SUDDEN} (signal 37)"),  # of real time, without a name
    (partial(close_all_descriptors, time.sleep), 0.0, f"{SUDDEN} (exit status 1)"),
    (partial(close_all_descriptors, time.sleep), 3600.0, f"{SUDDEN} (it closed its connection)"),
] * (os.name == "posix")


@pytest.fixture(scope="module")
def workers():
    """One process for several tests, replaced if it ends."""
    with Workers() as workers:
        yield workers


@pytest.mark.parametrize(("function", "argument", "reason"), [*ENDS, *POSIX_ENDS])
def test_any_end_of_a_process_is_reported_without_a_traceback(function, argument, reason, workers, capfd):
    assert workers.ask(function, argument).reason == reason
    assert workers.ask(len, "next") == 4
    assert capfd.readouterr().err == ""


def done(function, *arguments):
    with Workers(2) as workers:
        workers.submit("key", function, *arguments)
        (one,) = workers.finished()
    return one.value


def leave_a_folder_and(end, *arguments):
    tempfile.mkdtemp()
    end(*arguments)


@pytest.mark.parametrize(("end", "argument"), [(len, ""), (os._exit, 1), (time.sleep, 3600.0)])
def test_temporary_files_of_a_process_are_removed_however_it_ends(end, argument, tmp_path, monkeypatch):
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path))
    monkeypatch.setenv("TMPDIR", str(tmp_path))
    with Workers(1, limit=3.0) as workers:
        workers.submit("key", leave_a_folder_and, end, argument)
        list(workers.finished())
    assert not list(tmp_path.iterdir())


@pytest.fixture
def folder(tmp_path, monkeypatch):
    """The current folder, with an engine that was imported from it."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(sys, "path", list(sys.path))
    (tmp_path / "engine_of_this_folder.py").write_text("def simulate(): return 42\n")
    (engine,) = engines(["engine_of_this_folder:simulate"])
    yield tmp_path, engine.function
    del sys.modules["engine_of_this_folder"]


def test_a_worker_imports_from_the_folder_of_the_engine(folder):
    assert done(folder[1]) == 42


@pytest.mark.parametrize("stray", ["random", "socket"])
def test_a_stray_module_does_not_replace_a_library_module(stray, folder):
    (folder[0] / f"{stray}.py").write_text("raise SystemExit('the stray one was imported')\n")
    assert isinstance(done(tempfile.gettempdir), str)


def test_a_sudden_end_is_reported_with_the_last_line_on_standard_error(workers, capfd):
    assert workers.ask(last_words, 3) == Failure(
        "its process ended unexpectedly (exit status 3): the last word: 1 µm"
    )
    assert capfd.readouterr().err == "what comes before\nthe last word: 1 µm\n"


def test_output_of_a_worker_is_made_printable(workers, capfd):
    assert workers.ask(speak, "\x1b[31m \x9b") is None
    assert capfd.readouterr() == ("", "raw \\x1b[31m \\x9b\n" + 2 * "\\x1b[31m \\x9b\n")


def spoil(module):
    sys.modules[module] = None
    return os.getpid()


def test_a_process_never_works_for_two_engines(workers):
    spoilt = workers.ask(spoil, "json", owner="mine")
    assert workers.ask(os.getpid, owner="mine") == spoilt
    assert workers.ask(os.getpid) != spoilt


@pytest.mark.skipif(not hasattr(os, "fork"), reason="this system has no fork")
def test_a_forked_worker_does_not_answer_twice(workers):
    assert isinstance(workers.ask(os.fork), int)
    assert workers.ask(len, "four") == 4


@pytest.mark.skipif(os.name != "posix", reason="this system has no process groups")
def test_child_processes_of_a_worker_end_with_it():
    with Workers() as workers:
        child = workers.ask(start_a_child)
    wait_until(lambda: not is_alive(child))


def start_a_child():
    return subprocess.Popen(["sleep", "60"]).pid


def is_alive(number):
    """Return whether a process runs; zombies do not."""
    try:
        return "Z" not in Path(f"/proc/{number}/stat").read_text().rpartition(")")[2].split()[0]
    except OSError:
        return False
