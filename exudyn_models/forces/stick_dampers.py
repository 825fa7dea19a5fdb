"""What a contact that sticks is to the bodies on both of its sides: a damper between them.

With x = (u, S), the slip of the disc's centre and the relative spin, friction near rest is −(μN/ε)·P·∇P of the mean
slip speed P(x). P² is at most xᵀ·V·x with V = diag(1, 1, r²), r the mean radius of the contact, and just that where
the disc only moves sideways or only turns: friction resists slip like a damper (μN/ε)·V or less. x = J·q̇ of
``slip_jacobian`` makes it one between two bodies, D = (μN/ε)·Jᵀ·V·J.

Where P > ε one of several points can stick alone, while the disc pivots about it. It then is a damper with its share
of μN over the δ of ``friction_laws``.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from exudyn_models.forces.friction_laws import (
    CONTINUOUS,
    NONE_HELD,
    Contact,
    mean_radius,
    point_regularisation,
)
from exudyn_models.forces.load_and_coefficient import LoadAndCoefficient
from exudyn_models.forces.slip_kinematics import Kinds, radius_of_disc, slip_jacobian
from reference_model.systems import FloatArray


@dataclass(frozen=True, eq=False)
class StickDampers:
    """The dampers that a contact in stick is between two nodes with their ``reference`` coordinates, shape (n,)."""

    kinds: Kinds
    reference: FloatArray
    factors: LoadAndCoefficient

    @property
    def vary(self) -> bool:
        """Whether load or coefficient is a function."""
        return self.factors.contact is None

    def at(self, t: float, coordinates: FloatArray) -> FloatArray:
        """Return D, and that of each point which can stick alone, shape (1 + points, n, n).

        They are those at the time t (s) and the nodes' ``coordinates`` without reference values, shape (n,).
        """
        place = self.reference + coordinates
        to_slip, axes, (cosine, sine) = slip_jacobian(self.kinds, place)
        friction = self.factors.friction_force(t, float(radius_of_disc(self.kinds, place, axes)), 0.0, 0.0)
        dampers = friction * slip_dampers(self.factors.geometry, math.atan2(sine, cosine))
        if not to_slip[:2].any():  # two rotors: all points slip alike
            dampers = dampers[:1]
        return np.asarray(to_slip.T @ dampers @ to_slip)


def slip_dampers(contact: Contact, angle: float) -> FloatArray:
    """Return V/ε in s/m and s m, and that of each point that sticks alone, shape (1 + points, 3, 3).

    The disc's ``angle`` (rad) over the master is that of its first point.
    """
    outer, points, _, epsilon, held, _ = contact
    if points <= CONTINUOUS:
        radius = mean_radius(contact)
        return np.diag([1.0, 1.0, radius * radius])[None] / epsilon
    angles = angle + 2.0 * math.pi * np.arange(points) / points
    maps = np.zeros((points, 2, 3))  # of (u, S) to the slip of each point
    maps[:, 0, 0] = maps[:, 1, 1] = 1.0
    maps[:, 0, 2], maps[:, 1, 2] = -outer * np.sin(angles), outer * np.cos(angles)
    shares = maps.transpose(0, 2, 1) @ maps / points
    alone = shares / point_regularisation(epsilon, points)
    if held == NONE_HELD:
        return np.concatenate((shares.sum(axis=0)[None] / epsilon, alone if points > 1 else alone[:0]))
    others = np.delete(shares, held, axis=0).sum(axis=0) / epsilon
    return np.asarray(others + alone[held])[None]
