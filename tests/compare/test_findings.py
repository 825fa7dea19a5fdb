"""README, docs/findings.md and the paper quote the numbers of a report, and deviations are detected."""

import copy
import json
import re
import runpy
from pathlib import Path

import pytest
from fake_studies import claim

from compare.claims.as_json import claim_as_json
from compare.engines import engines
from compare.studies import STUDIES

ROOT = Path(__file__).parents[2]
BUILDER = runpy.run_path(str(ROOT / "builders" / "findings.py"))
PLACE, ERROR = "fig05: place, 3 digits", "fig05: place, error, good"


def results(measured=0.0512345678, error=1e-6, whole=True, other=1.0, sentence="Right.", place="Place"):
    """Return the results of a report on one or all studies, with claims of "fig05" for two engines."""
    found = [
        claim(place, engine, measured, measured, error, unit="m", named={"place": 0})
        for engine in ("good", "other")
    ]
    # Two claims share a cell of the matrix, which shows the worse verdict.
    found += [
        claim("Order", "good", 1.0, value, 0.01, kind="order", resolution=1.0, unit="1", named={"order": 0})
        for value in (other, 1.0)
    ]
    written = [
        claim_as_json(each)
        | {"id": f"fig05/{each.sentence.lower()}"}
        | {"evidence": "self-check" if each.sentence == "Order" else "independent"}
        for each in found
    ]
    names = [study.name for study in STUDIES] if whole else ["fig05"]
    return {
        "engines": [engine.name for engine in engines()],
        "totals": {"failed": 0, "missing": 0},
        "in_short": {"good": sentence},
        "studies": [{"name": name, "claims": written if name == "fig05" else []} for name in names],
    }


@pytest.fixture
def root(tmp_path, monkeypatch):
    (tmp_path / "docs" / "paper").mkdir(parents=True)
    (tmp_path / "builders").mkdir()
    (tmp_path / "builders" / "findings.md").write_text(f'At #n("{PLACE}") m, to #n("{ERROR}") m.\n#claims\n')
    (tmp_path / "docs" / "paper" / "paper.typ").write_text('#n("claims")', encoding="utf-8")
    (tmp_path / "README.md").write_text("All 2 claims, 3.14 times.\n")
    unmeasured = {"text": "", "value": 0.0, "error": 0.0, "nature": "count"}
    names = [PLACE, ERROR, "claims", "verdicts: independent"]
    (tmp_path / "docs" / "numbers.json").write_text(json.dumps(dict.fromkeys(names, unmeasured)))
    monkeypatch.setitem(BUILDER["wanted"].__globals__, "IN_README", ("claims", "verdicts: independent"))
    return tmp_path


def test_the_texts_contain_the_stored_numbers():
    assert list(BUILDER["outdated"](ROOT)) == []
    names = {study.name for study in STUDIES} | {"claims", "checks", "engine", "verdicts"}
    assert {name.partition(":")[0] for name in BUILDER["wanted"](ROOT)} <= names


def test_readme_contains_no_other_number_and_is_short():
    text = (ROOT / "README.md").read_text(encoding="utf-8")
    lines = text.splitlines()
    assert len(lines) <= 120
    first = "\n".join(lines[:25])
    assert [word in first for word in ("make report", "make test", "| engine | as shipped |")] == [True] * 3
    text = re.sub(r"(?s)<!-- engines -->.*<!-- end -->", "", text)  # from recordings
    kept = BUILDER["kept"](ROOT)
    for name in BUILDER["IN_README"]:
        text = text.replace(kept[name].text, "", 1)
    # Code, links, the citation and numbers of equations and the like do not count.
    for pattern in (
        r"(?s)```.*?```", r"`[^`]*`", r"\]\([^)]*\)", r"(?m)^> .*$", r"\b(?:Figs?\.|Python ≥) [\d.]+", r"\(\d+\)",
        "98 lines",
    ):  # fmt: skip
        text = re.sub(pattern, " ", text)
    assert re.findall(r".*\d.*", text) == []
    plain = (ROOT / "reference_model" / "plain.py").read_text(encoding="utf-8")
    assert len(plain.splitlines()) == 98


def test_digits_beyond_the_parameters_are_left_to_the_files():
    exact = BUILDER["Number"]("3145", 3145.010028181113, 3e-10, "measured", unit="rpm")
    assert BUILDER["_with_error"](exact) == "3145.010 rpm (numerical error 3×10⁻¹⁰ rpm)"


def test_a_report_writes_its_numbers(root):
    BUILDER["write"](results(), root)
    assert (root / "docs" / "findings.md").read_text(encoding="utf-8") == (
        "At [0.0512 m](#fig05place), to 1.0×10⁻⁶ m.\n### fig05/place\n\nPlace.\n\n- place: 0.051235 ± 1×10⁻⁶ m\n"
    )
    kept = BUILDER["kept"](root)
    order = BUILDER["number_in"](results(), "fig05: order")
    assert (order.claim, order.unit) == ("fig05/order", "")
    assert kept["claims"].value == 2
    assert kept["verdicts: independent"].value == 2  # the position by two engines; the order is a self-check
    assert list(BUILDER["deviations"](results(), root)) == []


def test_a_changed_sentence_about_an_engine_is_reported(root):
    (root / "builders" / "findings.md").write_text('Good: #n("engine: good")\n')
    (root / "docs" / "numbers.json").write_text("{}")
    BUILDER["write"](results(), root)
    assert (root / "docs" / "findings.md").read_text(encoding="utf-8") == "Good: Right.\n"
    assert list(BUILDER["deviations"](results(), root)) == []
    assert list(BUILDER["deviations"](results(sentence="Wrong."), root)) == [
        "engine: good: docs/numbers.json has Right., the report Wrong."
    ]


def test_a_text_without_the_stored_numbers_is_detected(root):
    BUILDER["write"](results(), root)
    assert list(BUILDER["outdated"](root)) == []
    (root / "README.md").write_text("All 12 claims, 3.14 times.\n")
    assert list(BUILDER["outdated"](root)) == [
        f"README.md does not contain 2, {name}" for name in ("claims", "verdicts: independent")
    ]
    (root / "docs" / "findings.md").write_text("At 0.0513 m\n")
    assert "docs/findings.md is not what builders/findings.md gives" in BUILDER["outdated"](root)
    (root / "docs" / "paper" / "paper.typ").write_text('#n("fig05: speed")', encoding="utf-8")
    assert list(BUILDER["outdated"](root)) == ["docs/numbers.json lacks or does not need ['fig05: speed']"]


def test_numbers_missing_from_a_report_are_kept(root):
    BUILDER["write"](results(), root)
    before = BUILDER["kept"](root)
    BUILDER["write"](results(measured=0.06, error=1e-3, whole=False), root)
    after = BUILDER["kept"](root)
    assert before["claims"] == after["claims"]
    assert after[PLACE].value == 0.06
    assert list(BUILDER["deviations"](results(whole=False) | {"studies": []}, root)) == []


def test_an_unknown_name_is_an_error_of_a_complete_report():
    assert BUILDER["number_in"](results(whole=False), "fig05: nothing") is None
    with pytest.raises(ValueError, match="'fig05: nothing': no claim of the study 'fig05' has that name"):
        BUILDER["number_in"](results(), "fig05: nothing")


@pytest.mark.parametrize(
    ("changed", "deviating"),
    [
        ({}, set()),
        ({"measured": 0.0512345678 + 1.9e-6}, set()),  # each number may be off by 1e-6
        ({"measured": 0.0512345678 + 2.1e-6}, {PLACE}),
        ({"measured": float("nan")}, {PLACE, "verdicts: independent"}),
        ({"error": 9e-6}, set()),
        ({"error": 1.1e-5}, {ERROR}),
        ({"error": 0.9e-7}, {ERROR}),
        ({"place": "Site"}, {PLACE, ERROR}),  # the claim has another sentence and another name
    ],
)
def test_deviations_beyond_the_error_are_reported(root, changed, deviating):
    BUILDER["write"](results(), root)
    sentences = BUILDER["deviations"](results(**changed), root)
    assert {sentence.rpartition(": docs/")[0] for sentence in sentences} == deviating


def test_a_quote_without_a_claim_is_an_error_of_a_complete_report():
    found = list(BUILDER["unmeasured"](results()))
    assert "basins: no claim has 'share at 1.5 rad/s, %, 3 digits'" in found
    assert list(BUILDER["unmeasured"](results(whole=False))) == []


def test_the_command_writes_and_checks(root, capsys, monkeypatch):
    path = root / "results.json"
    names = BUILDER["main"].__globals__
    monkeypatch.setitem(names, "read_results", lambda file: json.loads(file.read_text(encoding="utf-8")))
    monkeypatch.setitem(names, "unmeasured", lambda results: [])
    path.write_text(json.dumps(results()))
    with (root / "builders" / "findings.md").open("a") as template:
        template.write("![Branches](branches.svg)\n![Not in this report](map.svg)\n")
    (root / "figures").mkdir()
    (root / "figures" / "branches.svg").write_text("<svg/>")
    assert BUILDER["main"](["write", str(path)], root) == 0
    assert [figure.name for figure in (root / "docs").glob("*.svg")] == ["branches.svg"]
    changed = copy.deepcopy(results())
    changed["studies"][[study["name"] for study in changed["studies"]].index("fig05")]["claims"].pop(1)
    path.write_text(json.dumps(changed))
    assert BUILDER["main"](["check", str(path)], root) == 1
    assert "verdicts: independent: docs/numbers.json has 2 ± 0, the report 1 ± 0" in capsys.readouterr().out
    assert BUILDER["main"](["refresh"], root) == 2
