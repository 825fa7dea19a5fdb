"""Refinement of a basin's boundary: only points of a fine grid near the boundary are simulated.

A cell of the coarse grid is mixed if its corners end differently. Mixed cells are halved and their new points
simulated; new points of other cells are assumed to end like the corners. If this is wrong, the boundary continues
into a mixed cell with corners that were not simulated. These are then simulated, so *all corners of every mixed cell
of the finest grid were simulated*. Structures between points of the coarse grid are not detected.
"""

from collections.abc import Generator
from typing import TypeAlias

import numpy as np

from compare.claims.shares import BoolArray, Ends, IntArray, mixed

Lines: TypeAlias = tuple[IntArray, IntArray]
"""Positions of a coarser grid's lines on the finest grid, along y and x."""


class Grid:
    """The finest grid: ends of its points, and marks of simulated points, both of shape (y, x).

    Ends on lines not yet in use are meaningless.
    """

    def __init__(self, shape: tuple[int, int]) -> None:
        self.ends: Ends = np.zeros(shape, dtype=np.uint8)
        self.simulated: BoolArray = np.zeros(shape, dtype=bool)

    def found(self, numbers: IntArray, ends: Ends) -> None:
        """Store the ends of simulated points."""
        self.ends.flat[numbers], self.simulated.flat[numbers] = np.asarray(ends), True

    def lines(self, stride: int) -> Lines:
        """Return every ``stride``-th line of the grid, and the last line."""
        y, x = (np.union1d(np.arange(0, points, stride), points - 1) for points in self.ends.shape)
        return y, x

    def numbers(self, lines: Lines, chosen: BoolArray) -> IntArray:
        """Return the numbers of the points ``chosen``, shape (y, x), on ``lines``."""
        y, x = np.nonzero(chosen)
        return np.ravel_multi_index((lines[0][y], lines[1][x]), self.ends.shape)

    def guessed_corners(self, lines: Lines) -> IntArray:
        """Return the corners of mixed cells that were not simulated."""
        corner = np.zeros((len(lines[0]), len(lines[1])), dtype=bool)
        cells = mixed(self.ends[np.ix_(*lines)])
        for place in (np.s_[:-1, :-1], np.s_[1:, :-1], np.s_[:-1, 1:], np.s_[1:, 1:]):
            corner[place] |= cells
        return self.numbers(lines, corner & ~self.simulated[np.ix_(*lines)])

    def halved(self, lines: Lines, finer: Lines) -> IntArray:
        """Return the new points of mixed cells; give others the ends of their corners."""
        coarse = self.ends[np.ix_(*lines)]
        cells = mixed(coarse)
        # A point on a line belongs to the cells on both sides of it.
        before, behind = zip(*(_cells(*both) for both in zip(lines, finer, strict=True)), strict=True)
        in_mixed = np.zeros((len(finer[0]), len(finer[1])), dtype=bool)
        for y in (before[0], behind[0]):
            for x in (before[1], behind[1]):
                in_mixed |= cells[np.ix_(y, x)]
        places = np.ix_(*finer)
        simulated = self.simulated[places]
        self.ends[places] = np.where(simulated, self.ends[places], coarse[np.ix_(*before)])
        return self.numbers(finer, in_mixed & ~simulated)


def refined(shape: tuple[int, int], coarse: int) -> Generator[IntArray, Ends, Grid]:
    """Yield the points to simulate in each round, numbered y·(points of x) + x; receive their ends.

    The first grid has at least ``coarse`` points along each axis. Returns the finest grid, of ``shape`` (y, x).
    """
    grid = Grid(shape)
    stride = first_stride(shape, coarse)
    lines = grid.lines(stride)
    missing = grid.numbers(lines, np.ones((len(lines[0]), len(lines[1])), dtype=bool))
    while True:
        while missing.size:
            grid.found(missing, (yield missing))
            missing = grid.guessed_corners(lines)
        if stride == 1:
            return grid
        stride //= 2
        finer = grid.lines(stride)
        missing = grid.halved(lines, finer)
        lines = finer


def first_stride(shape: tuple[int, int], coarse: int) -> int:
    """Return the largest stride, a power of two, that leaves ``coarse`` points along each axis, or 1."""
    stride = 1
    while (min(shape) - 1) // (2 * stride) + 1 >= coarse:
        stride *= 2
    return stride


def _cells(lines: IntArray, finer: IntArray) -> tuple[IntArray, IntArray]:
    """Return the cells before and behind each finer line."""
    last = len(lines) - 2
    before = np.clip(np.searchsorted(lines, finer, side="left") - 1, 0, last)
    behind = np.clip(np.searchsorted(lines, finer, side="right") - 1, 0, last)
    return before, behind
