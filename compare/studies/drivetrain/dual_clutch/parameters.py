"""A car with a dual clutch that changes from the first gear to the second under load."""

from __future__ import annotations

import numpy as np

ENGINE, SHAFTS, VEHICLE = 0.2, (0.02, 0.025), 150.0
"""Inertias in kg m²: of the engine, of the shafts of both gears, and of the vehicle at its wheels."""

RATIOS = (13.0, 8.0)
"""Of the gears, speed of a shaft over that of the wheels."""

STIFFNESS, DAMPING = 5000.0, 10.0
"""Of each gear's shafts, seen from the clutch, in N m/rad and N m s/rad."""

TORQUE, RESISTANCE = 150.0, 400.0
"""Of the engine and against the wheels, in N m."""

RADIUS, COEFFICIENT, PLATES = 0.07, 0.12, 8
"""Of both clutches: a ring in m, wet, and how many pairs of faces."""

LOAD = 4500.0
"""Of a closed clutch in N: it holds 302 N m, twice the engine's torque."""

HAND_OVER = (0.2, 0.5)
"""In s: the first clutch opens and the second closes, both by straight lines in this time."""

UNTIL = 0.9
"""In s: the second clutch has stuck for a while."""

START = 200.0
"""Of the engine in rad/s, in the first gear, where nothing slips and the shaft transmits what is needed."""

EPSILON = 2e-2
"""In m/s, 0.29 rad/s: the law is the same in both models, whatever ε is, and explicit steps are limited by it."""

DENSE = np.linspace(0.0, UNTIL, 181).round(3)
"""When SciPy's states are asked for, in s."""

OFTEN = 10
TIMES = DENSE[OFTEN::OFTEN]
"""When both are compared, in s: each tenth of these times but the start."""

TOLERANCE = 1e-8
"""Of Exudyn's explicit steps, in rad, rad/s and J."""


def opening(time: float) -> float:
    """Return the load of the first clutch in N."""
    begin, end = HAND_OVER
    return LOAD * min(1.0, max(0.0, (end - time) / (end - begin)))


def closing(time: float) -> float:
    """Return the load of the second clutch in N."""
    begin, end = HAND_OVER
    return LOAD * min(1.0, max(0.0, (time - begin) / (end - begin)))


def speeds() -> list[float]:
    """Return the speeds of engine, both shafts and wheels at the start in rad/s."""
    wheels = START / RATIOS[0]
    return [START, START, RATIOS[1] * wheels, wheels]


def wind_up() -> float:
    """Return by how much the shaft of the first gear is wound up at the start in rad.

    The engine and all that the first gear drives are speeded up together.
    """
    (first, second), (low, high) = SHAFTS, RATIOS
    behind = (second * high**2 + VEHICLE) / low**2
    rate = (TORQUE - RESISTANCE / low) / (ENGINE + first + behind)
    return (behind * rate + RESISTANCE / low) / STIFFNESS
