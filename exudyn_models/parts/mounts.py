"""Nodes of the two bodies of a contact, and its place and axes on them.

A body is given by its node, its object, or a marker on it, which places the contact anywhere on the body. They become
``Kinds`` and ``Mounts`` for compiled code. If frames make no difference, there are no mounts, so closed forms apply.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import exudyn as exu
import numpy as np

from exudyn_models.forces.laws.tables import kept
from exudyn_models.forces.slip_kinematics import (
    GROUND,
    KINDS,
    NO_MOUNTS,
    PLANAR,
    POINTS,
    ROTOR,
    SPATIAL,
    TRANSLATIONS,
    Kinds,
    frame,
)
from reference_model.systems import FloatArray, finite_numbers, require_kind, shown

indices: Any = exu  # the index types are missing from its type hints

ALL = tuple(KINDS.values())

BODIES = ("RotationalMass1D", "RigidBody2D", "RigidBody", "MassPoint2D", "MassPoint")
"""Objects, by Exudyn's names, whose nodes may have one of the ``KINDS``."""

FLAT = (GROUND, ROTOR, PLANAR)
"""Kinds whose axis of rotation is fixed."""

SAME = 1e-12
"""Largest difference in m, or of unit vectors, between lines that count as one axis."""

PARALLEL = 1e-9
"""Largest sine of the angle between axes that count as parallel, and error of a rotation matrix."""


@dataclass(frozen=True, eq=False)
class Side:
    """One body of a contact, by the ``name`` of its argument; ``node`` is None for the ground.

    ``start``, shape (3,), and the columns of ``axes``, shape (3, 3), are the fixed frame of a rotor or the ground;
    ``place`` and ``rotation`` are likewise the frame of the contact on the body.
    """

    name: str
    node: Any
    kind: int
    start: FloatArray
    axes: FloatArray
    place: FloatArray
    rotation: FloatArray

    @property
    def centre(self) -> FloatArray:
        """Position of the contact on a rotor at zero angle, or on the ground."""
        return np.asarray(self.start + self.axes @ self.place)

    @property
    def numbers(self) -> list[float]:
        """``Mounts`` of this side."""
        frames = self.start, self.axes.T, self.place, self.rotation.T
        return [float(number) for array in frames for number in array.ravel()]

    @property
    def is_at_node(self) -> bool:
        """True if the contact has place and axes of the node, and a rotor or the ground has the global z-axis."""
        turned = (self.axes != np.eye(3)).any() or (self.rotation != np.eye(3)).any()
        return not (turned or self.start[:2].any() or self.place.any())


def checked_sides(
    mbs: Any,
    master_node: Any,
    disc_node: Any,
    masters: Sequence[int] = ALL,
    discs: Sequence[int] = ALL,
    rotations: Sequence[Any] = (None, None),
    master: str = "master",
) -> tuple[Side, Side]:
    """Return both sides of a contact; only the first, called ``master``, may be the ground.

    Raises ``ValueError`` if a node is not allowed, both are the same, or one of the ``rotations`` is not a rotation
    matrix.
    """
    require_kind("mbs", mbs, exu.MainSystem)
    disc = _side(mbs, "disc", disc_node, discs, rotations[1])
    other = _side(mbs, master, master_node, masters, rotations[0], or_ground=True)
    if other.node is not None and int(other.node) == int(disc.node):
        raise ValueError(
            f"disc_node {int(disc.node)} is also the {other.name}: a contact is between two bodies"
        )
    return other, disc


def nodes_and_kinds(master: Side, disc: Side) -> tuple[tuple[Any, ...], Kinds]:
    """Return the nodes, without the ground, and the kinds and mounts for compiled code."""
    nodes = (disc.node,) if master.node is None else (master.node, disc.node)
    # The place of a rotor along its axis matters only to a master that tilts.
    at_nodes = master.is_at_node and disc.is_at_node and (master.kind in FLAT or disc.start[2] == 0.0)
    plain = at_nodes or _share_an_axis(master, disc)
    return nodes, (master.kind, disc.kind, NO_MOUNTS if plain else kept((*master.numbers, *disc.numbers)))


def kinds_at(mbs: Any, master: Side, disc: Side, places: FloatArray) -> list[Kinds]:
    """Return the kinds and mounts of pins at ``places`` on the disc: x and y in m first, shape (n, 2 or more).

    They lie in the plane of contact, with x along the axis of the disc that defines the angle of the contact.
    """
    axis = _axes_and_spin(mbs, master)[0] @ master.rotation[:, 2] @ _axes_and_spin(mbs, disc)[0]
    x, y, _ = disc.rotation.T
    along = x if (x @ axis) ** 2 < 0.5 else y  # as in ``slip_and_place``
    along = along - (along @ axis) * axis
    along /= np.linalg.norm(along)
    arms = places[:, :1] * along + places[:, 1:2] * np.cross(axis, along)
    return [nodes_and_kinds(master, replace(disc, place=disc.place + arm))[1] for arm in arms]


def _share_an_axis(master: Side, disc: Side) -> bool:
    if disc.kind != ROTOR or master.kind not in (ROTOR, GROUND):
        return False
    axis = (master.axes @ master.rotation)[:, 2]
    turning = [side for side in (master, disc) if side.kind == ROTOR]
    points = [master.centre, *[point for side in turning for point in (side.start, side.centre)]]
    differences = [side.axes[:, 2] - axis for side in turning]
    differences += [np.cross(point - points[0], axis) for point in points[1:]]
    return bool(np.abs(differences).max() < SAME)


def check_axes(mbs: Any, master: Side, disc: Side) -> None:
    """Raise ``ValueError`` if a body turns across the contact's axis, so friction would not resist its spin.

    Fixed axes must be parallel to it; others may deviate by 45°, as may the spin of a body in space relative to the
    other body at the start.
    """
    fixed = master.kind in FLAT and disc.kind in FLAT
    axis = _axes_and_spin(mbs, master)[0] @ master.rotation[:, 2]
    for side, other in ((master, disc), (disc, master)):
        if side.kind in POINTS:
            raise ValueError(f"{side.name} {int(side.node)} is a point: contact_radius must be 0 on a point")
        if side.kind == GROUND:
            continue
        own = spin = _axes_and_spin(mbs, side)[1]
        if side.kind in SPATIAL:
            spin = own - _initial_spin(mbs, other)
        allowed = max(
            (PARALLEL if fixed else 1.0) * abs(float(axis @ spin)), PARALLEL * float(np.linalg.norm(own))
        )
        if float(np.linalg.norm(np.cross(axis, spin))) > allowed:
            turns = "initially spins" if side.kind in SPATIAL else "turns"
            raise ValueError(
                f"{side.name} {int(side.node)} {turns} about {_shown(spin)}: it must turn about the axis of the "
                f"contact, {_shown(axis)}, relative to the other body; it is the z-axis of the master's body or "
                "of the ground, turned by master_rotation"
            )


def _axes_and_spin(mbs: Any, side: Side) -> tuple[FloatArray, FloatArray]:
    """Return the initial axes of a body as columns, and its angular velocity (of any length if the axis is fixed)."""
    if side.kind in FLAT:
        return side.axes, side.axes[:, 2]
    entry = mbs.GetNode(side.node)
    rates = entry["initialVelocities"][TRANSLATIONS[side.kind] :]
    _, axes, turning = frame(side.kind, entry["referenceCoordinates"] + entry["initialCoordinates"], 0)
    return np.array(axes).T, np.array(turning[: len(rates)]).T @ rates


def _initial_spin(mbs: Any, side: Side) -> FloatArray:
    """Return the initial angular velocity in rad/s."""
    if side.kind == GROUND:
        return np.zeros(3)
    spin = _axes_and_spin(mbs, side)[1]
    rate = mbs.GetNode(side.node)["initialVelocities"][-1] if side.kind in FLAT else 1.0
    return np.asarray(rate * spin)


def _shown(vector: FloatArray) -> list[float]:
    return [float(number) for number in vector.round(6) + 0.0]


def _side(
    mbs: Any, name: str, given: Any, allowed: Sequence[int], rotation: Any, *, or_ground: bool = False
) -> Side:
    argument, place, turned = f"{name}_node", np.zeros(3), _checked_rotation(f"{name}_rotation", rotation)
    if type(given).__name__ == "MarkerIndex":
        given, place = _marked(argument, mbs, given)
    body = None
    if type(given).__name__ == "ObjectIndex":
        body = _body(argument, mbs, given, or_ground)
        given = body.get("nodeNumber")
    if given is None and or_ground:
        start, axes = _frame_of(body) if body else (np.zeros(3), np.eye(3))
        return Side(argument, None, GROUND, start, axes, place, turned)
    kind = _checked_kind(argument, mbs, given, allowed)
    start, axes = np.zeros(3), np.eye(3)
    if kind == ROTOR:
        start, axes = _frame_of(body) if body else _frame_of_rotor(argument, mbs, given)
    return Side(argument, given, kind, start, axes, place, turned)


def _checked_rotation(name: str, rotation: Any) -> FloatArray:
    if rotation is None:
        return np.eye(3)
    matrix = finite_numbers(name, rotation)
    if (
        matrix.shape == (3, 3)
        and np.abs(matrix @ matrix.T - np.eye(3)).max() < PARALLEL
        and np.linalg.det(matrix) > 0.0
    ):
        return matrix
    raise ValueError(f"{name} = {shown(rotation)}: it must be a rotation matrix of shape (3, 3)")


def _marked(name: str, mbs: Any, index: Any) -> tuple[Any, FloatArray]:
    count = mbs.systemData.NumberOfMarkers()
    if not 0 <= int(index) < count:
        raise ValueError(f"{name} {int(index)} does not exist: this model has {count} markers")
    marker = mbs.GetMarker(index)
    if marker["markerType"] == "BodyRigid":
        return indices.ObjectIndex(int(marker["bodyNumber"])), np.array(marker["localPosition"])
    if marker["markerType"] == "NodeRigid":
        return indices.NodeIndex(int(marker["nodeNumber"])), np.zeros(3)
    raise ValueError(
        f"{name} {int(index)} is a Marker{marker['markerType']}: it must be a MarkerBodyRigid or a MarkerNodeRigid"
    )


def _body(name: str, mbs: Any, index: Any, or_ground: bool) -> Any:
    try:
        body = mbs.GetObject(index)
    except exu.ExudynIndexError:
        count = mbs.systemData.NumberOfObjects()
        raise ValueError(f"{name} {int(index)} does not exist: this model has {count} objects") from None
    if body["objectType"] not in BODIES and not (or_ground and body["objectType"] == "Ground"):
        raise ValueError(
            f"{name} {int(index)} is an Object{body['objectType']}: it must be a body with a node, which is "
            f"an {', an '.join(f'Object{body}' for body in BODIES)}"
        )
    return body


def _frame_of(body: Any) -> tuple[FloatArray, FloatArray]:
    return np.array(body["referencePosition"]), np.array(body["referenceRotation"])


def _frame_of_rotor(name: str, mbs: Any, node: Any) -> tuple[FloatArray, FloatArray]:
    """Return the fixed frame of the bodies of a ``Node1D``, or the global frame if it has none yet."""
    frames = []
    for item in range(mbs.systemData.NumberOfObjects()):
        body = mbs.GetObject(item)
        if body["objectType"] not in ("RotationalMass1D", "Mass1D") or int(body["nodeNumber"]) != int(node):
            continue
        if body["objectType"] == "Mass1D":
            raise ValueError(
                f"{name} {int(node)} is the Node1D of an ObjectMass1D, which translates: it must be that of an "
                "ObjectRotationalMass1D"
            )
        frames.append(_frame_of(body))
    if not frames:
        return np.zeros(3), np.eye(3)
    start, axes = frames[0]
    axis = axes[:, 2]
    for place, others in frames[1:]:
        if max(np.abs(others[:, 2] - axis).max(), np.abs(np.cross(place - start, axis)).max()) > SAME:
            raise ValueError(
                f"{name} {int(node)} is the Node1D of bodies on different axes: pass the ObjectIndex of one of them"
            )
    return start, axes


def _checked_kind(name: str, mbs: Any, node: Any, allowed: Sequence[int]) -> int:
    try:
        kind = mbs.GetNode(None if isinstance(node, bool) else node)["nodeType"]
    except exu.ExudynIndexError:
        count = mbs.systemData.NumberOfNodes()
        raise ValueError(f"{name} {int(node)} does not exist: this model has {count} nodes") from None
    except exu.ExudynTypeError:
        raise ValueError(
            f"{name} = {node!r} is of type {type(node).__name__}: it must be a NodeIndex, the ObjectIndex of a body "
            "or the MarkerIndex of a rigid marker"
        ) from None
    if KINDS.get(kind) in allowed:
        return KINDS[kind]
    names = [f"Node{key}" for key, value in KINDS.items() if value in allowed]
    raise ValueError(
        f"{name} {int(node)} is a Node{kind}: it must be a {' or '.join(', '.join(names).rsplit(', ', 1))}"
    )
