"""Refinement of a basin's boundary: of a fine grid only those points are simulated that lie near to it.

On a coarse grid every point is simulated. Cells whose corners do not all end as the same are halved, and their new
points simulated; the new points of the other cells are taken to end as the corners do. Where that is wrong, the
boundary goes on beyond the cells that were halved, and a cell with different corners has one that was not
simulated: it is then, until there is no such cell. So in the end *every cell of the finest grid whose corners differ
has corners that were all simulated*. What lies wholly between the points of the coarse grid stays unseen.
"""

from __future__ import annotations

from collections.abc import Generator
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from compare.claims.shares import Ends, mixed

IntArray = NDArray[np.int64]
BoolArray = NDArray[np.bool_]

Lines: TypeAlias = tuple[IntArray, IntArray]
"""Places on the finest grid, along y and x, of the lines of a coarser one."""


class Grid:
    """The finest grid: what its points end as, and which of them were simulated, both of shape (y, x).

    Points that were neither simulated nor lie on a grid that is in use have no meaning yet.
    """

    def __init__(self, shape: tuple[int, int]) -> None:
        self.ends: Ends = np.zeros(shape, dtype=np.uint8)
        self.simulated: BoolArray = np.zeros(shape, dtype=bool)

    def found(self, numbers: IntArray, ends: Ends) -> None:
        """Take what points ended as."""
        self.ends.flat[numbers], self.simulated.flat[numbers] = np.asarray(ends), True

    def lines(self, stride: int) -> Lines:
        """Return the lines of the grid with every ``stride``-th point and the last one."""
        y, x = (np.union1d(np.arange(0, points, stride), points - 1) for points in self.ends.shape)
        return y, x

    def numbers(self, lines: Lines, chosen: BoolArray) -> IntArray:
        """Return the numbers of the ``chosen`` points of a grid, shape (y, x)."""
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
        """Return the new points of mixed cells; the others get the ends of the corners of their cells."""
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
    """Yield round by round which points to simulate, as y·(points of x) + x; take what they end as.

    Parameters
    ----------
    shape : tuple of int
        Number of y and of x of the finest grid.
    coarse : int
        Least number of points along each axis of the first grid.

    Returns
    -------
    Grid
        In the end.

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
    """Return the largest power of two that leaves at least ``coarse`` points along each axis, or 1."""
    stride = 1
    while (min(shape) - 1) // (2 * stride) + 1 >= coarse:
        stride *= 2
    return stride


def _cells(lines: IntArray, finer: IntArray) -> tuple[IntArray, IntArray]:
    """Return the cells between ``lines`` before and behind each finer line."""
    last = len(lines) - 2
    before = np.clip(np.searchsorted(lines, finer, side="left") - 1, 0, last)
    behind = np.clip(np.searchsorted(lines, finer, side="right") - 1, 0, last)
    return before, behind
