"""Friction of a planar disc on the ground, a rotor or a planar master, in closed form at a third of the cost.

The arguments are those of the functions in ``any_pair``.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from exudyn_models.forces.any_pair import NO_LAW, Parameters, contact_of, motion_of
from exudyn_models.forces.friction_laws import (
    ring_friction,
    ring_friction_derivatives,
    slip_potential_of_contact,
)
from exudyn_models.forces.jit import compiled
from exudyn_models.forces.laws.product import friction_force_under
from exudyn_models.forces.slip_kinematics import GROUND, NO_MOUNTS, PLANAR, ROTOR, SIZES
from reference_model.systems import FloatArray

IN_THE_PLANE = tuple((master, PLANAR, NO_MOUNTS) for master in (GROUND, ROTOR, PLANAR))
"""``Kinds`` of pairs that these functions support."""


@compiled
def force_in_the_plane(parameters: Parameters, mbs: Any, t: float, item: int, q: Any, q_t: Any) -> Any:
    """Return the generalised forces on both nodes, in the memory of ``q_t``."""
    contact, kinds, law = contact_of(parameters)
    coordinates, velocities = motion_of(parameters, q, q_t)
    motion = _relative(SIZES[kinds[0]], coordinates, velocities)
    dx, dy, angle, dvx, dvy, master_spin, disc_spin = motion
    if law[0] != NO_LAW:
        radius, points, _, epsilon, held, inner = contact
        spin = disc_spin - master_spin
        ux, uy = dvx + master_spin * dy, dvy - master_spin * dx
        speed = slip_potential_of_contact(ux, uy, spin, angle, contact)
        friction = friction_force_under(law, epsilon, t, math.sqrt(dx * dx + dy * dy), speed, spin)
        contact = radius, points, friction, epsilon, held, inner
    forces = velocities
    at = SIZES[kinds[0]]
    forces[at], forces[at + 1], forces[at + 2], master_moment = ring_friction(*motion, contact)
    if at > 0:
        forces[at - 1] = master_moment
    if at > 1:
        forces[0], forces[1] = -forces[at], -forces[at + 1]
    return q_t


@compiled
def jacobian_in_the_plane(
    parameters: Parameters,
    mbs: Any,
    t: float,
    item: int,
    q: Any,
    q_t: Any,
    position_factor: float,
    velocity_factor: float,
) -> FloatArray:
    """Return the derivatives of the negative forces, shape (n, n), under a load and a coefficient of time alone."""
    contact, kinds, law = contact_of(parameters)
    motion = _relative(SIZES[kinds[0]], *motion_of(parameters, q, q_t))
    if law[0] != NO_LAW:
        radius, points, _, epsilon, held, inner = contact
        contact = radius, points, friction_force_under(law, epsilon, t, 0.0, 0.0, 0.0), epsilon, held, inner
    derivatives = ring_friction_derivatives(*motion, contact)
    # The ground is a planar master without coordinates, a rotor one without x and y.
    first = SIZES[PLANAR] - SIZES[kinds[0]]
    return _over_both_nodes(derivatives, position_factor, velocity_factor)[first:, first:].copy()


Relative = tuple[float, float, float, float, float, float, float]
"""Relative motion: dx, dy, angle, dvx, dvy and both spins."""


@compiled
def _relative(at: int, coordinates: FloatArray, velocities: FloatArray) -> Relative:
    """Return the relative motion of a disc whose coordinates start at index ``at``."""
    x, y, vx, vy, master_spin = coordinates[at], coordinates[at + 1], velocities[at], velocities[at + 1], 0.0
    if at > 0:
        master_spin = velocities[at - 1]
    if at > 1:
        x, y, vx, vy = x - coordinates[0], y - coordinates[1], vx - velocities[0], vy - velocities[1]
    return x, y, coordinates[at + 2], vx, vy, master_spin, velocities[at + 2]


@compiled
def _over_both_nodes(derivatives: FloatArray, position_factor: float, velocity_factor: float) -> FloatArray:
    """Return minus the derivatives on two planar nodes from those of (F_x, F_y, M, M_master) by ``Relative``."""
    by_nodes = np.zeros((4, 6))
    for i in range(4):
        dx, dy, angle, dvx, dvy, master_spin, disc_spin = derivatives[i]
        by_nodes[i, 3] = position_factor * dx + velocity_factor * dvx
        by_nodes[i, 4] = position_factor * dy + velocity_factor * dvy
        by_nodes[i, 0], by_nodes[i, 1] = -by_nodes[i, 3], -by_nodes[i, 4]
        by_nodes[i, 2] = velocity_factor * master_spin
        by_nodes[i, 5] = position_factor * angle + velocity_factor * disc_spin
    result = np.zeros((6, 6))
    for j in range(6):
        result[0, j], result[1, j], result[2, j] = by_nodes[0, j], by_nodes[1, j], -by_nodes[3, j]
        result[3, j], result[4, j], result[5, j] = -by_nodes[0, j], -by_nodes[1, j], -by_nodes[2, j]
    return result
