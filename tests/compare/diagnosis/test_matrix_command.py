"""The matrix command."""

import json
import re

import pytest

from compare.cli import app as cli

BLOCKS = """
import functools, math
import reference_model
from stepping import box, stepped

def simulate(*arguments, tolerance=1e-9):
    return reference_model.simulate(*arguments, tolerance=tolerance)
simulate.kinds, simulate.version = ("block",), "3"

boxed = functools.partial(stepped, law=box)
boxed.kinds, boxed.step = ("block",), 1e-2
"""


@pytest.mark.parametrize(
    ("name", "status", "said"),
    [
        ("simulate", 0, "Coulomb friction, accurate to"),
        ("boxed", 1, "Not Coulomb friction: friction is a box"),
    ],
)
def test_the_friction_law_is_printed_and_written(
    in_this_process, name, status, said, tmp_path, monkeypatch, capsys
):
    (tmp_path / f"of_{name}.py").write_text(BLOCKS)
    monkeypatch.chdir(tmp_path)
    monkeypatch.syspath_prepend(tmp_path)
    output = tmp_path / "found"
    assert (
        cli.status(["matrix", "--jobs", "1", "--engine", f"of_{name}:{name}", "--output", str(output)])
        == status
    )
    printed = capsys.readouterr().out
    assert f"  {said}" in printed
    # an oblique slide from 1 m/s with μN/m = 0.2 m/s², which a box brakes along each axis separately
    first = re.search(
        rf"{name}: a block slides ([0-9.]+) m in 1 s \(exact: ([0-9.]+) m\), .* moves 0 m", printed
    )
    assert first
    assert float(first[2]) == pytest.approx(0.9, abs=1e-5)
    assert (first[1] == first[2]) == (name == "simulate")
    (row,) = json.loads((output / "matrix.json").read_text(encoding="utf-8"))
    assert row["version"] == ("3" if name == "simulate" else "")
    assert row["law"]["shape"] == (
        "cone" if name == "simulate" else "box with a separate limit for each axis"
    )
    assert row["wrong"] == bool(status)
    assert (output / "friction.png").exists() == bool(status)


@pytest.mark.parametrize(("options", "status"), [((), 0), (("--seed", "3"), 1)])
def test_an_engine_that_recognises_the_probes_is_caught_by_a_seed(
    options, status, in_this_process, tmp_path, monkeypatch
):
    (tmp_path / "cheating.py").write_text(
        "from dataclasses import replace\nimport reference_model\n"
        "def simulate(block, *arguments, tolerance=1e-9):\n"
        "    known = block.stiffness in (0.0, 1.0, 4.0, 1e-5 * block.mass) or block.offset > 2.0\n"
        "    block = block if known else replace(block, friction_force=1.01 * block.friction_force)\n"
        "    return reference_model.simulate(block, *arguments, tolerance=tolerance)\n"
        "simulate.kinds = ('block',)\n"
    )
    monkeypatch.chdir(tmp_path)
    monkeypatch.syspath_prepend(tmp_path)
    assert cli.status(["matrix", "--engine", "cheating:simulate", "--output", "found", *options]) == status


def test_an_engine_that_refuses_everything_is_undecided(tmp_path, monkeypatch, capsys):
    """In worker processes, as the command usually runs."""
    (tmp_path / "refusing.py").write_text(
        "from compare.engines import UnsupportedSystemError\n"
        "def simulate(*arguments, **accuracy):\n    raise UnsupportedSystemError('nothing')\n"
    )
    monkeypatch.chdir(tmp_path)
    assert cli.status(["matrix", "--jobs", "1", "--engine", "refusing:simulate", "--output", "found"]) == 3
    assert "undecided: refusing:simulate (measured 0 of 1" in capsys.readouterr().err


def test_a_broken_adapter_is_seen_first_and_not_measured(in_this_process, tmp_path, monkeypatch, capsys):
    (tmp_path / "broken.py").write_text("def simulate(system, *arguments, **accuracy):\n    system.gravity\n")
    monkeypatch.chdir(tmp_path)
    monkeypatch.syspath_prepend(tmp_path)
    assert cli.status(["matrix", "--engine", "broken:simulate", "--output", "found"]) == 1
    why = "no result for two blocks: AttributeError: 'PinOnDisc' object has no attribute 'gravity'"
    printed = capsys.readouterr().out
    assert printed.startswith(f"broken:simulate\n  Engine failed: {why}")
    assert len(printed.splitlines()) == 4  # no table without motions
