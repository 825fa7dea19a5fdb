"""Short motions that reveal the friction of a joint: how it slides, holds, breaks away and stops.

The change of momentum gives the friction moment without a friction law. All numbers are measured at each rung.
"""

from __future__ import annotations

import functools
import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from compare.claims.error_estimates import ROUNDING
from compare.diagnosis.ladder import SAFETY, Ladder, tolerances
from compare.diagnosis.probes import CHECKED_FOR, PULLS, SETTLES_FOR, SLIDES_FOR
from compare.engines import USUAL_TOLERANCE, BadTrajectoryError, Engine, UnsupportedSystemError
from reference_model import FrictionJoint, simulate
from reference_model.systems import FloatArray
from reference_model.systems.joint import AnySystem

JOINT = FrictionJoint(inertia=1.0, friction_moment=2.0)
RATE = JOINT.friction_moment / JOINT.inertia
"""Deceleration by friction alone in rad/s²."""

# --- Friction of a joint that turns, and the other moments.

DRAWS = 24

INERTIAS, SPEEDS = (1e-3, 1e3), (1e-2, 1e2)
"""Ranges in kg m² and rad/s."""

ANGLE = math.pi
"""Largest initial angle in rad."""

LOADS = (0.02, 0.5)
"""Range of the change of speed per second by friction, as a share of the speed."""

BEGINS_AT = 1e-3  # largest error of the first state, relative to its size


def asked(
    engine: Engine, motions: Sequence[tuple[AnySystem, tuple[float, ...], FloatArray]], tolerance: float
) -> list[FloatArray]:
    """Return the states of each motion; raise ``BadTrajectoryError`` if a motion begins elsewhere."""
    found = []
    for (_, start, _), run in zip(motions, engine.simulate_many(motions, tolerance=tolerance), strict=True):
        if not np.allclose(run.states[0], start, rtol=BEGINS_AT, atol=BEGINS_AT):
            shown = run.states[0].round(4).tolist()
            raise BadTrajectoryError(
                f"returned the initial state {shown} for {list(start)}: expected angle in rad and spin in rad/s"
            )
        found.append(run.states)
    return found


def first_check_of_joints(engine: Engine) -> tuple[tuple[float, float], tuple[float, float]]:
    """Return the angles in rad that a turning and a resting joint move, each as measured and exact."""
    pulled, times = replace(JOINT, moment=((0.0, 0.5 * JOINT.friction_moment),)), np.array([0.0, CHECKED_FOR])
    start = (0.0, 1.5 * RATE * CHECKED_FOR)
    turned, moved = asked(engine, [(JOINT, start, times), (pulled, (0.0, 0.0), times)], USUAL_TOLERANCE)
    return (float(turned[-1, 0]), float(simulate(JOINT, start, times).at_end[0])), (float(moved[-1, 0]), 0.0)


def draws() -> FloatArray:
    """Return inertia, friction moment, spin and angle of slides that fill their ranges, shape (n, 4)."""
    random = np.random.default_rng(1)
    levels = (np.array([random.permutation(DRAWS) for _ in range(4)]) + random.random((4, DRAWS))) / DRAWS
    inertia, speed, load = (
        ends[0] * (ends[1] / ends[0]) ** level
        for ends, level in zip((INERTIAS, SPEEDS, LOADS), levels, strict=False)
    )
    ways = np.where(np.arange(DRAWS) % 2, -1.0, 1.0)
    slides = np.column_stack((inertia, inertia * speed * load, ways * speed, ANGLE * (2.0 * levels[3] - 1.0)))
    return np.vstack(((JOINT.inertia, 0.1 * JOINT.friction_moment, 1.0, 0.0), slides))


def slides(engine: Engine, tolerance: float) -> FloatArray:
    """Return friction against the slide/F for each of the ``draws``, shape (n,)."""
    times = np.array([0.0, SETTLES_FOR, SETTLES_FOR + SLIDES_FOR])
    motions: list[tuple[AnySystem, tuple[float, ...], FloatArray]] = [
        (FrictionJoint(inertia=inertia, friction_moment=friction), (angle, spin), times)
        for inertia, friction, spin, angle in draws().tolist()
    ]
    runs = asked(engine, motions, tolerance)
    lost = [
        math.copysign(1.0, start[1]) * (states[1, 1] - states[2, 1])
        for (_, start, _), states in zip(motions, runs, strict=True)
    ]
    inertia, friction = draws()[:, :2].T
    return np.asarray(inertia * lost / (friction * SLIDES_FOR))


SMOOTH = replace(JOINT, friction_moment=1e-9)  # some engines need friction

SUPPORTS = {
    "spring moment": (replace(SMOOTH, stiffness=1.0), (1.0, 1.0)),
    "damping moment": (replace(SMOOTH, damping=1.0), (0.0, 1.0)),
    "moment of the offset": (replace(SMOOTH, stiffness=0.01, offset=100.0), (0.0, 0.1)),
    "constant applied moment": (replace(SMOOTH, moment=((0.0, 1.0),)), (0.0, 1.0)),
    "changing applied moment": (replace(SMOOTH, moment=((0.0, 0.0), (0.08, 1.0), (0.1, 2.0))), (0.0, 1.0)),
}
"""Turning joints and their initial states, each with one acting moment."""


def supports(engine: Engine, tolerance: float) -> FloatArray:
    """Return the change of speed due to each of ``SUPPORTS``, divided by the exact change, shape (n,)."""
    times = np.array([0.0, SETTLES_FOR, SETTLES_FOR + SLIDES_FOR])
    motions = [(joint, start, times) for joint, start in SUPPORTS.values()]
    found = []
    for (joint, _, _), (_, begun, ended) in zip(motions, asked(engine, motions, tolerance), strict=True):
        exact = simulate(joint, begun, times[1:]).at_end
        found.append((ended[1] - begun[1]) / (exact[1] - begun[1]))
    return np.array(found)


# --- A joint at rest: creep, breakaway and the static ratio.

HELD_FOR = 2.0  # duration in s; the creep speed is measured in the second half
LOOKS = 8
RATIO = 1.5
MOVES = 0.1  # a joint has moved if its mean speed exceeds this share of an exact joint's
MOST_HELD, BISECTIONS = 32.0, 12
OVERLOAD = 1.2


def loaded(engine: Engine, loads: Sequence[float], ratio: float, tolerance: float) -> FloatArray:
    """Return mean speed, largest deviation from it, gain and middle speed of loaded joints in rad/s, shape (n, 4).

    The ``loads`` are constant moments in units of F, and all numbers refer to the second half of the time.
    """
    times = np.concatenate(([0.0], HELD_FOR * np.linspace(0.5, 1.0, LOOKS + 1)))
    joints = [
        replace(JOINT, static_ratio=ratio, moment=((0.0, load * JOINT.friction_moment),)) for load in loads
    ]
    found = []
    for states in asked(engine, [(joint, (0.0, 0.0), times) for joint in joints], tolerance):
        angle, spin = states[1:].T
        mean = 2.0 * (angle[-1] - angle[0]) / HELD_FOR
        found.append([mean, np.max(abs(spin - mean)), spin[-1] - spin[0], spin[0]])
    return np.array(found)


def breakaway(engine: Engine, ratio: float) -> tuple[float, float]:
    """Return the largest load/F that a joint holds from rest, to 1 %, and its friction/F afterwards.

    The largest load/F is ``ratio`` if the engine is right. Both are NaN if the engine does not simulate joints with
    this static ratio.
    """
    tolerance = float(tolerances(engine)[-1])
    load = OVERLOAD * ratio
    try:
        ((_, _, gained, _),) = loaded(engine, (load,), ratio, tolerance)
    except UnsupportedSystemError:
        return math.nan, math.nan
    return _held(engine, ratio), load - 2.0 * float(gained) / (HELD_FOR * RATE)


def _held(engine: Engine, ratio: float) -> float:
    tolerance = float(tolerances(engine)[-1])

    def moves(load: float) -> bool:
        ((mean, *_),) = loaded(engine, (load,), ratio, tolerance)
        return bool(mean > MOVES * (load - 1.0) * RATE * 0.75 * HELD_FOR)

    least, most = 1.01, MOST_HELD
    if ratio > 1.0 and moves(0.99 * ratio):
        most = 0.99 * ratio
        if moves(least):
            return 1.0
    elif moves(1.01 * ratio):
        return ratio
    else:
        least = 1.01 * ratio
    for _ in range(BISECTIONS):
        middle = math.sqrt(least * most)
        least, most = (least, middle) if moves(middle) else (middle, most)
        if most < 1.01 * least:
            break
    return least


def delay(engine: Engine, tolerance: float) -> float:
    """Return how late in s a joint breaks away under 1.2 F."""
    ((_, _, gained, speed),) = loaded(engine, (OVERLOAD,), 1.0, tolerance)
    rate = gained / (0.5 * HELD_FOR)
    return 0.5 * HELD_FOR - speed / rate if rate else math.inf


# --- A joint that stops.

STOPS = 2.0  # initial speed in rad/s: it stops after 1 s and 1 rad
NEARLY = 0.01  # share of the speed; its time shows when the joint stops
AFTER = (1.2, 1.6, 2.0)
SPRUNG = replace(JOINT, stiffness=100.0)
RELEASED, RESTS = 8.5, 0.5
"""Angles in units of F/C: half swings end at 6.5, 4.5, 2.5 and 0.5, where the joint rests."""

SLOW = 1e-5
"""Speed in rad/s that friction removes within any step."""


def stops(engine: Engine, tolerance: float) -> FloatArray:
    """Return the angle and the time of a stop, divided by the exact values, and the lowest and the last speed.

    The speeds are in units of the initial speed. The fifth number is the angle of rest on a spring in units of F/C.
    The last number belongs to a joint that should stop within a step: its largest speed, divided by its initial
    speed.
    """
    near = np.linspace(0.9, 1.1, 41)
    turn = math.pi * math.sqrt(SPRUNG.inertia / SPRUNG.stiffness)
    unit = SPRUNG.friction_moment / SPRUNG.stiffness
    stopped, swung, slow = asked(
        engine,
        [
            (JOINT, (0.0, STOPS), np.concatenate(([0.0], near, AFTER))),
            (SPRUNG, (RELEASED * unit, 0.0), np.array([0.0, 5.0 * turn, 6.0 * turn])),
            (JOINT, (0.0, SLOW), np.array([0.0, 0.1, 0.15, 0.2])),
        ],
        tolerance,
    )
    speeds = stopped[1:, 1] / STOPS
    below = np.flatnonzero(speeds[: len(near)] <= NEARLY)
    at = math.inf
    if below.size:
        i = max(int(below[0]), 1)
        share = (speeds[i - 1] - NEARLY) / (speeds[i - 1] - speeds[i]) if speeds[i] < speeds[i - 1] else 0.0
        at = float(near[i - 1] + share * (near[i] - near[i - 1])) / (1.0 - NEARLY)
    after = (stopped[-1, 0] - stopped[-3, 0]) / ((AFTER[-1] - AFTER[0]) * STOPS)
    chatter = float(np.max(abs(slow[1:, 1]))) / SLOW
    return np.array([stopped[-1, 0], at, float(np.min(speeds)), after, swung[-1, 0] / unit, chatter])


# --- An hour at rest, and whole motions.

HOUR = 3600.0


def hour(engine: Engine) -> float:
    """Return the angle in rad that a joint moves in an hour under half of its limit, at the coarsest rung."""
    joint = replace(JOINT, moment=((0.0, 0.5 * JOINT.friction_moment),))
    (states,) = asked(
        engine, [(joint, (0.0, 0.0), np.array([0.0, 0.5, 1.0]) * HOUR)], float(tolerances(engine)[0])
    )
    return float(states[-1, 0])


SWUNG = (
    (
        FrictionJoint(
            inertia=0.5, friction_moment=1.5, damping=0.3, stiffness=4.0, offset=0.3,
            moment=((0.0, 0.0), (1.0, 6.0), (2.5, -7.0), (4.0, 2.0)),
        ),
        (0.2, 1.0),
    ),
    (
        FrictionJoint(
            inertia=2.0, friction_moment=3.0, damping=0.2, moment=((0.0, -5.0), (1.5, 8.0), (2.0, 1.0), (3.0, -9.0)),
        ),
        (-0.5, 0.0),
    ),
)  # fmt: skip
"""Joints that stick, break away and reverse, and their initial states."""

SWING_TIMES = np.linspace(0.0, 4.0, 17)


def motions(engine: Engine, tolerance: float) -> FloatArray:
    """Return the errors of all states of ``SWUNG``, relative to the largest angle and speed, shape (n,)."""
    runs = zip(asked(engine, [(*one, SWING_TIMES) for one in SWUNG], tolerance), _exact(), strict=True)
    return np.concatenate([np.ravel((states - exact) / sizes) for states, (exact, sizes) in runs])


@functools.cache
def _exact() -> list[tuple[FloatArray, FloatArray]]:
    exact = [simulate(*one, SWING_TIMES).states for one in SWUNG]
    return [(states, np.max(abs(states), axis=0)) for states in exact]


@dataclass(frozen=True, eq=False)
class Joint:
    """Friction of a joint in short motions; the finest rung is the last."""

    slides: FloatArray  # (rungs, draws): friction/F
    noise: FloatArray  # (draws,): error of the slides by precision and rounding
    supports: FloatArray  # (rungs, SUPPORTS): moments divided by the exact ones
    creeps: FloatArray  # (rungs, PULLS, 4), see ``loaded``
    held: FloatArray  # (2, 2), see ``breakaway``, with the static ratios 1 and ``RATIO``
    delays: FloatArray  # (rungs,): of the breakaway in s
    stops: FloatArray  # (rungs, 6), see ``stops``
    errors: FloatArray  # (rungs, states): errors of whole motions, relative to their sizes


def joint(engine: Engine) -> Joint:
    """Return the friction of a joint in short motions."""

    def at_each_rung(question: Callable[..., Any], *arguments: Any) -> FloatArray:
        return Ladder.of(engine, functools.partial(question, engine, *arguments)).values

    inertia, friction, spin, _ = draws().T
    return Joint(
        at_each_rung(slides),
        (SAFETY * engine.noise + ROUNDING) * inertia * abs(spin) / (friction * SLIDES_FOR),
        at_each_rung(supports),
        at_each_rung(loaded, PULLS, 1.0),
        np.array([breakaway(engine, ratio) for ratio in (1.0, RATIO)]),
        at_each_rung(delay),
        at_each_rung(stops),
        at_each_rung(motions),
    )
