"""Dry friction between two bodies on a ring or at points of it: one connector for pins, discs and drivetrains.

The connector is an ``ObjectGenericODE2`` without mass over the nodes of *both* bodies, so that it puts the full
reaction on the master: the force −F and the moment −d×F of a force F that acts at a distance d from the
master's own reference point. Exudyn's marker connectors leave that moment out, which is no longer an exchange of
momentum between two free bodies.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any, Protocol, cast

import exudyn.itemInterface
import numpy as np

from exudyn_models.friction_laws import (
    CONTINUOUS,
    NONE_HELD,
    ring_friction,
    ring_friction_derivatives,
)
from exudyn_models.friction_sensors import RingFriction
from exudyn_models.slip_map import (
    KINDS,
    PLANAR,
    ROTOR,
    Kinds,
    friction_derivatives_on_nodes,
    friction_on_nodes,
)
from exudyn_models.strength import NumberOrFunction, Strength
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
        contact_radius: float,
        friction_coefficient: float,
        normal_load: float,
        regularisation: float,
        contact_points: int | None = None,
    ) -> Any:
        """Add the connector or connectors."""
        ...


def add_ring_friction(
    mbs: Any,
    master_node: Any,
    disc_node: Any,
    *,
    contact_radius: float | None = None,
    inner_radius: float | None = None,
    outer_radius: float | None = None,
    friction_coefficient: NumberOrFunction,
    normal_load: NumberOrFunction,
    regularisation: float,
    contact_points: int | None = None,
    held: int | None = None,
) -> RingFriction:
    """Add friction between a disc and a master disc to ``mbs``; return a handle with its number and its sensors.

    The contact is a circle of ``contact_radius`` about the origin of the disc's node, or ``contact_points`` points on
    it that turn with the disc: point i at the angle φ + 2πi/n. The points share the normal load N alike. Or it is the
    annulus between ``inner_radius`` and ``outer_radius`` under uniform pressure. The law is that of
    ``friction_laws``: Coulomb friction wherever the slip reaches ε, viscous below.

    Either node is a ``Node1D``, which turns about the z-axis through the global origin, a ``NodeRigidBody2D``, a
    ``NodeRigidBodyRotVecLG`` or a ``NodeRigidBodyRxyz``. The plane of contact goes through the disc's node across the
    z-axis of the master's body; a small tilt of the disc against it leaves the ring as it is. The load presses
    nothing together: it counts for friction only. ``computeMassMatrixInversePerBody`` must stay False, because the
    nodes are shared with their bodies.

    Parameters
    ----------
    mbs : exudyn MainSystem
        Not yet assembled, with both nodes.
    master_node, disc_node : NodeIndex
        Of the two bodies.
    contact_radius : float
        R in m, >= 0; the contact is a pin if it is 0.
    inner_radius, outer_radius : float
        In place of ``contact_radius``: 0 <= ``inner_radius`` < ``outer_radius``, in m.
    friction_coefficient : float or callable
        μ >= 0, or a function that returns it for the mean slip speed of the contact in m/s (Stribeck's curve).
    normal_load : float or callable
        N in N of the whole contact, >= 0, or a function that returns it for the time in s. The function may read
        sensors of ``mbs``, as a controller does. Derivatives of N are not part of the Jacobian.
    regularisation : float
        ε in m/s, > 0.
    contact_points : int or None
        n >= 1, or None for the whole circle or annulus.
    held : int, optional
        i + 1 for a point i whose friction is viscous at any slip, to model one about which the disc pivots.

    Raises
    ------
    ValueError
        If a number is out of its range or a node is of a kind that can't be used. Where a function returns such a
        number in a run, Exudyn ends it with an error that tells it and for which argument.

    """
    if inner_radius is None and outer_radius is None:
        radius, points, epsilon = checked_contact(regularisation, contact_radius, contact_points)
        inner = radius
    else:
        inner, radius = _checked_annulus(inner_radius, outer_radius, contact_radius, contact_points)
        points, epsilon = CONTINUOUS, checked_regularisation(regularisation)
    if held is not None and held not in range(1, 1 + points):
        raise ValueError(
            f"held = {held}: it must be from 1 to the number of points, {contact_points}, or None"
        )
    unit = (radius, points, 1.0, epsilon, NONE_HELD if held is None else int(held) - 1, inner)
    strength = Strength(unit, friction_coefficient, normal_load)
    kinds = checked_kind("master_node", mbs, master_node), checked_kind("disc_node", mbs, disc_node)
    if int(master_node) == int(disc_node):
        raise ValueError(f"disc_node {int(disc_node)} is the master_node too: friction takes two bodies")
    reference = np.hstack(
        [mbs.GetNodeParameter(node, "referenceCoordinates") for node in (master_node, disc_node)]
    )
    force = _force_on_any(kinds, reference, strength)
    jacobian = _jacobian_on_any(kinds, reference, strength)
    if kinds[0] in (ROTOR, PLANAR) and kinds[1] == PLANAR:  # known in closed form, at half the cost
        # .tolist(): one NumPy number in the kernel would make all its arithmetic NumPy's, which is far slower.
        *place, x, y, angle = reference.tolist()
        if kinds[0] == PLANAR:
            x, y = x - place[0], y - place[1]
        # A pin's force is so short that the call into compiled code would cost more than it saves.
        kernel: Kernel = cast(Any, ring_friction).py_func if radius == 0.0 else ring_friction
        on_pair, jacobian_on_pair = (
            (_force_on_planar_master, _jacobian_on_planar_master)
            if kinds[0] == PLANAR
            else (_force_on_rotor, _jacobian_on_rotor)
        )
        force = on_pair(kernel, x, y, angle, strength, force)
        jacobian = jacobian_on_pair(x, y, angle, strength, jacobian)
    size = len(reference)
    item = mbs.AddObject(
        items.ObjectGenericODE2(
            nodeNumbers=[master_node, disc_node],
            massMatrix=np.zeros((size, size)),
            forceUserFunction=force,
            jacobianUserFunction=jacobian,
        )
    )
    return RingFriction(mbs, item, (master_node, disc_node), kinds, reference, strength)


def checked_contact(
    regularisation: float, contact_radius: float | None, contact_points: int | None
) -> tuple[float, int, float]:
    """Return R, number of points and ε; raise ``ValueError`` if one is out of its range."""
    radius = finite_number("contact_radius", contact_radius)
    if radius < 0.0:
        raise ValueError(f"contact_radius = {radius:g} m: it must be >= 0")
    if contact_points is not None and (
        isinstance(contact_points, bool) or contact_points != int(contact_points) or contact_points < 1
    ):
        raise ValueError(
            f"contact_points = {contact_points}: it must be a whole number >= 1, or None for the continuous ring"
        )
    epsilon = checked_regularisation(regularisation)
    if radius == 0.0:  # a pin, of however many points
        return radius, 1, epsilon
    return radius, int(contact_points or CONTINUOUS), epsilon


def _checked_annulus(
    inner_radius: float | None,
    outer_radius: float | None,
    contact_radius: float | None,
    contact_points: int | None,
) -> tuple[float, float]:
    """Return both radii in m; raise ``ValueError`` if there is no such annulus."""
    for name, value in (("contact_radius", contact_radius), ("contact_points", contact_points)):
        if value is not None:
            raise ValueError(f"{name} = {value}: it must be left out for an annulus with its two radii")
    inner, outer = finite_number("inner_radius", inner_radius), finite_number("outer_radius", outer_radius)
    if inner < 0.0:
        raise ValueError(f"inner_radius = {inner:g} m: it must be >= 0")
    if outer <= inner:
        raise ValueError(f"outer_radius = {outer:g} m: it must be > inner_radius = {inner:g} m")
    return inner, outer


def checked_regularisation(value: float) -> float:
    """Return ε in m/s as a float; raise ``ValueError`` if it is not a finite number > 0."""
    epsilon = finite_number("regularisation", value)
    if epsilon <= 0.0:
        raise ValueError(f"regularisation = {epsilon:g} m/s: it must be > 0")
    return epsilon


ForceFunction = Callable[[Any, float, int, Sequence[float], Sequence[float]], list[float]]
JacobianFunction = Callable[[Any, float, int, Sequence[float], Sequence[float], float, float], FloatArray]


def _force_on_any(kinds: Kinds, reference: FloatArray, strength: Strength) -> ForceFunction:
    def force(mbs: Any, t: float, item: int, q: Sequence[float], q_t: Sequence[float]) -> list[float]:
        contact = strength.contact or strength.contact_at(t)
        forces, slip_speed = friction_on_nodes(kinds, reference + q, np.array(q_t), contact)
        if strength.depends_on_slip:
            forces *= strength.coefficient(slip_speed)
        return cast(list[float], forces.tolist())

    return force


def _jacobian_on_any(kinds: Kinds, reference: FloatArray, strength: Strength) -> JacobianFunction:
    def jacobian(
        mbs: Any,
        t: float,
        item: int,
        q: Sequence[float],
        q_t: Sequence[float],
        position_factor: float,
        velocity_factor: float,
    ) -> FloatArray:
        contact = strength.contact or strength.contact_at(t)
        state = kinds, reference + q, np.array(q_t)
        derivatives, mean_derivatives = friction_derivatives_on_nodes(
            *state, position_factor, velocity_factor, contact
        )
        if strength.depends_on_slip:
            forces, slip_speed = friction_on_nodes(*state, contact)
            derivatives *= strength.coefficient(slip_speed)
            derivatives += strength.coefficient_slope(slip_speed) * np.outer(forces, mean_derivatives)
        return -derivatives  # Exudyn takes those of the left-hand side

    return jacobian


def _force_on_rotor(
    kernel: Kernel, x0: float, y0: float, angle0: float, strength: Strength, otherwise: ForceFunction
) -> ForceFunction:
    def force(mbs: Any, t: float, item: int, q: Sequence[float], q_t: Sequence[float]) -> list[float]:
        contact = strength.contact
        if contact is None:
            if strength.depends_on_slip:
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
            if strength.depends_on_slip:
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

    return _jacobian_on_pair(arguments, _ON_ROTOR, strength, otherwise)


def _jacobian_on_planar_master(
    x0: float, y0: float, angle0: float, strength: Strength, otherwise: JacobianFunction
) -> JacobianFunction:
    def arguments(q: Sequence[float], q_t: Sequence[float]) -> Relative:
        xm, ym, _, x, y, angle = q
        vxm, vym, master_spin, vx, vy, spin = q_t
        return x0 + x - xm, y0 + y - ym, angle0 + angle, vx - vxm, vy - vym, master_spin, spin

    return _jacobian_on_pair(arguments, _ON_PLANAR, strength, otherwise)


def _jacobian_on_pair(
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
        if strength.depends_on_slip:
            return otherwise(mbs, t, item, q, q_t, position_factor, velocity_factor)
        contact = strength.contact or strength.contact_at(t)
        derivatives = ring_friction_derivatives(*arguments(q, q_t), contact)
        return _over_both_nodes(derivatives, position_factor, velocity_factor, maps)

    return jacobian


def checked_kind(name: str, mbs: Any, node: Any, allowed: Sequence[int] = tuple(KINDS.values())) -> int:
    """Return which of ``KINDS`` the node is; raise ``ValueError`` if it is none of those ``allowed``."""
    kind = mbs.GetNode(node)["nodeType"]
    if KINDS.get(kind) in allowed:
        return KINDS[kind]
    names = [f"Node{key}" for key, value in KINDS.items() if value in allowed]
    raise ValueError(
        f"{name} {int(node)} is a Node{kind}: ring friction takes a {' or '.join(', '.join(names).rsplit(', ', 1))}"
    )
