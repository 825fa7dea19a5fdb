"""Random motions that are known: in closed form, or by the reference at a far tighter tolerance.

Sizes, rates and ratios are drawn from log-uniform distributions, signs and directions from all that there are.
"""

from __future__ import annotations

import cmath
import functools
import math
from collections.abc import Callable, Mapping
from dataclasses import replace

import numpy as np
from numpy.random import Generator

from compare.studies.engines.error_estimates.calibration import Problem
from compare.studies.toolkit.free_bodies import Slowing
from reference_model import simulate
from reference_model.formulas.pin import (
    first_order_whirl_response,
    release_time,
    whirl_frequency,
    whirl_radius,
)
from reference_model.systems import DiscOnDisc, FloatArray, PinOnDisc, System
from reference_model.trajectory import Trajectory

TIGHT = 1e-13
"""Tolerance of the reference where there is no closed form."""

SMALL_OFFSET = 1e-7
"""X0/ρ_c of the response. What is of second order in it is as small beside it; errors are ~ tolerance/X0."""

SAMPLES = 16
"""Of a turn of the whirl, for its mean: exact for the two harmonics that there are."""

THROWS = ((0.7, 20.0), (0.8, 60.0), (1.3, 50.0), (1.5, 15.0))
"""J/(mR²) of the thrown rings and atan(W/U) in degrees at the start.

Not 1, where the end is in the integrals like exp(−A/t): they are good to 1e-11 there, and to 1e-13 elsewhere.
"""


def between(random: Generator, low: float, high: float) -> float:
    """Draw from a log-uniform distribution."""
    return float(np.exp(random.uniform(math.log(low), math.log(high))))


def _sign(random: Generator) -> float:
    return float(random.choice((-1.0, 1.0)))


def _vector(random: Generator, size: float) -> complex:
    """Draw a vector of any direction and up to three times smaller or larger than ``size``."""
    return cmath.rect(size * between(random, 1 / 3, 3.0), random.uniform(-math.pi, math.pi))


def _state(place: complex, velocity: complex, *, angle: float = 0.0, spin: float | None = None) -> FloatArray:
    if spin is None:
        return np.array([place.real, place.imag, velocity.real, velocity.imag])
    return np.array([place.real, place.imag, angle, velocity.real, velocity.imag, spin])


def _at_end(trajectory: Trajectory) -> FloatArray:
    return trajectory.at_end


def any_pin(random: Generator) -> PinOnDisc:
    """Draw a pin with all that it may have; the disc turns faster than the pin oscillates."""
    mass, frequency, size = between(random, 0.1, 10.0), between(random, 0.3, 3.0), between(random, 0.03, 1.0)
    stiffness = mass * frequency**2
    return PinOnDisc(
        mass=mass,
        stiffness=stiffness,
        damping=mass * frequency * between(random, 0.01, 1.0),
        friction_force=stiffness * size * between(random, 0.1, 1.0),
        disc_speed=_sign(random) * frequency * between(random, 1.2, 4.0),
        offset=_sign(random) * size * between(random, 0.1, 1.0),
    )


def any_disc(random: Generator, points: int | None) -> DiscOnDisc:
    """Draw a disc with all that it may have, on so many points or a continuous ring."""
    pin = any_pin(random)
    radius = abs(pin.offset) * between(random, 0.5, 5.0)
    inertia = pin.mass * radius**2 * between(random, 0.3, 3.0)
    return DiscOnDisc(
        mass=pin.mass,
        stiffness=pin.stiffness,
        damping=pin.damping,
        friction_force=pin.friction_force,
        disc_speed=pin.disc_speed,
        offset=pin.offset,
        polar_inertia=inertia,
        contact_radius=radius,
        shaft_damping=inertia * pin.natural_frequency * between(random, 0.03, 1.0),
        shaft_speed=pin.disc_speed * random.uniform(-1.0, 2.0),
        contact_points=points,
    )


def any_start(random: Generator, system: System) -> FloatArray:
    """Draw a state as large as the offset; shape (4,) or (6,)."""
    size = abs(system.offset)
    place, velocity = _vector(random, size), _vector(random, size * system.natural_frequency)
    spin = system.disc_speed * random.uniform(-1.0, 2.0) if isinstance(system, DiscOnDisc) else None
    return _state(place, velocity, spin=spin)


def _duration(random: Generator, system: System) -> float:
    """Draw from one to two turns of the support's own oscillation, in s."""
    return between(random, 2.0 * math.pi, 4.0 * math.pi) / system.natural_frequency


def _damped(system: System, start: complex, velocity: complex, t: float) -> tuple[complex, complex]:
    """Return place and velocity of a damped oscillator about the offset, without friction."""
    decay = system.damping / (2.0 * system.mass)
    own = cmath.sqrt(complex(system.natural_frequency**2 - decay**2))
    w = start - system.offset
    slope = (velocity + decay * w) / own
    c, s, fade = cmath.cos(own * t), cmath.sin(own * t), math.exp(-decay * t)
    place = fade * (w * c + slope * s)
    return place + system.offset, -decay * place + fade * own * (slope * c - w * s)


def oscillator(random: Generator) -> Problem:
    """Let a pin without friction oscillate about the offset, damped."""
    pin = replace(any_pin(random), friction_force=0.0)
    place = _vector(random, abs(pin.offset))
    velocity = _vector(random, abs(pin.offset) * pin.natural_frequency)
    t = _duration(random, pin)
    exact = _state(*_damped(pin, place, velocity, t))
    return Problem(pin, _state(place, velocity), np.array([0.0, t]), _at_end, exact)


def shaft(random: Generator) -> Problem:
    """Let a disc without friction follow the shaft, with the lag of first order."""
    disc = replace(any_disc(random, None), friction_force=0.0)
    place = _vector(random, abs(disc.offset))
    velocity = _vector(random, abs(disc.offset) * disc.natural_frequency)
    lag, t = disc.polar_inertia / disc.shaft_damping, _duration(random, disc)
    spin = disc.disc_speed * random.uniform(-1.0, 2.0)
    away = spin - disc.shaft_speed
    exact = _state(
        *_damped(disc, place, velocity, t),
        angle=disc.shaft_speed * t - away * lag * math.expm1(-t / lag),
        spin=disc.shaft_speed + away * math.exp(-t / lag),
    )
    return Problem(disc, _state(place, velocity, spin=spin), np.array([0.0, t]), _at_end, exact)


def stick(random: Generator) -> Problem:
    """Let a pin turn with the disc until (7) lets it go: a state on the way, and when it is let go."""
    while True:
        pin = any_pin(random)
        # Within this radius there are places where friction can hold it (7).
        reach = (pin.friction_force + pin.stiffness * abs(pin.offset)) / abs(
            complex(pin.stiffness - pin.mass * pin.disc_speed**2, pin.damping * pin.disc_speed)
        )
        place = cmath.rect(reach * random.uniform(0.1, 1.0), random.uniform(-math.pi, math.pi))
        delay = release_time(pin, abs(place), cmath.phase(place))
        if 0.05 < delay * abs(pin.disc_speed) < math.inf:
            break
    turned = place * cmath.exp(0.5j * pin.disc_speed * delay)
    turning = 1j * pin.disc_speed
    return Problem(
        pin,
        _state(place, turning * place),
        np.array([0.0, 0.5 * delay, 1.3 * delay]),
        _on_the_way_and_release,
        np.append(_state(turned, 1j * turned) / abs(place), delay * pin.disc_speed),
    )


def _on_the_way_and_release(trajectory: Trajectory) -> FloatArray:
    """Return place, velocity and time of release in units of the radius and the disc's speed: all are about one.

    In metres and seconds places would be small beside the time, and so rounding of the largest number far above
    theirs.
    """
    omega, start = trajectory.system.disc_speed, trajectory.states[0]
    state = trajectory.states[1] / math.hypot(start[0], start[1]) / (1.0, 1.0, omega, omega)
    return np.append(state, omega * trajectory.stick_times[1:2])


def whirl(random: Generator) -> Problem:
    """Let a centred pin go round on the circle (11)."""
    pin = replace(any_pin(random), offset=0.0)
    turning, t = 1j * whirl_frequency(pin), _duration(random, pin)
    place = cmath.rect(whirl_radius(pin), random.uniform(-math.pi, math.pi))
    end = place * cmath.exp(turning * t)
    start, exact = _state(place, turning * place), _state(end, turning * end)
    return Problem(pin, start, np.array([0.0, t]), _at_end, exact)


def response(random: Generator) -> Problem:
    """Take the mean of a whirl with a small offset, in units of it: the exact response of first order."""
    pin = any_pin(random)
    pin = replace(pin, offset=SMALL_OFFSET * whirl_radius(pin))
    found, turning = first_order_whirl_response(pin), 1j * whirl_frequency(pin)
    place = whirl_radius(pin) + found.mean + found.second_harmonic
    velocity = turning * (whirl_radius(pin) + 2.0 * found.second_harmonic)
    turn = math.tau / pin.natural_frequency
    return Problem(
        pin,
        _state(place, velocity),
        turn * np.arange(SAMPLES + 1) / SAMPLES,
        _mean_over_offset,
        np.array([found.mean.real, found.mean.imag]) / pin.offset,
    )


def _mean_over_offset(trajectory: Trajectory) -> FloatArray:
    return np.asarray(np.mean(trajectory.states[1:, :2], axis=0) / trajectory.system.offset)


def free_ring(random: Generator) -> Problem:
    """Throw a ring on a table: how far it slides and turns, and when it rests."""
    inertia, degrees = THROWS[int(random.integers(len(THROWS)))]
    time, slid, turned = _unit_stop(inertia, degrees)
    mass, radius = between(random, 0.1, 10.0), between(random, 0.03, 1.0)
    speed, deceleration = between(random, 0.1, 3.0), between(random, 0.1, 3.0)
    disc = DiscOnDisc(
        mass=mass,
        polar_inertia=inertia * mass * radius**2,
        stiffness=0.0,
        damping=0.0,
        friction_force=mass * deceleration,
        disc_speed=0.0,
        contact_radius=radius,
        shaft_damping=0.0,
        shaft_speed=0.0,
    )
    angle, sense = math.radians(degrees), _sign(random)
    heading = cmath.rect(1.0, random.uniform(-math.pi, math.pi))
    rest, way = time * speed / deceleration, speed**2 / deceleration
    end = slid * way * heading
    return Problem(
        disc,
        _state(0j, speed * math.cos(angle) * heading, spin=sense * speed * math.sin(angle) / radius),
        np.array([0.0, 1.1 * rest]),
        _place_and_time_of_rest,
        np.array([end.real, end.imag, sense * turned * way / radius, rest]),
    )


@functools.cache
def _unit_stop(inertia: float, degrees: float) -> tuple[float, float, float]:
    """Return time and ways until a ring rests that is thrown with √(U² + W²) = 1 m/s, for μN = m·(1 m/s²)."""
    angle = math.radians(degrees)
    return Slowing(inertia).stop(math.cos(angle), math.sin(angle))[:3]


def _place_and_time_of_rest(trajectory: Trajectory) -> FloatArray:
    return np.append(trajectory.at_end[:3], trajectory.stick_times[-2:-1])


def _generic(random: Generator, system: System) -> Problem:
    """Take any motion; the reference says at a far tighter tolerance where it leads."""
    start, times = any_start(random, system), np.array([0.0, _duration(random, system)])
    return Problem(system, start, times, _at_end, simulate(system, start, times, tolerance=TIGHT).at_end)


def pin(random: Generator) -> Problem:
    """Let a pin slip, and stick where it happens to."""
    return _generic(random, any_pin(random))


def ring(random: Generator) -> Problem:
    """Let a disc slip on a continuous ring."""
    return _generic(random, any_disc(random, None))


def points(random: Generator) -> Problem:
    """Let a disc slip on three to six points."""
    return _generic(random, any_disc(random, int(random.integers(3, 7))))


PROBLEMS: Mapping[str, Callable[[Generator], Problem]] = {
    "damped oscillation": oscillator,
    "lag of the shaft": shaft,
    "stick and release": stick,
    "whirl": whirl,
    "response to an offset": response,
    "thrown ring": free_ring,
    "any motion of a pin": pin,
    "any motion of a ring": ring,
    "any motion of points": points,
}
"""By what they are about."""
