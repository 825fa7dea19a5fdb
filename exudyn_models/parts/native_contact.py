"""Friction by Exudyn's own sphere-triangle contact instead of a user function, as an independent check.

Spheres on the disc press on one triangle that turns with the master disc. Planar bodies keep their height, so the
normal force is constant. Exudyn's friction −μN·v/max(|v|, ε) of the touching points is the law of
``add_ring_friction`` for points.
"""

from __future__ import annotations

import cmath
import math
from typing import Any

import exudyn as exu

from exudyn_models.forces.laws.functions import checked_not_negative
from exudyn_models.forces.slip_kinematics import NO_MOUNTS, PLANAR, ROTOR
from exudyn_models.parts.mounts import checked_sides, nodes_and_kinds
from exudyn_models.parts.ring_friction import ContactPoints, checked_contact
from exudyn_models.solver.items import items
from reference_model.systems import positive_number

NORMAL_FORCE = 1.0
"""N of all points together, in N. Only the product μN matters, so μ is scaled to give it.

Rounding tilts the normal, so about 1e-15·N acts sideways. N is small where friction is large, as in the model of a
creeping disc.
"""


def add_native_friction(
    mbs: Any,
    master_node: Any,
    disc_node: Any,
    *,
    contact_radius: float | None = None,
    friction_coefficient: float,
    normal_load: float,
    regularisation: float,
    contact_points: ContactPoints | None = None,
    reach: float,
) -> list[Any]:
    """Add friction like ``add_ring_friction``, by one built-in contact per point; return their ``ObjectIndex``.

    The dimensions perpendicular to the plane equal the triangle's, because rounding tilts the normal by the ratio of
    size to penetration. The remaining rounding error is a slip of 1e-15·spin·``reach``.

    Parameters
    ----------
    mbs : exudyn MainSystem
        The model, not yet assembled, with both nodes and their bodies.
    master_node, disc_node : NodeIndex or ObjectIndex
        Master: a rotor, a planar body, or None for the ground. Disc: a planar body.
    contact_radius, regularisation : float
        R >= 0 in m, 0 for a pin; ε > 0 in m/s.
    friction_coefficient, normal_load : float
        μ >= 0, and N >= 0 in N of all points together.
    contact_points : int or sequence of (float, float, float)
        n >= 1 points on the circle, or places and shares of the load; a whole circle is not supported.
    reach : float
        Largest distance in m, > 0, of a point from the master's node; beyond it a point may leave the triangle.

    Raises
    ------
    ValueError
        If a number is out of range or a node is of an unsupported kind.

    """
    _, places, epsilon = checked_contact(regularisation, contact_radius, contact_points)
    if places is None:
        raise ValueError(
            "contact_points = None: Exudyn's built-in contact supports only points; pass their number, for example "
            "6, or a list of (x, y, share)"
        )
    coefficient = checked_not_negative("friction_coefficient", friction_coefficient, "")
    friction_force = coefficient * checked_not_negative("normal_load", normal_load, " N")
    reach = positive_number("reach", reach, "m")
    master, disc = _checked_nodes(mbs, master_node, disc_node)
    size = 2.0 * reach  # from the triangle's centre to a corner; the inscribed circle has half of it
    master_marker = _marker(mbs, master, 0j)
    contacts = []
    for x, y, share in places:
        arm = complex(x, y)
        data = _slip_data(mbs, size / 2.0, _initial_slip_speed(mbs, master, disc, arm))
        markers = [_marker(mbs, disc, arm), master_marker]
        contacts.append(_add_sphere(mbs, markers, data, size, friction_force, epsilon, share))
    return contacts


def _checked_nodes(mbs: Any, master_node: Any, disc_node: Any) -> tuple[Any, Any]:
    sides = checked_sides(mbs, master_node, disc_node, (ROTOR, PLANAR), (PLANAR,))
    if nodes_and_kinds(*sides)[1][2] != NO_MOUNTS:
        raise ValueError(
            f"master_node {master_node!r}, disc_node {disc_node!r}: Exudyn's built-in contact sits at the nodes, and "
            "a rotor or a ground must have the global z-axis; use add_ring_friction for markers and other axes"
        )
    master, disc = sides
    return master.node, disc.node


def _slip_data(mbs: Any, penetration: float, slip_speed: float) -> Any:
    """Add the data node of a contact; ``slip_speed`` (m/s) selects the first branch of the law."""
    return mbs.AddNode(
        items.NodeGenericData(
            initialCoordinates=[-penetration, slip_speed, 0.0, 0.0], numberOfDataCoordinates=4
        )
    )


def _add_sphere(
    mbs: Any, markers: list[Any], data: Any, size: float, friction_force: float, epsilon: float, share: float
) -> Any:
    penetration = size / 2.0
    height = penetration - size
    vectors: Any = exu.Vector3DList  # its type hint rejects valid lists
    return mbs.AddObject(
        items.ObjectContactSphereTriangle(
            markerNumbers=markers,
            nodeNumber=data,
            sphereRadius=size,
            trianglePoints=vectors([[*_plane(cmath.rect(size, math.tau * i / 3)), height] for i in range(3)]),
            includeEdges=0,
            dynamicFriction=friction_force / NORMAL_FORCE,
            frictionProportionalZone=epsilon,
            contactStiffness=NORMAL_FORCE * share / penetration,
        )
    )


def _plane(vector: complex) -> tuple[float, float]:
    return vector.real, vector.imag


def _marker(mbs: Any, node: Any, arm: complex) -> Any:
    """Add a marker at ``arm`` (m) of the body of ``node``, or of the ground."""
    if node is None:
        ground = mbs.AddObject(items.ObjectGround())
        return mbs.AddMarker(items.MarkerBodyRigid(bodyNumber=ground, localPosition=[*_plane(arm), 0.0]))
    numbers = range(mbs.systemData.NumberOfObjects())
    body = next(i for i in numbers if int(mbs.GetObject(i).get("nodeNumber", -1)) == int(node))
    return mbs.AddMarker(items.MarkerBodyRigid(bodyNumber=body, localPosition=[*_plane(arm), 0.0]))


def _initial_slip_speed(mbs: Any, master_node: Any, disc_node: Any, arm: complex) -> float:
    master, _, master_velocity, master_spin = _initial_motion(mbs, master_node)
    disc, angle, disc_velocity, disc_spin = _initial_motion(mbs, disc_node)
    arm *= cmath.exp(1j * angle)
    velocity = disc_velocity + 1j * disc_spin * arm
    return abs(velocity - master_velocity - 1j * master_spin * (disc + arm - master))


def _initial_motion(mbs: Any, node: Any) -> tuple[complex, float, complex, float]:
    """Return position, angle, velocity and spin of a node or of the ground."""
    if node is None:
        return 0j, 0.0, 0j, 0.0
    reference, initial, rates = (
        mbs.GetNodeParameter(node, name).tolist()
        for name in ("referenceCoordinates", "initialCoordinates", "initialVelocities")
    )
    *place, angle = (a + b for a, b in zip(reference, initial, strict=True))
    *velocity, spin = rates
    return (complex(*place), angle, complex(*velocity), spin)
