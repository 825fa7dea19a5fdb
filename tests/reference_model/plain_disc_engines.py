"""Eq. 19 integrated as plainly as can be, to judge the reference by."""

import cmath

import numpy as np
from plain_slip import slide
from scipy.optimize import minimize_scalar

from reference_model import plain
from reference_model.contact.contact_law import contact_of


def stuck_disc(disc, z, angle):
    v = 1j * disc.disc_speed * z
    return np.array([z.real, z.imag, angle, v.real, v.imag, disc.disc_speed])


def forces_of_support(disc, z, v, spin):
    """Force of springs and dampers in N, and moment of the shaft in N m."""
    *_, ax, ay, turning = plain.rates(
        disc, lambda *_: (0.0, 0.0, 0.0), [z.real, z.imag, 0.0, v.real, v.imag, spin]
    )
    return disc.mass * complex(ax, ay), disc.polar_inertia * turning


def slide_disc(disc, state, times, contact=None, **options):
    """States at ``times`` of pure slip."""
    # Steps small enough that the kinks of points and the logarithm of the ring, where U = R|S|, do no harm.
    friction = plain.by_law(disc.friction_force, contact_of(disc, contact))
    return slide(disc, state, times, friction, **{"max_step": 0.01} | options).y.T


def just_released_disc(disc, stick, delay):
    """State ``delay`` after the end of a stick phase: slip grows like ½κt² normal to the limit surface.

    The normal is the slip n = (u, w) of unit energy whose power against friction is least over what the pull puts in;
    κ is what the pull along it gains on friction in a unit of time. Both by differences, from the contact law.
    """
    law, omega = contact_of(disc), disc.disc_speed
    inertia = disc.polar_inertia / disc.mass

    def turned(time):
        turn = omega * (time - stick.start)
        return complex(*stick.initial_state[:2]) * cmath.exp(1j * turn), stick.initial_state[2] + turn

    def excess(n, time):
        """Power of pull less that of friction, over mass, for the slip n = (u in the frame of the disc, w)."""
        z, angle = turned(time)
        u = n[0] * cmath.exp(1j * angle)
        support, shaft = forces_of_support(disc, z, 1j * omega * z, omega)
        pull = support + disc.mass * omega**2 * z
        force, moment = law.force_and_moment(u, -n[1], angle)
        power = (u.conjugate() * (pull + disc.friction_force * force)).real
        return (power + n[1] * (shaft + disc.friction_force * moment)) / disc.mass

    def normal(direction, latitude):
        return np.cos(latitude) * cmath.exp(1j * direction), np.sin(latitude) / np.sqrt(inertia)

    def best(direction):
        return minimize_scalar(
            lambda latitude: -excess(normal(direction, latitude), stick.end),
            bounds=(-1.5, 1.5), method="bounded", options={"xatol": 1e-12},
        )  # fmt: skip

    grid = np.linspace(0.0, 2.0 * np.pi, 73)
    first = grid[np.argmin([best(direction).fun for direction in grid])]
    direction = minimize_scalar(
        lambda direction: best(direction).fun, bounds=(first - 0.1, first + 0.1), method="bounded",
        options={"xatol": 1e-12},
    ).x  # fmt: skip
    n = normal(direction, best(direction).x)
    growth = (excess(n, stick.end + 1e-5) - excess(n, stick.end - 1e-5)) / 2e-5
    z, angle = turned(stick.end + delay)
    state = stuck_disc(disc, z, angle)
    u = 0.5 * growth * delay**2 * n[0] * cmath.exp(1j * angle)
    state[3:] += u.real, u.imag, 0.5 * growth * delay**2 * n[1]
    return state


def friction_of_pivot(disc, state, point):
    """Force in N at ``point`` that keeps it on the master disc while the disc turns about it.

    The acceleration of the point relative to what it rests on is linear in that force: found by trying three.
    """
    n, omega = disc.contact_points, disc.disc_speed
    z, v, spin = complex(state[0], state[1]), complex(state[3], state[4]), state[5]
    arms = disc.contact_radius * np.exp(1j * (state[2] + 2.0 * np.pi * np.arange(n) / n))
    slip = 1j * (spin - omega) * (arms - arms[point])
    others = np.arange(n) != point
    friction = -disc.friction_force / n * slip[others] / abs(slip[others])
    support, shaft = forces_of_support(disc, z, v, spin)

    def acceleration(force):
        a = (support + friction.sum() + force) / disc.mass
        moment = shaft + (arms[others].conj() * friction).imag.sum() + (arms[point].conjugate() * force).imag
        of_point = a + (1j * moment / disc.polar_inertia - spin**2) * arms[point]
        return of_point + omega**2 * (z + arms[point])

    free, *unit = (acceleration(force) for force in (0.0, 1.0, 1j))
    columns = np.array([[(a - free).real, (a - free).imag] for a in unit]).T
    return complex(*np.linalg.solve(columns, [-free.real, -free.imag]))
