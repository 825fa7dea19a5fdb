"""Which motions the ends of many starts are, and which of them continue each other from value to value."""

from __future__ import annotations

from collections.abc import Callable, Hashable, Sequence
from typing import NamedTuple, Protocol, TypeVar

import numpy as np

from compare.claims.shares import Ends
from reference_model.ensemble import EndState
from reference_model.systems import FloatArray

GAP = 0.05
"""Relative gap in the largest radius between two motions that end as the same: single ones scatter by less."""

JUMP = 0.3
"""Relative difference of the radii, from what the two values before let expect, up to which a motion goes on."""


class Motion(NamedTuple):
    """What some of the starts end in: how, how many starts, and the median of their least and largest radius in m."""

    end: int
    starts: int
    least: float
    largest: float


def motions_of(ends: Ends, least: FloatArray, largest: FloatArray) -> list[Motion]:
    """Return the motions in which starts end, each argument of shape (n,); the undecided are none.

    Motions that end as the same are told apart by a gap between their radii; but those of a pin that is stuck, which
    may be stuck anywhere, are one.
    """
    found = []
    for end in EndState:
        here = np.flatnonzero((ends == end) & (end != EndState.UNDECIDED))
        if here.size == 0:
            continue
        here = here[np.argsort(largest[here], kind="stable")]
        radii = largest[here]
        apart = np.diff(radii) > GAP * radii[1:]
        if end == EndState.STUCK:
            apart[:] = False
        for group in np.split(here, np.flatnonzero(apart) + 1):
            middle = (float(np.median(values[group])) for values in (least, largest))
            found.append(Motion(int(end), group.size, *middle))
    return found


class Sized(Protocol):
    """Something that has a least and a largest radius in m."""

    @property
    def least(self) -> float:
        """The least."""
        ...

    @property
    def largest(self) -> float:
        """The largest."""
        ...


One = TypeVar("One", bound=Sized)


def matched(found: Sequence[Sequence[One]], kind: Callable[[One], Hashable]) -> list[dict[int, One]]:
    """Return branches of motions, each with the motion at the places of the values where it is there.

    A branch goes on with that motion of its kind which is nearest to what the line through its last two lets expect;
    the nearest pairs come first. What is farther than ``JUMP``, or has no branch to go on, begins a new one. Where a
    branch has no motion it ends.
    """
    branches: list[dict[int, One]] = []
    for i, here in enumerate(found):
        going_on = [branch for branch in branches if i - 1 in branch]
        pairs = sorted(
            (_distance(branch, i, motion), j, k)
            for j, branch in enumerate(going_on)
            for k, motion in enumerate(here)
            if kind(branch[i - 1]) == kind(motion)
        )
        taken: set[int] = set()
        for distance, j, k in pairs:
            if distance <= JUMP and i not in going_on[j] and k not in taken:
                going_on[j][i] = here[k]
                taken.add(k)
        branches.extend({i: motion} for k, motion in enumerate(here) if k not in taken)
    return branches


def _distance(branch: dict[int, One], i: int, motion: One) -> float:
    """Return how far a motion is from what a branch lets expect at place ``i``, as a part of the radius."""
    last = branch[i - 1]
    before = branch.get(i - 2, last)
    size = max(last.largest, motion.largest)
    expected = (2.0 * last.least - before.least, 2.0 * last.largest - before.largest)
    apart = max(abs(motion.least - expected[0]), abs(motion.largest - expected[1]))
    return apart / size if size > 0.0 else 0.0
