"""Friction of a planar disc on a rotor or on a planar master: in closed form, at half the cost of other pairs."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any, cast

import numpy as np

from exudyn_models.friction_laws import ring_friction, ring_friction_derivatives
from exudyn_models.slip_map import PLANAR, ROTOR, Kinds
from exudyn_models.strength import Strength
from reference_model.systems import FloatArray

Kernel = Callable[..., tuple[float, float, float, float]]

ForceFunction = Callable[[Any, float, int, Sequence[float], Sequence[float]], list[float]]
JacobianFunction = Callable[[Any, float, int, Sequence[float], Sequence[float], float, float], FloatArray]


def is_planar(kinds: Kinds) -> bool:
    """Return whether a pair of nodes is one of those."""
    return kinds[0] in (ROTOR, PLANAR) and kinds[1] == PLANAR


def on_planar_pair(
    kinds: Kinds,
    reference: FloatArray,
    strength: Strength,
    force: ForceFunction,
    jacobian: JacobianFunction,
) -> tuple[ForceFunction, JacobianFunction]:
    """Return the connector's force and Jacobian as functions for Exudyn.

    ``force`` and ``jacobian`` are those for any pair of nodes, for a strength that depends on the motion.
    """
    # .tolist(): one NumPy number in the kernel would make all its arithmetic NumPy's, which is far slower.
    *place, x, y, angle = reference.tolist()
    # A pin's force is so short that the call into compiled code would cost more than it saves.
    kernel: Kernel = cast(Any, ring_friction).py_func if strength.contact_radius == 0.0 else ring_friction
    if kinds[0] == ROTOR:
        return (
            _force_on_rotor(kernel, x, y, angle, strength, force),
            _jacobian_on_rotor(x, y, angle, strength, jacobian),
        )
    x, y = x - place[0], y - place[1]
    return (
        _force_on_planar_master(kernel, x, y, angle, strength, force),
        _jacobian_on_planar_master(x, y, angle, strength, jacobian),
    )


def _force_on_rotor(
    kernel: Kernel, x0: float, y0: float, angle0: float, strength: Strength, otherwise: ForceFunction
) -> ForceFunction:
    def force(mbs: Any, t: float, item: int, q: Sequence[float], q_t: Sequence[float]) -> list[float]:
        contact = strength.contact
        if contact is None:
            if strength.depends_on_motion:
                return otherwise(mbs, t, item, q, q_t)
            contact = strength.contact_at(t)
        _, x, y, angle = q
        master_spin, vx, vy, spin = q_t
        fx, fy, moment, master_moment = kernel(
            x0 + x, y0 + y, angle0 + angle, vx, vy, master_spin, spin, contact
        )
        return [master_moment, fx, fy, moment]

    return force


def _force_on_planar_master(
    kernel: Kernel, x0: float, y0: float, angle0: float, strength: Strength, otherwise: ForceFunction
) -> ForceFunction:
    def force(mbs: Any, t: float, item: int, q: Sequence[float], q_t: Sequence[float]) -> list[float]:
        contact = strength.contact
        if contact is None:
            if strength.depends_on_motion:
                return otherwise(mbs, t, item, q, q_t)
            contact = strength.contact_at(t)
        xm, ym, _, x, y, angle = q
        vxm, vym, master_spin, vx, vy, spin = q_t
        fx, fy, moment, master_moment = kernel(
            x0 + x - xm, y0 + y - ym, angle0 + angle, vx - vxm, vy - vym, master_spin, spin, contact
        )
        return [-fx, -fy, master_moment, fx, fy, moment]

    return force


Relative = tuple[float, float, float, float, float, float, float]
"""What the kernel takes of the motion: dx, dy, angle, dvx, dvy and both spins."""

Maps = tuple[FloatArray, FloatArray, FloatArray]
"""Generalised forces from (F_x, F_y, M, M_master); the kernel's positions and velocities from those of the nodes."""

_FORCES_ON_ROTOR = np.array([[0, 0, 0, 1], [1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0]], dtype=float)
_ON_ROTOR: Maps = (
    _FORCES_ON_ROTOR,
    np.hstack((np.zeros((3, 1)), np.eye(3))),
    np.array([[0, 1, 0, 0], [0, 0, 1, 0], [1, 0, 0, 0], [0, 0, 0, 1]], dtype=float),
)
_ON_PLANAR: Maps = (
    np.vstack(([[-1, 0, 0, 0], [0, -1, 0, 0]], _FORCES_ON_ROTOR)).astype(float),
    np.hstack((-np.diag([1.0, 1.0, 0.0]), np.eye(3))),
    np.array([[-1, 0, 0, 1, 0, 0], [0, -1, 0, 0, 1, 0], [0, 0, 1, 0, 0, 0], [0, 0, 0, 0, 0, 1]], dtype=float),
)


def _over_both_nodes(
    derivatives: FloatArray, position_factor: float, velocity_factor: float, maps: Maps
) -> FloatArray:
    """Return the Jacobian over the coordinates of both nodes from the derivatives of the kernel.

    Exudyn takes the derivative of the left-hand side, where the force stands with a minus.
    """
    forces, positions, velocities = maps
    weighted = (
        -position_factor * derivatives[:, :3] @ positions - velocity_factor * derivatives[:, 3:] @ velocities
    )
    return np.asarray(forces @ weighted)


def _jacobian_on_rotor(
    x0: float, y0: float, angle0: float, strength: Strength, otherwise: JacobianFunction
) -> JacobianFunction:
    def arguments(q: Sequence[float], q_t: Sequence[float]) -> Relative:
        _, x, y, angle = q
        master_spin, vx, vy, spin = q_t
        return x0 + x, y0 + y, angle0 + angle, vx, vy, master_spin, spin

    return _jacobian_of_pair(arguments, _ON_ROTOR, strength, otherwise)


def _jacobian_on_planar_master(
    x0: float, y0: float, angle0: float, strength: Strength, otherwise: JacobianFunction
) -> JacobianFunction:
    def arguments(q: Sequence[float], q_t: Sequence[float]) -> Relative:
        xm, ym, _, x, y, angle = q
        vxm, vym, master_spin, vx, vy, spin = q_t
        return x0 + x - xm, y0 + y - ym, angle0 + angle, vx - vxm, vy - vym, master_spin, spin

    return _jacobian_of_pair(arguments, _ON_PLANAR, strength, otherwise)


def _jacobian_of_pair(
    arguments: Callable[[Sequence[float], Sequence[float]], Relative],
    maps: Maps,
    strength: Strength,
    otherwise: JacobianFunction,
) -> JacobianFunction:
    def jacobian(
        mbs: Any,
        t: float,
        item: int,
        q: Sequence[float],
        q_t: Sequence[float],
        position_factor: float,
        velocity_factor: float,
    ) -> FloatArray:
        if strength.depends_on_motion:
            return otherwise(mbs, t, item, q, q_t, position_factor, velocity_factor)
        contact = strength.contact or strength.contact_at(t)
        derivatives = ring_friction_derivatives(*arguments(q, q_t), contact)
        return _over_both_nodes(derivatives, position_factor, velocity_factor, maps)

    return jacobian
