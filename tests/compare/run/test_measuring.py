"""A claim that fails or would take too long costs no other claim of its study."""

import json
import math
import xml.etree.ElementTree as ET
from contextlib import suppress
from dataclasses import replace

import fake_studies
import pytest

from compare.claims.measured import Measured
from compare.claims.prose import Prose
from compare.claims.study import Findings, Study
from compare.cli.app import status
from compare.engines import DeclaredLackError, Engine, UnsupportedSystemError, registry
from compare.output.outside_text import Failure
from compare.run.levels import LIMITS, QUICK_STEPS
from compare.run.measuring import NO_CLAIM, Course, measured
from compare.run.runner import run
from compare.run.store import Drawing
from compare.run.workers import Done

STUDY = Study("partly-long", Prose("One short claim, one long, one impossible"), quick=True)


@STUDY.claim("One is one", resolution=1.0)
def short(engine):
    return Measured(predicted=1.0, value=1.0, error=0.0, data={"short": [1.0]})


@STUDY.claim("A long motion ends", equation="(7)", resolution=1.0, duration=1e9)
def long(engine):
    return Measured(predicted=2.0, value=2.0, error=0.0)


@STUDY.claim("A heavy body moves", resolution=1.0)
def heavy(engine):
    raise RuntimeError(f"{engine.name} is too weak")


def stepping(*arguments, step):
    return fake_studies.straight(*arguments)


STEPPING = Engine("stepping", stepping, step=1e-3)
LONG, HEAVY = "A long motion ends", "A heavy body moves"


TOO_LONG = "needs more than the 850,000 steps that a study of the quick level allows; use --level full"


def test_a_claim_that_raises_or_needs_too_many_steps_is_a_gap():
    found = measured(STUDY, STEPPING, within=QUICK_STEPS)
    assert [claim.sentence for claim in found.claims] == ["One is one"]
    assert found.gaps[LONG] == TOO_LONG
    assert str(found.gaps[HEAVY]).startswith("stepping is too weak (test_measuring.py:")


@pytest.mark.parametrize("error", [DeclaredLackError, UnsupportedSystemError])
def test_only_a_refusal_beyond_the_declaration_is_a_gap(error):
    study = Study("refused", Prose("A claim that an engine refuses"))

    @study.claim("Nothing moves", resolution=1.0)
    def refused(engine):
        raise error("no offset")

    found = study.measure(STEPPING)
    assert found.not_simulated == ("no offset" if error is DeclaredLackError else "")
    assert found.gaps == ({} if error is DeclaredLackError else {"Nothing moves": "no offset"})


def test_without_a_limit_or_a_fixed_step_every_claim_is_attempted():
    assert measured(STUDY, STEPPING).gaps.keys() == {HEAVY}
    assert measured(STUDY, fake_studies.GOOD, within=QUICK_STEPS).gaps.keys() == {HEAVY}


def test_the_claims_of_the_quick_level_depend_on_steps_and_not_on_a_measured_time():
    """The steps of all claims of a study count, in their order."""
    study = Study("halves", Prose("Two claims of half a million steps"))

    @study.claim("The first half", resolution=1.0, duration=500.0)
    def first(engine):
        return Measured(predicted=1.0, value=1.0, error=0.0)

    @study.claim("The second half", resolution=1.0, duration=500.0)
    def second(engine):
        return Measured(predicted=1.0, value=1.0, error=0.0)

    found = measured(study, STEPPING, within=QUICK_STEPS)
    assert ([claim.sentence for claim in found.claims], found.gaps) == (
        ["The first half"], {"The second half": TOO_LONG},
    )  # fmt: skip
    assert measured(study, STEPPING, within=QUICK_STEPS, moved=500.0).claims == ()


@pytest.mark.parametrize(("quick", "within"), [(False, math.inf), (True, QUICK_STEPS)])
def test_a_process_starts_again_after_a_failure_and_only_the_quick_level_omits_claims(quick, within):
    course = Course(STUDY, "stepping", 10.0, quick)

    def work(result):
        steps, asked, found = course.claim("short"), [], None
        with suppress(StopIteration):
            while True:
                (_, _, (part,), _, left, _), _ = steps.send(found)
                asked, found = [*asked, (part, left)], Done(part, result, 0.0)
        return asked

    started = [(NO_CLAIM, math.inf), ("short", within)]
    assert list(map(work, (Failure("ended"), Findings(), Findings()))) == [started, started, started[1:]]


@pytest.fixture
def reporting(monkeypatch, tmp_path, in_this_process):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(registry, "_REGISTRY", {STEPPING.name: STEPPING, "good": fake_studies.GOOD})
    monkeypatch.setattr("compare.run.runner.is_registered", lambda name: name == "good")

    def report(*arguments, study=STUDY):
        ended = status(["report", "--jobs", "1", "--output", "out", *arguments], (study,))
        results = json.loads((tmp_path / "out" / "results.json").read_text(encoding="utf-8"))
        return ended, results, ET.parse(tmp_path / "out" / "junit.xml").findall(".//testcase")

    return report


def test_a_failed_claim_is_shown_alone(reporting, capsys):
    ended, results, cases = reporting("--engine", "stepping")
    assert ended == 1
    out = capsys.readouterr().out
    assert "partly-long stepping failed: stepping is too weak (test_measuring.py:" in out
    assert "2 checks against independent evidence agree, 0 differ, 0 inconclusive, 1 failed (" in out
    assert [claim["verdict"] for claim in results["studies"][0]["claims"]] == ["agrees", "agrees"]
    unit = results["studies"][0]["units"]["stepping"]
    assert (unit["state"], unit["reason"]) == ("failed", "stepping is too weak")  # a baseline may contain it
    (case,) = (one for one in cases if one.find("error") is not None)
    assert case.get("name") == HEAVY
    assert "test_measuring.py:" in case.find("error").text
    assert reporting("--engine", "stepping", "--resume")[0] == 1  # it is attempted again


def test_a_claim_that_is_not_attempted_at_the_quick_level_counts_as_not_measured(reporting, tmp_path, capsys):
    light = replace(STUDY, declared=[one for one in STUDY.declared if one.sentence != HEAVY])
    ended, results, cases = reporting("--level", "quick", "--engine", "stepping", study=light)
    assert ended == 0
    out = capsys.readouterr().out
    assert f"partly-long stepping not simulated: {TOO_LONG}" in " ".join(out.split())
    assert f"1 not simulated ({'out'}" in out
    assert "stepping: measured 1 of 2 claims (50 %)" in out
    assert [claim["id"] for claim in results["studies"][0]["claims"]] == ["partly-long/short"]
    assert results["studies"][0]["units"]["stepping"]["reason"] == TOO_LONG
    assert [case.get("name") for case in cases if case.find("skipped") is not None] == [LONG]
    page = (tmp_path / "out" / "index.html").read_text(encoding="utf-8")
    assert 'id="partly-long/long"' in page
    line = short.__code__.co_firstlineno
    assert f"test_measuring.py:{line}</code>" in page
    assert LIMITS["quick"] < 1e9
    # the full level attempts the claim even with --resume
    ended, results, _ = reporting("--resume", "--engine", "stepping", study=light)
    assert len(results["studies"][0]["claims"]) == 2


def lacking(engine):
    raise DeclaredLackError("no heavy bodies")


@pytest.mark.parametrize("second", [heavy, lacking])
@pytest.mark.parametrize("needed", ["short", "heavy"])
def test_curves_of_an_engine_with_gaps_are_drawn_unless_the_figure_needs_a_missing_claim(
    needed, second, tmp_path, in_this_process
):
    drawn_for = []
    declared = [replace(one, function=second) if one.function is heavy else one for one in STUDY.declared]

    def draw(data):
        drawn_for.append([name for name, arrays in data.items() if arrays[needed].size])
        return {}

    study = replace(
        STUDY,
        declared=declared,
        provided={"figures": draw, "curves": lambda: {"short": [2.0], "heavy": [3.0]}},
    )
    result = run((study,), (STEPPING,), folder=tmp_path, quick=second is heavy)
    missing = {LONG, HEAVY} if second is heavy else set()
    assert result.outcomes[STUDY.name, "stepping"].gaps.keys() == missing
    assert isinstance(result.drawings[STUDY.name], Drawing)
    assert drawn_for[-1] == (["theory", "stepping"] if needed == "short" else ["theory"])
