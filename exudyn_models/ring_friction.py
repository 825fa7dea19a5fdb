"""Dry friction between two bodies on a ring or at points of it: one connector for pins, discs and drivetrains.

The connector is an ``ObjectGenericODE2`` without mass over the nodes of *both* bodies, so that it puts the full
reaction on the master: the force −F and the moment −d×F of a force F that acts at a distance d from the
master's own reference point. Exudyn's marker connectors leave that moment out, which is no longer an exchange of
momentum between two free bodies.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Protocol, cast

import exudyn.itemInterface
import numpy as np

from exudyn_models.friction_laws import (
    CONTINUOUS,
    NONE_HELD,
)
from exudyn_models.friction_sensors import RingFriction
from exudyn_models.planar_pairs import ForceFunction, JacobianFunction, is_planar, on_planar_pair
from exudyn_models.slip_map import (
    KINDS,
    Kinds,
    friction_derivatives_on_nodes,
    friction_on_nodes,
)
from exudyn_models.strength import NumberOrFunction, Strength
from reference_model.systems import FloatArray, finite_number

items: Any = exudyn.itemInterface  # its type hints do not fit its own calls


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
    if is_planar(kinds):
        force, jacobian = on_planar_pair(kinds, reference, strength, force, jacobian)
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


def _force_on_any(kinds: Kinds, reference: FloatArray, strength: Strength) -> ForceFunction:
    def force(mbs: Any, t: float, item: int, q: Sequence[float], q_t: Sequence[float]) -> list[float]:
        contact = strength.contact or strength.contact_at(t)
        forces, slip_speed = friction_on_nodes(kinds, reference + q, np.array(q_t), contact)
        if strength.depends_on_motion:
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
        if strength.depends_on_motion:
            forces, slip_speed = friction_on_nodes(*state, contact)
            derivatives *= strength.coefficient(slip_speed)
            derivatives += strength.coefficient_slope(slip_speed) * np.outer(forces, mean_derivatives)
        return -derivatives  # Exudyn takes those of the left-hand side

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
