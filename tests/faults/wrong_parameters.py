"""The reference with wrong parameters: functions of a system that return the changed ones."""

from dataclasses import replace

from faults.reference import simulate
from reference_model.systems import DiscOnDisc


def with_parameters(change, system, start, times, *, tolerance=1e-9):
    """Simulate ``system`` with some of its parameters changed."""
    trajectory = simulate(replace(system, **change(system)), start, times, tolerance=tolerance)
    return replace(trajectory, system=system)


def off_by(name, share, system):
    """Return a parameter too large by ``share``; empty if the system lacks the parameter."""
    return {name: (1.0 + share) * getattr(system, name)} if hasattr(system, name) else {}


def one_point_too_few(system):
    """Return n − 1 points; a disc needs at least 3."""
    points = (system.contact_points or 0) if isinstance(system, DiscOnDisc) else 0
    return {"contact_points": points - 1} if points > 3 else {}


def stronger_at_extremes(system):
    """Return a load that is 1 % larger at high and low disc speeds."""
    usual = 0.3 <= abs(system.disc_speed) <= 4.0
    return {} if usual else {"friction_force": 1.01 * system.friction_force}


def weaker_backwards(system):
    """Return a load that is 1e-4 smaller for ω < 0."""
    return {"friction_force": (1.0 - 1e-4) * system.friction_force} if system.disc_speed < 0.0 else {}
