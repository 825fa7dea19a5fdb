"""The multibody model of either system."""

from __future__ import annotations

from typing import Any

from exudyn_models.paper.models.disc_on_disc import build_disc_on_disc
from exudyn_models.paper.models.pin_on_disc import build_pin_on_disc
from exudyn_models.parts.ring_friction import AddFriction, add_ring_friction
from exudyn_models.solver.model import Model
from reference_model.systems import DiscOnDisc, FloatArray, System


def build(
    system: System,
    initial_state: FloatArray,
    *,
    regularisation: float,
    friction: AddFriction = add_ring_friction,
    axes_speed: float = 0.0,
) -> Model:
    """Build ``system`` in ``initial_state``, with the contact that ``friction`` adds between the discs.

    In axes that turn with ``axes_speed`` (rad/s), which ``initial_state`` refers to, the ground turns backwards, see
    ``supported_body``.
    """
    options: dict[str, Any] = {
        "regularisation": regularisation,
        "friction": friction,
        "axes_speed": axes_speed,
    }
    if isinstance(system, DiscOnDisc):
        return build_disc_on_disc(system, initial_state, **options)
    return build_pin_on_disc(system, initial_state, **options)
