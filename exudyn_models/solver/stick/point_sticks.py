"""Exact stick of a contact at several points that stick and slide individually.

Every point is a pin with its share of the load. If one sticks, the disc pivots about it. If joints allow only spin,
the points stick and slide together.
"""

from __future__ import annotations

import cmath
import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import islice
from typing import Any

import numpy as np

from exudyn_models.forces.axial_pairs import AxialStick, Mode
from exudyn_models.forces.laws.places import places_in, slip_maps
from exudyn_models.forces.load_and_coefficient import Coefficient, LoadAndCoefficient, NumberOrFunction
from exudyn_models.forces.slip_kinematics import Kinds, slip_and_place_of_nodes
from exudyn_models.solver.stick.planar_stick import PlanarStick
from reference_model.systems import FloatArray


@dataclass(eq=False)
class PointsOnAxis(PlanarStick):
    """Friction at all points of a disc that joints hold on the axis of the contact.

    The joints carry an undetermined share of the points' forces. As at the start of sliding, each point holds the
    same share of its capacity. So the moment M comes with the force f·M, and f·u + S takes the place of the slip S.
    """

    @property
    def most_locks(self) -> int:
        """Largest number of constraints that hold the contact."""
        return 1

    @cached_property
    def _force_per_moment(self) -> complex:
        """The force per moment f in 1/m, in the disc's axes."""
        x, y, shares = places_in(self.factors.geometry[-1]).T
        arms = x + 1j * y
        return complex(shares @ (1j * arms / np.where(arms == 0.0, 1.0, abs(arms)))) / self.mean_radius

    def _wrench_per_moment(self, angle: float) -> FloatArray:
        force = self._force_per_moment * cmath.exp(1j * angle)
        return np.array([force.real, force.imag, 1.0])

    def rows(self, coordinates: FloatArray) -> FloatArray:
        """Return the gradient of the locked slip, shape (1, n)."""
        return np.asarray(self.to_locked(coordinates) @ self.slip_map(coordinates))

    def to_locked(self, coordinates: FloatArray) -> FloatArray:
        """Return the map from (u, S) to f·u + S, shape (1, 3)."""
        cosine, sine = slip_and_place_of_nodes(self.kinds, coordinates)[2]
        return self._wrench_per_moment(math.atan2(sine, cosine))[None]

    def wrench(self, mbs: Any, t: float, slip: FloatArray, radius: float, angle: float) -> FloatArray:
        """Return force and moment as ``AxialStick.wrench`` does."""
        moment: float = super().wrench(mbs, t, slip, radius, angle)[2]
        return moment * self._wrench_per_moment(angle)


@dataclass(eq=False, kw_only=True)
class PointSticks(AxialStick):
    """Friction at ``points`` that stick exactly and individually, or as a ``whole`` if joints allow only spin."""

    whole: PointsOnAxis
    points: tuple[PlanarStick, ...]

    @classmethod
    def at(
        cls,
        pins: Sequence[Kinds],
        kinds: Kinds,
        reference: FloatArray,
        factors: LoadAndCoefficient,
        ratio: float,
    ) -> PointSticks:
        """Return the contact with the ``kinds`` of its centre and of its ``pins``, and static ``ratio``.

        Raises ``ValueError`` if load or coefficient is a function of the radius, which differs from point to point.
        """
        loads = factors.at_pins(places_in(factors.geometry[-1])[:, 2])
        points = tuple(
            PlanarStick(pin, load, reference=reference, static_ratio=ratio, point=1 + i)
            for i, (pin, load) in enumerate(zip(pins, loads, strict=True))
        )
        whole = PointsOnAxis(kinds, factors, reference=reference, static_ratio=ratio)
        stick = cls(kinds, factors, reference=reference, static_ratio=ratio, whole=whole, points=points)
        stick.check(factors.friction_coefficient, factors.normal_load)
        return stick

    @property
    def parts(self) -> Sequence[PlanarStick]:
        """The whole contact and its points."""
        return self.whole, *self.points

    @property
    def active(self) -> Sequence[PlanarStick]:
        """The whole contact or its points."""
        return self.parts[:1] if self.whole.on_axis else self.points

    def use(self, locks: Sequence[int]) -> None:
        """Stick by the constraints with these object numbers, in the order of the parts."""
        super().use(locks)
        rest = iter(locks)
        for part in self.parts:
            part.use(tuple(islice(rest, part.lock_count)))

    def check(self, friction_coefficient: Coefficient, normal_load: NumberOrFunction) -> None:
        """Raise ``ValueError`` unless each point can evaluate coefficient and load alone."""
        factors = LoadAndCoefficient(self.factors.geometry, friction_coefficient, normal_load)
        if factors.depends_on_radius:
            raise ValueError(
                f"contact_points = {len(self.points)}: points under a load or coefficient of radius need a "
                "regularisation; without it each point evaluates both by itself, so use other arguments"
            )

    def renew(self) -> None:
        """Use the present load and coefficient from now on."""
        self.whole.renew()
        for point in self.points:
            point.factors.change(self.factors.friction_coefficient, self.factors.normal_load)
            point.renew()

    @property
    def visible_mode(self) -> Mode:
        """Mode that a sensor shows: locked if all points are locked, else the mode of a sliding point."""
        modes = {part.visible_mode for part in self.active}
        sliding = modes & {Mode.FORWARD, Mode.BACKWARD}
        return next(iter(sliding or modes - {Mode.OPEN} or modes))

    def force(self, *arguments: Any) -> Any:
        """Return the sum of the generalised forces, as the user function of the connector."""
        return np.sum([part.force(*arguments) for part in self.active], axis=0).tolist()

    def jacobian(self, *arguments: Any) -> FloatArray:
        """Return the sum of the derivatives of minus the forces, as the user function of the connector."""
        return np.asarray(sum(part.jacobian(*arguments) for part in self.active))

    def wrench(self, mbs: Any, t: float, slip: FloatArray, radius: float, angle: float) -> FloatArray:
        """Return force and moment about the centre as ``AxialStick.wrench`` does."""
        if self.whole.on_axis:
            return self.whole.wrench(mbs, t, slip, radius, angle)
        maps = slip_maps(self.factors.geometry[-1], angle)
        forces = [
            point.wrench(mbs, t, np.append(to_point @ slip, slip[2]), radius, angle)[:2]
            for point, to_point in zip(self.points, maps, strict=True)
        ]
        return np.asarray(np.einsum("pij,pi->j", maps, forces))

    def capacity_share(self, mbs: Any, t: float, angle: float = 0.0) -> float:
        """Return the largest share of capacity of a point."""
        return max(part.capacity_share(mbs, t) for part in self.active)
