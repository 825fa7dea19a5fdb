"""Commands of README and docs print the output that the page shows; the others are valid.

``tests/compare/cli/test_help.py`` checks the arguments of ``friction-discs``.
"""

import importlib.util
import re
import shlex
import tomllib
from importlib.metadata import entry_points
from pathlib import Path

import pytest

from compare.cli import app as cli
from compare.engines import INSTALLED

ROOT = Path(__file__).parents[2]
PAGES = [ROOT / "README.md", ROOT / "CONTRIBUTING.md", *sorted((ROOT / "docs").glob("*.md"))]
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]

BLOCK = re.compile(r"(?ms)^ *```(\w*)\n(.*?)^ *```")
PROGRAMS = (
    *("friction-discs", "pytest", "python", "make", "pip", "npm", "cc", "cd", "dask", "export"),
    ".ci/run",
)
DATA = ("{", '"offset"', '"state"', "t [s]", "0.", "...")
"""Beginnings of messages and files, which tests/compare/engines/outside checks."""

SMALLER = (
    (r"^friction-discs report .*$", "friction-discs report --claim fig03/rests --engine reference --jobs 1"),
    (r"^friction-discs matrix .*$", "friction-discs matrix --engine mypackage.mymodule:simulate --recorded"),
    (r"^(pytest .* --engine mypackage.*)$", r"\1 --collect-only"),
    (r"(07_engine_under_pytest:euler)$", r"\1 -k 'equal and not range and not stop'"),
)
"""Replacements that make commands cheap without changing the output that the pages show."""


def blocks(page):
    commands, shown = [], []
    for language, block in BLOCK.findall(page.read_text(encoding="utf-8")):
        lines = [line.strip() for line in block.splitlines() if not language and line.strip()]
        typed = [line for line in lines if line.startswith(PROGRAMS)]
        if typed and commands:
            yield page.name, commands, shown
            commands, shown = [], []
        commands += typed
        shown += [line for line in lines if line not in typed and commands and not line.startswith(DATA)]
    if commands:
        yield page.name, commands, shown


COMMANDS = [each for page in PAGES for each in blocks(page)]


def reduced(line):
    for pattern, replacement in SMALLER:
        line = re.sub(pattern, replacement, line)
    return line


def words_of(line):
    """Return the words of a command with the reference in place of programs and engines that may be missing."""
    absent = ("exec:", "fmu:", "files:", *INSTALLED)
    words = shlex.split(line, comments=True)
    return tuple("reference" if word.startswith(absent) else word for word in words)


def check_script(words):
    folders = (ROOT, ROOT / "examples", ROOT / "compare" / "diagnosis")
    path = next(folder / words[0] for folder in folders if (folder / words[0]).exists())
    assert path.suffix == ".py"


def check_target(words):
    assert words == [] or re.search(rf"^{words[0]}:", (ROOT / "Makefile").read_text("utf-8"), re.MULTILINE)


def check_installation(words):
    extras = re.fullmatch(r"\.(?:\[([\w,]+)\])?", words[-1])
    assert words[0] == "install"
    assert extras, f"{words[-1]} is not in a package index: install . or .[EXTRA]"
    assert set((extras[1] or "").split(",")) <= {"", *PROJECT["optional-dependencies"]}


def check_modules(words):
    source = (ROOT / "examples" / "exec_contact.js").read_text(encoding="utf-8")
    assert all(f'"{name}"' in source for name in words[1:])


def check_sources(words):
    assert all((ROOT / "examples" / word).exists() for word in words if word.endswith(".c"))


def check_dask(words):
    assert words[0] in {each.name for each in entry_points(group="dask_cli")}
    assert importlib.util.find_spec("s3fs")


OTHERS = {
    "python": check_script, "make": check_target, "pip": check_installation, "npm": check_modules,
    "cc": check_sources, "dask": check_dask,
}  # fmt: skip


@pytest.fixture
def workplace(tmp_path, monkeypatch, in_this_process):
    """Change to an empty folder. The examples and the engine of the tutorial can be imported there."""
    page = (ROOT / "docs" / "tutorial-judge.md").read_text(encoding="utf-8")
    engine = next(code for code in re.findall(r"(?s)```python\n(.*?)```", page) if "def simulate" in code)
    (tmp_path / "mypackage").mkdir()
    for name in ("mymodule.py", "mypackage/mymodule.py"):
        (tmp_path / name).write_text(engine, encoding="utf-8")
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr("compare.sweep.compute.run.CHECKED", 1)
    for drawn in ("compare.sweep.figures.write_figures", "compare.diagnosis.row.write_pictures"):
        monkeypatch.setattr(drawn, lambda *_: ())  # other tests draw them
    monkeypatch.syspath_prepend(ROOT / "examples")
    monkeypatch.syspath_prepend(tmp_path)


def output_of(program, words, capsys, shown):
    """Return the output of a command that a page shows; only check other commands."""
    if program == "friction-discs":
        status = cli.status(words) if shown else 0
        output, errors = capsys.readouterr()
        assert (status, errors.count("Traceback")) == (0, 0), errors
        return output
    if program == "pytest":
        options = [*words, "-p", "no:cacheprovider", "-p", "no:xdist", "-p", "no:zarr", "-q"]
        options += [] if shown else ["--collect-only"]
        # the engine of the page that shows the output fails
        assert pytest.main(options) == int("--collect-only" not in options)
        return capsys.readouterr().out
    if program in OTHERS:
        OTHERS[program](words)
    else:
        assert program in ("cd", "export") or (ROOT / program).exists()
    return ""


@pytest.mark.parametrize(("page", "lines", "shown"), COMMANDS, ids=lambda each: str(each)[:60])
def test_the_commands_of_a_page_are_valid_and_print_what_it_shows(page, lines, shown, workplace, capsys):
    printed = ""
    for line in lines:
        for command in map(reduced, re.sub(r"\s+#.*| >.*", "", line).split(" && ")):
            program, *words = words_of(command)
            printed += " ".join(output_of(program, words, capsys, bool(shown)).split())
    assert [each for each in shown if " ".join(each.split()) not in printed] == []


def test_the_pages_contain_commands_with_and_without_output():
    assert sum(len(lines) for _, lines, _ in COMMANDS) > 30
    assert sum(len(shown) for *_, shown in COMMANDS) > 5
