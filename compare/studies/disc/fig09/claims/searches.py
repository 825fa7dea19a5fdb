"""What an engine brings back near to a steady motion, on ring or on points, and the orders of small gaps."""

from __future__ import annotations

import functools
import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike

from compare.claims.error_estimates import Measurement, known, refined
from compare.engines import Engine
from compare.studies.disc.fig09.theory import CIRCLES, ORBIT_TOLERANCE, circle_of, radius_of_pin, rest_of
from compare.studies.toolkit.self_centred import with_load
from compare.studies.toolkit.steady_motion import sharpness, steady_motion
from reference_model.systems import DiscOnDisc, FloatArray


@functools.lru_cache(maxsize=4)
def circles_of(
    engine: Engine, disc: DiscOnDisc, circles: tuple[tuple[float, int], ...] = CIRCLES
) -> Measurement:
    """Return mean radius, frequency and spin of ``circles`` in units of μN/(βk), k and ω, shape (n, 3)."""
    found = refined(
        lambda tolerance: [circle(engine, disc, *one, tolerance) for one in circles], ORBIT_TOLERANCE
    )
    return with_tolerance(found, [sharpness(disc, circle_of(*one)) for one in circles])


def circle(engine: Engine, disc: DiscOnDisc, load: float, which: int, tolerance: float) -> FloatArray:
    """Return the same of one circle, no numbers where none comes back."""
    motion = steady_motion(engine, with_load(disc, load), circle_of(load, which).state, tolerance)
    if motion is None:
        return np.full(3, np.nan)
    return np.array(
        [
            float(np.hypot(*motion.mean)) / radius_of_pin(load),
            motion.frequency / disc.natural_frequency,
            motion.spin / disc.disc_speed,
        ]
    )


def rests_of(engine: Engine, disc: DiscOnDisc, loads: Sequence[float]) -> Measurement:
    """Return the means of x, y and spin at rest in units of X0 and ω, shape (n, 3)."""
    found = refined(
        lambda tolerance: [rest(engine, disc, load, tolerance) for load in loads], ORBIT_TOLERANCE
    )
    return with_tolerance(found, [sharpness(disc, rest_of(load)) for load in loads])


def rest(engine: Engine, disc: DiscOnDisc, load: float, tolerance: float) -> FloatArray:
    """Return the same at one friction force, no numbers where no rest comes back."""
    motion = steady_motion(engine, with_load(disc, load), rest_of(load).state, tolerance)
    if motion is None:
        return np.full(3, np.nan)
    return np.array([*motion.mean / disc.offset, motion.spin / disc.disc_speed])


def with_tolerance(found: Measurement, amplified: ArrayLike) -> Measurement:
    """Return motions found by shooting, shape (n, m), with an error for all numbers of a motion.

    One number alone may be right by chance, and two flows may be the same to within the tolerance, which the motion
    shows ``amplified``.
    """
    return Measurement(found.value, found.rows + ORBIT_TOLERANCE * np.asarray(amplified)[:, np.newaxis])


def extrapolated(gaps: FloatArray, error: FloatArray) -> tuple[FloatArray, FloatArray, float]:
    """Return the order of ``gaps``, shape (3, m), at a halved variable, its numerical and its model error.

    They are series in every other power, so that the order observed between neighbours tends to its limit like the
    square of the variable. ``error`` is that of the gaps, of shape (3, 1).
    """
    with np.errstate(divide="ignore", invalid="ignore"):
        orders = np.log2(gaps[:-1] / gaps[1:])
        noise = error / gaps
    step = (orders[1] - orders[0]) / 3.0
    numerical = np.asarray(5.0 / 3.0 * (noise[1] + noise[2]) / math.log(2.0))
    order = orders[1] + step
    return order, known(order, numerical), float(np.nan_to_num(np.max(np.abs(step))))
