"""The pin on the rotating disc (Fig. 2, eq. 1) as a multibody model."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import exudyn as exu
import exudyn.itemInterface

from exudyn_models.ring_friction import add_ring_friction
from reference_model.systems import FloatArray, PinOnDisc

items: Any = exudyn.itemInterface  # its type hints do not fit its own calls

MASTER_INERTIA = 1e30
"""kg m². The master disc's speed is prescribed: it is a body that no torque of the contact can slow down.

With this inertia a torque of 1 N m changes ω by 1e-30 rad/s in a second, so that ω stays what it is to the last bit.
Constraints would do the same for implicit solvers only; explicit ones ignore them without a word.
"""


@dataclass(frozen=True)
class PinModel:
    """The assembled model: coordinates are the master's angle, then x, y and the angle of the pin's body.

    ``container`` owns ``mbs`` and must live as long. The sensors store x, y, angle of the pin and their first and
    second time derivatives at every step.
    """

    container: Any
    mbs: Any
    sensors: tuple[Any, Any, Any]


def build_pin_on_disc(pin: PinOnDisc, initial_state: FloatArray, *, regularisation: float) -> PinModel:
    """Build the pin on the disc, starting in ``initial_state`` (x, y in m, vx, vy in m/s).

    A rigid body on springs and dampers to a support at (X0, 0), a master disc that turns about (0, 0) with ω, and
    ring friction of one point at radius 0 between them. Without friction there is no connector.
    """
    container = exu.SystemContainer()
    mbs = container.AddSystem()
    master_node = mbs.AddNode(
        items.Node1D(referenceCoordinates=[0.0], initialCoordinates=[0.0], initialVelocities=[pin.disc_speed])
    )
    mbs.AddObject(items.ObjectRotationalMass1D(nodeNumber=master_node, inertia=MASTER_INERTIA))
    x, y, vx, vy = initial_state.tolist()
    pin_node = mbs.AddNode(
        items.NodeRigidBody2D(
            referenceCoordinates=[0.0, 0.0, 0.0],
            initialCoordinates=[x, y, 0.0],
            initialVelocities=[vx, vy, 0.0],
        )
    )
    # Nothing turns the pin's body, so that its moment of inertia is any number.
    body = mbs.AddObject(items.ObjectRigidBody2D(nodeNumber=pin_node, mass=pin.mass, inertia=pin.mass))
    support = mbs.AddObject(items.ObjectGround(referencePosition=[pin.offset, 0.0, 0.0]))
    mbs.AddObject(
        items.CartesianSpringDamper(
            markerNumbers=[
                mbs.AddMarker(items.MarkerBodyPosition(bodyNumber=support)),
                mbs.AddMarker(items.MarkerBodyPosition(bodyNumber=body)),
            ],
            stiffness=[pin.stiffness, pin.stiffness, 0.0],
            damping=[pin.damping, pin.damping, 0.0],
        )
    )
    if pin.friction_force > 0.0:
        add_ring_friction(
            mbs,
            master_node,
            pin_node,
            friction_force=pin.friction_force,
            regularisation=regularisation,
        )
    variables = exu.OutputVariableType
    sensors = tuple(
        mbs.AddSensor(
            items.SensorNode(
                nodeNumber=pin_node, outputVariableType=variable, storeInternal=True, writeToFile=False
            )
        )
        for variable in (variables.Coordinates, variables.Coordinates_t, variables.Coordinates_tt)
    )
    mbs.Assemble()
    return PinModel(container, mbs, (sensors[0], sensors[1], sensors[2]))
