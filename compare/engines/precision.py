"""What an engine can't do better, made visible: noise of the size of its precision.

The numerical error of a claim is what changes with the tolerance. Rounding to single precision may change nothing:
the same digits are cut off at both tolerances. Noise of that size, other at each tolerance, goes the way of rounding
through whatever a claim does with the states, differences and roots and growth included, so that its error shows in
the change. This is the idea of stochastic arithmetic (Vignes, Mathematics and Computers in Simulation 35, 1993).
"""

from __future__ import annotations

import math
import zlib
from dataclasses import replace

import numpy as np

from reference_model.systems import ANGLE, FloatArray, System
from reference_model.trajectory import Trajectory

LEAST_PRECISE = 1e-3
"""The largest precision that may be declared: there is little left to compare of a coarser one."""

OTHER_SIZE = 0.25
"""Of the noise at the next smaller or larger tolerance, over its size at this one."""


def blurred_start(system: System, state: FloatArray, precision: float, tolerance: float) -> FloatArray:
    """Return ``state``, shape (4,) or (6,), from another place, as near as rounding may move it.

    It moves with the master disc there, so that its slip stays: what sticks begins with stick.
    """
    half = len(state) // 2
    moved = _blurred(state[np.newaxis], precision, tolerance, state)[0]
    moved[half:] = state[half:]
    x, y = (moved - state)[:ANGLE]
    moved[half : half + ANGLE] += system.disc_speed * np.array([-y, x])
    return np.asarray(moved)


def blurred(trajectory: Trajectory, precision: float, tolerance: float, start: FloatArray) -> Trajectory:
    """Return ``trajectory`` with noise up to ``precision`` of its largest distance from the axis, speed, angle, spin.

    The first state is the ``start`` that was asked for.
    """
    states = np.asarray(trajectory.states, dtype=float)
    states = _blurred(states, precision, tolerance, start, trajectory.times)
    states[0] = start
    return replace(trajectory, states=states)


def _blurred(states: FloatArray, precision: float, tolerance: float, *question: FloatArray) -> FloatArray:
    """Return ``states`` with noise that follows from the question alone, its factor from the tolerance.

    At the two tolerances of an estimate it is the same noise, of the other sign and another size. Two numbers may be
    off by nearly the same by chance, but not then, whether the effect has the noise's sign or none.
    """
    noise = np.random.default_rng([zlib.crc32(part.tobytes()) for part in question])
    factor = precision if round(math.log(tolerance, COARSENING)) % 2 else -OTHER_SIZE * precision
    return np.asarray(states + factor * noise.uniform(-1.0, 1.0, states.shape) * _sizes(states))


def _sizes(states: FloatArray) -> FloatArray:
    """Return beside which size a number is rounded, for each component of ``states`` (n, 4) or (n, 6)."""
    half = states.shape[1] // 2
    sizes = np.max(np.abs(states), axis=0)
    for x in (0, half):
        sizes[x : x + ANGLE] = np.max(np.hypot(*states[:, x : x + ANGLE].T))
    return np.asarray(sizes)


# --- The tolerances at which engines are asked.

USUAL_TOLERANCE = 1e-9

COARSENING = 8.0
"""Factor between the two tolerances from which an error is estimated, see ``compare.claims.error_estimates``."""
