"""The motions that a study requests, if they do not depend on the answers.

A recording engine gives exact and then slightly wrong answers. If its questions are equal, every engine would receive
them.
"""

from __future__ import annotations

import hashlib
import json
from collections.abc import Callable, Iterable, Sequence
from contextlib import suppress
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike

from compare.claims.study import Study
from compare.engines import Engine, reference
from compare.engines.outside.json_lines import question
from compare.engines.outside.motion_files import FORMAT, INDEX, name_of
from compare.output.text_files import replacing, write_text
from reference_model.systems import System
from reference_model.trajectory import Trajectory

OFF_BY = 1e-4
"""Error of the wrong answers relative to each component's size, larger than those of engines."""


@dataclass(frozen=True)
class Planned:
    """The motions that a study requests.

    - ``motions``: the questions, as lines for a program.
    - ``claims``: number of claims that need no other motions.
    - ``adaptive``: number of omitted claims, whose motions depend on the answers.
    """

    motions: tuple[bytes, ...]
    claims: int
    adaptive: int


@dataclass(eq=False)
class _Recorder:
    """The ``simulate`` of an engine that records its questions.

    No two instances are equal, so a study never reuses results of another one.
    """

    answer: Callable[..., Trajectory]
    asked: dict[bytes, None] = field(default_factory=dict)

    def __call__(
        self, system: System, initial_state: ArrayLike, times: ArrayLike, *, tolerance: float
    ) -> Trajectory:
        line = question(system, initial_state, times, {"tolerance": tolerance})
        self.asked[line] = None
        return self.answer(line, system, initial_state, times, tolerance)


def planned(study: Study, kinds: tuple[str, ...], seed: int | None = None) -> Planned:
    """Return the motions that ``study`` requests from an engine of ``kinds`` that reports no phases.

    ``seed`` is that of their units, see ``Engine.seed``.
    """
    truth = _Truth()
    motions: dict[bytes, None] = {}
    claims = adaptive = 0
    for part in study.sentences().values():
        exact, off = _Recorder(truth.exact), _Recorder(truth.off)
        found = _measured(study, Engine("plan", exact, kinds, phases=False, seed=seed), part)
        with suppress(Exception):  # a study may raise anything for wrong answers
            _measured(study, Engine("plan", off, kinds, phases=False, seed=seed), part)
        if list(exact.asked) != list(off.asked):
            adaptive += found
        elif found > 0:  # no claims if the system is of another kind
            claims += found
            motions |= exact.asked
    return Planned(tuple(motions), claims, adaptive)


def _measured(study: Study, engine: Engine, part: str) -> int:
    return len(study.measure(engine, only=(part,)).claims)


class _Truth:
    """Cached answers of the reference, without phases."""

    def __init__(self) -> None:
        self._known: dict[bytes, Trajectory] = {}

    def exact(
        self, line: bytes, system: System, state: ArrayLike, times: ArrayLike, tolerance: float
    ) -> Trajectory:
        """Return the motion."""
        if line not in self._known:
            found = reference.function(system, state, times, tolerance=tolerance)
            self._known[line] = Trajectory(system, found.times, found.states)
        return self._known[line]

    def off(
        self, line: bytes, system: System, state: ArrayLike, times: ArrayLike, tolerance: float
    ) -> Trajectory:
        """Return the motion with reproducible random errors."""
        found = self.exact(line, system, state, times, tolerance)
        draw = np.random.default_rng(int(hashlib.sha256(line).hexdigest()[:16], 16))
        size = OFF_BY * np.max(np.abs(found.states), axis=0)
        return Trajectory(
            system, found.times, found.states + size * draw.uniform(-1.0, 1.0, found.states.shape)
        )


def write_plan(folder: Path, kinds: Sequence[str], motions: Iterable[bytes]) -> None:
    """Write the index and a file for each question in ``motions``; existing answers are kept."""
    names = []
    for line in motions:
        names.append(name_of(line))
        with replacing(folder / f"{names[-1]}.json", "wb") as stream:
            stream.write(line)
    content = {"format": FORMAT, "kinds": list(kinds), "motions": names}
    write_text(folder / INDEX, json.dumps(content, indent=0))
