"""Output, files and exit statuses of ``friction-discs report``."""

import json
import os
import sys
from dataclasses import replace

import fake_studies as fake
import pytest

from compare.claims.measured import Measured
from compare.claims.prose import Prose
from compare.claims.study import Findings, Study
from compare.cli import app as cli
from compare.engines import registry
from compare.run.runner import Run

HOSTILE = """
from compare.engines import UnsupportedSystemError
def refusing(*arguments, **accuracy):
    raise UnsupportedSystemError('nothing')
"""


def measure_with_another(engine):
    independent = fake.measure_agreement(engine).claims
    implied = fake.claim("It follows", engine.name, 0.5, 0.5, 0.0, implied_by=independent[0].sentence)
    return Findings((*independent, implied))


def itself(engine, value):
    return value and Measured(predicted=value, value=value, error=0.0)


OF_ANOTHER = replace(fake.AGREEMENT, name="of-another", only=("exudyn",))
THEORY = {"theory": fake.theory_of_verdicts}
BOTH = fake.fake("both", "Both", "Half.", measure_with_another, provided=THEORY)
SILENT = Study("silent", Prose("A study with nothing to measure"))
SILENT.claim("{} is itself", resolution=1.0, each={"One": None, "Two": 2.0})(itself)
STUDIES = (*fake.ALL, fake.ASKING, OF_ANOTHER, BOTH, SILENT)


@pytest.fixture
def folder(tmp_path, monkeypatch):
    """Change to an empty folder, where the engine "good" is registered."""
    (tmp_path / "hostile.py").write_text(HOSTILE)
    (tmp_path / "exiting.py").write_text("import os\nos._exit(0)")
    monkeypatch.chdir(tmp_path)
    monkeypatch.syspath_prepend(tmp_path)
    monkeypatch.setattr(registry, "_REGISTRY", {"good": fake.GOOD})
    return tmp_path


@pytest.fixture
def report(folder, in_this_process):
    return lambda arguments, studies=STUDIES: cli.status(
        ["report", "--jobs", "1", *arguments.split()], studies
    )


def results_in(folder):
    return json.loads((folder / "results.json").read_text(encoding="utf-8"))


def studies_in(folder):
    return [study["name"] for study in results_in(folder)["studies"]]


def test_a_report_that_differs_ends_with_status_1(reported):
    process, folder = reported
    assert process.returncode == 1
    assert "\r" not in process.stderr  # no progress bar without a terminal
    assert "verdicts good differs: The equilibrium is lost at the load of eq. (5)" in process.stdout
    gave_up = "the step size became too small at t = 3.2 s: try a larger tolerance (fake_studies.py:"
    assert process.stdout.count(f"verdicts failing failed: {gave_up}") == 1
    first = "4 checks against independent evidence and 1 other agree, 1 differs, 1 inconclusive, 4 failed"
    totals, *diagnoses = process.stdout.partition(first)[2].splitlines()
    assert totals == f" ({folder / 'index.html'})"
    assert [line.partition(":")[0] for line in diagnoses] == ["good", "failing"]
    assert diagnoses[1].startswith(
        "failing: Engine failed: no result for law: the step size became too small"
    )


MEASURED = "check against independent evidence"
LACKS = "good does not simulate a disc on single points or a disc on a continuous ring"
NOTHING = "too little to show anything: {}: nothing was measured, because no claim applies\n"
SHARE = "good: measured {} of {} claims ({} %)\n"
REPORTS = [
    (
        "inconclusive",
        3,
        f"{SHARE.format(0, 1, 0)}0 checks against independent evidence agree, 0 differ, 1 inconclusive (",
    ),
    (
        "partly",
        0,
        f"partly good not simulated: {LACKS}\n{SHARE.format(1, 1, 100)}1 {MEASURED} agrees, 0 differ, "
        "0 inconclusive, 1 not simulated (",
    ),
    ("undrawable", 0, "undrawable: the figures could not be drawn: KeyError: 'radius'"),
    ("asking --engine hostile:refusing", 3, NOTHING.format("hostile:refusing")),
    ("asking --engine good --engine hostile:refusing", 3, NOTHING.format("hostile:refusing")),
    ("of-another --engine good", 3, NOTHING.format("good")),
    (
        "both --min-conclusive 2",
        0,
        f"{SHARE.format(2, 2, 100)}1 {MEASURED} and 2 others agree, ",
    ),
    ("both --min-conclusive 3", 3, "2 claims agree, but --min-conclusive requires 3\n"),
    ("silent --engine good", 1, "silent good failed: the motion does not allow this measurement\n"),
]


@pytest.mark.parametrize(("arguments", "status", "said"), REPORTS, ids=[row[0] for row in REPORTS])
def test_arguments_give_status_totals_and_a_report(arguments, status, said, report, folder, capsys):
    assert report(arguments) == status
    assert f"\n{said}" in "\n" + "\n".join(capsys.readouterr())
    assert (folder / "report-part" / "index.html").exists()


def test_an_engine_that_ends_its_process_leaves_no_report(folder):
    assert cli.status(["report", "asking", "--jobs", "1", "--engine", "exiting:simulate"], STUDIES) == 2
    assert not (folder / "report-part").exists()


def test_a_report_without_differences_prints_its_totals_and_nothing_else(report, folder, capsys):
    assert report("--level quick --engine good --output new/folder", fake.ALL) == 0
    page = os.path.join("new", "folder", "index.html")
    assert capsys.readouterr() == (
        f"{SHARE.format(1, 1, 100)}1 {MEASURED} agrees, 0 differ, 0 inconclusive ({page})\n",
        "",
    )
    assert studies_in(folder / "new" / "folder") == ["agreement"]


def test_on_a_terminal_there_is_a_progress_bar(report, monkeypatch, capsys):
    monkeypatch.setenv("TERM", "xterm")
    monkeypatch.setattr(sys.stderr, "isatty", lambda: True)
    assert report("agreement") == 0
    shown = capsys.readouterr().err
    assert "2/2" in shown
    assert "0/100" not in shown


def test_missing_measurements_are_listed_once_at_the_end(report, monkeypatch, capsys):
    names = tuple(f"engine-{i}" for i in range(20))
    limits = []

    def interrupted(studies, engines, *, limit, **more):
        limits.append(limit)
        found = {("verdicts", "theory"): Findings((fake.claim("A claim", "theory", 0.0, 1.0, 0.1),))}
        return Run(studies, names, outcomes=found, seconds={("verdicts", "theory"): 1.0}, interrupted=True)

    monkeypatch.setattr("compare.run.runner.run", interrupted)
    assert report("verdicts") == 130
    out, err = capsys.readouterr()
    assert out.splitlines()[0] == "verdicts theory differs: A claim"
    assert len(out.splitlines()) == 2
    listed = ", ".join(f"verdicts engine-{i}" for i in range(10))
    assert err.startswith(
        f"Interrupted; still missing: {listed} and 10 more. Repeat the command with --resume"
    )
    assert report("verdicts --study-limit 2.5") == 130
    assert limits == [None, 2.5]


def test_a_partial_report_does_not_replace_the_full_one(report, folder, capsys):
    studies = (fake.AGREEMENT, fake.PARTLY)
    assert report("", studies) == 0
    for part in ("partly", "--level quick", "--engine good"):
        assert report(part, studies) == 0
        assert studies_in(folder / "report") == ["agreement", "partly"]
    assert studies_in(folder / "report-part") == ["agreement", "partly"]
    capsys.readouterr()
    for part in ("partly", "--level quick", "--engine fake_studies:straight"):
        assert report(f"{part} --output report", studies) == 2
        assert capsys.readouterr().err == (
            "report contains a full report; choose another --output, or replace the report with --replace\n"
        )
    assert studies_in(folder / "report") == ["agreement", "partly"]
    assert report("--engine good --output report", studies) == 0  # measures it all again
    assert report("partly --output report --replace", studies) == 0
    assert studies_in(folder / "report") == ["partly"]
    assert report("agreement --output report", studies) == 0  # it was partial


DECLARED = Study("declared", Prose("Claims that are declared"), quick=True)


@DECLARED.claim("One is one", unit="m", resolution=1.0)
def one(engine):
    return Measured(predicted=1.0, value=1.0, error=0.0)


@DECLARED.claim("It is {}", unit="m, rad", resolution=1.0, each={"Small one": 1e-9, "large": 1.0})
def of_size(engine, size):
    return Measured(
        predicted=[size, 1.0], value=[size, 2.0], error=0.1, components=("x in m", "angle in rad")
    )


def test_one_claim_of_a_family_is_measured_alone_and_its_numbers_printed(report, folder, capsys):
    assert report("--claim declared/of-size/small-one", (DECLARED,)) == 1
    printed = capsys.readouterr().out
    assert "good differs: predicted 1.0 rad, measured 2.0 rad, difference 1.0, allowed 0.10 " in printed
    assert "largest difference of 2: 0 m, 1.0 rad" in printed  # each unit separately
    (study,) = results_in(folder / "report-part")["studies"]
    assert [claim["id"] for claim in study["claims"]] == ["declared/of-size/small-one"]
    assert (folder / "report-part" / "arrays" / "declared" / "of-size" / "small-one.csv").exists()
    assert not (folder / "report").exists()  # the full report is not overwritten
    assert report("--claim declared/ones", (DECLARED,)) == 2
    assert "unknown claim 'declared/ones': did you mean 'declared/one'?" in capsys.readouterr().err
