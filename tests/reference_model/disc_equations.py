"""Eq. 19 of the plain equations, for complex arguments too, and (23), to judge the disc's formulas by."""

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


def points_on_ring(disc, number):
    """Force and moment of ``number`` points that share μN, from (20) and (21), with friction full at any slip."""
    return plain.on_ring(disc.friction_force, disc.contact_radius, number, epsilon=0.0)


def eq_23(disc):
    """Force and moment of (23)."""

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


def rates(disc, friction, state):
    """Right side of (19) as a first-order system, for x, y, angle, vx, vy, spin."""
    return np.array(plain.rates(disc, friction, state))


def rates_in_turning_axes(disc, friction, frequency, state):
    """Rates of x, y, vx, vy along axes that turn at ``frequency``, and of the spin, which don't see the angle."""
    x, y, vx, vy, spin = state
    still = rates(disc, friction, [x, y, 0.0, vx, vy, spin])
    return still[[0, 1, 3, 4, 5]] - frequency * np.array([-y, x, -vy, vx, 0.0 * spin])


def mirrored(disc):
    """Return the disc whose motions are those of ``disc`` mirrored in the x axis."""
    return replace(disc, disc_speed=-disc.disc_speed, shaft_speed=-disc.shaft_speed)


def disc_in_units(disc, mass, length, time):
    """``disc`` in units that are smaller by these factors: the same motion in other numbers."""
    return replace(
        disc,
        mass=disc.mass * mass,
        polar_inertia=disc.polar_inertia * mass * length**2,
        stiffness=disc.stiffness * mass / time**2,
        damping=disc.damping * mass / time,
        friction_force=disc.friction_force * mass * length / time**2,
        disc_speed=disc.disc_speed / time,
        offset=disc.offset * length,
        hardening=disc.hardening * mass / time**2 / length**2,
        stop_gap=disc.stop_gap * length,
        stop_stiffness=disc.stop_stiffness * mass / time**2,
        contact_radius=disc.contact_radius * length,
        shaft_damping=disc.shaft_damping * mass * length**2 / time,
        shaft_speed=disc.shaft_speed / time,
    )
