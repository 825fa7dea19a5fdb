"""Measure the claims of one study about one engine, for reports and for pytest."""

import math
from collections.abc import Collection, Generator
from dataclasses import dataclass, replace
from typing import Any

from compare.claims.study import Findings, Study
from compare.engines import Engine, engines
from compare.output.outside_text import Failure
from compare.run.levels import QUICK_STEPS
from compare.run.workers import Done, Workers, attempted

START_UP = 60.0
"""Additional time in s for the start of a process, which imports the engine and the study."""

NO_CLAIM = "-"
"""Selector that fits no claim."""

Work = tuple[tuple[Any, ...], float]
"""Arguments of ``measured``, and a limit of processor time in s."""


@dataclass
class Course:
    """Measurements of single claims about one engine, within the processor time that the other claims leave.

    One process should measure all claims, because later claims then reuse earlier motions. ``ready`` is True if it
    has imported the engine. ``moved`` is the duration in s of the motions of its claims.
    """

    study: Study
    engine: Engine | str
    limit: float
    quick: bool
    seed: int | None = None
    spent: float = 0.0
    moved: float = 0.0
    ready: bool = False

    def claim(self, part: str) -> Generator[Work, Done, Findings | Failure | str]:
        """Yield work and receive its results; return the results of one claim, or why there are none."""
        name = self.engine if isinstance(self.engine, str) else self.engine.name
        longer = f"the study {self.study.name} takes longer than {self.limit:g} s with {name}; "
        longer += "use --level full" if self.quick else "use a larger --study-limit"
        if self.spent >= self.limit:
            return longer
        if not self.ready:  # imports do not count
            yield self._work(NO_CLAIM), self.limit + START_UP
        left = max(round(self.limit - self.spent, 1), 0.1)  # for people to read
        done = yield self._work(part, QUICK_STEPS if self.quick else math.inf), left
        found: Findings | Failure = done.value
        self.moved += self.study.duration(part) * (not isinstance(found, Findings) or not found.gaps)
        self.spent += done.spent
        self.ready = isinstance(found, Findings)  # a failure may have ended the process
        if isinstance(found, Findings):
            return next(iter(found.gaps.values()), found)
        return longer if self.quick and self.spent >= self.limit else found

    def claims(self) -> Generator[Work, Done, Findings]:
        """Yield work and receive its results; return the findings about all claims."""
        found = Findings()
        for sentence, part in self.study.sentences().items():
            found = found.and_claim(sentence, (yield from self.claim(part)))
        return found

    def _work(self, part: str, within: float = math.inf) -> tuple[Any, ...]:
        return self.study, self.engine, (part,), self.seed, within, self.moved


class Bench:
    """Measure one claim at a time, see ``Course``."""

    def __init__(self, limit: float, seed: int | None, *, quick: bool) -> None:
        self.seed = seed
        self._workers = Workers(1)
        self._limit, self._quick = limit, quick
        self._courses: dict[tuple[str, str], Course] = {}
        self._last: Course | None = None

    def outcome(self, study: Study, engine: str, part: str) -> Findings | Failure | str:
        """Return the findings of one ``part`` of ``study`` for the engine of that name, or why there are none."""
        new = Course(study, engine, self._limit, self._quick, self.seed)
        course = self._courses.setdefault((study.name, engine), new)
        course.ready = course.ready and self._last is course
        self._last, steps = course, course.claim(part)
        done: Any = None
        while True:
            try:
                work, limit = steps.send(done)
            except StopIteration as end:
                result: Findings | Failure | str = end.value
                return result
            self._workers.submit(part, measured, *work, owner=engine, limit=limit)
            (done,) = self._workers.finished()

    def close(self) -> None:
        """End the measuring process."""
        self._workers.__exit__(None, None, None)


def measured(
    study: Study,
    engine: Engine | str | None,
    only: Collection[str] = (),
    seed: int | None = None,
    within: float = math.inf,
    moved: float = 0.0,
) -> Findings:
    """Run the study's ``measure``, or its theory if ``engine`` is None.

    An engine given by name is imported here; ``seed`` is for its units. ``only`` selects claims as in
    ``Study.measure``. An exception costs only the claim that raised it. A claim that needs more than ``within``
    steps, counted with earlier motions of ``moved`` s, is not attempted, see ``Findings.gaps``.
    """
    if isinstance(engine, str):
        engine = replace(engines([engine])[0], seed=seed)
    if engine is None:
        return study.measure_theory(only=only)
    if not (parts := study.sentences()):
        return study.measure(engine, only=only)
    found = Findings()
    for sentence, part in parts.items():
        if only and part not in only:
            continue
        lasts = moved + study.duration(part)
        if engine.step is not None and lasts / engine.step > within:
            late = f"needs more than the {within:,.0f} steps that a study of the quick level allows; use --level full"
            found = found.and_claim(sentence, late)
        else:
            moved = lasts
            found = found.and_claim(sentence, attempted(study.measure, engine, only=(part,)))
    return found
