"""Noise that makes the limited precision of an engine visible in the error estimates.

Rounding to single precision can cut off the same digits at both tolerances of an error estimate. Noise of that size,
different at each tolerance, propagates as rounding does (stochastic arithmetic: Vignes, Mathematics and Computers in
Simulation 35, 1993).
"""

import math
import zlib
from dataclasses import replace

import numpy as np

from reference_model.systems import ANGLE, FloatArray
from reference_model.systems.joint import AnySystem, FrictionJoint
from reference_model.trajectory import Trajectory

LEAST_PRECISE = 1e-3  # largest precision that an engine may declare
OTHER_SIZE = 0.25  # noise at every second tolerance, relative to the noise at the others


SINGLE = 1e-6
"""Precision of states in single precision, with the rounding errors of some hundred steps."""

FEW_DIGITS = 2.0**16
"""Numbers with fewer binary digits, such as 0.75, say nothing about the precision."""


def are_single(states: FloatArray) -> bool:
    """Return whether at least four states after the first row need single precision, and none needs more."""
    changed = states[1:][states[1:] != states[0]]
    digits = np.frexp(changed)[0] * FEW_DIGITS
    return bool(
        np.count_nonzero(digits != np.rint(digits)) >= 4 and np.all(changed == changed.astype(np.float32))
    )


def blurred_start(system: AnySystem, state: FloatArray, precision: float, tolerance: float) -> FloatArray:
    """Return ``state``, of any shape, with its position or angle moved by noise of size ``precision``.

    The velocity of the master disc is added, so a sticking body still sticks.
    """
    half = len(state) // 2
    moved = _blurred(state[np.newaxis], precision, tolerance, state)[0]
    moved[half:] = state[half:]
    if isinstance(system, FrictionJoint):
        return np.asarray(moved)
    x, y = (moved - state)[:ANGLE]
    moved[half : half + ANGLE] += system.disc_speed * np.array([-y, x])
    return np.asarray(moved)


def blurred(trajectory: Trajectory, precision: float, tolerance: float, start: FloatArray) -> Trajectory:
    """Return ``trajectory`` with noise up to ``precision`` times its largest lengths, speeds, angle and spin."""
    states = np.asarray(trajectory.states, dtype=float)
    states = _blurred(states, precision, tolerance, start, trajectory.times)
    states[0] = start
    return replace(trajectory, states=states)


def _blurred(states: FloatArray, precision: float, tolerance: float, *question: FloatArray) -> FloatArray:
    """Return ``states`` with noise that depends only on ``question``, times a factor that depends on the tolerance.

    Opposite signs at the two tolerances of an estimate reveal odd effects of the noise, different amplitudes even
    effects. Independent noise could be equal by chance.
    """
    noise = np.random.default_rng([zlib.crc32(part.tobytes()) for part in question])
    factor = precision if round(math.log(tolerance, COARSENING)) % 2 else -OTHER_SIZE * precision
    return np.asarray(states + factor * noise.uniform(-1.0, 1.0, states.shape) * _sizes(states))


def _sizes(states: FloatArray) -> FloatArray:
    half = states.shape[1] // 2
    sizes = np.max(np.abs(states), axis=0)
    for x in (0, half) if half >= ANGLE else ():
        sizes[x : x + ANGLE] = np.max(np.hypot(*states[:, x : x + ANGLE].T))
    return np.asarray(sizes)


USUAL_TOLERANCE = 1e-9

COARSENING = 8.0
"""Ratio of the two tolerances of an error estimate."""
