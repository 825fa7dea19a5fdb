"""Connectors between the nodes of two bodies, with the full reaction on both.

In general this is a massless ``ObjectGenericODE2``. A force F on the disc comes with −F and the moment −d×F on a
master at the distance d. Exudyn's marker connectors omit that moment and so do not conserve angular momentum.

Rotors on one axis have no such moment. Under a constant load they use ``ObjectConnectorCoordinateSpringDamperExt``
with the law of ``axial_pairs``, which takes a fraction of the time of a Python function.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from exudyn_models.forces.axial_pairs import constant_law
from exudyn_models.forces.user_functions import ForceFunction, JacobianFunction
from exudyn_models.solver.contacts import Contact, register
from exudyn_models.solver.items import coordinate_marker, items


def add_connector(
    mbs: Any, nodes: Sequence[Any], force: ForceFunction, jacobian: JacobianFunction, name: str = ""
) -> Any:
    """Add a connector between ``nodes``; return its ``ObjectIndex``.

    ``force`` returns the forces on all coordinates. ``jacobian`` returns the sum of the derivatives of the *negative*
    forces in coordinates and in velocities, each multiplied by the factor passed to it.
    """
    size = sum(len(mbs.GetNodeParameter(node, "referenceCoordinates")) for node in nodes)
    return mbs.AddObject(
        items.ObjectGenericODE2(
            name=name,
            nodeNumbers=list(nodes),
            massMatrix=np.zeros((size, size)),
            forceUserFunction=force,
            jacobianUserFunction=jacobian,
        )
    )


def add_friction_connector(mbs: Any, nodes: Sequence[Any], contact: Contact) -> Any:
    """Add and register the connector of a contact between ``nodes``; return its ``ObjectIndex``."""
    register(mbs, contact)
    if not contact.built_in:
        return add_connector(
            mbs, nodes, contact.functions["force"], contact.functions["jacobian"], contact.name
        )
    markers = rotor_markers(mbs, nodes)
    item = mbs.AddObject(
        items.ObjectConnectorCoordinateSpringDamperExt(
            name=contact.name, markerNumbers=markers, frictionProportionalZone=1.0
        )
    )
    renew_friction(mbs, item, contact)
    return item


def renew_friction(mbs: Any, item: Any, contact: Contact) -> None:
    """Let the connector ``item`` apply the present functions of a contact."""
    if not contact.built_in:
        for name, function in contact.functions.items():
            mbs.SetObjectParameter(item, f"{name}UserFunction", function)
        return
    law = constant_law(contact.kinds, contact.factors)
    resistance = 0 if law else _resistance(contact.functions["force"], len(contact.reference))
    mbs.SetObjectParameter(item, "springForceUserFunction", resistance)
    if law:
        moment, spin = law
        mbs.SetObjectParameter(item, "dynamicFrictionForce", moment)
        mbs.SetObjectParameter(item, "frictionProportionalZone", spin)


def _resistance(force: ForceFunction, size: int) -> Callable[..., float]:
    others = [0.0] * (size - 1)
    return lambda mbs, t, item, twist, spin, *_: -force(mbs, t, item, [*others, twist], [*others, spin])[-1]


def rotor_markers(mbs: Any, nodes: Sequence[Any]) -> list[Any]:
    """Add markers of the angles of two rotors, or of the ground and one rotor."""
    return [coordinate_marker(mbs, node) for node in ((None, *nodes) if len(nodes) == 1 else nodes)]
