"""Published texts cite only existing equations, figures and sections of the paper, and existing documents."""

import ast
import functools
import re
from pathlib import Path

import pytest

from compare.studies import STUDIES

ROOT = Path(__file__).parents[2]
EQUATIONS, FIGURES, SECTIONS = 26, 11, 5
"""Numbers of equations, figures and sections in the paper."""

PACKAGES = ("compare", "reference_model", "exudyn_models")
SOURCES = sorted(path for package in PACKAGES for path in (ROOT / package).rglob("*.py"))
PAGES = [ROOT / "README.md", *sorted((ROOT / "docs").glob("*.md"))]


@functools.cache
def nodes_of(path):
    return tuple(ast.walk(ast.parse(path.read_text(encoding="utf-8"))))


def cited(pattern, text):
    """Return the numbers in the group of ``pattern``, a list such as "2, 3", "14 to 16" or "11–16"."""
    return [int(number) for found in re.finditer(pattern, text) for number in re.findall(r"\d+", found[1])]


LIST = r"(\d+(?:(?:, | and | to |–)\d+)*)(?![\d.]*\d)"


def wrong(text):
    return [
        f"{kind} {number}"
        for kind, pattern, most in (
            ("section", rf"\b[Ss]ections? {LIST}", SECTIONS),
            ("figure", rf"\bFigs?\. {LIST}", FIGURES),
            ("equation", rf"\b[Ee]qs?\. {LIST}", EQUATIONS),
        )
        for number in cited(pattern, text)
        if not 1 <= number <= most
    ]


@pytest.mark.parametrize("text", ["section 6", "Figs. 9 and 12", "eq. 27", "Section 0"])
def test_a_citation_outside_the_paper_is_found(text):
    assert len(wrong(text)) == 1


def test_cited_sections_figures_and_equations_are_in_the_paper():
    found = [(path, wrong(path.read_text(encoding="utf-8"))) for path in (*SOURCES, *PAGES)]
    assert not [each for each in found if each[1]]


def equations_of_claims():
    for path in SOURCES:
        for node in nodes_of(path):
            if isinstance(node, ast.keyword) and node.arg == "equation":
                for each in ast.walk(node.value):
                    if isinstance(each, ast.Constant) and isinstance(each.value, str) and "(" in each.value:
                        yield path.name, each.value


def test_equations_of_claims_exist_in_the_paper():
    found = list(equations_of_claims())
    assert len(found) > 60
    for _, equation in found:
        assert re.fullmatch(r"\(\d+\)(?:(?:, |–)\(\d+\))*(?:, [a-z ]+)?", equation), equation
        assert all(1 <= int(number) <= EQUATIONS for number in re.findall(r"\d+", equation)), equation


def test_numbers_in_parentheses_in_texts_of_studies_are_equations():
    for study in STUDIES:
        for text in (study.title, study.prose.paper, study.prose.finding, *study.figures.values()):
            assert all(1 <= number <= EQUATIONS for number in map(int, re.findall(r"\((\d+)\)", text))), text


def test_no_unit_is_changed_by_the_case_of_a_sentence():
    """``str.capitalize`` turns "0.5 N/m³" into "0.5 n/m³"."""
    for path in SOURCES:
        for node in nodes_of(path):
            if isinstance(node, ast.Call) and isinstance(node.func, ast.Attribute):
                assert node.func.attr not in ("capitalize", "swapcase") or node.args, path


def test_a_space_separates_a_percentage_from_its_sign():
    """A space separates the number, as for any unit; Python's own format writes "1%"."""
    for path in (*SOURCES, *PAGES):
        text = path.read_text(encoding="utf-8")
        assert not re.findall(r":[.\d]*%\}", text), path
        if path in PAGES:
            assert not re.findall(r"\d%(?!\w)", text), path


def test_every_named_document_exists():
    names = {path.name for path in ROOT.rglob("*.md") if ".venv" not in path.parts}
    for path in (*SOURCES, *PAGES, *sorted((ROOT / "tests").rglob("*.py"))):
        for name in re.findall(r"[\w./-]+\.md\b", path.read_text(encoding="utf-8")):
            assert Path(name).name in names or path == Path(__file__), f"{path.name}: {name}"
