"""Plain integration of eq. 1 in real coordinates, an independent reference for the motions of pins."""

import math
from dataclasses import replace

import numpy as np
from plain_slip import slide

from reference_model import plain
from reference_model.systems import DiscOnDisc
from reference_model.trajectory import Phase, Solution, Trajectory


def slip_velocity(pin, state):
    x, y, vx, vy = state
    return np.array([vx + pin.disc_speed * y, vy - pin.disc_speed * x])


def support_force(pin, state):
    """Return the force of springs, stop and dampers on the pin."""
    return pin.mass * rates(pin, state, np.zeros_like)[2:]


def stuck_state(system, x, y):
    """Return the state of a pin or a disc that turns with the master disc."""
    speed = system.disc_speed
    if isinstance(system, DiscOnDisc):
        return np.array([x, y, 0.0, -speed * y, speed * x, speed])
    return np.array([x, y, -speed * y, speed * x])


def as_disc(pin, points):
    """Return a disc without relative spin that moves like the pin."""
    shape = {"polar_inertia": 0.02, "contact_radius": 0.2, "shaft_damping": 0.0, "shaft_speed": 0.0}
    return DiscOnDisc(**vars(pin), **shape, contact_points=points)


def turned_with_disc(pin, state, time):
    """Return the state of a stuck pin after ``time``."""
    c, s = math.cos(pin.disc_speed * time), math.sin(pin.disc_speed * time)
    x, y = state[0], state[1]
    return stuck_state(pin, c * x - s * y, s * x + c * y)


def pull_on_stuck_pin(pin, state):
    """Return the force in N that friction must balance for the pin to turn with the disc (6)."""
    return support_force(pin, state) + pin.mass * pin.disc_speed**2 * np.asarray(state[:2])


def rates(pin, state, friction):
    """Return the right side of (1) with the friction force ``friction(slip_velocity)`` in N."""
    return np.array(plain.rates(pin, of_vector(friction), state))


def of_vector(friction):
    """Convert a force as a function of the slip velocity in m/s, shape (2,), to a friction of ``plain``."""
    return lambda slip_x, slip_y, *_: (*friction(np.array([slip_x, slip_y])), 0.0)


def integrate(pin, state, times, friction, regularisation=0.0, method="DOP853", tolerance=1e-12):
    """Return the trajectory of ``pin`` under any friction law."""
    run = slide(pin, state, times, of_vector(friction), method=method, rtol=tolerance, atol=tolerance * 1e-2)
    phase = Phase("slip", float(times[0]), float(times[-1]), run.y[:, 0].copy())
    solution = Solution("plain", tolerance, 0, 0, 0.0, regularisation)
    return Trajectory(pin, np.array(times), run.y.T.copy(), (phase,), solution)


# Powers of mass, length and time.
DIMENSIONS = {
    "mass": (1, 0, 0), "stiffness": (1, 0, -2), "damping": (1, 0, -1), "friction_force": (1, 1, -2),
    "disc_speed": (0, 0, -1), "offset": (0, 1, 0), "hardening": (1, -2, -2), "stop_gap": (0, 1, 0),
    "stop_stiffness": (1, 0, -2), "polar_inertia": (1, 2, 0), "contact_radius": (0, 1, 0),
    "shaft_damping": (1, 2, -1), "shaft_speed": (0, 0, -1),
}  # fmt: skip


def in_units(system, mass, length, time):
    """Return ``system`` in units that are smaller by these factors."""
    values = {
        name: getattr(system, name) * mass**m * length**x * time**t
        for name, (m, x, t) in DIMENSIONS.items()
        if hasattr(system, name)
    }
    return replace(system, **values)
