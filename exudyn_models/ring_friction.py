"""Dry friction between two bodies on a ring or at points of it: one connector for pins, discs and drivetrains.

The connector is an ``ObjectGenericODE2`` without mass over the nodes of *both* bodies, so that it puts the full
reaction on the master: the force −F and the moment −d×F of a force F that acts at a distance d from the
master's own reference point. Exudyn's marker connectors leave that moment out, which is no longer an exchange of
momentum between two free bodies.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any, Protocol

import exudyn.itemInterface
import numpy as np

from exudyn_models.friction_laws import (
    CONTINUOUS,
    NONE_HELD,
    Contact,
    ring_friction,
    ring_friction_derivatives,
)
from reference_model.systems import FloatArray, finite_number

items: Any = exudyn.itemInterface  # its type hints do not fit its own calls

Kernel = Callable[..., tuple[float, float, float, float]]


class AddFriction(Protocol):
    """Adds friction between two discs to a model, as ``add_ring_friction`` does."""

    def __call__(
        self,
        mbs: Any,
        master_node: Any,
        disc_node: Any,
        *,
        friction_force: float,
        regularisation: float,
        contact_radius: float = 0.0,
        contact_points: int | None = 1,
    ) -> Any:
        """Add the connector or connectors; return their ``ObjectIndex``."""
        ...


def add_ring_friction(
    mbs: Any,
    master_node: Any,
    disc_node: Any,
    *,
    friction_force: float,
    regularisation: float,
    contact_radius: float = 0.0,
    contact_points: int | None = 1,
    held: int | None = None,
) -> Any:
    """Add friction between a disc and a master disc to ``mbs``; return the ``ObjectIndex`` of the connector.

    The contact is a circle of ``contact_radius`` about the origin of the disc's node, or ``contact_points`` points on
    it that turn with the disc: point i at the angle φ + 2πi/n. The points share the normal force N alike. The law is
    that of ``friction_laws``: Coulomb friction wherever the slip reaches ε, viscous below.

    The disc's node is a ``NodeRigidBody2D``. The master's is a ``NodeRigidBody2D`` or a ``Node1D`` that turns about
    the z-axis through the global origin. ``computeMassMatrixInversePerBody`` must stay False, because the nodes are
    shared with their bodies.

    Parameters
    ----------
    mbs : exudyn MainSystem
        Not yet assembled, with both nodes.
    master_node, disc_node : NodeIndex
        Of the two bodies.
    friction_force : float
        μN of all points together, in N, >= 0.
    regularisation : float
        ε in m/s, > 0.
    contact_radius : float
        R in m, >= 0; with one point at R = 0 the contact is a pin.
    contact_points : int or None
        n >= 1, or None for the whole circle, which then has R > 0.
    held : int, optional
        i + 1 for a point i whose friction is viscous at any slip, to model one about which the disc pivots.

    Raises
    ------
    ValueError
        If a number is out of its range or a node is of a kind that can't be used.

    """
    numbers = checked_contact(friction_force, regularisation, contact_radius, contact_points)
    if held is not None and held not in range(1, 1 + numbers[1]):
        raise ValueError(
            f"held = {held}: it must be from 1 to the number of points, {contact_points}, or None"
        )
    contact = (*numbers, NONE_HELD if held is None else int(held) - 1)
    # A pin's force is so short that the call into compiled code would cost more than it saves.
    kernel: Kernel = ring_friction.py_func if contact[0] == 0.0 else ring_friction
    planar_master = is_planar("master_node", mbs, master_node, rotor_allowed=True)
    is_planar("disc_node", mbs, disc_node, rotor_allowed=False)
    # .tolist(): one NumPy number in the kernel would make all its arithmetic NumPy's, which is far slower.
    xd, yd, angle_d = mbs.GetNodeParameter(disc_node, "referenceCoordinates").tolist()
    if planar_master:
        xm, ym, _ = mbs.GetNodeParameter(master_node, "referenceCoordinates").tolist()
        force = _force_on_planar_master(kernel, xd - xm, yd - ym, angle_d, contact)
        jacobian = _jacobian_on_planar_master(xd - xm, yd - ym, angle_d, contact)
    else:
        force = _force_on_rotor(kernel, xd, yd, angle_d, contact)
        jacobian = _jacobian_on_rotor(xd, yd, angle_d, contact)
    size = 6 if planar_master else 4
    return mbs.AddObject(
        items.ObjectGenericODE2(
            nodeNumbers=[master_node, disc_node],
            massMatrix=np.zeros((size, size)),
            forceUserFunction=force,
            jacobianUserFunction=jacobian,
        )
    )


def checked_contact(
    friction_force: float, regularisation: float, contact_radius: float, contact_points: int | None
) -> tuple[float, int, float, float]:
    """Return R, number of points, μN and ε; raise ``ValueError`` if one is out of its range."""
    friction = finite_number("friction_force", friction_force)
    radius = finite_number("contact_radius", contact_radius)
    if friction < 0.0:
        raise ValueError(f"friction_force = {friction:g} N: it must be >= 0")
    if radius < 0.0:
        raise ValueError(f"contact_radius = {radius:g} m: it must be >= 0")
    if contact_points is None:
        if radius == 0.0:
            raise ValueError(
                "contact_radius = 0 m: it must be > 0 for the continuous ring, contact_points = None"
            )
    elif isinstance(contact_points, bool) or contact_points != int(contact_points) or contact_points < 1:
        raise ValueError(
            f"contact_points = {contact_points}: it must be a whole number >= 1, or None for the continuous ring"
        )
    epsilon = checked_regularisation(regularisation)
    return (radius, int(contact_points or CONTINUOUS), friction, epsilon)


def checked_regularisation(value: float) -> float:
    """Return ε in m/s as a float; raise ``ValueError`` if it is not a finite number > 0."""
    epsilon = finite_number("regularisation", value)
    if epsilon <= 0.0:
        raise ValueError(f"regularisation = {epsilon:g} m/s: it must be > 0")
    return epsilon


ForceFunction = Callable[[Any, float, int, Sequence[float], Sequence[float]], list[float]]
JacobianFunction = Callable[[Any, float, int, Sequence[float], Sequence[float], float, float], FloatArray]


def _force_on_rotor(kernel: Kernel, x0: float, y0: float, angle0: float, contact: Contact) -> ForceFunction:
    def force(mbs: Any, t: float, item: int, q: Sequence[float], q_t: Sequence[float]) -> list[float]:
        _, x, y, angle = q
        master_spin, vx, vy, spin = q_t
        fx, fy, moment, master_moment = kernel(
            x0 + x, y0 + y, angle0 + angle, vx, vy, master_spin, spin, contact
        )
        return [master_moment, fx, fy, moment]

    return force


def _force_on_planar_master(
    kernel: Kernel, x0: float, y0: float, angle0: float, contact: Contact
) -> ForceFunction:
    def force(mbs: Any, t: float, item: int, q: Sequence[float], q_t: Sequence[float]) -> list[float]:
        xm, ym, _, x, y, angle = q
        vxm, vym, master_spin, vx, vy, spin = q_t
        fx, fy, moment, master_moment = kernel(
            x0 + x - xm, y0 + y - ym, angle0 + angle, vx - vxm, vy - vym, master_spin, spin, contact
        )
        return [-fx, -fy, master_moment, fx, fy, moment]

    return force


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


def _jacobian_on_rotor(x0: float, y0: float, angle0: float, contact: Contact) -> JacobianFunction:
    def jacobian(
        mbs: Any,
        t: float,
        item: int,
        q: Sequence[float],
        q_t: Sequence[float],
        position_factor: float,
        velocity_factor: float,
    ) -> FloatArray:
        _, x, y, angle = q
        master_spin, vx, vy, spin = q_t
        derivatives = ring_friction_derivatives(
            x0 + x, y0 + y, angle0 + angle, vx, vy, master_spin, spin, contact
        )
        return _over_both_nodes(derivatives, position_factor, velocity_factor, _ON_ROTOR)

    return jacobian


def _jacobian_on_planar_master(x0: float, y0: float, angle0: float, contact: Contact) -> JacobianFunction:
    def jacobian(
        mbs: Any,
        t: float,
        item: int,
        q: Sequence[float],
        q_t: Sequence[float],
        position_factor: float,
        velocity_factor: float,
    ) -> FloatArray:
        xm, ym, _, x, y, angle = q
        vxm, vym, master_spin, vx, vy, spin = q_t
        derivatives = ring_friction_derivatives(
            x0 + x - xm, y0 + y - ym, angle0 + angle, vx - vxm, vy - vym, master_spin, spin, contact
        )
        return _over_both_nodes(derivatives, position_factor, velocity_factor, _ON_PLANAR)

    return jacobian


def is_planar(name: str, mbs: Any, node: Any, *, rotor_allowed: bool) -> bool:
    """Return whether ``node`` is that of a planar body, not of a rotor; raise ``ValueError`` if it can't be used."""
    kind = mbs.GetNode(node)["nodeType"]
    if kind == "RigidBody2D":
        return True
    if kind == "1D" and rotor_allowed:
        return False
    allowed = "NodeRigidBody2D or Node1D" if rotor_allowed else "NodeRigidBody2D"
    raise ValueError(f"{name} {int(node)} is a Node{kind}: ring friction takes a {allowed}")
