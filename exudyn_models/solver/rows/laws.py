"""Laws of couplings between rotors on one axis.

A mesh is an ideal constraint G·ω = 0 with the moment T along G, and friction f along the gradient g of a slip s. Its
limit is a preload plus a share of |T|; the share depends on the direction of the power. For a gear g is the first
shaft relative to the carrier, and the shares are 1/η − 1 if this shaft drives (T·s < 0) and 1 − η' if it is driven.
η' <= 0 is a gear that locks itself.

Exudyn's Jacobian does not contain the effect of constraint forces on friction, and its iteration diverges if friction
is a large share of them. So each mesh also applies the change of T that the friction of all meshes causes. The
multiplier of the constraint is then T₀, the moment without friction. From T₀, ``Meshes`` solves for f and
T together.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from exudyn_models.forces.axial_pairs import FREE, Mode, RowLaw
from reference_model.systems import FloatArray
from reference_model.trajectory import SimulationError

LEAST = 1e-10
"""Limit in N m of unloaded meshes and one-way clutches, so rounding errors of a moment do not release them."""

ABOVE = 10.0
"""Ratio of the limit of a one-way clutch in its locked direction to the largest moment in the model."""

ITERATIONS = 100
"""Largest number of iterations for directions of power; each changes the direction of at least one mesh."""

SETTLED = 1e-13
"""Largest relative change of settled shares."""

Share = Callable[[float, bool], float]
"""Function of |T| in N m, and of whether the first shaft drives, for the share of |T| that friction has."""


@dataclass(eq=False, kw_only=True)
class RotaryLaw(RowLaw):
    """Law of a part between rotors in a model with ``data``."""

    data: Any

    def __post_init__(self) -> None:
        self.reference = np.zeros(len(self.weights))

    def multipliers(self) -> FloatArray:
        """Return the present forces of all constraints, shape (m,)."""
        return np.asarray(self.data.GetAECoordinates(), float)

    def check_running(self) -> None:
        """Raise ``ValueError`` unless ``solve_dynamic`` switches modes."""
        if not self.running:
            raise ValueError(
                "a gear with losses, a limited slip differential or a one-way clutch needs "
                "exudyn_models.solve_dynamic"
            )


@dataclass(eq=False)
class OneWayLaw(RotaryLaw):
    """A one-way clutch: the slip is free forward, and locked backward by any moment >= 0."""

    def limits(self, t: float) -> tuple[float, float]:
        """Return the limits in N m; the second limit exceeds all present moments."""
        self.largest = max(self.largest, ABOVE * float(np.abs(self.multipliers()).max(initial=0.0)), 1.0)
        return FREE * self.largest, self.largest

    def moment(self, t: float, spin: float) -> float:
        """Return the moment in slip, 0 N m."""
        return 0.0


class GrowingLimit:
    """Limit that grows with a moment T; ``place`` is that of T among the loads of the model."""

    place: int
    static_ratio: float

    @property
    def load(self) -> float:
        """Present moment T in N m."""
        raise NotImplementedError

    def limit(self, load: float, direction: int) -> float:
        """Return the largest friction in N m against a slip in a direction, ±1, at a moment T in N m."""
        raise NotImplementedError

    def slope_at(self, load: float, direction: int) -> float:
        """Return the derivative by T of the friction against a slip in a direction, ±1, or 0 without slip."""
        raise NotImplementedError

    def load_at(self, own: float | None) -> float:
        """Return the present T of a contact at rest; ``own`` is the part in its group at rest, or None."""
        raise NotImplementedError

    def limits_at(self, load: float) -> tuple[float, float]:
        """Return the limits at rest in N m at a moment T."""
        raise NotImplementedError

    def rest(self, t: float) -> None:
        """Evaluate load and coefficient at rest."""

    def shares(self, force: float, load: float) -> tuple[Sequence[float], Sequence[FloatArray]]:
        """Return the shares of both limits that a force at rest needs, and their slopes in force and in T."""
        values, slopes = list[float](), list[FloatArray]()
        for limit, way in zip(self.limits_at(load), (1, -1), strict=True):
            values.append(-way * force / limit)
            by_load = self.static_ratio * self.slope_at(load, way)
            slopes.append(np.array([-way / limit, force / limit**2 * by_load]))
        return values, slopes


@dataclass(eq=False)
class MeshLaw(GrowingLimit, RotaryLaw):
    """Friction of a mesh with the constraint ``item``, whose gradient is ``constraint``, shape (n,).

    ``preload`` in N m and ``share`` determine its limit, always zero if the mesh is ``lossless``. ``shifts`` returns
    the change of T at rest by contacts that share the load and are not constraints themselves.
    """

    constraint: FloatArray = field(kw_only=True)
    lossless: bool = field(kw_only=True)
    item: int = -1
    preload: float = field(kw_only=True)
    share: Share = field(kw_only=True)
    meshes: Meshes | None = None
    place: int = 0
    shifts: Callable[[], float] | None = None

    @property
    def constraints(self) -> tuple[int, ...]:
        """Object numbers of the lock, if there is friction, and of the constraint of the mesh."""
        return *self.locks, self.item

    def use(self, constraints: Sequence[int]) -> None:
        """Stick by the constraints with these object numbers."""
        *locks, self.item = constraints
        self.locks = tuple(locks)

    def limit(self, load: float, direction: int) -> float:
        """Return the largest friction in N m against a slip in a direction, ±1, at a moment T in N m."""
        return self.preload + self.share(abs(load), load * direction < 0.0) * abs(load)

    def slope_at(self, load: float, direction: int) -> float:
        """Return the derivative by T of the friction against a slip in a direction, ±1, or 0 without slip."""
        share = self.share(abs(load), load * direction < 0.0)
        return direction * (share if load >= 0.0 else -share)

    @property
    def load(self) -> float:
        """Present moment T of the constraint in N m."""
        shift = self.shifts() if self.shifts and self.mode == Mode.LOCKED else 0.0
        return self._load + shift

    @property
    def slope(self) -> float:
        """Present friction in slip against T, without preload."""
        return self.slope_at(self.load, int(self.mode or 0))

    @property
    def _load(self) -> float:
        if self.meshes is None:
            return -float(self.multipliers()[self.data.GetObjectLTGAE(self.item)[0]])
        return float(self.meshes.now()[0][self.place])

    def moment_and_friction(self, t: float, twist: float, rate: float) -> tuple[float, float]:
        """Return T and the friction in N m."""
        locked = self.mode == Mode.LOCKED
        return self.load, float(self.held_forces()[0]) if locked else self.moment(t, rate)

    def limits(self, t: float) -> tuple[float, float]:
        """Return the largest friction in N m against sliding forward and backward."""
        return self.limits_at(self._load)

    def load_at(self, own: float | None) -> float:
        """Return the present T by the forces of constraints."""
        return self._load

    def limits_at(self, load: float) -> tuple[float, float]:
        """Return the limits at rest in N m at a moment T."""
        self.largest = max(self.largest, self.preload + abs(load))
        least = max(LEAST, FREE * self.largest)
        return max(self.limit(load, 1), least), max(self.limit(load, -1), least)

    def moment(self, t: float, spin: float) -> float:
        """Return the friction in N m in slip."""
        return float(self.meshes.now()[1][self.place]) if self.meshes else 0.0

    def force(self, mbs: Any, t: float, item: int, q: Sequence[float], q_t: Sequence[float]) -> list[float]:
        """Return the moments on the nodes: friction, and the change of T that friction causes."""
        if self.lossless:
            return [0.0] * len(q)
        self.check_running()
        if self.meshes is None:
            return [0.0] * len(q)
        loads, friction = self.meshes.now()
        change = loads[self.place] - self.meshes.read()[self.place]
        moments: list[float] = (friction[self.place] * self.weights + change * self.constraint).tolist()
        return moments


class Meshes:
    """All meshes of a model, whose ``multipliers`` (N m) a function returns."""

    def __init__(self, mbs: Any, laws: Sequence[MeshLaw]) -> None:
        self.laws, self._data = laws, mbs.systemData
        self.places = np.array([int(self._data.GetObjectLTGAE(law.item)[0]) for law in laws], dtype=int)
        #: Change of the moments T by unit friction at each mesh, shape (m, m).
        self.by_friction = np.zeros((len(laws), len(laws)))
        #: False while the meshes exert no friction.
        self.active = True
        self._known: tuple[Any, tuple[FloatArray, FloatArray]] = None, (np.empty(0), np.empty(0))
        for i, law in enumerate(laws):
            law.meshes, law.place = self, i

    def read(self) -> FloatArray:
        """Return T₀ in N m, shape (m,)."""
        return np.asarray(-self._data.GetAECoordinates()[self.places], float)

    def now(self) -> tuple[FloatArray, FloatArray]:
        """Return the present moments T and frictions f in N m, shape (m,)."""
        free = self.read()
        modes = tuple(int(law.mode) if law.slides and law.mode else 0 for law in self.laws)
        if not self.active or not any(modes):
            return free, np.zeros(len(free))
        key = free.tobytes(), modes, self.by_friction.tobytes()
        if key != self._known[0]:
            self._known = key, self._solve(free, np.array(modes))
        return self._known[1]

    def _solve(self, free: FloatArray, directions: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Solve f = −direction·(preload + share·|T|) and T = T₀ + w·f; the shares depend on T."""
        preloads = np.array([law.preload for law in self.laws])
        loads, friction, before = free, free, np.full(len(free), np.inf)
        for _ in range(ITERATIONS):
            each = zip(self.laws, loads.tolist(), directions.tolist(), strict=True)
            slopes = np.array([law.slope_at(load, direction) for law, load, direction in each])
            if np.abs(slopes - before).max() <= SETTLED * np.abs(slopes).max():
                return loads, friction
            before = slopes
            friction = np.linalg.solve(
                np.eye(len(free)) + slopes[:, None] * self.by_friction, -directions * preloads - slopes * free
            )
            loads = free + self.by_friction @ friction
        raise SimulationError(
            "a gear jams: no force of its teeth satisfies its efficiency in the present motion, because it locks "
            "itself too strongly for the inertias of its shafts"
        )
