"""Build the site: ``python docs/site/build.py [FOLDER]``; a warning is an error.

The site contains the pages of ``docs/``, the changelog and the guide for contributors. A file of the repository
that a page links to becomes a page of code. ``pages.py`` writes the pages about the program, and includes the report
and its figures if ``report/`` contains one.
"""

from __future__ import annotations

import posixpath
import re
import shutil
import sys
import tempfile
from collections.abc import Iterator
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent))
import notebooks as gallery
import pages as pages_of_program

from compare.report.numbers import unbroken

ROOT = Path(__file__).parents[2]
DOCS = ROOT / "docs"
REPORT = ROOT / "report"

WHOLE = {"CONTRIBUTING.md": "contributing.md", "CHANGELOG.md": "changelog.md", "README.md": "index.md"}
"""Pages outside docs, with their names on the site. The site has its own start page instead of the README."""

LINK = re.compile(r"\]\((?!\w+:|#)([^)#\s]+)(#[^)\s]*)?\)")
CODE = re.compile(r"(^```.*?^```|`[^`\n]+`)", re.MULTILINE | re.DOTALL)
LANGUAGES = {".py": "python", ".c": "c", ".js": "javascript"}

SECTIONS = {
    "Tutorials": ("tutorial-judge", "tutorial-model", "tutorial-motions"),
    "Engines": ("judge-your-engine", "benchmark", "foreign-engines", "verdicts", "tolerance-tubes"),
    "Models": ("friction-in-your-own-model", "from-modelica", "fmu"),
    "Motions": ("findings", "equations", "sweeps"),
    "Look up": ("gallery", "glossary", "cite", "latest-report"),
    "Reference": (
        "commands",
        "api/tasks",
        "api/reference-model",
        "api/ensemble",
        "api/exudyn-models",
        "api/fmu-models",
        "api/compare",
    ),
    "Development": ("architecture", "modules", "benchmarks", "contributing", "changelog"),
}
"""Pages by section, in the order of the navigation."""

API = {
    "reference-model": ("reference_model",),
    "ensemble": ("reference_model.ensemble",),
    "exudyn-models": ("exudyn_models",),
    "fmu-models": ("fmu_models",),
    "compare": (
        "compare.engines.engine",
        "compare.claims.claim",
        "compare.claims.study",
        "compare.claims.measured",
        "compare.claims.error_estimates",
        "compare.output.figures",
    ),
}
"""Public modules by page."""

DATA = {"exudyn_models": ("exudyn_models.drivetrain.parameters.PASSENGER_CAR",)}
"""Public data by module, documented where it is defined."""


def gather(folder: Path) -> None:
    """Write all pages into a folder, ready for Sphinx."""
    pages = {path.name: _text(path) for path in DOCS.glob("*.md")}
    sources = {uri: f"docs/{uri}" for uri in pages}
    for name, uri in WHOLE.items():
        if uri not in pages:
            pages[uri], sources[uri] = _text(ROOT / name), name
    linked = {path for uri, text in pages.items() for path in _outside(text, sources[uri])}
    found = {uri: _unbroken(moved(text, sources[uri], uri)) for uri, text in pages.items()}
    found["index.md"] += _navigation()
    found["latest-report.md"] = pages_of_program.report(found["latest-report.md"])
    found["cite.md"] = pages_of_program.citation(found["cite.md"])
    notebooks = gallery.notebooks()
    found |= {f"notebooks/{name}.py": text for name, text in notebooks.items()}
    found["gallery.md"] = gallery.linked(found["gallery.md"], list(notebooks))
    found["commands.md"] = pages_of_program.commands()
    found["modules.md"] = pages_of_program.modules()
    found["benchmarks.md"] = pages_of_program.benchmarks()
    found["api/tasks.rst"] = pages_of_program.tasks()
    for uri in ("equations.md", "findings.md", "cite.md"):
        found[uri] = pages_of_program.linked_claims(found[uri])
    found |= {_page_of(path): _shown(path) for path in linked}
    found |= {f"api/{name}.rst": _reference(modules) for name, modules in API.items()}
    for uri, text in found.items():
        (folder / uri).parent.mkdir(parents=True, exist_ok=True)
        (folder / uri).write_text(text, encoding="utf-8")
    for picture in [*DOCS.glob("*.png"), *DOCS.glob("*.svg")]:
        shutil.copy(picture, folder)
    shutil.copytree(DOCS / "gallery", folder / "gallery")


def _text(path: Path) -> str:
    return path.read_text(encoding="utf-8")


def _repository_path(link: str, source: str) -> str:
    return posixpath.normpath(posixpath.join(posixpath.dirname(source), link))


def _outside(text: str, source: str) -> Iterator[str]:
    """Yield the files that a page links to and that are not pages of the site."""
    for link, _ in LINK.findall(text):
        path = _repository_path(link, source)
        if path not in WHOLE and not _is_of_docs(path) and (ROOT / path).is_file():
            yield path


def _is_of_docs(path: str) -> bool:
    """Return whether a file of the repository is a page or a figure of the site."""
    return posixpath.dirname(path) in ("docs", "docs/gallery") and not path.endswith(".py")


def _page_of(path: str) -> str:
    return f"source/{path}.md"


def moved(text: str, source: str, uri: str) -> str:
    """Return a page with its links changed from files of the repository to pages of the site."""

    def replaced(found: re.Match[str]) -> str:
        path = _repository_path(found[1], source)
        if path in WHOLE:
            to = WHOLE[path]
        elif _is_of_docs(path):
            to = path.removeprefix("docs/")
        elif (ROOT / path).is_file():
            to = _page_of(path)
        elif (ROOT / path).is_dir():
            to = "gallery.md"
        else:
            return found[0]  # Sphinx reports it
        return f"]({posixpath.relpath(to, posixpath.dirname(uri) or '.')}{found[2] or ''})"

    return LINK.sub(replaced, text)


def _unbroken(text: str) -> str:
    """Return a page with no-break spaces before units, except in code."""
    return "".join(part if i % 2 else unbroken(part) for i, part in enumerate(CODE.split(text)))


def _navigation() -> str:
    """Return the tables of contents for the navigation by Sphinx."""
    blocks = [
        f":caption: {caption}\n:hidden:\n:maxdepth: 1\n\n" + "\n".join(names)
        for caption, names in SECTIONS.items()
    ]
    return "".join(f"\n```{{toctree}}\n{block}\n```\n" for block in blocks)


def _shown(path: str) -> str:
    """Return a page with the code of a file."""
    language = LANGUAGES.get(Path(path).suffix, "text")
    return f"---\norphan: true\n---\n\n# {path}\n\n`````{language}\n{_text(ROOT / path).rstrip()}\n`````\n"


def _reference(modules: tuple[str, ...]) -> str:
    """Return a page of the reference, from docstrings."""
    title = modules[0].split(".")[0] if len(modules) > 1 else modules[0]
    lines = [title, "=" * len(title), ""]
    for module in modules:
        if len(modules) > 1:
            lines += [module, "-" * len(module), ""]
        lines += [f".. automodule:: {module}", "   :imported-members:" * (len(modules) == 1), ""]
        lines += [f".. autodata:: {name}\n   :no-value:\n" for name in DATA.get(module, ())]
    return "\n".join(lines)


def main(folder: Path) -> int:
    """Build the site into ``folder`` and return the exit status."""
    from sphinx.cmd.build import build_main

    with tempfile.TemporaryDirectory() as place:
        pages, built = Path(place, "pages"), Path(place, "site")
        gather(pages)
        shutil.copy(Path(__file__).with_name("conf.py"), pages)
        footer = f"copyright=2026, the friction-discs maintainers. {pages_of_program.footer()}"
        options = ["-W", "--keep-going", "-q", "-b", "html", "-D", footer, str(pages), str(built)]
        status = build_main(options)
        executed = Path(place, "jupyter_execute", "notebooks")  # next to the site, by myst-nb
        shutil.copytree(executed, built / "notebooks", dirs_exist_ok=True)
        shutil.rmtree(folder, ignore_errors=True)
        shutil.copytree(built, folder)
    if not status and (REPORT / "index.html").exists():
        shutil.copytree(REPORT, folder / "report", dirs_exist_ok=True)
    if not status and pages_of_program.PAPER.exists():
        shutil.copy(pages_of_program.PAPER, folder)
    return status


if __name__ == "__main__":
    sys.path.insert(0, str(ROOT))
    sys.exit(main(Path(sys.argv[1] if len(sys.argv) > 1 else ROOT / "site").resolve()))
