"""What the documents say of the house is so: its paths and names, its floors, and the picture of them."""

import importlib.util
import re
import sys
from pathlib import Path
from xml.etree import ElementTree

import pytest

ROOT = Path(__file__).parents[1]
PAGES = [ROOT / name for name in ("docs/architecture.md", "CONTRIBUTING.md", "CHANGELOG.md")]
ARCHITECTURE, _, CHANGELOG = PAGES

PLACEHOLDER = re.compile(r"[A-Z]{3,}")
"""Stands for a name of one's own, as in compare/studies/GROUP/NAME/."""

PLACE = re.compile(r"(?:\.\w+|[\w.]+)(?:/[\w.]*)+|[A-Z]+\.md|pyproject\.toml")
DOTTED = re.compile(r"(?:reference_model|exudyn_models|fmu_models|compare)(?:\.\w+)+(?::\w+)?")


def spans(page):
    """Return what stands as code in the running text; what is to be typed may not be there yet."""
    text = re.sub(r"```.*?```", "", page.read_text("utf-8"), flags=re.DOTALL)
    return re.findall(r"`([^`\n]+)`", text)


def moved():
    """Return the rows of the changelog: old path, and the new ones."""
    rows = re.findall(r"^\| `([\w/.]+)` \| (.+) \|$", CHANGELOG.read_text("utf-8"), flags=re.MULTILINE)
    return [(old, re.findall(r"`([\w/.]+)`", new)) for old, new in rows]


OLD = {old for old, _ in moved()}


def mentioned(pattern):
    return sorted(
        {
            (page.name, span)
            for page in PAGES
            for span in spans(page)
            if pattern.fullmatch(span) and span not in OLD
        }
    )


@pytest.mark.parametrize(("page", "place"), mentioned(PLACE))
def test_a_path_in_a_document_is_there(page, place):
    parts = [part for part in place.split("/") if part]
    known = next((parts[:i] for i, part in enumerate(parts) if PLACEHOLDER.search(part)), parts)
    path = ROOT.joinpath(*known)
    assert path.exists()
    assert path.is_dir() or not place.endswith("/")


@pytest.mark.parametrize(("page", "name"), mentioned(DOTTED))
def test_a_dotted_name_in_a_document_can_be_imported(page, name):
    parts = re.split(r"[.:]", name)
    depth = max(i for i in range(1, len(parts) + 1) if _is_module(parts[:i]))
    thing = importlib.import_module(".".join(parts[:depth]))
    for part in parts[depth:]:
        thing = getattr(thing, part)


def _is_module(parts):
    try:
        return importlib.util.find_spec(".".join(parts)) is not None
    except ModuleNotFoundError:
        return False


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_links_lead_somewhere(page):
    links = re.findall(r"\]\(([^)#:]+)\)", page.read_text("utf-8"))
    assert links
    assert [link for link in links if not (page.parent / link).exists()] == []


@pytest.mark.parametrize(("old", "new"), moved())
def test_what_moved_is_where_the_changelog_says(old, new):
    assert new
    assert all((ROOT / path).exists() for path in new)


def test_each_change_has_one_place():
    text = ARCHITECTURE.read_text("utf-8").partition("## Where do I change")[2]
    rows = re.findall(r"^\| ([^|`]+) \| (.+) \|$", text, flags=re.MULTILINE)
    changes = [(what, place) for what, place in rows if what != "what"]
    assert len(changes) >= 15
    assert all(re.fullmatch(r"`[^`]+`", place) for _, place in changes)
    assert len({place for _, place in changes}) == len(changes)


@pytest.fixture(scope="module")
def floors():
    spec = importlib.util.spec_from_file_location("draw_floors", ROOT / "docs" / "draw_floors.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def test_every_import_leads_to_a_floor_below(floors):
    height = {
        f"{package}.{room}": -i
        for package, layers in floors.floors().items()
        for i, rooms in enumerate(layers)
        for room in rooms
    }
    pairs = floors.imports()
    assert {room for pair in pairs for room in pair} <= set(height)
    inside = [pair for pair in pairs if pair[0].split(".")[0] == pair[1].split(".")[0]]
    assert len(inside) > 50
    assert [(here, there) for here, there in inside if height[here] <= height[there]] == []


def test_the_picture_of_the_floors_is_drawn_from_these_imports(floors):
    description = "{http://purl.org/dc/elements/1.1/}description"
    (found,) = ElementTree.parse(floors.PICTURE).iter(description)
    assert found.text == floors.drawn_from(), f"run {Path(sys.executable).name} docs/draw_floors.py"
