"""Exit statuses if an engine measured nothing, or less than requested."""

import json
from dataclasses import replace

import fake_studies
import pytest

from compare.claims.measured import Measured
from compare.claims.prose import Prose
from compare.claims.study import Findings, Study
from compare.cli import app as cli

ENGINES = """
import sys
from compare.engines import UnsupportedSystemError
def refusing(*arguments, **accuracy):
    raise UnsupportedSystemError('nothing')
def leaving(*arguments, **accuracy):
    sys.exit(0)
"""


@pytest.fixture
def hostile(tmp_path, monkeypatch):
    (tmp_path / "hostile.py").write_text(ENGINES)
    (tmp_path / "exiting.py").write_text("import os\nos._exit(0)")
    monkeypatch.chdir(tmp_path)
    monkeypatch.syspath_prepend(tmp_path)
    return tmp_path


STUDIES = (fake_studies.ASKING, replace(fake_studies.AGREEMENT, name="of-another", only=("exudyn",)))
ENDING = ("report asking --jobs 1 --engine exiting:simulate", 2)
"""Ends its own process."""


@pytest.mark.parametrize(
    ("command", "status"),
    [
        ("report asking --engine hostile:refusing", 4),
        ("report asking --engine reference --engine hostile:refusing", 4),
        ("report of-another --engine reference", 4),
        ("simulate pin --engine hostile:refusing", 1),
        ("simulate pin --engine hostile:leaving", 1),
        ENDING,
    ],
)
def test_status_is_not_0_if_an_engine_measured_nothing(command, status, hostile, request):
    if (command, status) != ENDING:
        request.getfixturevalue("in_this_process")
    assert cli.status(command.split(), STUDIES) == status
    written = (hostile / "report-part" / "index.html").exists()
    assert written == (command.startswith("report") and status != 2)


def measure_with_another(engine):
    independent = fake_studies.measure_agreement(engine).claims
    implied = fake_studies.claim("It follows", engine.name, 0.5, 0.5, 0.0, implied_by=independent[0].sentence)
    return Findings((*independent, implied))


@pytest.mark.usefixtures("in_this_process")
@pytest.mark.parametrize(("least", "status"), [("2", 0), ("3", 3)])
def test_the_theorys_own_algebra_is_not_conclusive(least, status, tmp_path, capsys):
    theory = {"theory": fake_studies.theory_of_verdicts}
    study = fake_studies.fake("both", "Both", "Half.", measure_with_another, provided=theory)
    arguments = ["report", "--engine", "fake_studies:straight", "--output", str(tmp_path)]
    assert cli.status([*arguments, "--min-conclusive", least], (study,)) == status
    out, err = capsys.readouterr()
    assert out.startswith("1 check against independent evidence and 2 others agree, ")
    assert err == ("2 claims agree, but --min-conclusive requires 3\n" if status else "")


def itself(engine, value):
    return value and Measured(predicted=value, value=value, error=0.0)


@pytest.mark.usefixtures("in_this_process")
def test_a_claim_omitted_without_a_reason_has_its_own_status(tmp_path, capsys):
    study = Study("silent", Prose("A study with nothing to measure"))
    study.claim("{} is itself", resolution=1.0, each={"One": None, "Two": 2.0})(itself)
    arguments = ["report", "--output", str(tmp_path)]
    assert cli.status([*arguments, "--engine", "fake_studies:straight"], (study,)) == 4
    sentence = "silent fake_studies:straight: claims not measured, without a reason: One is itself\n"
    assert capsys.readouterr().err.endswith(sentence)


@pytest.mark.usefixtures("in_this_process")
def test_a_partial_report_does_not_replace_the_full_one(tmp_path, monkeypatch, capsys):
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
    capsys.readouterr()
    for part in (["partly"], ["--level", "quick"], ["--engine", "fake_studies:straight"]):
        assert cli.status(["report", *part, "--output", str(tmp_path / "report")], studies) == 2
        assert capsys.readouterr().err == (
            f"{tmp_path / 'report'} contains a full report; choose another --output, or replace the report with "
            "--replace\n"
        )
        assert measured("report") == ["agreement", "partly"]
    assert (
        cli.status(["report", "--engine", "good", "--output", "report"], studies) == 0
    )  # measures it all again
    assert cli.status(["report", "partly", "--output", "report", "--replace"], studies) == 0
    assert measured("report") == ["partly"]
    assert cli.status(["report", "agreement", "--output", "report"], studies) == 0  # it was partial
