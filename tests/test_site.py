"""The site's pages link to each other; Sphinx itself runs in a workflow, where a warning is an error."""

import ast
import importlib
import json
import runpy
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]


@pytest.fixture(scope="module")
def site():
    return runpy.run_path(str(ROOT / "docs" / "site" / "build.py"))


@pytest.fixture(scope="module")
def gathered(site, tmp_path_factory):
    folder = tmp_path_factory.mktemp("site")
    site["gather"](folder)
    return folder


def test_every_page_is_in_the_navigation(site, gathered):
    named = {name for names in site["SECTIONS"].values() for name in names}
    pages = {path.relative_to(gathered).with_suffix("").as_posix() for path in gathered.rglob("*.*")}
    assert named <= pages
    pages_of_docs = {path.stem for path in (ROOT / "docs").glob("*.md")}
    assert pages_of_docs - {"index"} <= named


def test_links_of_the_site_stay_in_it(site, gathered):
    for path in gathered.rglob("*.md"):
        if path.relative_to(gathered).parts[0] == "source":
            continue
        for link, _ in site["LINK"].findall(path.read_text(encoding="utf-8")):
            target = (path.parent / link).resolve()
            assert target.exists(), f"{path.name}: {link}"
            assert target.is_relative_to(gathered.resolve()), f"{path.name}: {link}"


def test_a_link_into_the_repository_leads_to_a_page_of_code(site, gathered):
    text = "[a](../examples/01_pin.py), [b](../examples), [c](sweeps.md)"
    moved = site["moved"](text, "docs/gallery.md", "gallery.md")
    shown = site["_page_of"]("examples/01_pin.py")
    assert moved == f"[a]({shown}), [b](gallery.md), [c](sweeps.md)"
    assert "simulate(pin" in (gathered / shown).read_text(encoding="utf-8")


def test_numbers_stay_with_their_units_except_in_code(site):
    page = site["_unbroken"]("At 5 m/s, `sleep 5 m`.\n```\n5 s\n```\n")
    assert page == "At 5\N{NO-BREAK SPACE}m/s, `sleep 5 m`.\n```\n5 s\n```\n"


def test_bars_in_docstrings_are_bars():
    escape = runpy.run_path(str(ROOT / "docs" / "site" / "conf.py"))["escape_bars"]
    lines = ["μN·v/|v|, ``a|b``::", "", "    c|d", "|e|"]
    escape(None, "", "", None, None, lines)
    assert lines == [r"μN·v/\|v\|, ``a|b``::", "", "    c|d", r"\|e\|"]


def test_the_api_by_task_names_everything_public_once(site):
    pages = site["pages_of_program"]
    packages = ("reference_model", "reference_model.ensemble", "exudyn_models", "fmu_models")
    public = {f"{name}.{each}" for name in packages for each in importlib.import_module(name).__all__}
    named = [pages.full_name(name) for names in pages.TASKS.values() for name in names]
    assert sorted(named) == sorted(public)


def test_the_pages_made_from_the_program_contain_the_help_and_the_citation(gathered):
    page = (gathered / "commands").with_suffix(".md").read_text(encoding="utf-8")
    for command in ("report", "simulate disc", "sweep shock", "export-fmu clutch"):
        section = page.partition(f"\n## friction-discs {command}\n")[2].partition("\n## ")[0]
        assert "Options:" in section
        assert "Example" in section
    assert "@software{" in (gathered / "cite.md").read_text(encoding="utf-8")


def test_every_module_and_every_benchmark_with_its_figures_has_a_place(gathered):
    modules = (gathered / "modules").with_suffix(".md").read_text(encoding="utf-8")
    packages = ("reference_model", "exudyn_models", "fmu_models", "compare")
    assert modules.count("\n| `") == sum(len([*(ROOT / name).rglob("*.py")]) for name in packages)
    assert "|  |" not in modules  # each has a docstring
    benchmarks = (gathered / "benchmarks").with_suffix(".md").read_text(encoding="utf-8")
    assert "\n## ensemble_discs\n" in benchmarks
    assert "| ring, Figs. 8, 9, 11 |" in benchmarks


def test_the_gallery_links_notebooks_that_compute_print_and_draw_without_arguments(gathered):
    gallery = (gathered / "gallery").with_suffix(".md").read_text(encoding="utf-8")
    examples = sorted((ROOT / "examples").glob("*.py"))
    for path in examples:
        assert f"](notebooks/{path.name}), <a href=" in gallery
        text = (gathered / "notebooks" / path.name).read_text(encoding="utf-8")
        assert "sys.argv" not in text
        assert ('\ndraw("picture.png")\n' in text) == ("def draw(" in text)
        assert "print(" in text or "print(" not in path.read_text(encoding="utf-8")
        ast.parse(text)


def test_names_of_claims_lead_to_the_report(site, tmp_path, monkeypatch):
    pages = site["pages_of_program"]
    claims = [{"id": f"fig11/slides/{case}"} for case in ("twelve-points", "six-points")]
    claims.append({"id": "fig05/critical"})
    (tmp_path / "results.json").write_text(json.dumps({"studies": [{"claims": claims}]}))
    monkeypatch.setattr(pages, "REPORT", tmp_path)
    text = pages.linked_claims("`fig05/critical`, `fig11/slides`, `docs/site`")
    assert '<a href="report/index.html#fig05/critical"><code>fig05/critical</code></a>' in text
    assert '"report/index.html#fig11/slides/six-points"><code>fig11/slides</code>' in text
    assert text.endswith("`docs/site`")
    text = pages.linked_claims(
        "[0.03](#fig05critical), [4](findings.md#fig05critical), [so](#cost)\n### fig05/critical\n\nAgrees.\n"
    )
    address = '<a href="report/index.html#fig05/critical">'
    assert text.startswith(f"{address}0.03</a>, {address}4</a>, [so](#cost)")
    assert text.endswith(f"### fig05/critical\n\n{address}Agrees.</a>\n")
