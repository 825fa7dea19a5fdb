"""The paper refers only to existing claims, figures and numbers; a workflow typesets it."""

import re
import runpy
from pathlib import Path

from compare.claims.errata import ERRATA
from compare.studies import STUDIES

ROOT = Path(__file__).parents[1]
FINDINGS = runpy.run_path(str(ROOT / "builders" / "findings.py"))
PAPER = ROOT / "docs" / "paper"
TEXT = (PAPER / "paper.typ").read_text(encoding="utf-8")


def claims(text):
    return [
        name for listed in re.findall(r"#c\(([^)]*)\)", text) for name in re.findall(r'"([^"]*)"', listed)
    ]


def references():
    """Return the names that the paper refers to, the existing names, and the least number of the former, by kind."""
    numbers = [each.equation.partition(",")[0] for each in ERRATA]
    corrections = TEXT.partition("= Corrections")[2].partition("\n)\n")[0]
    entries = re.findall(r"^(\w+):$", (PAPER / "references.yml").read_text(encoding="utf-8"), re.MULTILINE)
    cited = [name for name in re.findall(r"(?<![\w\"])@([a-z-]+)", TEXT) if not name.startswith("fig-")]
    figures = runpy.run_path(str(PAPER / "build.py"))["figures"]()
    return {
        "claims": (
            claims(TEXT),
            {one.identity(study.name, "") for study in STUDIES for one in study.declared},
            30,
        ),
        "figures": (figures, {name for study in STUDIES for name in study.figures}, 3),
        "numbers": (FINDINGS["QUOTED"].findall(TEXT), FINDINGS["kept"]().keys(), 20),
        "citations": (cited, set(entries), len(entries)),
        "references": (entries, set(cited), len(entries)),
        "corrections": (numbers, {number for number in numbers if f"[{number}]" in corrections}, len(ERRATA)),
    }


def test_the_paper_refers_only_to_what_exists():
    for kind, (referred, existing, least) in references().items():
        assert len(referred) >= least, kind
        assert set(referred) <= set(existing), kind


def test_the_paper_about_the_software_contains_the_present_numbers_and_cites_all_its_references():
    text = (PAPER / "paper.md").read_text(encoding="utf-8")
    script = runpy.run_path(str(PAPER / "build.py"))
    assert len(script["NAMED"].findall(text)) >= 8
    assert script["filled"](text) == text, "run python docs/paper/build.py"
    entries = re.findall(r"^@\w+\{(\w+),", (PAPER / "paper.bib").read_text(encoding="utf-8"), re.MULTILINE)
    assert set(re.findall(r"(?<!\w)@([a-z]+)", text)) == set(entries)
    assert all((PAPER / path).exists() for path in re.findall(r"\]\((\S+\.png)\)", text))
    for heading in ("Summary", "Statement of need", "State of the field", "References"):
        assert f"\n# {heading}\n" in text


def test_the_paper_without_a_report_lists_missing_numbers(monkeypatch, capsys, tmp_path):
    script = runpy.run_path(str(PAPER / "build.py"))
    monkeypatch.setitem(script["main"].__globals__, "FIGURES", tmp_path)
    assert script["main"]() == 2
    assert capsys.readouterr().err == (
        f"missing in {tmp_path}: basins, fig06-branches, stability-map; run make report first\n"
    )


def test_a_figure_is_wide_enough_for_its_smallest_letters():
    needed = runpy.run_path(str(PAPER / "build.py"))["needed_width"]
    svg = '<svg width="720pt"><g scale(0.015625)/><g scale(0.11 -0.11)/><g scale(0.1 -0.1)/></svg>'
    assert needed(svg) >= 0.7 * 720.0  # 10 pt at full size, at least 7 pt in print
