"""Cost of points at any places with unequal shares, relative to as many points on a ring.

Run with ``python benchmarks/contact_points.py``; prints a table within ten seconds. The two contacts of a row take
turns, and each number is the least of all repetitions, so other load affects both equally.
"""

from __future__ import annotations

import time
from collections.abc import Callable

import numpy as np

from compare.claims.parameters import FIG11
from exudyn_models.forces.friction_laws import NONE_HELD, friction_of
from exudyn_models.forces.laws.places import ring_places, table_of
from reference_model import Points, PointsOnRing
from reference_model.systems import Place

REPETITIONS, CALLS = 100, 400


def uneven(number: int) -> Points:
    """Return points at random places within the ring, with random shares."""
    rng = np.random.default_rng(number)
    shares = rng.uniform(0.5, 1.5, number)
    x, y = rng.uniform(-0.5, 0.5, (2, number)) * FIG11.contact_radius
    return Points(np.column_stack((x, y, shares / shares.sum())).tolist())


def law_of_reference(contact: Points) -> Callable[[], object]:
    """Return a function that evaluates the reference's law many times."""
    return lambda: [contact.force_and_moment(0.2 + 0.1j, 1.3, 0.4) for _ in range(CALLS)]


def law_of_exudyn(places: tuple[Place, ...]) -> Callable[[], object]:
    """Return a function that evaluates the connector's law many times."""
    contact = FIG11.contact_radius, len(places), 1.0, 1e-6, NONE_HELD, table_of(places)
    return lambda: [friction_of(0.2, 0.1, 1.3, 0.4, contact) for _ in range(CALLS)]


def least_times(*functions: Callable[[], object]) -> list[float]:
    """Return the least time in s of each function."""
    best = [np.inf] * len(functions)
    for _ in range(REPETITIONS):
        for i, function in enumerate(functions):
            began = time.perf_counter()
            function()
            best[i] = min(best[i], time.perf_counter() - began)
    return best


def main() -> None:
    """Print microseconds per evaluation from Python, and their ratio."""
    print("law                                    on a ring  anywhere   ratio")
    for number in (3, 6, 24):
        ring, points = PointsOnRing(FIG11.contact_radius, number), uneven(number)
        on_ring = ring_places(FIG11.contact_radius, number)
        rows = {
            "reference": (law_of_reference(ring), law_of_reference(points)),
            "connector in Exudyn": (law_of_exudyn(on_ring), law_of_exudyn(tuple(points))),
        }
        for name, laws in rows.items():
            first, second = (1e6 / CALLS * found for found in least_times(*laws))
            print(f"{name + f', {number} points':38} {first:9.3f} {second:9.3f} {second / first:7.2f}")


if __name__ == "__main__":
    main()
