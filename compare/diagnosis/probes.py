"""Short motions that reveal the friction force, its history, the support and the moment of a disc.

The change of momentum gives the friction force without a friction law or an exact solution. The force on a block that
slides straight on a plane at rest is constant, so any step distinguishes cone, box and pyramid.
"""

from __future__ import annotations

import cmath
import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import simpson

from compare.engines import EVERYWHERE, BadTrajectoryError, Engine, Ranges
from reference_model import simulate
from reference_model.systems import DiscOnDisc, FloatArray, PinOnDisc

PLANE = np.array([1.0, 1j])

HEADINGS = np.radians(np.arange(4.0, 364.0, 15.0))
"""Directions of slip in rad, none equally close to two axes of a polygon with up to 16 sides."""

FRICTION = 0.2  # μN in N for a mass of 1 kg

WEAK = 1e-5
"""Stiffness in N/m for a mass of 1 kg; engines may derive a characteristic speed from it and μN."""

SLIDE = PinOnDisc(mass=1.0, stiffness=WEAK, damping=0.0, friction_force=FRICTION, disc_speed=0.0, offset=0.0)
SPEED = 1.0  # speed of sliding blocks, in m/s

SETTLES_FOR = 0.05
"""Time in s before friction is measured: MuJoCo's soft contact takes 0.04 s to reach its steady force."""

SLIDES_FOR = 0.1
"""Duration in s; friction removes 1/50 of the speed, less than any component across an axis."""

PANELS = 32  # intervals for the integral of friction with a direction that changes
FEWEST_PANELS = 4  # the same at the coarsest rung, where steps may not exceed an interval
CHECKED_FOR = 1.0


def first_check(engine: Engine) -> tuple[tuple[float, float], tuple[float, float]]:
    """Return the distances in m that a sliding and a resting block move, each as measured and exact."""
    sliding, times = (0.0, 0.0, 0.6 * SPEED, 0.8 * SPEED), (0.0, CHECKED_FOR)
    begun, slid = engine.simulate(SLIDE, sliding, times).states
    if not np.allclose(begun, sliding, atol=1e-3):
        shown = begun.round(3).tolist()
        raise BadTrajectoryError(
            f"returned the initial state {shown} for {list(sliding)}: expected x, y, vx, vy"
        )
    exact = simulate(SLIDE, sliding, times, tolerance=1e-12).states[-1]
    moved = engine.simulate(pulled_block(0.5), (0.0,) * 4, times).states[-1]
    return (math.hypot(*slid[:2]), math.hypot(*exact[:2])), (math.hypot(*moved[:2]), 0.0)


# --- Friction force against mass, load, speed, heading and place.

DRAWS, TURNING_DRAWS = 48, 24  # combinations on a plane at rest and on a turntable

MASSES, SPEEDS, DISC_SPEEDS, PLACES = (1e-3, 1e3), (1e-4, 1e2), (1e-2, 1e2), (1e-4, 1.0)
"""Ranges in kg, m/s, rad/s and m."""

REACH = 9.0
"""Largest distance of a probe from the origin in m, because the plate of an engine is finite."""

SPENT = 0.05
"""Largest share of the slip that friction may remove; the probe is repeated with smaller loads."""

WEAKER, MOST_WEAKER = 10.0, 7  # factor of the load between repetitions, and their largest number


@dataclass(frozen=True, eq=False)
class Push:
    """A body that slides, with complex initial position and velocity."""

    system: PinOnDisc
    place: complex
    velocity: complex

    @classmethod
    def of(
        cls, mass: float, load: float, slip: complex, place: complex = 0j, disc_speed: float = 0.0
    ) -> Push:
        """Return a slide with the slip ``slip`` (m/s) at ``place`` (m)."""
        system = replace(SLIDE, mass=mass, stiffness=WEAK * mass, friction_force=load, disc_speed=disc_speed)
        return cls(system, place, slip + 1j * disc_speed * place)

    def within(self, limits: Ranges) -> Push:
        """Return the slide about its place, with lengths, speeds and load so small that it stays within limits.

        The engine's limits and ``REACH`` apply.
        """
        half = 0.5 * (SETTLES_FOR + self.lasts) * self.velocity
        reach = min(REACH, limits.coordinate) / (abs(self.place) + abs(half))
        share = min(1.0, reach, limits.speed / max(abs(self.velocity), 1e-300))
        system = replace(self.system, friction_force=share * self.system.friction_force)
        return Push(system, share * (self.place - half), share * self.velocity)

    @property
    def lasts(self) -> float:
        """Duration of the measurement in s."""
        return SLIDES_FOR / max(1.0, abs(self.system.disc_speed))

    def weaker(self, factor: float) -> Push:
        """Return the same slide with a smaller load."""
        return replace(self, system=replace(self.system, friction_force=self.system.friction_force / factor))

    def times(self, panels: int) -> FloatArray:
        """Return the start in s and the ends of the intervals."""
        panels = panels if self.system.disc_speed else 2
        return np.concatenate(([0.0], SETTLES_FOR + np.linspace(0.0, self.lasts, panels + 1)))

    def free_slip(self, times: FloatArray) -> NDArray[np.complex128]:
        """Return the slip in m/s without friction."""
        return np.asarray(self.velocity - 1j * self.system.disc_speed * (self.place + self.velocity * times))

    @property
    def start(self) -> tuple[float, ...]:
        """Initial state."""
        return (self.place.real, self.place.imag, self.velocity.real, self.velocity.imag)


def headings() -> list[Push]:
    """Return slides in all directions, each across the radius."""
    return [Push.of(1.0, FRICTION, unit * SPEED, 1j * unit) for unit in np.exp(1j * HEADINGS).tolist()]


def draws(turning: bool, limits: Ranges = EVERYWHERE) -> list[Push]:
    """Return slides that fill the ranges of mass, speed, load, heading and place (a Latin hypercube)."""
    masses = max(MASSES[0], limits.mass[0]), min(MASSES[1], limits.mass[1])
    speeds = SPEEDS[0], min(SPEEDS[1], limits.speed)
    number, random = (TURNING_DRAWS if turning else DRAWS), np.random.default_rng(1)
    levels = (np.array([random.permutation(number) for _ in range(7)]) + random.random((7, number))) / number
    found = []
    for mass, speed, load, heading, radius, angle, disc in levels.T.tolist():
        mass, speed = _within(masses, mass), _within(speeds, speed)
        omega = math.copysign(_within(DISC_SPEEDS, disc), heading - 0.5) if turning else 0.0
        distance = speed / abs(omega) * 10.0 ** (radius - 0.5) if turning else _within(PLACES, radius)
        place = cmath.rect(distance, 2.0 * math.pi * angle)
        slip = cmath.rect(speed, HEADINGS[int(heading * len(HEADINGS))])
        push = Push.of(mass, FRICTION * mass * speed * 10.0 ** (-2.0 * load), slip, place, omega)
        found.append(push.within(limits))
    return found


def _within(ends: tuple[float, float], level: float) -> float:
    return float(ends[0] * (ends[1] / ends[0]) ** level)


FORCE, SLIP, RADIAL, CONDITIONS, BEGUN, NOISE, LEFT = (
    slice(0, 2),
    slice(2, 4),
    slice(4, 6),
    slice(6, 11),
    slice(11, 13),
    13,
    14,
)


def slides(
    engine: Engine, pushes: Sequence[Push], tolerance: float, panels: int = FEWEST_PANELS
) -> FloatArray:
    """Return, for each slide, the numbers in the columns above, shape (n, 15).

    They are the mean friction force/μN, the mean directions of slip and position, the conditions (mass, load,
    mean slip speed, disc speed, mean distance from the axis), the initial speed in m/s as given and as measured, the
    error of the force due to the declared precision, and the share of the slip that friction leaves.
    """
    motions = [(push.system, push.start, push.times(panels)) for push in pushes]
    runs = engine.simulate_many(motions, tolerance=tolerance)
    found = []
    for push, run in zip(pushes, runs, strict=True):
        system, times = push.system, run.times[1:]
        z, v = run.states[1:, :2] @ PLANE, run.states[1:, 2:] @ PLANE
        slip = v - 1j * system.disc_speed * z
        impulse = system.mass * (v[-1] - v[0]) + system.stiffness * simpson(z, x=times)
        force = impulse / (system.friction_force * push.lasts)
        mean, radial = (
            simpson(one / np.maximum(np.abs(one), 1e-300), x=times) / push.lasts for one in (slip, z)
        )
        begun = v[0] - force * system.friction_force / system.mass * SETTLES_FOR
        vectors = (part for one in (force, mean, radial) for part in (one.real, one.imag))
        speed, free = abs(push.velocity), push.free_slip(times)
        noise = 3.0 * engine.noise * system.mass * speed / (system.friction_force * push.lasts)
        left = 1.0 - np.max(np.abs(slip - free)) / np.max(np.abs(free))
        mean_slip, distance = np.mean(np.abs(slip)), np.mean(np.abs(z))
        conditions = system.mass, system.friction_force, mean_slip, system.disc_speed, distance
        found.append([*vectors, *conditions, speed, abs(begun), noise, left])
    return np.array(found)


FAR = 100.0  # distance from the axis in m


def far_away(engine: Engine, tolerance: float) -> FloatArray:
    """Return the friction force against a slide at the distance ``FAR``, divided by μN, shape (1,)."""
    ((force, *_),) = slides(engine, [Push.of(SLIDE.mass, FRICTION, SPEED, complex(FAR))], tolerance)
    return np.array([-force])


def unsaturated(engine: Engine, pushes: Sequence[Push], tolerance: float) -> list[Push]:
    """Return the slides with loads so small that friction removes little of the slip."""
    found, saturated = list(pushes), list(range(len(pushes)))
    for _ in range(MOST_WEAKER):
        left = slides(engine, [found[i] for i in saturated], tolerance)[:, LEFT]
        saturated = [i for i, share in zip(saturated, left, strict=True) if share < 1.0 - SPENT]
        for i in saturated:
            found[i] = found[i].weaker(WEAKER)
        if not saturated:
            break
    for i in saturated:  # something other than friction changes the slip
        found[i] = pushes[i]
    return found


# --- History: blocks pulled from rest, at rest after a slide, and released a second time.

PULLS = (0.25, 0.5, 0.75, 0.9)  # loads on blocks that should stick, as fractions of μN

NEARLY, BEYOND = 0.99, (1.001, 1.01, 1.05, 1.2)
"""Load that friction can just hold, and loads that it cannot hold."""

PULLED_FOR = 4.0  # duration in s; the creep speed is measured in the second half

LOOKS = 16


def pulled_block(pull: float) -> PinOnDisc:
    """Return a block under a spring force of ``pull``·μN whose spring is anchored about as far as probes reach.

    The stiffness is the same for all loads near μN, because engines may derive a characteristic speed from it.
    """
    near = min(pull, BEYOND[-1])
    return replace(SLIDE, stiffness=pull / near * FRICTION / REACH, offset=near * REACH)


def pulled(engine: Engine, pulls: Sequence[float], tolerance: float) -> FloatArray:
    """Return mean speed, largest deviation, mean acceleration and middle velocity of pulled blocks, shape (n, 5).

    They refer to the second half of the time, in m/s and m/s², except the last: the distance in m in the first half.
    """
    blocks = [pulled_block(pull) for pull in pulls]
    times = np.concatenate(([0.0], PULLED_FOR * np.linspace(0.5, 1.0, LOOKS + 1)))
    runs = engine.simulate_many([(block, np.zeros(4), times) for block in blocks], tolerance=tolerance)
    found = []
    for run in runs:
        x, v, half = run.states[1:, 0], run.states[1:, 2], times[-1] - times[1]
        mean = (x[-1] - x[0]) / half
        found.append([mean, np.max(np.abs(v - mean)), (v[-1] - v[0]) / half, v[0], abs(x[0])])
    return np.array(found)


SWING = PinOnDisc(mass=1.0, stiffness=4.0, damping=0.0, friction_force=FRICTION, disc_speed=0.0, offset=0.0)
"""A block on a spring; μN stretches the spring by 5 cm."""

SECOND_PULL = 1.03  # load/μN at the second release
RATE = 2.0  # natural frequency of ``SWING`` in rad/s


def second_release(engine: Engine, tolerance: float) -> FloatArray:
    """Return the distance after the second release, divided by the exact distance, and the delay."""
    stretch = FRICTION / SWING.stiffness
    turned, quarter = math.pi / RATE, 0.5 * math.pi / RATE
    start = ((SECOND_PULL + 2.0) * stretch, 0.0, 0.0, 0.0)
    times = (0.0, turned + quarter, 2.5 * turned)
    x = engine.simulate(SWING, start, times, tolerance=tolerance).states[:, 0] / stretch
    swing = SECOND_PULL - 1.0
    return np.array([(x[2] + SECOND_PULL) / (2.0 * swing), -(x[1] + 1.0) / (swing * RATE)])


def at_rest(engine: Engine, tolerance: float) -> float:
    """Return the largest creep speeds in m/s of blocks close to release and at rest after a slide."""
    ((nearly, *_),) = pulled(engine, (NEARLY,), tolerance)
    run = engine.simulate(pulled_block(0.5), (0.0, 0.0, 0.0, 0.2), (0.0, 5.0, 6.0), tolerance=tolerance)
    return float(max(abs(nearly), np.hypot(*(run.states[2, :2] - run.states[1, :2]))))


# --- Lag of friction behind a slip that turns.

TURN = PinOnDisc(mass=1.0, stiffness=WEAK, damping=0.0, friction_force=0.02, disc_speed=1.0, offset=0.0)

TURNS_FOR = 1.0
"""Duration in s; the slip of a pin that leaves the axis radially turns with the disc below."""


def lag(engine: Engine, tolerance: float) -> float:
    """Return the delay in s of the friction direction behind the slip; 0 for Coulomb friction.

    The delay is the missing momentum over the momentum that a shift in time changes, along the direction of this
    change.
    """
    times = SETTLES_FOR + np.linspace(0.0, TURNS_FOR, PANELS + 1)
    run = engine.simulate(TURN, (0.0, 0.0, SPEED, 0.0), np.concatenate(([0.0], times)), tolerance=tolerance)
    states = run.states[1:]
    z, v = states[:, :2] @ PLANE, states[:, 2:] @ PLANE
    slip = v - 1j * TURN.disc_speed * z
    direction = slip / np.abs(slip)
    turning = (np.gradient(np.unwrap(np.angle(slip)), times, edge_order=2)) * 1j * direction
    expected, shifted = (TURN.friction_force * simpson(each, x=times) for each in (direction, turning))
    # m·Δv = −∫C·z − ∫μN·(direction − lag·turning)
    missing = TURN.mass * (v[-1] - v[0]) + WEAK * simpson(z, x=times) + expected
    return float((missing * np.conj(shifted)).real / abs(shifted) ** 2)


# --- The support without friction, and the moment of a disc.

SMOOTH = replace(SLIDE, friction_force=1e-9)  # some engines need friction

SUPPORTS = {
    "spring force": ("stiffness", replace(SMOOTH, stiffness=1.0), (1.0, 0.5, -0.05, 0.1)),
    "damper force": ("damping", replace(SMOOTH, damping=1.0), (0.0, 0.0, 1.0, 0.5)),
    "force of the offset": ("offset", replace(SMOOTH, stiffness=1.0, offset=1.0), (0.0, 0.0, 0.0, 0.1)),
}
"""Parameters, systems and initial states with one acting part of the support; no body starts at rest."""

NONLINEAR = {
    "hardening force": ("hardening", replace(SMOOTH, hardening=1.0), (1.0, 0.5, -0.05, 0.1)),
    "stop force": (
        "stop_stiffness",
        replace(SMOOTH, stop_stiffness=1.0, stop_gap=0.5),
        (1.0, 0.5, -0.05, 0.1),
    ),
}
"""The same for the nonlinear parts."""


LINEAR = 1e-3
"""Largest deviation of a change of velocity that is proportional to the parameter; a damper slows itself."""


def supports(engine: Engine, parts: Mapping[str, Any], tolerance: float) -> FloatArray:
    """Return the factor of the parameter of each of the ``parts`` that explains the change of velocity."""
    times = np.array([0.0, SETTLES_FOR, SLIDES_FOR])
    motions = [(*motion, times) for _, *motion in parts.values()]
    found = []
    settled = _settled(engine, motions, tolerance, 1e-9)
    for (name, system, _), (begun, ended, exact) in zip(parts.values(), settled, strict=True):
        share = factor = _share(ended[2:], exact[2:], begun[2:])
        for _ in range(2 if abs(share - 1.0) > LINEAR and 0.1 < share < 10.0 else 0):
            other = replace(system, **{name: factor * getattr(system, name)})
            end = simulate(other, begun, times[1:], tolerance=1e-9).states[-1]
            expected = _share(end[2:], exact[2:], begun[2:])
            factor += (share - expected) * (factor - 1.0) / (expected - 1.0)
        found.append(factor)
    return np.array(found)


def _settled(
    engine: Engine, motions: Sequence[Any], tolerance: float, exactly: float
) -> Iterator[tuple[FloatArray, FloatArray, FloatArray]]:
    """Yield the states after ``SETTLES_FOR`` and at the end, and the exact end from the first state."""
    runs = engine.simulate_many(motions, tolerance=tolerance)
    for (system, _, times), run in zip(motions, runs, strict=True):
        begun, ended = run.states[1:]
        yield begun, ended, simulate(system, begun, times[1:], tolerance=exactly).states[-1]


def _share(found: FloatArray, exact: FloatArray, start: FloatArray) -> float:
    """Return the component of a change of state along the exact change, divided by it."""
    right = exact - start
    return float((found - start) @ right / (right @ right))


def discs(points: int | None) -> list[tuple[DiscOnDisc, tuple[float, ...], FloatArray]]:
    """Return small and large discs that slide, spin, and slide and spin."""
    found: list[tuple[DiscOnDisc, tuple[float, ...], FloatArray]] = []
    for mass, radius in ((1.0, 0.1), (30.0, 2.0)):
        for slip, spin in ((1.0, 0.0), (0.0, 1.0), (0.6, 0.8)):
            disc = DiscOnDisc(
                mass=mass,
                polar_inertia=mass * radius**2,
                stiffness=WEAK * mass,
                damping=0.0,
                friction_force=FRICTION * mass,
                disc_speed=0.0,
                contact_radius=radius,
                shaft_damping=0.0,
                shaft_speed=0.0,
                contact_points=points,
            )
            heading = cmath.rect(slip * SPEED, 0.3)
            start = (0.0, 0.0, 0.0, heading.real, heading.imag, spin * SPEED / radius)
            found.append((disc, start, np.array([0.0, SETTLES_FOR, SETTLES_FOR + SLIDES_FOR])))
    return found


def moments(engine: Engine, points: int | None, tolerance: float) -> FloatArray:
    """Return force and moment of friction divided by the exact values, shape (6, 2); NaN for missing values."""
    motions, found = discs(points), []
    settled = _settled(engine, motions, tolerance, 1e-12)
    for (_, start, _), (begun, ended, exact) in zip(motions, settled, strict=True):
        force = _share(ended[3:5], exact[3:5], begun[3:5]) if start[3] else math.nan
        found.append([force, (ended[5] - begun[5]) / (exact[5] - begun[5]) if start[5] else math.nan])
    return np.array(found)
