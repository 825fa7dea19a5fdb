"""Random motions from the whole parameter range, redrawn until they suit the claims."""

import cmath
import functools
import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.random import Generator

import compare.studies.engines.trajectories.theory as theory
from compare.claims import WORKING
from compare.studies.engines.trajectories.theory import Motion, by_reference
from compare.studies.toolkit.pins import farthest
from compare.studies.toolkit.random_systems import between, sign
from reference_model import DiscOnDisc, PinOnDisc
from reference_model.formulas.pin import release_time
from reference_model.systems import System


def _pin(random: Generator, disc_speed: float) -> PinOnDisc:
    mass, frequency = between(random, 0.5, 3.0), between(random, 0.7, 1.6)
    stiffness, offset = mass * frequency**2, sign(random) * between(random, 0.05, 0.2)
    return PinOnDisc(
        mass=mass,
        stiffness=stiffness,
        damping=mass * frequency * between(random, 0.03, 0.3),
        friction_force=stiffness * abs(offset) * between(random, 0.1, 0.9),
        disc_speed=disc_speed,
        offset=offset,
    )


def _stiffening(random: Generator, disc_speed: float) -> PinOnDisc:
    pin = _pin(random, disc_speed)
    size = abs(pin.offset)
    return replace(
        pin,
        hardening=pin.stiffness / size**2 * between(random, 0.003, 0.03),
        stop_gap=between(random, 0.03, 0.1),
        stop_stiffness=pin.stiffness * between(random, 0.1, 0.5),
    )


def _ring(random: Generator, disc_speed: float) -> DiscOnDisc:
    pin = _pin(random, disc_speed)
    radius = between(random, 0.15, 0.5)
    inertia = pin.mass * radius**2 * between(random, 0.5, 3.0)
    return DiscOnDisc(
        mass=pin.mass,
        polar_inertia=inertia,
        stiffness=pin.stiffness,
        damping=pin.damping,
        friction_force=pin.friction_force,
        disc_speed=disc_speed,
        offset=pin.offset,
        contact_radius=radius,
        shaft_damping=inertia * pin.natural_frequency * between(random, 0.03, 0.3),
        shaft_speed=disc_speed * random.uniform(-1.0, 2.0),
    )


def _on_points(random: Generator, disc_speed: float) -> DiscOnDisc:
    points = int(random.integers(3, 7))
    return replace(_ring(random, disc_speed), contact_points=points)


def _sliding(random: Generator, system: System) -> tuple[float, ...]:
    """Draw a start that makes the body circle the support's centre on its spring, in either sense."""
    w = cmath.rect(between(random, 0.2, 0.6), random.uniform(-math.pi, math.pi))
    z = w + system.offset
    v = sign(random) * 1j * system.natural_frequency * between(random, 0.7, 1.4) * w
    if not isinstance(system, DiscOnDisc):
        return (z.real, z.imag, v.real, v.imag)
    slip = abs(v - 1j * system.disc_speed * z)
    rim = slip * (between(random, 0.1, 0.5) if random.random() < 0.5 else between(random, 1.5, 3.0))
    spin = system.disc_speed - sign(random) * rim / system.contact_radius
    return (z.real, z.imag, random.uniform(-math.pi, math.pi), v.real, v.imag, spin)


def _slides(motion: Motion) -> bool:
    """Return whether forces are smooth: everything slips clearly, and the stop is touched always or never."""
    system, run = motion.system, by_reference(motion)
    speed = run.slip_speed
    if isinstance(system, DiscOnDisc):
        speed = np.abs(speed - system.contact_radius * np.abs(system.disc_speed - run.states[:, 5]))
        turn = theory.PANEL * np.max(np.abs(run.states[:, 5]))
        if system.contact_points is not None and turn > theory.MOST_TURN:
            return False
    beyond = np.hypot(run.states[:, 0] - system.offset, run.states[:, 1]) - system.stop_gap
    smooth = len(run.phases) == 1 and np.min(speed) > theory.LEAST_SLIP * np.max(speed)
    return bool(smooth and (np.all(beyond > 0.0) or np.all(beyond < 0.0)))


def _sticking(random: Generator, disc_speed: float) -> PinOnDisc:
    pin = _pin(random, disc_speed)
    return replace(pin, friction_force=pin.stiffness * abs(pin.offset) * between(random, 0.5, 2.0))


def _stuck(random: Generator, pin: PinOnDisc) -> tuple[float, ...]:
    z = cmath.rect(min(farthest(pin), 1.0) * random.uniform(0.1, 1.0), random.uniform(-math.pi, math.pi))
    v = 1j * pin.disc_speed * z
    return (z.real, z.imag, v.real, v.imag)


def _sticks(motion: Motion) -> bool:
    """Return whether (7) releases the pin soon, and any later stick phases are long enough."""
    pin, (x, y, *_) = motion.system, motion.start
    if not (
        isinstance(pin, PinOnDisc)
        and theory.STICKS_FOR[0]
        < release_time(pin, math.hypot(x, y), math.atan2(y, x))
        < theory.STICKS_FOR[1]
    ):
        return False
    run = by_reference(motion)
    inside = [np.sum((run.times > p.start) & (run.times < p.end)) for p in run.stick_phases]
    return (
        run.phases[-1].kind == "slip"
        and len(run.phases) <= theory.MOST_PHASES
        and bool(min(inside) >= theory.LEAST_SAMPLES)
    )


@dataclass(frozen=True)
class Drawn:
    """Random motions of one kind, drawn on demand: at all ``SPEEDS``, in both senses.

    ``number`` is part of the seed.
    """

    number: int
    body: Callable[[Generator, float], System]
    start: Callable[[Generator, Any], tuple[float, ...]]

    def __iter__(self) -> Iterator[Motion]:
        return iter(self._motions)

    @functools.cached_property
    def _motions(self) -> tuple[Motion, ...]:
        random = np.random.default_rng([theory.SEED, self.number])
        return tuple(self._one(random, sense, speeds) for speeds in theory.SPEEDS for sense in (1.0, -1.0))

    def _one(self, random: Generator, sense: float, speeds: tuple[float, float]) -> Motion:
        sticks = self.start is _stuck
        while True:
            system = self.body(random, sense * random.uniform(*speeds))
            motion = Motion(
                system,
                self.start(random, system),
                theory.UNTIL,
                sticks,
                tolerance=WORKING if sticks else WORKING / 10,
                resolution=1e-8 if sticks else 1e-9,
                source=f"assumption: parameters and start are random, with seed {theory.SEED}",
            )
            if _sticks(motion) if sticks else _slides(motion):
                return motion


DRAWN = {
    "pins": Drawn(0, _pin, _sliding),
    "pins on stops": Drawn(1, _stiffening, _sliding),
    "rings": Drawn(2, _ring, _sliding),
    "points": Drawn(3, _on_points, _sliding),
    # Other numbers may draw motions that wrong engines never finish, which shows less than a deviation.
    "pins that stick": Drawn(12, _sticking, _stuck),
}
