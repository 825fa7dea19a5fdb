"""What would silently be ignored, overflow or be blamed on something else ends in a sentence."""

import os
import subprocess
import sys

import fake_studies
import pytest
from processes import REAL, environment

from compare.claims.study import Findings
from compare.cli import app as cli
from compare.run.runner import Run
from compare.run.workers import failure, lacks_memory

PIN, DISC = ("simulate", "pin"), ("simulate", "disc")
BASIN, MAP = ("sweep", "basin", "pin"), ("sweep", "map", "pin")
SIZE, MOST = "its size must be between 1e-50 and 1e+50", "its size must be at most 1e+50"

REFUSED = [
    ((*PIN, "--set", "mass=1e-320"), f"mass = 9.99989e-321 kg: {SIZE}"),
    ((*PIN, "--set", "damping=1e300"), f"damping = 1e+300 N s/m: {MOST}"),
    ((*PIN, "--set", "offset=-1e300"), f"offset = -1e+300 m: {MOST}"),
    ((*PIN, "--set", "mass=1e-40"), "damping = 0.1 N s/m: damping/mass = 1e+39 must be at most 1e+25"),
    ((*DISC, "--set", "contact_radius=1e200"), f"contact_radius = 1e+200 m: {SIZE}"),
    (
        (*DISC, "--set", "polar_inertia=1e-40"),
        "contact_radius = 0.12 m: mass·contact_radius²/polar_inertia = 1.44e+38 must be at most 1e+25",
    ),
    ((*BASIN, "--x", "x=-1e308:1e308:10"), "x from -1e+308 to 1e+308: the range must be finite"),
    ((*MAP, "--x", "mass=1:1e300:10"), f"mass = 1e+300 kg: {SIZE}"),
    ((*PIN, "--until", "5", "--until", "6"), "--until is there 2 times: give it once"),
    ((*PIN, "--start", *"0123", "--start", *"4567"), "--start is there 2 times: give it once"),
    ((*PIN, "--engine", "reference", "--engine", "exudyn"), "--engine is there 2 times: give it once"),
    (("report", "--output", "a", "--output", "b"), "--output is there 2 times: give it once"),
    ((*BASIN, "--x", "x=0:1:3", "--x", "x=0:2:3"), "--x is there 2 times: give it once"),
    ((*PIN, "--set", "mass=1", "--set", "mass=2"), "--set mass: it is there more than once"),
    ((*BASIN, "--start", "y=1,y=2"), "--start 'y=1,y=2': y is there more than once"),
    ((*BASIN, "--start", "x=1"), "--start x: it has its values from --x or --y, leave one of them out"),
    ((*BASIN, "--random", "9", "--coarse", "9"), "--coarse is of a grid: leave it out with --random"),
    (
        (*MAP, "--set", "disc_speed=2"),
        "--set disc_speed: it has its values from --x or --y, leave one of them out",
    ),
    (
        ("sweep", "uncertainty", "pin", "--vary", "vx=normal(0, 1)", "--start", "vx=1"),
        "--start vx: it has its values from --vary, leave one of them out",
    ),
    (
        ("sweep", "uncertainty", "pin", "--vary", "mass=uniform(1, 2)", "--set", "mass=1"),
        "--set mass: it has its values from --vary, leave one of them out",
    ),
    (("report", "--output", ""), "--output '': it must not be empty"),
    ((*PIN, "--output", ""), "--output '': it must not be empty"),
    ((*BASIN, "--x", ""), "--x '': it must not be empty"),
]


@pytest.mark.parametrize(("arguments", "sentence"), REFUSED, ids=[" ".join(one) for one, _ in REFUSED])
def test_it_is_refused_in_one_sentence(arguments, sentence, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    assert cli.status(list(arguments), fake_studies.ALL) == 2
    assert capsys.readouterr() == ("", sentence + "\n")
    assert list(tmp_path.iterdir()) == []


@pytest.fixture
def without_reader(monkeypatch):
    """A standard output that nobody reads; closing it, as a process does at its end, must be no error either."""
    reader, writer = os.pipe()
    os.close(reader)
    monkeypatch.setattr(sys, "stderr", sys.stderr)  # which typer may replace
    with open(writer, "w") as output:
        monkeypatch.setattr(sys, "stdout", output)
        yield


@pytest.mark.usefixtures("in_this_process", "without_reader")
@pytest.mark.parametrize(
    ("study", "engine", "status"), [("partly", "straight", 0), ("verdicts", "failing", 1)]
)
def test_a_reader_that_stops_early_changes_no_status(study, engine, status, tmp_path, capsys):
    arguments = ["report", study, "--engine", f"fake_studies:{engine}", "--jobs", "1"]
    assert cli.status([*arguments, "--output", str(tmp_path)], fake_studies.ALL) == status
    assert capsys.readouterr().err == ""


@pytest.mark.usefixtures("without_reader")
@pytest.mark.parametrize("arguments", [["list"], ["--help"], ["errata"]])
def test_a_reader_that_stops_early_is_no_error(arguments, capsys):
    assert cli.status(arguments) == 0
    assert capsys.readouterr().err == ""


def test_what_is_missing_is_told_once_and_after_what_matters(tmp_path, monkeypatch, capsys):
    names = tuple(f"engine-{i}" for i in range(20))

    def interrupted(studies, engines, **more):
        found = {("verdicts", "theory"): Findings((fake_studies.claim("A claim", "theory", 0.0, 1.0, 0.1),))}
        return Run(studies, names, outcomes=found, seconds={("verdicts", "theory"): 1.0}, interrupted=True)

    monkeypatch.setattr("compare.run.runner.run", interrupted)
    assert cli.status(["report", "verdicts", "--output", str(tmp_path)], fake_studies.ALL) == 130
    out, err = capsys.readouterr()
    assert out.splitlines()[0] == "verdicts theory differs: A claim"
    assert len(out.splitlines()) == 2
    listed = ", ".join(f"verdicts engine-{i}" for i in range(10))
    assert (
        err == f"Interrupted; missing: {listed} and 10 more. The same command with --resume completes it.\n"
    )


def test_the_time_after_which_a_study_is_given_up_is_that_of_the_option(tmp_path, monkeypatch):
    limits = []

    def nothing(studies, engines, *, limit, **more):
        limits.append(limit)
        return Run(studies, (), interrupted=True)

    monkeypatch.setattr("compare.run.runner.run", nothing)
    arguments = ["report", "verdicts", "--output", str(tmp_path)]
    for more in ([], ["--study-limit", "2.5"]):
        cli.status(arguments + more, fake_studies.ALL)
    assert limits == [None, 2.5]


def test_ctrl_c_while_the_command_is_still_being_loaded_is_told(tmp_path):
    (tmp_path / "typer.py").write_text("raise KeyboardInterrupt")
    path = os.pathsep.join([str(tmp_path), environment()["PYTHONPATH"]])
    process = subprocess.run(
        [*REAL, "list"], env=environment(PYTHONPATH=path), capture_output=True, text=True
    )
    assert (process.returncode, process.stdout, process.stderr) == (130, "", "Interrupted.\n")


def test_ctrl_c_while_a_command_runs_is_told(monkeypatch, capsys):
    def interrupted(*arguments, **more):
        raise KeyboardInterrupt

    monkeypatch.setattr("compare.engines.engines", interrupted)
    assert cli.status(["list"]) == 130
    assert capsys.readouterr().err == "Interrupted.\n"


def test_little_memory_is_told_as_such(monkeypatch, tmp_path, capsys):
    try:
        try:
            raise OSError("libllvmlite.so: failed to map segment from shared object")
        except OSError as error:
            raise OSError("Could not find/load shared object file 'libllvmlite.so'") from error
    except OSError as error:
        library = error
    assert failure(library).reason.startswith("there is not enough memory (OSError: Could not find/load")
    assert lacks_memory(MemoryError())
    assert not lacks_memory(OSError(28, "No space left on device"))

    def run(*arguments):
        raise library

    monkeypatch.setattr("compare.sweep.compute.run.run", run)
    assert cli.status([*BASIN, "--output", str(tmp_path)]) == 1
    assert capsys.readouterr().err == (
        "there is not enough memory. The same command with --resume goes on.\n"
    )
