"""Parameters, formulas and claims."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from compare.claims import Data, Measured, Measurement, Study, refined
from compare.claims.parameters import components_of
from compare.claims.prose import Table
from compare.diagnosis.row import Row
from compare.diagnosis.run import row_of
from compare.engines import Engine
from compare.foreign import Recording, recordings
from compare.report.numbers import error_text
from compare.studies.toolkit.measuring import recorded_cells
from reference_model import FrictionJoint
from reference_model.systems import FloatArray

SOURCE = "assumption: a joint of 0.5 kg m² with friction of 2 N m"

JOINT = FrictionJoint(inertia=0.5, friction_moment=2.0)
FRICTION, DECELERATION = JOINT.friction_moment, JOINT.friction_moment / JOINT.inertia
"""F in N m, and F/J in rad/s²."""

SPEED = 2.0
"""Initial spin ω₀ in rad/s."""

STOPPING_TIME, STOPPING_ANGLE = SPEED / DECELERATION, 0.5 * SPEED**2 / DECELERATION
WHILE_TURNING = np.array([0.0, 0.5, 0.9, 1.5, 3.0])
"""Sample times in units of the time to rest."""

LOADS, HELD = (0.1, 0.5, 0.9, 0.99), 4.0
"""Moments that friction holds in units of F, and their duration in s."""

RATIO, RAMP = 1.5, 4.0
"""Static ratio, and growth of the moment in N m/s."""

BREAKS = RATIO * FRICTION / RAMP
"""Time of the breakaway in s."""

RAMPED = np.array([0.0, 0.9, 1.1, 1.5, 2.0]) * BREAKS
STATIC = replace(JOINT, static_ratio=RATIO, moment=((0.0, 0.0), (3.0 * BREAKS, 3.0 * BREAKS * RAMP)))

SPRUNG, RELEASED, SWINGS = replace(JOINT, stiffness=20.0), 8.5, 4
"""Joint on a spring, its first angle in units of F/C, and its half swings; it rests at 0.5·F/C."""

BACK = 3.0
"""Moment in units of F against the spin."""

TURNED = replace(JOINT, moment=((0.0, -BACK * FRICTION),))
AT = np.array([0.0, 0.5, 1.5, 3.0]) * SPEED / ((BACK + 1.0) * DECELERATION)


# --- Closed forms: angle and spin, shape (n, 2)


def stopped(times: ArrayLike) -> FloatArray:
    """Return φ = ω₀t − F·t²/2J until the joint rests."""
    t = np.minimum(times, STOPPING_TIME)
    return np.column_stack((SPEED * t - 0.5 * DECELERATION * t**2, SPEED - DECELERATION * t))


def broken_away(times: ArrayLike) -> FloatArray:
    """Return rest until the moment is r·F, then J·φ̈ = (r − 1)·F + q·τ."""
    t = np.maximum(np.asarray(times, dtype=float) - BREAKS, 0.0)
    first, growth = (RATIO - 1.0) * DECELERATION, RAMP / JOINT.inertia
    return np.column_stack((first * t**2 / 2.0 + growth * t**3 / 6.0, first * t + growth * t**2 / 2.0))


def swung(times: ArrayLike) -> FloatArray:
    """Return half swings n like cos kt about (−1)ⁿ·F/C, each shorter by 2F/C, until the joint rests."""
    k, f = math.sqrt(SPRUNG.stiffness / SPRUNG.inertia), FRICTION / SPRUNG.stiffness
    t = np.minimum(times, SWINGS * math.pi / k)
    n = np.minimum(np.floor(k * t / math.pi), SWINGS - 1)
    size = (RELEASED - (2.0 * n + 1.0)) * f
    return np.column_stack(((-1.0) ** n * f + size * np.cos(k * t), -size * k * np.sin(k * t)))


def turned_back(times: ArrayLike) -> FloatArray:
    """Return the motion under −M, slowed down by M + F, then accelerated back by M − F."""
    t = np.asarray(times, dtype=float)
    slows, gains = (BACK + 1.0) * DECELERATION, (BACK - 1.0) * DECELERATION
    stop = SPEED / slows
    on, back = np.minimum(t, stop), np.maximum(t - stop, 0.0)
    return np.column_stack(
        (SPEED * on - 0.5 * slows * on**2 - 0.5 * gains * back**2, SPEED - slows * on - gains * back)
    )


def curves() -> Data:
    t, ramp = np.linspace(0.0, WHILE_TURNING[-1] * STOPPING_TIME, 121), np.linspace(0.0, RAMPED[-1], 121)
    swings = np.linspace(0.0, SWINGS + 1.0, 401)
    turn = math.pi * math.sqrt(SPRUNG.inertia / SPRUNG.stiffness)
    return {
        "stop t": t,
        "stop": stopped(t)[:, 1],
        "ramp": RAMP * ramp / FRICTION,
        "broken away": broken_away(ramp)[:, 1],
        "half swings": swings,
        "way": swung(swings * turn)[:, 0] * SPRUNG.stiffness / FRICTION,
    }


STUDY = Study.beside(__file__, "joints", source=SOURCE, seconds=5.0, quick=True, contact=True)
STUDY.provides(curves=curves)


def moved(engine: Engine, joint: FrictionJoint, start: Sequence[float], times: FloatArray) -> Measurement:
    """Return angle and spin after the first of ``times``, shape (n, 2)."""

    def states(tolerance: float) -> FloatArray:
        return np.asarray(engine.simulate(joint, start, times, tolerance=tolerance).states[1:])

    return refined(states)


def compared(
    found: Measurement, expected: FloatArray, joint: FrictionJoint, times: FloatArray, data: Data
) -> Measured:
    """Compare angle and spin with a closed form."""
    return Measured(
        predicted=expected,
        value=found.value,
        error=np.max(found.error, axis=0),  # single errors may be small by chance
        at={"t in s": times[1:]},
        components=components_of(joint),
        system=joint,
        data=data,
    )


@STUDY.claim(
    "A joint that turns decelerates at F/J, stops after Jω₀²/2F, and stays at rest",
    unit="rad, rad/s",
    resolution=1e-4,
)
def stops(engine: Engine) -> Measured:
    times = STOPPING_TIME * WHILE_TURNING
    found = moved(engine, JOINT, (0.0, SPEED), times)
    data = {"stop t": times[1:], "stop": found.value[:, 1]}
    return compared(found, stopped(times[1:]), JOINT, times, data)


@STUDY.claim(
    "A moment below F holds a joint permanently, without creep",
    unit="F·t/J",
    resolution=1e-5,
    note=f"Mean spin in {HELD:g} s, divided by the spin that F would cause in this time.",
    swept=("moment",),
)
def holds(engine: Engine, loads: Sequence[float] = LOADS) -> Measured:
    joints = [replace(JOINT, moment=((0.0, load * FRICTION),)) for load in loads]
    times = np.array([0.0, HELD])

    def crept(tolerance: float) -> FloatArray:
        runs = engine.simulate_many([(one, (0.0, 0.0), times) for one in joints], tolerance=tolerance)
        return np.array([run.at_end[0] for run in runs]) / (DECELERATION * HELD**2)

    found = refined(crept)
    return Measured(
        predicted=np.zeros(len(loads)),
        value=found.value,
        error=found.largest,
        at={"moment over F": loads},
        system=JOINT,
    )


@STUDY.claim(
    "Under a moment that grows, a joint with a static ratio of 1.5 breaks away at 1.5 F and then slides with F",
    unit="rad, rad/s",
    resolution=5e-2,
    note="J·φ̈ = 0.5·F + q·τ after the breakaway, with the growth q of the moment. Without a static "
    "ratio, the spin would end higher by 0.25 rad/s.",
)
def breaks_away(engine: Engine) -> Measured:
    found = moved(engine, STATIC, (0.0, 0.0), RAMPED)
    data = {"ramp": RAMP * RAMPED[1:] / FRICTION, "broken away": found.value[:, 1]}
    return compared(found, broken_away(RAMPED[1:]), STATIC, RAMPED, data)


@STUDY.claim(
    "On a spring, each half swing of a joint is shorter by 2F/C, until it rests where friction holds it",
    unit="rad, rad/s",
    resolution=1e-3,
    note="It starts at 8.5·F/C, turns back at 6.5, 4.5 and 2.5, and rests at 0.5·F/C.",
)
def swings(engine: Engine) -> Measured:
    halves = 0.5 * np.arange(2.0 * SWINGS + 2.0)
    unit = FRICTION / SPRUNG.stiffness
    times = np.asarray(math.pi * math.sqrt(SPRUNG.inertia / SPRUNG.stiffness) * halves)
    found = moved(engine, SPRUNG, (RELEASED * unit, 0.0), times)
    data = {"half swings": halves[1:], "way": found.value[:, 0] / unit}
    return compared(found, swung(times[1:]), SPRUNG, times, data)


@STUDY.claim(
    "A moment of 3 F against the spin turns a joint back at once, and friction changes its sign with the spin",
    unit="rad, rad/s",
    resolution=1e-2,
    note="It decelerates at 4 F/J, then accelerates backwards at 2 F/J.",
)
def turns_back(engine: Engine) -> Measured:
    found = moved(engine, TURNED, (0.0, SPEED), AT)
    return compared(found, turned_back(AT[1:]), TURNED, AT, {})


# --- Recorded engines

RECORDED = {
    "stops": "stops",
    "holds": "holds",
    "breaks-away": "breaks away at 1.5 F",
    "swings": "swings",
    "turns-back": "turns back",
}
"""Headings of the claims in the table of recorded engines."""


def tables() -> tuple[Table, ...]:
    def deviation(claim: Mapping[str, Any]) -> str:
        return error_text(float(np.max(np.array(claim["difference"], dtype=float))))

    rows = tuple(
        (one.name, *recorded_cells(one, STUDY.name, list(RECORDED), deviation), _in_words(one))
        for one in recordings()
        if STUDY.name in one.claims
    )
    caption = (
        "Recorded engines, with their own friction in joints: verdict and largest deviation for each claim, and the "
        "first sentence of matrix. Fixed steps are 0.5 and 0.18 ms."
    )
    return (Table(caption, ("Engine, setting", *RECORDED.values(), "In words"), rows),)


def _in_words(recording: Recording) -> str:
    row = row_of(recording)
    only = Row(row.engine, row.version, row.step, repeat=row.repeat, joint=row.joint, hour=row.hour)
    return only.sentences[0]


STUDY.provides(tables=tables)
