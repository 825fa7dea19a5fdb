"""The launch: how the engine pulls, how the clutch is pressed, how the vehicle resists."""

from __future__ import annotations

import math

import numpy as np

from compare.studies.toolkit.drivetrain_bench import RPM

ENGINE_SPEED = 2000.0 * RPM
MEAN, RIPPLE = 100.0, 1.0
"""The engine's mean torque in N m, and what its firing adds to it, as a share."""

KNOTS, CAPACITIES = (0.0, 0.8, 1.2, 1.25), (0.0, 180.0, 180.0, 30.0)
"""Times in s, and the clutch's capacity in N m at them: it is pressed on, held, and opened."""

PIECES = tuple(zip(KNOTS, KNOTS[1:], CAPACITIES, CAPACITIES[1:], strict=False))
"""Start and end of each piece of the capacity, and its values there; in Python asked a tenth of NumPy's time."""

RATE = CAPACITIES[1] / KNOTS[1]
"""Of the capacity's growth at first, in N m/s."""

UNTIL = 1.35
STUCK = np.linspace(1.08, 1.19, 12)
"""In s: the end, and times at which the clutch sticks."""

SLIP = 10.0
"""rad/s, to which the clutch slips where it does not stick yet."""

EPSILONS = np.array([0.05, 0.1, 0.2, 0.4])
"""ε in m/s. The first is the one of the launch with all its eccentricities."""

LARGEST_STEP = 0.01
"""In s: so large that the tolerance decides."""

ROLLING, AIR = 1300.0 * 9.81 * 0.012 * 0.3 / 13.0, 0.5 * 1.2 * 0.65 * (0.3 / 13.0) ** 3
"""In N m and N m s²/rad² at the input shaft, 0.3 m of wheel behind 13 : 1: 1300 kg on 1.2 %, 0.65 m² in the air."""


def capacity(time: float) -> float:
    """Return the clutch's capacity in N m."""
    for start, end, low, high in PIECES:
        if time < end:
            return low + (high - low) * max(0.0, time - start) / (end - start)
    return CAPACITIES[-1]


def resistance(time: float, angle: float, speed: float) -> float:
    """Return the torque in N m by which the vehicle resists, at the input shaft."""
    return -ROLLING * math.tanh(speed) - AIR * speed * abs(speed)
