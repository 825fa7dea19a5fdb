"""The motions that a study requests, if they do not depend on the answers.

A recording engine gives exact and then slightly wrong answers. If its questions are equal, every engine would receive
them.
"""

import hashlib
import json
from collections.abc import Iterable, Sequence
from contextlib import suppress
from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike

from compare.claims.study import Study
from compare.engines import Engine, reference
from compare.engines.outside.json_lines import question
from compare.engines.outside.motion_files import FORMAT, INDEX, name_of
from compare.output.text_files import replacing, write_text
from reference_model.systems import FloatArray, System
from reference_model.trajectory import Trajectory

OFF_BY = 1e-4
"""Error of the wrong answers relative to each component's size, larger than the errors of engines."""


@dataclass(frozen=True)
class Planned:
    """The motions of a study as lines for a program, and the numbers of claims with and without fixed motions."""

    motions: tuple[bytes, ...]
    claims: int
    adaptive: int


@dataclass(eq=False)
class _Recorder:
    """The ``simulate`` of an engine that records its questions; its answers are exact, or wrong by ``OFF_BY``.

    No two instances are equal, so a study never reuses results of another engine. ``known`` contains the exact
    motions.
    """

    known: dict[bytes, Trajectory]
    exact: bool
    asked: dict[bytes, None] = field(default_factory=dict)

    def __call__(
        self, system: System, initial_state: ArrayLike, times: ArrayLike, *, tolerance: float
    ) -> Trajectory:
        line = question(system, initial_state, times, {"tolerance": tolerance})
        self.asked[line] = None
        if line not in self.known:
            motion = reference.function(system, initial_state, times, tolerance=tolerance)
            self.known[line] = Trajectory(system, motion.times, motion.states)
        found = self.known[line]
        return found if self.exact else replace(found, states=found.states + _errors(line, found.states))


def _errors(line: bytes, states: FloatArray) -> FloatArray:
    """Return reproducible random errors."""
    draw = np.random.default_rng(int(hashlib.sha256(line).hexdigest()[:16], 16))
    size: FloatArray = OFF_BY * np.max(np.abs(states), axis=0)
    return size * draw.uniform(-1.0, 1.0, states.shape)


def planned(study: Study, kinds: tuple[str, ...], seed: int | None = None) -> Planned:
    """Return the motions that ``study`` requests from an engine of ``kinds`` without phases, in units of ``seed``."""
    known: dict[bytes, Trajectory] = {}
    motions: dict[bytes, None] = {}
    claims = adaptive = 0
    for part in study.sentences().values():
        exact, off = _Recorder(known, exact=True), _Recorder(known, exact=False)
        plan = Engine("plan", exact, kinds, phases=False, seed=seed)
        found = len(study.measure(plan, only=(part,)).claims)
        with suppress(Exception):  # a study may raise anything for wrong answers
            study.measure(replace(plan, function=off), only=(part,))
        if list(exact.asked) != list(off.asked):
            adaptive += found
        elif found > 0:  # no claims if the system is of another kind
            claims += found
            motions |= exact.asked
    return Planned(tuple(motions), claims, adaptive)


def write_plan(folder: Path, kinds: Sequence[str], motions: Iterable[bytes]) -> None:
    """Write the index and a file for each question in ``motions``; existing answers are kept."""
    names = []
    for line in motions:
        names.append(name_of(line))
        with replacing(folder / f"{names[-1]}.json", "wb") as stream:
            stream.write(line)
    content = {"format": FORMAT, "kinds": list(kinds), "motions": names}
    write_text(folder / INDEX, json.dumps(content, indent=0))
