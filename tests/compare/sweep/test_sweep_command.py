"""Command line of sweeps."""

import re
from dataclasses import asdict

import pytest
from long_sweeps import content
from processes import ROOT

from compare.claims.parameters import FIG5
from compare.cli import app as cli
from compare.cli.command import NOTHING_SHOWN
from compare.cli.sweep.commands import MAPS, PLANES
from compare.cli.sweep.run import STORE
from compare.sweep.distributions import KINDS
from compare.sweep.files import Files
from reference_model.orbits.shock import Shock

SMALL = ["--until", "20"]  # leaves most undecided
BASIN = ["sweep", "basin", "pin", "--x", "x=0:0.2:3", "--y", "vx=0:0.1:2", *SMALL]


def test_help_lists_the_default_axes_and_all_distributions(capsys):
    for name, axes in (("basin", PLANES), ("map", MAPS)):
        cli.status(["sweep", name, "--help"])
        out = capsys.readouterr().out
        for system, (x, y) in axes.items():
            assert re.search(rf"{system} +--x {re.escape(x)} --y {re.escape(y)}\n", out)
        assert "[default: (12000; 1200 for a disc on points)]" in " ".join(out.split())
    cli.status(["sweep", "uncertainty", "--help"])
    out = capsys.readouterr().out
    for name, kind in KINDS.items():
        assert f" {name}({', '.join(kind.arguments)}" in out


def test_the_later_of_two_simultaneous_commands_is_rejected(tmp_path, monkeypatch, capsys):
    there = [set(), {"zarr.json"}]  # another process creates the store after the check
    monkeypatch.setattr(Files, "inside", lambda self, folder="": there.pop(0))
    assert cli.status([*BASIN, "--output", str(tmp_path)]) == 2
    place = str(tmp_path / STORE)
    sentence = f"another command has just started {place!r}; wait until it ends, or choose another --output\n"
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
    """Omit the last block, which needs a batch system."""
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
        ("", "already exists; use --resume to continue it, or choose another --output"),
        ("--seed 2 --resume", "contains a different sweep; choose another --output"),
        ("--chunk 5 --resume", "chunk = 5: "),
        ("--resume", "was computed by a different version of the code or libraries"),
    ],
)
def test_a_store_of_another_sweep_is_rejected_and_not_overwritten(more, words, finished, monkeypatch, capsys):
    folder, arguments = finished
    if words.endswith("libraries"):
        monkeypatch.setattr("compare.run.provenance.stamp", lambda: "other")
    before = files(folder)
    assert cli.status([*arguments, *more.split()]) == 2
    assert words in capsys.readouterr().err
    assert files(folder) == before


@pytest.fixture
def planned(monkeypatch):
    """Return a function that gives the plan of a command, which does not run."""
    plans = []
    monkeypatch.setattr("compare.cli.sweep.options.run_sweep", lambda plan, *others: plans.append(plan))
    return lambda *arguments: cli.status(["sweep", "basin", *arguments]) or plans[-1]


@pytest.mark.parametrize(
    ("arguments", "until"),
    [
        ("pin", 12000.0),
        ("disc --set contact_points=6", 1200.0),
        ("disc --set contact_points=6 --until 7", 7.0),
    ],
)
def test_the_default_duration_is_that_of_the_help(arguments, until, planned):
    assert planned(*arguments.split()).duration == until


def test_parameters_and_other_components_are_accepted(planned):
    plan = planned(*BASIN[2:], "--set", "damping=0.2", "--start", "y=0.05,vy=-0.1")
    assert asdict(plan.system) == asdict(FIG5) | {"damping": 0.2}
    states, _ = plan.trajectories(range(6))
    assert states.tolist() == [[x, 0.05, vx, -0.1] for vx in (0.0, 0.1) for x in (0.0, 0.1, 0.2)]


def test_a_finished_sweep_prints_and_draws_the_same_again(finished, capsys):
    folder, arguments = finished
    assert cli.status([*arguments, "--resume"]) == NOTHING_SHOWN
    out, err = capsys.readouterr()
    assert out.startswith("6 of 6 starts simulated\n")
    assert err == "83 % of the trajectories are undecided; use a larger --until\n"
    before = {name: (folder / name).read_bytes() for name in ("basin.svg", "basin.png")}
    for name in before:
        (folder / name).unlink()
    assert cli.status(["sweep", "figures", str(folder)]) == NOTHING_SHOWN
    assert capsys.readouterr().out == out
    assert {name: (folder / name).read_bytes() for name in before} == before


@pytest.mark.parametrize(
    "arguments",
    [
        "basin pin --random 30",
        "map disc --x disc_speed=1.3:1.6:2 --y friction_force=0.01:0.02:2 --start x=0 --start x=0.1",
        "uncertainty pin --vary vx=uniform(0,0.01) --samples 256",
        "continuation pin --x disc_speed=1.4:1.6:2 --samples 3",
    ],
)
def test_every_sweep_prints_and_draws_its_results(arguments, tmp_path, capsys):
    kind, *more = arguments.split()
    status = cli.status(["sweep", kind, *more, *SMALL, "--output", str(tmp_path)])
    assert status in (NOTHING_SHOWN, 1)
    assert "trajectories by the plain reference" in capsys.readouterr().out
    for suffix in ("svg", "png"):
        assert (tmp_path / f"{kind}.{suffix}").stat().st_size > 5000
    assert {group for group, _ in content(tmp_path / STORE)} >= {"round-0", "check", "result"}


@pytest.mark.parametrize(("bisected", "status"), [(0.1 + 2e-9, 0), (0.1 + 2e-7, 1)])
def test_the_smallest_shock_is_printed_with_its_check(bisected, status, monkeypatch, capsys):
    monkeypatch.setattr("reference_model.smallest_shock", lambda pin, tolerance: Shock(pin, 0.06, -0.08))
    monkeypatch.setattr("reference_model.orbits.shock.by_bisection", lambda shock: bisected)
    assert cli.status(["sweep", "shock", "--set", "mass=2"]) == status
    assert capsys.readouterr().out == (
        "smallest shock that leads to the whirl: 0.2 N s, a velocity change of 0.1 m/s, (0.06, -0.08) m/s\n"
        "  direction: -53.13° from the x-axis\n"
        f"  check by bisection: {bisected:.9g} m/s, relative difference {bisected / 0.1 - 1.0:.0e}\n"
    )
