"""The pin (Fig. 2, eq. 1) and the disc (Fig. 7, eq. 19 to 21) as multibody models."""

from typing import Any

import exudyn as exu
import numpy as np

from exudyn_models.parts.radial_support import add_radial_support
from exudyn_models.parts.ring_friction import AddFriction, add_ring_friction
from exudyn_models.solver.items import add_rotor, coordinate_marker, items, node_sensor
from exudyn_models.solver.solver_run import Model
from reference_model.systems import (
    DiscOnDisc,
    FloatArray,
    System,
    checked_state,
    finite_number,
    require_callable,
)

MASTER_INERTIA = 1e30
"""Inertia in kg m² of the master disc, a body whose speed no contact torque can change.

A torque of 1 N m changes ω by 1e-30 rad/s per second. Explicit solvers would silently ignore a constraint.
"""


def build_model(
    system: System,
    initial_state: FloatArray,
    *,
    regularisation: float,
    friction: AddFriction = add_ring_friction,
    axes_speed: float = 0.0,
) -> Model:
    """Build ``system`` in ``initial_state``, shape (4,) or (6,), with the contact that ``friction`` adds.

    A body on springs and dampers to a support at (X0, 0) touches a master disc that turns about (0, 0) with ω. A disc
    has a torsional damper to its shaft. ``initial_state`` refers to axes that turn with ``axes_speed`` (rad/s); the
    ground turns backwards in them.
    """
    initial_state = checked_state(system, initial_state)
    axes_speed = finite_number("axes_speed", axes_speed)
    require_callable("friction", friction)
    container = exu.SystemContainer()
    mbs = container.AddSystem()
    master = add_rotor(mbs, MASTER_INERTIA, system.disc_speed - axes_speed)
    body = _add_supported_body(mbs, system, initial_state, axes_speed)
    contact: dict[str, Any] = {"contact_radius": 0.0}
    if isinstance(system, DiscOnDisc):
        contact = {"contact_radius": system.contact_radius, "contact_points": system.contact_points}
        if system.shaft_damping > 0.0:
            _add_shaft(mbs, body, system, axes_speed)
    if system.friction_force > 0.0:
        friction(
            mbs,
            master,
            body,
            friction_coefficient=1.0,
            normal_load=system.friction_force,
            regularisation=regularisation,
            **contact,
        )
    variables = exu.OutputVariableType
    position, velocity, acceleration = (
        node_sensor(mbs, body, variable)
        for variable in (variables.Coordinates, variables.Coordinates_t, variables.Coordinates_tt)
    )
    sensors = position, velocity, acceleration
    mbs.Assemble()
    return Model(container, mbs, mbs.GetNodeODE2Index(body), system.state_size // 2, sensors)


def _add_supported_body(mbs: Any, system: System, initial_state: FloatArray, axes_speed: float) -> Any:
    """Add a planar body on springs and dampers to a support at (X0, 0), which turns backwards in turning axes."""
    position, velocity = initial_state.reshape(2, -1).tolist()
    turn = [0.0] * (3 - len(position))
    node = mbs.AddNode(
        items.NodeRigidBody2D(
            referenceCoordinates=[0.0, 0.0, 0.0],
            initialCoordinates=position + turn,
            initialVelocities=velocity + turn,
        )
    )
    # The inertia of a pin is arbitrary, because nothing turns it.
    inertia = system.polar_inertia if isinstance(system, DiscOnDisc) else system.mass
    mbs.AddObject(items.ObjectRigidBody2D(nodeNumber=node, mass=system.mass, inertia=inertia))
    add_radial_support(
        mbs,
        None if axes_speed == 0.0 else add_rotor(mbs, MASTER_INERTIA, -axes_speed),
        node,
        stiffness=system.stiffness,
        damping=system.damping,
        hardening=system.hardening,
        stop_gap=system.stop_gap,
        stop_stiffness=system.stop_stiffness,
        offset=(system.offset, 0.0),
    )
    if axes_speed != 0.0:
        _add_inertia_forces(mbs, node, system.mass, axes_speed)
    return node


def _add_inertia_forces(mbs: Any, node: Any, mass: float, speed: float) -> None:
    """Add the Coriolis force −2m·ω×v and the centrifugal force mω²·r, for axes that turn with ``speed``."""
    coriolis = 2.0 * mass * speed
    mbs.AddObject(
        items.ObjectGenericODE2(
            nodeNumbers=[node],
            massMatrix=np.zeros((3, 3)),
            stiffnessMatrix=np.diag([-mass * speed**2, -mass * speed**2, 0.0]),
            dampingMatrix=np.array([[0.0, -coriolis, 0.0], [coriolis, 0.0, 0.0], [0.0, 0.0, 0.0]]),
        )
    )


def _add_shaft(mbs: Any, node: Any, disc: DiscOnDisc, axes_speed: float) -> None:
    """Add the torsional damper between ``disc`` and a shaft that turns at Ω, with the moment b(Ω − φ̇)."""
    mbs.AddObject(
        items.ObjectConnectorCoordinateSpringDamperExt(
            markerNumbers=[coordinate_marker(mbs, None), coordinate_marker(mbs, node, 2)],
            damping=disc.shaft_damping,
            velocityOffset=disc.shaft_speed - axes_speed,
        )
    )
