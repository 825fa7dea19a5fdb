"""The numbers of README and docs are those of a report, and a report that says something else is noticed."""

import json
import re
from dataclasses import replace

import pytest
from fake_studies import claim

from compare.claims.as_json import claim_as_json
from compare.cli import readme
from compare.cli.readme import Number, filled, kept, parted, unlike, write
from compare.engines import engines
from compare.studies import STUDIES

TEXT = """Each of <!--=claims-->some 12<!--/--> claims, <!--=verdicts: kind=order, verdict=agrees-->…<!--/--> of them.
It whirls at <!--=fig05: place, 3 digits-->…<!--/--> m, to <!--=fig05: place, error, good-->1e-12<!--/--> m.
"""


def results(measured=0.0512345678, error=1e-6, whole=True, verdict_of_order="agrees"):
    """Return what a report of one or of all studies has, with two claims of "fig05" by two engines."""
    found = [
        claim("Place", "good", 0.0512345, measured, error, unit="m", named={"place": 0}),
        claim("Place", "other", 0.0512345, measured, error, unit="m", named={"place": 0}),
        claim(
            "Order",
            "good",
            1.0,
            1.0 if verdict_of_order == "agrees" else 2.0,
            0.01,
            kind="order",
            resolution=1.0,
        ),
        claim("Order", "good", 1.0, 1.0, 0.01, kind="order", resolution=1.0),  # the same, of other parameters
    ]
    names = [study.name for study in STUDIES] if whole else ["fig05"]
    return {
        "engines": [engine.name for engine in engines()],
        "totals": {"failed": 0, "missing": 0},
        "studies": [
            {"name": name, "claims": [claim_as_json(each) for each in found] if name == "fig05" else []}
            for name in names
        ],
    }


@pytest.fixture
def root(tmp_path):
    (tmp_path / "docs").mkdir()
    (tmp_path / "README.md").write_text(TEXT, encoding="utf-8")
    return tmp_path


def test_the_texts_have_the_numbers_that_are_kept():
    assert unlike() == []
    assert len(kept()) > 20


def prose(text):
    """Return a page without code, marked numbers, links, and numbers that are names, as of equations."""
    for pattern in (
        r"```.*?```",
        readme.MARKED.pattern,
        r"`[^`]*`",
        r"\]\([^)]*\)",
        r"^> .*$",  # the paper as one cites it
        r"\b(?:Figs?\.|Equations?|Python ≥) [\d.]+(?: and \d+)?",
        r"\(\d+\)",
        r"[kX]0",
    ):
        text = re.sub(
            pattern, " ", text, flags=re.DOTALL if pattern.startswith(("```", "(<")) else re.MULTILINE
        )
    return text


def test_every_number_of_the_readme_is_from_a_report():
    text = (readme.ROOT / "README.md").read_text(encoding="utf-8")
    assert re.findall(r".*\d.*", prose(text)) == []
    assert re.findall(r"\d+", prose(f"{text}\nAnd 17 more.")) == ["17"]


def test_no_line_of_a_page_begins_with_a_marked_number():
    """A comment at the beginning of a line ends the paragraph, for GitHub and for the site alike."""
    for path, text in readme.texts().items():
        assert re.findall(r"^\s*<!--=.*", text, re.MULTILINE) == [], path


def test_the_readme_is_short_and_has_the_engines_on_its_first_screen():
    lines = (readme.ROOT / "README.md").read_text(encoding="utf-8").splitlines()
    assert len(lines) <= 120
    first = "\n".join(lines[:25])
    assert [word in first for word in ("make report", "make test", "(docs/engines.png)")] == [True] * 3


def test_a_number_of_the_paper_is_kept_and_one_that_was_never_measured_is_noticed(root):
    (root / "docs" / "paper").mkdir()
    paper = root / "docs" / "paper" / "paper.typ"
    paper.write_text('#n("fig05: place, error, good") and #n("claims")', encoding="utf-8")
    write(results(), root)
    assert "fig05: place, error, good" in kept(root)
    assert unlike(root) == []
    paper.write_text('#n("fig05: place, error, other")', encoding="utf-8")
    assert unlike(root) == ["the paper: fig05: place, error, other: never measured"]


def test_every_number_of_the_texts_names_a_study_or_counts():
    names = {study.name for study in STUDIES} | {"claims", "verdicts"}
    assert {words.partition(":")[0] for words in readme.wanted()} <= names


def test_a_report_writes_its_numbers_between_the_marks(root):
    write(results(), root)
    text = (root / "README.md").read_text(encoding="utf-8")
    assert readme.MARKED.sub(lambda found: found["text"], text) == (
        "Each of 2 claims, 1 of them.\nIt whirls at 0.0512 m, to 1.0×10⁻⁶ m.\n"
    )
    assert [words for words, _ in readme.marks(text)] == [words for words, _ in readme.marks(TEXT)]
    assert unlike(root) == []
    assert parted(results(), root) == []


def test_a_number_written_by_hand_is_found_out(root):
    write(results(), root)
    path = root / "README.md"
    text = path.read_text(encoding="utf-8")
    path.write_text(text.replace("0.0512<", "0.0513<"), encoding="utf-8")
    (sentence,) = unlike(root)
    assert "'0.0513' in place of '0.0512'" in sentence
    path.write_text(text.partition("\n")[0], encoding="utf-8")
    assert {sentence.partition("'")[0] for sentence in unlike(root)} == {"no text has "}


def test_what_a_report_is_not_about_stays_as_it_was(root):
    write(results(), root)
    before = kept(root)
    part = results(measured=0.06, error=1e-3, whole=False)
    write(part, root)
    after = kept(root)
    assert before["claims"] == after["claims"]
    assert after["fig05: place, 3 digits"].value == 0.06
    empty = part | {"studies": []}
    write(empty, root)
    assert kept(root) == after
    assert parted(empty, root) == []


def test_a_name_that_no_claim_has_is_told_by_a_whole_report_only(root):
    (root / "README.md").write_text("<!--=fig05: nothing-->1<!--/-->", encoding="utf-8")
    write(results(whole=False), root)
    with pytest.raises(ValueError, match="'fig05: nothing': no claim of the study 'fig05' has that name"):
        write(results(), root)


@pytest.mark.parametrize(
    ("changed", "told"),
    [
        ({}, set()),
        ({"measured": 0.0512345678 + 1.9e-6}, set()),  # each of the two may be 1e-6 off
        ({"measured": 0.0512345678 + 2.1e-6}, {"fig05: place, 3 digits"}),
        ({"measured": float("nan")}, {"fig05: place, 3 digits"}),
        ({"error": 9e-6}, set()),
        ({"error": 1.1e-5}, {"fig05: place, error, good"}),
        ({"error": 0.9e-7}, {"fig05: place, error, good"}),
        ({"verdict_of_order": "differs"}, {"verdicts: kind=order, verdict=agrees"}),
    ],
)
def test_numbers_part_by_more_than_their_nature_allows(root, changed, told):
    write(results(), root)
    assert {sentence.rpartition(": the text has")[0] for sentence in parted(results(**changed), root)} == told


def test_a_condition_on_a_field_that_claims_have_not_is_refused(root):
    with pytest.raises(ValueError, match="'colour' is no field of a claim, which has study, sentence"):
        readme.number_in(results(), "verdicts: colour=red")


def test_a_quote_in_a_study_that_no_claim_has_is_told_by_a_whole_report_only():
    found = readme.unmeasured(results())
    assert "basins: no claim has 'share at 1.5 rad/s, %, 3 digits'" in found
    assert "foreign-engines: no claim has 'late by a box, 2 digits'" in found
    assert readme.unmeasured(results(whole=False)) == []


def test_counts_are_exact():
    count = Number("223", 223, 0.0, "count")
    assert count.parts_from(replace(count, value=224))
    assert not count.parts_from(replace(count, text="two hundred"))


def test_a_mark_without_a_number_shows_an_ellipsis():
    assert filled("<!--=claims-->12<!--/-->", {}) == "<!--=claims-->…<!--/-->"


def test_the_command_writes_and_checks(root, capsys, monkeypatch):
    path = root / "results.json"
    monkeypatch.setattr(readme, "read_results", lambda file: json.loads(file.read_text(encoding="utf-8")))
    path.write_text(json.dumps(results()), encoding="utf-8")
    path.write_text(json.dumps(results(whole=False)), encoding="utf-8")
    assert readme.main(["check", str(path)], root) == 1
    assert readme.main(["write", str(path)], root) == 1  # a part of a report has no counts
    (root / "README.md").write_text(TEXT.split("\n", 1)[1], encoding="utf-8")
    path.write_text(json.dumps(results(whole=False)), encoding="utf-8")
    assert readme.main(["write", str(path)], root) == 0
    assert readme.main(["check", str(path)], root) == 0
    path.write_text(json.dumps(results(measured=0.06, whole=False)), encoding="utf-8")
    capsys.readouterr()
    assert readme.main(["check", str(path)], root) == 1
    assert (
        "fig05: place, 3 digits: the text has 0.0512345678 ± 1e-06, measured is 0.06"
        in capsys.readouterr().out
    )
    assert readme.main(["refresh"], root) == 2
