"""The friction disc on the master disc (Fig. 7, eq. 19 to 21) as a multibody model."""

from __future__ import annotations

from typing import Any

import exudyn as exu
import exudyn.itemInterface

from exudyn_models.paper.models.supported_body import add_master, add_supported_body, assembled
from exudyn_models.parts.ring_friction import AddFriction, add_ring_friction
from exudyn_models.solver.model import Model
from reference_model.systems import DiscOnDisc, FloatArray

items: Any = exudyn.itemInterface  # its type hints do not fit its own calls


def build_disc_on_disc(
    disc: DiscOnDisc,
    initial_state: FloatArray,
    *,
    regularisation: float,
    friction: AddFriction = add_ring_friction,
    axes_speed: float = 0.0,
) -> Model:
    """Build the disc in ``initial_state`` (x, y in m, angle in rad, vx, vy in m/s, spin in rad/s).

    The model consists of a rigid body on springs and dampers to a support at (X0, 0), a torsional damper to the
    shaft, a master disc that turns about (0, 0) with ω, and ring friction between the two discs. Connectors with zero
    friction or damping are omitted. The model is described in axes that turn with ``axes_speed`` (rad/s).
    """
    container = exu.SystemContainer()
    mbs = container.AddSystem()
    master = add_master(mbs, disc.disc_speed - axes_speed)
    body = add_supported_body(mbs, disc, initial_state, disc.polar_inertia, axes_speed)
    if disc.shaft_damping > 0.0:
        add_shaft(mbs, body, disc, axes_speed)
    if disc.friction_force > 0.0:
        friction(
            mbs,
            master,
            body,
            contact_radius=disc.contact_radius,
            friction_coefficient=1.0,
            normal_load=disc.friction_force,
            regularisation=regularisation,
            contact_points=disc.contact_points,
        )
    return assembled(container, mbs, body, disc)


def add_shaft(mbs: Any, node: Any, disc: DiscOnDisc, axes_speed: float = 0.0) -> None:
    """Add the torsional damper between a node of ``disc`` and a shaft that turns at Ω, with the moment b(Ω − φ̇).

    The shaft is the ground's coordinate, and Ω, relative to the axes, is the damper's velocity offset.
    """
    ground = mbs.AddNode(items.NodePointGround())
    mbs.AddObject(
        items.ObjectConnectorCoordinateSpringDamperExt(
            markerNumbers=[
                mbs.AddMarker(items.MarkerNodeCoordinate(nodeNumber=ground, coordinate=0)),
                mbs.AddMarker(items.MarkerNodeCoordinate(nodeNumber=node, coordinate=2)),
            ],
            damping=disc.shaft_damping,
            velocityOffset=disc.shaft_speed - axes_speed,
        )
    )
