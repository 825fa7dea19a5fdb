"""The plugin from a user's view: pytest in an empty folder, on the installed package."""

import io
import json
import os
import re
import shutil
import subprocess
import sys
import xml.etree.ElementTree as ET
from contextlib import redirect_stderr, redirect_stdout

import pytest
from processes import PATIENCE, ROOT, work_here

from compare.claims.claim import THEORY
from compare.run.statuses import NOTHING_SHOWN, STATUSES
from compare.studies import STUDIES

ENGINES = """
import time
from dataclasses import replace
import numpy as np
import reference_model
from compare.engines import UnsupportedSystemError
from reference_model import Phase, Solution, Trajectory

def resting(system, state, times, *, tolerance=1e-9):
    "Nothing ever moves."
    states = np.tile(np.asarray(state, dtype=float), (len(times), 1))
    phases = (Phase("slip", times[0], times[-1], states[0]),)
    return Trajectory(system, np.array(times), states, phases, Solution("none", tolerance, 0, 0, 0.0))

def not_a_number(system, state, times, *, tolerance=1e-9):
    trajectory = resting(system, state, times)
    states = trajectory.states.copy()
    states[-1, 0] = np.nan
    return replace(trajectory, states=states)

def hanging(*arguments, **options):
    time.sleep(1000.0)

def picky(system, *arguments, tolerance=1e-9):
    assert system.disc_speed < 2.0, "no fast discs"
    return reference_model.simulate(system, *arguments, tolerance=tolerance)

def refusing(*arguments, tolerance=1e-9):
    raise UnsupportedSystemError("mine is closed")

def sliding(*arguments, tolerance=1e-9):
    return reference_model.simulate(*arguments, tolerance=tolerance)
sliding.sticks = False
"""

CLAIMS = {study.name: list(study.sentences()) for study in STUDIES if study.only != (THEORY,)}


OWN = ("mine", "exiting", "example", "rough")
"""Modules of engines, which differ between folders."""


def run(folder, *arguments, here=True):
    """Run pytest in ``folder`` and return its exit status, its output, and {(claim, engine): (tag, text)}.

    It runs in this process because starting pytest and the package takes longer than most tests, and also measures
    ``here``. The diagnosis of failing engines is left out.
    """
    output = io.StringIO()
    with pytest.MonkeyPatch.context() as patch, redirect_stdout(output), redirect_stderr(output):
        patch.chdir(folder)
        if here:
            work_here(patch)
        patch.setattr("compare.diagnosis.run.PROBES", ())
        for name in OWN:
            patch.delitem(sys.modules, name, raising=False)
        options = (*OPTIONS, *WITHOUT_OTHERS, *WITHIN_ANOTHER)
        status = pytest.main([*options, *arguments])
        for name in OWN:
            sys.modules.pop(name, None)
    return status, output.getvalue(), cases_in(folder)


def run_by_itself(folder, *arguments):
    done = subprocess.run(
        [sys.executable, "-m", "pytest", *OPTIONS, *WITHOUT_OTHERS, *arguments],
        cwd=folder,
        env=outside(),
        capture_output=True,
        encoding="utf-8",
        timeout=PATIENCE,
    )
    return done.returncode, done.stdout + done.stderr, cases_in(folder)


def outside():
    return {name: value for name, value in os.environ.items() if not name.startswith("PYTEST")}


OPTIONS = ("-p", "no:cacheprovider", "--junit-xml=out.xml")

WITHOUT_OTHERS = ("-p", "no:hypothesispytest", "-p", "no:zarr")
"""Options that disable plugins which import their whole library at each start of pytest."""

WITHIN_ANOTHER = ("-p", "no:xdist", "-p", "no:faulthandler", "-p", "no:unraisableexception")
"""Options that disable plugins already active in the outer run; the last one collects garbage five times."""


def cases_in(folder):
    cases = {}
    if (folder / "out.xml").exists():
        for case in ET.parse(folder / "out.xml").iter("testcase"):
            verdict = next((child for child in case if child.tag in ("failure", "error", "skipped")), None)
            text = "" if verdict is None else f"{verdict.get('message')} {verdict.text}"
            cases[case.get("name")] = ("passed" if verdict is None else verdict.tag, text)
    return cases


def judge(folder, study, *names, options=(), run=run, **more):
    (folder / "mine.py").write_text(ENGINES)
    chosen = [argument for name in names for argument in ("--engine", name)]
    return run(folder, "--pyargs", "compare", "--study", study, *chosen, *options, **more)


def test_every_claim_of_a_level_is_collected_once(tmp_path):
    for level in ("full", "quick"):
        options = ("--engine", "nobody:simulate", "--level", level, "--collect-only", "-q")
        _, output, _ = run(tmp_path, "--pyargs", "compare", *options)
        collected = [line.partition("::")[2] for line in output.splitlines() if "::" in line]
        wanted = [study for study in STUDIES if not study.only and (study.quick or level == "full")]
        assert sorted(collected) == sorted(claim for study in wanted for claim in study.sentences())
    assert all(CLAIMS.values())
    for name, listed in CLAIMS.items():
        assert len(set(listed)) == len(listed), name


@pytest.mark.parametrize(
    ("names", "options", "expected"),
    [
        (("reference",), (), 0),
        (("reference",), ("--min-conclusive", "1000"), NOTHING_SHOWN),
        (("reference", "mine:sliding"), (), NOTHING_SHOWN),
        (("mine:refusing",), (), NOTHING_SHOWN),
    ],
)
def test_the_status_reports_missing_measurements_without_a_terminal_plugin(
    names, options, expected, tmp_path
):
    options = (*options, "-k", "which", "-p", "no:terminal")
    assert judge(tmp_path, "sticking-domain", *names, options=options)[0] == expected


FAILING = {
    "mine:not_a_number": "s is not finite: [nan, ",
    "exiting:simulate": "engine 'exiting:simulate' cannot be imported: SystemExit: 0",
    "mine:missing": "engine 'mine:missing' cannot be imported: module 'mine' has no attribute 'missing'",
}

ASKED = [claim for claim in CLAIMS["sticking-domain"] if "which" in claim]


def test_a_correct_engine_passes_next_to_failing_ones_which_show_the_reason(tmp_path):
    (tmp_path / "exiting.py").write_text("raise SystemExit(0)")
    names = ("reference", "mine:resting", *FAILING)
    status, output, cases = judge(tmp_path, "sticking-domain", *names, options=("-k", "which"))
    assert status == 1
    assert set(cases) == {f"{claim} [{engine}]" for claim in ASKED for engine in names}
    assert {cases[f"{claim} [reference]"][0] for claim in ASKED} == {"passed"}
    tag, text = cases["The largest radius at which a stuck pin does not slip is (9) [mine:resting]"]
    assert tag == "failure"
    for part in (
        "the engine returned NaN at ω = 0.9 rad/s, so a number is missing",
        "predicted ",
        "measured ",
        "(numerical, estimated from the engine) + 0 (model)",
        "friction-discs report sticking-domain --engine mine:resting",
    ):
        assert part in text, part
    assert "Traceback" not in output
    for engine, reason in FAILING.items():
        for claim in ASKED:
            tag, text = cases[f"{claim} [{engine}]"]
            assert tag == "failure"
            assert "no result: " in text
            assert reason in text


@pytest.mark.parametrize("quick", [False, True])
def test_a_study_out_of_time_fails_no_claim(quick, tmp_path):
    options = ("--study-limit", "1", *["--level", "quick"] * quick)
    status, output, cases = judge(tmp_path, "fig04", "mine:hanging", options=options, here=False)
    assert set(cases) == set(CLAIMS["fig04"])  # a single engine is not named
    assert {tag for tag, _ in cases.values()} == {"skipped"}
    unfinished = [text for _, text in cases.values() if "not finished within 1 s" in text]
    assert len(unfinished) == (0 if quick else 1)  # the claim that was measured then
    remedy = "use --level full" if quick else "use a larger --study-limit"
    reason = f"the study fig04 takes longer than 1 s with mine:hanging; {remedy}"
    assert f"not measured: {reason} ({len(cases) - len(unfinished)} claims)" in output
    assert f"mine:hanging: measured 0 of {len(cases)} claims (0 %)" in output
    assert status == NOTHING_SHOWN


def test_an_exception_costs_only_the_claims_that_need_the_motion(tmp_path):
    _, output, cases = judge(tmp_path, "fig04", "mine:picky")
    tags = {claim: tag for claim, (tag, _) in cases.items()}
    assert set(tags.values()) == {"passed", "failure"}
    assert all("no fast discs" in text for tag, text in cases.values() if tag == "failure")
    assert (
        f"{list(tags.values()).count('failure')} claims failed. Tests with single blocks alone find: "
        in output
    )


def of_pins_that_slide(claim):
    return claim.split(": ")[1].startswith(("a pin", "pins")) and "stick" not in claim


def test_claims_that_other_processes_measure_are_reported_once(tmp_path):
    status, output, cases = judge(
        tmp_path, "sticking-domain", "mine:sliding", options=("-n", "1"), run=run_by_itself
    )
    assert status == NOTHING_SHOWN
    assert set(cases) == set(CLAIMS["sticking-domain"])
    assert {tag for tag, _ in cases.values()} == {"skipped"}
    assert "not attempted: mine:sliding does not simulate stick (" in output
    assert f" {len(cases)} not attempted in " in output


HONEST = """
from example import euler

def honest(pin, *arguments, **options):
    assert pin.hardening == 0.0, "nobody asks for that"
    return euler(pin, *arguments, **options)
honest.sticks, honest.step = False, 5e-2
"""


@pytest.fixture
def example(tmp_path):
    shutil.copy(ROOT / "examples" / "07_engine_under_pytest.py", tmp_path / "example.py")
    (tmp_path / "rough.py").write_text(HONEST)
    return tmp_path


def test_the_example_passes_with_its_error_and_reports_what_it_cannot_simulate(example):
    """The number of inconclusive claims of the coarse engine depends on the remaining time."""
    allowed = {"example:runge_kutta": {"passed"}, "rough:honest": {"passed", "skipped"}}
    left_out = ("hardens", "stops", "range", "play", "Momentum", "Position")
    chosen = ("-k", " and ".join(f"not {word}" for word in left_out))
    _, output, cases = judge(example, "trajectories", *allowed, options=chosen)
    asked = {claim for claim in CLAIMS["trajectories"] if not any(word in claim for word in left_out)}
    slide = set(filter(of_pins_that_slide, asked))
    assert set(cases) == {f"{claim} [{engine}]" for claim in asked for engine in allowed}
    for engine, verdicts in allowed.items():
        for claim in asked:
            found, _ = cases[f"{claim} [{engine}]"]
            assert found in (verdicts if claim in slide else {"skipped"}), (claim, engine)
    left_open = sum(cases[f"{claim} [rough:honest]"][0] == "skipped" for claim in slide)
    assert f"{2 * len(slide) - left_open} passed" in output
    assert f" {2 * len(asked - slide)} not attempted" in output
    assert f" {left_open} inconclusive" in output or left_open == 0
    assert ("inconclusive: the error budget of " in output) == (left_open > 0)
    for lacking in ("stick", "a disc on a continuous ring or a disc on single points"):
        assert f"not attempted: example:runge_kutta does not simulate {lacking} (" in output


def test_the_documents_contain_the_statuses_once():
    table = "\n".join(f"| {status} | {meaning} |" for status, meaning in STATUSES.items())
    text = "".join(path.read_text(encoding="utf-8") for path in sorted((ROOT / "docs").glob("*.md")))
    assert text.count(table) == text.count("| 130 |") == 1


FILE = str(ROOT / "compare" / "studies" / "pin" / "fig05" / "__init__.py")
USAGE, NOTHING = pytest.ExitCode.USAGE_ERROR, pytest.ExitCode.NO_TESTS_COLLECTED
BY_ITS_NAME = "select a study by its name, with --pyargs compare --study"
REFUSED = [
    ("--pyargs compare --engine exudin", USAGE, "unknown engine 'exudin': did you mean 'exudyn'?"),
    ("--pyargs compare --engine exudyn --study-limit 0", USAGE, "--study-limit 0: it must be > 0 s"),
    (
        "--pyargs compare --engine exudyn --study fig6",
        USAGE,
        "unknown study 'fig6': did you mean 'fig06'?",
    ),
    (
        "--pyargs compare.studies.drivetrain.run_up.claims",
        USAGE,
        f"compare.studies.drivetrain.run_up.claims: {BY_ITS_NAME} drivetrain-run-up\n",
    ),
    ("--pyargs compare.studies.no_such", USAGE, f"compare.studies.no_such: {BY_ITS_NAME} NAME\n"),
    ("--pyargs compare", NOTHING, "no engine given; use --engine MODULE:FUNCTION"),
    (FILE, NOTHING, "no engine given; use --engine MODULE:FUNCTION"),
]


@pytest.mark.parametrize(("arguments", "expected", "sentence"), REFUSED, ids=[one[2] for one in REFUSED])
def test_invalid_options_are_rejected_at_once(arguments, expected, sentence, tmp_path):
    status, output, _ = run(tmp_path, *arguments.split())
    assert status == expected
    assert sentence in output


REPEATING = """
def pytest_addoption(parser):
    parser.addoption("--count", type=int, default=1)

def pytest_generate_tests(metafunc):
    pass
"""


@pytest.mark.parametrize("option", ["--count=2", "--count 2"])
def test_an_option_for_test_functions_is_rejected_not_ignored(option, tmp_path, monkeypatch):
    (tmp_path / "repeating.py").write_text(REPEATING)
    monkeypatch.syspath_prepend(tmp_path)
    arguments = ["-p", "repeating", "--pyargs", "compare", "--engine", "exudyn", "--collect-only", "-q"]
    assert run(tmp_path, *arguments, "--study", "block")[0] == 0
    status, output, _ = run(tmp_path, *arguments, *option.split())
    assert status == USAGE
    assert "--count: it applies to test functions, but claims are none; omit it" in output


OTHERS = {
    "test_of_others.py": (),
    "tests/test_compare.py": ("tests/test_compare.py::test", "-k", "test or compare"),
    "compare/test_engines.py": ("compare",),
    "comparelib/test_it.py": ("--pyargs", "comparelib.test_it"),
}
"""Files with a test of other projects, and pytest's arguments that select it."""

OF_OTHERS = """
import sys

def test(pytestconfig):
    assert pytestconfig.getoption('engine') == 'diesel'
    assert pytestconfig.pluginmanager.has_plugin('friction_discs')
    assert not {'reference_model', 'compare.engines'} & set(sys.modules)
"""

ONE_AFTER_THE_OTHER = """
import json, os, sys
import pytest

for folder, arguments in json.loads(sys.argv[1]):
    os.chdir(folder)
    print("status", int(pytest.main(arguments)), flush=True)
    for name, module in list(sys.modules.items()):
        if (getattr(module, "__file__", None) or "").startswith(folder):
            del sys.modules[name]
"""


def test_the_tests_of_others_do_not_notice_the_plugin(tmp_path):
    options = ["--engine", "diesel", *WITHOUT_OTHERS, "-o", "pythonpath=.", *OPTIONS]
    runs = []
    for i, (file, named) in enumerate(OTHERS.items()):
        folder = tmp_path / str(i)
        (folder / file).parent.mkdir(parents=True)
        (folder / "conftest.py").write_text(
            "def pytest_addoption(parser):\n    parser.addoption('--engine')\n    parser.addoption('--level')\n"
        )
        (folder / file).write_text(OF_OTHERS)
        runs.append((str(folder), [*named, *options]))
    command = [sys.executable, "-c", ONE_AFTER_THE_OTHER, json.dumps(runs)]
    done = subprocess.run(command, env=outside(), capture_output=True, encoding="utf-8", timeout=PATIENCE)
    output = done.stdout + done.stderr
    assert re.findall(r"1 passed|status \S+", output) == ["1 passed", "status 0"] * len(OTHERS), output
