"""Exit statuses where an engine has measured nothing, or less than it was asked for."""

import json
import re

import fake_studies
import pytest

from compare.claims.measured import Measured
from compare.claims.prose import Prose
from compare.claims.study import Study
from compare.cli import app as cli

ENGINES = """
import os, sys
from compare.engines import UnsupportedSystemError
def refusing(*arguments, **accuracy):
    raise UnsupportedSystemError('nothing')
def leaving(*arguments, **accuracy):
    sys.exit(0)
def dying(*arguments, **accuracy):
    os._exit(0)
"""


@pytest.fixture
def hostile(tmp_path, monkeypatch):
    """A folder with engines that do not answer, and one that ends the process that imports it."""
    (tmp_path / "hostile.py").write_text(ENGINES)
    (tmp_path / "exiting.py").write_text("import os\nos._exit(0)")
    monkeypatch.chdir(tmp_path)
    monkeypatch.syspath_prepend(tmp_path)
    return tmp_path


RAISING = [
    ("report fig03 --engine hostile:refusing", 4),
    ("report fig03 --engine reference --engine hostile:refusing", 4),
    ("report drivetrain-momentum --engine reference", 4),
    ("simulate pin --engine hostile:refusing", 1),
    ("simulate pin --engine hostile:leaving", 1),
]
ENDING = [
    ("report fig03 --jobs 1 --engine hostile:dying", 1),
    ("report fig03 --jobs 1 --engine exiting:simulate", 2),
    ("matrix --engine exiting:simulate", 2),
    ("simulate pin --engine hostile:dying", 1),
]
"""The engine ends the process in which it works."""


@pytest.mark.parametrize(("command", "status"), RAISING + ENDING)
def test_no_command_ends_with_status_0_where_an_engine_has_measured_nothing(
    command, status, hostile, request
):
    if (command, status) in RAISING:
        request.getfixturevalue("in_this_process")
    assert cli.status(command.split()) == status
    written = (hostile / "report-part" / "index.html").exists()
    assert written == (command.startswith("report") and status != 2)


@pytest.mark.usefixtures("in_this_process")
def test_the_theorys_own_algebra_is_not_conclusive(tmp_path, capsys):
    arguments = ["report", "fig03", "--engine", "reference", "--output", str(tmp_path)]
    assert cli.status([*arguments, "--min-conclusive", "1000"]) == 3
    out, err = capsys.readouterr()
    independent, algebra, implied = map(int, re.findall(r"(\d+) (?:agree|of algebra|implied)", out))
    assert err.splitlines()[-1] == f"{independent + implied} verdicts are conclusive: 1000 are asked for"
    assert algebra > 0


def itself(engine, value):
    return value and Measured(predicted=value, value=value, error=0.0)


@pytest.mark.usefixtures("in_this_process")
def test_a_claim_that_is_left_out_without_a_reason_has_a_status_of_its_own(tmp_path, capsys):
    study = Study("silent", Prose("A study with nothing to measure"))
    study.claim("{} is itself", resolution=1.0, each={"One": None, "Two": 2.0})(itself)
    arguments = ["report", "--output", str(tmp_path)]
    assert cli.status([*arguments, "--engine", "fake_studies:straight"], (study,)) == 4
    sentence = "silent fake_studies:straight: not measured, and no reason given: One is itself\n"
    assert capsys.readouterr().err.endswith(sentence)


@pytest.mark.usefixtures("in_this_process")
def test_a_part_of_the_report_does_not_replace_the_whole_one(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr("compare.engines.registry._REGISTRY", {"good": fake_studies.GOOD})
    studies = (fake_studies.AGREEMENT, fake_studies.PARTLY)

    def measured(folder):
        results = json.loads((tmp_path / folder / "results.json").read_text(encoding="utf-8"))
        return [study["name"] for study in results["studies"]]

    assert cli.status(["report"], studies) == 0
    for part in (["partly"], ["--level", "quick"], ["--engine", "good"]):
        assert cli.status(["report", *part], studies) == 0
        assert measured("report") == ["agreement", "partly"]
    assert measured("report-part") == ["agreement", "partly"]
    assert cli.status(["report", "partly", "--output", "report"], studies) == 0
    assert measured("report") == ["partly"]
