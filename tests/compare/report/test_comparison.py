"""Differences of two reports, and the exit status of ``friction-discs diff``."""

import json
from dataclasses import replace

import numpy as np
import pytest
from fake_studies import AGREEMENT, FAILING, GOOD, VERDICTS, claim, fake, measure_verdicts

from compare.claims.study import Findings
from compare.cli.app import status
from compare.report.comparison import without_verdict
from compare.report.write import write_report
from compare.run.runner import run

pytestmark = pytest.mark.usefixtures("all_in_this_process")


def written(folder, measure=measure_verdicts, studies=(), engine=GOOD):
    study = fake(VERDICTS.name, VERDICTS.title, "Any.", measure)
    write_report(run((study, *studies), (engine,), folder=folder / "data"), folder)
    return folder


def with_first(changed):
    """Measure as before, except for the number of the first claim."""

    def measure(engine):
        first, *others = measure_verdicts(engine).claims
        return Findings((replace_measured(first, changed), *others))

    return measure


def replace_measured(one, measured):
    return claim(
        one.sentence, one.engine, one.predicted, measured, one.budget.numerical, equation=one.equation
    )


@pytest.fixture(scope="module")
def old(tmp_path_factory, all_in_this_process):
    return written(tmp_path_factory.mktemp("old"))


def told(capsys, *arguments):
    capsys.readouterr()
    return status(["diff", *map(str, arguments)], None), capsys.readouterr().out.splitlines()


def test_a_report_does_not_differ_from_itself(old, capsys):
    assert told(capsys, old, old) == (0, ["0 worse, 0 moved, 0 gone, 0 new, 0 better"])


def test_a_change_within_both_error_bars_does_not_count(old, tmp_path, capsys):
    new = written(tmp_path, with_first(0.08 + 3e-11 - 1.29e-10))
    assert told(capsys, old, new / "results.json")[0] == 0


def test_a_change_beyond_both_error_bars_counts_even_if_both_agree(old, tmp_path, capsys):
    verdicts = measure_verdicts(GOOD).claims
    semicircle = verdicts[1].measured.copy()
    semicircle[4] -= 5e-10  # each report allows 2e-10
    wide = replace_measured(verdicts[1], semicircle)
    new = written(tmp_path, lambda engine: Findings((verdicts[0], wide_as_it(wide), *verdicts[2:])))
    found, lines = told(capsys, old, new)
    assert found == 1
    assert lines[0].startswith(
        "moved: verdicts/equilibria-of-all-loads-lie-on-the-semicircle good: measured "
    )
    assert "by 5.0×10⁻¹⁰ m, allowed 4.4×10⁻¹⁰" in lines[0]
    assert lines[-1] == "0 worse, 1 moved, 0 gone, 0 new, 0 better"


def wide_as_it(one):
    """Return a claim whose difference is slightly within its error."""
    predicted = one.predicted.copy()
    predicted[4] = one.measured[4]
    return claim(one.sentence, one.engine, predicted, one.measured, 2.4e-10, equation=one.equation)


def test_a_missing_number_counts_as_a_change(old, tmp_path, capsys):
    new = written(tmp_path, with_first(np.nan))
    found, lines = told(capsys, old, new)
    assert (found, lines[0].partition(":")[0]) == (1, "worse")


def test_verdicts_get_worse_and_better(old, tmp_path, capsys):
    new = written(tmp_path, with_first(0.09))
    found, lines = told(capsys, old, new)
    assert found == 1
    assert lines[0].startswith(
        "worse: verdicts/the-pin-comes-to-rest-at-the-point-of-eq-3 good: agrees before, "
    )
    found, lines = told(capsys, new, old)
    assert (found, lines[-1]) == (0, "0 worse, 0 moved, 0 gone, 0 new, 1 better")


def test_missing_claims_count_and_new_ones_do_not(old, tmp_path, capsys):
    new = written(tmp_path, lambda engine: Findings(measure_verdicts(engine).claims[1:]), (AGREEMENT,))
    found, lines = told(capsys, old, new)
    assert (found, lines[-1]) == (1, "0 worse, 0 moved, 1 gone, 2 new, 0 better")
    assert "gone: verdicts/the-pin-comes-to-rest-at-the-point-of-eq-3 good: " in lines[0]
    found, lines = told(capsys, new, old)
    assert lines[0] == "gone: agreement good: missing in the new report"


def test_a_failed_study_is_reported_once(old, tmp_path, capsys):
    new = written(tmp_path, engine=replace(FAILING, name="good"))
    found, lines = told(capsys, old, new)
    assert found == 1
    assert [line.partition(": the")[0] for line in lines[:-1]] == [
        "worse: verdicts good: finished before, failed now",
    ]


def test_reports_without_verdicts_of_an_engine_do_not_pass(old, tmp_path, capsys):
    failed = written(tmp_path, engine=FAILING)
    assert told(capsys, failed, failed)[0] == 4
    assert told(capsys, failed, old)[0] == 1


def test_a_study_may_have_no_claims_about_its_theory():
    unit = {"state": "finished"}
    study = {"name": "fig04", "units": {"theory": unit, "good": unit}, "claims": [{"engine": "good"}]}
    assert without_verdict({"studies": [study]}) == ()
    assert without_verdict({"studies": [study | {"claims": []}]}) == ("good",)


def test_known_failures_do_not_count(old, tmp_path, capsys):
    new, known = written(tmp_path, with_first(0.09)), tmp_path / "known.json"
    assert told(capsys, old, new, "--write-baseline", known)[0] == 1
    listed = json.loads(known.read_text(encoding="utf-8"))["known"]
    assert [one["claim"].partition("/")[2][:11] for one in listed] == ["the-equilib", "the-pin-com"]
    found, lines = told(capsys, old, new, "--baseline", known)
    assert (found, lines[0].partition(":")[0]) == (0, "worse (known)")
    _, lines = told(capsys, new, old, "--baseline", known)
    assert lines[1].startswith("no longer fails: verdicts/the-pin-comes-to-rest")


@pytest.mark.parametrize(
    ("content", "sentence"),
    [
        (None, "cannot read"),
        ("{}", "is not a baseline"),
        ("[", "is not a baseline"),
        ('{"format": 1, "version": 1}', "is no"),
    ],
)
def test_an_invalid_baseline_is_rejected(old, tmp_path, capsys, content, sentence):
    known = tmp_path / "known.json"
    if content is not None:
        known.write_text(content, encoding="utf-8")
    assert status(["diff", str(old), str(old), "--baseline", str(known)], None) == 2
    assert sentence in capsys.readouterr().err


def test_claims_with_different_numbers_of_elements_cannot_be_compared(old, tmp_path, capsys):
    def shorter(engine):
        first, second, *others = measure_verdicts(engine).claims
        short = claim(second.sentence, engine.name, second.predicted[:5], second.measured[:5], 2e-10)
        return Findings((first, short, *others))

    found, lines = told(capsys, old, written(tmp_path, shorter))
    assert (found, lines[0].endswith("so they cannot be compared")) == (1, True)
