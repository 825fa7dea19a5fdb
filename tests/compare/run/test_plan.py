"""Motions of studies that do not depend on the answers."""

import json
from functools import lru_cache

import numpy as np
import pytest

from compare.claims.error_estimates import refined
from compare.claims.measured import Measured
from compare.claims.parameters import FIG5, FIG11
from compare.claims.prose import Prose
from compare.claims.study import Study
from compare.cli import app as cli
from compare.cli.trajectory_files import write_csv
from compare.engines import engines
from compare.run.plan import planned
from reference_model import PinOnDisc, simulate

pytestmark = pytest.mark.usefixtures("in_this_process")

STUDY = Study("planned", Prose("A study of all sorts"))
START = (0.1, 0.0, 0.03, 0.0)
MORE = {"unit": "m", "resolution": 1e-6}


@lru_cache
def radius(engine, tolerance):
    return float(np.hypot(*engine.simulate(FIG5, START, (0.0, 1.0), tolerance=tolerance).states[-1, :2]))


def measured(quantity):
    found = refined(quantity)
    exact = simulate(FIG5, START, (0.0, 1.0), tolerance=1e-12)
    return Measured(predicted=np.hypot(*exact.states[-1, :2]), value=found.value, error=found.largest)


@STUDY.claim("The radius is found", **MORE)
def fixed(engine):
    return measured(lambda tolerance: radius(engine, tolerance))


@STUDY.claim("The radius is found once more, from what is kept", **MORE)
def fixed_again(engine):
    return measured(lambda tolerance: radius(engine, tolerance))


@STUDY.claim("Where a motion ends another begins", **MORE)
def chained(engine):
    end = engine.simulate(FIG5, START, (0.0, 1.0)).states[-1]
    engine.simulate(FIG5, np.round(end, 6), (0.0, 1.0))  # errors of engines may be smaller than that
    return measured(lambda tolerance: radius(engine, tolerance))


@STUDY.claim("Stick is looked for in the states", **MORE)
def looked_closer(engine):
    assert engine.simulate(FIG5, START, (0.0, 15.0)).phases
    return measured(lambda tolerance: radius(engine, tolerance))


@STUDY.claim("A disc moves", **MORE)
def of_a_disc(engine):
    engine.simulate(FIG11, (*START, 0.0, 0.0), (0.0, 0.1))
    return measured(lambda tolerance: radius(engine, tolerance))


@pytest.mark.parametrize(("kinds", "claims"), [(("pin",), 2), (("pin", "ring"), 3)])
def test_only_claims_with_fixed_motions_of_the_engines_kinds_are_planned(kinds, claims):
    found = planned(STUDY, kinds)
    assert (found.claims, found.adaptive) == (claims, 2)
    questions = [json.loads(line) for line in found.motions]
    assert {question["system"]["kind"] for question in questions} == set(kinds)
    tolerances = [one["tolerance"] for one in questions if one["system"]["kind"] == "pin"]
    assert tolerances == [1e-9, 1.25e-10]


def test_answers_to_the_plan_of_the_command_line_are_judged(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    assert cli.status(["plan", "--jobs", "1"], (STUDY,)) == 0
    out = capsys.readouterr().out
    assert "planned: 2 motions for 2 claims, 2 claims left out" in out
    assert "report --engine files:plan" in out
    paths = [path for path in (tmp_path / "plan").glob("*.json") if path.name != "plan.json"]
    assert len(paths) == 2
    (engine,) = engines(["files:plan"])
    empty = STUDY.measure(engine)
    assert empty.claims == ()
    assert any(path.with_suffix(".csv").name in "".join(map(str, empty.gaps.values())) for path in paths)
    for path in paths:
        question = json.loads(path.read_text())
        assert question["system"].pop("kind") == "pin"
        pin = PinOnDisc(**question["system"])
        found = simulate(pin, question["state"], question["times"], tolerance=question["tolerance"])
        with open(path.with_suffix(".csv"), "w", encoding="utf-8") as stream:
            write_csv(found, "mine", stream)
    judged = STUDY.measure(engine)
    assert [claim.sentence for claim in judged.claims] == [
        "The radius is found",
        "The radius is found once more, from what is kept",
    ]
    assert {claim.verdict.name for claim in judged.claims} == {"AGREES"}
    assert "plan does not contain this motion" in judged.not_simulated


def test_an_empty_plan_is_rejected_and_a_study_of_our_engines_is_skipped(tmp_path, capsys):
    ours = Study("ours", Prose("A study of one engine"), only=("exudyn",))
    to_folder = ("--jobs", "1", "--output", str(tmp_path))
    assert cli.status(["plan", "--kind", "points", *to_folder], (STUDY,)) == 2
    sentence = "no motions to plan: they are of another --kind, or they depend on earlier answers"
    assert sentence in capsys.readouterr().err
    assert not (tmp_path / "plan.json").exists()
    assert cli.status(["plan", "ours", "planned", *to_folder], (ours, STUDY)) == 0
    assert "ours applies only to exudyn; skipped\n" in capsys.readouterr().err


def test_a_study_that_fails_is_reported_and_the_others_are_planned(tmp_path, capsys):
    broken = Study("broken", Prose("A study with a mistake"))
    broken.claim("It is measured", resolution=1.0)(_broken)
    assert cli.status(["plan", "--jobs", "1", "--output", str(tmp_path)], (broken, STUDY)) == 1
    said = capsys.readouterr()
    # Slow planning shows its progress first.
    assert said.err.splitlines()[-1].startswith("cannot plan broken: a mistake (test_plan.py:")
    assert said.out.startswith("planned: 2 motions for 2 claims, 2 claims left out")


def _broken(engine):
    raise ValueError("a mistake")
