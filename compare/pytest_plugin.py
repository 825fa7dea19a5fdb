"""``pytest --pyargs compare --engine mypackage.mymodule:simulate``: every claim is a test of that engine.

Each study is a file, and each sentence that it claims a test, known without measuring. The
first test of a study that runs measures all of it, in a process of its own that a time limit ends. A test fails
where the claim differs or the engine has no answer. What the engine never promised is "not attempted", and what
its errors leave open "inconclusive": neither is a pass.

Without ``--pyargs compare``, or a file of this package, pytest does not notice this plugin: its options do not even
exist.
"""

from __future__ import annotations

import shlex
from collections import Counter
from collections.abc import Iterator
from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING, Any, NoReturn

import pytest

if TYPE_CHECKING:
    from compare.claims.claim import Claim
    from compare.claims.study import Findings, Study
    from compare.run.workers import Failure

STUDIES = Path(__file__).with_name("studies")

STUDY_MODULES = "compare.studies"

INCONCLUSIVE, NOT_ATTEMPTED = "inconclusive", "not attempted"

NO_VERDICT = {INCONCLUSIVE: "?", NOT_ATTEMPTED: "-"}
"""What a test without a verdict is called in pytest's totals, and its sign among the dots."""

PROPERTY, ENGINE = "friction-discs", "friction-discs engine"

NOTHING_SHOWN, NOTHING_MEASURED = 6, 7
"""Exit statuses in addition to those of pytest: too few claims pass; an engine has no verdict."""


# Options of these names may well be another's: they are there only for a run that asks for this package.
def pytest_load_initial_conftests(early_config: pytest.Config, parser: pytest.Parser) -> None:
    """Add the options to a run of ``compare``."""
    known = early_config.known_args_namespace
    if not any(_is_own(argument, known.pyargs) for argument in known.file_or_dir):
        return
    group = parser.getgroup(PROPERTY, "friction-discs: judge an engine with pytest --pyargs compare")
    group.addoption(
        "--engine",
        dest="friction_discs_engines",
        action="append",
        default=[],
        metavar="MODULE:FUNCTION",
        help="engine to judge, the name of an installed one, exec:COMMAND, files:DIR or fmu:FILE; "
        "several times for several",
    )
    group.addoption(
        "--level",
        dest="friction_discs_level",
        choices=("quick", "full"),
        default="full",
        help="all studies, or those that take seconds (default: full)",
    )
    group.addoption(
        "--study",
        dest="friction_discs_studies",
        action="append",
        default=[],
        metavar="NAME",
        help="study to measure, as friction-discs list names it; several times for several (default: all)",
    )
    group.addoption(
        "--study-limit",
        dest="friction_discs_limit",
        type=float,
        default=120.0,
        metavar="SECONDS",
        help="time after which a study of an engine is given up (default: 120)",
    )
    group.addoption(
        "--min-conclusive",
        dest="friction_discs_least",
        type=int,
        default=1,
        metavar="N",
        help=f"how many claims have to pass, or pytest ends with status {NOTHING_SHOWN} if none fails (default: 1); "
        f"it ends with status {NOTHING_MEASURED} if an engine has no verdict at all",
    )


def _is_own(argument: str, by_module: bool) -> bool:
    """Return whether an argument is this package or in it: by its name after ``--pyargs``, else by its path."""
    place = argument.partition("::")[0]
    if by_module and place.partition(".")[0] == __name__.partition(".")[0]:
        return True
    return Path(place).resolve().is_relative_to(STUDIES.parent)


def _engines(config: pytest.Config) -> list[str]:
    names: list[str] = config.getoption("friction_discs_engines", [])
    return list(dict.fromkeys(names))


def pytest_configure(config: pytest.Config) -> None:
    """Refuse a study or an engine that is not known, and a limit that is none."""
    known = config.known_args_namespace
    for argument in known.file_or_dir if known.pyargs else ():
        if argument.startswith(f"{STUDY_MODULES}."):
            raise pytest.UsageError(_instead_of(argument))
    if not _engines(config):
        return
    from compare.engines import known_name
    from compare.studies import studies

    limit = config.getoption("friction_discs_limit")
    if not 0.0 < limit < float("inf"):
        raise pytest.UsageError(f"--study-limit {limit:g}: it must be > 0 s")
    try:
        for name in _engines(config):
            known_name(name)
        studies(config.getoption("friction_discs_studies"))
    except ValueError as error:
        raise pytest.UsageError(str(error)) from None
    config.stash[_BENCH] = Bench(limit)
    config.pluginmanager.register(config.stash[_BENCH])


def _instead_of(module: str) -> str:
    """Return what to ask for in place of a study's module, as "compare.studies.trajectories"."""
    from compare.studies import STUDIES as ALL

    parts = module.partition("::")[0].removeprefix(f"{STUDY_MODULES}.").replace("_", "-").split(".")
    named = {"-".join(parts[i:j]) for i in range(len(parts)) for j in range(i + 1, len(parts) + 1)}
    name = next((study.name for study in ALL if study.name in named), "NAME")
    return f"{module}: a study is asked for by its name, with --pyargs compare --study {name}"


def pytest_report_header(config: pytest.Config) -> str | None:
    """Say what is judged, or how to say it."""
    names = config.getoption("friction_discs_engines", None)
    if names is None:
        return None
    return f"friction-discs: {', '.join(names) or 'no engine, name one with --engine MODULE:FUNCTION'}"


def pytest_collect_file(file_path: Path, parent: pytest.Collector) -> StudyFile | None:
    """Take the modules of the studies, where an engine is to be judged."""
    place = file_path.parent if file_path.name == "__init__.py" else file_path.with_suffix("")
    # a study is a module in the folder of its group, or a package
    if file_path.suffix != ".py" or STUDIES not in place.parents[1:2] or not _engines(parent.config):
        return None
    from compare.studies import STUDIES as ALL

    quick = parent.config.getoption("friction_discs_level") == "quick"
    wanted = parent.config.getoption("friction_discs_studies")
    module = ".".join((STUDY_MODULES, *place.relative_to(STUDIES).parts))
    study = getattr(import_module(module), "STUDY", None)
    if study not in ALL or (quick and not study.quick) or (wanted and study.name not in wanted):
        return None
    return StudyFile.of(parent, file_path, study)


class StudyFile(pytest.File):
    """A study: the claims that it makes of each engine that it is about."""

    study: Study

    @classmethod
    def of(cls, parent: pytest.Collector, path: Path, study: Study) -> StudyFile:
        """Return the collector of ``study``."""
        file: StudyFile = cls.from_parent(parent, path=path)
        file.study = study
        return file

    def collect(self) -> Iterator[ClaimTest]:
        """Yield a test for each sentence and engine."""
        names = [name for name in _engines(self.config) if not self.study.only or name in self.study.only]
        for name in names:
            for sentence in self.study.sentences():
                yield ClaimTest.of(self, name, sentence, alone=len(_engines(self.config)) == 1)


class ClaimTest(pytest.Item):
    """One claim of a study about one engine."""

    study: Study
    engine: str
    sentence: str

    @classmethod
    def of(cls, parent: StudyFile, engine: str, sentence: str, *, alone: bool) -> ClaimTest:
        """Return the test of ``sentence``; its name is the sentence, and the engine's unless it is ``alone``."""
        test: ClaimTest = cls.from_parent(parent, name=sentence if alone else f"{sentence} [{engine}]")
        test.study, test.engine, test.sentence = parent.study, engine, sentence
        test.user_properties.append((ENGINE, engine))
        return test

    def reportinfo(self) -> tuple[Path, None, str]:
        """Return where the claim is made, and its name."""
        return self.path, None, f"{self.study.name}: {self.name}"

    def runtest(self) -> None:
        """Pass if all claims of this sentence agree."""
        from compare.claims.claim import Verdict
        from compare.run.workers import Failure

        outcome = self.config.stash[_BENCH].outcome(self.study, self.engine, self._asked_with())
        if isinstance(outcome, Failure):
            pytest.fail("\n    ".join((f"no result: {outcome.reason}", *outcome.where)), pytrace=False)
        claims = [claim for claim in outcome.claims if claim.sentence == self.sentence]
        if not claims and self.study.only:
            self._without_verdict(NOT_ATTEMPTED, f"of {self.engine} the study does not claim it")
        elif not claims and outcome.not_simulated:
            self._without_verdict(NOT_ATTEMPTED, outcome.not_simulated)
        elif not claims:
            pytest.fail("what the engine did gave no ground to measure this", pytrace=False)
        verdicts = {claim.verdict: claim for claim in claims}
        if Verdict.DIFFERS in verdicts:
            pytest.fail(_account(self.study, verdicts[Verdict.DIFFERS], self.engine), pytrace=False)
        if Verdict.INCONCLUSIVE in verdicts:
            self._without_verdict(
                INCONCLUSIVE, _account(self.study, verdicts[Verdict.INCONCLUSIVE], self.engine)
            )

    def _asked_with(self) -> tuple[str, ...]:
        """Return the parts of the study that the tests of this run are about, be it by -k, -m or their names."""
        parts = self.study.sentences()
        tests = (test for test in self.session.items if isinstance(test, ClaimTest))
        mine = (test for test in tests if (test.study, test.engine) == (self.study, self.engine))
        return tuple(parts[test.sentence] for test in mine)

    def _without_verdict(self, why: str, reason: str) -> NoReturn:
        self.user_properties.append((PROPERTY, why))
        pytest.skip(reason)


class Bench:
    """Measures each study with each engine once, as far as it is asked for, when its first claim is.

    It is also a plugin that counts the results of each engine, including those from other processes.
    """

    def __init__(self, limit: float) -> None:
        from compare.run.workers import Workers

        self._workers = Workers(1, limit)
        self._outcomes: dict[tuple[str, str], Findings | Failure] = {}
        self.counts: Counter[tuple[str, str]] = Counter()

    def outcome(self, study: Study, engine: str, parts: tuple[str, ...]) -> Findings | Failure:
        """Return what ``parts`` of ``study`` find about the engine of that name, or why they find nothing."""
        from compare.run.runner import measured

        key = (study.name, engine)
        if key not in self._outcomes:
            self._outcomes[key] = self._workers.ask(measured, study, engine, parts, owner=engine)
        return self._outcomes[key]

    def pytest_runtest_logreport(self, report: pytest.TestReport) -> None:
        """Count the result of a test."""
        if report.when == "call":
            self.counts[_engine_of(report), _why_none(report) or report.outcome] += 1

    def pytest_unconfigure(self) -> None:
        """End the process that measures."""
        self._workers.__exit__(None, None, None)


_BENCH = pytest.StashKey[Bench]()


def _account(study: Study, claim: Claim, engine: str) -> str:
    """Return a claim with the numbers that decide, and all that is needed to repeat it with the named engine."""
    from compare.claims.claim import Verdict
    from compare.report.numbers import answers_text, error_text, in_short, value_text, worst

    element = worst(claim)
    repeat = {
        "parameters": ", ".join(f"{name} = {value}" for name, value in claim.parameters.items()),
        "source": claim.source,
        "note": claim.note,
        "again": f"friction-discs report {study.name} --engine {shlex.quote(engine)}",
    }
    if claim.answers:
        first = f"{in_short(claim)} hold, {answers_text(element.numerical)} are too close to decide"
        return _listed(first, {"claim": f"{claim.sentence} {claim.equation}".rstrip()} | repeat)
    unit = f" {element.unit}" if element.unit else ""
    allowed = f"{error_text(element.total)}{unit}"
    differs = claim.verdict is Verdict.DIFFERS
    lines = {
        "claim": f"{claim.sentence} {claim.equation}".rstrip(),
        "predicted": f"{value_text(element.predicted, element.difference)}{unit}",
        "measured": f"{value_text(element.measured, element.difference)}{unit}",
        "difference": f"{error_text(element.difference)}{unit}",
        "error budget": f"{allowed} = {error_text(element.numerical)} (numerical, as the engine's own change says) "
        f"+ {error_text(element.model)} (model)",
        "resolution": f"{error_text(claim.budget.resolution)}{unit}: a larger budget shows nothing",
        "element": f"{element.name}: of {element.count} the nearest to its budget or the farthest beyond"
        if element.name
        else "",
        "largest": "; ".join(
            f"{error_text(one.difference)} {one.unit}, {one.name}"
            for one in element.largest
            if one.index != element.index
        ),
    }
    first = (
        f"differs by {error_text(element.difference)}{unit}, allowed are {allowed}"
        if differs
        else f"an error budget of {allowed} leaves it open"
    )
    return _listed(first, lines | repeat)


def _listed(first: str, lines: dict[str, str]) -> str:
    return "\n".join([first, *(f"  {name:12}  {text}" for name, text in lines.items() if text)])


def pytest_report_teststatus(report: pytest.TestReport) -> tuple[str, str, str] | None:
    """Count claims without a verdict as what they are."""
    why = _why_none(report)
    return (why, NO_VERDICT[why], why.upper()) if why else None


def _why_none(report: pytest.TestReport) -> str:
    """Return why a test has no verdict, "" for one that has, or that is another's."""
    if report.when != "call" or not report.skipped:
        return ""
    return next((str(value) for name, value in report.user_properties if name == PROPERTY), "")


@pytest.hookimpl(trylast=True)
def pytest_sessionfinish(session: pytest.Session, exitstatus: int) -> None:
    """End with status 7 if an engine has no verdict, or 6 if too few claims pass."""
    config, names = session.config, _engines(session.config)
    if not names or exitstatus != pytest.ExitCode.OK or config.getoption("collectonly"):
        return
    counts = config.stash[_BENCH].counts
    if any(counts[name, "passed"] + counts[name, INCONCLUSIVE] == 0 for name in names):
        session.exitstatus = NOTHING_MEASURED
    elif sum(counts[name, "passed"] for name in names) < config.getoption("friction_discs_least"):
        session.exitstatus = NOTHING_SHOWN


def _diagnoses(failed: list[pytest.TestReport]) -> Iterator[str]:
    """Yield in a line for each engine that failed what law of friction it has, and how its errors fall."""
    from compare.diagnosis.run import IN_SHORT, in_short
    from compare.run.runner import loaded
    from compare.run.workers import Workers

    with Workers(1, IN_SHORT) as workers:
        for name in dict.fromkeys(filter(None, map(_engine_of, failed))):
            try:
                (engine,) = loaded([name], workers)
                yield f"{name}: {' '.join(in_short(engine, workers).sentences)}"
            except ValueError as error:  # it can't even be imported
                yield str(error)


def _engine_of(report: pytest.TestReport) -> str:
    """Return the engine that a test is about, "" for a test of somebody else."""
    return next((str(value) for name, value in report.user_properties if name == ENGINE), "")


def pytest_terminal_summary(terminalreporter: pytest.TerminalReporter, config: pytest.Config) -> None:
    """Say why claims have no verdict, each reason once, and what is behind those that differ."""
    failed = terminalreporter.stats.get("failed", [])
    if failed and _engines(config) and not hasattr(config, "workerinput"):
        for line in _diagnoses(failed):
            terminalreporter.write_line(f"diagnosis: {line}")
    for why in NO_VERDICT:
        reports = terminalreporter.stats.get(why, [])
        reasons = Counter(report.longrepr[2].removeprefix("Skipped: ").splitlines()[0] for report in reports)
        for reason, count in reasons.items():
            terminalreporter.write_line(f"{why}: {reason} ({count} claim{'s' if count > 1 else ''})")


@pytest.hookimpl(optionalhook=True)
def pytest_xdist_make_scheduler(config: pytest.Config, log: Any) -> Any:
    """Keep the claims of a study in one process, since they are measured together."""
    if not _engines(config) or config.getoption("dist") != "load":
        return None
    from xdist.scheduler import LoadFileScheduling  # type: ignore[import-untyped]

    return LoadFileScheduling(config, log)
