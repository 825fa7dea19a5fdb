"""Friction of a planar disc on the ground, a rotor or a planar master, in closed form at a third of the cost.

The arguments are those of the functions in ``any_pair``.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np

from exudyn_models.forces.friction_laws import (
    contact_of,
    ring_friction,
    ring_friction_derivatives,
    slip_potential_of_contact,
)
from exudyn_models.forces.jit import compiled
from exudyn_models.forces.laws.product import Law, friction_force_under
from exudyn_models.forces.slip_kinematics import GROUND, PLANAR, ROTOR, Floats, Kinds
from reference_model.systems import FloatArray


@compiled
def force_on_ground(
    parameters: Floats, law: Law | None, mbs: Any, t: float, item: int, q: Floats, q_t: Floats
) -> Floats:
    """Return the generalised forces on a planar disc."""
    fx, fy, moment, _ = _friction(_on_ground(parameters, q, q_t), parameters, law, t)
    return fx, fy, moment


@compiled
def force_on_rotor(
    parameters: Floats, law: Law | None, mbs: Any, t: float, item: int, q: Floats, q_t: Floats
) -> Floats:
    """Return the forces on a rotor and a planar disc."""
    fx, fy, moment, master_moment = _friction(_on_rotor(parameters, q, q_t), parameters, law, t)
    return master_moment, fx, fy, moment


@compiled
def force_on_planar(
    parameters: Floats, law: Law | None, mbs: Any, t: float, item: int, q: Floats, q_t: Floats
) -> Floats:
    """Return the forces on a planar master and a planar disc."""
    fx, fy, moment, master_moment = _friction(_on_planar(parameters, q, q_t), parameters, law, t)
    return -fx, -fy, master_moment, fx, fy, moment


@compiled
def jacobian_on_ground(
    parameters: Floats,
    mbs: Any,
    t: float,
    item: int,
    q: Floats,
    q_t: Floats,
    position_factor: float,
    velocity_factor: float,
) -> FloatArray:
    """Return the derivatives of the negative forces, shape (3, 3)."""
    contact, _ = contact_of(parameters)
    derivatives = ring_friction_derivatives(*_on_ground(parameters, q, q_t), contact)
    # The ground is a planar master without coordinates.
    return _over_both_nodes(derivatives, position_factor, velocity_factor)[3:, 3:].copy()


@compiled
def jacobian_on_rotor(
    parameters: Floats,
    mbs: Any,
    t: float,
    item: int,
    q: Floats,
    q_t: Floats,
    position_factor: float,
    velocity_factor: float,
) -> FloatArray:
    """Return the derivatives of the negative forces, shape (4, 4)."""
    contact, _ = contact_of(parameters)
    derivatives = ring_friction_derivatives(*_on_rotor(parameters, q, q_t), contact)
    # A rotor is a planar master without x and y.
    return _over_both_nodes(derivatives, position_factor, velocity_factor)[2:, 2:].copy()


@compiled
def jacobian_on_planar(
    parameters: Floats,
    mbs: Any,
    t: float,
    item: int,
    q: Floats,
    q_t: Floats,
    position_factor: float,
    velocity_factor: float,
) -> FloatArray:
    """Return the derivatives of the negative forces, shape (6, 6)."""
    contact, _ = contact_of(parameters)
    derivatives = ring_friction_derivatives(*_on_planar(parameters, q, q_t), contact)
    return _over_both_nodes(derivatives, position_factor, velocity_factor)


LAWS: dict[Kinds, tuple[Callable[..., Floats], Callable[..., FloatArray]]] = {
    (GROUND, PLANAR, None): (force_on_ground, jacobian_on_ground),
    (ROTOR, PLANAR, None): (force_on_rotor, jacobian_on_rotor),
    (PLANAR, PLANAR, None): (force_on_planar, jacobian_on_planar),
}

Relative = tuple[float, float, float, float, float, float, float]
"""Relative motion: dx, dy, angle, dvx, dvy and both spins."""


@compiled
def _friction(
    motion: Relative, parameters: Floats, law: Law | None, t: float
) -> tuple[float, float, float, float]:
    contact, _ = contact_of(parameters)
    if law is None:
        return ring_friction(*motion, contact)
    dx, dy, angle, dvx, dvy, master_spin, disc_spin = motion
    radius, points, _, epsilon, held, inner = contact
    spin = disc_spin - master_spin
    ux, uy = dvx + master_spin * dy, dvy - master_spin * dx
    speed = slip_potential_of_contact(ux, uy, spin, angle, contact)
    friction = friction_force_under(law, epsilon, t, math.sqrt(dx * dx + dy * dy), speed, spin)
    return ring_friction(*motion, (radius, points, friction, epsilon, held, inner))


@compiled
def _on_ground(parameters: Floats, q: Floats, q_t: Floats) -> Relative:
    _, (_, _, x, y, angle) = contact_of(parameters)
    return x + q[0], y + q[1], angle + q[2], q_t[0], q_t[1], 0.0, q_t[2]


@compiled
def _on_rotor(parameters: Floats, q: Floats, q_t: Floats) -> Relative:
    _, (_, _, _, x, y, angle) = contact_of(parameters)
    return x + q[1], y + q[2], angle + q[3], q_t[1], q_t[2], q_t[0], q_t[3]


@compiled
def _on_planar(parameters: Floats, q: Floats, q_t: Floats) -> Relative:
    _, (_, _, xm, ym, _, x, y, angle) = contact_of(parameters)
    dx, dy = (x + q[3]) - (xm + q[0]), (y + q[4]) - (ym + q[1])
    return dx, dy, angle + q[5], q_t[3] - q_t[0], q_t[4] - q_t[1], q_t[2], q_t[5]


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
