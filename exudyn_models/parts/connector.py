"""Connectors between the nodes of two bodies, with the full reaction on both.

In general this is a massless ``ObjectGenericODE2``. A force F on the disc comes with −F and the moment −d×F on a
master at the distance d. Exudyn's marker connectors omit that moment and so do not conserve angular momentum.

Rotors on one axis have no such moment. Under a constant load they use ``ObjectConnectorCoordinateSpringDamperExt``
with the law of ``axial_pairs``, which takes a fraction of the time of a Python function. Under a load of time, it is
``ObjectConnectorCoordinateSpringDamper``, whose user function costs less than half.
"""

from collections.abc import Sequence
from typing import Any

import numpy as np

from exudyn_models.forces.axial_pairs import constant_law, resistance_on_axis
from exudyn_models.forces.user_functions import ForceFunction, JacobianFunction
from exudyn_models.solver.contacts import Contact, register
from exudyn_models.solver.items import coordinate_marker, items

BUILT_IN = "ConnectorCoordinateSpringDamperExt"
"""Exudyn's connector with the law of constant friction."""


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
    options = {"name": contact.name, "markerNumbers": rotor_markers(mbs, nodes)}
    item = mbs.AddObject(
        items.ObjectConnectorCoordinateSpringDamperExt(frictionProportionalZone=1.0, **options)
        if constant_law(contact.kinds, contact.factors)
        else items.ObjectConnectorCoordinateSpringDamper(**options)
    )
    renew_friction(mbs, item, contact)
    return item


def renew_friction(mbs: Any, item: Any, contact: Contact) -> None:
    """Let the connector ``item`` apply the present functions of a contact."""
    if not contact.built_in:
        for name, function in contact.functions.items():
            mbs.SetObjectParameter(item, f"{name}UserFunction", function)
        return
    law, resistance = constant_law(contact.kinds, contact.factors), resistance_on_axis(contact.factors)
    if mbs.GetObject(item)["objectType"] != BUILT_IN:
        mbs.SetObjectParameter(item, "springForceUserFunction", resistance)
    elif law is None:
        mbs.SetObjectParameter(item, "springForceUserFunction", lambda *arguments: resistance(*arguments[:8]))
    else:
        mbs.SetObjectParameter(item, "springForceUserFunction", 0)
        mbs.SetObjectParameter(item, "dynamicFrictionForce", law[0])
        mbs.SetObjectParameter(item, "frictionProportionalZone", law[1])


def rotor_markers(mbs: Any, nodes: Sequence[Any]) -> list[Any]:
    """Add markers of the angles of two rotors, or of the ground and one rotor."""
    return [coordinate_marker(mbs, node) for node in ((None, *nodes) if len(nodes) == 1 else nodes)]
