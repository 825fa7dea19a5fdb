"""Random pins, discs and initial states.

Sizes, rates and ratios have log-uniform distributions; signs and directions have uniform distributions.
"""

import cmath
import math
from dataclasses import asdict

import numpy as np
from numpy.random import Generator

from reference_model.systems import DiscOnDisc, FloatArray, PinOnDisc, System


def between(random: Generator, low: float, high: float) -> float:
    return float(np.exp(random.uniform(math.log(low), math.log(high))))


def sign(random: Generator) -> float:
    return float(random.choice((-1.0, 1.0)))


def vector(random: Generator, size: float) -> complex:
    """Draw a vector of any direction, with a length between a third and three times ``size``."""
    return cmath.rect(size * between(random, 1 / 3, 3.0), random.uniform(-math.pi, math.pi))


def state_of(
    place: complex, velocity: complex, *, angle: float = 0.0, spin: float | None = None
) -> FloatArray:
    """Return the state of a pin, shape (4,), or with a ``spin`` the state of a disc, shape (6,)."""
    if spin is None:
        return np.array([place.real, place.imag, velocity.real, velocity.imag])
    return np.array([place.real, place.imag, angle, velocity.real, velocity.imag, spin])


def any_pin(random: Generator) -> PinOnDisc:
    """Draw a pin with damping, friction and offset; ω exceeds its natural frequency."""
    mass, frequency, size = between(random, 0.1, 10.0), between(random, 0.3, 3.0), between(random, 0.03, 1.0)
    stiffness = mass * frequency**2
    return PinOnDisc(
        mass=mass,
        stiffness=stiffness,
        damping=mass * frequency * between(random, 0.01, 1.0),
        friction_force=stiffness * size * between(random, 0.1, 1.0),
        disc_speed=sign(random) * frequency * between(random, 1.2, 4.0),
        offset=sign(random) * size * between(random, 0.1, 1.0),
    )


def any_disc(random: Generator, points: int | None) -> DiscOnDisc:
    """Draw a disc with shaft damping and offset, on ``points`` or on a continuous ring (None)."""
    pin = any_pin(random)
    radius = abs(pin.offset) * between(random, 0.5, 5.0)
    inertia = pin.mass * radius**2 * between(random, 0.3, 3.0)
    return DiscOnDisc(
        **asdict(pin),
        polar_inertia=inertia,
        contact_radius=radius,
        shaft_damping=inertia * pin.natural_frequency * between(random, 0.03, 1.0),
        shaft_speed=pin.disc_speed * random.uniform(-1.0, 2.0),
        contact_points=points,
    )


def any_start(random: Generator, system: System) -> FloatArray:
    """Draw an initial state on the scale of the offset, shape (4,) or (6,)."""
    size = abs(system.offset)
    place, velocity = vector(random, size), vector(random, size * system.natural_frequency)
    spin = system.disc_speed * random.uniform(-1.0, 2.0) if isinstance(system, DiscOnDisc) else None
    return state_of(place, velocity, spin=spin)
