"""Commands of README and docs run, expensive ones at a smaller size, and print the output that the page shows."""

import importlib.util
import re
import shlex
import shutil
import subprocess
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

BASIN = "friction-discs sweep basin pin --x x=-0.3:0.5:1000 --y vx=-0.4:0.4:1000"
SMALLER = (
    (r"^friction-discs sweep basin pin( --random .*)?$", BASIN),
    (r"^(friction-discs sweep map .*):64 (.*):64$", r"\1:2 \2:2"),
    (r"^(friction-discs sweep uncertainty .*)$", r"\1 --samples 256"),
    (r"^(friction-discs sweep continuation .*):100$", r"\1:2 --samples 4"),
    (r"^(friction-discs simulate .*)--until 100", r"\1--until 5"),
    (r"^friction-discs plan .*$", "friction-discs plan fig03 --output motions"),
    (r"^friction-discs report .*$", "friction-discs report --claim fig03/rests --engine reference --jobs 1"),
    (r"^friction-discs matrix .*$", "friction-discs matrix --engine mypackage.mymodule:simulate --recorded"),
    (r"(07_engine_under_pytest:euler)$", r"\1 -k 'equal and not range and not stop'"),
)
"""Replacements that make commands cheap; ``tests/compare/cli/test_help.py`` checks the arguments as printed."""


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


def run_of_ours(words, capsys):
    status = cli.status(words)
    output, errors = capsys.readouterr()
    assert (status, errors.count("Traceback")) == (0, 0), errors
    return output


def run_of_pytest(words, capsys, fully):
    options = ["-p", "no:cacheprovider", "-p", "no:xdist", "-p", "no:zarr", "-q"] + ["--collect-only"] * (
        not fully
    )
    assert pytest.main([*words, *options]) == int(fully)  # the engine of that page fails
    return capsys.readouterr().out


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


def compile_example(words):
    if shutil.which("cc") is None:
        pytest.skip("there is no C compiler")
    shutil.copy(ROOT / "examples" / "exec_pin.c", ".")
    subprocess.run(["cc", *words], check=True)


def check_dask(words):
    assert words[0] in {each.name for each in entry_points(group="dask_cli")}
    assert importlib.util.find_spec("s3fs")


OTHERS = {
    "python": check_script, "make": check_target, "pip": check_installation, "npm": check_modules,
    "cc": compile_example, "dask": check_dask,
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
    monkeypatch.setattr("compare.sweep.compute.run.CHECKED", 2)
    monkeypatch.setattr(
        "compare.sweep.figures.write_figures", lambda store, folder: ()
    )  # other tests draw them
    monkeypatch.syspath_prepend(ROOT / "examples")
    monkeypatch.syspath_prepend(tmp_path)


DONE = {}
"""Outputs of the commands that ran, so that none runs twice."""


def output_of(program, words, capsys, fully):
    """Run one command and return its output; a run of pytest only ``fully`` if a page shows its output."""
    if program == "friction-discs":
        return run_of_ours(words, capsys)
    if program == "pytest":
        return run_of_pytest(words, capsys, fully)
    if program in OTHERS:
        OTHERS[program](words)
    else:
        assert program in ("cd", "export") or (ROOT / program).exists()
    return ""


@pytest.mark.parametrize(("page", "lines", "shown"), COMMANDS, ids=lambda each: str(each)[:60])
def test_the_commands_of_a_page_run_and_print_what_the_page_shows(page, lines, shown, workplace, capsys):
    printed = ""
    for line in lines:
        for command in map(reduced, re.sub(r"\s+#.*| >.*", "", line).split(" && ")):
            program, *words = words_of(command)
            key = (program, *words)
            if key not in DONE:
                DONE[key] = " ".join(output_of(program, words, capsys, bool(shown)).split())
            printed += DONE[key]
    assert [each for each in shown if " ".join(each.split()) not in printed] == []


def test_the_pages_contain_commands_with_and_without_output():
    assert sum(len(lines) for _, lines, _ in COMMANDS) > 30
    assert sum(len(shown) for *_, shown in COMMANDS) > 5
