"""Runs in this process and in others give the same results; nothing is lost if an engine or the user ends one."""

import json
import multiprocessing
import os
import signal
import subprocess
from dataclasses import replace

import fake_studies as fake
import numpy as np
import pytest
from processes import FAKE, PATIENCE, ended, environment, interruptible, wait_for, wait_until

from compare.claims.study import Findings
from compare.cli.report import store_of
from compare.engines import registry
from compare.run import runner
from compare.run.runner import TRUSTED, run
from compare.run.workers import Workers

BOTH = (fake.GOOD, fake.FAILING)


def check_results(result):
    assert not result.interrupted
    assert result.missing == ()
    for column in ("theory", "good"):
        assert isinstance(result.outcomes["verdicts", column], Findings)
    failure = result.outcomes["verdicts", "failing"]
    assert failure.reason == "the step size became too small at t = 3.2 s: try a larger tolerance"
    assert failure.where[-1].startswith("fake_studies.py:")
    assert "/" not in "".join(failure.where)


def test_this_process_and_two_others_of_which_one_dies_find_and_draw_the_same(tmp_path, request, monkeypatch):
    monkeypatch.setattr(
        registry, "_REGISTRY", {engine.name: engine for engine in BOTH}
    )  # may share a process
    dying = (fake.VERDICTS, replace(fake.DEATH, only=("good",)))
    other = run(dying, BOTH, folder=tmp_path / "other", jobs=2)
    assert multiprocessing.active_children() == []
    request.getfixturevalue("in_this_process")
    this = run((fake.VERDICTS,), BOTH, folder=tmp_path / "this")
    for result in (this, other):
        check_results(result)
    assert other.outcomes["death", "good"].reason == "its process ended unexpectedly (exit status 7)"
    drawing = this.drawings["verdicts"]
    assert set(drawing.figures) == {"fake-radius"}
    assert drawing.animations["fake-motion"].startswith(b"GIF89a")
    assert other.drawings["verdicts"] == drawing  # byte for byte: figures are reproducible
    good = [result.outcomes["verdicts", "good"] for result in (this, other)]
    np.testing.assert_array_equal(good[0].data["radius"], good[1].data["radius"])
    assert [c.measured.tolist() for c in good[0].claims] == [c.measured.tolist() for c in good[1].claims]


def test_progress_names_the_running_work_and_the_remaining_time(tmp_path, in_this_process):
    def progress_of(jobs, expected):
        found = []
        more = {"jobs": jobs, "expected": expected, "progress": lambda *one: found.append(one)}
        run((fake.AGREEMENT,), (fake.GOOD, fake.ALSO_GOOD), folder=tmp_path, **more)
        return found

    found = progress_of(1, {("agreement", "good"): 1000.0})  # the study itself expects 1 s
    assert found[0] == (0, 3, "agreement good", pytest.approx(1001.0, abs=1e-6))
    # The first took no time in place of 1000 s, so the second is expected to take less than its 1 s.
    assert found[1] == (1, 3, "agreement also-good", pytest.approx(TRUSTED / (TRUSTED + 1000.0), rel=0.1))
    assert found[2][2] == "agreement figures"
    assert found[-1] == (3, 3, "", 0.0)
    first, *_ = progress_of(2, {("agreement", name): 1000.0 for name in ("good", "also-good")})
    assert first == (0, 3, "agreement good, agreement also-good", pytest.approx(1000.0, abs=1e-6))


def test_number_and_time_limit_of_the_processes_are_those_of_the_run(tmp_path, monkeypatch, in_this_process):
    made = []
    monkeypatch.setattr(runner, "Workers", lambda jobs, limit: made.append((jobs, limit)) or Workers(jobs))
    run((), (), folder=tmp_path, jobs=3, limit=7.0)
    assert made == [(3, 7.0)]


def test_resume_computes_only_missing_results_of_the_same_code(tmp_path, monkeypatch, in_this_process):
    path = tmp_path / "count"
    monkeypatch.setenv("COUNT", str(path))

    def counted(*engines, resume=True):
        path.write_text("")
        found = run((fake.COUNTED,), engines, folder=tmp_path, resume=resume)
        return found, path.read_text().split()

    first, measured = counted(fake.GOOD)
    assert measured == ["good"]
    second, measured = counted(fake.GOOD, fake.ALSO_GOOD)
    assert measured == ["also-good"]
    assert second.seconds["counted", "good"] == first.seconds["counted", "good"]
    assert second.outcomes["counted", "good"].data == first.outcomes["counted", "good"].data
    assert counted(fake.GOOD, resume=False)[1] == ["good"]
    monkeypatch.setattr("compare.run.runner.engine_stamp", lambda engine: "of other code")
    assert counted(fake.GOOD)[1] == ["good"]


@pytest.mark.skipif(os.name == "nt", reason="Ctrl-C is sent as a POSIX signal")
def test_ctrl_c_keeps_finished_results_and_lists_missing_ones(tmp_path):
    running, output = tmp_path / "running", tmp_path / "report"
    arguments = ["report", "unending", "--engine", "good", "--engine", "also-good", "--engine", "failing"]
    process = subprocess.Popen(
        [*FAKE, *arguments, "--jobs", "1", "--output", str(output)],
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
