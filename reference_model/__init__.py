"""The radial dynamics of friction discs in plain NumPy and SciPy, with exact Coulomb friction."""

from reference_model.annulus import Annulus
from reference_model.contact import PointsOnRing, Ring, ThreeTermRing
from reference_model.integrate import simulate
from reference_model.orbits import Orbit, last_whirl, modulated_cycle, whirl_branch, whirl_orbit
from reference_model.pin_formulas import sticking_radius
from reference_model.power import PowerBalance, power_balance
from reference_model.stability import onset_load
from reference_model.steady_states import (
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
    "SimulationError",
    "Solution",
    "SpinningEquilibrium",
    "SpinningWhirl",
    "ThreeTermRing",
    "Trajectory",
    "Whirl",
    "last_whirl",
    "modulated_cycle",
    "onset_load",
    "power_balance",
    "self_centred_equilibria",
    "simulate",
    "smallest_load_with_whirl",
    "sticking_radius",
    "whirl_branch",
    "whirl_orbit",
    "whirls",
    "why_no_equilibrium",
    "why_no_whirl",
]
