"""A massless connector over the nodes of *both* bodies, which applies the full reaction to both.

It is an ``ObjectGenericODE2``, which returns generalised forces on all coordinates of its nodes. A force F on the
disc comes with the force −F and the moment −d×F on a master at the distance d. Exudyn's marker connectors omit that
moment, which violates conservation of angular momentum for two free bodies.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import exudyn.itemInterface
import numpy as np

from exudyn_models.forces.user_functions import ForceFunction, JacobianFunction

items: Any = exudyn.itemInterface  # its type hints do not fit its own calls


def add_connector(mbs: Any, nodes: Sequence[Any], force: ForceFunction, jacobian: JacobianFunction) -> Any:
    """Add a connector over ``nodes``; return its ``ObjectIndex``.

    ``force`` returns the forces on all coordinates of the nodes. ``jacobian`` returns the sum of the derivatives of
    the *negative* forces with respect to coordinates and velocities, each multiplied by the factor passed to it.
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
