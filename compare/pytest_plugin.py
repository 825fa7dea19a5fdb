"""``pytest --pyargs compare --engine mypackage.mymodule:simulate``: every claim is a test of that engine.

A separate process measures the claims. A test fails if the claim differs or the engine has no answer. A claim
without a verdict is "not attempted" (the engine declares that it lacks something), "inconclusive" (errors are too
large) or "not measured" (the engine refuses a motion, or no time is left).

Without ``--pyargs compare`` or a file of this package the plugin is inactive.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from importlib import import_module
from pathlib import Path
from types import SimpleNamespace
from typing import TYPE_CHECKING, Any, NoReturn

import pytest

from compare.run.levels import LIMITS, seed_of
from compare.run.statuses import INTERRUPTED, NOTHING_SHOWN, Share

if TYPE_CHECKING:
    from compare.claims.claim import Claim
    from compare.claims.study import Study
    from compare.run.measuring import Bench

STUDIES = Path(__file__).with_name("studies")

STUDY_MODULES = "compare.studies"

INCONCLUSIVE, NOT_ATTEMPTED, NOT_MEASURED = "inconclusive", "not attempted", "not measured"

NO_VERDICT = {INCONCLUSIVE: "?", NOT_ATTEMPTED: "-", NOT_MEASURED: "t"}
"""Names of tests without a verdict in pytest's totals, and their progress characters."""

PROPERTY, ENGINE = "friction-discs", "friction-discs engine"


# The option names may clash with another plugin, so they exist only in runs of this package.
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
        help="Engine to test: MODULE:FUNCTION, the name of an installed engine, exec:COMMAND, files:DIR or fmu:FILE; "
        "can be repeated",
    )
    group.addoption(
        "--level",
        dest="friction_discs_level",
        choices=tuple(LIMITS),
        default="full",
        help="Studies to measure: all, or only those that take seconds (default: full)",
    )
    group.addoption(
        "--seed",
        dest="friction_discs_seed",
        type=int,
        metavar="N",
        help="Seed of the units of mass, length and time in which an engine receives its motions, drawn for each "
        "system over three decades (default: 1 for --level quick, else SI units)",
    )
    group.addoption(
        "--study",
        dest="friction_discs_studies",
        action="append",
        default=[],
        metavar="NAME",
        help="Study to measure, by its name in friction-discs list; can be repeated (default: all)",
    )
    group.addoption(
        "--study-limit",
        dest="friction_discs_limit",
        type=float,
        metavar="SECONDS",
        help="Limit of processor time in s for all claims of one study about one engine "
        f"(default: {LIMITS['full']:g}, or {LIMITS['quick']:g} at the quick level)",
    )
    group.addoption(
        "--min-conclusive",
        dest="friction_discs_least",
        type=int,
        default=1,
        metavar="N",
        help=f"Smallest number of claims that must pass; otherwise the exit status is {NOTHING_SHOWN} (default: 1), "
        "as it is if less than half of an engine's claims can be measured",
    )


def _is_own(argument: str, by_module: bool) -> bool:
    """Return whether an argument is within this package."""
    place = argument.partition("::")[0]
    if by_module and place.partition(".")[0] == __name__.partition(".")[0]:
        return True
    return Path(place).resolve().is_relative_to(STUDIES.parent)


def _engines(config: pytest.Config) -> list[str]:
    names: list[str] = config.getoption("friction_discs_engines", [])
    return list(dict.fromkeys(names))


def pytest_configure(config: pytest.Config) -> None:
    """Raise ``pytest.UsageError`` for an unknown study or engine, or an invalid time limit."""
    known = config.known_args_namespace
    for argument in known.file_or_dir if known.pyargs else ():
        if argument.startswith(f"{STUDY_MODULES}."):
            raise pytest.UsageError(_instead_of(argument))
    if not _engines(config):
        return
    from compare.engines import known_name
    from compare.run.measuring import Bench
    from compare.studies import studies

    level, limit = config.getoption("friction_discs_level"), config.getoption("friction_discs_limit")
    limit = LIMITS[level] if limit is None else limit
    if not 0.0 < limit < float("inf"):
        raise pytest.UsageError(f"--study-limit {limit:g}: it must be > 0 s")
    try:
        for name in _engines(config):
            known_name(name)
        studies(config.getoption("friction_discs_studies"))
    except ValueError as error:
        raise pytest.UsageError(str(error)) from None
    given = {str(word).partition("=")[0] for word in config.invocation_params.args}
    if ignored := ", ".join(given & _of_functions(config)):
        raise pytest.UsageError(f"{ignored}: it applies to test functions, but claims are none; omit it")
    seed = seed_of(level, config.getoption("friction_discs_seed"))
    config.stash[_COUNTS] = Counts(Bench(limit, seed, quick=level == "quick"))
    config.pluginmanager.register(config.stash[_COUNTS])


def _of_functions(config: pytest.Config) -> set[str]:
    """Return the options of plugins that parametrise test functions, such as "--count" of pytest-repeat."""
    found: set[str] = set()
    recorder = SimpleNamespace(
        addini=lambda *_, **__: None, addoption=lambda *names, **_: found.update(names)
    )
    recorder.getgroup = lambda *_, **__: recorder
    known = {"parser": recorder, "pluginmanager": config.pluginmanager}
    plugins = [one.plugin for one in config.hook.pytest_generate_tests.get_hookimpls()]
    for one in config.hook.pytest_addoption.get_hookimpls():
        if one.plugin in plugins and one.plugin_name != "python":  # that is pytest's own
            one.function(*(known[name] for name in one.argnames))
    return found


def _instead_of(module: str) -> str:
    """Return the error message for a study's module, such as "compare.studies.trajectories"."""
    from compare.studies import STUDIES as ALL

    parts = module.partition("::")[0].removeprefix(f"{STUDY_MODULES}.").replace("_", "-").split(".")
    named = {"-".join(parts[i:j]) for i in range(len(parts)) for j in range(i + 1, len(parts) + 1)}
    name = next((study.name for study in ALL if study.name in named), "NAME")
    return f"{module}: select a study by its name, with --pyargs compare --study {name}"


def pytest_report_header(config: pytest.Config) -> str | None:
    """Return the header line with the engines, or with the missing option."""
    names = config.getoption("friction_discs_engines", None)
    if names is None:
        return None
    return f"friction-discs: {', '.join(names) or 'no engine given; use --engine MODULE:FUNCTION'}"


def pytest_collect_file(file_path: Path, parent: pytest.Collector) -> StudyFile | None:
    """Return the collector of a study's module, if an engine is given."""
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
    file: StudyFile = StudyFile.from_parent(parent, path=file_path)
    file.study = study
    return file


class StudyFile(pytest.File):
    """A study with a test for each claim and engine."""

    study: Study

    def collect(self) -> Iterator[ClaimTest]:
        """Yield a test for each sentence and engine; its name contains the engine if there are several."""
        engines = _engines(self.config)
        for engine in engines:
            if self.study.only and engine not in self.study.only:
                continue
            for sentence in self.study.sentences():
                name = sentence if len(engines) == 1 else f"{sentence} [{engine}]"
                test: ClaimTest = ClaimTest.from_parent(self, name=name)
                test.study, test.engine, test.sentence = self.study, engine, sentence
                test.user_properties.append((ENGINE, engine))
                yield test


class ClaimTest(pytest.Item):
    """One claim of a study about one engine."""

    study: Study
    engine: str
    sentence: str

    def reportinfo(self) -> tuple[Path, None, str]:
        """Return the file of the claim, no line, and its name."""
        return self.path, None, f"{self.study.name}: {self.name}"

    def runtest(self) -> None:
        """Pass if all claims of this sentence agree."""
        from compare.claims.claim import Verdict
        from compare.run.workers import Failure

        bench, part = self.config.stash[_COUNTS].bench, self.study.sentences()[self.sentence]
        outcome = bench.outcome(self.study, self.engine, part)
        if isinstance(outcome, str) or (isinstance(outcome, Failure) and outcome.unfinished):
            self._without_verdict(NOT_MEASURED, str(outcome))
        if isinstance(outcome, Failure):
            pytest.fail("\n    ".join((f"no result: {outcome.reason}", *outcome.where)), pytrace=False)
        claims = [claim for claim in outcome.claims if claim.sentence == self.sentence]
        if not claims:
            reason = outcome.not_simulated or f"this claim does not apply to {self.engine}"
            self._without_verdict(NOT_ATTEMPTED, reason)
        verdicts = {claim.verdict: claim for claim in claims}
        if Verdict.DIFFERS in verdicts:
            pytest.fail(self._account(verdicts[Verdict.DIFFERS]), pytrace=False)
        if Verdict.INCONCLUSIVE in verdicts:
            self._without_verdict(INCONCLUSIVE, self._account(verdicts[Verdict.INCONCLUSIVE]))

    def _account(self, claim: Claim) -> str:
        from compare.report.page import command

        return _account(claim, command(self.study.name, self.engine, self.config.stash[_COUNTS].bench.seed))

    def _without_verdict(self, why: str, reason: str) -> NoReturn:
        self.user_properties.append((PROPERTY, why))
        pytest.skip(reason)


class Counts:
    """Plugin that counts the results of each engine, also from other processes."""

    def __init__(self, bench: Bench) -> None:
        self.bench = bench
        self.found: Counter[tuple[str, str]] = Counter()
        self.interrupted = False

    def pytest_keyboard_interrupt(self, excinfo: pytest.ExceptionInfo[BaseException]) -> None:
        """Notice Ctrl-C, but not pytest's own interruptions."""
        self.interrupted = excinfo.type is KeyboardInterrupt

    def pytest_runtest_logreport(self, report: pytest.TestReport) -> None:
        """Count the result of a test."""
        if report.when == "call":
            self.found[_property(report, ENGINE), _why_none(report) or report.outcome] += 1

    def share(self, engine: str) -> Share:
        """Return the share of claims with a verdict among those that the engine declares to simulate."""
        counts = {why: number for (name, why), number in self.found.items() if name == engine}
        measured = sum(number for why, number in counts.items() if why not in NO_VERDICT)
        return Share(measured, sum(counts.values()) - counts.get(NOT_ATTEMPTED, 0))

    def pytest_unconfigure(self) -> None:
        """End the measuring process."""
        self.bench.close()


_COUNTS = pytest.StashKey[Counts]()


def _account(claim: Claim, again: str) -> str:
    """Return the deciding numbers of a claim, and the parameters and command that repeat it."""
    from compare.report.numbers import answers_text, decision, error_text, in_short, value_text, worst

    element = worst(claim)
    repeat = {
        "parameters": ", ".join(f"{name} = {value}" for name, value in claim.parameters.items()),
        "source": claim.source,
        "note": claim.note,
        "again": again,
    }
    if claim.answers:
        first = f"{in_short(claim)} hold, {answers_text(element.numerical)} undecided"
        return _listed(first, {"claim": f"{claim.sentence} {claim.equation}".rstrip()} | repeat)
    unit = f" {element.unit}" if element.unit else ""
    allowed = f"{error_text(element.total)}{unit}"
    lines = {
        "claim": f"{claim.sentence} {claim.equation}".rstrip(),
        "predicted": f"{value_text(element.predicted, element.difference)}{unit}",
        "measured": f"{value_text(element.measured, element.difference)}{unit}",
        "difference": f"{error_text(element.difference)}{unit}",
        "error budget": f"{allowed} = {error_text(element.numerical)} (numerical, estimated from the engine) "
        f"+ {error_text(element.model)} (model)",
        "resolution": f"{error_text(claim.budget.resolution)}{unit}, the largest conclusive budget",
        "element": f"{element.name}, the worst of {element.count} relative to the budget"
        if element.name
        else "",
        "largest": "; ".join(
            f"{error_text(one.difference)} {one.unit}, {one.name}"
            for one in element.largest
            if one.index != element.index
        ),
    }
    return _listed(decision(claim), lines | repeat)


def _listed(first: str, lines: dict[str, str]) -> str:
    return "\n".join([first, *(f"  {name:12}  {text}" for name, text in lines.items() if text)])


def pytest_report_teststatus(report: pytest.TestReport) -> tuple[str, str, str] | None:
    """Return the category, character and word for a claim without a verdict."""
    why = _why_none(report)
    return (why, NO_VERDICT[why], why.upper()) if why else None


def _why_none(report: pytest.TestReport) -> str:
    return _property(report, PROPERTY) if report.when == "call" and report.skipped else ""


def _property(report: pytest.TestReport, name: str) -> str:
    return str(dict(report.user_properties).get(name, ""))


@pytest.hookimpl(trylast=True)
def pytest_sessionfinish(session: pytest.Session, exitstatus: int) -> None:
    """Replace pytest's exit status by one of ``compare.run.statuses``."""
    config, names = session.config, _engines(session.config)
    if not names or config.getoption("collectonly"):
        return
    counts = config.stash[_COUNTS]
    if counts.interrupted:
        session.exitstatus = INTERRUPTED
    if exitstatus != pytest.ExitCode.OK:
        return
    passed = sum(counts.found[name, "passed"] for name in names)
    enough = all(counts.share(name).enough for name in names)
    if not enough or passed < config.getoption("friction_discs_least"):
        session.exitstatus = NOTHING_SHOWN


def pytest_terminal_summary(terminalreporter: pytest.TerminalReporter, config: pytest.Config) -> None:
    """Write the diagnosis of failed engines, reasons for missing verdicts, and the share of measured claims."""
    failed = terminalreporter.stats.get("failed", [])
    if failed and _engines(config) and not hasattr(config, "workerinput"):
        from compare.diagnosis.run import in_short

        fails = Counter(engine for report in failed if (engine := _property(report, ENGINE)))
        for line, number in zip(in_short(fails), fails.values(), strict=True):
            terminalreporter.write_line(
                f"{number} claim{'s' if number > 1 else ''} failed. Tests with single blocks alone find: {line}"
            )
    for why in NO_VERDICT:
        reports = terminalreporter.stats.get(why, [])
        reasons = Counter(report.longrepr[2].removeprefix("Skipped: ").splitlines()[0] for report in reports)
        for reason, count in reasons.items():
            terminalreporter.write_line(f"{why}: {reason} ({count} claim{'s' if count > 1 else ''})")
    if not config.getoption("collectonly"):
        for name in _engines(config):
            terminalreporter.write_line(f"{name}: {config.stash[_COUNTS].share(name).in_words('claim')}")


@pytest.hookimpl(optionalhook=True)
def pytest_xdist_make_scheduler(config: pytest.Config, log: Any) -> Any:
    """Return a scheduler that keeps the claims of a study in one process."""
    if not _engines(config) or config.getoption("dist") != "load":
        return None
    from xdist.scheduler import LoadFileScheduling  # type: ignore[import-untyped]

    return LoadFileScheduling(config, log)
