"""Measures single claims about engines within a time limit for each study."""

from __future__ import annotations

from compare.claims.study import Findings, Study
from compare.run.measuring import Course, measured
from compare.run.workers import Failure, Workers


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
