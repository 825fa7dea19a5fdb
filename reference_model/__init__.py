"""The radial dynamics of friction discs in plain NumPy and SciPy, with exact Coulomb friction."""

from reference_model.integrate import simulate
from reference_model.orbits import Orbit, last_whirl, whirl_branch, whirl_orbit
from reference_model.pin_formulas import sticking_radius
from reference_model.power import PowerBalance, power_balance
from reference_model.steady_states import SelfCentredEquilibrium, Whirl, self_centred_equilibria, whirls
from reference_model.systems import PinOnDisc
from reference_model.trajectory import Phase, SimulationError, Solution, Trajectory

__all__ = [
    "Orbit",
    "Phase",
    "PinOnDisc",
    "PowerBalance",
    "SelfCentredEquilibrium",
    "SimulationError",
    "Solution",
    "Trajectory",
    "Whirl",
    "last_whirl",
    "power_balance",
    "self_centred_equilibria",
    "simulate",
    "sticking_radius",
    "whirl_branch",
    "whirl_orbit",
    "whirls",
]
