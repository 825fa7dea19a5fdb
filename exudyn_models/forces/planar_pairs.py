"""Friction of a planar disc on the ground, a rotor or a planar master, in closed form.

The arguments are the same as in ``any_pair``. A force costs 0.55 (pin) to 0.7 times as much, a Jacobian
0.35 to 0.6 times, and the first contact takes half as long to compile.
"""

from typing import Any

import numpy as np

from exudyn_models.forces.any_pair import Parameters, contact_of, motion_of
from exudyn_models.forces.friction_laws import Contact, ring_friction, ring_friction_derivatives
from exudyn_models.forces.jit import compiled, inlined
from exudyn_models.forces.slip_kinematics import GROUND, NO_MOUNTS, PLANAR, ROTOR, SIZES
from reference_model.systems import FloatArray

IN_THE_PLANE = tuple((master, PLANAR, NO_MOUNTS) for master in (GROUND, ROTOR, PLANAR))
"""``Kinds`` of pairs that these functions support."""


@compiled
def force_in_the_plane(
    parameters: Parameters, factor: float, mbs: Any, t: Any, item: Any, q: Any, q_t: Any
) -> Any:
    """Return the generalised forces on both nodes, in the memory of ``q_t``, times ``factor``."""
    contact, motion, forces, disc = _contact_and_motion(parameters, factor, q, q_t)
    forces[disc], forces[disc + 1], forces[disc + 2], master_moment = ring_friction(*motion, contact)
    if disc > 0:
        forces[disc - 1] = master_moment
    if disc > 1:
        forces[0], forces[1] = -forces[disc], -forces[disc + 1]
    return q_t


@compiled
def jacobian_in_the_plane(
    parameters: Parameters,
    factor: float,
    mbs: Any,
    t: Any,
    item: Any,
    q: Any,
    q_t: Any,
    position_factor: float,
    velocity_factor: float,
) -> FloatArray:
    """Return the derivatives of the negative forces, shape (n, n), if ``factor`` does not depend on the motion."""
    contact, motion, _, disc = _contact_and_motion(parameters, factor, q, q_t)
    derivatives = ring_friction_derivatives(*motion, contact)
    # The ground is a planar master without coordinates, and a rotor is a planar master without x and y.
    hidden = SIZES[PLANAR] - disc
    return _over_both_nodes(derivatives, position_factor, velocity_factor)[hidden:, hidden:].copy()


Relative = tuple[float, float, float, float, float, float, float]
"""Relative motion: dx, dy, angle, dvx, dvy and both spins."""


@inlined
def _contact_and_motion(
    parameters: Parameters, factor: float, q: Any, q_t: Any
) -> tuple[Contact, Relative, FloatArray, int]:
    """Return the contact with its present μN, the relative motion, the velocities, and the disc's first index."""
    contact, kinds = contact_of(parameters)
    coordinates, velocities = motion_of(parameters, q, q_t)
    disc = SIZES[kinds[0]]
    x, y, angle = coordinates[disc], coordinates[disc + 1], coordinates[disc + 2]
    vx, vy, spin, master_spin = velocities[disc], velocities[disc + 1], velocities[disc + 2], 0.0
    if disc > 0:
        master_spin = velocities[disc - 1]
    if disc > 1:
        x, y, vx, vy = x - coordinates[0], y - coordinates[1], vx - velocities[0], vy - velocities[1]
    radius, points, friction, epsilon, held, inner = contact
    contact = radius, points, factor * friction, epsilon, held, inner
    return contact, (x, y, angle, vx, vy, master_spin, spin), velocities, disc


@compiled
def _over_both_nodes(derivatives: FloatArray, position_factor: float, velocity_factor: float) -> FloatArray:
    """Return minus the derivatives on two planar nodes, from those of (F_x, F_y, M, M_master)."""
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
