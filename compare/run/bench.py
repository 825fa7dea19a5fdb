"""Measures single claims about engines within a time limit for each study."""

from __future__ import annotations

import time
from collections import defaultdict
from collections.abc import Callable
from typing import Any

from compare.claims.study import Findings, Study
from compare.run.runner import measured, pace
from compare.run.workers import Failure, Workers

START_UP = 60.0
"""Additional time in s for the start of a process and its imports."""

NO_CLAIM = "-"
"""Selector that fits no claim."""


class Bench:
    """Measures one claim at a time, within the time that the other claims of its study leave."""

    def __init__(self, limit: float, seed: int | None, *, quick: bool) -> None:
        self.seed = seed
        self._workers = Workers(1)
        self._limit, self._quick = limit, quick
        self._ready: tuple[str, str] | None = None
        self._spent: defaultdict[tuple[str, str], float] = defaultdict(float)
        self._pace: dict[str, float] = {}

    def outcome(self, study: Study, engine: str, part: str) -> Findings | Failure:
        """Return the findings of one ``part`` of ``study`` for the engine of that name, or the failure.

        One process measures all claims, so later ones reuse the motions of earlier ones.
        """
        key = (study.name, engine)
        left = self._limit - self._spent[key]
        longer = f"the study {study.name} takes longer than {self._limit:g} s with {engine}; "
        longer += "use --level full" if self._quick else "use a larger --study-limit"
        if left <= 0.0:
            return Findings(not_simulated=longer)
        if self._quick and (estimate := study.duration(part) * self._pace_of(engine)) > left:
            return Findings(
                not_simulated=f"would take about {estimate:.2g} s with {engine}; use --level full"
            )
        if self._ready != key:  # imports do not count
            self._ask(self._limit + START_UP, engine, measured, study, engine, (NO_CLAIM,), self.seed)
        began = time.monotonic()
        found: Findings | Failure = self._ask(left, engine, measured, study, engine, (part,), self.seed)
        self._spent[key] += time.monotonic() - began
        self._ready = key if isinstance(found, Findings) else None  # a failure may have ended the process
        out_of_time = self._spent[key] >= self._limit and not isinstance(found, Findings)
        return Findings(not_simulated=longer) if out_of_time and self._quick else found

    def _pace_of(self, engine: str) -> float:
        """Return the time for a second of motion, 0 without a fixed step or a result."""
        if engine not in self._pace:
            found = self._ask(self._limit + START_UP, engine, pace, engine)
            self._pace[engine] = found if isinstance(found, float) else 0.0
        return self._pace[engine]

    def _ask(self, limit: float, engine: str, function: Callable[..., Any], *arguments: Any) -> Any:
        self._workers.limit = limit
        return self._workers.ask(function, *arguments, owner=engine)

    def close(self) -> None:
        """End the measuring process."""
        self._workers.__exit__(None, None, None)
