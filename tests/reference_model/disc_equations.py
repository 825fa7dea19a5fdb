"""Eqs. 19 and 23 for real and complex arguments, an independent reference for formulas."""

from dataclasses import replace

import numpy as np

from compare.claims.parameters import FIG9
from reference_model import plain
from reference_model.systems import DiscOnDisc

FIG_9 = replace(FIG9, offset=0.0)
LARGE = DiscOnDisc(
    mass=2.3, polar_inertia=0.6, stiffness=5.1, damping=0.7, friction_force=0.4, disc_speed=2.2, offset=0.15,
    contact_radius=0.5, shaft_damping=0.3, shaft_speed=-0.9,
)  # fmt: skip
STICKY = DiscOnDisc(
    mass=1.0, polar_inertia=0.02, stiffness=1.0, damping=0.1, friction_force=0.09, disc_speed=1.5, offset=0.1,
    contact_radius=0.12, shaft_damping=0.005, shaft_speed=1.25,
)  # fmt: skip
"""A disc whose motions from ``STICKING`` have stick phases, and pivots if it has points."""

STICKING = [0.1, 0.0, 0.0, 0.03, 0.0, 1.5]


def points_on_ring(disc, number):
    """Return force and moment of ``number`` points that share μN by (20) and (21)."""
    return plain.on_ring(disc.friction_force, disc.contact_radius, number, epsilon=0.0)


def eq_23(disc):
    """Return force and moment of (23)."""

    def friction(slip_x, slip_y, relative_spin, angle):
        R = disc.contact_radius
        centre, rim = slip_x**2 + slip_y**2, (R * relative_spin) ** 2
        mean = centre + rim
        both = 0.75 * centre * rim / mean**2
        force = -disc.friction_force / np.sqrt(mean) * (1.0 - rim / (2.0 * mean) + both)
        moment = (
            disc.friction_force / np.sqrt(mean) * R**2 * relative_spin * (1.0 - centre / (2.0 * mean) + both)
        )
        return force * slip_x, force * slip_y, moment

    return friction


def rates(system, friction, state):
    """Return the right side of (1) or (19) as a first-order system."""
    return np.array(plain.rates(system, friction, state))


def rates_in_turning_axes(system, friction, frequency, state):
    """Return the rates of x, y, vx, vy in axes that turn at ``frequency``, and of the spin of a disc."""
    x, y, vx, vy, *spin = state
    angle = [0.0] if spin else []
    still = rates(system, friction, [x, y, *angle, vx, vy, *spin])
    return (np.delete(still, 2) if spin else still) - frequency * np.array(
        [-y, x, -vy, vx, *(0.0 * w for w in spin)]
    )


def derivative(function, point):
    """Return the Jacobian by complex steps, which avoids cancellation."""
    step, point = 1e-20, np.asarray(point, dtype=complex)
    return np.column_stack([function(point + 1j * step * e).imag / step for e in np.eye(point.size)])


def assert_same_eigenvalues(found, expected, tolerance=1e-12):
    left = list(expected)
    assert len(found) == len(left)
    scale = np.abs(left).max()
    for value in found:
        nearest = min(left, key=lambda other: abs(other - value))
        assert abs(nearest - value) <= tolerance * scale, f"{value} not in {expected}"
        left.remove(nearest)


def mirrored(system):
    """Return the pin or disc whose motions are mirrored in the x axis."""
    shaft = {"shaft_speed": -system.shaft_speed} if isinstance(system, DiscOnDisc) else {}
    return replace(system, disc_speed=-system.disc_speed, **shaft)
