"""Measure the claims of one study about one engine, for reports and for pytest."""

import functools
import math
from collections.abc import Collection, Generator
from dataclasses import dataclass, replace
from typing import Any

from compare.claims.study import Findings, Study
from compare.engines import Engine, engines
from compare.engines.outside.processor_time import processor_time
from compare.output.outside_text import Failure
from compare.run.workers import Done, Workers, attempted
from reference_model.systems import PinOnDisc

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
    has imported the engine.
    """

    study: Study
    engine: Engine | str
    limit: float
    quick: bool
    seed: int | None = None
    spent: float = 0.0
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
        done = yield self._work(part, left if self.quick else math.inf), left
        found: Findings | Failure = done.value
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
        return self.study, self.engine, (part,), self.seed, within


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
) -> Findings:
    """Run the study's ``measure``, or its theory if ``engine`` is None.

    An engine given by name is imported here; ``seed`` is for its units. ``only`` selects claims as in
    ``Study.measure``. An exception costs only the claim that raised it, and a claim that would take longer than
    ``within`` (in s) at the engine's pace is not attempted, see ``Findings.gaps``.
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
        if within < math.inf and (estimate := study.duration(part) * pace(engine)) > within:
            late = f"would take about {float(f'{estimate:.2g}'):g} s with {engine.name}; use --level full"
            found = found.and_claim(sentence, late)
        else:
            found = found.and_claim(sentence, attempted(study.measure, engine, only=(part,)))
    return found


PACED = PinOnDisc(mass=1.0, stiffness=1.0, damping=0.0, friction_force=0.1, disc_speed=0.0, offset=0.0)

PACE_STEPS = 500


@functools.cache
def pace(engine: Engine) -> float:
    """Return the processor time in s for a second of motion; 0 if ``engine`` has no fixed step or no result."""
    found = attempted(_paced, engine) if engine.step is not None else 0.0
    return found if isinstance(found, float) else 0.0


def _paced(engine: Engine) -> float:
    assert engine.step is not None
    start, lasts = (1.0, 0.0, 0.0, 0.0), PACE_STEPS * engine.step
    engine.simulate(PACED, start, (0.0, lasts))  # the first call may compile
    began = processor_time()
    engine.simulate(PACED, start, (0.0, lasts))
    return (processor_time() - began) / lasts
