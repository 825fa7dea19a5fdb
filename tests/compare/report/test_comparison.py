"""Differences of two reports, and the exit status of ``friction-discs diff``."""

import copy
import functools
import json
import lzma
import operator
import os
import shutil
from dataclasses import replace

import jsonschema
import numpy as np
import pytest
from fake_studies import AGREEMENT, FAILING, GOOD, VERDICTS, claim, fake, measure_verdicts

from compare.claims.study import Findings
from compare.cli.app import status
from compare.report import results_json
from compare.report.comparison import without_verdict
from compare.report.write import write_report
from compare.run.runner import run

pytestmark = pytest.mark.usefixtures("all_in_this_process")


def written(folder, measure=measure_verdicts, studies=(), engine=GOOD):
    study = fake(VERDICTS.name, VERDICTS.title, "Any.", measure)
    write_report(run((study, *studies), (engine,), folder=folder / "data"), folder)
    return folder


def told(capsys, *arguments):
    capsys.readouterr()
    return status(["diff", *map(str, arguments)], None), capsys.readouterr().out.splitlines()


@pytest.fixture(scope="module")
def old(tmp_path_factory, all_in_this_process):
    return written(tmp_path_factory.mktemp("old"))


FIRST, SECOND, *OTHERS = measure_verdicts(GOOD).claims


def changed(one, measured, **more):
    values = {"predicted": one.predicted, "numerical": one.budget.numerical, "equation": one.equation} | more
    return claim(one.sentence, one.engine, measured=measured, **values)


def with_claims(*claims):
    return {"measure": lambda engine: Findings(claims)}


def with_first(measured):
    return with_claims(changed(FIRST, measured), SECOND, *OTHERS)


def with_second_beyond_its_error_bar():
    """Move one element by more than both reports allow, although the claim still agrees."""
    measured, predicted = SECOND.measured.copy(), SECOND.predicted.copy()
    measured[4] -= 5e-10  # each report allows 2e-10
    predicted[4] = measured[4]
    return with_claims(FIRST, changed(SECOND, measured, predicted=predicted, numerical=2.4e-10), *OTHERS)


def with_shorter_second():
    shorter = changed(SECOND, SECOND.measured[:5], predicted=SECOND.predicted[:5], numerical=2e-10)
    return with_claims(FIRST, shorter, *OTHERS)


REST = "verdicts/the-pin-comes-to-rest-at-the-point-of-eq-3 good"
CIRCLE = "verdicts/equilibria-of-all-loads-lie-on-the-semicircle good"
NEW = claim("A new claim", "good", 0.0, 1.0, 0.0, resolution=0.1)
CHANGES = {
    "nothing": ({}, "", ""),
    "within both error bars": (with_first(0.08 + 3e-11 - 1.29e-10), "", ""),
    "beyond both error bars": (
        with_second_beyond_its_error_bar(),
        f"moved: {CIRCLE}: measured … by 5.0×10⁻¹⁰ m, allowed 4.4×10⁻¹⁰",
        "1 moved",
    ),
    "a missing number": (with_first(np.nan), f"worse: {REST}: ", "1 worse"),
    "a verdict": (with_first(0.09), f"worse: {REST}: agrees before, ", "1 worse"),
    "other claims": (
        with_claims(SECOND, *OTHERS) | {"studies": (AGREEMENT,)}, f"gone: {REST}: ", "1 gone, 2 new",
    ),
    "a new claim that differs": (
        with_claims(FIRST, SECOND, *OTHERS, NEW), "worse: verdicts/a-new-claim good: new, differs", "1 worse",
    ),
    "a study that failed": (
        {"engine": replace(FAILING, name="good")},
        "worse: verdicts good: finished before, failed now: the step",
        "1 worse",
    ),
    "other numbers": (with_shorter_second(), "moved: … so they cannot be compared", "1 moved"),
}  # fmt: skip


@pytest.mark.parametrize(("new", "first", "totals"), CHANGES.values(), ids=CHANGES)
def test_a_change_beyond_the_error_bars_is_listed_and_counts(new, first, totals, old, tmp_path, capsys):
    found, lines = told(capsys, old, written(tmp_path, **new))
    begin, _, middle = first.partition("…")
    assert lines[0].startswith(begin)
    assert middle in lines[0]
    assert ", ".join(part for part in lines[-1].split(", ") if part[0] != "0") == totals
    assert found == bool(totals)


def test_better_verdicts_pass_but_a_missing_study_does_not(old, tmp_path, capsys):
    worse = written(tmp_path / "worse", **with_first(0.09))
    found, lines = told(capsys, worse, old / "results.json")
    assert (found, lines[-1]) == (0, "0 worse, 0 moved, 0 gone, 0 new, 1 better")
    more = written(tmp_path / "more", studies=(AGREEMENT,))
    found, lines = told(capsys, more, old)
    assert (found, lines[0]) == (1, "gone: agreement good: missing in the new report")


def test_reports_without_verdicts_of_an_engine_do_not_pass(old, tmp_path, capsys):
    failed = written(tmp_path, engine=FAILING)
    assert told(capsys, failed, failed)[0] == 3
    assert told(capsys, failed, old)[0] == 1


def test_a_study_may_have_no_claims_about_its_theory():
    unit = {"state": "finished"}
    study = {"name": "fig04", "units": {"theory": unit, "good": unit}, "claims": [{"engine": "good"}]}
    assert without_verdict({"studies": [study]}) == ()
    assert without_verdict({"studies": [study | {"claims": []}]}) == ("good",)


def test_known_failures_do_not_count(old, tmp_path, capsys):
    new, known = written(tmp_path, **with_first(0.09)), tmp_path / "known.json"
    assert told(capsys, old, new, "--write-baseline", known)[0] == 1
    listed = json.loads(known.read_text(encoding="utf-8"))["known"]
    assert [one["claim"].partition("/")[2][:11] for one in listed] == ["the-equilib", "the-pin-com"]
    found, lines = told(capsys, old, new, "--baseline", known)
    assert (found, lines[0].partition(":")[0]) == (0, "worse (known)")
    _, lines = told(capsys, new, old, "--baseline", known)
    assert lines[1].startswith("no longer fails: verdicts/the-pin-comes-to-rest")


INVALID = [
    (None, "cannot read"),
    ("[", "is not a baseline"),
    ('{"format": "friction-discs baseline", "version": 2, "known": []}', "is not a baseline"),
]


@pytest.mark.parametrize(("content", "sentence"), INVALID)
def test_an_invalid_baseline_is_rejected(old, tmp_path, capsys, content, sentence):
    known = tmp_path / "known.json"
    if content is not None:
        known.write_text(content, encoding="utf-8")
    assert status(["diff", str(old), str(old), "--baseline", str(known)], None) == 2
    assert sentence in capsys.readouterr().err


def places(content, path=()):
    """Yield the path of every value in JSON."""
    for key, value in content.items() if isinstance(content, dict) else enumerate(content):
        yield (*path, key)
        if isinstance(value, dict | list):
            yield from places(value, (*path, key))


def test_every_damaged_value_of_a_report_is_detected(old, tmp_path, capsys):
    file = tmp_path / "results.json"
    shutil.copytree(old / "arrays", tmp_path / "arrays")
    whole = json.loads((old / "results.json").read_text())
    valid = jsonschema.Draft202012Validator(results_json.schema()).is_valid
    for *way, last in places(whole):
        for damage in ("missing", None, {}, -1.5, True):
            content = copy.deepcopy(whole)
            parent = functools.reduce(operator.getitem, way, content)
            parent[last] = damage
            if damage == "missing":
                del parent[last]
            file.write_text(json.dumps(content))
            code, _ = told(capsys, file, old)
            assert code == 2 or valid(content), (way, last, damage)
    file.write_text(json.dumps(whole).replace('"agrees"', '"perhaps"'))
    assert status(["diff", str(file), str(old)]) == 2
    assert capsys.readouterr().err.startswith(f"{str(file)!r} is not a valid report: totals ")


TABLES = {
    "missing column": lambda text: text.replace("numerical_error", "error"),
    "no number": lambda text: text.replace("0.", "zero."),
    "cut": lambda text: text[:-30],
    "empty": lambda text: "",
    "pipe": None,
}


@pytest.mark.parametrize("damage", TABLES)
def test_a_damaged_table_is_named(damage, old, tmp_path, capsys):
    new = shutil.copytree(old, tmp_path / "new")
    table = next(path for path in sorted((new / "arrays").rglob("*.csv")) if "0." in path.read_text())
    text = table.read_text()
    table.unlink()
    if TABLES[damage] is None:
        os.mkfifo(table)
    else:
        table.write_text(TABLES[damage](text))
    assert status(["diff", str(old), str(new)]) == 2
    err = capsys.readouterr().err
    assert repr(str(table)) in err
    assert err.count("\n") == 1


def test_a_table_is_not_unpacked_without_a_bound(tmp_path, monkeypatch):
    monkeypatch.setattr(results_json, "LARGEST", 1000)
    table = tmp_path / "table.csv.xz"
    table.write_bytes(lzma.compress(b"engine,measurement\n" + 10_000 * b"a,1\n"))
    assert sum(map(len, results_json._read(table).values())) < 1000
