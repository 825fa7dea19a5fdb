"""The paper's systems as multibody models in Exudyn, and parts for your own models.

All public names are exported here. Importing the package replaces ``exudyn.MainSystem.Assemble`` in the whole process
by a method that lets the package's parts forget the numbers of their coordinates and then calls Exudyn's method.
Models without these parts assemble as before. The names come from these packages:

- ``parts``: friction, radial support, heat capacity and energy balance for your model. Importing it also defines
  ``mbs.CreateRingFriction`` and similar methods.
- ``solver``: ``solve_dynamic``, which is ``mbs.SolveDynamic`` with checks, and ``largest_stable_step`` for explicit
  solvers with a fixed step.
- ``drivetrain``: engine, clutch and vehicle made of these parts, and an example, ``PASSENGER_CAR``.
- ``paper``: the paper's pin and disc. ``simulate`` has the signature and result of the reference.
- ``forces``: the compiled force laws.
"""

from exudyn_models.drivetrain.model import DrivetrainModel, build_drivetrain
from exudyn_models.drivetrain.parameters import PASSENGER_CAR, Drivetrain, four_cylinder
from exudyn_models.paper.linearisation import eigenvalues
from exudyn_models.paper.model import build_model
from exudyn_models.paper.native_contact import simulate_with_native_contact
from exudyn_models.paper.simulate import simulate, simulate_fixed_step
from exudyn_models.parts import create_functions as _create_functions  # noqa: F401  registers methods of mbs
from exudyn_models.parts.energy_balance import EnergyBalance, add_energy_balance, spring_energy
from exudyn_models.parts.friction_sensors import RingFriction
from exudyn_models.parts.native_contact import add_native_friction
from exudyn_models.parts.radial_support import RadialSupport, add_radial_support
from exudyn_models.parts.ring_friction import add_ring_friction
from exudyn_models.parts.rotational.couplings import RotorCoupling
from exudyn_models.parts.rotational.gears import add_differential, add_gear, add_planetary
from exudyn_models.parts.rotational.one_way_clutch import add_one_way_clutch
from exudyn_models.parts.rotational.shifts import ShiftSequence, shift_sequence
from exudyn_models.parts.rotational.sliders import add_slider_friction, add_tyre
from exudyn_models.parts.rotational.torques import (
    RoadLoad,
    RotorTorques,
    add_road_load,
    add_torque,
    add_torque_converter,
    torque_table,
)
from exudyn_models.parts.rotational.torsional_spring import add_torsional_spring
from exudyn_models.parts.thermal_node import ThermalNode, add_thermal_node
from exudyn_models.solver.checks.step_limit import largest_stable_step
from exudyn_models.solver.linear.locked_state import ContactState, Linearisation, linearise
from exudyn_models.solver.solve_dynamic import solve_dynamic
from exudyn_models.solver.stick.sticking_contacts import ModeChange

__all__ = [
    "PASSENGER_CAR",
    "ContactState",
    "Drivetrain",
    "DrivetrainModel",
    "EnergyBalance",
    "Linearisation",
    "ModeChange",
    "RadialSupport",
    "RingFriction",
    "RoadLoad",
    "RotorCoupling",
    "RotorTorques",
    "ShiftSequence",
    "ThermalNode",
    "add_differential",
    "add_energy_balance",
    "add_gear",
    "add_native_friction",
    "add_one_way_clutch",
    "add_planetary",
    "add_radial_support",
    "add_ring_friction",
    "add_road_load",
    "add_slider_friction",
    "add_thermal_node",
    "add_torque",
    "add_torque_converter",
    "add_torsional_spring",
    "add_tyre",
    "build_drivetrain",
    "build_model",
    "eigenvalues",
    "four_cylinder",
    "largest_stable_step",
    "linearise",
    "shift_sequence",
    "simulate",
    "simulate_fixed_step",
    "simulate_with_native_contact",
    "solve_dynamic",
    "spring_energy",
    "torque_table",
]
