"""The radial dynamics of friction discs in plain NumPy and SciPy, with exact Coulomb friction.

Where to find what:

- parameters and results: ``systems``, ``trajectory``;
- the force of a support that may harden or have a stop: ``support``;
- laws of friction: ``contact`` with ``ring_integrals``, ``annulus``;
- the paper's closed forms: ``pin_formulas``, ``disc_formulas``; ``harmonic_balance`` for a hardening support;
- simulation: ``integrate``, which goes through ``phases`` of ``slip`` and ``sticking`` by the equations of motion of
  ``pin`` and ``disc``; ``points`` with ``pivot`` and ``limit_surface`` for discs on single points, ``growth`` for how
  slip begins, ``units`` and ``stepping`` below;
- many trajectories at once, or a single one, compiled: ``ensemble``;
- steady motions: ``steady_states`` with ``disc_balance`` and ``zeros``; ``orbits`` by shooting, ``stick_slip`` by the
  map from release to release;
- boundaries of basins: ``basins`` with ``dividing_curves``;
- stability: ``stability``, ``characteristic``, ``modulation``; ``boundaries`` by ``continuation``;
- a check of any engine: ``power``.
"""

from reference_model.contact.annulus import Annulus
from reference_model.contact.contact_law import PointsOnRing, Ring, ThreeTermRing
from reference_model.formulas.pin import sticking_radius
from reference_model.formulas.power_balance import PowerBalance, power_balance
from reference_model.orbits.basin_boundary import basin_boundary, boundary_point
from reference_model.orbits.release_map import StickSlipOrbit, stick_slip_orbits
from reference_model.orbits.shooting import Orbit, last_whirl, modulated_cycle, whirl_branch, whirl_orbit
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
    "stick_slip_orbits",
    "sticking_radius",
    "whirl_branch",
    "whirl_orbit",
    "whirls",
    "why_no_equilibrium",
    "why_no_whirl",
]
