"""Common parts of the models of pin and friction disc: master disc, supported body, and sensors."""

from __future__ import annotations

from typing import Any

import exudyn as exu
import exudyn.itemInterface
import numpy as np

from exudyn_models.parts.radial_support import add_radial_support
from exudyn_models.solver.model import IN_MEMORY, Model
from reference_model.systems import FloatArray, System

items: Any = exudyn.itemInterface  # its type hints do not fit its own calls

MASTER_INERTIA = 1e30
"""Inertia in kg m² of the master disc, a body whose speed no contact torque can change.

A torque of 1 N m changes ω by 1e-30 rad/s per second, so ω stays constant to the last bit. A constraint would work
with implicit solvers only; explicit ones silently ignore it.
"""


def add_master(mbs: Any, speed: float) -> Any:
    """Add the master disc, which always turns about (0, 0) with ``speed`` (rad/s); return its ``NodeIndex``."""
    node = mbs.AddNode(
        items.Node1D(referenceCoordinates=[0.0], initialCoordinates=[0.0], initialVelocities=[speed])
    )
    mbs.AddObject(items.ObjectRotationalMass1D(nodeNumber=node, inertia=MASTER_INERTIA))
    return node


def add_supported_body(
    mbs: Any, system: System, initial_state: FloatArray, polar_inertia: float, axes_speed: float = 0.0
) -> Any:
    """Add a planar body on springs and dampers to a support at (X0, 0); return its ``NodeIndex``.

    ``initial_state`` is a state of ``system``; a pin's body starts at the angle 0 without spin. In axes that turn
    with ``axes_speed`` (rad/s) the ground with its support is a body that turns backwards.
    """
    position, velocity = initial_state.reshape(2, -1).tolist()
    turn = [0.0] * (3 - len(position))
    node = mbs.AddNode(
        items.NodeRigidBody2D(
            referenceCoordinates=[0.0, 0.0, 0.0],
            initialCoordinates=position + turn,
            initialVelocities=velocity + turn,
        )
    )
    mbs.AddObject(items.ObjectRigidBody2D(nodeNumber=node, mass=system.mass, inertia=polar_inertia))
    add_radial_support(
        mbs,
        None if axes_speed == 0.0 else add_master(mbs, -axes_speed),
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
    """Add the Coriolis force −2m·ω×v and the centrifugal force mω²·r on a body, for axes that turn with ``speed``."""
    coriolis = 2.0 * mass * speed
    mbs.AddObject(
        items.ObjectGenericODE2(
            nodeNumbers=[node],
            massMatrix=np.zeros((3, 3)),
            stiffnessMatrix=np.diag([-mass * speed**2, -mass * speed**2, 0.0]),
            dampingMatrix=np.array([[0.0, -coriolis, 0.0], [coriolis, 0.0, 0.0], [0.0, 0.0, 0.0]]),
        )
    )


def assembled(container: Any, mbs: Any, node: Any, system: System) -> Model:
    """Assemble ``mbs`` with sensors for the motion of ``node`` as a state of ``system``."""
    variables = exu.OutputVariableType
    position, velocity, acceleration = (
        mbs.AddSensor(items.SensorNode(nodeNumber=node, outputVariableType=variable, **IN_MEMORY))
        for variable in (variables.Coordinates, variables.Coordinates_t, variables.Coordinates_tt)
    )
    mbs.Assemble()
    return Model(
        container,
        mbs,
        mbs.GetNodeODE2Index(node),
        system.state_size // 2,
        (position, velocity, acceleration),
    )
