"""Exact stick of a contact at several points, which stick and slide one by one.

Every point is a pin with its share of the load. If one sticks, the disc pivots about it. If joints allow only spin
and the friction of all points is a moment without a force, they stick and slide together, because locks of single
points would load the joints.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import scipy.linalg

from exudyn_models.forces.axial_pairs import WHOLE, AxialStick, Mode
from exudyn_models.forces.laws.places import places_in, slip_maps
from exudyn_models.forces.load_and_coefficient import Coefficient, LoadAndCoefficient, NumberOrFunction
from exudyn_models.forces.slip_kinematics import Kinds
from exudyn_models.solver.stick.locked_contacts import least_maximum
from exudyn_models.solver.stick.planar_stick import PlanarStick
from reference_model.systems import FloatArray


@dataclass(eq=False, kw_only=True)
class PointSticks(AxialStick):
    """Friction at ``points`` that stick exactly, one by one, or as a ``whole`` if joints allow only spin."""

    whole: PlanarStick
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
            PlanarStick(pin, reference, load, ratio, point=1 + i)
            for i, (pin, load) in enumerate(zip(pins, loads, strict=True))
        )
        whole = PlanarStick(kinds, reference, factors, ratio, point=WHOLE)
        stick = cls(kinds, reference, factors, ratio, whole=whole, points=points)
        stick.check(factors.friction_coefficient, factors.normal_load)
        return stick

    def parts(self) -> Sequence[AxialStick]:
        """Return the whole and the points, which know the present numbers of their locks."""
        start, parts = 0, (self.whole, *self.points)
        for part in parts:
            part.locks = self.locks[start : start + part.most_locks]
            start += part.most_locks
        return parts

    @property
    def active(self) -> Sequence[PlanarStick]:
        """Return the parts that stick and slide in this model."""
        return (self.whole,) if self.whole.on_axis else self.points

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
        """Mode as a sensor shows it: locked if all points are, and otherwise that of one that slides."""
        modes = {part.visible_mode for part in self.active}
        sliding = modes & {Mode.FORWARD, Mode.BACKWARD}
        return next(iter(sliding or modes - {Mode.OPEN} or modes))

    def force(self, mbs: Any, t: float, item: int, q: Sequence[float], q_t: Sequence[float]) -> Any:
        """Return the sum of the generalised forces, as the user function of the connector."""
        return np.sum([part.force(mbs, t, item, q, q_t) for part in self.active], axis=0).tolist()

    def jacobian(
        self,
        mbs: Any,
        t: float,
        item: int,
        q: Sequence[float],
        q_t: Sequence[float],
        position_factor: float,
        velocity_factor: float,
    ) -> FloatArray:
        """Return the sum of the derivatives of minus the forces, as the user function of the connector."""
        arguments = mbs, t, item, q, q_t, position_factor, velocity_factor
        return np.asarray(sum(part.jacobian(*arguments) for part in self.active))

    def wrench(self, mbs: Any, t: float, slip: FloatArray, radius: float, angle: float) -> FloatArray:
        """Return force (N) and moment (N m) on the disc about its centre, in the master's axes, shape (3,)."""
        if self.whole.on_axis:
            return self.whole.wrench(mbs, t, slip, radius, angle)
        maps = slip_maps(self.factors.geometry[-1], angle)
        forces = [
            point.wrench(mbs, t, np.append(to_point @ slip, slip[2]), radius, angle)[:2]
            for point, to_point in zip(self.points, maps, strict=True)
        ]
        return np.asarray(np.einsum("pij,pi->j", maps, forces))

    def capacity_share(self, mbs: Any, t: float, angle: float = 0.0) -> float:
        """Return the least share of their capacities that lets the points hold the load, or 1 if a point slides."""
        if self.whole.on_axis:
            return self.whole.capacity_share(mbs, t)
        mode = self.visible_mode
        if mode != Mode.LOCKED:
            return 0.0 if mode == Mode.OPEN else 1.0
        maps = slip_maps(self.factors.geometry[-1], angle)
        held = np.array([point.held_wrench(mbs)[:2] for point in self.points])
        capacities = np.array([point.holding_force(t) for point in self.points])
        closed = capacities > 0.0
        held, capacities = held[closed], capacities[closed]
        undetermined = scipy.linalg.null_space(maps[closed].reshape(-1, 3).T)
        undetermined = undetermined.reshape(*held.shape, -1)

        def shares(x: FloatArray) -> tuple[FloatArray, FloatArray]:
            forces = held + undetermined @ x
            sizes = np.linalg.norm(forces, axis=1)
            directions = forces / np.where(sizes > 0.0, sizes, 1.0)[:, None]
            slopes = np.einsum("pi,pik->pk", directions, undetermined)
            return sizes / capacities, slopes / capacities[:, None]

        size = undetermined.shape[-1]
        return float(np.max(shares(least_maximum(shares, size) if size else np.zeros(0))[0]))
