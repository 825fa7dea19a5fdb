"""Examples in help texts and documents are valid commands."""

import re
import shlex
from dataclasses import asdict

import pytest
import typer
from processes import ROOT

import compare.cli.sweep.run
import compare.run.runner
import compare.run.workers
import compare.sweep.files
from compare.claims.errata import ERRATA
from compare.claims.parameters import FIG5, FIG11
from compare.cli import app as cli
from compare.engines import INSTALLED, Engine, known_name
from compare.run.plan import write_plan
from compare.sweep.store import SweepStore
from fmu_models import MODELS
from reference_model.systems import PARAMETERS

COMMAND = "friction-discs "


def help_texts(command=None, path="friction-discs"):
    command = command or typer.main.get_command(cli.app)
    yield path, command.help
    for name, part in getattr(command, "commands", {}).items():
        yield from help_texts(part, f"{path} {name}")


def examples(text):
    found, margin = [], None
    for line in text.splitlines():
        indent = len(line) - len(line.lstrip())
        if line.lstrip().startswith(COMMAND):
            found.append(line.strip())
            margin = indent
        elif margin is not None and line.strip() and indent > margin:
            found[-1] += f" {line.strip()}"
        else:
            margin = None
    return found


def code(document):
    return "\n".join(re.findall(r"```\w*\n(.*?)```", document.read_text(), re.DOTALL))


HELP = [(name, example) for name, text in help_texts() for example in examples(text)]
DOCUMENTS = [
    (path.name, example)
    for path in (ROOT / "README.md", *sorted((ROOT / "docs").glob("*.md")))
    for example in examples(code(path))
] + [
    ("ci-workflow.yml", example.partition(" ||")[0])
    for example in examples((ROOT / "docs" / "ci-workflow.yml").read_text(encoding="utf-8"))
]


class Understood(BaseException):
    """The arguments are valid."""


@pytest.fixture
def idle(monkeypatch, tmp_path):

    def stop(*arguments, **options):
        raise Understood

    monkeypatch.chdir(tmp_path)
    (tmp_path / "motions").mkdir()
    write_plan(tmp_path / "motions", ["pin"], [])  # the plan of a document
    monkeypatch.setattr(compare.run.runner, "run", stop)
    monkeypatch.setattr(compare.run.workers.Workers, "finished", stop)
    monkeypatch.setattr(Engine, "simulate", stop)
    monkeypatch.setattr(compare.cli.sweep.run, "_executor", stop)
    monkeypatch.setattr(compare.sweep.files.Files, "write", stop)
    monkeypatch.setattr("reference_model.smallest_shock", stop)
    monkeypatch.setattr("fmu_models.export", stop)
    monkeypatch.setattr("compare.report.results_json.read_results", stop)
    monkeypatch.setattr(SweepStore, "open", stop)
    monkeypatch.setattr("compare.claims.errata.ERRATA", ERRATA[:1])


def at_hand(arguments):
    """Replace engines that may not be installed."""
    ours = iter(("reference", "exudyn"))
    return [
        next(ours)
        if argument.startswith(("exec:", "mypackage.mymodule:"))
        or (argument.partition(":")[0] in INSTALLED and known_name(argument))
        else argument
        for argument in arguments
    ]


@pytest.mark.parametrize(
    ("where", "example"), [pytest.param(*pair, id=": ".join(pair)) for pair in HELP + DOCUMENTS]
)
def test_an_example_is_valid(where, example, idle, capsys):
    arguments = at_hand(shlex.split(example, comments=True)[1:])
    try:
        status = cli.status(arguments)
    except Understood:
        return
    output, errors = capsys.readouterr()
    assert (status, errors) == (0, "")
    assert output
    assert arguments[0] in ("list", "errata") or arguments[-1] == "--help"


def test_every_command_has_its_own_example():
    assert {name for name, _ in HELP} == {name for name, _ in help_texts()}
    for name, example in HELP:
        assert example.startswith(name) or name == "friction-discs"
    assert len(DOCUMENTS) > 10


def parameters_of(command):
    """Return default and unit of each parameter."""
    if command == "export-fmu clutch":
        units = str.maketrans({".": " ", "3": "³"})  # FMI writes N.s/m and N/m3
        parameters = [one for one in MODELS["clutch"].variables if one.role == "parameter"]
        return {one.name: (one.start, one.unit.translate(units)) for one in parameters}
    system = FIG5 if command == "simulate pin" else FIG11
    units = {name: unit for name, unit, _ in PARAMETERS[type(system)]}
    return {name: (value, units.get(name, "")) for name, value in asdict(system).items()}


@pytest.mark.parametrize("command", ["simulate pin", "simulate disc", "export-fmu clutch"])
def test_help_lists_each_parameter_with_default_and_unit(command):
    text = dict(help_texts())[COMMAND + command].partition("Parameters, ")[2].partition("Example")[0]
    listed = re.findall(r"(\w+)=(\S+)(?: \(([^)]+)\))?", text)
    found = {name: (None if value == "none" else float(value), unit) for name, value, unit in listed}
    assert found == parameters_of(command)
