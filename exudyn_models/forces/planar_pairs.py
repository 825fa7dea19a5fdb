"""Friction of a planar disc on a rotor or on a planar master: in closed form, at a third of the cost of other pairs.

Their arguments are those of the functions for any pair, in ``slip_jacobian``.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from exudyn_models.forces.friction_laws import contact_of, ring_friction, ring_friction_derivatives
from exudyn_models.forces.jit import compiled
from exudyn_models.forces.slip_kinematics import PLANAR, ROTOR, Floats, Kinds
from reference_model.systems import FloatArray


@compiled
def force_on_rotor(parameters: Floats, mbs: Any, t: float, item: int, q: Floats, q_t: Floats) -> Floats:
    """Return the generalised forces on a rotor and a planar disc."""
    contact, _ = contact_of(parameters)
    fx, fy, moment, master_moment = ring_friction(*_on_rotor(parameters, q, q_t), contact)
    return master_moment, fx, fy, moment


@compiled
def force_on_planar(parameters: Floats, mbs: Any, t: float, item: int, q: Floats, q_t: Floats) -> Floats:
    """Return the generalised forces on a planar master and a planar disc."""
    contact, _ = contact_of(parameters)
    fx, fy, moment, master_moment = ring_friction(*_on_planar(parameters, q, q_t), contact)
    return -fx, -fy, master_moment, fx, fy, moment


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
    """Return the derivatives of the left-hand side, where the force stands with a minus, shape (4, 4)."""
    contact, _ = contact_of(parameters)
    derivatives = ring_friction_derivatives(*_on_rotor(parameters, q, q_t), contact)
    return _over_both_nodes(
        derivatives,
        position_factor,
        velocity_factor,
        _FORCES_ON_ROTOR,
        _POSITIONS_ON_ROTOR,
        _VELOCITIES_ON_ROTOR,
    )


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
    """Return the derivatives of the left-hand side, where the force stands with a minus, shape (6, 6)."""
    contact, _ = contact_of(parameters)
    derivatives = ring_friction_derivatives(*_on_planar(parameters, q, q_t), contact)
    return _over_both_nodes(
        derivatives,
        position_factor,
        velocity_factor,
        _FORCES_ON_PLANAR,
        _POSITIONS_ON_PLANAR,
        _VELOCITIES_ON_PLANAR,
    )


LAWS: dict[Kinds, tuple[Callable[..., Floats], Callable[..., FloatArray]]] = {
    (ROTOR, PLANAR): (force_on_rotor, jacobian_on_rotor),
    (PLANAR, PLANAR): (force_on_planar, jacobian_on_planar),
}
"""Force and Jacobian on these pairs."""

Relative = tuple[float, float, float, float, float, float, float]
"""What the kernel takes of the motion: dx, dy, angle, dvx, dvy and both spins."""


@compiled
def _on_rotor(parameters: Floats, q: Floats, q_t: Floats) -> Relative:
    _, (_, _, _, x, y, angle) = contact_of(parameters)
    return x + q[1], y + q[2], angle + q[3], q_t[1], q_t[2], q_t[0], q_t[3]


@compiled
def _on_planar(parameters: Floats, q: Floats, q_t: Floats) -> Relative:
    _, (_, _, xm, ym, _, x, y, angle) = contact_of(parameters)
    dx, dy = (x + q[3]) - (xm + q[0]), (y + q[4]) - (ym + q[1])
    return dx, dy, angle + q[5], q_t[3] - q_t[0], q_t[4] - q_t[1], q_t[2], q_t[5]


# Generalised forces from (F_x, F_y, M, M_master), and what the kernel takes of positions and velocities of the nodes.
_FORCES_ON_ROTOR = np.array([[0, 0, 0, 1], [1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0]], dtype=float)
_POSITIONS_ON_ROTOR = np.hstack((np.zeros((3, 1)), np.eye(3)))
_VELOCITIES_ON_ROTOR = np.array([[0, 1, 0, 0], [0, 0, 1, 0], [1, 0, 0, 0], [0, 0, 0, 1]], dtype=float)
_FORCES_ON_PLANAR = np.vstack(([[-1, 0, 0, 0], [0, -1, 0, 0]], _FORCES_ON_ROTOR))
_POSITIONS_ON_PLANAR = np.hstack((-np.diag([1.0, 1.0, 0.0]), np.eye(3)))
_VELOCITIES_ON_PLANAR = np.array(
    [[-1, 0, 0, 1, 0, 0], [0, -1, 0, 0, 1, 0], [0, 0, 1, 0, 0, 0], [0, 0, 0, 0, 0, 1]], dtype=float
)


@compiled
def _over_both_nodes(
    derivatives: FloatArray,
    position_factor: float,
    velocity_factor: float,
    forces: FloatArray,
    positions: FloatArray,
    velocities: FloatArray,
) -> FloatArray:
    """Return minus the derivatives over the coordinates of both nodes from those of the kernel."""
    by_position = derivatives[:, :3].copy() @ positions  # a product of matrices takes whole ones only
    by_velocity = derivatives[:, 3:].copy() @ velocities
    return -(forces @ (position_factor * by_position + velocity_factor * by_velocity))
