"""Output, files and exit statuses of the commands, beyond the table of arguments."""

import csv
import io
import json
import os
import re
import subprocess
import sys
from dataclasses import asdict, replace

import fake_studies
import numpy as np
import pytest
from processes import REAL, environment

from compare.claims.errata import ERRATA, TEXT
from compare.claims.parameters import FIG5, FIG11
from compare.claims.study import Findings
from compare.cli import app as cli
from compare.engines import EVERY_KIND
from compare.run.runner import Run
from compare.run.workers import failure, lacks_memory

pytestmark = pytest.mark.usefixtures("in_this_process")


@pytest.mark.parametrize(("name", "figure"), [("pin", FIG5), ("disc", FIG11)])
def test_help_of_simulate_has_the_parameters_of_the_figure(name, figure, capsys):
    assert cli.status(["simulate", name, "--help"]) == 0
    found = dict(re.findall(r"(\w+)=(\S+)", capsys.readouterr().out.partition("Examples:")[0]))
    assert {k: None if v == "none" else float(v) for k, v in found.items()} == asdict(figure)


def test_list_names_studies_and_engines(capsys):
    assert cli.status(["list"], fake_studies.ALL) == 0
    out = capsys.readouterr().out
    assert re.search(
        r"^  verdicts +1.0 s  full +every engine +Fig. 3: self-centring of the pin at low speed$", out, re.M
    )
    assert re.search(r"^  agreement +1.0 s  quick ", out, re.M)
    assert "\nEngines: reference, exudyn, exudyn-native\n" in out
    assert "on request: compiled, plain, " in out
    assert ", mujoco:pyramid" in out


def test_list_shows_the_times_of_the_last_report(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "report").mkdir()
    units = {"good": {"seconds": 2.5}, "other": {"seconds": 4.0}, "stopped": {"seconds": None}}
    results = {"studies": [{"name": "verdicts", "units": units}]}
    (tmp_path / "report" / "results.json").write_text(json.dumps(results))
    assert cli.status(["list"], fake_studies.ALL) == 0
    out = capsys.readouterr().out
    assert re.search(r"^  verdicts +6.5 s ", out, re.M)
    (tmp_path / "report" / "results.json").write_text("{")
    assert cli.status(["list"], fake_studies.ALL) == 0
    assert re.search(r"^  verdicts +1.0 s ", capsys.readouterr().out, re.M)


def test_errata_prints_their_source_both_forms_and_both_errors(capsys):
    assert cli.status(["errata"]) == 0
    out = capsys.readouterr().out
    assert out.startswith(f"{TEXT}\n")
    for erratum in ERRATA:
        assert f"{erratum.heading}\n  printed    {erratum.printed}\n" in out
    assert out.count(", error ") == 2 * len(ERRATA)


WITHOUT = """
import sys
import compare.cli.app
for arguments in (["--help"], ["sweep", "basin", "--help"]):
    compare.cli.app.status(arguments)
heavy = "numpy scipy matplotlib numba exudyn exudyn_models reference_model xarray zarr distributed"
print("heavy", [name for name in heavy.split() if name in sys.modules])
sys.modules["zarr"] = None  # as if it were not installed
for arguments in (["sweep", "basin", "pin"], ["sweep", "basin", "--help"], ["list"]):
    print("status", compare.cli.app.status(arguments))
"""


def test_help_needs_no_heavy_library_and_only_a_sweep_needs_the_extra():
    done = subprocess.run([REAL[0], "-c", WITHOUT], env=environment(), capture_output=True, encoding="utf-8")
    assert done.stderr == "sweeps need zarr; install with: pip install zarr\n"
    assert re.findall(r"^(?:heavy|status) .*$", done.stdout, re.MULTILINE) == [
        "heavy []",
        "status 2",
        "status 0",
        "status 0",
    ]


def report(*arguments, engine="fake_studies:straight", output, studies=fake_studies.ALL):
    options = ("--engine", engine, "--jobs", "1", "--output", str(output))
    return cli.status(["report", *arguments, *options], studies)


def test_a_report_that_differs_ends_with_status_1(reported):
    process, folder = reported
    assert process.returncode == 1
    assert "\r" not in process.stderr  # no progress bar without a terminal
    assert "verdicts good differs: The equilibrium is lost at the load of eq. (5)" in process.stdout
    gave_up = "the step size became too small at t = 3.2 s: try a larger tolerance (fake_studies.py:"
    assert process.stdout.count(f"verdicts failing failed: {gave_up}") == 1
    first = "4 checks against independent evidence and 1 other agree, 1 differs, 1 inconclusive, 4 failed"
    totals, *diagnoses = process.stdout.partition(first)[2].splitlines()
    assert totals == f" ({folder / 'index.html'})"
    assert [line.partition(":")[0] for line in diagnoses] == ["good", "failing"]
    assert diagnoses[1].startswith("failing: Undecided: no result for law: the step size became too small")


LACKS = "fake_studies:straight does not simulate a disc on single points or a disc on a continuous ring"
REPORTS = [
    (
        "inconclusive",
        3,
        "0 checks against independent evidence agree, 0 differ, 1 inconclusive (",
    ),
    (
        "partly",
        0,
        f"partly fake_studies:straight not simulated: {LACKS}\n"
        "1 check against independent evidence agrees, 0 differ, 0 inconclusive, 1 not simulated (",
    ),
    ("undrawable", 1, "undrawable: the figures could not be drawn: KeyError: 'radius'"),
]


@pytest.mark.parametrize(("study", "status", "said"), REPORTS)
def test_status_and_totals_of_a_report(study, status, said, tmp_path, capsys):
    assert report(study, output=tmp_path) == status
    assert f"\n{said}" in f"\n{capsys.readouterr().out}"


def test_a_report_without_differences_prints_its_totals_and_nothing_else(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    assert report("--level", "quick", output="new/folder") == 0  # the default is all studies
    page = os.path.join("new", "folder", "index.html")
    totals = f"1 check against independent evidence agrees, 0 differ, 0 inconclusive ({page})\n"
    assert capsys.readouterr() == (totals, "")
    results = json.loads((tmp_path / "new" / "folder" / "results.json").read_text(encoding="utf-8"))
    assert [study["name"] for study in results["studies"]] == ["agreement"]


class Terminal(io.StringIO):
    def isatty(self):
        return True


def test_on_a_terminal_there_is_a_progress_bar(tmp_path, monkeypatch):
    monkeypatch.setenv("TERM", "xterm")
    monkeypatch.setattr(sys, "stderr", Terminal())
    assert report("agreement", output=tmp_path) == 0
    shown = sys.stderr.getvalue()
    assert "2/2" in shown
    assert "0/100" not in shown


def test_missing_measurements_are_listed_once_at_the_end(tmp_path, monkeypatch, capsys):
    names = tuple(f"engine-{i}" for i in range(20))
    limits = []

    def interrupted(studies, engines, *, limit, **more):
        limits.append(limit)
        found = {("verdicts", "theory"): Findings((fake_studies.claim("A claim", "theory", 0.0, 1.0, 0.1),))}
        return Run(studies, names, outcomes=found, seconds={("verdicts", "theory"): 1.0}, interrupted=True)

    monkeypatch.setattr("compare.run.runner.run", interrupted)
    assert report("verdicts", output=tmp_path) == 130
    out, err = capsys.readouterr()
    assert out.splitlines()[0] == "verdicts theory differs: A claim"
    assert len(out.splitlines()) == 2
    listed = ", ".join(f"verdicts engine-{i}" for i in range(10))
    assert err.startswith(
        f"Interrupted; still missing: {listed} and 10 more. Repeat the command with --resume"
    )
    assert report("verdicts", "--study-limit", "2.5", output=tmp_path) == 130
    assert limits == [None, 2.5]


SIMULATE = ("--engine", "fake_studies:straight", "--samples", "3", "--until", "2")
UNITS = {"x": "m", "y": "m", "angle": "rad", "vx": "m/s", "vy": "m/s", "spin": "rad/s"}
OF_PIN = {name: unit for name, unit in UNITS.items() if name not in ("angle", "spin")}
MOTIONS = {
    "pin": (
        replace(FIG5, mass=2.0, disc_speed=-1.25),
        "--set mass=2 --set disc_speed=-1.25 --start -0.1 0 -3e-2 1",
    ),
    "disc of 6 points": (
        replace(FIG11, contact_points=6),
        "--set contact_points=6 --start 0.1 0 -0.5 0.25 0 1.25",
    ),
    "disc of none": (
        replace(FIG11, shaft_speed=-1.0),
        "--set contact_points=None --set shaft_speed=-1 --start 0 0 0 1 0 0",
    ),
}


@pytest.mark.parametrize("motion", MOTIONS)
def test_simulate_prints_a_table_or_writes_files(motion, tmp_path, monkeypatch, capsys):
    monkeypatch.setattr(fake_studies.straight, "kinds", EVERY_KIND, raising=False)
    system, arguments = MOTIONS[motion]
    call = ["simulate", motion.split()[0], *SIMULATE, *arguments.split()]
    units = OF_PIN if motion == "pin" else UNITS
    start = [float(value) for value in arguments.partition("--start ")[2].split()]
    half = len(start) // 2
    states = [[*np.add(start[:half], np.multiply(t, start[half:])), *start[half:]] for t in (0.0, 1.0, 2.0)]
    assert cli.status(call) == 0
    rows = list(csv.reader(io.StringIO(printed := capsys.readouterr().out)))
    assert rows[0] == ["t [s]", *(f"{name} [{unit}]" for name, unit in units.items())]
    np.testing.assert_array_equal(
        np.array(rows[1:], dtype=float), [[t, *state] for t, state in enumerate(states)]
    )

    for name in ("motion.csv", "motion.json"):
        assert cli.status([*call, "--output", str(tmp_path / name)]) == 0
    assert capsys.readouterr() == ("", "")
    assert (tmp_path / "motion.csv").read_text(encoding="utf-8") == printed.replace("\r\n", "\n")
    content = json.loads((tmp_path / "motion.json").read_text(encoding="utf-8"))
    assert content["system"] == type(system).__name__
    assert content["parameters"] == asdict(system)
    assert (content["columns"], content["units"]) == (list(units), {"t": "s"} | units)
    assert (content["times"], content["states"]) == ([0.0, 1.0, 2.0], states)
    assert content["phases"][0]["kind"] == "slip"
    assert content["solution"]["tolerance"] == 1e-9


def test_simulate_draws_the_motion_in_place_of_a_table(tmp_path, capsys):
    picture = tmp_path / "motion.pdf"
    assert cli.status(["simulate", "pin", *SIMULATE, "--plot", str(picture)]) == 0
    assert capsys.readouterr() == ("", "")
    assert picture.read_bytes().startswith(b"%PDF")


def test_simulate_shows_the_elapsed_time_on_a_terminal(monkeypatch, capsys):
    monkeypatch.setenv("TERM", "xterm")
    shown = []
    for patience in (0.0, 60.0):
        monkeypatch.setattr("compare.cli.simulate.PATIENCE", patience)
        monkeypatch.setattr(sys, "stderr", Terminal())
        assert cli.status(["simulate", "pin", *SIMULATE]) == 0
        shown.append("fake_studies:straight simulates until t = 2 s" in sys.stderr.getvalue())
    assert shown == [True, False]


def test_simulate_without_settings_is_the_second_case_of_fig_5(capsys):
    assert cli.status(["simulate", "pin"]) == 0
    out, err = capsys.readouterr()
    assert err == ""
    rows = out.splitlines()
    assert len(rows) == 4002
    assert rows[1] == "0.0,0.1,0.0,0.03,0.0"
    assert rows[-1].startswith("400.0,")


def test_files_are_kept_if_the_engine_fails(tmp_path):
    (tmp_path / "old.csv").write_text("precious")
    for name in ("old.csv", "new.csv"):
        arguments = ["--engine", "fake_studies:failing", "--output", str(tmp_path / name)]
        assert cli.status(["simulate", "pin", *arguments]) == 1
    assert [path.read_text() for path in tmp_path.iterdir()] == ["precious"]


@pytest.mark.skipif(not os.path.exists("/dev/full"), reason="there is no device that is always full")
@pytest.mark.parametrize("arguments", ["list", "simulate pin --until 1", "simulate pin --output full.csv"])
def test_a_full_disk_gives_a_message_of_one_line(arguments, tmp_path, monkeypatch, capsys):
    (tmp_path / "full.csv").symlink_to("/dev/full")
    monkeypatch.chdir(tmp_path)
    with open("/dev/full", "w") as full:
        monkeypatch.setattr(sys, "stdout", full)
        assert cli.status(arguments.split()) == 2
    assert re.fullmatch(r"cannot write .*: No space left on device\n", capsys.readouterr().err)


@pytest.fixture
def without_reader(monkeypatch):
    """Standard output without a reader; closing it, as a process does at its end, must not fail either."""
    reader, writer = os.pipe()
    os.close(reader)
    monkeypatch.setattr(sys, "stderr", sys.stderr)  # typer may replace it
    with open(writer, "w") as output:
        monkeypatch.setattr(sys, "stdout", output)
        yield


@pytest.mark.usefixtures("without_reader")
@pytest.mark.parametrize(
    ("arguments", "status"),
    [
        ("list", 0),
        ("--help", 0),
        ("simulate pin --until 1", 0),
        ("report partly --engine fake_studies:straight --output out", 0),
        ("report undrawable --engine fake_studies:straight --output out", 1),
    ],
)
def test_a_reader_that_stops_early_changes_no_status(arguments, status, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    assert cli.status(arguments.split(), fake_studies.ALL) == status
    assert capsys.readouterr().err == ""


def test_lack_of_memory_is_reported(monkeypatch, tmp_path, capsys):
    try:
        try:
            raise OSError("libllvmlite.so: failed to map segment from shared object")
        except OSError as error:
            raise OSError("Could not find/load shared object file 'libllvmlite.so'") from error
    except OSError as error:
        library = error
    assert failure(library).reason.startswith("not enough memory (OSError: Could not find/load")
    assert lacks_memory(MemoryError())
    assert not lacks_memory(OSError(28, "No space left on device"))

    def run(*arguments):
        raise library

    monkeypatch.setattr("compare.sweep.compute.run.run", run)
    assert cli.status(["sweep", "basin", "pin", "--output", str(tmp_path)]) == 1
    assert capsys.readouterr().err == ("not enough memory. Repeat the command with --resume to continue.\n")


ENDS_OF_PROCESSES = [
    (["report", "--jobs", "0"], 2, "jobs = 0: it must lie between 1 and 1000\n"),
    (["interrupted while it loads"], 130, "Interrupted.\n"),
]


@pytest.mark.parametrize(("arguments", "status", "sentence"), ENDS_OF_PROCESSES)
def test_a_process_ends_with_status_and_message(arguments, status, sentence, tmp_path):
    if status == 130:
        (tmp_path / "typer.py").write_text("raise KeyboardInterrupt")
    path = os.pathsep.join([str(tmp_path), environment()["PYTHONPATH"]])
    done = subprocess.run(
        [*REAL, *arguments], env=environment(PYTHONPATH=path), capture_output=True, text=True
    )
    assert (done.returncode, done.stderr) == (status, sentence)


def test_a_process_ends_normally_without_a_reader():
    reader, writer = os.pipe()
    os.close(reader)
    done = subprocess.run([*REAL, "--help"], env=environment(), stdout=writer, stderr=subprocess.PIPE)
    os.close(writer)
    assert (done.returncode, done.stderr) == (0, b"")
