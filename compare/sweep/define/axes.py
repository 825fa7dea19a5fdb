"""Axes of a plane: a name, a range, and how many values."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

from compare.engines import one_of
from reference_model.systems import FloatArray, finite_number

MOST_POINTS = 100_000


@dataclass(frozen=True)
class Axis:
    """Values of a component of the state or of a parameter at equal distances.

    Parameters
    ----------
    name : str
        The component or parameter.
    low, high : float
        Its first and last value, in its SI unit; low < high.
    points : int
        Number of values, from 2 to 100,000.

    Raises
    ------
    ValueError
        If the range is empty or not finite, or for another number of points.

    """

    name: str
    low: float
    high: float
    points: int

    def __post_init__(self) -> None:
        """Refuse what has no points."""
        if not self.low < self.high:
            raise ValueError(
                f"{self.name} from {self.low:g} to {self.high:g}: the range must begin below its end"
            )
        if not math.isfinite(self.high - self.low):
            raise ValueError(f"{self.name} from {self.low:g} to {self.high:g}: the range must be finite")
        if not 2 <= self.points <= MOST_POINTS:
            raise ValueError(f"{self.name} with {self.points} points: there must be 2 to {MOST_POINTS}")

    @classmethod
    def parse(cls, text: str, kind: str, names: Iterable[str]) -> Axis:
        """Return the axis that "NAME=LOW:HIGH:POINTS" says; raise ``ValueError`` for anything else.

        ``names`` are those that are allowed, ``kind`` says what they are.
        """
        name, _, numbers = text.partition("=")
        parts = numbers.split(":")
        if len(parts) != 3:
            raise ValueError(f"axis {text!r}: write it as NAME=LOW:HIGH:POINTS")
        name = one_of(kind, name.strip(), names)
        low, high = (finite_number(name, part) for part in parts[:2])
        try:
            points = int(parts[2])
        except ValueError:
            raise ValueError(f"axis {text!r}: the number of points must be a whole number") from None
        return cls(name, low, high, points)

    @property
    def values(self) -> FloatArray:
        """All values, shape (points,)."""
        return np.linspace(self.low, self.high, self.points)
