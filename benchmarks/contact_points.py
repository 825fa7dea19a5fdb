"""Cost of points at any places with unequal shares, relative to as many points on a ring.

Run with ``python benchmarks/contact_points.py``; prints a table within ten seconds. The two contacts of a row take
turns, and each number is the least of all repetitions, so other load affects both equally.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from functools import partial

import numpy as np

from exudyn_models.forces.friction_laws import NONE_HELD, friction_of
from exudyn_models.forces.laws.places import table_of
from reference_model import Points, PointsOnRing
from reference_model.systems import FloatArray, Place

REPETITIONS, CALLS, RADIUS = 100, 400, 0.12
MOTION = 0.2 + 0.1j, 1.3, 0.4
"""Slip in m/s, relative spin in rad/s and angle in rad."""


def law_of_exudyn(places: tuple[Place, ...]) -> Callable[[], object]:
    """Return a function that evaluates the connector's law."""
    contact = RADIUS, len(places), 1.0, 1e-6, NONE_HELD, table_of(places)
    return lambda: friction_of(MOTION[0].real, MOTION[0].imag, *MOTION[1:], contact)


def least_times(*functions: Callable[[], object]) -> FloatArray:
    """Return the shortest time of each function in microseconds."""
    times = np.full((REPETITIONS, len(functions)), np.inf)
    for repetition in times:
        for i, function in enumerate(functions):
            began = time.perf_counter()
            for _ in range(CALLS):
                function()
            repetition[i] = 1e6 * (time.perf_counter() - began) / CALLS
    return times.min(axis=0)


if __name__ == "__main__":
    print("law, in µs per call from Python         on a ring  anywhere   ratio")
    for number in (3, 6, 24):
        rng = np.random.default_rng(number)
        shares, (x, y) = rng.uniform(0.5, 1.5, number), rng.uniform(-0.5, 0.5, (2, number)) * RADIUS
        laws = PointsOnRing(RADIUS, number), Points(np.column_stack((x, y, shares / shares.sum())).tolist())
        reference = [partial(law.force_and_moment, *MOTION) for law in laws]
        for name, calls in {
            "reference": reference,
            "Exudyn": [law_of_exudyn(tuple(law)) for law in laws],
        }.items():
            ring, points = least_times(*calls)
            print(f"{name + f', {number} points':38} {ring:10.3f} {points:9.3f} {points / ring:7.2f}")
