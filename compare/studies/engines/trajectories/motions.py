"""The motions of the study of plain motions: some by hand, and some drawn from all that the studies use.

In the paper's parameters m, J and C are one: an engine that takes one for the other moves as it should. Here no two
parameters are equal, so that each has a part of its own in the motion. A mistake may also be confined to a corner of
the parameters, to a slow disc or to one that turns the other way: so motions are drawn from that whole range.
"""

from __future__ import annotations

import cmath
import functools
import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace

import numpy as np
from numpy.polynomial.legendre import leggauss
from numpy.random import Generator

from compare.claims.paper_parameters import FIG5, FIG5_STARTS
from reference_model import DiscOnDisc, PinOnDisc, simulate
from reference_model.formulas.pin import release_time
from reference_model.systems import FloatArray, System
from reference_model.trajectory import Trajectory

EXACT = 1e-13
"""Tolerance of the reference."""

PANEL = 0.25
"""Length in s of the pieces of time over which forces are integrated."""

NODES, WEIGHTS = leggauss(10)
"""Of Gauss's rule, on (−1, 1): forces are integrated to rounding where no point of the contact comes to rest."""

PIN = PinOnDisc(mass=1.3, stiffness=2.1, damping=0.17, friction_force=0.11, disc_speed=1.9, offset=0.07)

STIFFENING = replace(PIN, hardening=0.4, stop_gap=0.2, stop_stiffness=0.2)

DISC = DiscOnDisc(
    mass=1.3,
    polar_inertia=0.7,
    stiffness=2.1,
    damping=0.4,
    friction_force=0.055,
    disc_speed=1.9,
    offset=0.03,
    contact_radius=0.15,
    shaft_damping=0.02,
    shaft_speed=0.8,
)

SIX = replace(DISC, contact_points=6)

OTHER_WAY = replace(DISC, damping=0.15, disc_speed=-1.9, shaft_speed=-1.6)


@dataclass(frozen=True)
class Motion:
    """Parameters, start, length in s, whether it sticks on its way, resolution in SI units, and where it is from.

    ``tolerance`` is that of the engine.
    """

    system: System
    start: tuple[float, ...]
    until: float
    sticks: bool = False
    tolerance: float = 1e-10
    resolution: float = 1e-7
    source: str = (
        "parameters of which no two are equal, and a start from which nothing sticks, are our choice"
    )


DISC_START = (0.06, 0.01, 0.2, -0.01, 0.02, 0.9)

MOTIONS = {
    "a pin": Motion(PIN, (0.6, 0.1, -0.2, 0.5), 20.0),
    "a pin inside the play of its stop, with the disc turning the other way": Motion(
        replace(PIN, disc_speed=-PIN.disc_speed, stop_gap=1.0, stop_stiffness=0.2),
        (0.6, 0.1, -0.1, -0.6),
        20.0,
    ),
    "a pin on a support that hardens, beyond its stop": Motion(STIFFENING, (0.6, 0.1, -0.2, 0.5), 20.0),
    "a pin that sticks on its way": Motion(
        FIG5,
        FIG5_STARTS["whirl"],
        15.0,
        sticks=True,
        tolerance=1e-9,
        resolution=1e-5,
        source="Fig. 5, second start",
    ),
    "a disc on the continuous ring": Motion(DISC, DISC_START, 20.0),
    "a disc on six points": Motion(SIX, DISC_START, 20.0),
    "a disc on the continuous ring, all turning the other way": Motion(
        OTHER_WAY, (0.3, 0.1, 0.3, 0.05, -0.4, -1.7), 20.0
    ),
}
"""Nowhere but in the pin that sticks does a point of the contact come to rest: there friction has a bend."""


def times_of(motion: Motion) -> FloatArray:
    """Return bounds and Gauss nodes of all panels in their order: each panel begins with a bound."""
    bounds = np.linspace(0.0, motion.until, round(motion.until / PANEL) + 1)
    places = np.concatenate(([0.0], 0.5 + 0.5 * NODES))
    return np.append(bounds[:-1, np.newaxis] + PANEL * places, motion.until)


@functools.cache
def by_reference(motion: Motion) -> Trajectory:
    """Return the motion at ``times_of(motion)`` by the reference at its tightest."""
    return simulate(motion.system, motion.start, times_of(motion), tolerance=EXACT)


# ---------------------------------------------------------------- drawn from the whole range

SEED = 8

SPEEDS = ((0.1, 0.3), (0.4, 3.0), (4.1, 6.0))
"""|ω| in rad/s: slow, as about the natural frequency, and fast. The other studies go from 0.15 to 5."""

UNTIL = 3.0
"""In s."""

LEAST_SLIP = 0.15
"""Of the largest: nothing comes near to rest where forces are integrated."""

MOST_TURN = 2.0
"""Of a disc on points in rad in a ``PANEL``: its forces turn as fast."""

STICKS_FOR = (0.2, 2.0)
"""Time in s for which a pin sticks at the start."""

MOST_PHASES = 6

LEAST_SAMPLES = 4
"""Of a stick phase, so that (7) can be asked in the middle of it."""


def between(random: Generator, low: float, high: float) -> float:
    """Draw from a log-uniform distribution."""
    return float(np.exp(random.uniform(math.log(low), math.log(high))))


def _sign(random: Generator) -> float:
    return float(random.choice((-1.0, 1.0)))


def _pin(random: Generator, disc_speed: float) -> PinOnDisc:
    mass, frequency = between(random, 0.5, 3.0), between(random, 0.7, 1.6)
    stiffness, offset = mass * frequency**2, _sign(random) * between(random, 0.05, 0.2)
    return PinOnDisc(
        mass=mass,
        stiffness=stiffness,
        damping=mass * frequency * between(random, 0.03, 0.3),
        friction_force=stiffness * abs(offset) * between(random, 0.1, 0.9),
        disc_speed=disc_speed,
        offset=offset,
    )


def _stiffening(random: Generator, disc_speed: float) -> PinOnDisc:
    """Draw a support that hardens, and a stop in which a body rolls round that swings out further."""
    pin = _pin(random, disc_speed)
    size = abs(pin.offset)
    return replace(
        pin,
        hardening=pin.stiffness / size**2 * between(random, 0.003, 0.03),
        stop_gap=between(random, 0.03, 0.1),
        stop_stiffness=pin.stiffness * between(random, 0.1, 0.5),
    )


def _disc(random: Generator, disc_speed: float, points: int | None) -> DiscOnDisc:
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
        contact_points=points,
    )


def _sliding(random: Generator, system: System) -> tuple[float, ...]:
    """Draw a start from which the support's spring swings the body round in either sense, not through the middle."""
    w = cmath.rect(between(random, 0.2, 0.6), random.uniform(-math.pi, math.pi))
    z = w + system.offset
    v = _sign(random) * 1j * system.natural_frequency * between(random, 0.7, 1.4) * w
    if not isinstance(system, DiscOnDisc):
        return (z.real, z.imag, v.real, v.imag)
    slip = abs(v - 1j * system.disc_speed * z)
    rim = slip * (between(random, 0.1, 0.5) if random.random() < 0.5 else between(random, 1.5, 3.0))
    spin = system.disc_speed - _sign(random) * rim / system.contact_radius
    return (z.real, z.imag, random.uniform(-math.pi, math.pi), v.real, v.imag, spin)


def _slides(motion: Motion) -> bool:
    """Return whether forces are smooth: all slips, nothing is near to rest, a stop is always touched or never."""
    system, run = motion.system, by_reference(motion)
    speed = run.slip_speed
    if isinstance(system, DiscOnDisc):
        speed = np.abs(speed - system.contact_radius * np.abs(system.disc_speed - run.states[:, 5]))
        if system.contact_points is not None and PANEL * np.max(np.abs(run.states[:, 5])) > MOST_TURN:
            return False
    beyond = np.hypot(run.states[:, 0] - system.offset, run.states[:, 1]) - system.stop_gap
    smooth = len(run.phases) == 1 and np.min(speed) > LEAST_SLIP * np.max(speed)
    return bool(smooth and (np.all(beyond > 0.0) or np.all(beyond < 0.0)))


def _sticking(random: Generator, disc_speed: float) -> PinOnDisc:
    """Draw a pin whose load is about what holds it against the offset."""
    pin = _pin(random, disc_speed)
    return replace(pin, friction_force=pin.stiffness * abs(pin.offset) * between(random, 0.5, 2.0))


def _stuck(random: Generator, pin: System) -> tuple[float, ...]:
    """Draw a start that turns with the disc, where friction may hold the pin by (7), or not."""
    reach = (pin.friction_force + pin.stiffness * abs(pin.offset)) / abs(
        complex(pin.stiffness - pin.mass * pin.disc_speed**2, pin.damping * pin.disc_speed)
    )
    z = cmath.rect(min(reach, 1.0) * random.uniform(0.1, 1.0), random.uniform(-math.pi, math.pi))
    v = 1j * pin.disc_speed * z
    return (z.real, z.imag, v.real, v.imag)


def _sticks(motion: Motion) -> bool:
    """Return whether (7) lets the pin go before long, and it comes to stick again for more than moments if at all."""
    pin, (x, y, *_) = motion.system, motion.start
    if not (
        isinstance(pin, PinOnDisc)
        and STICKS_FOR[0] < release_time(pin, math.hypot(x, y), math.atan2(y, x)) < STICKS_FOR[1]
    ):
        return False
    run = by_reference(motion)
    inside = [np.sum((run.times > p.start) & (run.times < p.end)) for p in run.stick_phases]
    return (
        run.phases[-1].kind == "slip"
        and len(run.phases) <= MOST_PHASES
        and bool(min(inside) >= LEAST_SAMPLES)
    )


@functools.cache
def drawn_motions() -> Mapping[str, tuple[Motion, ...]]:
    """Return motions with random parameters by what moves: of each kind at all ``SPEEDS``, in both senses."""
    return {
        "pins": _six(0, _pin, _sliding),
        "pins on stops": _six(1, _stiffening, _sliding),
        "rings": _six(2, lambda random, speed: _disc(random, speed, None), _sliding),
        "points": _six(3, lambda random, speed: _disc(random, speed, int(random.integers(3, 7))), _sliding),
        # From some draws, wrong engines never come to an end: they would show less than a motion that differs.
        "pins that stick": _six(12, _sticking, _stuck),
    }


def _six(
    kind: int,
    body: Callable[[Generator, float], System],
    start: Callable[[Generator, System], tuple[float, ...]],
) -> tuple[Motion, ...]:
    """Draw one motion for each of ``SPEEDS`` and each sense."""
    random = np.random.default_rng([SEED, kind])
    return tuple(_one(random, body, start, sense, speeds) for speeds in SPEEDS for sense in (1.0, -1.0))


def _one(
    random: Generator,
    body: Callable[[Generator, float], System],
    start: Callable[[Generator, System], tuple[float, ...]],
    sense: float,
    speeds: tuple[float, float],
) -> Motion:
    """Draw until the motion is one that claims can be made for."""
    sticks = start is _stuck
    while True:
        system = body(random, sense * random.uniform(*speeds))
        motion = Motion(
            system,
            start(random, system),
            UNTIL,
            sticks,
            tolerance=1e-9 if sticks else 1e-10,
            resolution=1e-4 if sticks else 1e-7,
            source=f"assumption: parameters and start are random, with seed {SEED}",
        )
        if _sticks(motion) if sticks else _slides(motion):
            return motion
