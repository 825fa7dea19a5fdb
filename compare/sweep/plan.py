"""What is to be simulated: for the number of a trajectory its start and its parameters, wherever it is computed.

A plan is data that can be sent to another process and written as JSON. Its trajectories have numbers from 0 on, and
it says in which rounds they are to be simulated: all at once, or where the boundary of a basin turns out to be.
"""

from __future__ import annotations

from collections.abc import Generator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, ClassVar, Protocol, TypeAlias

import numpy as np
from numpy.typing import NDArray

from compare.claims.as_json import as_json, from_json
from compare.sweep.distributions import Uncertain, uniform_rows
from compare.sweep.quantities import Axis, components, parameters
from compare.sweep.refinement import refined
from reference_model.systems import FloatArray, System

IntArray = NDArray[np.int64]
Ends = NDArray[np.uint8]

Numbers: TypeAlias = range | IntArray
"""Numbers of trajectories."""

Rounds: TypeAlias = Generator[Numbers, Ends, Any]
"""Yields the numbers of a round and takes what these trajectories ended as; of a grid it returns the whole of it."""

Trajectories: TypeAlias = tuple[FloatArray, dict[str, FloatArray]]
"""Initial states of shape (n, 4 or 6) and the parameters that differ, each of shape (n,)."""

BASES = 2
"""Independent samples from which the sensitivities are estimated."""


@dataclass(frozen=True, kw_only=True)
class Common:
    """What all plans have.

    Parameters
    ----------
    system : PinOnDisc or DiscOnDisc
        The parameters that are not swept.
    duration : float
        In s, of trajectories whose end is not certain before.
    tolerance : float
        Relative accuracy to aim at.
    seed : int
        Of all that is random.

    """

    kind: ClassVar[str]

    system: System
    duration: float
    tolerance: float
    seed: int


class Plan(Protocol):
    """What a sweep needs to know of any plan."""

    kind: ClassVar[str]

    @property
    def system(self) -> System:
        """The parameters that are not swept."""
        ...

    @property
    def duration(self) -> float:
        """In s."""
        ...

    @property
    def tolerance(self) -> float:
        """Relative accuracy to aim at."""
        ...

    @property
    def seed(self) -> int:
        """Of all that is random."""
        ...

    def rounds(self) -> Rounds:
        """Yield which trajectories to simulate."""
        ...

    def trajectories(self, numbers: Numbers) -> Trajectories:
        """Return starts and parameters of trajectories, the same whichever are asked for together."""
        ...


@dataclass(frozen=True, kw_only=True)
class Basin(Common):
    """Starts on a grid in a plane of two components of the state; trajectory number y·(points of x) + x.

    Parameters
    ----------
    start : tuple of float
        The state at time 0; two of its components are replaced.
    x, y : Axis
        These components.
    coarse : int
        Least number of points along each axis of the grid that refinement starts from.

    """

    kind = "basin"

    start: tuple[float, ...]
    x: Axis
    y: Axis
    coarse: int

    def rounds(self) -> Rounds:
        """Yield the coarse grid, and then what is at the boundary on finer and finer ones."""
        return refined((self.y.points, self.x.points), self.coarse)

    def trajectories(self, numbers: Numbers) -> Trajectories:
        """Return the starts; parameters do not differ."""
        y, x = np.divmod(np.asarray(numbers), self.x.points)
        values = {self.x.name: self.x.values[x], self.y.name: self.y.values[y]}
        return _changed(self.system, self.start, values, len(numbers))


@dataclass(frozen=True, kw_only=True)
class RandomBasin(Common):
    """Starts that are equally likely everywhere in a plane of two components of the state.

    Parameters
    ----------
    start, x, y
        As in :class:`Basin`; the axes' numbers of points have no meaning.
    samples : int
        Number of starts.

    """

    kind = "random basin"

    start: tuple[float, ...]
    x: Axis
    y: Axis
    samples: int

    def rounds(self) -> Rounds:
        """Yield all."""
        yield range(self.samples)

    def trajectories(self, numbers: Numbers) -> Trajectories:
        """Return the starts; parameters do not differ."""
        uniform = _rows(self.seed, np.asarray(numbers), 2)
        values = {
            axis.name: axis.low + (axis.high - axis.low) * column
            for axis, column in zip((self.x, self.y), uniform.T, strict=True)
        }
        return _changed(self.system, self.start, values, len(numbers))


@dataclass(frozen=True, kw_only=True)
class Map(Common):
    """A grid in a plane of two parameters; trajectory number (start·(points of y) + y)·(points of x) + x.

    Parameters
    ----------
    starts : tuple of tuple of float
        States at time 0, each for all parameters.
    x, y : Axis
        The parameters.

    """

    kind = "map"

    starts: tuple[tuple[float, ...], ...]
    x: Axis
    y: Axis

    @property
    def shape(self) -> tuple[int, int, int]:
        """Number of starts, of y and of x."""
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
class Uncertainty(Common):
    """Random parameters and starts, in the arrangement from which Sobol's indices are estimated (Saltelli 2010).

    Row by row there are two independent draws A and B, and for each uncertain quantity a mixture that has this one
    quantity from B and the others from A. The trajectory's number is row·(2 + quantities) + its place in the row.

    Parameters
    ----------
    start : tuple of float
        The state at time 0, where it is not uncertain.
    varied : tuple of Uncertain
        What is uncertain.
    samples : int
        Number of rows.

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
        """Return the values of what is uncertain, each of shape (n,)."""
        row, place = np.divmod(np.asarray(numbers), self.row)
        uniform = _rows(self.seed, row, BASES * len(self.varied))
        result = {}
        for i, uncertain in enumerate(self.varied):
            of_b = (place == 1) | (place == BASES + i)
            chosen = np.where(of_b, uniform[:, len(self.varied) + i], uniform[:, i])
            result[uncertain.name] = uncertain.values(chosen)
        return result


@dataclass(frozen=True, kw_only=True)
class Continuation(Common):
    """Random starts, the same at each value of one parameter; trajectory number value·samples + start.

    Parameters
    ----------
    start : tuple of float
        The state at time 0, where it is not random.
    x : Axis
        The parameter.
    varied : tuple of Uncertain
        The components of the start that are random.
    samples : int
        Number of starts.

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


PLANS: dict[str, type[Any]] = {
    plan.kind: plan for plan in (Basin, RandomBasin, Map, Uncertainty, Continuation)
}


def count(plan: Plan) -> int:
    """Return the number of trajectories; of a basin that is refined, the points of its finest grid."""
    if isinstance(plan, Basin):
        return plan.x.points * plan.y.points
    return len(next(plan.rounds()))


def plan_as_json(plan: Plan) -> dict[str, Any]:
    """Return the plan as JSON values."""
    return {"kind": plan.kind, **as_json(plan)}


def plan_from_json(content: Mapping[str, Any]) -> Plan:
    """Return the plan of ``plan_as_json``; raise ``KeyError``, ``TypeError`` or ``ValueError`` if there is none."""
    values = dict(content)
    plan: Plan = from_json(PLANS[values.pop("kind")], values)
    return plan


def _rows(seed: int, rows: IntArray, width: int) -> FloatArray:
    """Return the given rows, which are near to each other, of a table of random numbers, shape (n, width)."""
    first, last = int(np.min(rows)), int(np.max(rows))
    return uniform_rows(seed, first, last - first + 1, width)[rows - first]


def _changed(
    system: System, start: Sequence[float], values: dict[str, FloatArray], count: int
) -> Trajectories:
    """Return ``start`` for all with some components replaced, and the parameters among ``values``."""
    states = np.tile(np.asarray(start, dtype=float), (count, 1))
    for place, name in enumerate(components(system)):
        if name in values:
            states[:, place] = values[name]
    return states, {name: values[name] for name in parameters(system) if name in values}
