"""The motion of a ring that an engine throws, and what is seen of it."""

from __future__ import annotations

import functools
import math

import numpy as np
from numpy.typing import ArrayLike

from compare.engines import Engine
from compare.studies.disc.free_ring.parameters import (
    DECELERATION,
    ENDING,
    INTERVALS,
    NEARNESSES,
    REMAINING,
    RINGS,
    SPEED,
    TABLE,
    TOLERANCE,
    Throw,
)
from compare.studies.disc.free_ring.theory import expected_approach
from reference_model import Trajectory
from reference_model.systems import FloatArray


@functools.cache
def roughly_rest(engine: Engine, throw: Throw) -> float:
    """Return when the ring of ``engine`` rests, in s, which sets the times that the claims sample.

    It is of the claims' own tolerance. A smaller one then moves the rest against these times by about their error,
    so that the change of what a claim measures covers that error.
    """
    longest = 2.0 * max(1.0, throw.inertia) * SPEED / DECELERATION
    found = rest_of(engine.simulate(throw.disc, throw.state, [0.0, longest], tolerance=TOLERANCE))
    return found if math.isfinite(found) else longest


@functools.cache
def thrown(engine: Engine, throw: Throw, tolerance: float) -> Trajectory:
    """Return the motion of a throw, at all times at which it is looked at."""
    rest = roughly_rest(engine, throw)
    times = [
        *uniform_times(engine, throw),
        *(rest * (1.0 - REMAINING)),
        *(rest * (1.0 - ENDING)),
        1.02 * rest,
    ]
    if throw in RINGS:
        times += [*approach_times(engine, throw)]
    return engine.simulate(throw.disc, throw.state, np.unique(times), tolerance=tolerance)


def uniform_times(engine: Engine, throw: Throw) -> FloatArray:
    """Return equally spaced times until the ring rests, in s."""
    return np.linspace(0.0, roughly_rest(engine, throw), INTERVALS + 1)[:-1]


def approach_times(engine: Engine, throw: Throw) -> FloatArray:
    """Return when the remaining time is A over each of the nearnesses, in s."""
    return roughly_rest(engine, throw) - expected_approach(throw) / np.array(NEARNESSES)


def rest_of(trajectory: Trajectory) -> float:
    """Return when the ring comes to rest in s, no number if it does not."""
    return trajectory.phases[-1].start if trajectory.phases[-1].kind == "stick" else math.nan


def speeds_at(trajectory: Trajectory, times: ArrayLike) -> tuple[FloatArray, FloatArray]:
    """Return U and W in m/s at ``times``, which are among those of the trajectory."""
    states = trajectory.states[[int(np.argmin(np.abs(trajectory.times - time))) for time in np.ravel(times)]]
    return np.hypot(states[:, 3], states[:, 4]), TABLE.contact_radius * np.abs(states[:, 5])


def speeds_before_rest(
    engine: Engine, throw: Throw, tolerance: float, left: ArrayLike
) -> tuple[FloatArray, FloatArray]:
    """Return U and W in m/s when fractions ``left`` of the time to rest are left, which are among those looked at."""
    return speeds_at(thrown(engine, throw, tolerance), roughly_rest(engine, throw) * (1.0 - np.asarray(left)))
