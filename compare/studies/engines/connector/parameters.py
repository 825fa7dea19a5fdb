"""Two free discs, the friction between them, and the steps in which they are moved."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Body:
    """A free disc: mass in kg, inertia in kg m², place and angle, velocities and spin."""

    mass: float
    inertia: float
    place: tuple[float, float, float]
    velocity: tuple[float, float, float]


BODIES = (
    Body(2.0, 0.5, (0.4, -0.2, 0.3), (0.1, 0.2, 3.0)),
    Body(1.0, 0.08, (0.55, -0.05, 1.0), (-0.2, 0.1, -2.0)),
)
"""The master disc and the disc on it."""

FRICTION, RADIUS, EPSILON = 0.3, 0.12, 1e-3
"""μN in N, R in m, and ε in m/s, above which the discs slip all the time."""

STEPS, UNTIL = 6000, 10.0
"""Steps, and the last time in s."""

RESOLUTION = 1e-12
"""Of momenta over the largest part of one body."""
