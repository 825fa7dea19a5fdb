"""``friction-discs report --claim ID`` measures only this claim."""

import json

import pytest
from fake_studies import GOOD

from compare.claims.measured import Measured
from compare.claims.prose import Prose
from compare.claims.study import Study
from compare.cli.app import status
from compare.engines import registry

STUDY = Study("declared", Prose("Claims that are declared"), quick=True)
ASKED = []


@STUDY.claim("One is one", unit="m", resolution=1.0)
def one(engine):
    ASKED.append("one")
    return Measured(predicted=1.0, value=1.0 + 1e-3, error=1e-2)


@STUDY.claim("It is {}", unit="m, rad", resolution=1.0, each={"Small one": 1e-9, "large": 1.0})
def of_size(engine, size):
    ASKED.append(size)
    return Measured(
        predicted=[size, 1.0], value=[size, 2.0], error=0.1, components=("x in m", "angle in rad")
    )


@pytest.fixture
def reporting(monkeypatch, tmp_path, in_this_process):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(registry, "_REGISTRY", {GOOD.name: GOOD})
    ASKED.clear()
    return lambda *arguments: status(["report", "--jobs", "1", *arguments], (STUDY,))


def test_one_claim_is_measured_and_its_numbers_printed(reporting, tmp_path, capsys):
    assert reporting("--claim", "declared/one") == 0
    assert ASKED == ["one"]
    assert "good agrees: predicted 1.0 m, measured 1.001 m, difference 0.0010, allowed 0.010 " in (
        capsys.readouterr().out
    )
    (study,) = json.loads((tmp_path / "report-part" / "results.json").read_text(encoding="utf-8"))["studies"]
    assert [claim["id"] for claim in study["claims"]] == ["declared/one"]
    assert not (tmp_path / "report").exists()  # the full report is not overwritten


def test_one_claim_of_a_family_is_measured_alone(reporting, tmp_path, capsys):
    arguments = ("--claim", "declared/of-size/small-one", "--engine", "good", "--output", "elsewhere")
    assert reporting(*arguments) == 1
    assert ASKED == [1e-9]
    printed = capsys.readouterr().out
    assert "good differs: predicted 1.0 rad, measured 2.0 rad" in printed
    assert "largest difference of 2: 0 m, 1.0 rad" in printed  # each unit separately
    assert (tmp_path / "elsewhere" / "arrays" / "declared" / "of-size" / "small-one.csv").exists()


def test_an_unknown_claim_gets_a_suggestion(reporting, capsys):
    assert reporting("--claim", "declared/ones") == 2
    assert "unknown claim 'declared/ones': did you mean 'declared/one'?" in capsys.readouterr().err
    assert ASKED == []
