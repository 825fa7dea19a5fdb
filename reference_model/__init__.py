"""The radial dynamics of friction discs in plain NumPy and SciPy, with exact Coulomb friction.

Where to find what:

- to begin with: ``plain``, the paper's equations as printed, integrated by SciPy, in 100 lines;
- parameters and results: ``systems``, ``trajectory``; the force of a support that may harden or stop: ``support``;
- the door to a simulation: ``simulation``;
- ``contact``: the laws of friction of a pin, of points, of a ring and of an annulus, and what they can hold;
- ``formulas``: the paper's closed forms, of the ``pin`` and the ``disc``; harmonic balance for a hardening support,
  balances of torques, characteristic polynomials; and ``power_balance``, a check of any engine;
- ``motion``: what a simulation goes through, slip and stick, from one phase to the next;
- ``steady``: steady motions, their stability, and where it is lost, as curves in planes of two parameters;
- ``orbits``: periodic motions by shooting, their branches, the map from release to release, boundaries of basins;
- ``ensemble``: many trajectories at once, or a single one, compiled;
- ``numerics``: roots, curves by continuation, curves on which a sign changes.
"""

from reference_model.contact.annulus import Annulus
from reference_model.contact.contact_law import PointsOnRing, Ring, ThreeTermRing
from reference_model.formulas.pin import sticking_radius
from reference_model.formulas.power_balance import PowerBalance, power_balance
from reference_model.orbits import Orbit, last_whirl, modulated_cycle, whirl_branch, whirl_orbit
from reference_model.orbits.basin_boundary import basin_boundary, boundary_point
from reference_model.orbits.release_map import StickSlipOrbit, stick_slip_orbits
from reference_model.orbits.shock import Shock, smallest_shock
from reference_model.simulation import simulate
from reference_model.steady.stability import onset_load
from reference_model.steady.steady_states import (
    SelfCentredEquilibrium,
    SpinningEquilibrium,
    SpinningWhirl,
    Whirl,
    self_centred_equilibria,
    smallest_load_with_whirl,
    whirls,
    why_no_equilibrium,
    why_no_whirl,
)
from reference_model.systems import DiscOnDisc, PinOnDisc
from reference_model.trajectory import Phase, SimulationError, Solution, Trajectory

__version__ = "0.1.0"
"""Of all three packages: ``pyproject.toml`` takes it from here."""

__all__ = [
    "Annulus",
    "DiscOnDisc",
    "Orbit",
    "Phase",
    "PinOnDisc",
    "PointsOnRing",
    "PowerBalance",
    "Ring",
    "SelfCentredEquilibrium",
    "Shock",
    "SimulationError",
    "Solution",
    "SpinningEquilibrium",
    "SpinningWhirl",
    "StickSlipOrbit",
    "ThreeTermRing",
    "Trajectory",
    "Whirl",
    "basin_boundary",
    "boundary_point",
    "last_whirl",
    "modulated_cycle",
    "onset_load",
    "power_balance",
    "self_centred_equilibria",
    "simulate",
    "smallest_load_with_whirl",
    "smallest_shock",
    "stick_slip_orbits",
    "sticking_radius",
    "whirl_branch",
    "whirl_orbit",
    "whirls",
    "why_no_equilibrium",
    "why_no_whirl",
]
