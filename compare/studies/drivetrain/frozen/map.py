"""Where whirls of the car's clutch disc are modulated: a map over speed, torque and surplus of load."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from compare.claims.study import Data
from compare.studies.drivetrain.frozen.linear import of_modulation, state_matrix_of, whirl_under_surplus
from compare.studies.toolkit.drivetrain_bench import RPM
from reference_model.systems import FloatArray

if TYPE_CHECKING:
    from exudyn_models import Drivetrain

SPEEDS = np.linspace(2900.0, 6500.0, 46)
"""In turns a minute, from just above the natural frequency."""

TORQUES = np.geomspace(0.2, 60.0, 46)
"""In N m."""

SURPLUSES = np.geomspace(1e-4, 0.2, 46)
"""Of the load, over what the torque needs."""

SURPLUS, SPEED = 0.1, 6000.0
"""Those of the other map."""


def maps_of_modulation(car: Drivetrain) -> Data:
    """Return growth rates in 1/s of the modulation over (torque, speed) and over (torque, surplus).

    NaN where no whirl keeps the clutch from locking up. The radius in m, too, which tells whether it is on the stop.
    """
    over_speed = np.array([[whirl_growth(car, n, t, SURPLUS) for n in SPEEDS] for t in TORQUES])
    over_surplus = np.array([[whirl_growth(car, SPEED, t, s) for s in SURPLUSES] for t in TORQUES])
    return {
        "speeds": SPEEDS,
        "torques": TORQUES,
        "surpluses": SURPLUSES,
        "over speed": over_speed,
        "over surplus": over_surplus,
    }


def whirl_growth(car: Drivetrain, speed: float, torque: float, surplus: float) -> FloatArray:
    """Return growth rate and radius of the whirl, shape (2,); NaN if there is none."""
    whirl = whirl_under_surplus(car, speed * RPM, torque, surplus)
    if whirl is None:
        return np.array([np.nan, np.nan])
    slowest = of_modulation(state_matrix_of(car, whirl), whirl.frequency)[0]
    return np.array([slowest.real, whirl.radius])
