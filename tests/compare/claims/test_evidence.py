"""Kind of evidence of a verdict, from the claim, the engine and related verdicts."""

import json
import re
import xml.etree.ElementTree as ET
from dataclasses import replace
from functools import partial

import numpy as np
import pytest
from fake_studies import GOOD, claim, fake, straight

from compare.claims.claim import BASES, THEORY, Verdict
from compare.claims.study import Findings
from compare.engines import Engine, engines, exudyn, exudyn_native, reference
from compare.report.matrix import State, evidence_of, matrix
from compare.report.numbers import unbroken
from compare.report.page import counted, summary
from compare.report.write import write_report
from compare.run.runner import Run, run
from compare.studies import STUDIES, studies

pytestmark = pytest.mark.usefixtures("all_in_this_process")


@pytest.mark.parametrize(
    ("engine", "about", "evidence"),
    [
        ("exudyn", {}, "independent"),
        ("exudyn", {"kind": "conservation"}, "independent"),
        ("exudyn", {"kind": "trajectory"}, "independent"),
        ("mypackage.mymodule:simulate", {"kind": "trajectory"}, "independent"),
        ("reference", {"kind": "trajectory"}, "self-check"),
        ("reference", {"kind": "trajectory", "basis": "independent"}, "independent"),
        ("reference", {"kind": "conservation", "basis": "reference"}, "self-check"),
        ("exudyn", {"kind": "conservation", "basis": "reference"}, "independent"),
        ("exudyn", {"basis": "self-check"}, "self-check"),
        (THEORY, {}, "algebra"),
        (THEORY, {"kind": "trajectory"}, "self-check"),  # simulated by the reference
        (THEORY, {"basis": "independent"}, "independent"),
    ],
)
def test_the_engine_decides_whether_a_prediction_is_its_own(engine, about, evidence):
    assert evidence_of(claim("c", engine, 0.0, 0.0, 1.0, **about)) == evidence


RESTS, CIRCLE, OTHER = "It rests there", "So it rests on the circle", "It whirls elsewhere"


def measured(engine, rests=0.0, basis="independent"):
    made = (
        claim(RESTS, engine.name, 0.0, rests, 1e-9, basis=basis),
        claim(CIRCLE, engine.name, 0.0, 0.0, 1e-9, implied_by=RESTS),
        claim(OTHER, engine.name, 0.0, 0.0, 1e-9),
    )
    return Findings(made)


measured_with_its_own_law = partial(measured, basis="reference")


def study_of(measure, **more):
    return fake("rests", "Rest and whirl", "They are.", measure, **more)


def kinds(folder, study, *of):
    rows = matrix(run((study,), of, folder=folder)).rows
    return {row.sentence: {name: cell.evidence for name, cell in row.cells.items()} for row in rows}


@pytest.mark.parametrize(("rests", "evidence"), [(0.0, "implied"), (1.0, "independent")])
def test_a_claim_implied_by_an_agreeing_claim_adds_no_evidence(rests, evidence, tmp_path):
    found = kinds(tmp_path, study_of(partial(measured, rests=rests)), GOOD)
    assert [each["good"] for each in found.values()] == ["independent", evidence, "independent"]


def test_a_self_check_does_not_imply_independent_evidence(tmp_path):
    """(4) needs no friction law, so it is independent evidence even if the predicted position of rest uses one."""
    found = kinds(tmp_path, study_of(measured_with_its_own_law), reference, exudyn)
    assert found[RESTS] == {"reference": "self-check", "exudyn": "independent"}
    assert found[CIRCLE] == {"reference": "independent", "exudyn": "implied"}


def test_an_engine_with_another_contact_is_independent_of_its_kin_only_where_the_contact_decides(tmp_path):
    (named,) = engines(["exudyn-native"])
    for contact, evidence in ((False, "implied"), (True, "independent")):
        found = kinds(tmp_path / str(contact), study_of(measured, contact=contact), exudyn, named)
        assert found[OTHER] == {"exudyn": "independent", "exudyn-native": evidence}
    alone = kinds(tmp_path / "alone", study_of(measured), named)
    assert alone[OTHER] == {"exudyn-native": "independent"}  # no related engine takes part


def test_an_unnamed_variant_takes_part_only_where_its_contact_decides():
    usual = next(engine for engine in engines() if engine.name == exudyn_native.name)
    (named,) = engines([exudyn_native.name])
    assert (usual.contact_only, named.contact_only) == (True, False)
    about_contact = {study.name for study in STUDIES if study.contact}
    assert {"contact-laws", "trajectories", "block"} <= about_contact < {study.name for study in STUDIES}
    asked = Run(STUDIES, ("exudyn", usual.name), contact_only=(usual.name,))
    assert {study.name for study in STUDIES if usual.name in asked.columns(study)} == about_contact
    everything = Run(STUDIES, ("exudyn", usual.name))
    assert len([study for study in STUDIES if usual.name in everything.columns(study)]) > 15


def measured_and_told(engine):
    return replace(measured(engine), data={"contact only": np.array(float(engine.contact_only))})


def test_findings_about_the_contact_alone_are_not_reused_for_the_whole_engine(tmp_path):
    study = study_of(measured_and_told, contact=True)
    part = Engine("part", straight, contact_only=True)
    for engine in (part, replace(part, contact_only=False), part):
        found = run((study,), (engine,), folder=tmp_path, resume=True).outcomes["rests", "part"]
        assert found.data["contact only"] == float(engine.contact_only)


@pytest.mark.parametrize(
    ("name", "said"),
    [
        ("trajectories", {"a pin", "a pin that sticks on its way", "a disc on six points"}),
        ("power-balance", {"six points thrown on a table, to rest"}),
    ],
)
def test_motions_for_the_contact_alone_are_a_subset_of_the_study(name, said):
    (study,) = studies([name])
    resting = Engine("resting", straight, ("pin", "points"), contact_only=True)
    assert {made.sentence.split(": ")[1] for made in study.measure(resting).claims} == said


def test_the_contact_alone_is_measured_by_radius_and_frequency_of_the_whirl():
    (study,) = studies(["whirl-stability"])
    few = {name: {"speeds": (1.5,)} for name in ("radius", "frequency")}
    found = study.measure(replace(reference, contact_only=True), few).claims
    assert {made.identity: made.verdict for made in found} == {
        "whirl-stability/radius": Verdict.AGREES,
        "whirl-stability/frequency": Verdict.AGREES,
    }


@pytest.fixture(scope="module")
def reported(tmp_path_factory, all_in_this_process):
    """Return matrix and folder of a report on the reference and Exudyn, with all kinds of evidence."""
    folder = tmp_path_factory.mktemp("evidence")
    study = study_of(measured_with_its_own_law, provided={"theory": theory})
    native_too = replace(exudyn_native, function=straight)
    return write_report(
        run((study,), (reference, exudyn, native_too), folder=folder / "data"), folder
    ), folder


def theory():
    return Findings((claim("The forms are one", THEORY, 0.0, 0.0, 1e-9),))


def test_the_page_counts_independent_evidence_first_and_explains_each_kind(reported):
    found, folder = reported
    line = "4 checks against independent evidence and 3 others agree, 0 differ, 0 inconclusive"
    assert summary(found) == line
    assert counted(found) == (
        "4 claims, 7 checks (each claim in every engine of its study): 4 against independent evidence, "
        "1 self-checks, 1 of algebra and 1 implied by others."
    )
    page = (folder / "index.html").read_text(encoding="utf-8")
    assert f'<p class="totals" id="totals"><strong>{line}.</strong> <span>{counted(found)}</span></p>' in page
    assert f"<title>Friction discs: {line}</title>" in page

    (legend,) = re.findall(r'<dl class="legend kinds">(.*?)</dl>', page, flags=re.DOTALL)
    assert re.findall("<dt>(.*?)</dt>", legend) == ["independent", "self-check", "algebra", "implied"]
    by = rf'implied by <a href="#(rests/[a-z0-9-]+)" title="{re.escape(RESTS)}">\1</a>'
    assert (
        len(re.findall(by, page)) == 1
    )  # a second link, in the line that opens the table, would be unreachable
    assert "Exudyn with its built-in contact" not in page  # no study of contact, so it measured nothing


def test_the_headline_counts_the_evidence_that_half_the_friction_would_spoil(tmp_path):
    def with_kinematics(engine):
        claims = measured(engine).claims
        return Findings((*claims[:2], replace(claims[2], friction=False)))

    found = write_report(run((study_of(with_kinematics),), (GOOD,), folder=tmp_path / "data"), tmp_path)
    line = "2 checks against independent evidence (1 of them test the friction force) and 1 other agree"
    assert summary(found) == f"{line}, 0 differ, 0 inconclusive"
    results = json.loads((tmp_path / "results.json").read_text(encoding="utf-8"))
    assert [one["friction"] for one in results["studies"][0]["claims"]] == [True, True, False]


@pytest.mark.parametrize(
    ("name", "function", "basis"),
    [("clutch-scale", "spins", "reference"), ("clutch-parts", "balance", "self-check")],
)
def test_a_prediction_from_the_friction_law_under_test_is_not_independent(name, function, basis):
    (study,) = studies([name])
    assert [one.basis for one in study.declared if one.function.__name__ == function] == [basis]


def test_machine_readable_results_contain_the_kind_of_evidence(reported):
    _, folder = reported
    results = json.loads((folder / "results.json").read_text(encoding="utf-8"))
    counts = {kind: counts["agrees"] for kind, counts in results["evidence"].items()}
    assert counts == {"independent": 4, "self-check": 1, "algebra": 1, "implied": 1}
    claims = {(made["engine"], made["sentence"]): made for made in results["studies"][0]["claims"]}
    assert claims["reference", RESTS]["evidence"] == "self-check"
    implied = claims["exudyn", CIRCLE]
    assert (implied["evidence"], implied["follows_from"]) == ("implied", RESTS)
    cases = {
        (case.get("classname"), case.get("name")): {
            each.get("name"): each.get("value") for each in case.iter("property")
        }
        for case in ET.parse(folder / "junit.xml").iter("testcase")
    }
    said = {"kind": "formula", "evidence": "implied", "implied by": RESTS}
    assert cases["rests.exudyn", CIRCLE].items() >= said.items()
    assert cases["rests.theory", "The forms are one"]["evidence"] == "algebra"


def test_matrix_and_table_show_the_same_number(tmp_path):
    """The claim's smallest budget is much smaller than its largest."""

    def budgets(engine):
        differences, allowed = np.array([1e-13, 9e-6, 2e-5]), np.array([1e-12, 1e-5, 1e-3])
        return Findings(
            (claim("Three numbers", engine.name, np.zeros(3), differences, allowed, resolution=1.0),)
        )

    written = write_report(run((study_of(budgets),), (GOOD,), folder=tmp_path / "data"), tmp_path)
    cell = written.rows[0].cells["good"]
    assert (cell.state, cell.number) == (State.AGREES, "±\N{NO-BREAK SPACE}1.0×10⁻⁵ m")
    page = (tmp_path / "index.html").read_text(encoding="utf-8")
    assert page.count(f'<small class="within">{unbroken(cell.number)}</small>') == 2
    assert '<data value="9e-06">' in page
    assert 'largest <data value="2e-05">' in page
    (made,) = json.loads((tmp_path / "results.json").read_text(encoding="utf-8"))["studies"][0]["claims"]
    decisive = made["decided_by"]
    assert (decisive["element"], decisive["name"], decisive["unit"]) == (1, "no. 2 of 3", "m")
    assert (decisive["difference"], decisive["allowed"]) == (9e-6, 1e-5)
    assert made["largest"] == [{"element": 2, "name": "no. 3 of 3", "unit": "m", "difference": 2e-5}]


def test_an_implying_claim_is_not_itself_implied():
    found = 0
    for study in STUDIES:
        by_sentence = {one.sentence: one for one in study.declared}
        for one in study.declared:
            assert one.basis in ("", *(set(BASES) - {"algebra"} if one.of_engine else BASES))
            if one.implied_by:
                found += 1
                assert not by_sentence[one.implied_by].implied_by, (study.name, one.sentence)
    assert found > 8
