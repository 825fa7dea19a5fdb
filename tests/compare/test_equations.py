"""The table of equations matches the docstrings and claims, and contains every equation."""

import runpy

import pytest
from processes import ROOT


@pytest.fixture(scope="module")
def table():
    return runpy.run_path(str(ROOT / "docs" / "write_equations.py"))


def test_the_table_of_equations_is_current(table):
    found = table["PAGE"].read_text(encoding="utf-8")
    assert found == table["text"](), "run python docs/write_equations.py"


def test_every_equation_has_a_function_and_except_for_definitions_a_claim(table):
    assert len(table["EQUATIONS"]) == 26
    assert [number for number, found in table["functions"]().items() if not found] == []
    assert [number for number, found in table["claims"]().items() if not found] == [2, 24, 25]


@pytest.mark.parametrize(
    ("text", "numbers"),
    [
        ("by (14) to (16), see eq. 3", {3, 14, 15, 16}),
        ("Eq. 1 and 19 to 21 of the paper", {1, 19, 20, 21}),
        ("(19), (20)", {19, 20}),
        ("shape (n, 4) of 27, (27)", set()),
    ],
)
def test_citations_in_docstrings_are_parsed(table, text, numbers):
    assert table["cited"](text) == numbers
