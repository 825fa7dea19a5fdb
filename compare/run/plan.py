"""Which motions a study asks for, as far as that does not depend on the answers.

Each claim is measured with an engine that answers as the reference does and writes down what it is asked, and once
more with answers that are a little off: where the same is asked, it would be asked of any engine.
"""

from __future__ import annotations

import hashlib
import json
from collections.abc import Callable, Iterable, Iterator, Sequence
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
"""Of the largest size of each component of a state: more than an engine's error, so that what hangs on it shows."""


@dataclass(frozen=True)
class Planned:
    """What a study asks for.

    Parameters
    ----------
    motions : tuple of bytes
        The questions, as lines for a program.
    claims : int
        How many claims they are enough for.
    adaptive : int
        How many claims ask for motions that depend on the answers, and were left out.

    """

    motions: tuple[bytes, ...]
    claims: int
    adaptive: int


@dataclass(eq=False)
class _Recorder:
    """The ``simulate`` of an engine that writes down what it is asked.

    No two are equal, so that nothing that a study keeps of one engine is taken for another.
    """

    answer: Callable[..., Trajectory]
    asked: dict[bytes, None] = field(default_factory=dict)

    def __call__(
        self, system: System, initial_state: ArrayLike, times: ArrayLike, *, tolerance: float
    ) -> Trajectory:
        line = question(system, initial_state, times, {"tolerance": tolerance})
        self.asked[line] = None
        return self.answer(line, system, initial_state, times, tolerance)


def planned(study: Study, kinds: tuple[str, ...]) -> Planned:
    """Return what ``study`` asks of an engine of ``kinds`` that tells no stick."""
    truth = _Truth()
    motions: dict[bytes, None] = {}
    claims = adaptive = 0
    for only in _pieces(study):
        exact, off = _Recorder(truth.exact), _Recorder(truth.off)
        found = _measured(study, exact, kinds, only)
        with suppress(Exception):  # whatever a study does with answers that are off
            _measured(study, off, kinds, only)
        if list(exact.asked) != list(off.asked):
            adaptive += found
        elif found > 0:  # not of another kind of system
            claims += found
            motions |= exact.asked
    return Planned(tuple(motions), claims, adaptive)


def _pieces(study: Study) -> Iterator[tuple[str, ...]]:
    """Yield what can be measured by itself: each claim."""
    for part in study.sentences().values():
        yield (part,)


def _measured(study: Study, recorder: _Recorder, kinds: tuple[str, ...], only: tuple[str, ...]) -> int:
    """Return how many claims are made of what the recorder answers."""
    return len(study.measure(Engine("plan", recorder, kinds, phases=False), only=only).claims)


class _Truth:
    """Answers of the reference, each computed once, without phases: files tell none."""

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
        """Return the motion with errors, which are the same each time."""
        found = self.exact(line, system, state, times, tolerance)
        draw = np.random.default_rng(int(hashlib.sha256(line).hexdigest()[:16], 16))
        size = OFF_BY * np.max(np.abs(found.states), axis=0)
        return Trajectory(
            system, found.times, found.states + size * draw.uniform(-1.0, 1.0, found.states.shape)
        )


def write_plan(folder: Path, kinds: Sequence[str], motions: Iterable[bytes]) -> None:
    """Write the index, and a file for each of the questions ``motions``; answers that are there stay."""
    names = []
    for line in motions:
        names.append(name_of(line))
        with replacing(folder / f"{names[-1]}.json", "wb") as stream:
            stream.write(line)
    content = {"format": FORMAT, "kinds": list(kinds), "motions": names}
    write_text(folder / INDEX, json.dumps(content, indent=0))
