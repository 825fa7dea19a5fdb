"""The reference with wrong parameters."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any

from numpy.typing import ArrayLike

from faults.reference import simulate
from reference_model.systems import DiscOnDisc, System
from reference_model.trajectory import Trajectory


def with_parameters(
    change: Callable[[System], dict[str, Any]],
    system: System,
    initial_state: ArrayLike,
    times: ArrayLike,
    *,
    tolerance: float = 1e-9,
) -> Trajectory:
    """Simulate ``system`` with some of its parameters changed."""
    trajectory = simulate(replace(system, **change(system)), initial_state, times, tolerance=tolerance)
    return replace(trajectory, system=system)


def off_by(name: str, share: float, system: System) -> dict[str, float]:
    """Return a parameter too large by ``share``; empty if the system lacks the parameter."""
    return {name: (1.0 + share) * getattr(system, name)} if hasattr(system, name) else {}


def points_of(system: System) -> int:
    """Return the number of contact points of a disc, 0 without any."""
    return (system.contact_points or 0) if isinstance(system, DiscOnDisc) else 0


def one_point_too_few(system: System) -> dict[str, Any]:
    """Return n − 1 points; a disc needs at least 3."""
    return {"contact_points": points_of(system) - 1} if points_of(system) > 3 else {}


def load_not_shared(system: System) -> dict[str, Any]:
    """Return the load multiplied by the number of points."""
    return {"friction_force": system.friction_force * (points_of(system) or 1)}


def disc_backwards(system: System) -> dict[str, Any]:
    """Return −ω."""
    return {"disc_speed": -system.disc_speed}


def stronger_at_extremes(system: System) -> dict[str, Any]:
    """Return a load that is 1 % larger at high and low disc speeds."""
    usual = 0.3 <= abs(system.disc_speed) <= 4.0
    return {} if usual else {"friction_force": 1.01 * system.friction_force}


def weaker_backwards(system: System) -> dict[str, Any]:
    """Return a load that is 1e-4 smaller for ω < 0."""
    return {"friction_force": (1.0 - 1e-4) * system.friction_force} if system.disc_speed < 0.0 else {}
