"""Texts refer only to existing paths, headings, modules, functions, options, equations and figures."""

import ast
import functools
import importlib.util
import re
import sys
from itertools import chain
from pathlib import Path
from xml.etree import ElementTree

import typer

from compare.cli.app import app
from compare.studies import STUDIES

ROOT = Path(__file__).parents[1]
PACKAGES = ("reference_model", "exudyn_models", "fmu_models", "compare")
PAGES = [*ROOT.glob("*.md"), *sorted((ROOT / "docs").glob("*.md"))]
SOURCES = [path for package in PACKAGES for path in sorted((ROOT / package).rglob("*.py"))]
WORKFLOWS = sorted((ROOT / ".github" / "workflows").glob("*.yml"))
ARCHITECTURE = ROOT / "docs" / "architecture.md"

MOST = {"section": 5, "figure": 11, "equation": 26}
"""Numbers of sections, figures and equations in the paper."""

PLACEHOLDER = re.compile(r"[A-Z]{3,}")
"""Placeholder for a name that the reader chooses, as in compare/studies/GROUP/NAME/."""

PLACE = re.compile(
    rf"(?:(?:{'|'.join(PACKAGES)}|tests|docs|examples|builders|benchmarks|\.ci)(?:/[\w.-]*)+|[A-Z]+\.md)"
)
LINK = re.compile(r"\]\((?!\w+:|#)([^)#\s]+)(#[^)\s]*)?\)")
DOTTED = re.compile(rf"(?:{'|'.join(PACKAGES)})(?:\.\w+)+(?::\w+)?")
OPTION = re.compile(r"(?<![\w-])--[a-z][a-z-]+")

OF_OTHERS = {
    *("--pyargs", "--junit-xml", "--lf"),
    *("--study", "--engine", "--level", "--study-limit", "--min-conclusive"),
    "--view",
}
"""Options of pytest, of our pytest plugin, and of an example."""


@functools.cache
def text_of(path):
    return path.read_text(encoding="utf-8")


def spans(page):
    return re.findall(r"`([^`\n]+)`", re.sub(r"```.*?```", "", text_of(page), flags=re.DOTALL))


def anchors(path):
    """Return the anchors of a page's headings."""
    headings = re.findall(r"^#+ (.*)$", text_of(path), re.MULTILINE)
    return {re.sub(r"[^\w\- ]", "", heading).strip().lower().replace(" ", "-") for heading in headings}


def paths():
    """Yield the file, the path and the anchor of each reference in a page or a workflow."""
    for page in PAGES:
        for place in filter(PLACE.fullmatch, spans(page)):
            parts = place.rstrip("/").split("/")
            known = next((parts[:i] for i, part in enumerate(parts) if PLACEHOLDER.search(part)), parts)
            yield page, ROOT.joinpath(*known), ""
        for link, anchor in LINK.findall(text_of(page)):
            yield page, page.parent / link, anchor[1:]
    for workflow in WORKFLOWS:
        for name in re.findall(r"[\w./-]+\.(?:txt|py)\b", text_of(workflow)):
            yield workflow, ROOT / name, ""


def test_paths_and_headings_exist():
    found = list(paths())
    assert len(found) > 200
    assert [
        (file.name, str(path), anchor)
        for file, path, anchor in found
        if not path.exists() or (anchor and anchor not in anchors(path))
    ] == []


def test_documents_that_code_names_exist():
    names = {path.name for path in ROOT.rglob("*.md") if ".venv" not in path.parts}
    for path in (*SOURCES, *PAGES, *sorted((ROOT / "tests").rglob("*.py"))):
        for name in re.findall(r"[\w./-]+\.md\b", text_of(path)):
            assert Path(name).name in names or path == Path(__file__), f"{path.name}: {name}"


@functools.cache
def found(name):
    """Return whether a dotted name, as "package.module.Class.method", can be imported."""
    parts = re.split(r"[.:]", name)
    depth = max((i for i in range(1, len(parts) + 1) if is_module(parts[:i])), default=0)
    return depth > 0 and has(importlib.import_module(".".join(parts[:depth])), parts[depth:])


def is_module(parts):
    try:
        return importlib.util.find_spec(".".join(parts)) is not None
    except ModuleNotFoundError:
        return False


def has(thing, parts):
    for part in parts:
        if not hasattr(thing, part) and part not in getattr(thing, "__annotations__", ()):
            return False
        thing = getattr(thing, part, None)
    return True


def options(command):
    for parameter in command.params:
        yield from parameter.opts
    for subcommand in getattr(command, "commands", {}).values():
        yield from options(subcommand)


def test_options_in_documents_exist():
    of_builder = OPTION.findall(text_of(ROOT / "builders" / "record.py"))
    known = {*options(typer.main.get_command(app)), "--help", *of_builder} | OF_OTHERS
    named = {option for page in PAGES for span in spans(page) for option in OPTION.findall(span)}
    assert len(named) > 15
    assert named - known == set()


@functools.cache
def nodes_of(path):
    return tuple(ast.walk(ast.parse(text_of(path))))


def names():
    """Yield module, class and name of each :role:`name` and dotted name in a docstring or a page."""
    for path in SOURCES:
        module = ".".join(path.relative_to(ROOT).with_suffix("").parts).removesuffix(".__init__")
        for node in nodes_of(path):
            if isinstance(node, ast.Module | ast.ClassDef | ast.FunctionDef):
                text = ast.get_docstring(node) or ""
                scope = [node.name] if isinstance(node, ast.ClassDef) else []
                for name in re.findall(r":(?:mod|class|func|meth|attr):`~?([^`]+)`", text):
                    yield module, scope, name
                for name in filter(DOTTED.fullmatch, re.findall(r"``([^`\n]+)``", text)):
                    yield module, [], name
    for page in PAGES:
        for name in filter(DOTTED.fullmatch, spans(page)):
            yield "compare", [], name


def resolves(module, scope, name):
    """Return whether a name is known in its class, its module, or a package around it."""
    parts = name.lstrip(".").split(".")
    here = importlib.import_module(module)
    classes = [thing for thing in vars(here).values() if isinstance(thing, type)]
    if has(here, parts) or has(here, [*scope, *parts]) or any(has(each, parts) for each in classes):
        return True
    around = module.split(".")
    return any(found(".".join([*around[:i], *parts])) for i in range(len(around) + 1))


def test_names_in_docstrings_and_pages_exist():
    everything = list(names())
    assert len(everything) > 100
    assert [(module, name) for module, scope, name in everything if not resolves(module, scope, name)] == []


# --- The paper


def numbers(pattern, text):
    """Return the numbers of a list such as "2, 3", "14 to 16" or "11–16" in the group of ``pattern``."""
    return [int(number) for found in re.finditer(pattern, text) for number in re.findall(r"\d+", found[1])]


LIST = r"(\d+(?:(?:, | and | to |–)\d+)*)(?![\d.]*\d)"
CITED = {
    "section": rf"\b[Ss]ections? {LIST}",
    "figure": rf"\bFigs?\. {LIST}",
    "equation": rf"\b[Ee]qs?\. {LIST}",
}


def test_cited_sections_figures_and_equations_are_in_the_paper():
    for kind, pattern in CITED.items():
        cited = [(path.name, n) for path in (*SOURCES, *PAGES) for n in numbers(pattern, text_of(path))]
        assert len(cited) > 5
        assert [each for each in cited if not 1 <= each[1] <= MOST[kind]] == []


def equations_of_claims():
    keywords = (node for path in SOURCES for node in nodes_of(path) if isinstance(node, ast.keyword))
    for each in chain.from_iterable(ast.walk(node.value) for node in keywords if node.arg == "equation"):
        if isinstance(each, ast.Constant) and isinstance(each.value, str) and "(" in each.value:
            yield each.value


def test_equations_of_claims_and_of_texts_of_studies_are_in_the_paper():
    equations = list(equations_of_claims())
    assert len(equations) > 60
    for equation in equations:
        assert re.fullmatch(r"\(\d+\)(?:(?:, |–)\(\d+\))*(?:, [a-z ]+)?", equation), equation
    texts = (
        text
        for study in STUDIES
        for text in (study.title, study.prose.paper, study.prose.finding, *study.figures.values())
    )
    for text in (*equations, *texts):
        assert all(1 <= number <= MOST["equation"] for number in numbers(r"\((\d+)\)", text)), text


# --- The style of units


def test_no_unit_is_changed_by_the_case_of_a_sentence():
    """``str.capitalize`` turns "0.5 N/m³" into "0.5 n/m³"."""
    for path in SOURCES:
        for node in nodes_of(path):
            if isinstance(node, ast.Call) and isinstance(node.func, ast.Attribute):
                assert node.func.attr not in ("capitalize", "swapcase") or node.args, path


def test_a_space_separates_a_percentage_from_its_sign():
    """A space separates the number, as for any unit; Python's own format writes "1%"."""
    for path in (*SOURCES, *PAGES):
        assert not re.findall(r":[.\d]*%\}", text_of(path)), path
        assert path not in PAGES or not re.findall(r"\d%(?!\w)", text_of(path)), path


# --- The architecture


def test_each_change_has_one_place():
    text = text_of(ARCHITECTURE).partition("## Where do I change")[2]
    rows = re.findall(r"^\| ([^|`]+) \| (.+) \|$", text, flags=re.MULTILINE)
    changes = [(what, place) for what, place in rows if what != "what"]
    assert len(changes) >= 15
    assert all(re.fullmatch(r"`[^`]+`", place) for _, place in changes)
    assert len({place for _, place in changes}) == len(changes)


def test_the_picture_of_the_layers_is_drawn_from_these_imports():
    spec = importlib.util.spec_from_file_location("draw_layers", ROOT / "docs" / "draw_layers.py")
    layers = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(layers)
    description = "{http://purl.org/dc/elements/1.1/}description"
    (drawn,) = ElementTree.parse(layers.PICTURE).iter(description)
    assert drawn.text == layers.drawn_from(), f"run {Path(sys.executable).name} docs/draw_layers.py"
