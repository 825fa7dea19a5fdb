"""Arguments, exit status and message of the command line."""

import errno
import os
import re
import shlex

import fake_studies
import pytest

from compare.cli import app as cli

pytestmark = pytest.mark.usefixtures("in_this_process")

PIN, DISC, BASIN, MAP = "simulate pin", "simulate disc", "sweep basin pin", "sweep map pin"
UNCERTAIN, ALONG = "sweep uncertainty pin", "sweep continuation pin"
SIZE, MOST = "its size must be between 1e-50 and 1e+50", "its size must be at most 1e+50"
POINTS = "a whole number from 3 to 1000, or None for the continuous ring; use PinOnDisc for a single point"
AXES = "--x or --y already varies"
CLAIM = "--claim cannot be combined with named studies, --level or --resume"
VARIED = "--vary already varies"
OF_NORMAL = "normal takes (mean, deviation) with deviation > 0"
NORMAL = "--vary 'x=normal(0, 1)'"
NO_FOLDER, MISSING, THERE = map(os.strerror, (errno.ENOTDIR, errno.ENOENT, errno.EEXIST))
GAVE_UP = "the step size became too small at t = 3.2 s: try a larger tolerance (fake_studies.py:…)"

HELP = [
    (f"{command} --help", 0, f"Usage: friction-discs {command} [OPTIONS]…")
    for command in (
        *("list", "report", "diff", "matrix", "plan", "errata", "simulate", "simulate pin", "simulate disc"),
        *("export-fmu", "export-fmu pin", "export-fmu disc", "export-fmu clutch"),
        *("sweep", "sweep basin", "sweep map", "sweep uncertainty", "sweep continuation", "sweep shock"),
        "sweep figures",
    )
]

BAD = [
    ("report verdict", "unknown study 'verdict': did you mean 'verdicts'?"),
    ("report --engine exudin", "unknown engine 'exudin': did you mean 'exudyn'?"),
    ("report --engine mujoco:piramid", "unknown setting of mujoco 'piramid': did you mean 'pyramid'?"),
    ("report --engine zzz", "unknown engine 'zzz': choose from reference, exudyn…"),
    ("report --engine :simulate", "engine ':simulate' …"),
    ("report --engine .:simulate", "engine '.:simulate' …"),
    ("report --engine exec:./missing", "./missing: command not found"),
    ("report --engine files:.", "…/plan.json cannot be read: …; create it with friction-discs plan"),
    ("report --engine fmu:missing.fmu", "fmu:missing.fmu: file not found"),
    ("report --engine numpy:pi", "engine 'numpy:pi' is not callable: expected simulate(system, …"),
    ("report --engine numpy:no", "engine 'numpy:no' cannot be imported: … has no attribute 'no'"),
    ("report --engine nothing:no", "engine 'nothing:no' cannot be imported: No module named 'nothing'"),
    ("report --level medium", "unknown level 'medium': choose from quick, full"),
    ("report --jobs 0", "jobs = 0: it must lie between 1 and 1000"),
    ("report --jobs two", "jobs = 'two': it must be a whole number"),
    ("report --study-limit 0", "study-limit = 0 s: it must be > 0"),
    ("report pushes --data .", "--data .: no such folder, or it contains no logs like 10_90_10_…txt.xz"),
    ("report --min-conclusive -1", "min-conclusive = -1: it must lie between 0 and 1000000"),
    (
        "report --level quick verdicts",
        "--level quick selects the studies, so it cannot be combined with verdicts; omit …",
    ),
    ("report --output a --output b", "--output is given 2 times; give it once"),
    ("report --output ''", "--output '': it must not be empty"),
    ("report --output file/report", f"cannot write to the folder 'file/report': {NO_FOLDER}"),
    ("report --claim verdicts/x verdicts", CLAIM),
    ("report --claim verdicts/x --level quick", CLAIM),
    ("report --claim verdicts/x --resume", CLAIM),
    ("matrix --limit 0", "limit = 0 s: it must be > 0"),
    ("matrix --benchmark --recorded", "--recorded: the benchmark has no recorded results; omit it"),
    ("plan --kind sphere", "…unknown kind of system 'sphere'…"),
    ("diff nowhere nowhere", f"cannot read 'nowhere': {MISSING}"),
    (
        "diff file file",
        "'file' is not the results.json of a report: Expecting value: line 1 column 1 (char 0)",
    ),
    ("export-fmu pin --fmi 4 --output pin.fmu", "fmi = 4: it must lie between 2 and 3"),
    ("export-fmu pin --output pin.zip", "output = 'pin.zip': the name of a unit must end with .fmu"),
    ("export-fmu clutch --set plate=2 --output c.fmu", "unknown parameter 'plate': did you mean 'plates'?"),
    ("export-fmu clutch --set plates=0 --output c.fmu", "plates = 0: it must lie between 1 and 1000"),
    ("export-fmu clutch --set plates=1.5 --output c.fmu", "plates = 1.5: it must be a whole number"),
    ("reprot", "…"),
    ("simulate", "…"),
    (f"{PIN} --plot a.gif", "--plot 'a.gif': the file name must end in .png or .pdf or .svg"),
    (f"{PIN} --plot file/a.png", f"cannot write the file 'file/a.png': {NO_FOLDER}"),
    (f"{PIN} --start 0 0", "…"),
    (f"{PIN} --start 0 0 0 x", "start = 'x': it must be a number, such as 0.5 or -1e-3"),
    (f"{PIN} --start 0 nan 0 0", "start = nan: it must be finite"),
    (f"{PIN} --set disk_speed=1", "unknown parameter 'disk_speed': did you mean 'disc_speed'?"),
    (f"{PIN} --set mass", "--set 'mass': write it as NAME=VALUE"),
    (f"{PIN} --set mass=-1", "mass = -1 kg: it must be > 0"),
    (f"{PIN} --set mass=1 --set mass=2", "--set mass is given more than once; give it once"),
    (f"{PIN} --set mass=1e-320", f"mass = 9.99989e-321 kg: {SIZE}"),
    (f"{PIN} --set damping=1e300", f"damping = 1e+300 N s/m: {MOST}"),
    (f"{PIN} --set mass=1e-40", "damping = 0.1 N s/m: damping/mass = 1e+39 must be at most 1e+25"),
    (f"{DISC} --set contact_radius=1e200", f"contact_radius = 1e+200 m: {SIZE}"),
    (f"{DISC} --set polar_inertia=1e-40", "contact_radius = 0.12 m: …/polar_inertia = 1.44e+38…"),
    (f"{DISC} --set shaft_damping=none", "shaft_damping = 'none': it must be a number, such as 0.5 or -1e-3"),
    (f"{DISC} --set contact_points=2.5", f"contact_points = 2.5: it must be {POINTS}"),
    (f"{PIN} --until 0", "until = 0 s: it must be > 0"),
    (f"{PIN} --samples 1", "samples = 1: it must lie between 2 and 10000000"),
    (f"{PIN} --tolerance 1", "tolerance = 1: it must lie between 1e-14 and 1e-2"),
    (f"{PIN} --output pin.txt", "unknown format of 'pin.txt': the file name must end in .csv or .json"),
    (f"{PIN} --output no/pin.csv", f"cannot write the file 'no/pin.csv': {MISSING}"),
    (f"{DISC} --engine fake_studies:failing", "… does not simulate a disc on a continuous ring"),
    ("sweep basin pins", "unknown system 'pins': did you mean 'pin'?"),
    (f"{BASIN} --x offset=0:1:5", "unknown component 'offset': choose from x, y, vx, vy"),
    (f"{BASIN} --x x=1:1:5", "axis x from 1 to 1: the lower end must be less than the upper end"),
    (f"{BASIN} --x x", "axis 'x': write it as NAME=LOW:HIGH:POINTS"),
    (f"{BASIN} --x x=0:inf:5", "x = inf: it must be finite"),
    (f"{BASIN} --x x=0:1:1", "axis x with 1 points: it must have 2 to 100000…"),
    (f"{BASIN} --x x=0:1:2.5", "axis 'x=0:1:2.5': the number of points must be a whole number"),
    (f"{BASIN} --x x=-1e308:1e308:10", "axis x from -1e+308 to 1e+308: the range must be finite"),
    (f"{BASIN} --x vx=0:1:5", "vx is on both axes; --x and --y must be different quantities"),
    (f"{BASIN} --x x=0:1:100000 --y y=0:1:100000", "grid too large: 1e+10 points, the limit is 1e+08"),
    (f"{BASIN} --x ''", "--x '': it must not be empty"),
    (f"{BASIN} --random 0", "random = 0: it must lie between 1 and…"),
    (f"{BASIN} --random 9 --coarse 9", "--coarse cannot be combined with --random"),
    (f"{BASIN} --coarse 1", "coarse = 1: it must lie between 2 and…"),
    (f"{BASIN} --chunk 0", "chunk = 0: it must lie between 1 and…"),
    (f"{BASIN} --until 0", "until = 0 s: it must be > 0"),
    (f"{BASIN} --seed -1", "seed = -1: it must lie between 0 and…"),
    (f"{BASIN} --start z=1", "unknown component 'z'…"),
    (f"{BASIN} --start 0.1", "--start '0.1': write it as NAME=VALUE,NAME=VALUE"),
    (f"{BASIN} --start y=1,y=2", "--start 'y=1,y=2': y is given more than once"),
    (f"{MAP} --start x=1e60", "initial_state[0] = 1e+60: it must not be larger than 1e+50…"),
    (f"{BASIN} --start x=1", f"--start x: {AXES} x; leave one of them out"),
    (f"{BASIN} --set hardening=-1", "hardening = -1…"),
    (f"{BASIN} --output file", f"cannot write to the folder '…file': {THERE}"),
    (f"{BASIN} --output s4://sweeps", "cannot open 's4://sweeps': …; use a folder or s3://BUCKET/NAME"),
    (f"{BASIN} --scheduler tcp://here", "scheduler = 'tcp://here': write it as tcp://HOST:PORT"),
    (f"{BASIN} --scheduler tcp://here:port", "scheduler = 'tcp://here:port': write it as tcp://HOST:PORT"),
    (f"{MAP} --x vx=0:1:5", "unknown parameter 'vx'…"),
    (f"{MAP} --x mass=1:1e300:10", f"mass = 1e+300 kg: {SIZE}"),
    (f"{MAP} --y friction_force=-0.1:0.1:4", "friction_force = -0.1 N: it must be >= 0"),
    (f"{MAP} --set disc_speed=2", f"--set disc_speed: {AXES} disc_speed; leave one of them out"),
    ("sweep map disc --x contact_points=3:6:4", "unknown parameter 'contact_points'…"),
    (UNCERTAIN, "no uncertain quantity given; use --vary…"),
    (f"{UNCERTAIN} --vary 'mass=normal(1, 0.1)'", "… includes mass = -inf, but it must be > 0…"),
    (f"{UNCERTAIN} --vary 'mass=gauss(1, 0.1)'", "unknown distribution 'gauss': choose from normal, …"),
    (f"{UNCERTAIN} --vary 'mass=normal(1)'", f"mass=normal(1): {OF_NORMAL}"),
    (f"{UNCERTAIN} --vary 'mass=normal(1, 0)'", f"mass=normal(1, 0): {OF_NORMAL}"),
    (f"{UNCERTAIN} --vary 'mass=uniform(2, 1)'", "… uniform takes (low, high) with low < high"),
    (f"{UNCERTAIN} --vary 'mass=uniform(0, 1)'", "… includes mass = 0, but it must be > 0…"),
    (f"{UNCERTAIN} --vary 'mass=triangular(1, 3, 2)'", "… with low <= mode <= high and low < high"),
    (f"{UNCERTAIN} --vary 'mas=normal(1, 0.1)'", "… 'mas': did you mean 'mass'?"),
    ("sweep uncertainty disc --vary 'contact_points=uniform(3, 6)'", "unknown … 'contact_points'…"),
    (f"{UNCERTAIN} --vary 'mass=normal(1'", "--vary 'mass=normal(1': write it as NAME=DISTRIBUTION…"),
    (f"{UNCERTAIN} {NORMAL} --vary 'x=uniform(0, 1)'", "--vary x is given more than once; give it once"),
    (f"{UNCERTAIN} {NORMAL} --samples 1000", "samples = 1000: it must be a power of 2, for example 1024"),
    (f"{UNCERTAIN} {NORMAL} --samples 128", "samples = 128: it must lie…"),
    (f"{UNCERTAIN} {NORMAL} --start x=1", f"--start x: {VARIED} x; leave one of them out"),
    (f"{UNCERTAIN} --vary 'mass=uniform(1, 2)' --set mass=1", f"--set mass: {VARIED} mass; leave one…"),
    (f"{ALONG} --x x=0:1:5", "unknown parameter 'x'…"),
    (f"{ALONG} --vary 'x=uniform(0, 1e60)'", "… includes x = 1e+60, but it must not be larger than 1e+50…"),
    (f"{ALONG} --vary 'x=truncnorm(0, 1e-300, 1, 2)'", "…: its values are not finite numbers…"),
    (f"{ALONG} --vary 'mass=uniform(1, 2)'", "…unknown component 'mass'…"),
    (f"{ALONG} --set disc_speed=2", "--set disc_speed: --x already varies disc_speed; leave one of them out"),
    ("sweep shock --set damping=0.5", "no saddle-type stick-slip orbit at these parameters, so …"),
    ("sweep shock --set offset=0", "friction_force = 0.09 N: the self-centred equilibrium exists only…"),
    ("sweep figures nowhere", "…is not the store of a sweep…"),
]

ENGINE = """
import sys
from compare.engines import UnsupportedSystemError
def fails(system, initial_state, times, *, tolerance):
    raise KeyError('inside')
def nothing(system, initial_state, times, *, tolerance):
    pass
def refusing(*arguments, **accuracy):
    raise UnsupportedSystemError('nothing')
def leaving(*arguments, **accuracy):
    sys.exit(0)
"""

FAILED = [
    (f"{PIN} --engine fake_studies:failing", f"engine 'fake_studies:failing' failed: {GAVE_UP}"),
    (
        f"{PIN} --engine engines_of_mine:fails",
        "engine 'engines_of_mine:fails' failed: KeyError: 'inside' (engines_of_mine.py:5 in fails)",
    ),
    (
        f"{PIN} --engine engines_of_mine:nothing",
        "engine 'engines_of_mine:nothing' failed: TypeError: simulate() returned None: it must be a…",
    ),
    (f"{PIN} --engine engines_of_mine:refusing", "…"),
    (f"{PIN} --engine engines_of_mine:leaving", "…"),
]

STUDIES = (fake_studies.VERDICTS, fake_studies.AGREEMENT)
"""Fake studies, so a bug that starts a report by mistake cannot end this process."""

TABLE = [
    ("", 0, "Usage: friction-discs…"),
    ("--version", 0, "friction-discs …"),
    *HELP,
    *((arguments, 2, sentence) for arguments, sentence in BAD),
    *((arguments, 1, sentence) for arguments, sentence in FAILED),
]


@pytest.mark.parametrize(
    ("arguments", "status", "sentence"), TABLE, ids=[row[0] or "nothing" for row in TABLE]
)
def test_arguments_give_status_and_message(arguments, status, sentence, tmp_path, monkeypatch, capsys):
    """Expect one line on the error stream unless the status is 0, and no files."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.syspath_prepend(tmp_path)
    (tmp_path / "file").touch()
    (tmp_path / "engines_of_mine.py").write_text(ENGINE)
    assert cli.status(shlex.split(arguments), STUDIES) == status
    out, err = capsys.readouterr()
    err = re.sub(r"Compiling for this machine.*\n", "", err)  # on a machine without compiled kernels
    said, nothing = (out, err) if status == 0 else (err, out)
    pattern = ".*".join(map(re.escape, sentence.split("…")))
    assert re.fullmatch(f"{pattern}\n", said, re.DOTALL if status == 0 else re.NOFLAG), said
    assert nothing == ""
    assert "--help" not in arguments or "<" not in said, "a Python type"
    assert {path.name for path in tmp_path.iterdir()} - {"__pycache__"} == {"file", "engines_of_mine.py"}
