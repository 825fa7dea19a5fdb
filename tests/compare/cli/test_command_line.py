"""Output and files of the commands ``list``, ``errata`` and ``simulate``, and ends of processes."""

import csv
import io
import json
import os
import re
import subprocess
import sys
import time
from contextlib import contextmanager
from dataclasses import asdict, replace

import fake_studies
import matplotlib
import numpy as np
import pytest
from processes import REAL, environment, interruptible

from compare.claims.errata import ERRATA, TEXT
from compare.claims.parameters import FIG5, FIG11
from compare.cli import app as cli
from compare.engines import EVERY_KIND
from compare.run.workers import failure, lacks_memory

pytestmark = pytest.mark.usefixtures("in_this_process")


def test_list_shows_engines_and_studies_with_the_times_of_the_last_report(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "report").mkdir()
    units = {"good": {"seconds": 2.5}, "other": {"seconds": 4.0}, "stopped": {"seconds": None}}
    results = {"studies": [{"name": "verdicts", "units": units}]}
    for content, seconds in ((json.dumps(results), "6.5"), ("{", "1.0")):
        (tmp_path / "report" / "results.json").write_text(content)
        assert cli.status(["list"], fake_studies.ALL) == 0
        out = capsys.readouterr().out
        title = "Fig. 3: self-centring of the pin at low speed"
        assert re.search(rf"^  verdicts +{seconds} s  full +every engine +{title}$", out, re.M)
        assert re.search(r"^  agreement +1.0 s  quick ", out, re.M)
    assert "\nEngines: reference, exudyn, exudyn-native\n" in out
    assert "on request: plain, " in out
    assert ", mujoco:pyramid" in out


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


@pytest.mark.skipif(os.name != "posix", reason="needs a POSIX shell")
@pytest.mark.parametrize(
    ("arguments", "status"), [("simulate pin --until 1", 0), ("simulate pin --until x", 2)]
)
def test_closed_input_and_error_streams_change_no_status(arguments, status, tmp_path):
    output = tmp_path / "motion.csv"
    command = f"exec {REAL[0]} -m compare.cli {arguments} --output {output} <&- 2>&-"
    done = subprocess.run(["sh", "-c", command], env=environment(), capture_output=True, encoding="utf-8")
    assert (done.returncode, done.stdout, output.exists()) == (status, "", status == 0)


SIMULATE = ("--engine", "fake_studies:straight", "--samples", "3", "--until", "2")
UNITS = {"x": "m", "y": "m", "angle": "rad", "vx": "m/s", "vy": "m/s", "spin": "rad/s"}
OF_PIN = {name: unit for name, unit in UNITS.items() if name not in ("angle", "spin")}
MOTIONS = {
    "pin": (
        replace(FIG5, mass=2.0, disc_speed=-1.25),
        "--set mass=2 --set disc_speed=-1.25 --start -0.1 0 -3e-2 1",
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


def test_simulate_draws_the_motion_in_place_of_a_table(tmp_path, monkeypatch, capsys):
    monkeypatch.setitem(matplotlib.rcParams, "text.usetex", True)  # the user's own setting
    monkeypatch.setenv("PATH", str(tmp_path))  # no LaTeX
    picture = tmp_path / "motion.pdf"
    assert cli.status(["simulate", "pin", *SIMULATE, "--plot", str(picture)]) == 0
    assert capsys.readouterr() == ("", "")
    assert picture.read_bytes().startswith(b"%PDF")


def test_simulate_shows_the_elapsed_time_on_a_terminal(monkeypatch, capsys):
    monkeypatch.setenv("TERM", "xterm")
    monkeypatch.setattr(sys.stderr, "isatty", lambda: True)
    shown = []
    for patience in (0.0, 60.0):
        monkeypatch.setattr("compare.cli.simulate.PATIENCE", patience)
        assert cli.status(["simulate", "pin", *SIMULATE]) == 0
        shown.append("fake_studies:straight simulates until t = 2 s" in capsys.readouterr().err)
    assert shown == [True, False]


def test_simulate_without_settings_is_the_second_case_of_fig_5(capsys):
    assert cli.status(["simulate", "pin"]) == 0
    out, err = capsys.readouterr()
    assert err == ""
    rows = out.splitlines()
    assert len(rows) == 4002
    assert rows[1] == "0.0,0.1,0.0,0.03,0.0"
    assert rows[-1].startswith("400.0,")


@pytest.mark.skipif(not os.path.exists("/dev/full"), reason="there is no device that is always full")
@pytest.mark.parametrize("arguments", ["simulate pin --until 1", "simulate pin --output full.csv"])
def test_a_full_disk_gives_a_message_of_one_line(arguments, tmp_path, monkeypatch, capsys):
    (tmp_path / "full.csv").symlink_to("/dev/full")
    monkeypatch.chdir(tmp_path)
    with open("/dev/full", "w") as full:
        monkeypatch.setattr(sys, "stdout", full)
        assert cli.status(arguments.split()) == 2
    assert re.fullmatch(r"cannot write .*: No space left on device\n", capsys.readouterr().err)


@contextmanager
def without_reader(monkeypatch):
    """Replace standard output by a pipe without a reader.

    Closing it, as a process does at its end, must not fail either. A fixture would be too early, because pytest sets
    standard output again before each test.
    """
    reader, writer = os.pipe()
    os.close(reader)
    with open(writer, "w") as output, monkeypatch.context() as patch:
        patch.setattr(sys, "stderr", sys.stderr)  # typer may replace it
        patch.setattr(sys, "stdout", output)
        yield


@pytest.mark.parametrize(
    ("arguments", "status"),
    [
        ("list", 0),
        ("simulate pin --until 1", 0),
        ("report undrawable --engine fake_studies:straight --output out", 0),
    ],
)
def test_a_reader_that_stops_early_changes_no_status(arguments, status, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    with without_reader(monkeypatch):
        assert cli.status(arguments.split(), fake_studies.ALL) == status
    assert capsys.readouterr() == ("", "")


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


def test_a_process_that_is_interrupted_while_it_loads_says_so(tmp_path):
    (tmp_path / "typer.py").write_text("raise KeyboardInterrupt")
    path = os.pathsep.join([str(tmp_path), environment()["PYTHONPATH"]])
    done = subprocess.run([*REAL, "list"], env=environment(PYTHONPATH=path), capture_output=True, text=True)
    assert (done.returncode, done.stderr) == (130, "Interrupted.\n")


SOON = 30.0
"""Time limit in s; all commands would take a minute."""

LOSING = """
import hashlib, os, signal, tempfile, threading, time, weakref
from pathlib import Path
from compare.cli import app, main
from compare.output.text_files import locked, replacing
from compare.run.interrupts import postponed

def callback():
    thing = set()
    lost = weakref.ref(thing, lambda _: signal.raise_signal(NUMBER))
    del thing

def module():
    try:
        signal.raise_signal(NUMBER)
    except:
        pass

def compiled():
    threading.Timer(0.1, os.kill, (os.getpid(), NUMBER)).start()
    hashlib.pbkdf2_hmac("sha256", b"", b"", 1_000_000_000)

def start_of_a_process():
    with postponed():
        signal.raise_signal(NUMBER)
        time.sleep(2.0)

def command(*arguments, **options):
    with tempfile.TemporaryDirectory(dir="."), locked(Path(".")), replacing(Path("file")):
        CODE()
        time.sleep(60.0)

app.app = command
main([])
"""


@pytest.mark.skipif(os.name == "nt", reason="Ctrl-C is sent as a POSIX signal")
@pytest.mark.parametrize("number", ["signal.SIGINT", "signal.SIGTERM"])
@pytest.mark.parametrize("code", ["callback", "module", "compiled", "start_of_a_process"])
def test_an_interrupt_ends_a_command_in_code_that_loses_or_delays_it(code, number, tmp_path):
    text = LOSING.replace("CODE", code).replace("NUMBER", number)
    begin = time.monotonic()
    done = subprocess.run(
        [REAL[0], "-c", text],
        env=environment(),
        capture_output=True,
        text=True,
        cwd=tmp_path,
        preexec_fn=interruptible,
    )
    assert (done.returncode, done.stderr, list(tmp_path.iterdir())) == (130, "Interrupted.\n", [])
    assert time.monotonic() - begin < SOON


def test_a_process_ends_normally_without_a_reader():
    reader, writer = os.pipe()
    os.close(reader)
    done = subprocess.run([*REAL, "--help"], env=environment(), stdout=writer, stderr=subprocess.PIPE)
    os.close(writer)
    assert (done.returncode, done.stderr) == (0, b"")
