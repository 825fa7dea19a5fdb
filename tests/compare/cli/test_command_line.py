import csv
import errno
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
from processes import PATIENCE, REAL, environment

from compare.claims.errata import ERRATA
from compare.claims.parameters import FIG5, FIG11
from compare.cli import app as cli
from compare.engines import EVERY_KIND

pytestmark = pytest.mark.usefixtures("in_this_process")


def test_help_of_every_command_has_an_example(capsys):
    for name in ("list", "report", "simulate", "simulate pin", "simulate disc", "errata"):
        assert cli.status([*name.split(), "--help"]) == 0
        assert f"friction-discs {name}" in capsys.readouterr().out


@pytest.mark.parametrize(("name", "figure"), [("pin", FIG5), ("disc", FIG11)])
def test_help_of_simulate_has_the_parameters_of_the_figure(name, figure, capsys):
    assert cli.status(["simulate", name, "--help"]) == 0
    found = dict(re.findall(r"(\w+)=(\S+)", capsys.readouterr().out.partition("Examples:")[0]))
    assert {k: None if v == "none" else float(v) for k, v in found.items()} == asdict(figure)


def test_without_a_command_there_is_help(capsys):
    assert cli.status([]) == 0
    assert "Usage: friction-discs" in capsys.readouterr().out


def test_version(capsys):
    assert cli.status(["--version"]) == 0
    assert capsys.readouterr().out.startswith("friction-discs ")


def test_list_names_studies_and_engines(capsys):
    assert cli.status(["list"], fake_studies.ALL) == 0
    out = capsys.readouterr().out
    assert "  verdicts      Fig. 3: self-centring of the pin at low speed\n" in out
    assert "Engines: reference, exudyn" in out
    assert "; on request compiled, plain\n" in out


def test_the_quick_level_takes_the_studies_of_seconds_and_no_names(tmp_path, capsys):
    quick = [
        "report",
        "--level",
        "quick",
        "--engine",
        "fake_studies:straight",
        "--jobs",
        "1",
        "--output",
        str(tmp_path),
    ]
    assert cli.status(quick, fake_studies.ALL) == 0
    results = json.loads((tmp_path / "results.json").read_text(encoding="utf-8"))
    assert [study["name"] for study in results["studies"]] == ["agreement"]
    assert cli.status([*quick, "verdicts"], fake_studies.ALL) == 2
    assert "--level quick chooses the studies: leave out verdicts, or the level" in capsys.readouterr().err


def test_help_starts_without_the_heavy_libraries():
    heavy = "numpy scipy matplotlib numba exudyn exudyn_models reference_model"
    loaded = f"[name for name in '{heavy}'.split() if name in sys.modules]"
    code = f"import sys, compare.cli.app; compare.cli.app.status(['--help']); print({loaded})"
    process = subprocess.run([REAL[0], "-c", code], env=environment(), capture_output=True, encoding="utf-8")
    assert process.stdout.startswith("Usage: friction-discs")
    assert process.stdout.splitlines()[-1] == "[]"


def test_errata_prints_both_forms_and_both_errors(capsys):
    assert cli.status(["errata"]) == 0
    out = capsys.readouterr().out
    for erratum in ERRATA:
        assert f"{erratum.heading}\n  printed    {erratum.printed}\n" in out
    assert out.count(", error ") == 2 * len(ERRATA)


def test_a_report_that_differs_ends_with_status_1(reported):
    process, folder = reported
    assert process.returncode == 1
    assert "\r" not in process.stderr  # no progress bar but on a terminal
    assert "verdicts good differs: The equilibrium is lost at the load of eq. (5)" in process.stdout
    gave_up = "the step size became too small at t = 3.2 s: try a larger tolerance (fake_studies.py:"
    assert process.stdout.count(f"verdicts failing failed: {gave_up}") == 1
    first = "4 agree on independent evidence, besides 1 of algebra; 1 differs, 1 inconclusive, 4 failed"
    totals, *diagnoses = process.stdout.partition(first)[2].splitlines()
    assert totals == f" ({folder / 'index.html'})"
    assert [line.partition(":")[0] for line in diagnoses] == ["good", "failing"]
    assert diagnoses[1].startswith("failing: No result of law: the step size became too small")


def test_a_report_without_differences_ends_with_status_0(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    arguments = ["--engine", "fake_studies:straight", "--jobs", "1", "--output", "new/folder"]
    assert cli.status(["report", "agreement", *arguments], fake_studies.ALL) == 0
    totals, page = "1 agrees on independent evidence; 0 differ, 0 inconclusive", os.path.join("new", "folder")
    assert capsys.readouterr() == (f"{totals} ({os.path.join(page, 'index.html')})\n", "")


@pytest.mark.parametrize(
    ("study", "engine", "status", "totals"),
    [
        (
            "verdicts",
            "straight",
            1,
            "2 agree on independent evidence, besides 1 of algebra; 1 differs, 1 inconclusive",
        ),
        (
            "verdicts",
            "failing",
            1,
            "0 agree on independent evidence, besides 1 of algebra; 0 differ, 0 inconclusive, 1 failed",
        ),
        ("inconclusive", "straight", 3, "0 agree on independent evidence; 0 differ, 1 inconclusive"),
    ],
)
def test_status_of_a_report(study, engine, status, totals, tmp_path, capsys):
    arguments = [
        "report",
        study,
        "--engine",
        f"fake_studies:{engine}",
        "--jobs",
        "1",
        "--output",
        str(tmp_path),
    ]
    assert cli.status(arguments, fake_studies.ALL) == status
    assert f"\n{totals} (" in capsys.readouterr().out


def test_a_system_that_an_engine_is_not_made_for_is_no_failure(tmp_path, capsys):
    arguments = [
        "report",
        "partly",
        "--engine",
        "fake_studies:straight",
        "--output",
        str(tmp_path),
        "--jobs",
        "1",
    ]
    assert cli.status(arguments, fake_studies.ALL) == 0
    lines = capsys.readouterr().out.splitlines()
    lacking = "fake_studies:straight does not simulate a disc on single points or a disc on a continuous ring"
    assert lines == [
        f"partly fake_studies:straight not simulated: {lacking}",
        f"1 agrees on independent evidence; 0 differ, 0 inconclusive, 1 not simulated ({tmp_path / 'index.html'})",
    ]


def test_a_figure_that_fails_ends_with_status_1(tmp_path, capsys):
    arguments = ["report", "undrawable", "--engine", "reference", "--output", str(tmp_path), "--jobs", "1"]
    assert cli.status(arguments, fake_studies.ALL) == 1
    assert "undrawable: the figures could not be drawn: KeyError: 'radius'" in capsys.readouterr().out


SIMULATE = ["simulate", "pin", "--engine", "fake_studies:straight", "--until", "2", "--samples", "3"]
NUMBERS = [[0.0, 0.1, 0.0, 0.03, 0.0], [1.0, 0.13, 0.0, 0.03, 0.0], [2.0, 0.16, 0.0, 0.03, 0.0]]


def test_simulate_writes_csv_to_the_standard_output(capsys):
    assert cli.status(SIMULATE) == 0
    rows = list(csv.reader(io.StringIO(capsys.readouterr().out)))
    assert rows[0] == ["t [s]", "x [m]", "y [m]", "vx [m/s]", "vy [m/s]"]
    np.testing.assert_array_equal(np.array(rows[1:], dtype=float), NUMBERS)


def test_simulate_writes_files(tmp_path, capsys):
    assert cli.status([*SIMULATE, "--output", str(tmp_path / "pin.csv")]) == 0
    assert capsys.readouterr() == ("", "")
    np.testing.assert_array_equal(np.loadtxt(tmp_path / "pin.csv", delimiter=",", skiprows=1), NUMBERS)

    changes = ["--set", "mass=2", "--set", "disc_speed=-1.25", "--start", "-0.1", "0", "-3e-2", "1"]
    assert cli.status([*SIMULATE, *changes, "--output", str(tmp_path / "pin.json")]) == 0
    content = json.loads((tmp_path / "pin.json").read_text())
    assert content["parameters"] == {
        "mass": 2.0,
        "stiffness": 1.0,
        "damping": 0.1,
        "friction_force": 0.09,
        "disc_speed": -1.25,
        "offset": 0.1,
        "hardening": 0.0,
        "stop_gap": 0.0,
        "stop_stiffness": 0.0,
    }
    assert content["states"][0] == [-0.1, 0.0, -0.03, 1.0]
    assert content["times"] == [0.0, 1.0, 2.0]
    assert content["phases"][0]["kind"] == "slip"
    assert content["solution"]["tolerance"] == 1e-9
    assert content["units"]["vx"] == "m/s"


def test_simulate_without_settings_is_the_second_case_of_fig_5(capsys):
    assert cli.status(["simulate", "pin"]) == 0
    out, err = capsys.readouterr()
    assert err == ""
    rows = out.splitlines()
    assert len(rows) == 4002
    assert rows[1] == "0.0,0.1,0.0,0.03,0.0"
    assert rows[-1].startswith("400.0,")


SIMULATE_DISC = [*SIMULATE[:1], "disc", *SIMULATE[2:-4], "--until", "1", "--samples", "2"]
DISC_STATE = ["--start", "0.1", "0", "-0.5", "0.25", "0", "1.25"]


@pytest.fixture
def straight_discs(monkeypatch):
    """The fake engine that moves everything on straight lines promises discs too."""
    monkeypatch.setattr(fake_studies.straight, "kinds", EVERY_KIND, raising=False)


@pytest.mark.usefixtures("straight_discs")
def test_simulate_disc_writes_six_states_with_their_units(tmp_path, capsys):
    assert cli.status([*SIMULATE_DISC, *DISC_STATE]) == 0
    rows = list(csv.reader(io.StringIO(capsys.readouterr().out)))
    units = {"x": "m", "y": "m", "angle": "rad", "vx": "m/s", "vy": "m/s", "spin": "rad/s"}
    assert rows[0] == ["t [s]", *(f"{name} [{unit}]" for name, unit in units.items())]
    numbers = [[0.0, 0.1, 0.0, -0.5, 0.25, 0.0, 1.25], [1.0, 0.35, 0.0, 0.75, 0.25, 0.0, 1.25]]
    np.testing.assert_array_equal(np.array(rows[1:], dtype=float), numbers)

    assert cli.status([*SIMULATE_DISC, *DISC_STATE, "--output", str(tmp_path / "disc.json")]) == 0
    content = json.loads((tmp_path / "disc.json").read_text())
    assert content["system"] == "DiscOnDisc"
    assert content["units"] == {"t": "s"} | units
    assert content["columns"] == list(units)
    assert content["parameters"] == asdict(FIG11)
    assert content["states"] == [row[1:] for row in numbers]


@pytest.mark.usefixtures("straight_discs")
@pytest.mark.parametrize(("text", "points"), [("6", 6), ("24", 24), ("none", None), (" None", None)])
def test_contact_points_are_a_number_or_the_ring(text, points, tmp_path):
    path = tmp_path / "disc.json"
    changes = ["--set", f"contact_points={text}", "--set", "shaft_speed=-1"]
    assert cli.status([*SIMULATE_DISC, *changes, "--output", str(path)]) == 0
    changed = replace(FIG11, contact_points=points, shaft_speed=-1.0)
    assert json.loads(path.read_text())["parameters"] == asdict(changed)


def test_a_reader_that_stops_early_is_no_error(tmp_path):
    process = subprocess.Popen(
        [*REAL, "simulate", "pin", "--until", "50", "--samples", "20001"],
        env=environment(),
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
    )
    process.stdout.readline()
    process.stdout.close()
    assert process.stderr.read() == b""
    assert process.wait(timeout=PATIENCE) == 0
    process.stderr.close()


def test_an_engine_that_gives_up_ends_in_its_sentence(capsys):
    assert cli.status(["simulate", "pin", "--engine", "fake_studies:failing"]) == 1
    sentence = "the step size became too small at t = 3.2 s: try a larger tolerance (fake_studies.py:"
    assert capsys.readouterr().err.startswith(f"engine 'fake_studies:failing' failed: {sentence}")


PIN, DISC = ("simulate", "pin"), ("simulate", "disc")
BAD = [
    (("report", "verdict"), "unknown study 'verdict': did you mean 'verdicts'?"),
    (("report", "--engine", "exudin"), "unknown engine 'exudin': did you mean 'exudyn'?"),
    (("report", "--jobs", "0"), "jobs = 0: it must lie between 1 and 1000"),
    (("report", "--study-limit", "0"), "study-limit = 0 s: it must be > 0"),
    (("report", "--min-conclusive", "-1"), "min-conclusive = -1: it must lie between 0 and 1000000"),
    (("matrix", "--limit", "0"), "limit = 0 s: it must be > 0"),
    (("matrix", "--engine", "exudin"), "unknown engine 'exudin': did you mean 'exudyn'?"),
    (("report", "--study-limit", "soon"), "study-limit = 'soon': it must be a number"),
    (("report", "--jobs", "two"), "jobs = 'two': it must be a whole number"),
    ((*PIN, "--engine", "referense"), "unknown engine 'referense': did you mean 'reference'?"),
    ((*PIN, "--set", "disk_speed=1"), "unknown parameter 'disk_speed': did you mean 'disc_speed'?"),
    ((*PIN, "--set", "mass"), "--set 'mass': write it as NAME=VALUE"),
    ((*PIN, "--set", "mass=heavy"), "mass = 'heavy': it must be a number"),
    ((*PIN, "--set", "mass=-1"), "mass = -1 kg: it must be > 0"),
    ((*PIN, "--set", "mass=0"), "mass = 0 kg: it must be > 0"),
    ((*PIN, "--set", "stiffness=-1"), "stiffness = -1 N/m: it must be >= 0"),
    ((*PIN, "--set", "damping=-0.1"), "damping = -0.1 N s/m: it must be >= 0"),
    ((*PIN, "--set", "friction_force=-2"), "friction_force = -2 N: it must be >= 0"),
    ((*PIN, "--set", "offset=nan"), "offset = nan: it must be finite"),
    ((*PIN, "--set", "disc_speed=inf"), "disc_speed = inf: it must be finite"),
    ((*PIN, "--start", "0", "0", "0", "x"), "start = 'x': it must be a number"),
    ((*PIN, "--start", "0", "nan", "0", "0"), "start = nan: it must be finite"),
    ((*PIN, "--until", "0"), "until = 0 s: it must be > 0"),
    ((*PIN, "--until", "-1"), "until = -1 s: it must be > 0"),
    ((*PIN, "--until", "nan"), "until = nan: it must be finite"),
    ((*PIN, "--until", "soon"), "until = 'soon': it must be a number"),
    ((*PIN, "--samples", "1"), "samples = 1: it must lie between 2 and 10000000"),
    ((*PIN, "--samples", "1" + 14 * "0"), f"samples = {10**14}: it must lie between 2 and 10000000"),
    ((*PIN, "--samples", "2.5"), "samples = '2.5': it must be a whole number"),
    ((*PIN, "--tolerance", "1"), "tolerance = 1: it must lie between 1e-14 and 1e-2"),
    ((*PIN, "--set", "shaft_speed=1"), "unknown parameter 'shaft_speed': did you mean 'disc_speed'?"),
    ((*DISC, "--set", "shaft_spede=1"), "unknown parameter 'shaft_spede': did you mean 'shaft_speed'?"),
    ((*DISC, "--set", "polar_inertia=0"), "polar_inertia = 0 kg m²: it must be > 0"),
    ((*DISC, "--set", "contact_radius=-1"), "contact_radius = -1 m: it must be > 0"),
    ((*DISC, "--set", "shaft_damping=-1"), "shaft_damping = -1 N m s/rad: it must be >= 0"),
    ((*DISC, "--set", "shaft_damping=none"), "shaft_damping = 'none': it must be a number"),
    *(
        (
            (*DISC, "--set", f"contact_points={points}"),
            f"contact_points = {points}: it must be a whole number from 3 to 1000, or None for the "
            "continuous ring; a single point is a PinOnDisc",
        )
        for points in ("1", "2", "2.5", "-6", "1e6")
    ),
    ((*DISC, "--set", "contact_points=six"), "contact_points = 'six': it must be a number"),
    ((*DISC, "--start", "0", "0", "0", "0", "0", "nan"), "start = nan: it must be finite"),
    (
        (*DISC, "--engine", "fake_studies:failing"),
        "fake_studies:failing does not simulate a disc on a continuous ring",
    ),
    (
        (*DISC, "--engine", "fake_studies:failing", "--set", "contact_points=6"),
        "fake_studies:failing does not simulate a disc on single points",
    ),
    ((*PIN, "--output", "pin.txt"), "can't tell the format of 'pin.txt': it must end in .csv or .json"),
]


@pytest.mark.parametrize(("arguments", "sentence"), BAD, ids=[" ".join(arguments) for arguments, _ in BAD])
def test_bad_input_ends_in_one_sentence(arguments, sentence, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    assert cli.status(list(arguments), fake_studies.ALL) == 2
    assert capsys.readouterr() == ("", sentence + "\n")
    assert list(tmp_path.iterdir()) == []  # refused before anything was made


@pytest.mark.parametrize(
    "arguments",
    [
        ("reprot",),
        ("simulate",),
        ("simulate", "pim"),
        (*PIN, "--start", "0", "0"),
        (*PIN, "--start", "0", "0", "0", "0", "0", "0"),
        (*DISC, "--start", "0", "0", "0", "0"),
        (*DISC, "--start", "0", "0", "0", "0", "0", "0", "0"),
        (*PIN, "--sett", "a=1"),
    ],
)
def test_wrong_usage_ends_in_one_sentence(arguments, capsys):
    assert cli.status(list(arguments)) == 2
    out, err = capsys.readouterr()
    assert out == ""
    assert err.count("\n") == 1
    assert "Usage" not in err


@pytest.mark.parametrize(
    ("arguments", "sentence"),
    [
        (
            ("report", "--output", "{file}/report"),
            "can't write into the folder '{file}/report': {no_folder}",
        ),
        (("report", "--output", "{file}"), "can't write into the folder '{file}': {there}"),
        ((*PIN, "--output", "{file}/pin.csv"), "can't write the file '{file}/pin.csv': {no_folder}"),
        (
            (*PIN, "--output", "{folder}/no/pin.csv"),
            "can't write the file '{folder}/no/pin.csv': {missing}",
        ),
    ],
)
def test_what_cannot_be_written_is_refused_before_anything_is_computed(arguments, sentence, tmp_path, capsys):
    names = {
        "file": str(tmp_path / "file"),
        "folder": str(tmp_path),
        "no_folder": os.strerror(errno.ENOTDIR),
        "missing": os.strerror(errno.ENOENT),
        "there": os.strerror(errno.EEXIST),
    }
    (tmp_path / "file").touch()
    assert cli.status([argument.format(**names) for argument in arguments], fake_studies.ALL) == 2
    assert capsys.readouterr() == ("", sentence.format(**names) + "\n")


def test_bad_input_to_the_process(command):
    process = command("simulate", "pin", "--set", "mass=-1")
    assert (process.returncode, process.stdout, process.stderr) == (2, "", "mass = -1 kg: it must be > 0\n")


@pytest.mark.parametrize(
    ("name", "sentence"),
    [
        (
            "fails",
            "engine 'engines_of_mine:fails' failed: KeyError: 'inside' (engines_of_mine.py:2 in fails)",
        ),
        (
            "nothing",
            "engine 'engines_of_mine:nothing' failed: TypeError: simulate() returned None: it must be a",
        ),
        ("other", "engine 'engines_of_mine:other' failed: TypeError: other() "),
    ],
)
def test_whatever_an_engine_raises_or_returns_ends_in_one_sentence(
    name, sentence, tmp_path, monkeypatch, capsys
):
    (tmp_path / "engines_of_mine.py").write_text(
        "def fails(system, initial_state, times, *, tolerance):\n    raise KeyError('inside')\n"
        "def nothing(system, initial_state, times, *, tolerance):\n    pass\n"
        "def other(): pass\n"
    )
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(sys, "path", list(sys.path))
    assert cli.status([*PIN, "--engine", f"engines_of_mine:{name}"]) == 1
    output, errors = capsys.readouterr()
    assert output == ""
    assert errors.startswith(sentence)
    assert errors.count("\n") == 1


@pytest.mark.skipif(not os.path.exists("/dev/full"), reason="there is no device that is always full")
def test_a_full_disk_ends_a_process_in_one_sentence():
    with open("/dev/full", "w") as full:
        done = subprocess.run(
            [*REAL, "list"], env=environment(), stdout=full, stderr=subprocess.PIPE, text=True
        )
    assert (done.returncode, done.stderr) == (2, "can't write to the output: No space left on device\n")


@pytest.mark.skipif(not os.path.exists("/dev/full"), reason="there is no device that is always full")
@pytest.mark.parametrize("arguments", [("list",), (*PIN, "--until", "1"), (*PIN, "--output", "full.csv")])
def test_a_full_disk_ends_in_one_sentence(arguments, tmp_path, monkeypatch, capsys):
    (tmp_path / "full.csv").symlink_to("/dev/full")
    monkeypatch.chdir(tmp_path)
    with open("/dev/full", "w") as full:
        monkeypatch.setattr(sys, "stdout", full)
        assert cli.status(arguments) == 2
    error = capsys.readouterr().err
    assert error.startswith("can't write ")
    assert error.endswith(": No space left on device\n")
    assert error.count("\n") == 1


def test_files_stay_as_they_are_when_the_engine_gives_up(tmp_path, capsys):
    path = tmp_path / "pin.csv"
    path.write_text("precious")
    assert cli.status(["simulate", "pin", "--engine", "fake_studies:failing", "--output", str(path)]) == 1
    assert path.read_text() == "precious"
    new = tmp_path / "new.csv"
    assert cli.status(["simulate", "pin", "--engine", "fake_studies:failing", "--output", str(new)]) == 1
    assert not new.exists()


def test_on_a_terminal_there_is_a_progress_bar(tmp_path, monkeypatch):
    class Terminal(io.StringIO):
        def isatty(self):
            return True

    monkeypatch.setenv("TERM", "xterm")
    monkeypatch.setattr(sys, "stderr", Terminal())
    arguments = ["--engine", "fake_studies:straight", "--jobs", "1", "--output", str(tmp_path)]
    assert cli.status(["report", "agreement", *arguments], fake_studies.ALL) == 0
    assert "2/2" in sys.stderr.getvalue()
