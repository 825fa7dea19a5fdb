"""Files of a report for programs: results with a published schema, and tables in full precision."""

import json
import xml.etree.ElementTree as ET
from dataclasses import asdict

import jsonschema
import numpy as np
import pytest
from fake_studies import AGREEMENT, GOOD, claim, fake, measure_verdicts

from compare.claims.as_json import claim_from_json
from compare.claims.study import Findings
from compare.claims.validation import Validation
from compare.report import results_json as arrays
from compare.report.results_json import read_results, schema
from compare.report.write import write_report
from compare.run.runner import run

pytestmark = pytest.mark.usefixtures("in_this_process")

CHECKED = jsonschema.Draft202012Validator(schema())


@pytest.fixture
def results(reported):
    return json.loads((reported[1] / "results.json").read_text(encoding="utf-8"))


def test_results_match_the_published_schema(results):
    jsonschema.Draft202012Validator.check_schema(schema())
    CHECKED.validate(results)


@pytest.mark.parametrize(
    "wrong",
    [
        lambda it: it.pop("version"),
        lambda it: it["studies"][0]["claims"][0].update(verdict="agreed"),
        lambda it: it["studies"][0]["claims"][0]["decided_by"].pop("unit"),
        lambda it: it["stamp"].pop("commit"),
    ],
)
def test_the_schema_rejects_other_files(results, wrong):
    wrong(results)
    assert not CHECKED.is_valid(results)


def test_results_list_studies_engines_and_versions(results):
    assert results["engine_versions"] == {"good": "", "failing": ""}
    assert all(results["stamp"][name] for name in ("commit", "processor", "exudyn"))
    assert "inf" not in results["stamp"].values()


def mixed(engine):
    """A claim with numbers in two units, one of them missing, that an engine makes twice."""
    parts = {"unit": "m, rad", "axes": (("a", "b"), ("x in m", "angle in rad")), "size": [1.0, np.inf]}
    values = np.array([[0.1, np.nan], [0.3, 1.0 / 3.0]])
    return Findings(
        tuple(claim("Both", engine.name, values, values + off, 0.5, **parts) for off in (0.0, 0.1))
    )


@pytest.mark.parametrize("large", [0, 10**9], ids=["compressed", "plain"])
def test_a_table_contains_unit_and_place_of_each_number(tmp_path, monkeypatch, large):
    monkeypatch.setattr(arrays, "LARGE", large)
    study = fake("mixed", "Mixed", "Any.", mixed)
    write_report(run((study,), (GOOD,), folder=tmp_path / "data"), tmp_path)
    first, second = read_results(tmp_path / "results.json")["studies"][0]["claims"]
    assert (first["measurement"], second["measurement"]) == (1, 2)
    assert first["arrays"] == second["arrays"] == "arrays/mixed/both.csv" + (".xz" if large == 0 else "")
    np.testing.assert_array_equal(claim_from_json(second).measured, [[0.2, np.nan], [0.4, 1.0 / 3.0 + 0.1]])
    assert first["size"][0][0] == 1.0
    if large:
        table = (tmp_path / first["arrays"]).read_text(encoding="utf-8").splitlines()
        assert table[4] == f'good,1,3,"b, angle in rad",rad,{1 / 3!r},{1 / 3!r},0.5,inf'


FITS = Validation("heading of a push", "degrees", 5.0, 0.5, 2.0, 0.1, 0.01, 0.5, 1.5, 2.5, 40)


def one_validation():
    return (FITS,)


def test_a_validation_is_on_the_page_and_in_the_results_but_never_counted(tmp_path):
    study = fake("agreement", "Agreement", "Any.", measure_verdicts)
    plain, validated = tmp_path / "plain", tmp_path / "validated"
    write_report(run((study,), (GOOD,), folder=tmp_path / "data"), plain)
    study.provides(validations=one_validation)
    write_report(run((study,), (GOOD,), folder=tmp_path / "data"), validated)
    without, with_it = (
        json.loads((one / "results.json").read_text(encoding="utf-8")) for one in (plain, validated)
    )
    CHECKED.validate(with_it)
    assert (without["validations"], with_it["validations"]) == ([], [{"study": "agreement"} | asdict(FITS)])
    assert (with_it["totals"], with_it["evidence"]) == (without["totals"], without["evidence"])
    page = (validated / "index.html").read_text(encoding="utf-8")
    assert "Heading of a push" in page
    assert "5.0 ± 0.5 degrees" in page.replace("\N{NO-BREAK SPACE}", " ")
    assert "50\N{NO-BREAK SPACE}% of 40" in page
    assert 'id="validation"' not in (plain / "index.html").read_text(encoding="utf-8")


def test_a_badge_counts_agreement_and_is_red_for_differences(reported, tmp_path):
    badge = ET.fromstring((reported[1] / "badge.svg").read_text(encoding="utf-8"))
    assert badge.get("aria-label") == "friction-discs: 5 of 11 agree"
    colours = [one.get("fill") for one in badge.iter() if one.tag.endswith("path")]
    assert colours == ["#9c1c1c"]
    write_report(run((AGREEMENT,), (GOOD,), folder=tmp_path / "data"), tmp_path)
    assert "#1d5c38" in (tmp_path / "badge.svg").read_text(encoding="utf-8")


def test_a_report_of_another_version_is_rejected(tmp_path):
    content = '{"format": "friction-discs results", "version": 7}'
    (tmp_path / "results.json").write_text(content, encoding="utf-8")
    with pytest.raises(ValueError, match="has version 7, but this program reads version 1"):
        read_results(tmp_path)


def test_a_table_of_another_report_is_rejected(reported, tmp_path):
    (tmp_path / "results.json").write_bytes((reported[1] / "results.json").read_bytes())
    with pytest.raises(ValueError, match=r"cannot read .*, a table of .*: No such file"):
        read_results(tmp_path)
    one = json.loads((tmp_path / "results.json").read_text(encoding="utf-8"))["studies"][0]["claims"][0]
    table = tmp_path / one["arrays"]
    table.parent.mkdir(parents=True)
    table.write_text(",".join(arrays.COLUMNS) + "\n", encoding="utf-8")
    with pytest.raises(ValueError, match="contains 0 numbers of theory"):
        read_results(tmp_path)
