"""The paper's systems as multibody models in Exudyn.

For models of your own: ``ring_friction`` with ``friction_laws`` and ``friction_sensors``, and ``native_contact``. The
paper's systems: ``pin_on_disc`` and ``disc_on_disc`` on a ``supported_body``, chosen by ``models``. ``simulate`` goes
through turns of ``slip_and_creep`` and reads ``phases`` from the motion; ``linearisation`` gives eigenvalues.
"""

from exudyn_models.disc_on_disc import build_disc_on_disc
from exudyn_models.friction_sensors import RingFriction
from exudyn_models.linearisation import eigenvalues
from exudyn_models.native_contact import add_native_friction, simulate_with_native_contact
from exudyn_models.pin_on_disc import build_pin_on_disc
from exudyn_models.ring_friction import add_ring_friction
from exudyn_models.simulate import simulate, simulate_fixed_step

__all__ = [
    "RingFriction",
    "add_native_friction",
    "add_ring_friction",
    "build_disc_on_disc",
    "build_pin_on_disc",
    "eigenvalues",
    "simulate",
    "simulate_fixed_step",
    "simulate_with_native_contact",
]
