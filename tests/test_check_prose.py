"""The language check fails above a file's budget, and budgets only fall."""

import runpy
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
CHECK = runpy.run_path(str(ROOT / "builders" / "check_prose.py"))

PAGE = """# What a heading says does not count

A page about friction, which is no
pass. What moves?

- Of Drake, creep is not recorded.

```
what code says
```
"""
MODULE = '''"""Tell what is left."""

RESULT = "what a string says"  # with which it begins
'''


@pytest.fixture
def root(tmp_path):
    (tmp_path / "docs").mkdir()
    (tmp_path / "builders").mkdir()
    (tmp_path / "docs" / "sweeps.md").write_text(PAGE, encoding="utf-8")
    (tmp_path / "docs" / "module.py").write_text(MODULE, encoding="utf-8")
    return tmp_path


def budgets(root, text):
    (root / CHECK["BUDGET"]).write_text(text, encoding="utf-8")


def test_a_file_above_its_budget_fails_with_its_sentences_and_one_below_it_is_listed(root, capsys):
    lowered = "below budget: docs/module.py, docs/glossary.md; run python builders/check_prose.py lower"
    budgets(root, "1 docs/sweeps.md\n3 docs/module.py\n1 docs/glossary.md\n")
    assert CHECK["main"]([], root) == 1
    assert capsys.readouterr().out.splitlines() == [
        "docs/sweeps.md: 2 unclear constructions, budget 1",
        "  3: A page about friction, which is no pass.",
        "  6: Of Drake, creep is not recorded.",
        lowered,
    ]
    budgets(root, "2 docs/sweeps.md\n3 docs/module.py\n1 docs/glossary.md\n")
    assert CHECK["main"]([], root) == 0
    assert capsys.readouterr().out.splitlines() == [lowered]


def test_budgets_are_lowered_and_never_raised(root):
    budgets(root, "3 docs/sweeps.md\n1 docs/module.py\n1 docs/glossary.md\n")
    assert CHECK["main"](["lower"], root) == 0
    assert (root / CHECK["BUDGET"]).read_text() == "1 docs/module.py\n2 docs/sweeps.md\n"


def test_an_empty_table_stays_empty_but_a_missing_one_is_written(root):
    budgets(root, "")
    CHECK["main"](["lower"], root)
    assert (root / CHECK["BUDGET"]).read_text() == ""
    (root / CHECK["BUDGET"]).unlink()
    CHECK["main"](["lower"], root)
    assert (root / CHECK["BUDGET"]).read_text() == "2 docs/module.py\n2 docs/sweeps.md\n"
