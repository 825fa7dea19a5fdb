"""The multibody model of either system."""

from __future__ import annotations

from exudyn_models.disc_on_disc import build_disc_on_disc
from exudyn_models.pin_on_disc import build_pin_on_disc
from exudyn_models.ring_friction import AddFriction, add_ring_friction
from exudyn_models.supported_body import Model
from reference_model.systems import DiscOnDisc, FloatArray, System


def build(
    system: System,
    initial_state: FloatArray,
    *,
    regularisation: float,
    friction: AddFriction = add_ring_friction,
) -> Model:
    """Build ``system``, starting in ``initial_state``, with what ``friction`` adds between the discs."""
    if isinstance(system, DiscOnDisc):
        return build_disc_on_disc(system, initial_state, regularisation=regularisation, friction=friction)
    return build_pin_on_disc(system, initial_state, regularisation=regularisation, friction=friction)
