"""The pin on the rotating disc (Fig. 2, eq. 1) as a multibody model."""

from __future__ import annotations

import exudyn as exu

from exudyn_models.paper.models.supported_body import add_master, add_supported_body, assembled
from exudyn_models.parts.ring_friction import AddFriction, add_ring_friction
from exudyn_models.solver.model import Model
from reference_model.systems import FloatArray, PinOnDisc


def build_pin_on_disc(
    pin: PinOnDisc,
    initial_state: FloatArray,
    *,
    regularisation: float,
    friction: AddFriction = add_ring_friction,
    axes_speed: float = 0.0,
) -> Model:
    """Build the pin on the disc in ``initial_state`` (x, y in m, vx, vy in m/s).

    The model consists of a rigid body on springs and dampers to a support at (X0, 0), a master disc that turns about
    (0, 0) with ω, and ring friction of one point at radius 0 between them, unless friction is zero. It is described
    in axes that turn with ``axes_speed`` (rad/s).
    """
    container = exu.SystemContainer()
    mbs = container.AddSystem()
    master = add_master(mbs, pin.disc_speed - axes_speed)
    # The moment of inertia is arbitrary, because nothing turns the pin's body.
    body = add_supported_body(mbs, pin, initial_state, pin.mass, axes_speed)
    if pin.friction_force > 0.0:
        friction(
            mbs,
            master,
            body,
            contact_radius=0.0,
            friction_coefficient=1.0,
            normal_load=pin.friction_force,
            regularisation=regularisation,
        )
    return assembled(container, mbs, body, pin)
