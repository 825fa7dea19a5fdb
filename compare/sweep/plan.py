"""Plans of sweeps: initial state and parameters of each trajectory by its number.

A refined basin has a round of trajectories for each step of the refinement; other plans have one round.
"""

import math
from abc import ABC, abstractmethod
from collections.abc import Generator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, ClassVar, TypeAlias

import numpy as np

from compare.claims.as_json import as_json, from_json
from compare.claims.shares import Ends, IntArray
from compare.sweep.distributions import Uncertain, uniform_rows
from compare.sweep.quantities import Axis, components, parameters, units
from compare.sweep.refinement import refined
from reference_model.systems import FloatArray, System, checked_state, checked_tolerance

Numbers: TypeAlias = range | IntArray

Rounds: TypeAlias = Generator[Numbers, Ends, Any]
"""Yields the numbers of a round and receives their ends; a refined basin returns its grid."""

Trajectories: TypeAlias = tuple[FloatArray, dict[str, FloatArray]]
"""Initial states of shape (n, 4 or 6) and the swept parameters, each of shape (n,)."""

MOST_POINTS = 100_000_000
BASES = 2  # independent samples for the sensitivities


@dataclass(frozen=True, kw_only=True)
class Plan(ABC):
    """Fields that all plans share.

    The ``system`` contains the fixed parameters. A trajectory lasts at most ``duration`` (s) and ends once its end is
    certain; ``tolerance`` is its relative accuracy.
    """

    kind: ClassVar[str]

    system: System
    duration: float
    tolerance: float
    seed: int

    def __post_init__(self) -> None:
        """Raise ``ValueError`` for values that no command allows, because a stored plan may be forged."""
        checked_tolerance(self.tolerance)
        of_kind = vars(self)
        starts = of_kind.get("starts", [of_kind.get("start", ())])
        for start in starts:
            checked_state(self.system, start)
        counts = [len(starts), *(of_kind.get(name, 1) for name in ("samples", "coarse"))]
        axes = [of_kind[name] for name in ("x", "y") if name in of_kind]
        if (points := math.prod(axis.points for axis in axes)) > MOST_POINTS:
            raise ValueError(f"grid too large: {points:g} points, the limit is {MOST_POINTS:g}")
        names = {one.name for one in (*axes, *of_kind.get("varied", ()))}
        positive = 0.0 < self.duration < math.inf and min(counts) > 0 and self.seed >= 0
        if not positive or not names <= units(self.system).keys():
            raise ValueError(f"no sweep has this plan: {self}")

    @abstractmethod
    def rounds(self) -> Rounds:
        """Yield the numbers of the trajectories of each round."""

    @abstractmethod
    def trajectories(self, numbers: Numbers) -> Trajectories:
        """Return initial states and parameters; each trajectory depends only on its own number."""


@dataclass(frozen=True, kw_only=True)
class Basin(Plan):
    """Starts on a grid in a plane of two state components, numbered y·(points of x) + x.

    The axes replace two components of ``start``. The first grid has at least ``coarse`` points along each axis.
    """

    kind = "basin"

    start: tuple[float, ...]
    x: Axis
    y: Axis
    coarse: int

    def rounds(self) -> Rounds:
        """Yield the coarse grid, then the points near the boundary on finer grids."""
        return refined((self.y.points, self.x.points), self.coarse)

    def trajectories(self, numbers: Numbers) -> Trajectories:
        """Return the starts."""
        y, x = np.divmod(np.asarray(numbers), self.x.points)
        values = {self.x.name: self.x.values[x], self.y.name: self.y.values[y]}
        return _changed(self.system, self.start, values, len(numbers))


@dataclass(frozen=True, kw_only=True)
class RandomBasin(Plan):
    """Uniformly distributed starts in the plane of a :class:`Basin`."""

    kind = "random basin"

    start: tuple[float, ...]
    x: Axis
    y: Axis
    samples: int

    def rounds(self) -> Rounds:
        """Yield all."""
        yield range(self.samples)

    def trajectories(self, numbers: Numbers) -> Trajectories:
        """Return the starts."""
        uniform = _rows(self.seed, np.asarray(numbers), 2)
        values = {
            axis.name: axis.low + (axis.high - axis.low) * column
            for axis, column in zip((self.x, self.y), uniform.T, strict=True)
        }
        return _changed(self.system, self.start, values, len(numbers))


@dataclass(frozen=True, kw_only=True)
class Map(Plan):
    """A grid in a plane of two parameters, each combined with all initial states ``starts``.

    Trajectories are numbered (start·(points of y) + y)·(points of x) + x.
    """

    kind = "map"

    starts: tuple[tuple[float, ...], ...]
    x: Axis
    y: Axis

    @property
    def shape(self) -> tuple[int, int, int]:
        """Number of starts, of points along y and along x."""
        return len(self.starts), self.y.points, self.x.points

    def rounds(self) -> Rounds:
        """Yield all."""
        yield range(int(np.prod(self.shape)))

    def trajectories(self, numbers: Numbers) -> Trajectories:
        """Return starts and parameters."""
        start, y, x = np.unravel_index(np.asarray(numbers), self.shape)
        values = {self.x.name: self.x.values[x], self.y.name: self.y.values[y]}
        return np.array(self.starts)[start], values


@dataclass(frozen=True, kw_only=True)
class Uncertainty(Plan):
    """Random parameters and starts in the design for Sobol indices by Saltelli et al. (2010).

    Each of the ``samples`` rows contains two independent draws A and B and, for each quantity in ``varied``, A with
    this quantity from B. Trajectories are numbered row·(2 + quantities) + position in the row.
    """

    kind = "uncertainty"

    start: tuple[float, ...]
    varied: tuple[Uncertain, ...]
    samples: int

    @property
    def row(self) -> int:
        """Number of trajectories in a row."""
        return BASES + len(self.varied)

    def rounds(self) -> Rounds:
        """Yield all."""
        yield range(self.samples * self.row)

    def trajectories(self, numbers: Numbers) -> Trajectories:
        """Return starts and parameters."""
        values = self.values(numbers)
        return _changed(self.system, self.start, values, len(numbers))

    def values(self, numbers: Numbers) -> dict[str, FloatArray]:
        """Return the uncertain quantities, each of shape (n,)."""
        row, place = np.divmod(np.asarray(numbers), self.row)
        uniform = _rows(self.seed, row, BASES * len(self.varied))
        result = {}
        for i, uncertain in enumerate(self.varied):
            of_b = (place == 1) | (place == BASES + i)
            chosen = np.where(of_b, uniform[:, len(self.varied) + i], uniform[:, i])
            result[uncertain.name] = uncertain.values(chosen)
        return result


@dataclass(frozen=True, kw_only=True)
class Continuation(Plan):
    """Random starts, the same at each value of the parameter ``x``, numbered value·samples + start.

    The components in ``varied`` are random; ``start`` contains the others.
    """

    kind = "continuation"

    start: tuple[float, ...]
    x: Axis
    varied: tuple[Uncertain, ...]
    samples: int

    def rounds(self) -> Rounds:
        """Yield all."""
        yield range(self.x.points * self.samples)

    def trajectories(self, numbers: Numbers) -> Trajectories:
        """Return starts and the parameter."""
        value, sample = np.divmod(np.asarray(numbers), self.samples)
        uniform = _rows(self.seed, sample, len(self.varied))
        starts = {one.name: one.values(column) for one, column in zip(self.varied, uniform.T, strict=True)}
        return _changed(self.system, self.start, starts | {self.x.name: self.x.values[value]}, len(numbers))


PLANS: dict[str, type[Plan]] = {
    plan.kind: plan for plan in (Basin, RandomBasin, Map, Uncertainty, Continuation)
}


def count(plan: Plan) -> int:
    """Return the number of trajectories, or of points of a basin's finest grid."""
    if isinstance(plan, Basin):
        return plan.x.points * plan.y.points
    return len(next(plan.rounds()))


def plan_as_json(plan: Plan) -> dict[str, Any]:
    """Return the plan as JSON values."""
    return {"kind": plan.kind, **as_json(plan)}


def plan_from_json(content: Mapping[str, Any]) -> Plan:
    """Return the plan; raise ``KeyError``, ``TypeError`` or ``ValueError`` if it is invalid."""
    values = dict(content)
    return from_json(PLANS[values.pop("kind")], values)


def _rows(seed: int, rows: IntArray, width: int) -> FloatArray:
    """Return the given ``rows`` of a table of random numbers; the rows between them are also computed."""
    first, last = int(np.min(rows)), int(np.max(rows))
    return uniform_rows(seed, first, last - first + 1, width)[rows - first]


def _changed(
    system: System, start: Sequence[float], values: dict[str, FloatArray], count: int
) -> Trajectories:
    states = np.tile(np.asarray(start, dtype=float), (count, 1))
    for place, name in enumerate(components(system)):
        if name in values:
            states[:, place] = values[name]
    return states, {name: values[name] for name in parameters(system) if name in values}
