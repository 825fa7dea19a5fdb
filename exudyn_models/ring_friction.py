"""Dry friction between two bodies at points on a ring: one connector for pins, discs and drivetrains.

The connector is an ``ObjectGenericODE2`` without mass over the nodes of *both* bodies, so that it puts the full
reaction on the master: the force −F and the moment −d×F of a force F that acts at a distance d from the
master's own reference point. Exudyn's marker connectors leave that moment out, which is no longer an exchange of
momentum between two free bodies.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import Any

import exudyn.itemInterface
import numba
import numpy as np

from reference_model.systems import FloatArray, finite_number

items: Any = exudyn.itemInterface  # its type hints do not fit its own calls

Kernel = Callable[..., tuple[float, float, float, float]]


def add_ring_friction(
    mbs: Any,
    master_node: Any,
    disc_node: Any,
    *,
    friction_force: float,
    regularisation: float,
    contact_radius: float = 0.0,
    contact_points: int = 1,
) -> Any:
    """Add friction between a disc and a master disc to ``mbs``; return the ``ObjectIndex`` of the connector.

    ``contact_points`` points sit on a circle of ``contact_radius`` about the origin of the disc's node and turn
    with the disc: point i at the angle φ + 2πi/n. Each carries the normal force N/n and slips with v over the
    master disc below. The friction on the disc there is

        F = −(μN/n)·v/max(|v|, ε),

    Coulomb friction for |v| ≥ ε, viscous below. Of the usual smoothings this one alone is *exact* as soon as
    |v| ≥ ε: with v/√(v²+ε²) every release leaves an error of ε^0.8 behind, here all errors are of first order in ε.

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
    contact_points : int
        n >= 1.

    Raises
    ------
    ValueError
        If a number is out of its range or a node is of a kind that can't be used.

    """
    friction = finite_number("friction_force", friction_force)
    radius = finite_number("contact_radius", contact_radius)
    if friction < 0.0:
        raise ValueError(f"friction_force = {friction:g} N: it must be >= 0")
    if radius < 0.0:
        raise ValueError(f"contact_radius = {radius:g} m: it must be >= 0")
    if isinstance(contact_points, bool) or contact_points != int(contact_points) or contact_points < 1:
        raise ValueError(f"contact_points = {contact_points}: it must be a whole number >= 1")
    epsilon = checked_regularisation(regularisation)
    contact = (radius, int(contact_points), friction, epsilon)
    # A pin's force is so short that the call into compiled code would cost more than it saves.
    kernel: Kernel = ring_friction.py_func if radius == 0.0 else ring_friction
    planar_master = _is_planar("master_node", mbs, master_node, rotor_allowed=True)
    _is_planar("disc_node", mbs, disc_node, rotor_allowed=False)
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


def checked_regularisation(value: float) -> float:
    """Return ε in m/s as a float; raise ``ValueError`` if it is not a finite number > 0."""
    epsilon = finite_number("regularisation", value)
    if epsilon <= 0.0:
        raise ValueError(f"regularisation = {epsilon:g} m/s: it must be > 0")
    return epsilon


@numba.njit(cache=True)
def ring_friction(
    dx: float,
    dy: float,
    angle: float,
    dvx: float,
    dvy: float,
    master_spin: float,
    disc_spin: float,
    contact: tuple[float, int, float, float],
) -> tuple[float, float, float, float]:
    """Return force and moment on the disc and moment on the master: F_x, F_y (N), M, M_master (N m).

    ``dx, dy`` (m) and ``dvx, dvy`` (m/s) are position and velocity of the disc relative to the master's node,
    ``angle`` (rad) is φ, the spins are in rad/s; ``contact`` is (R, n, μN, ε). The force on the master is −F.
    """
    radius, points, friction, epsilon = contact
    ux = dvx + master_spin * dy  # slip of the disc's centre
    uy = dvy - master_spin * dx
    if radius == 0.0:
        slip = math.sqrt(ux * ux + uy * uy)
        factor = -friction / (slip if slip > epsilon else epsilon)
        fx = factor * ux
        fy = factor * uy
        return fx, fy, 0.0, dy * fx - dx * fy
    rim = radius * (disc_spin - master_spin)
    share = friction / points
    fx = fy = moment = 0.0
    for i in range(points):
        alpha = angle + 2.0 * math.pi * i / points
        c, s = math.cos(alpha), math.sin(alpha)
        vx = ux - rim * s
        vy = uy + rim * c
        slip = math.sqrt(vx * vx + vy * vy)
        factor = -share / (slip if slip > epsilon else epsilon)
        fx += factor * vx
        fy += factor * vy
        moment += factor * (c * vy - s * vx)
    moment *= radius
    return fx, fy, moment, dy * fx - dx * fy - moment


@numba.njit(cache=True)
def ring_friction_derivatives(
    dx: float,
    dy: float,
    angle: float,
    dvx: float,
    dvy: float,
    master_spin: float,
    disc_spin: float,
    contact: tuple[float, int, float, float],
) -> FloatArray:
    """Return the derivatives of (F_x, F_y, M, M_master) with respect to the first seven arguments, shape (4, 7)."""
    radius, points, friction, epsilon = contact
    ux = dvx + master_spin * dy
    uy = dvy - master_spin * dx
    spin = disc_spin - master_spin
    share = friction / points
    result = np.zeros((4, 7))
    fx = fy = 0.0
    for i in range(points):
        alpha = angle + 2.0 * math.pi * i / points
        rx, ry = radius * math.cos(alpha), radius * math.sin(alpha)
        vx = ux - spin * ry
        vy = uy + spin * rx
        slip = math.sqrt(vx * vx + vy * vy)
        if slip > epsilon:  # dF/dv = −(μN/n)·(1 − e⊗e)/|v|: only the direction changes
            ex, ey = vx / slip, vy / slip
            gxx, gxy, gyy = -share * ey * ey / slip, share * ex * ey / slip, -share * ex * ex / slip
            px, py = -share * ex, -share * ey
        else:
            gxx, gxy, gyy = -share / epsilon, 0.0, -share / epsilon
            px, py = gxx * vx, gyy * vy
        for j in range(7):
            # d(vx)/d(argument j), d(vy)/d(argument j)
            if j == 0:
                wx, wy = 0.0, -master_spin
            elif j == 1:
                wx, wy = master_spin, 0.0
            elif j == 2:
                wx, wy = -spin * rx, -spin * ry
            elif j == 3:
                wx, wy = 1.0, 0.0
            elif j == 4:
                wx, wy = 0.0, 1.0
            elif j == 5:
                wx, wy = dy + ry, -dx - rx
            else:
                wx, wy = -ry, rx
            hx = gxx * wx + gxy * wy
            hy = gxy * wx + gyy * wy
            result[0, j] += hx
            result[1, j] += hy
            result[2, j] += rx * hy - ry * hx
        result[2, 2] -= ry * py + rx * px  # the arm turns with the disc
        fx += px
        fy += py
    for j in range(7):
        result[3, j] = dy * result[0, j] - dx * result[1, j] - result[2, j]
    result[3, 0] -= fy
    result[3, 1] += fx
    return result


Contact = tuple[float, int, float, float]
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


def _is_planar(name: str, mbs: Any, node: Any, *, rotor_allowed: bool) -> bool:
    kind = mbs.GetNode(node)["nodeType"]
    if kind == "RigidBody2D":
        return True
    if kind == "1D" and rotor_allowed:
        return False
    allowed = "NodeRigidBody2D or Node1D" if rotor_allowed else "NodeRigidBody2D"
    raise ValueError(f"{name} {int(node)} is a Node{kind}: ring friction takes a {allowed}")
