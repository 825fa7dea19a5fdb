import itertools
import json
import multiprocessing
import os
import signal
import subprocess
import sys
import time
from dataclasses import replace
from types import SimpleNamespace

import fake_studies as fake
import numpy as np
import pytest
from processes import FAKE, PATIENCE, environment, interruptible, wait_for, wait_until

from compare.claims.study import Findings
from compare.cli.report import store_of
from compare.run import workers
from compare.run.runner import run
from compare.run.workers import Failure

BOTH = (fake.GOOD, fake.FAILING)


@pytest.fixture(scope="module")
def both_ways(tmp_path_factory):
    """Return runs in one process and in two, one of which dies."""
    studies = (fake.VERDICTS, fake.AGREEMENT)
    one = run(studies, BOTH, folder=tmp_path_factory.mktemp("one"))
    dying = (*studies, replace(fake.DEATH, only=("good",)))
    two = run(dying, BOTH, folder=tmp_path_factory.mktemp("two"), jobs=2)
    assert multiprocessing.active_children() == []
    return one, two


@pytest.mark.parametrize("way", [0, 1])
def test_a_failing_engine_and_a_dying_process_do_not_affect_the_rest(way, both_ways):
    result = both_ways[way]
    assert not result.interrupted
    assert result.missing == ()
    for key in (
        ("verdicts", "theory"),
        ("verdicts", "good"),
        ("agreement", "good"),
        ("agreement", "failing"),
    ):
        assert isinstance(result.outcomes[key], Findings)
    failure = result.outcomes["verdicts", "failing"]
    assert failure.reason == "the step size became too small at t = 3.2 s: try a larger tolerance"
    assert failure.where[-1].startswith("fake_studies.py:")
    assert "/" not in "".join(failure.where)
    if way == 1:
        assert result.outcomes["death", "good"].reason == "its process ended unexpectedly (exit status 7)"


def test_progress_names_the_running_work_and_the_remaining_time(tmp_path, in_this_process):
    told = []
    run(
        (fake.AGREEMENT,),
        (fake.GOOD, fake.ALSO_GOOD),
        folder=tmp_path,
        expected={("agreement", "good"): 1000.0},  # the study itself expects 1 s
        progress=lambda *one: told.append(one),
    )
    assert told[0] == (0, 3, "agreement good", pytest.approx(1001.0, abs=1e-6))
    assert told[1] == (1, 3, "agreement also-good", pytest.approx(1.0, abs=1e-6))
    assert told[2][2] == "agreement figures"
    assert told[-1] == (3, 3, "", 0.0)


def test_a_measurement_ends_at_the_limit_and_the_rest_continues(tmp_path, monkeypatch):
    """The clock jumps during the measurement, first to just before the limit, then beyond it.

    The time that the process takes to start does not count.
    """
    running, limit, wait = tmp_path / "running", 1000.0, workers.wait
    monkeypatch.setenv("RUNNING", str(running))
    looks, given_up = itertools.count(), {}

    def monotonic():
        jump = 0.0 if not running.exists() else 0.9 if next(looks) < 9 else 2.0
        return time.monotonic() + jump * limit

    def progress(done, total, now, left):
        given_up.setdefault(done, next(looks))

    clock = SimpleNamespace(monotonic=monotonic, perf_counter=time.perf_counter, sleep=time.sleep)
    monkeypatch.setattr(workers, "time", clock)
    monkeypatch.setattr(workers, "wait", lambda connections, left: wait(connections, min(left, 0.05)))
    studies = (fake.UNENDING, fake.AGREEMENT)
    result = run(studies, (fake.ALSO_GOOD,), folder=tmp_path, limit=limit, progress=progress)
    assert given_up[1] > 9
    assert result.outcomes["unending", "also-good"] == Failure("not finished within 1000 s", unfinished=True)
    assert result.seconds["unending", "also-good"] == limit
    assert isinstance(result.outcomes["agreement", "also-good"], Findings)
    assert multiprocessing.active_children() == []


def test_one_and_two_processes_find_and_draw_the_same(both_ways):
    one, two = both_ways
    drawing = one.drawings["verdicts"]
    assert set(drawing.figures) == {"fake-radius"}
    assert drawing.animations["fake-motion"].startswith(b"GIF89a")
    assert two.drawings["verdicts"] == drawing  # byte for byte: figures are reproducible
    good = [result.outcomes["verdicts", "good"] for result in (one, two)]
    np.testing.assert_array_equal(good[0].data["radius"], good[1].data["radius"])
    assert [c.measured.tolist() for c in good[0].claims] == [c.measured.tolist() for c in good[1].claims]


def test_an_invalid_result_is_reported(tmp_path):
    unsendable = replace(fake.NO_FINDINGS, name="unsendable", provided={"measure": lambda engine: None})
    found = run((fake.NO_FINDINGS, unsendable), (fake.GOOD,), folder=tmp_path).outcomes
    assert (
        found["no-findings", "good"].reason
        == "TypeError: the study returned NoneType, but must return Findings"
    )
    assert found["unsendable", "good"].reason.startswith("cannot be sent to another process (Can't pickle ")
    assert found["unsendable", "good"].reason.endswith("use functions of a module")


@pytest.fixture
def count(tmp_path, monkeypatch, in_this_process):
    path = tmp_path / "count"
    path.touch()
    monkeypatch.setenv("COUNT", str(path))
    return lambda: path.read_text().split()


def test_resume_computes_only_missing_results_of_the_same_code(tmp_path, count, monkeypatch):
    first = run((fake.COUNTED,), (fake.GOOD,), folder=tmp_path)
    assert count() == ["good"]
    second = run((fake.COUNTED,), (fake.GOOD, fake.ALSO_GOOD), folder=tmp_path, resume=True)
    assert count() == ["good", "also-good"]
    assert second.seconds["counted", "good"] == first.seconds["counted", "good"]
    assert second.outcomes["counted", "good"].data == first.outcomes["counted", "good"].data
    run((fake.COUNTED,), (fake.GOOD,), folder=tmp_path)
    assert count() == ["good", "also-good", "good"]
    monkeypatch.setattr("compare.run.runner.engine_stamp", lambda engine: "of other code")
    run((fake.COUNTED,), (fake.GOOD,), folder=tmp_path, resume=True)
    assert count() == ["good", "also-good", "good", "good"]


@pytest.mark.skipif(os.name == "nt", reason="Ctrl-C is sent as a POSIX signal")
def test_ctrl_c_keeps_finished_results_and_lists_missing_ones(tmp_path):
    running, output = tmp_path / "running", tmp_path / "report"
    arguments = ["report", "unending", "--engine", "good", "--engine", "also-good", "--engine", "failing"]
    process = subprocess.Popen(
        [*FAKE, *arguments, "--jobs", "2", "--output", str(output)],
        env=environment(RUNNING=str(running)),
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        encoding="utf-8",
        start_new_session=True,
        preexec_fn=interruptible,
    )
    wait_for(process, running)
    wait_until(lambda: list(store_of(output).glob("unending--good--*.zip")))
    os.killpg(process.pid, signal.SIGINT)  # to all processes, as a terminal does
    out, err = process.communicate(timeout=PATIENCE)
    assert process.returncode == 130
    missing = "unending also-good, unending failing"
    sentence = (
        f"Interrupted; still missing: {missing}. Repeat the command with --resume to complete the report."
    )
    assert err.splitlines()[-1] == sentence  # slow machines print their progress before
    assert "1 check against independent evidence agrees, 0 differ, 0 inconclusive, 2 missing" in out
    results = json.loads((output / "results.json").read_text(encoding="utf-8"))
    assert results["interrupted"]
    states = {engine: unit["state"] for engine, unit in results["studies"][0]["units"].items()}
    assert states == {"good": "finished", "also-good": "missing", "failing": "missing"}
    page = (output / "index.html").read_text(encoding="utf-8")
    assert "missing: unending with also-good, unending with failing." in page
    wait_until(lambda: ended(process.pid))


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
        env=environment(),
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
        start_new_session=True,
    )
    wait_for(process, running)
    process.kill()
    process.wait()
    wait_until(lambda: ended(process.pid))


def ended(group):
    """Return whether every process of the group has ended; zombies count as ended."""
    try:
        os.killpg(group, 0)
    except ProcessLookupError:
        return True
    return False
