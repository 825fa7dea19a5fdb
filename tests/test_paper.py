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


def test_every_claim_of_the_paper_is_declared():
    declared = {each.identity(study.name, "") for study in STUDIES for each in study.declared}
    assert len(claims(TEXT)) > 30
    assert set(claims(TEXT)) <= declared
    assert claims('#c("fig05/x", "fig06/y")') == ["fig05/x", "fig06/y"]


def test_every_figure_of_the_paper_is_one_of_the_report():
    names = runpy.run_path(str(PAPER / "build.py"))["figures"]()
    assert len(names) == 3
    assert set(names) <= {name for study in STUDIES for name in study.figures}


def test_every_number_of_the_paper_was_measured():
    words = FINDINGS["QUOTED"].findall(TEXT)
    assert len(words) > 20
    assert set(words) <= FINDINGS["kept"]().keys()


def test_the_paper_without_a_report_lists_missing_numbers(monkeypatch, capsys, tmp_path):
    script = runpy.run_path(str(PAPER / "build.py"))
    monkeypatch.setitem(script["main"].__globals__, "FIGURES", tmp_path)
    assert script["main"]() == 2
    assert capsys.readouterr().err == (
        f"missing in {tmp_path}: basins, fig06-branches, stability-map; run make report first\n"
    )


def test_all_citations_of_the_paper_are_in_its_references():
    entries = set(
        re.findall(r"^(\w+):$", (PAPER / "references.yml").read_text(encoding="utf-8"), re.MULTILINE)
    )
    cited = {name for name in re.findall(r"(?<![\w\"])@([a-z-]+)", TEXT) if not name.startswith("fig-")}
    assert cited == entries


def test_a_figure_is_wide_enough_for_its_smallest_letters():
    needed = runpy.run_path(str(PAPER / "build.py"))["needed_width"]
    svg = '<svg width="720pt"><g scale(0.015625)/><g scale(0.11 -0.11)/><g scale(0.1 -0.1)/></svg>'
    assert needed(svg) >= 0.7 * 720.0  # 10 pt at full size, at least 7 pt in print


def test_the_table_of_the_paper_has_every_erratum():
    table = TEXT.partition("= Corrections")[2].partition("\n)\n")[0]
    numbers = [each.equation.partition(",")[0] for each in ERRATA]
    assert [number for number in numbers if f"[{number}]" not in table] == []
