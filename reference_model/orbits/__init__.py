"""Closed orbits by shooting, branches of them, and the boundaries of basins that unstable ones make."""

from reference_model.orbits.shooting import Orbit, last_whirl, modulated_cycle, whirl_branch, whirl_orbit

__all__ = ["Orbit", "last_whirl", "modulated_cycle", "whirl_branch", "whirl_orbit"]
