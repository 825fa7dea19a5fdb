"""The paper's systems as multibody models in Exudyn, and parts for models of your own.

All that is public has its name here; where it comes from, and where to change it:

- ``parts``: what goes into a model of yours. Friction between two bodies, ``add_ring_friction`` with its handle
  ``RingFriction``, and by Exudyn's own contact ``add_native_friction``; an elastic support, ``add_radial_support``
  with its ``RadialSupport``; what friction heats, ``add_thermal_node`` with its ``ThermalNode``; the
  ``EnergyBalance`` of a run, ``add_energy_balance`` and ``spring_energy``. Friction and support are
  ``mbs.CreateRingFriction`` and ``mbs.CreateRadialSupport`` too, as soon as this package is imported.
- ``solver``: how to run it. ``solve_dynamic`` is ``mbs.SolveDynamic`` that tells what went wrong;
  It returns a list of ``ModeChange`` if contacts stick exactly. ``largest_stable_step`` is for explicit solvers with
  a fixed step.
- ``drivetrain``: engine, clutch and vehicle, made of these parts. ``Drivetrain`` has the parameters,
  ``PASSENGER_CAR`` is one and ``four_cylinder`` its torque; ``build_drivetrain`` returns a ``DrivetrainModel``.
- ``paper``: the pin and the disc of the paper. ``simulate`` has the call and the result of the reference's,
  ``simulate_fixed_step`` is for studies of convergence, ``simulate_with_native_contact`` goes without our friction;
  ``build_pin_on_disc`` and ``build_disc_on_disc`` return the models, ``eigenvalues`` small motions about a state.
- ``forces``: the compiled laws below all of them.
"""

from exudyn_models.drivetrain.model import DrivetrainModel, build_drivetrain
from exudyn_models.drivetrain.parameters import PASSENGER_CAR, Drivetrain, four_cylinder
from exudyn_models.paper.linearisation import eigenvalues
from exudyn_models.paper.models.disc_on_disc import build_disc_on_disc
from exudyn_models.paper.models.pin_on_disc import build_pin_on_disc
from exudyn_models.paper.native_contact import simulate_with_native_contact
from exudyn_models.paper.simulate import simulate, simulate_fixed_step
from exudyn_models.parts import create_functions as _create_functions  # noqa: F401  for its methods of mbs
from exudyn_models.parts.energy_balance import EnergyBalance, add_energy_balance, spring_energy
from exudyn_models.parts.friction_sensors import RingFriction
from exudyn_models.parts.native_contact import add_native_friction
from exudyn_models.parts.radial_support import RadialSupport, add_radial_support
from exudyn_models.parts.ring_friction import add_ring_friction
from exudyn_models.parts.thermal_node import ThermalNode, add_thermal_node
from exudyn_models.solver.solve_dynamic import solve_dynamic
from exudyn_models.solver.step_limit import largest_stable_step
from exudyn_models.solver.sticking_contacts import ModeChange

__all__ = [
    "PASSENGER_CAR",
    "Drivetrain",
    "DrivetrainModel",
    "EnergyBalance",
    "ModeChange",
    "RadialSupport",
    "RingFriction",
    "ThermalNode",
    "add_energy_balance",
    "add_native_friction",
    "add_radial_support",
    "add_ring_friction",
    "add_thermal_node",
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
