"""Worker processes: their imports, their time limit, and the reasons for their end."""

import itertools
import os
import signal
import subprocess
import sys
import tempfile
import time
from functools import partial
from pathlib import Path
from types import SimpleNamespace

import pytest
from processes import ended, environment, wait_for, wait_until
from work import (
    Unreadable,
    close_all_descriptors,
    kill,
    last_words,
    leave_a_folder_and,
    raise_it,
    speak,
    spend,
    spoil,
    start_a_child,
)

from compare.engines import engines
from compare.engines.outside.processor_time import is_over
from compare.run import workers as module
from compare.run.workers import Failure, Workers

SUDDEN = "its process ended unexpectedly"

ENDS = [
    (sys.exit, 0, "SystemExit: 0"),
    (raise_it, KeyboardInterrupt(), "KeyboardInterrupt"),
    (os._exit, 0, f"{SUDDEN} (exit status 0)"),
    (len, Unreadable(), "cannot be read"),
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


@pytest.mark.parametrize(("end", "argument"), [(len, ""), (os._exit, 1), (time.sleep, 3600.0)])
def test_temporary_files_of_a_process_are_removed_however_it_ends(end, argument, tmp_path, monkeypatch):
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path))
    monkeypatch.setenv("TMPDIR", str(tmp_path))
    with Workers(1, limit=3.0) as workers:
        workers.ask(len, "")  # a process that has just started does not look idle
        workers.ask(leave_a_folder_and, end, argument)
    assert not list(tmp_path.iterdir())


def test_work_ends_at_the_limit_and_the_rest_continues(tmp_path, monkeypatch):
    """The clock jumps during the work, first to just before the limit, then beyond it."""
    running, limit, wait, looks = tmp_path / "running", 1000.0, module.wait, itertools.count()

    def monotonic():
        jump = 0.0 if not running.exists() else 0.9 if next(looks) < 9 else 2.0
        return time.monotonic() + jump * limit

    monkeypatch.setattr(module, "time", SimpleNamespace(monotonic=monotonic, sleep=time.sleep))
    monkeypatch.setattr(module, "wait", lambda connections, left: wait(connections, min(left, 0.05)))
    with Workers(limit=limit) as workers:
        workers.submit("file", Path.touch, running)
        workers.submit("unending", time.sleep, 3600.0)
        workers.submit("next", len, "next")
        touched, late, following = workers.finished()
    assert next(looks) > 9
    assert late.value == Failure("not finished within 1000 s", unfinished=True)
    assert (touched.value, late.seconds, following.value) == (None, limit, 4)


@pytest.mark.skipif(
    not hasattr(time, "pthread_getcpuclockid"), reason="clocks of processes are a POSIX thing"
)
def test_a_limit_may_be_longer_than_a_system_can_wait():
    with Workers(limit=1e308) as workers:
        assert workers.ask(abs, -1) == 1


def test_limits_count_the_processor_time_of_the_process_and_its_programs(workers):
    program = f"{sys.executable} -c 'import time; t = time.process_time() + 0.5\nwhile time.process_time() < t: pass'"
    for function, arguments in ((spend, (0.5,)), (os.system, (program,))):
        workers.submit("", function, *arguments, limit=60.0)
        (done,) = workers.finished()
        assert 0.4 < done.spent < 3.0
        assert done.seconds >= 0.4
    workers.submit("", spend, 30.0, limit=0.5)
    (late,) = workers.finished()
    assert late.value == Failure("not finished within 0.5 s", unfinished=True)
    assert 0.5 <= late.spent < 5.0


@pytest.mark.parametrize(
    ("spent", "waited", "over"),
    [(9.9, 9.9, False), (9.9, 200.0, False), (10.0, 200.0, True), (0.1, 9.9, False), (0.1, 10.0, True)],
)
def test_a_busy_process_may_wait_for_a_loaded_machine_but_an_idle_one_may_not(spent, waited, over):
    assert is_over(10.0, spent, waited) == over


def test_work_that_cannot_be_sent_is_reported(workers):
    reason = workers.ask(lambda: None).reason
    assert reason.startswith("cannot be sent to another process (Can't pickle ")
    assert reason.endswith("use functions of a module")


@pytest.fixture
def folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(sys, "path", list(sys.path))
    (tmp_path / "engine_of_this_folder.py").write_text("def simulate(): return 42\n")
    (engine,) = engines(["engine_of_this_folder:simulate"])
    yield tmp_path, engine.function
    del sys.modules["engine_of_this_folder"]


def test_a_worker_imports_from_the_folder_of_the_engine_but_no_stray_library(folder):
    for stray in ("random", "socket"):
        (folder[0] / f"{stray}.py").write_text("raise SystemExit('the stray one was imported')\n")
    with Workers() as workers:
        assert isinstance(workers.ask(tempfile.gettempdir), str)
        assert workers.ask(folder[1]) == 42


def test_a_sudden_end_is_reported_with_the_last_line_on_standard_error(workers, capfd):
    assert workers.ask(last_words, 3) == Failure(f"{SUDDEN} (exit status 3): the last word: 1 µm")
    assert capfd.readouterr().err == "what comes before\nthe last word: 1 µm\n"


def test_output_of_a_worker_is_made_printable(workers, capfd):
    assert workers.ask(speak, "\x1b[31m \x9b") is None
    assert capfd.readouterr() == ("", "raw \\x1b[31m \\x9b\n" + 2 * "\\x1b[31m \\x9b\n")


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


def is_alive(number):
    """Return whether a process runs; zombies do not."""
    try:
        return "Z" not in Path(f"/proc/{number}/stat").read_text().rpartition(")")[2].split()[0]
    except OSError:
        return False


OUTLIVING = """
import sys, time
from pathlib import Path
from compare.run.workers import Workers

if __name__ == "__main__":
    with Workers(2) as workers:
        workers.submit("first", time.sleep, 3600.0)
        workers.submit("second", Path.touch, Path(sys.argv[1]))
        list(workers.finished())
"""


@pytest.mark.skipif(os.name == "nt", reason="groups of processes are a POSIX thing")
def test_no_process_outlives_a_killed_one(tmp_path):
    running, script = tmp_path / "running", tmp_path / "script.py"
    script.write_text(OUTLIVING)
    process = subprocess.Popen(
        [sys.executable, str(script), str(running)],
        env=environment(TMPDIR=str(tmp_path)),
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
        start_new_session=True,
    )
    wait_for(process, running)
    process.kill()
    process.wait()
    wait_until(lambda: ended(process.pid))
