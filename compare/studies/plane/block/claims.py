"""A block on a plane at rest: thrown, held, let go, on a spring, and pulled."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np

from compare.claims.error_estimates import WORKING, Measurement, refined
from compare.claims.measured import Measured, answers_of, asked
from compare.claims.parameters import at_each
from compare.claims.study import Study
from compare.engines import Engine
from compare.studies.plane.block.parameters import (
    ACROSS,
    AFAR,
    AT_REST,
    BEYOND,
    BLOCK,
    DIAGONAL,
    FRICTION,
    HEADINGS,
    HELD,
    LOADS,
    MOVED,
    PULL,
    PULLED,
    RELEASED,
    SOURCE,
    SPEED,
    SPRING,
    SWINGING,
    SWINGS,
    TURNING,
    WHILE_SLIDING,
    direction,
    state_of,
)
from compare.studies.plane.block.pictures import draw
from compare.studies.plane.block.theory import (
    STOPPING_DISTANCE,
    STOPPING_TIME,
    across,
    bend_by_spring,
    curves,
    half_swings,
    pulled,
    thrown,
)
from reference_model.systems import FloatArray, PinOnDisc

STUDY = Study.beside(
    __file__,
    "block",
    source=SOURCE,
    system=BLOCK,
    seconds=1.5,
    quick=True,
    contact=True,
)
STUDY.provides(figures=draw, curves=curves)

IN_SPACE = ("place along in m", "place across in m", "velocity along in m/s", "velocity across in m/s")


def moved(
    engine: Engine,
    pin: PinOnDisc,
    headings: Sequence[float],
    start: tuple[complex, complex],
    times: FloatArray,
) -> Measurement:
    """Return the states at ``times`` but the first, seen along and across each heading, shape (headings, n, 4).

    ``start`` is place and velocity as seen that way; places are from (X0, 0), where the spring is relaxed.
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
    """Return the states of s and v, shape (n, 2), along each heading: nothing moves across, (headings, n, 4)."""
    states = np.zeros((len(headings), len(motion), 4))
    states[..., ::2] = motion
    return states


def largest_by_component(found: Measurement) -> FloatArray:
    """Return the largest error of each component of a state: a single number may be right by chance."""
    return np.asarray(np.max(found.error, axis=tuple(range(found.error.ndim - 1))))


def along(
    found: Measurement, way: FloatArray, headings: Sequence[float], times: FloatArray, **more: Any
) -> Measured:
    """Return states ``found`` beside ``way``, s and v at ``times`` (n, 2), along headings; ``more`` of Measured."""
    return Measured(
        predicted=on_a_line(way, headings),
        value=found.value,
        error=largest_by_component(found),
        at={"heading in degrees": headings, "t in s": times},
        components=IN_SPACE,
        **more,
    )


@STUDY.claim(
    "A thrown block is slowed down by μN/m, straight ahead, whatever its heading",
    unit="m, m/s",
    resolution=1e-6,
    note="s = v₀t − μN·t²/2m.",
)
def slows(engine: Engine, headings: Sequence[float] = HEADINGS) -> Measured:
    """Follow throws up to nine tenths of the time in which they stop."""
    times = STOPPING_TIME * WHILE_SLIDING
    found = moved(engine, BLOCK, headings, (0j, SPEED + 0j), times)
    return along(found, thrown(times[1:]), headings, times[1:])


@STUDY.claim(
    "A thrown block stops after mv₀²/2μN, straight ahead, whatever its heading",
    unit="m, m/s",
    resolution=1e-6,
)
def stops(engine: Engine, headings: Sequence[float] = HEADINGS) -> Measured:
    """Look at throws when they rest."""
    times = STOPPING_TIME * np.array([0.0, AT_REST])
    found = moved(engine, BLOCK, headings, (0j, SPEED + 0j), times)
    rest, stops = np.array([[STOPPING_DISTANCE, 0.0]]), found.value[:, 0, :2]
    return along(found, rest, headings, times[1:], data={"stops": stops})


@STUDY.claim(
    "A pull below μN holds a block for ever: it does not creep",
    unit="μN/√(mC)",
    resolution=1e-5,
    note=f"Mean speed along and across the pull in {HELD:g} s; without friction a spring that pulls with μN would "
    "bring the block to the speed μN/√(mC).",
    swept=("stiffness",),
)
def holds(engine: Engine, loads: Sequence[float] = LOADS) -> Measured:
    """Leave a block on a stretched spring alone."""
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
    "A pull 1 % beyond μN moves a block from rest, straight ahead, by the closed form, until it is held again",
    unit="m, m/s",
    resolution=1e-4,
    note="About the place at which the spring pulls with μN it moves as 0.01·μN/C·cos kt, k = √(C/m), for half a "
    "swing.",
)
def lets_go(engine: Engine, headings: Sequence[float] = HEADINGS) -> Measured:
    """Look at a block that is let go in the middle of its way, and when it is held again."""
    stretch = BEYOND * FRICTION / SPRING.stiffness
    times = np.array([0.0, 0.5, 1.25]) * math.pi / SPRING.natural_frequency
    found = moved(engine, SPRING, headings, (-stretch + 0j, 0j), times)
    way = half_swings(SPRING, stretch, times[1:])
    return along(found, -way, headings, times[1:], system=SPRING)


@STUDY.claim(
    "A pull of 99 % of μN holds a block, and one of 101 % moves it, whatever its direction",
    note=f"Whether it has moved by less than {100.0 * MOVED:g} cm in {HELD:g} s, then whether by more: half of how "
    f"far it slides at 101 %; {at_each('heading', HEADINGS)} degrees.",
)
def cone(engine: Engine, headings: Sequence[float] = HEADINGS) -> Measured:
    """Ask on which side of the cone a block is, at eight places beside it."""

    def margins(tolerance: float) -> FloatArray:
        places = [
            -load * FRICTION / SPRING.stiffness * direction(heading)
            for load in (LOADS[-1], BEYOND)
            for heading in headings
        ]
        runs = engine.simulate_many(
            [(SPRING, state_of(place), [0.0, HELD]) for place in places], tolerance=tolerance
        )
        moved = [abs(complex(*run.at_end[:2]) - place) for run, place in zip(runs, places, strict=True)]
        return np.repeat((-1.0, 1.0), len(headings)) * (np.array(moved) - MOVED)

    return answers_of(*asked(margins, WORKING), system=SPRING)


@STUDY.claim(
    "On a spring each half swing is shorter by 2μN/C, until the block rests where friction holds it",
    unit="μN/C, k·μN/C",
    resolution=1e-3,
    note="Let go at 8.5·μN/C, at 45 degrees: it turns at 6.5, 4.5 and 2.5, and rests at 0.5·μN/C. Looked at each "
    "quarter of a swing.",
)
def swings(engine: Engine) -> Measured:
    """Follow a block on a stiff spring to rest, and a little on."""
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
        data={"half swings": 0.5 * quarters[1:], "way": found.value[0, :, 0] / length},
    )


@STUDY.claim(
    "A weak spring from afar pulls a sliding block straight ahead, by the exact solution of spring and friction",
    unit="m, m/s",
    resolution=1e-4,
    note="s = (P − μN)/C·(1 − cos kt) + v₀/k·sin kt with the pull P = 1.5·μN at the start, k = √(C/m): it speeds up "
    "evenly to within a hundredth.",
)
def pulled_along(engine: Engine, headings: Sequence[float] = HEADINGS) -> Measured:
    """Throw a block along the pull."""
    stretch = PULL * FRICTION / AFAR.stiffness
    found = moved(engine, AFAR, headings, (-stretch + 0j, SPEED + 0j), PULLED)
    way = pulled(AFAR, SPEED, stretch, PULLED[1:])
    from_start = Measurement(found.value + np.array([stretch, 0.0, 0.0, 0.0]), found.error)
    return along(from_start, way, headings, PULLED[1:], system=AFAR)


@STUDY.claim(
    "Thrown across a pull equal to friction, a block comes down to half its speed, by the closed form",
    unit="m/s",
    resolution=1e-5,
    note="Velocity along and across the pull, v₀(1 − w)/2 and v₀√w with w + ln w = 1 − 4μN·t/mv₀: the friction turns "
    "with the velocity. Model error: what the spring's pull changes on the way.",
)
def pulled_across(engine: Engine) -> Measured:
    """Throw a block along y, which is pulled along x."""
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
