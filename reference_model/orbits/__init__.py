"""Periodic orbits by shooting, their branches, and the basin boundaries formed by unstable orbits."""

from reference_model.orbits.shooting import NoOrbitError, Orbit
from reference_model.orbits.whirl import last_whirl, modulated_cycle, whirl_branch, whirl_orbit

__all__ = ["NoOrbitError", "Orbit", "last_whirl", "modulated_cycle", "whirl_branch", "whirl_orbit"]
