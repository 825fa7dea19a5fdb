"""Equivalent dampers of a sticking contact between its two bodies.

With x = (u, S), the slip of the disc's centre and the relative spin, regularised friction near rest is −(μN/ε)·P·∇P
with the mean slip speed P(x). P² is at most xᵀ·V·x with V = diag(1, 1, r²), r the mean radius of the contact. So
friction resists slip at most like a damper (μN/ε)·V. With x = J·q̇ of ``slip_and_place`` it is the damper D =
(μN/ε)·Jᵀ·V·J between two bodies.

If P > ε, one of several points can stick alone while the disc pivots about it. It is then a damper with its share of
μN over the δ of ``friction_laws``.
"""

import math
from dataclasses import dataclass

import numpy as np

from exudyn_models.forces.friction_laws import (
    CONTINUOUS,
    NONE_HELD,
    Contact,
    mean_radius,
)
from exudyn_models.forces.laws.places import places_in, regularisation_at, slip_maps
from exudyn_models.forces.load_and_coefficient import LoadAndCoefficient
from exudyn_models.forces.slip_kinematics import ROUNDING, Kinds, slip_and_place_of_nodes
from reference_model.systems import FloatArray


@dataclass(frozen=True, eq=False)
class StickDampers:
    """Equivalent dampers of a contact between two nodes with ``reference`` coordinates, shape (n,)."""

    kinds: Kinds
    reference: FloatArray
    factors: LoadAndCoefficient

    @property
    def vary(self) -> bool:
        """True if load or coefficient is a function."""
        return self.factors.contact is None

    def at(self, t: float, coordinates: FloatArray) -> FloatArray:
        """Return D and the damper of each point that can stick alone, shape (1 + points, n, n).

        ``coordinates``, shape (n,), describe the nodes at the time t (s), without reference values.
        """
        place = self.reference + coordinates
        to_slip, _, (cosine, sine), (x, y) = slip_and_place_of_nodes(self.kinds, place)
        friction = self.factors.friction_force(t, math.hypot(x, y), 0.0, 0.0)
        dampers = friction * slip_dampers(self.factors.geometry, math.atan2(sine, cosine))
        if np.abs(to_slip[:2]).max() < ROUNDING:  # rotors on one axis: all points slip equally
            dampers = dampers[:1]
        return np.asarray(to_slip.T @ dampers @ to_slip)


def slip_dampers(contact: Contact, angle: float) -> FloatArray:
    """Return V/ε in s/m and s m, and the same for each point that sticks alone, shape (1 + points, 3, 3).

    ``angle`` (rad) is the angle of the disc's first point.
    """
    _, points, _, epsilon, held, table = contact
    if points <= CONTINUOUS:
        radius = mean_radius(contact)
        return np.diag([1.0, 1.0, radius * radius])[None] / epsilon
    maps, loads = slip_maps(table, angle), places_in(table)[:, 2]
    shares = maps.transpose(0, 2, 1) @ maps * loads[:, np.newaxis, np.newaxis]
    alone = shares / regularisation_at(table, epsilon)
    if held == NONE_HELD:
        return np.concatenate((shares.sum(axis=0)[None] / epsilon, alone if points > 1 else alone[:0]))
    others = np.delete(shares, held, axis=0).sum(axis=0) / epsilon
    return np.asarray(others + alone[held])[None]
