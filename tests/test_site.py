"""The site's pages link to each other; Sphinx itself runs in a workflow, where a warning is an error."""

import re
import runpy
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
PAGES = [*ROOT.glob("*.md"), *sorted((ROOT / "docs").glob("*.md"))]


@pytest.fixture(scope="module")
def site():
    return runpy.run_path(str(ROOT / "docs" / "site" / "build.py"))


@pytest.fixture(scope="module")
def gathered(site, tmp_path_factory):
    folder = tmp_path_factory.mktemp("site")
    site["gather"](folder)
    return folder


def anchors(path):
    """Return what a page's headings are called in links."""
    headings = re.findall(r"^#+ (.*)$", path.read_text(encoding="utf-8"), re.MULTILINE)
    return {re.sub(r"[^\w\- ]", "", heading).strip().lower().replace(" ", "-") for heading in headings}


def test_every_link_leads_to_a_file_and_a_heading_that_are_there(site):
    found = [
        (path, link, anchor)
        for path in PAGES
        for link, anchor in site["LINK"].findall(path.read_text("utf-8"))
    ]
    assert len(found) > 100
    for path, link, anchor in found:
        target = path.parent / link
        assert target.exists(), f"{path.name}: {link}"
        assert not anchor or anchor[1:] in anchors(target), f"{path.name}: {link}{anchor}"


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


def test_bars_in_docstrings_are_bars():
    escape = runpy.run_path(str(ROOT / "docs" / "site" / "conf.py"))["escape_bars"]
    lines = ["μN·v/|v|, ``a|b``::", "", "    c|d", "|e|"]
    escape(None, "", "", None, None, lines)
    assert lines == [r"μN·v/\|v\|, ``a|b``::", "", "    c|d", r"\|e\|"]
