"""Measure the claims of one study about one engine, for reports and for pytest."""

from __future__ import annotations

import functools
import math
import time
from collections.abc import Collection, Generator
from dataclasses import dataclass, replace
from typing import Any

from compare.claims.study import Findings, Study
from compare.engines import Engine, UnsupportedSystemError, engines
from compare.output.outside_text import Failure, printable
from compare.run.workers import Workers, attempted
from reference_model.systems import PinOnDisc

START_UP = 60.0
"""Additional time in s for the start of a process, which imports the engine and the study."""

NO_CLAIM = "-"
"""Selector that fits no claim."""

Work = tuple[tuple[Any, ...], float]
"""Arguments of ``measured``, and a time limit in s."""


@dataclass
class Course:
    """Measurements of single claims about one engine, within the time that the other claims of the study leave.

    One process should measure all claims, because later claims then reuse earlier motions. ``ready`` is True if it
    has imported the engine.
    """

    study: Study
    engine: Engine | str
    limit: float
    quick: bool
    seed: int | None = None
    spent: float = 0.0
    ready: bool = False

    def claim(self, part: str) -> Generator[Work, Any, Findings | Failure | str]:
        """Yield work and receive its results; return those of one claim, or why there are none."""
        name = self.engine if isinstance(self.engine, str) else self.engine.name
        longer = f"the study {self.study.name} takes longer than {self.limit:g} s with {name}; "
        longer += "use --level full" if self.quick else "use a larger --study-limit"
        if self.spent >= self.limit:
            return longer
        if not self.ready:  # imports do not count
            yield self._work(NO_CLAIM), self.limit + START_UP
        began, left = time.monotonic(), max(round(self.limit - self.spent, 1), 0.1)  # for people to read
        found: Findings | Failure = yield self._work(part, left if self.quick else math.inf), left
        self.spent += time.monotonic() - began
        self.ready = isinstance(found, Findings)  # a failure may have ended the process
        if isinstance(found, Findings):
            return next(iter(found.gaps.values()), found)
        return longer if self.quick and self.spent >= self.limit else found

    def claims(self) -> Generator[Work, Any, Findings]:
        """Yield work and receive its results; return the findings about all claims."""
        found = Findings()
        for sentence, part in self.study.sentences().items():
            found = found.and_claim(sentence, (yield from self.claim(part)))
        return found

    def _work(self, part: str, within: float = math.inf) -> tuple[Any, ...]:
        return self.study, self.engine, (part,), self.seed, within


class Bench:
    """Measure one claim at a time, see ``Course``."""

    def __init__(self, limit: float, seed: int | None, *, quick: bool) -> None:
        self.seed = seed
        self._workers = Workers(1)
        self._limit, self._quick = limit, quick
        self._courses: dict[tuple[str, str], Course] = {}
        self._last: Course | None = None

    def outcome(self, study: Study, engine: str, part: str) -> Findings | Failure:
        """Return the findings of one ``part`` of ``study`` for the engine of that name, or the failure."""
        new = Course(study, engine, self._limit, self._quick, self.seed)
        course = self._courses.setdefault((study.name, engine), new)
        course.ready = course.ready and self._last is course
        self._last, steps, found = course, course.claim(part), None
        while True:
            try:
                work, self._workers.limit = steps.send(found)
            except StopIteration as end:
                return Findings(not_simulated=end.value) if isinstance(end.value, str) else end.value
            found = self._workers.ask(measured, *work, owner=engine)

    def close(self) -> None:
        """End the measuring process."""
        self._workers.__exit__(None, None, None)


def measured(
    study: Study,
    engine: Engine | str | None,
    only: Collection[str] = (),
    seed: int | None = None,
    within: float = math.inf,
) -> Findings:
    """Run the study's ``measure``, or its theory if ``engine`` is None.

    An engine given by name is imported here; ``seed`` is for its units. ``only`` selects claims as in
    ``Study.measure``. An exception costs only the claim that raised it, and a claim that would take longer than
    ``within`` (in s) at the engine's pace is not attempted, see ``Findings.gaps``.
    """
    if isinstance(engine, str):
        engine = replace(engines([engine])[0], seed=seed)
    if engine is None:
        return _checked(study.measure_theory(only=only) if study.has_theory else None)
    if not (parts := study.sentences()):
        return _simulated(study, engine, only)
    found = Findings()
    for sentence, part in parts.items():
        if only and part not in only:
            continue
        if within < math.inf and (estimate := study.duration(part) * pace(engine)) > within:
            late = f"would take about {float(f'{estimate:.2g}'):g} s with {engine.name}; use --level full"
            found = found.and_claim(sentence, late)
        else:
            found = found.and_claim(sentence, attempted(_simulated, study, engine, (part,)))
    return found


def _simulated(study: Study, engine: Engine, only: Collection[str]) -> Findings:
    try:
        return _checked(study.measure(engine, only=only))
    except UnsupportedSystemError as error:
        return Findings(not_simulated=printable(error))


def _checked(findings: object) -> Findings:
    if not isinstance(findings, Findings):
        raise TypeError(f"the study returned {type(findings).__name__}, but must return Findings")
    return replace(findings, not_simulated=printable(findings.not_simulated))


PACED = PinOnDisc(mass=1.0, stiffness=1.0, damping=0.0, friction_force=0.1, disc_speed=0.0, offset=0.0)

PACE_STEPS = 500


@functools.cache
def pace(engine: Engine) -> float:
    """Return the wall-clock time for a second of motion; 0 if ``engine`` has no fixed step or no result."""
    found = attempted(_paced, engine) if engine.step is not None else 0.0
    return found if isinstance(found, float) else 0.0


def _paced(engine: Engine) -> float:
    assert engine.step is not None
    start, lasts = (1.0, 0.0, 0.0, 0.0), PACE_STEPS * engine.step
    engine.simulate(PACED, start, (0.0, lasts))  # the first call may compile
    began = time.perf_counter()
    engine.simulate(PACED, start, (0.0, lasts))
    return (time.perf_counter() - began) / lasts
