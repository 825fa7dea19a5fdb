"""A massless connector over the nodes of *both* bodies, which applies the full reaction to both.

It is an ``ObjectGenericODE2``, which returns generalised forces on all coordinates of its nodes. A force F on the
disc comes with the force −F and the moment −d×F on a master at the distance d. Exudyn's marker connectors omit that
moment, which violates conservation of angular momentum for two free bodies.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import exudyn as exu
import exudyn.itemInterface
import numpy as np

from exudyn_models.forces.slip_kinematics import KINDS, ROTOR
from exudyn_models.forces.user_functions import ForceFunction, JacobianFunction

items: Any = exudyn.itemInterface  # its type hints do not fit its own calls


def add_connector(mbs: Any, nodes: Sequence[Any], force: ForceFunction, jacobian: JacobianFunction) -> Any:
    """Add a connector over ``nodes``; return its ``ObjectIndex``.

    ``force`` returns the forces on all their coordinates. ``jacobian`` returns the sum of the derivatives of the
    *negative* forces by coordinates and by velocities, each multiplied by the factor passed to it.
    """
    size = sum(len(mbs.GetNodeParameter(node, "referenceCoordinates")) for node in nodes)
    return mbs.AddObject(
        items.ObjectGenericODE2(
            nodeNumbers=list(nodes),
            massMatrix=np.zeros((size, size)),
            forceUserFunction=force,
            jacobianUserFunction=jacobian,
        )
    )


BODIES = ("RotationalMass1D", "RigidBody2D", "RigidBody")
"""Objects, by Exudyn's names, whose nodes may be those of ``KINDS``."""


def node_of(name: str, mbs: Any, node_or_body: Any, *, or_ground: bool = False) -> Any:
    """Return the ``NodeIndex`` of a body from its ``ObjectIndex``, None for a ground, and other values unchanged.

    Raises ``ValueError`` for any other object, and for a ground that is not allowed here, or not at the origin.
    """
    if type(node_or_body).__name__ != "ObjectIndex":
        return node_or_body
    try:
        body = mbs.GetObject(node_or_body)
    except exu.ExudynIndexError:
        count = mbs.systemData.NumberOfObjects()
        raise ValueError(
            f"{name} {int(node_or_body)} does not exist: this model has {count} objects"
        ) from None
    if or_ground and body["objectType"] == "Ground":
        if body["referencePosition"].any() or (body["referenceRotation"] != np.eye(3)).any():
            raise ValueError(
                f"{name} {int(node_or_body)} is an ObjectGround at {body['referencePosition'].tolist()}: it must be "
                "at the global origin with the global axes, because its axis is the global z-axis"
            )
        return None
    if body["objectType"] not in BODIES:
        raise ValueError(
            f"{name} {int(node_or_body)} is an Object{body['objectType']}: it must be a body with a node, which is "
            f"an {', an '.join(f'Object{body}' for body in BODIES)}"
        )
    return body["nodeNumber"]


def checked_kind(name: str, mbs: Any, node: Any, allowed: Sequence[int] = tuple(KINDS.values())) -> int:
    """Return the kind of a node, one of ``KINDS``.

    Raises ``ValueError`` if it is not ``allowed``, or if the node's body turns about another axis than a rotor must,
    or translates. A body that is added later is not checked.
    """
    try:
        kind = mbs.GetNode(node)["nodeType"]
    except exu.ExudynIndexError:
        count = mbs.systemData.NumberOfNodes()
        raise ValueError(f"{name} {int(node)} does not exist: this model has {count} nodes") from None
    except exu.ExudynTypeError:
        raise ValueError(
            f"{name} = {node!r} is of type {type(node).__name__}: it must be a NodeIndex or the "
            "ObjectIndex of a body"
        ) from None
    if KINDS.get(kind) in allowed:
        if KINDS[kind] == ROTOR:
            _check_axis(name, mbs, node)
        return KINDS[kind]
    names = [f"Node{key}" for key, value in KINDS.items() if value in allowed]
    raise ValueError(
        f"{name} {int(node)} is a Node{kind}: it must be a {' or '.join(', '.join(names).rsplit(', ', 1))}"
    )


def _check_axis(name: str, mbs: Any, node: Any) -> None:
    for item in range(mbs.systemData.NumberOfObjects()):
        body = mbs.GetObject(item)
        kind = body["objectType"]
        if kind not in ("RotationalMass1D", "Mass1D") or int(body["nodeNumber"]) != int(node):
            continue
        place, axis = body["referencePosition"], body["referenceRotation"][:, 2]
        if kind == "Mass1D" or place[:2].any() or (axis != [0.0, 0.0, 1.0]).any():
            raise ValueError(
                f"{name} {int(node)} is the Node1D of an Object{kind} at {place.tolist()} with the axis "
                f"{axis.tolist()}: it must be that of an ObjectRotationalMass1D about the global z-axis"
            )
