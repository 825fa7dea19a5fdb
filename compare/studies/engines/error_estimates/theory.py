"""Random motions with an exact solution, or solved by the reference at a far tighter tolerance."""

import cmath
import functools
import math
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, replace

import numpy as np
from numpy.random import Generator
from numpy.typing import NDArray

from compare.claims import TRUTH, refined
from compare.engines import Engine
from compare.studies.toolkit.free_bodies import Slowing, on_a_table
from compare.studies.toolkit.pins import farthest
from compare.studies.toolkit.random_systems import (
    any_disc,
    any_pin,
    any_start,
    between,
    sign,
    state_of,
    vector,
)
from reference_model import simulate
from reference_model.formulas.pin import (
    first_order_whirl_response,
    release_time,
    whirl_frequency,
    whirl_radius,
)
from reference_model.systems import FloatArray, System
from reference_model.trajectory import Trajectory

MOTIONS = 360
"""Motions per engine, shared equally by the kinds of problem that it can simulate."""

TOLERANCES = (1e-7, 1e-5)

SEED = 20

LEAST_COVERAGE, MOST_OVER_ESTIMATE = 0.99, 30.0
"""Requirements for each kind of motion."""

SOURCE = (
    f"assumption: parameters, starts, times and tolerances (from {TOLERANCES[0]:g} to {TOLERANCES[1]:g}) "
    "are random"
)

FRICTIONLESS = ("damped oscillation", "lag of the shaft")
"""Kinds of problem without friction."""

KNOWN = 4.0 * np.finfo(float).eps
"""Rounding error of an exact motion, relative to its largest number; a smaller error occurs only by chance."""

EXACT = 100.0 * TRUTH
"""Tolerance of the reference, a thousandth of the smallest tolerance of a motion."""

SMALL_OFFSET = 1e-7
"""X0/ρ_c in the response. Terms of second order are smaller by this factor, and errors are ~ tolerance/X0."""

SAMPLES = 16
"""Samples per turn of the whirl; their mean is exact for both harmonics."""

THROWS = ((0.7, 20.0), (0.8, 60.0), (1.3, 50.0), (1.5, 15.0))
"""J/(mR²) of the thrown rings, and the initial atan(W/U) in degrees.

J/(mR²) is not 1, because the integrals then end like exp(−A/t), with errors of 1e-11 instead of 1e-13.
"""


# --- Calibration of error estimates with true errors


@dataclass(frozen=True, eq=False)
class Problem:
    """A motion with numbers whose ``exact`` values are known, shape (m,).

    ``quantity`` returns the numbers of a trajectory, or fewer if some are missing.
    """

    system: System
    start: FloatArray
    times: FloatArray
    quantity: Callable[[Trajectory], FloatArray]
    exact: FloatArray

    def measured(self, engine: Engine, tolerance: float) -> FloatArray:
        """Return the numbers from ``engine``, shape (m,), all NaN if one is missing."""
        found = self.quantity(engine.simulate(self.system, self.start, self.times, tolerance=tolerance))
        return found if found.shape == self.exact.shape else np.full(self.exact.shape, math.nan)


@dataclass(frozen=True, eq=False)
class Calibration:
    """True and estimated errors of n numbers, relative to the largest number of their ``motion`` (from 0).

    They are NaN if the engine did not provide the number.
    """

    motion: NDArray[np.int_]
    errors: FloatArray
    estimates: FloatArray

    @property
    def motions(self) -> int:
        """Number of motions."""
        return int(self.motion[-1]) + 1

    @functools.cached_property
    def _covered(self) -> FloatArray:
        within = np.bincount(self.motion, self.errors <= self.estimates)  # False for NaN
        return np.asarray(within / np.bincount(self.motion))

    @property
    def coverage(self) -> float:
        """Share of numbers whose true error lies within the estimate; all motions have equal weight."""
        return float(np.mean(self._covered))

    @property
    def coverage_noise(self) -> float:
        """Standard error of the coverage as a mean over motions, whose numbers are correlated."""
        return float(np.std(self._covered, ddof=1) / math.sqrt(self.motions))

    @property
    def ratios(self) -> FloatArray:
        """Ratios of estimates to true errors, at least ``KNOWN``, shape (n,); 0 for a missing number."""
        ratios = self.estimates / np.maximum(self.errors, KNOWN)
        return np.where(np.isnan(ratios), 0.0, ratios)

    @property
    def over_estimate(self) -> float:
        """Median ratio of estimate to true error."""
        return float(np.median(self.ratios))


def calibrated(engine: Engine, problems: Iterable[tuple[Problem, float]]) -> Calibration:
    motion, errors, estimates = [], [], []
    for i, (problem, tolerance) in enumerate(problems):
        measured, estimate = refined(functools.partial(problem.measured, engine), tolerance)
        scale = np.max(np.abs(problem.exact))
        motion.append(np.full(measured.shape, i))
        errors.append(np.abs(measured - problem.exact) / scale)
        estimates.append(estimate / scale)
    return Calibration(np.concatenate(motion), np.concatenate(errors), np.concatenate(estimates))


# --- Random motions with an exact solution


def _at_end(trajectory: Trajectory) -> FloatArray:
    return trajectory.at_end


def _duration(random: Generator, system: System) -> float:
    return between(random, 2.0 * math.pi, 4.0 * math.pi) / system.natural_frequency


def _damped(system: System, start: complex, velocity: complex, t: float) -> tuple[complex, complex]:
    decay = system.damping / (2.0 * system.mass)
    own = cmath.sqrt(complex(system.natural_frequency**2 - decay**2))
    w = start - system.offset
    slope = (velocity + decay * w) / own
    c, s, fade = cmath.cos(own * t), cmath.sin(own * t), math.exp(-decay * t)
    place = fade * (w * c + slope * s)
    return place + system.offset, -decay * place + fade * own * (slope * c - w * s)


def oscillator(random: Generator) -> Problem:
    pin = replace(any_pin(random), friction_force=0.0)
    place = vector(random, abs(pin.offset))
    velocity = vector(random, abs(pin.offset) * pin.natural_frequency)
    t = _duration(random, pin)
    exact = state_of(*_damped(pin, place, velocity, t))
    return Problem(pin, state_of(place, velocity), np.array([0.0, t]), _at_end, exact)


def shaft(random: Generator) -> Problem:
    """Draw a disc without friction, whose spin follows the shaft with a lag."""
    disc = replace(any_disc(random, None), friction_force=0.0)
    place = vector(random, abs(disc.offset))
    velocity = vector(random, abs(disc.offset) * disc.natural_frequency)
    lag, t = disc.polar_inertia / disc.shaft_damping, _duration(random, disc)
    spin = disc.disc_speed * random.uniform(-1.0, 2.0)
    away = spin - disc.shaft_speed
    exact = state_of(
        *_damped(disc, place, velocity, t),
        angle=disc.shaft_speed * t - away * lag * math.expm1(-t / lag),
        spin=disc.shaft_speed + away * math.exp(-t / lag),
    )
    return Problem(disc, state_of(place, velocity, spin=spin), np.array([0.0, t]), _at_end, exact)


def stick(random: Generator) -> Problem:
    """Draw a pin that turns with the disc until its release by (7): a state before it, and the time of release."""
    while True:
        pin = any_pin(random)
        place = cmath.rect(farthest(pin) * random.uniform(0.1, 1.0), random.uniform(-math.pi, math.pi))
        delay = release_time(pin, abs(place), cmath.phase(place))
        if 0.05 < delay * abs(pin.disc_speed) < math.inf:
            break
    turned = place * cmath.exp(0.5j * pin.disc_speed * delay)
    turning = 1j * pin.disc_speed
    return Problem(
        pin,
        state_of(place, turning * place),
        np.array([0.0, 0.5 * delay, 1.3 * delay]),
        _on_the_way_and_release,
        np.append(state_of(turned, 1j * turned) / abs(place), delay * pin.disc_speed),
    )


def _on_the_way_and_release(trajectory: Trajectory) -> FloatArray:
    """Return position, velocity and release time in units of the radius and the disc speed.

    In metres and seconds, the rounding of the time would exceed the errors of the positions.
    """
    omega, start = trajectory.system.disc_speed, trajectory.states[0]
    state = trajectory.states[1] / math.hypot(start[0], start[1]) / (1.0, 1.0, omega, omega)
    return np.append(state, omega * trajectory.stick_times[1:2])


def whirl(random: Generator) -> Problem:
    pin = replace(any_pin(random), offset=0.0)
    turning, t = 1j * whirl_frequency(pin), _duration(random, pin)
    place = cmath.rect(whirl_radius(pin), random.uniform(-math.pi, math.pi))
    end = place * cmath.exp(turning * t)
    start, exact = state_of(place, turning * place), state_of(end, turning * end)
    return Problem(pin, start, np.array([0.0, t]), _at_end, exact)


def response(random: Generator) -> Problem:
    """Draw a whirl with a small offset; its mean divided by the offset is the exact first-order response."""
    pin = any_pin(random)
    pin = replace(pin, offset=SMALL_OFFSET * whirl_radius(pin))
    found, turning = first_order_whirl_response(pin), 1j * whirl_frequency(pin)
    place = whirl_radius(pin) + found.mean + found.second_harmonic
    velocity = turning * (whirl_radius(pin) + 2.0 * found.second_harmonic)
    turn = math.tau / pin.natural_frequency
    return Problem(
        pin,
        state_of(place, velocity),
        turn * np.arange(SAMPLES + 1) / SAMPLES,
        _mean_over_offset,
        np.array([found.mean.real, found.mean.imag]) / pin.offset,
    )


def _mean_over_offset(trajectory: Trajectory) -> FloatArray:
    return np.asarray(np.mean(trajectory.states[1:, :2], axis=0) / trajectory.system.offset)


def free_ring(random: Generator) -> Problem:
    """Draw a ring thrown on a table: the distances that it slides and turns, and the time of rest."""
    inertia, degrees = THROWS[int(random.integers(len(THROWS)))]
    time, slid, turned = _unit_stop(inertia, degrees)
    mass, radius = between(random, 0.1, 10.0), between(random, 0.03, 1.0)
    speed, deceleration = between(random, 0.1, 3.0), between(random, 0.1, 3.0)
    angle, sense = math.radians(degrees), sign(random)
    heading = cmath.rect(1.0, random.uniform(-math.pi, math.pi))
    rest, way = time * speed / deceleration, speed**2 / deceleration
    end = slid * way * heading
    return Problem(
        on_a_table(mass, inertia, radius, mass * deceleration),
        state_of(0j, speed * math.cos(angle) * heading, spin=sense * speed * math.sin(angle) / radius),
        np.array([0.0, 1.1 * rest]),
        _place_and_time_of_rest,
        np.array([end.real, end.imag, sense * turned * way / radius, rest]),
    )


@functools.cache
def _unit_stop(inertia: float, degrees: float) -> tuple[float, float, float]:
    """Return time and distances to rest for √(U² + W²) = 1 m/s and μN/m = 1 m/s²."""
    angle = math.radians(degrees)
    return Slowing(inertia).stop(math.cos(angle), math.sin(angle))[:3]


def _place_and_time_of_rest(trajectory: Trajectory) -> FloatArray:
    return np.append(trajectory.at_end[:3], trajectory.stick_times[-2:-1])


def _generic(random: Generator, system: System) -> Problem:
    start, times = any_start(random, system), np.array([0.0, _duration(random, system)])
    return Problem(system, start, times, _at_end, simulate(system, start, times, tolerance=EXACT).at_end)


def pin(random: Generator) -> Problem:
    return _generic(random, any_pin(random))


def ring(random: Generator) -> Problem:
    return _generic(random, any_disc(random, None))


def points(random: Generator) -> Problem:
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
