"""Run studies with engines: in parallel, with separate failures, and nothing lost at Ctrl-C."""

import time
from collections.abc import Callable, Collection, Generator, Hashable, Iterable, Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

from compare.claims.claim import THEORY, Verdict
from compare.claims.errata import Erratum, Evidence
from compare.claims.study import Data, Findings, Study
from compare.engines import Engine, engines, is_registered, known_name, owner_of, told_apart
from compare.run.interrupts import caught
from compare.run.levels import LIMITS
from compare.run.measuring import Course, Work, measured
from compare.run.provenance import engine_stamp, engine_version
from compare.run.statuses import Share
from compare.run.store import Drawing, DrawingStore, Store, drawing_stamp, drawn
from compare.run.workers import Done, Failure, Workers

Progress = Callable[[int, int, str, float], None]
"""Takes the numbers of finished and of all pieces of work, the names of the running pieces and the time left in s."""


@dataclass
class Run:
    """The requested measurements and their results so far.

    - ``studies``, ``engines``: requested studies, and names of the requested engines without "theory".
    - ``contact_only``: names of the engines that take part only in studies of the contact (``Study.contact``).
    - ``outcomes``, ``seconds``: findings or failure, and duration in s, for each (study, engine or "theory").
    - ``drawings``, ``evidence``: drawing or failure for each study; evidence or failure for ``errata`` by index.
    - ``seed``: seed of the units of the motions, see ``Engine.seed``.
    - ``interrupted``: True if Ctrl-C ended the run early.
    """

    studies: tuple[Study, ...]
    engines: tuple[str, ...]
    errata: tuple[Erratum, ...] = ()
    contact_only: tuple[str, ...] = ()
    about: tuple[str, ...] = ()
    outcomes: dict[tuple[str, str], Findings | Failure] = field(default_factory=dict)
    seconds: dict[tuple[str, str], float] = field(default_factory=dict)
    drawings: dict[str, Drawing | Failure] = field(default_factory=dict)
    evidence: dict[int, Evidence | Failure] = field(default_factory=dict)
    versions: dict[str, str] = field(default_factory=dict)
    seed: int | None = None
    interrupted: bool = False

    def columns(self, study: Study) -> tuple[str, ...]:
        """Return the columns of ``study``: "theory" if some claims need no engine, and the engines that take part."""
        theory = (THEORY,) if study.has_theory else ()
        return theory + tuple(name for name in self.engines if self._takes_part(name, study))

    def _takes_part(self, name: str, study: Study) -> bool:
        return (not study.only or name in study.only) and (study.contact or name not in self.contact_only)

    @property
    def missing(self) -> tuple[tuple[str, str], ...]:
        """Pairs (study, engine) without an outcome."""
        return tuple(
            (study.name, column)
            for study in self.studies
            for column in self.columns(study)
            if (study.name, column) not in self.outcomes
        )

    def share(self, name: str) -> Share:
        """Return the share of conclusive claims among those that the engine ``name`` declares to simulate."""
        measured = of = 0
        for study in (one for one in self.studies if name in self.columns(one)):
            found = self.outcomes.get((study.name, name))
            claims = found.claims if isinstance(found, Findings) else ()
            open_ = set(found.gaps if isinstance(found, Findings) else study.sentences())
            open_ |= {claim.sentence for claim in claims if claim.verdict is Verdict.INCONCLUSIVE}
            shown = {claim.sentence for claim in claims} - open_
            measured, of = measured + len(shown), of + len(shown | open_)
        return Share(measured, of)

    @property
    def done(self) -> int:
        """Number of finished pieces of work."""
        return len(self.outcomes) + len(self.drawings) + len(self.evidence)

    def data(self, study: Study) -> dict[str, Data]:
        """Return the arrays for the figures by engine."""
        found = {column: self.outcomes.get((study.name, column)) for column in self.columns(study)}
        return {
            column: outcome.data
            for column, outcome in found.items()
            if isinstance(outcome, Findings) and outcome.data
        }


def run(
    studies: tuple[Study, ...],
    engines: tuple[Engine, ...],
    *,
    folder: Path,
    jobs: int = 1,
    limit: float | None = None,
    quick: bool = False,
    resume: bool = False,
    errata: tuple[Erratum, ...] = (),
    expected: Mapping[tuple[str, str], float] | None = None,
    progress: Progress = lambda done, total, now, left: None,
) -> Run:
    """Measure every study with every engine, keep the findings in ``folder``, and draw the figures.

    Drawings of equal data are reused. Work that takes longer than ``limit`` (s) fails. If ``quick``, claims that
    would take a foreign engine too long are not attempted. ``resume`` reuses findings of the same code and libraries.
    ``expected`` are the durations of an earlier run. After Ctrl-C the results are incomplete.
    """
    result = Run(
        studies,
        tuple(engine.name for engine in engines),
        errata,
        tuple(engine.name for engine in engines if engine.contact_only),
        tuple(
            engine.about
            for engine in engines
            if engine.about and any(study.contact or not engine.contact_only for study in studies)
        ),
        versions={one.name: engine_version(one.name, one.kin, one.version) for one in engines},
        seed=next((engine.seed for engine in engines), None),
    )
    with Workers(jobs, limit) as workers:
        stores = Store(folder), DrawingStore(folder)
        runner = _Runner(result, workers, jobs, quick, *stores, expected or {}, progress)
        workers.watch = runner.show
        try:
            runner.work({engine.name: engine for engine in engines}, resume)
        except KeyboardInterrupt:
            caught()
            result.interrupted = True
    return result


TRUSTED = 20.0
"""Work in s whose expected duration counts as seen, when the remaining time adapts to the durations so far."""


@dataclass
class _Runner:
    result: Run
    workers: Workers
    jobs: int
    quick: bool
    store: Store
    drawings: DrawingStore
    expected: Mapping[tuple[str, str], float]
    progress: Progress
    began: dict[Hashable, float] = field(default_factory=dict)
    start: float = field(default_factory=time.monotonic)
    took: list[tuple[str, str]] = field(default_factory=list)  # work that an earlier run had not done
    stamps: dict[str, str | None] = field(default_factory=dict)
    drawn_from: dict[str, str] = field(default_factory=dict)
    courses: dict[Hashable, tuple[Course, Generator[Work, Done, Findings]]] = field(default_factory=dict)

    def work(self, engines: Mapping[str, Engine], resume: bool) -> None:
        result = self.result
        work = {
            (study.name, column): (study, engines.get(column))
            for study in sorted(result.studies, key=lambda study: -study.seconds)
            for column in result.columns(study)
        }
        self.stamps = {column: engine_stamp(engines.get(column)) for column in {column for _, column in work}}
        for key, (study, engine) in work.items():
            found = self.store.find(*key, self.stamps[key[1]], study.identities) if resume else None
            if found is not None:
                result.outcomes[key], result.seconds[key] = found
            else:
                self._submit(key, study, engine)
        for study in result.studies:
            self._draw_if_complete(study.name)
        for i, erratum in enumerate(result.errata):
            self.workers.submit(("errata", i), erratum.evidence)
        for finished in self.workers.finished():
            self._take(finished)
        self.show([])

    def _submit(self, key: Hashable, study: Study, engine: Engine | None) -> None:
        """Submit a study as a whole, or claim by claim if only a part of it may exceed a time limit."""
        limit = LIMITS["quick"] if self.quick and self.workers.limit is None else self.workers.limit
        if engine is None or is_registered(engine.name) or limit is None or not study.sentences():
            self.workers.submit(key, measured, study, engine, owner=owner_of(engine))
            return
        course = Course(study, engine, limit, self.quick)
        self.courses[key] = course, course.claims()
        self._next(key, engine.name, None)

    def _next(self, key: Hashable, owner: str, last: Any) -> Done | None:
        """Submit the next claim of a study that is measured claim by claim; return the findings after the last."""
        course, steps = self.courses[key]
        try:
            work, limit = steps.send(last)
        except StopIteration as end:
            return Done(key, end.value, course.spent)
        self.workers.submit(key, measured, *work, owner=owner, limit=limit, first=last is not None)
        return None

    def show(self, running: Collection[Hashable]) -> None:
        result, now = self.result, time.monotonic()
        self.began = {key: self.began.get(key, now) for key in running}
        whole: dict[Hashable, float] = {
            key: self.expected.get(key, study.seconds)
            for study in result.studies
            for key in ((study.name, column) for column in result.columns(study))
        }
        spent = {key: min(now - began, whole[key]) for key, began in self.began.items() if key in whole}
        left = {key: each - spent.get(key, 0.0) for key, each in whole.items() if key not in result.outcomes}
        seen = sum(whole[key] for key in self.took) + sum(spent.values())
        elapsed = self.jobs * (now - self.start)  # with figures, errata and other load
        pace = (TRUSTED + elapsed) / (TRUSTED + seen)
        total = sum(len(result.columns(study)) + 1 for study in result.studies) + len(result.errata)
        names = ", ".join(_name_of(key) for key in running)
        seconds = pace * max(sum(left.values()) / self.jobs, *left.values(), 0.0)
        self.progress(result.done, total, names, seconds)

    def _take(self, done: Done) -> None:
        kind: Any
        name: Any
        kind, name = done.key  # type: ignore[misc]
        if kind == "errata":
            self.result.evidence[name] = done.value
            return
        if kind == "draw":
            self.result.drawings[name] = done.value
            if isinstance(done.value, Drawing):
                self.drawings.keep(name, self.drawn_from[name], done.value)
            return
        last = self._next(done.key, name, done) if done.key in self.courses else done
        if last is None:
            return
        self.result.outcomes[kind, name] = last.value
        self.result.seconds[kind, name] = last.seconds
        self.took.append((kind, name))
        if isinstance(last.value, Findings) and not last.value.gaps:
            self.store.keep(kind, name, self.stamps[name], last.value, last.seconds)
        self._draw_if_complete(kind)

    def _draw_if_complete(self, name: str) -> None:
        study = next(study for study in self.result.studies if study.name == name)
        if any((name, column) not in self.result.outcomes for column in self.result.columns(study)):
            return
        data = self.result.data(study)
        outcomes = {column: self.result.outcomes[name, column] for column in data}
        findings = {column: found for column, found in outcomes.items() if isinstance(found, Findings)}
        partial = [column for column, found in findings.items() if found.gaps or found.not_simulated]
        self.drawn_from[name] = drawing_stamp(data)
        found = self.drawings.find(name, self.drawn_from[name], study.figures)
        if found is not None:
            self.result.drawings[name] = found
        else:
            self.workers.submit(("draw", name), drawn, study, data, partial, first=True)


def _name_of(key: Any) -> str:
    first, second = key
    return "errata" if first == "errata" else f"{second} figures" if first == "draw" else f"{first} {second}"


# --- Engines by name. Their modules are imported in another process, because an import may end its process.


def loaded(names: Iterable[str], workers: Workers, seed: int | None = None) -> tuple[Engine, ...]:
    """Return the engines of the given names, loaded by the ``workers``.

    Raises ``ValueError`` for a name that is unknown or that the process could not load.
    """
    names = [known_name(name) for name in dict.fromkeys(names)]
    if all(map(is_registered, names)):
        found = engines(names)
    else:
        found = told_apart(names, [_loaded(name, workers) for name in names])
    return tuple(replace(engine, seed=seed) for engine in found)


def _loaded(name: str, workers: Workers) -> Engine:
    found = workers.ask(_described, name)
    if isinstance(found, str):
        raise ValueError(found)
    if isinstance(found, Failure):
        raise ValueError(f"cannot load engine {name!r}: {found}")
    engine: Engine = found
    return engine


def _described(name: str) -> Engine | str:
    """Return the engine, without references to its module, or the message of a ``ValueError``."""
    try:
        return engines([name])[0]
    except ValueError as error:
        return str(error)
