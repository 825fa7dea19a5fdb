"""At which speeds, torques and loads the car's clutch is looked at, and how exactly."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from compare.claims.error_estimates import WORKING
from compare.studies.toolkit.drivetrain_bench import passenger_car

if TYPE_CHECKING:
    from exudyn_models import Drivetrain


def balanced_car() -> Drivetrain:
    """Return the passenger car without unbalance."""
    return replace(passenger_car(), unbalance=0.0)


FINER = 24
"""Rings of the reference's annulus, in place of 16, which show their error."""

CASES = ((80.0, 12.0), (40.0, 12.0), (80.0, 30.0))
"""Torque in N m and slip in rad/s at which the onset is sought."""

TORQUE, SLIPPING = 80.0, 12.0
"""N m and rad/s of the bench: about what the run-up has."""

BELOW, ABOVE = (1500.0, 2200.0, 2700.0), (3600.0, 4500.0, 6000.0)
"""Speeds of the bench in turns a minute, below and above the onset."""

DECAYS, SEEN = 20.0, 5.0
"""Length of a run in decay times of its slowest mode, and how many of them before its end the rest is inferred."""

START = 3e-4
"""In m: from where a whirl starts, at rest and within the play."""

SAMPLE = 5e-4
"""In s, on the bench."""

MODULATED = (6000.0, 0.6, 0.1)
"""Speed in turns a minute, torque in N m, and by how much the load is more than the torque needs."""

WHIRLS = (MODULATED, (3800.0, 1.3, 0.05), (4500.0, 8.0, 0.01))
"""The same: the second whirl is not modulated, the third is on the stop."""

BORDER_SURPLUS, BORDER_TORQUES = MODULATED[2], (0.2, 0.8, 1.4)
"""Of load, and torques in N m: from a small whirl to one that all but reaches the stop."""

BETWEEN = (3900.0, 4300.0)
"""Speeds in turns a minute below and above the border."""

TIME = 0.4
"""In s: for how long small deviations are followed."""

DEVIATION = 3e-3
"""As a part of the radius."""

TOLERANCE = 20 * WORKING
"""Of the runs that are subtracted from each other."""

PUSH, UNTIL = 0.2, 6.0
"""The same of the modulated motion: first deviation, and when it ends, in s."""

ROUGHER = 80.0
"""Its tolerance over the usual one."""

CYCLE_SAMPLE = 2e-3
"""In s, of the modulated motion."""

SPEEDS = np.linspace(2900.0, 6500.0, 32)
"""Of the map in turns a minute, from just above the natural frequency."""

TORQUES = np.geomspace(0.2, 60.0, 32)
"""Of the maps in N m."""

SURPLUSES = np.geomspace(1e-4, 0.2, 32)
"""Of the load, over what the torque needs."""

SURPLUS, SPEED = 0.1, 6000.0
"""Of the map over speeds, and of that over surpluses."""
