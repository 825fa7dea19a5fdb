"""The citation takes version and commit from the program, and the rest from CITATION.cff."""

import runpy
from pathlib import Path

import pytest

from reference_model import __version__

ROOT = Path(__file__).parents[1]


@pytest.fixture
def cited():
    return runpy.run_path(str(ROOT / "docs" / "cited.py"))


def test_the_entries_contain_version_date_and_commit(cited, monkeypatch):
    names = cited["bibtex"].__globals__
    monkeypatch.setitem(names, "date", lambda: "2030-01-02")
    monkeypatch.setitem(names, "commit", lambda: "abc123")
    software, paper = cited["bibtex"]().split("\n\n")
    for line in (
        f"version = {{{__version__}}},",
        "date = {2030-01-02},",
        "year = {2030},",
        "note = {commit abc123},",
    ):
        assert f"\n  {line}\n" in software
    assert "author = {Fidlin, Alexander and Stamm, Wolfgang}" in paper
    assert "pages = {526--534}" in paper


def test_unknown_facts_are_left_out(cited, monkeypatch):
    names = cited["bibtex"].__globals__
    monkeypatch.setitem(names, "date", lambda: "")
    monkeypatch.setitem(names, "commit", lambda: "")
    assert not any(name in cited["bibtex"]().partition("\n\n")[0] for name in ("year =", "date =", "note ="))
    assert f"```bibtex\n{cited['bibtex']()}```" in (ROOT / "docs" / "cite.md").read_text(encoding="utf-8")
    with pytest.raises(ValueError, match="no field 'doi'"):
        cited["field"]("doi")
