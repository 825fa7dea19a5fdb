"""Parameters, formulas and claims."""

import cmath
import math
from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import ArrayLike
from scipy.special import lambertw

from compare.claims import WORKING, Data, Measured, Measurement, Study, answers_of, asked, refined
from compare.claims.parameters import at_each
from compare.engines import Engine
from compare.studies.toolkit.random_systems import state_of
from reference_model.systems import FloatArray, PinOnDisc

SOURCE = "assumption: a block of 1 kg with friction of 1 N"

BLOCK = PinOnDisc(mass=1.0, stiffness=0.0, damping=0.0, friction_force=1.0, disc_speed=0.0)

FRICTION = BLOCK.friction_force
DECELERATION = FRICTION / BLOCK.mass
"""g in m/s²."""

HEADINGS = (0.0, 22.5, 45.0, 67.5)
"""Headings in degrees: sides, corners and neither of squares and octagons in any orientation."""

SPEED = 1.0
"""v₀ in m/s."""

WHILE_SLIDING = np.array([0.0, 0.5, 0.9])
"""Sample times as shares of the time to rest."""

AT_REST = 1.5
"""Sample time divided by the time to rest, late enough for regularised laws."""

SPRING = replace(BLOCK, stiffness=0.25)
"""A stretch of 4 m pulls with μN, so the pull changes slowly, and the block stays on the plate of an engine."""

LOADS = (0.1, 0.5, 0.9, 0.99)
"""Pulls that friction holds, in units of μN."""

BEYOND = 1.01
"""Pull that exceeds friction, in units of μN."""

HELD = 10.0
"""Duration in s."""

MOVED = (BEYOND - 1.0) * FRICTION / SPRING.stiffness
"""Smallest displacement (m) that counts as motion: half of the slide under ``BEYOND``."""

SWINGING = replace(BLOCK, stiffness=1e4)
RELEASED = 8.5
"""Position in units of μN/C; half swings end at 6.5, 4.5, 2.5 and 0.5, where the block rests."""

SWINGS = 4

DIAGONAL = 45.0
"""Heading in degrees."""

PULL = 1.5
"""Initial pull on a block thrown along it, in units of μN."""

PULLED = np.array([0.0, 1.0, 2.0])

ACROSS = replace(BLOCK, stiffness=1e-6, offset=1e6)
"""The spring pulls a block at the origin with μN along x, constant to about 1e-6."""

TURNING = np.array([0.0, 0.25, 0.5, 1.0, 2.0])
"""Sample times in s; finally the block moves almost along the pull."""


def direction(degrees: float) -> complex:
    return cmath.rect(1.0, math.radians(degrees))


# --- Closed forms, from Newton's law with friction μN; s (m) is the distance along a line, and v = ds/dt

STOPPING_TIME = SPEED / DECELERATION
STOPPING_DISTANCE = 0.5 * SPEED**2 / DECELERATION


def thrown(times: ArrayLike) -> FloatArray:
    """Return s and v under friction alone, shape (n, 2): s = v₀t − gt²/2 until the block rests."""
    t = np.minimum(times, STOPPING_TIME)
    return np.column_stack((SPEED * t - 0.5 * DECELERATION * t**2, SPEED - DECELERATION * t))


def half_swings(pin: PinOnDisc, start: float, times: ArrayLike) -> FloatArray:
    """Return s and v, shape (n, 2), after release at s = ``start`` > f = μN/C from a spring relaxed at 0.

    In half swing n (from 0) the block oscillates like cos kt about (−1)^n·f with the amplitude start − (2n + 1)·f. It
    rests when the next amplitude would not be positive.
    """
    k, f = pin.natural_frequency, pin.friction_force / pin.stiffness
    last = math.ceil(0.5 * (start / f - 1.0))
    t = np.minimum(times, last * math.pi / k)
    n = np.minimum(np.floor(k * t / math.pi), last - 1)
    amplitude = start - (2.0 * n + 1.0) * f
    return np.column_stack(((-1.0) ** n * f + amplitude * np.cos(k * t), -amplitude * k * np.sin(k * t)))


def pulled(pin: PinOnDisc, speed: float, stretch: float, times: ArrayLike) -> FloatArray:
    """Return s and v, shape (n, 2), of a block that slides along the pull of a spring stretched by ``stretch``.

    s = a·(1 − cos kt) + (v₀/k)·sin kt with a = stretch − μN/C.
    """
    k, t = pin.natural_frequency, np.asarray(times, dtype=float)
    a = stretch - pin.friction_force / pin.stiffness
    way = 2.0 * a * np.sin(0.5 * k * t) ** 2 + speed / k * np.sin(k * t)
    return np.column_stack((way, a * k * np.sin(k * t) + speed * np.cos(k * t)))


def across(times: ArrayLike) -> FloatArray:
    """Return the velocity along and across a constant pull μN of a block thrown across it, shape (n, 2).

    Pull and friction change the speed and the velocity along the pull at opposite rates, so their sum is constant.
    With the angle θ between pull and velocity and w = tan²(θ/2), they are v₀(1 ± w)/2, and the velocity across is
    v₀√w. Newton's law becomes w + ln w = 1 − 4gt/v₀.
    """
    w = lambertw(np.exp(1.0 - 4.0 * DECELERATION * np.asarray(times, dtype=float) / SPEED)).real
    return np.column_stack((0.5 * SPEED * (1.0 - w), SPEED * np.sqrt(w)))


def bend_by_spring(times: FloatArray) -> float:
    """Return the largest error (m/s) of ``across`` due to the change of the spring's pull.

    The pull changes by C·r after a distance r ≤ v₀t. Friction is monotone in the slip, so two velocities diverge at
    most at the rate C·r/m.
    """
    return float(0.5 * ACROSS.stiffness / ACROSS.mass * SPEED * times[-1] ** 2)


def curves() -> Data:
    k, length = SWINGING.natural_frequency, FRICTION / SWINGING.stiffness
    swings, times = np.linspace(0.0, SWINGS + 1.0, 401), np.linspace(0.0, 2.0, 201)
    return {
        "half swings": swings,
        "way": half_swings(SWINGING, RELEASED * length, swings * math.pi / k)[:, 0] / length,
        "t": times,
        "velocity": across(times),
    }


STUDY = Study.beside(
    __file__,
    "block",
    source=SOURCE,
    system=BLOCK,
    seconds=1.5,
    quick=True,
    contact=True,
)
STUDY.provides(curves=curves)

IN_SPACE = ("position along in m", "position across in m", "velocity along in m/s", "velocity across in m/s")


def moved(
    engine: Engine,
    pin: PinOnDisc,
    headings: Sequence[float],
    start: tuple[complex, complex],
    times: FloatArray,
) -> Measurement:
    """Return the states after the first of ``times``, along and across each heading, shape (headings, n, 4).

    ``start`` is position and velocity, along + i·across, relative to (X0, 0), where the spring is relaxed.
    """

    def states(tolerance: float) -> FloatArray:
        ways = [direction(heading) for heading in headings]
        runs = engine.simulate_many(
            [(pin, state_of(pin.offset + along * start[0], along * start[1]), times) for along in ways],
            tolerance=tolerance,
        )
        found = []
        for along, run in zip(ways, runs, strict=True):
            seen = run.states[1:]
            place, velocity = seen[:, 0] - pin.offset + 1j * seen[:, 1], seen[:, 2] + 1j * seen[:, 3]
            turned = np.column_stack((place, velocity)) / along
            found.append(np.ascontiguousarray(turned).view(float))
        return np.array(found)

    return refined(states)


def on_a_line(motion: FloatArray, headings: Sequence[float]) -> FloatArray:
    states = np.zeros((len(headings), len(motion), 4))
    states[..., ::2] = motion
    return states


def largest_by_component(found: Measurement) -> FloatArray:
    """Return one error for each component, because single errors may be small by chance."""
    return np.asarray(np.max(found.error, axis=tuple(range(found.error.ndim - 1))))


def along(
    found: Measurement, way: FloatArray, headings: Sequence[float], times: FloatArray, **more: Any
) -> Measured:
    """Compare the states ``found`` with ``way``, s and v of shape (n, 2)."""
    return Measured(
        predicted=on_a_line(way, headings),
        value=found.value,
        error=largest_by_component(found),
        at={"heading in degrees": headings, "t in s": times},
        components=IN_SPACE,
        **more,
    )


@STUDY.claim(
    "A thrown block decelerates at μN/m, straight ahead, whatever its heading",
    unit="m, m/s",
    resolution=1e-6,
    note="s = v₀t − μN·t²/2m.",
)
def slows(engine: Engine, headings: Sequence[float] = HEADINGS) -> Measured:
    times = STOPPING_TIME * WHILE_SLIDING
    found = moved(engine, BLOCK, headings, (0j, SPEED + 0j), times)
    return along(found, thrown(times[1:]), headings, times[1:])


@STUDY.claim(
    "A thrown block stops after mv₀²/2μN, straight ahead, whatever its heading",
    unit="m, m/s",
    resolution=1e-6,
)
def stops(engine: Engine, headings: Sequence[float] = HEADINGS) -> Measured:
    times = STOPPING_TIME * np.array([0.0, AT_REST])
    found = moved(engine, BLOCK, headings, (0j, SPEED + 0j), times)
    rest, stops = np.array([[STOPPING_DISTANCE, 0.0]]), found.value[:, 0, :2]
    return along(found, rest, headings, times[1:], data={"stops": stops})


@STUDY.claim(
    "A pull below μN holds a block permanently, without creep",
    unit="μN/√(mC)",
    resolution=1e-5,
    note=f"Mean speed along and across the pull in {HELD:g} s. Without friction, a spring that pulls with μN would "
    "accelerate the block to the speed μN/√(mC).",
    swept=("stiffness",),
)
def holds(engine: Engine, loads: Sequence[float] = LOADS) -> Measured:
    stretch, rate = FRICTION / SPRING.stiffness, FRICTION / math.sqrt(SPRING.mass * SPRING.stiffness)
    times = np.array([0.0, HELD])
    crept, errors = [], []
    for load in loads:
        found = moved(engine, SPRING, HEADINGS, (-load * stretch + 0j, 0j), times)
        crept.append((found.value[:, 0, :2] - (-load * stretch, 0.0)) / HELD / rate)
        errors.append(largest_by_component(found)[:2] / HELD / rate)
    return Measured(
        predicted=np.zeros_like(crept),
        value=crept,
        error=np.max(errors),
        at={"pull over μN": loads, "heading in degrees": HEADINGS},
        components=("along", "across"),
        system=SPRING,
    )


@STUDY.claim(
    "A pull 1 % above μN moves a block from rest, straight ahead, by the closed form, until it sticks again",
    unit="m, m/s",
    resolution=1e-4,
    note="The block moves as 0.01·μN/C·cos kt with k = √(C/m) for half a swing, about the position where the spring "
    "pulls with μN.",
)
def lets_go(engine: Engine, headings: Sequence[float] = HEADINGS) -> Measured:
    stretch = BEYOND * FRICTION / SPRING.stiffness
    times = np.array([0.0, 0.5, 1.25]) * math.pi / SPRING.natural_frequency
    found = moved(engine, SPRING, headings, (-stretch + 0j, 0j), times)
    way = half_swings(SPRING, stretch, times[1:])
    return along(found, -way, headings, times[1:], system=SPRING)


@STUDY.claim(
    "A pull of 99 % of μN holds a block, and a pull of 101 % moves it, whatever its direction",
    note=f"Has the block moved by more than {100.0 * MOVED:g} cm, half of its slide at 101 %, in {HELD:g} s?"
    f" Directions: {at_each('heading', HEADINGS)} degrees.",
)
def cone(engine: Engine, headings: Sequence[float] = HEADINGS) -> Measured:

    def margins(tolerance: float) -> FloatArray:
        places = [
            -load * FRICTION / SPRING.stiffness * direction(heading)
            for load in (LOADS[-1], BEYOND)
            for heading in headings
        ]
        runs = engine.simulate_many(
            [(SPRING, state_of(place, 0j), [0.0, HELD]) for place in places], tolerance=tolerance
        )
        moved = [abs(complex(*run.at_end[:2]) - place) for run, place in zip(runs, places, strict=True)]
        return np.repeat((-1.0, 1.0), len(headings)) * (np.array(moved) - MOVED)

    return answers_of(*asked(margins, WORKING), system=SPRING)


@STUDY.claim(
    "On a spring, each half swing is shorter by 2μN/C, until the block rests where friction holds it",
    unit="μN/C, k·μN/C",
    resolution=1e-3,
    note="The block starts at 8.5·μN/C at 45 degrees, turns back at 6.5, 4.5 and 2.5, and rests at 0.5·μN/C. Sampled "
    "every quarter of a swing. This is code_aster's test SDND100.",
)
def swings(engine: Engine) -> Measured:
    k, length = SWINGING.natural_frequency, FRICTION / SWINGING.stiffness
    quarters = np.arange(2.0 * SWINGS + 2.0)
    times = np.asarray(0.5 * math.pi / k * quarters)
    found = moved(engine, SWINGING, (DIAGONAL,), (RELEASED * length + 0j, 0j), times)
    unit = length * np.array([1.0, 1.0, k, k])
    way = half_swings(SWINGING, RELEASED * length, times[1:])
    return Measured(
        predicted=on_a_line(way, (DIAGONAL,))[0] / unit,
        value=found.value[0] / unit,
        error=largest_by_component(found) / unit,
        at={"half swing": 0.5 * quarters[1:]},
        components=[name.replace("in m/s", "in k·μN/C").replace("in m", "in μN/C") for name in IN_SPACE],
        system=SWINGING,
        source="code_aster, V5.01.100, SDND100",
        data={"half swings": 0.5 * quarters[1:], "way": found.value[0, :, 0] / length},
    )


@STUDY.claim(
    "A weak distant spring pulls a sliding block straight ahead, by the exact solution of spring and friction",
    unit="m, m/s",
    resolution=1e-4,
    note="s = (P − μN)/C·(1 − cos kt) + v₀/k·sin kt with the initial pull P = 1.5·μN and k = √(C/m).",
)
def pulled_along(engine: Engine, headings: Sequence[float] = HEADINGS) -> Measured:
    stretch = PULL * FRICTION / SPRING.stiffness
    found = moved(engine, SPRING, headings, (-stretch + 0j, SPEED + 0j), PULLED)
    way = pulled(SPRING, SPEED, stretch, PULLED[1:])
    from_start = Measurement(found.value + np.array([stretch, 0.0, 0.0, 0.0]), found.error)
    return along(from_start, way, headings, PULLED[1:], system=SPRING)


@STUDY.claim(
    "A block thrown at right angles to a pull equal to friction slows to half its speed as in the closed form",
    unit="m/s",
    resolution=1e-5,
    note="Velocity along and across the pull, v₀(1 − w)/2 and v₀√w with w + ln w = 1 − 4μN·t/mv₀; the friction turns "
    "with the velocity. Model error: the change of the spring's pull along the path.",
)
def pulled_across(engine: Engine) -> Measured:
    start = state_of(0j, SPEED * 1j)

    def velocities(tolerance: float) -> FloatArray:
        return np.asarray(engine.simulate(ACROSS, start, TURNING, tolerance=tolerance).states[1:, 2:])

    found = refined(velocities)
    return Measured(
        predicted=across(TURNING[1:]),
        value=found.value,
        error=found.largest,
        model=bend_by_spring(TURNING),
        at={"t in s": TURNING[1:]},
        components=("along", "across"),
        system=ACROSS,
        data={"t": TURNING[1:], "velocity": found.value},
    )
