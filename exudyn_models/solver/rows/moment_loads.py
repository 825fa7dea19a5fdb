"""Friction on one axis whose load grows with a moment T, its own or that of another part: N = N₀ + g·|T|.

If T is its own moment, friction slides at μN₀r/(1 − gμr) with the mean radius r, and gμr must be below 1. The moment
of another part depends only on the state, except at rest and in a mesh. There ``active_set`` and ``stick.resting``
find it together with all forces.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from exudyn_models.forces.axial_pairs import AxialStick, Mode, RowLaw
from exudyn_models.forces.load_and_coefficient import AT_REST, LoadAndCoefficient
from exudyn_models.solver.rows.laws import LEAST, GrowingLimit, Meshes, MeshLaw
from reference_model.systems import FloatArray
from reference_model.trajectory import SimulationError


@dataclass(eq=False, kw_only=True)
class SelfEnergisingStick(AxialStick):
    """Friction whose load grows by ``gains`` in 1/m times its own positive or negative moment."""

    gains: tuple[float, float]

    def __post_init__(self) -> None:
        """Raise ``ValueError`` if a constant coefficient lets the contact lock itself."""
        if self.factors.contact is None:
            return
        loop = max(self.gains) * self.static_ratio * self.arms(0.0, AT_REST)[1]
        if loop >= 1.0:
            raise ValueError(
                f"load_gain = {max(self.gains):g} 1/m: this contact locks itself, because its load causes {loop:.3g} "
                "times itself by static friction; it must cause less than itself"
            )

    @cached_property
    def per_newton(self) -> LoadAndCoefficient:
        """Friction under 1 N."""
        return self.factors.per_newton()

    def renew(self) -> None:
        """Use the present load and coefficient."""
        self.per_newton = self.factors.per_newton()

    def arms(self, t: float, spin: float) -> tuple[float, float]:
        """Return the sliding moment under N₀ in N m, and that under 1 N in m."""
        radius = self.mean_radius
        motion = t, 0.0, radius * abs(spin), spin
        return radius * self.factors.friction_force(*motion), radius * self.per_newton.friction_force(*motion)

    def slopes(self, t: float, spin: float) -> tuple[float, float]:
        """Return the derivatives of ``arms`` by the relative spin."""
        return self.slope_of(self.factors, t, spin), self.slope_of(self.per_newton, t, spin)

    def amplified(self, moment: float, arm: float, spin: float) -> float:
        """Return a moment under N₀ with that of the load it causes; ``arm`` is the moment in m under 1 N.

        Raises ``SimulationError`` if the friction locks itself.
        """
        loop = self.gains[int(spin > 0.0)] * arm
        if loop >= 1.0:
            raise SimulationError(
                f"a contact locks itself, because its load causes {loop:.3g} times itself (load_gain times friction "
                "coefficient times radius); it must cause less than itself, so use a smaller load_gain"
            )
        return moment / (1.0 - loop)

    def sliding_moment(self, t: float, spin: float) -> float:
        """Return the magnitude of the moment in N m."""
        return self.amplified(*self.arms(t, spin), spin)

    def sliding_slope(self, t: float, spin: float) -> float:
        """Return the derivative of the magnitude of the moment by the relative spin."""
        moment, arm = self.arms(t, spin)
        by_moment, by_arm = self.slopes(t, spin)
        by_load = by_arm * self.gains[int(spin > 0.0)] * self.amplified(moment, arm, spin)
        return self.amplified(by_moment + by_load, arm, spin)

    def limits(self, t: float) -> tuple[float, float]:
        """Return the largest moments in N m at rest against sliding forward and backward."""
        ratio = self.static_ratio
        (forward, arm), (backward, other) = self.arms(t, AT_REST), self.arms(t, -AT_REST)
        return (
            self.amplified(ratio * forward, ratio * arm, AT_REST),
            self.amplified(ratio * backward, ratio * other, -AT_REST),
        )


@dataclass(eq=False, kw_only=True)
class MomentLoadedStick(GrowingLimit, SelfEnergisingStick):
    """Friction whose load grows with the moment T of another ``part``, which ``present`` returns in its slip.

    ``part`` is None if its moment depends only on the state. ``place`` is that of T among the loads of the model.
    ``exerts`` is False while its friction is an unknown.
    """

    part: RowLaw | None
    present: Callable[[], float]
    place: int = 0
    exerts: bool = True
    _arms: dict[int, tuple[float, float]] = field(default_factory=dict)

    def __post_init__(self) -> None:
        """Accept any gains, because another moment causes the load."""

    @property
    def constant_forces(self) -> None:
        """None, because they vary."""
        return

    @property
    def load(self) -> float:
        """Present moment T in N m."""
        if isinstance(self.part, MeshLaw):
            return self.part.load
        at_rest = self.part is not None and self.part.mode == Mode.LOCKED
        return float(self.part.held_forces()[0]) if self.part and at_rest else self.present()

    def load_at(self, own: float | None) -> float:
        """Return T; ``own`` is the moment of its part in a group at rest with this contact, or None."""
        return self.load if own is None or isinstance(self.part, MeshLaw) else own

    def _gain(self, load: float) -> float:
        return self.gains[int(load < 0.0)]

    def limit(self, load: float, direction: int) -> float:
        """Return the friction in N m against slip in a direction at a moment T, as last evaluated."""
        moment, arm = self._arms[direction]
        return moment + arm * self._gain(load) * abs(load)

    def slope_at(self, load: float, direction: int) -> float:
        """Return the derivative by T of the friction against a slip in a direction."""
        return direction * float(np.copysign(self._arms[direction][1] * self._gain(load), load))

    def rest(self, t: float) -> None:
        """Evaluate load and coefficient at rest."""
        directions = (1, -1) if not self.slides else (-int(self.mode or 0),)
        self._arms |= {direction: self.arms(t, direction * AT_REST) for direction in directions}

    def limits(self, t: float) -> tuple[float, float]:
        """Return the largest moments in N m at rest against sliding forward and backward."""
        self.rest(t)
        return self.limits_at(self.load)

    def limits_at(self, load: float) -> tuple[float, float]:
        """Return the largest moments in N m at rest at a moment T."""
        forward, backward = (max(self.static_ratio * self.limit(load, way), LEAST) for way in (1, -1))
        return forward, backward

    def sliding_moment(self, t: float, spin: float) -> float:
        """Return the magnitude of the moment in N m."""
        way = 1 if spin > 0.0 else -1
        self._arms[way] = self.arms(t, spin)
        return self.limit(self.load, way) if self.exerts else 0.0

    def sliding_slope(self, t: float, spin: float) -> float:
        """Return the derivative of the magnitude of the moment by the relative spin."""
        load, (by_moment, by_arm) = self.load, self.slopes(t, spin)
        return by_moment + by_arm * self._gain(load) * abs(load)


class Loads:
    """Moments of a model that let limits grow: those of meshes, then those that load contacts."""

    def __init__(self, mbs: Any, laws: Sequence[RowLaw]) -> None:
        self._all, data = laws, mbs.systemData
        self.meshes = Meshes(mbs, [law for law in laws if isinstance(law, MeshLaw)])
        self._sticks = [law for law in laws if isinstance(law, MomentLoadedStick)]
        for place, law in enumerate(self._sticks, len(self.meshes.laws)):
            law.place = place
        self._laws = [*self.meshes.laws, *self._sticks]
        #: Place of the constraint of each mesh, -1 for other parts.
        self._places = np.array(
            [
                int(data.GetObjectLTGAE(part.item)[0]) if isinstance(part, MeshLaw) else -1
                for part in [*self.meshes.laws, *(law.part for law in self._sticks)]
            ],
            dtype=int,
        )

    def act(self, exert: bool) -> None:
        """Let friction that grows with these moments act, or not."""
        self.meshes.active = exert
        for law in self._sticks:
            law.exerts = exert

    def by_forces(
        self, of_constraints: Callable[[NDArray[Any]], FloatArray], firsts: Sequence[int]
    ) -> FloatArray:
        """Return these moments by unit forces along all k locks, shape (m, k).

        ``of_constraints`` returns those of constraints at places, and ``firsts`` are the first locks of all laws.
        """
        at_meshes = self._places >= 0
        meshes = of_constraints(self._places[at_meshes])
        found = np.zeros((len(self._places), meshes.shape[1]))
        found[at_meshes] = meshes
        for law in self._sticks:
            if law.part in self._all and not at_meshes[law.place]:
                found[law.place, firsts[self._all.index(law.part)]] = 1.0
        return found

    def without(self, by_forces: FloatArray, constraints: FloatArray) -> FloatArray:
        """Return these moments without the forces that ``by_forces`` relates to them, under ``constraints``."""
        return np.array(
            [
                -constraints[place] if place >= 0 else 0.0 if forces.any() else law.load
                for place, forces, law in zip(self._places, by_forces, self._laws, strict=True)
            ]
        )
