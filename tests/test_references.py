"""Documents and docstrings name only existing paths, links, modules, functions and options; layers are as drawn."""

import ast
import importlib.util
import re
import sys
from pathlib import Path
from xml.etree import ElementTree

import pytest
import typer

from compare.cli.app import app

ROOT = Path(__file__).parents[1]
PAGES = [ROOT / name for name in ("README.md", "CONTRIBUTING.md", "CHANGELOG.md")]
PAGES += sorted((ROOT / "docs").glob("*.md"))
ARCHITECTURE = ROOT / "docs" / "architecture.md"
PACKAGES = ("reference_model", "exudyn_models", "fmu_models", "compare")

PLACEHOLDER = re.compile(r"[A-Z]{3,}")
"""Placeholder for a name that the reader chooses, as in compare/studies/GROUP/NAME/."""

PLACE = re.compile(
    rf"(?:(?:{'|'.join(PACKAGES)}|tests|docs|examples|builders|benchmarks|\.ci)(?:/[\w.-]*)+|[A-Z]+\.md)"
)
DOTTED = re.compile(rf"(?:{'|'.join(PACKAGES)})(?:\.\w+)+(?::\w+)?")
OPTION = re.compile(r"(?<![\w-])--[a-z][a-z-]+")

OF_OTHERS = {
    "--pyargs",
    "--junit-xml",
    "--lf",
    "--study",
    "--engine",
    "--level",
    "--study-limit",
    "--min-conclusive",
    "--view",
}
"""Options of pytest, of our pytest plugin, and of an example."""


def spans(page):
    text = re.sub(r"```.*?```", "", page.read_text("utf-8"), flags=re.DOTALL)
    return re.findall(r"`([^`\n]+)`", text)


def mentioned(pattern):
    return sorted({(page.name, span) for page in PAGES for span in spans(page) if pattern.fullmatch(span)})


@pytest.mark.parametrize(("page", "place"), mentioned(PLACE))
def test_a_path_in_a_document_is_there(page, place):
    parts = [part for part in place.split("/") if part]
    known = next((parts[:i] for i, part in enumerate(parts) if PLACEHOLDER.search(part)), parts)
    path = ROOT.joinpath(*known)
    assert path.exists()
    assert path.is_dir() or not place.endswith("/")


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


def test_a_dotted_name_in_a_document_can_be_imported():
    names = mentioned(DOTTED)
    assert len(names) > 5
    assert [(page, name) for page, name in names if not found(name)] == []


def options(command):
    for parameter in command.params:
        yield from parameter.opts
    for subcommand in getattr(command, "commands", {}).values():
        yield from options(subcommand)


def test_options_in_documents_exist():
    of_builder = OPTION.findall((ROOT / "builders" / "record.py").read_text("utf-8"))
    known = {*options(typer.main.get_command(app)), "--help", *of_builder} | OF_OTHERS
    named = {option for page in PAGES for span in spans(page) for option in OPTION.findall(span)}
    assert len(named) > 15
    assert named - known == set()


def references():
    """Yield the module and the name of each :role:`name` and of each dotted name in a docstring."""
    for path in (path for package in PACKAGES for path in sorted((ROOT / package).rglob("*.py"))):
        module = ".".join(path.relative_to(ROOT).with_suffix("").parts).removesuffix(".__init__")
        tree = ast.parse(path.read_text("utf-8"))
        for node in ast.walk(tree):
            if isinstance(node, ast.Module | ast.ClassDef | ast.FunctionDef):
                text = ast.get_docstring(node) or ""
                scope = [node.name] if isinstance(node, ast.ClassDef) else []
                for name in re.findall(r":(?:mod|class|func|meth|attr):`~?([^`]+)`", text):
                    yield module, scope, name
                for name in re.findall(r"``([^`\n]+)``", text):
                    if DOTTED.fullmatch(name):
                        yield module, [], name


def resolves(module, scope, name):
    """Return whether a docstring's name is known in its class, its module, or a package around it."""
    parts = name.lstrip(".").split(".")
    here = importlib.import_module(module)
    classes = [thing for thing in vars(here).values() if isinstance(thing, type)]
    if has(here, parts) or has(here, [*scope, *parts]) or any(has(each, parts) for each in classes):
        return True
    around = module.split(".")
    return any(found(".".join([*around[:i], *parts])) for i in range(len(around) + 1))


def test_names_in_docstrings_exist():
    everything = list(references())
    assert len(everything) > 100
    assert [(module, name) for module, scope, name in everything if not resolves(module, scope, name)] == []


def test_each_change_has_one_place():
    text = ARCHITECTURE.read_text("utf-8").partition("## Where do I change")[2]
    rows = re.findall(r"^\| ([^|`]+) \| (.+) \|$", text, flags=re.MULTILINE)
    changes = [(what, place) for what, place in rows if what != "what"]
    assert len(changes) >= 15
    assert all(re.fullmatch(r"`[^`]+`", place) for _, place in changes)
    assert len({place for _, place in changes}) == len(changes)


@pytest.fixture(scope="module")
def layers():
    spec = importlib.util.spec_from_file_location("draw_layers", ROOT / "docs" / "draw_layers.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def test_the_picture_of_the_layers_is_drawn_from_these_imports(layers):
    description = "{http://purl.org/dc/elements/1.1/}description"
    (found,) = ElementTree.parse(layers.PICTURE).iter(description)
    assert found.text == layers.drawn_from(), f"run {Path(sys.executable).name} docs/draw_layers.py"
