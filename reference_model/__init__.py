"""Radial dynamics of friction discs with exact Coulomb friction, in NumPy and SciPy.

- ``plain``: the paper's equations as printed, integrated by SciPy; read it first;
- ``systems``, ``support``, ``trajectory``: parameters, nonlinear supports and results;
- ``simulation``: :func:`simulate` for a pin, a disc and a joint with friction;
- ``contact``: friction laws, their limit surfaces, and the quasi-static motion of a pushed body;
- ``formulas``: the paper's closed forms, harmonic balance, torque balances and ``power_balance``;
- ``steady``: steady motions, their stability, and its boundaries;
- ``orbits``: periodic motions by shooting, their branches, the release map and basin boundaries;
- ``core``: one trajectory by the same functions, interpreted or compiled;
- ``ensemble``: compiled simulation of many trajectories;
- ``numerics``: roots, continuation, curves where a function changes sign, and compiled code on disk.

The public names are imported when they are used, so that the parameters alone can be used without SciPy.
"""

from importlib import import_module
from importlib.util import find_spec
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from reference_model.contact.annulus import Annulus
    from reference_model.contact.contact_law import Ring, ThreeTermRing
    from reference_model.contact.points import Points, PointsOnRing
    from reference_model.contact.pushing import Pushing
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
    from reference_model.systems.joint import FrictionJoint
    from reference_model.trajectory import Phase, SimulationError, Solution, Trajectory

__version__ = "0.1.0"
"""Version of all packages, read by ``pyproject.toml``."""

__all__ = [
    "Annulus",
    "DiscOnDisc",
    "FrictionJoint",
    "Orbit",
    "Phase",
    "PinOnDisc",
    "Points",
    "PointsOnRing",
    "PowerBalance",
    "Pushing",
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

_HOMES = (
    "systems", "trajectory", "contact.points", "contact.contact_law", "contact.annulus", "systems.joint",
    "formulas.joint", "simulation", "formulas.pin", "formulas.power_balance", "contact.pushing", "steady.stability",
    "steady.steady_states", "orbits.whirl", "orbits.shooting", "orbits.release_map", "orbits.basin_boundary",
    "orbits.shock",
)  # fmt: skip
"""The modules of these names; each module is searched after the modules that it imports. ``find_packages`` would also
find modules."""


def __getattr__(name: str) -> Any:
    if name in __all__:
        modules = (import_module(f"{__name__}.{home}") for home in _HOMES)
        return next(getattr(module, name) for module in modules if hasattr(module, name))
    if not name.startswith("_") and find_spec(f"{__name__}.{name}"):
        return import_module(f"{__name__}.{name}")
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})
