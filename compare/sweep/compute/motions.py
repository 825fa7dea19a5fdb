"""Groups the ends of many starts into motions, and connects motions of successive values into branches."""

from collections.abc import Callable, Hashable, Sequence
from typing import NamedTuple, TypeVar

import numpy as np

from compare.claims.shares import Ends
from reference_model.ensemble import EndState
from reference_model.systems import FloatArray

GAP = 0.05
"""Relative gap in the largest radius between two motions; a single motion scatters by less."""

JUMP = 0.3  # largest relative difference between the radii of a motion and of its extrapolated branch


class Motion(NamedTuple):
    """A motion that starts end in: its kind, their number, medians of least and largest radius in m."""

    end: int
    starts: int
    least: float
    largest: float


def motions_of(ends: Ends, least: FloatArray, largest: FloatArray) -> list[Motion]:
    """Return the motions that starts end in, without undecided starts; all arguments have shape (n,).

    A gap between radii separates motions of one kind, except stuck motions, because a pin may stick anywhere.
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


class TheoryMotion(NamedTuple):
    """A motion of the theory: its kind, least and largest radius in m, and stability."""

    meaning: str
    least: float
    largest: float
    stable: bool


One = TypeVar("One", Motion, TheoryMotion)


def matched(found: Sequence[Sequence[One]], kind: Callable[[One], Hashable]) -> list[dict[int, One]]:
    """Return branches of motions; each maps indices of values to motions.

    A branch continues with the motion of its kind nearest to a linear extrapolation; nearest pairs are matched first.
    A motion farther than ``JUMP`` from all branches begins a new branch.
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
    last = branch[i - 1]
    before = branch.get(i - 2, last)
    size = max(last.largest, motion.largest)
    expected = (2.0 * last.least - before.least, 2.0 * last.largest - before.largest)
    apart = max(abs(motion.least - expected[0]), abs(motion.largest - expected[1]))
    return apart / size if size > 0.0 else 0.0
