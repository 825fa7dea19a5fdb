"""The paper's systems as multibody models in Exudyn.

For models of your own: ``ring_friction`` with its ``friction_sensors``, ``radial_support``, ``energy_balance``,
``step_limit`` and ``native_contact``; ``drivetrain`` is made of them, and ``drivetrain_picture`` draws it. The
paper's systems: ``pin_on_disc`` and ``disc_on_disc`` on a ``supported_body``, chosen by ``models``. ``simulate`` goes
through turns of ``slip_and_creep`` and reads ``phases`` from the motion; ``linearisation`` gives eigenvalues.
"""

from exudyn_models.drivetrain.model import (
    PASSENGER_CAR,
    Drivetrain,
    DrivetrainModel,
    build_drivetrain,
    four_cylinder,
)
from exudyn_models.paper.linearisation import eigenvalues
from exudyn_models.paper.models.disc_on_disc import build_disc_on_disc
from exudyn_models.paper.models.pin_on_disc import build_pin_on_disc
from exudyn_models.paper.native_contact import add_native_friction, simulate_with_native_contact
from exudyn_models.paper.simulate import simulate, simulate_fixed_step
from exudyn_models.parts.energy_balance import EnergyBalance, add_energy_balance, spring_energy
from exudyn_models.parts.friction_sensors import RingFriction
from exudyn_models.parts.radial_support import RadialSupport, add_radial_support
from exudyn_models.parts.ring_friction import add_ring_friction
from exudyn_models.solver.solve_dynamic import solve_dynamic
from exudyn_models.solver.step_limit import largest_stable_step

__all__ = [
    "PASSENGER_CAR",
    "Drivetrain",
    "DrivetrainModel",
    "EnergyBalance",
    "RadialSupport",
    "RingFriction",
    "add_energy_balance",
    "add_native_friction",
    "add_radial_support",
    "add_ring_friction",
    "build_disc_on_disc",
    "build_drivetrain",
    "build_pin_on_disc",
    "eigenvalues",
    "four_cylinder",
    "largest_stable_step",
    "simulate",
    "simulate_fixed_step",
    "simulate_with_native_contact",
    "solve_dynamic",
    "spring_energy",
]
