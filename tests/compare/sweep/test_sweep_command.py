"""The command line of sweeps: its help, what it refuses, what it prints and draws."""

import re
import shutil
import subprocess
from dataclasses import asdict

import pytest
from long_sweeps import content
from processes import REAL, ROOT, environment

from compare.claims.parameters import FIG5
from compare.cli import app as cli
from compare.cli.command import NOTHING_SHOWN
from compare.cli.sweep.commands import MAPS, PLANES
from compare.cli.sweep.run import STORE
from compare.sweep.distributions import KINDS
from compare.sweep.files import Files
from compare.sweep.store import SweepStore

SMALL = ["--until", "20"]  # most are undecided then
BASIN = ["sweep", "basin", "pin", "--x", "x=0:0.2:3", "--y", "vx=0:0.1:2", *SMALL]


@pytest.mark.parametrize(
    "name", ["", " basin", " map", " uncertainty", " continuation", " shock", " figures"]
)
def test_help_of_every_sweep_has_an_example(name, capsys):
    assert cli.status(["sweep", *name.split(), "--help"]) == 0
    assert f"friction-discs sweep{name}" in capsys.readouterr().out


def test_help_has_the_axes_and_distributions_that_there_are(capsys):
    for name, axes in (("basin", PLANES), ("map", MAPS)):
        cli.status(["sweep", name, "--help"])
        out = capsys.readouterr().out
        for system, (x, y) in axes.items():
            assert re.search(rf"{system} +--x {re.escape(x)} --y {re.escape(y)}\n", out)
    cli.status(["sweep", "uncertainty", "--help"])
    out = capsys.readouterr().out
    for name, kind in KINDS.items():
        assert f" {name}({', '.join(kind.arguments)}" in out


def test_help_of_sweeps_starts_without_the_heavy_libraries():
    heavy = "numpy scipy matplotlib numba xarray zarr distributed reference_model"
    code = (
        "import sys, compare.cli.app; compare.cli.app.status(['sweep', 'basin', '--help']); "
        f"print([name for name in '{heavy}'.split() if name in sys.modules])"
    )
    process = subprocess.run([REAL[0], "-c", code], env=environment(), capture_output=True, encoding="utf-8")
    assert process.stdout.splitlines()[-1] == "[]"


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["basin", "pins"], "unknown system 'pins': did you mean 'pin'?"),
        (["basin", "pin", "--x", "spin=0:1:5"], "unknown component 'spin'"),
        (["basin", "pin", "--x", "offset=0:1:5"], "unknown component 'offset': known are x, y, vx, vy"),
        (["basin", "pin", "--x", "x=1:1:5"], "x from 1 to 1: the range must begin below its end"),
        (["basin", "pin", "--x", "x=0:1:1"], "x with 1 points: there must be 2 to 100000"),
        (["basin", "pin", "--x", "vx=0:1:5"], "vx is on both axes: they must be different"),
        (["basin", "pin", "--x", "x=0:1:100000", "--y", "y=0:1:100000"], "there may be 100000000 in a plane"),
        (["basin", "pin", "--random", "0"], "random = 0: it must lie between 1 and"),
        (["basin", "pin", "--coarse", "1"], "coarse = 1: it must lie between 2 and"),
        (["basin", "pin", "--chunk", "0"], "chunk = 0: it must lie between 1 and"),
        (["basin", "pin", "--until", "0"], "until = 0 s: it must be > 0"),
        (["basin", "pin", "--tolerance", "1"], "tolerance = 1: it must lie between"),
        (["basin", "pin", "--seed", "-1"], "seed = -1: it must lie between 0 and"),
        (["basin", "pin", "--start", "z=1"], "unknown component 'z'"),
        (["basin", "pin", "--start", "0.1"], "--start '0.1': write it as NAME=VALUE,NAME=VALUE"),
        (["basin", "pin", "--set", "mass=0"], "mass = 0 kg: it must be > 0"),
        (["basin", "pin", "--set", "hardening=1"], "hardening = 1"),
        (["map", "pin", "--x", "vx=0:1:5"], "unknown parameter 'vx'"),
        (["map", "disc", "--x", "contact_points=3:6:4"], "unknown parameter 'contact_points'"),
        (["map", "pin", "--y", "friction_force=-0.1:0.1:4"], "friction_force = -0.1 N: it must be >= 0"),
        (["uncertainty", "pin"], "nothing is uncertain: say what is"),
        (
            ["uncertainty", "pin", "--vary", "mass=normal(1, 0.1)"],
            "it allows mass = -inf, and it must be > 0",
        ),
        (["uncertainty", "pin", "--vary", "x=normal(0, 1)", "--vary", "x=uniform(0, 1)"], "more than once"),
        (
            ["uncertainty", "pin", "--vary", "x=normal(0, 1)", "--samples", "1000"],
            "samples = 1000: it must be a power of 2, 1024 for instance",
        ),
        (
            ["uncertainty", "pin", "--vary", "x=normal(0, 1)", "--samples", "128"],
            "samples = 128: it must lie",
        ),
        (["continuation", "pin", "--x", "x=0:1:5"], "unknown parameter 'x'"),
        (["continuation", "pin", "--vary", "mass=uniform(1, 2)"], "unknown component 'mass'"),
        (["continuation", "pin", "--set", "disc_speed=2"], "it has its values from --x"),
        (["continuation", "pin", "--x", "mass=-1:1:3"], "mass = -1 kg: it must be > 0"),
        (["continuation", "pin", "--scheduler", "1e-400"], "1e-400"),
        (["basin", "pin", "--scheduler", "tcp://127.0.0.1:1"], "tcp://127.0.0.1:1"),
        (["figures", "nowhere"], "is no store of a sweep"),
    ],
)
def test_bad_input_is_refused_in_one_sentence_and_nothing_is_written(arguments, words, capsys, tmp_path):
    folder = tmp_path / "s"
    more = [] if arguments[0] == "figures" else ["--output", str(folder)]
    assert cli.status(["sweep", *arguments, *more]) == 2
    out, err = capsys.readouterr()
    assert out == ""
    assert words in err
    assert err.count("\n") == 1
    assert not folder.exists()


@pytest.mark.parametrize("more", [[], ["--resume"]])
def test_of_two_commands_that_begin_at_once_the_later_one_is_told(more, tmp_path, monkeypatch, capsys):
    there = [set(), {"zarr.json"}]  # it is there when the store is made, and not when the command looks
    monkeypatch.setattr(Files, "inside", lambda self, folder="": there.pop(0))
    assert cli.status([*BASIN, "--output", str(tmp_path), *more]) == 2
    place = str(tmp_path / STORE)
    sentence = f"another command has just begun {place!r}: wait until it ends, or take another --output\n"
    assert capsys.readouterr() == ("", sentence)


@pytest.fixture(scope="module")
def finished(tmp_path_factory):
    folder = tmp_path_factory.mktemp("finished")
    arguments = [*BASIN, "--output", str(folder)]
    assert cli.status(arguments) == NOTHING_SHOWN
    return folder, arguments


def files(folder):
    return {
        path: (path.stat().st_mtime_ns, path.read_bytes()) for path in folder.rglob("*") if path.is_file()
    }


def test_the_code_of_the_page_about_sweeps_runs(finished, tmp_path, monkeypatch):
    """All of it but a cluster of a batch system, which is the last block."""
    (tmp_path / "basin").symlink_to(finished[0])
    monkeypatch.chdir(tmp_path)
    text = (ROOT / "docs" / "sweeps.md").read_text(encoding="utf-8")
    blocks = [block for block in re.findall(r"```python\n(.*?)```", text, re.DOTALL) if "dask" not in block]
    assert len(blocks) == 2
    names = {}
    for block in blocks:
        exec(block, names)
        if "open_zarr" in block:
            assert "self_centred" in names["found"].attrs["flag_meanings"]
    assert list(names["found"].end) == [1, 1, 2]


@pytest.mark.parametrize(
    ("more", "words"),
    [
        ([], "is there already: --resume goes on with it, or take another --output"),
        (["--seed", "2", "--resume"], "belongs to another sweep: take another --output"),
        (["--set", "mass=2"], "belongs to another sweep: take another --output"),
        (["--chunk", "5", "--resume"], "chunk = 5: "),
    ],
)
def test_a_store_of_another_sweep_is_refused_and_nothing_overwritten(finished, more, words, capsys):
    folder, arguments = finished
    before = files(folder)
    assert cli.status([*arguments, *more]) == 2
    assert words in capsys.readouterr().err
    assert files(folder) == before


def test_a_store_of_other_code_is_refused(finished, monkeypatch, capsys):
    _, arguments = finished
    monkeypatch.setattr("compare.run.provenance.stamp", lambda: "other")
    assert cli.status([*arguments, "--resume"]) == 2
    assert "was computed by other code or libraries" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("more", "until"),
    [
        (["pin"], 12000.0),
        (["disc"], 12000.0),
        (["disc", "--set", "contact_points=6"], 1200.0),
        (["disc", "--set", "contact_points=6", "--until", "7"], 7.0),
    ],
    ids=lambda value: " ".join(value) if isinstance(value, list) else "",
)
def test_an_end_is_waited_for_as_long_as_the_help_says(more, until, monkeypatch, capsys):
    plans = []
    monkeypatch.setattr("compare.cli.sweep.options.run_sweep", lambda plan, *others: plans.append(plan))
    cli.status(["sweep", "basin", *more])
    assert plans[0].duration == until
    cli.status(["sweep", "basin", "--help"])
    words = " ".join(capsys.readouterr().out.split())
    assert "[default: (12000, of a disc on single points 1200)]" in words


def test_a_folder_that_is_no_store_is_refused_and_left_alone(capsys, tmp_path):
    (tmp_path / STORE).mkdir()
    (tmp_path / STORE / "precious").write_text("data")
    assert cli.status([*BASIN, "--output", str(tmp_path), "--resume"]) == 2
    assert "is no store of a sweep" in capsys.readouterr().err
    assert [path.name for path in (tmp_path / STORE).iterdir()] == ["precious"]


def test_a_folder_that_cannot_be_written_is_refused(capsys, tmp_path):
    (tmp_path / "file").write_text("")
    assert cli.status([*BASIN, "--output", str(tmp_path / "file")]) == 2
    assert "can't write into the folder" in capsys.readouterr().err


def test_resuming_a_finished_sweep_prints_its_results_again(finished, capsys):
    folder, arguments = finished
    assert cli.status([*arguments, "--resume"]) == NOTHING_SHOWN
    out = capsys.readouterr().out
    assert out.startswith("6 of 6 starts simulated\n")
    assert cli.status(["sweep", "figures", str(folder)]) == NOTHING_SHOWN
    assert capsys.readouterr().out == out


def test_parameters_and_the_other_components_are_taken(tmp_path):
    more = ["--set", "damping=0.2", "--start", "y=0.05,vy=-0.1", "--output", str(tmp_path)]
    assert cli.status([*BASIN, *more]) == 0
    plan = SweepStore.open(tmp_path / STORE).plan
    assert asdict(plan.system) == asdict(FIG5) | {"damping": 0.2}
    states, _ = plan.trajectories(range(6))
    assert states.tolist() == [[x, 0.05, vx, -0.1] for vx in (0.0, 0.1) for x in (0.0, 0.1, 0.2)]


def test_figures_are_drawn_again_on_demand(finished):
    folder, _ = finished
    before = {name: (folder / name).read_bytes() for name in ("basin.svg", "basin.png")}
    for name in before:
        (folder / name).unlink()
    assert cli.status(["sweep", "figures", str(folder)]) == NOTHING_SHOWN
    assert {name: (folder / name).read_bytes() for name in before} == before


def test_a_sweep_that_leaves_most_open_has_a_status_of_its_own(tmp_path, capsys):
    output = str(tmp_path / "short")
    assert cli.status([*BASIN[:-2], "--until", "0.1", "--output", output]) == NOTHING_SHOWN
    assert "100 % are undecided: raise --until" in capsys.readouterr().err
    assert cli.status(["sweep", "figures", output]) == NOTHING_SHOWN


def test_figures_of_an_unfinished_sweep_are_refused(tmp_path, capsys, monkeypatch):
    monkeypatch.setattr("compare.sweep.store.SMALL", 0)
    assert cli.status([*BASIN, "--output", str(tmp_path)]) == NOTHING_SHOWN
    shutil.rmtree(tmp_path / STORE / "result")
    capsys.readouterr()
    assert cli.status(["sweep", "figures", str(tmp_path)]) == 2
    assert "is not finished: --resume goes on with it" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("arguments", "name"),
    [
        (["basin", "pin", "--random", "30"], "basin"),
        (
            [
                "map",
                "pin",
                "--x",
                "offset=0:0.1:3",
                "--y",
                "mass=1:2:2",
                "--start",
                "x=0",
                "--start",
                "x=0.1",
            ],
            "map",
        ),
        (["map", "disc", "--x", "disc_speed=1.3:1.6:2", "--y", "friction_force=0.01:0.02:2"], "map"),
        (
            ["uncertainty", "pin", "--vary", "vx=uniform(0, 0.01)", "--samples", "256"],
            "uncertainty",
        ),
        (["continuation", "pin", "--x", "disc_speed=1.4:1.6:2", "--samples", "3"], "continuation"),
    ],
    ids=lambda value: value if isinstance(value, str) else " ".join(value[:2]),
)
def test_every_sweep_prints_and_draws_its_results(arguments, name, tmp_path, capsys):
    assert cli.status(["sweep", *arguments[:2], *SMALL, *arguments[2:], "--output", str(tmp_path)]) in (
        NOTHING_SHOWN,
        1,
    )
    out = capsys.readouterr().out
    assert "of them by the plain reference" in out
    for suffix in ("svg", "png"):
        assert (tmp_path / f"{name}.{suffix}").stat().st_size > 5000
    assert {group for group, _ in content(tmp_path / STORE)} >= {"round-0", "check", "result"}
