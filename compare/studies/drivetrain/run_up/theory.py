"""What the reference says of the reduced disc at the run-up's speeds, frozen: rest, unbalance and whirl."""

from __future__ import annotations

import functools
from typing import TYPE_CHECKING

import numpy as np

from compare.claims.study import Data
from compare.studies.drivetrain.run_up.parameters import IDLE, SLIP, TOP, transmitted
from compare.studies.toolkit.drivetrain_bench import (
    RPM,
    Operation,
    natural_frequency,
    onset_speed,
    passenger_car,
    rotating_damping,
)
from compare.studies.toolkit.drivetrain_steady import rest_of, whirl_of
from reference_model.systems import FloatArray

if TYPE_CHECKING:
    from exudyn_models import Drivetrain


@functools.lru_cache(maxsize=2)
def whirls_above_onset(car: Drivetrain) -> FloatArray:
    """Return speed in rad/s, radius in m and frequency in rad/s of the reference's whirl, shape (30, 3)."""
    torque = transmitted(car)
    speeds = np.linspace(onset_speed(car, SLIP, torque), TOP * RPM, 31)[1:]
    circles = [whirl_of(car, Operation(speed, SLIP, torque)) for speed in speeds]
    return np.array([(s, each.radius, each.frequency) for s, each in zip(speeds, circles, strict=True)])


def curves(count: int = 120) -> Data:
    """Return what the reference predicts of the reduced disc at frozen speeds, ``count`` of them below the onset."""
    car = passenger_car()
    k, torque = natural_frequency(car), transmitted(car)
    onset, damping = onset_speed(car, SLIP, torque), rotating_damping(car, SLIP, torque)
    slow = np.linspace(IDLE * RPM, onset, count + 1)[:-1]
    rests = [rest_of(car, Operation(speed, SLIP, torque, car.offset)) for speed in slow]
    # Small motions of the unbalanced disc: mz̈ + (β + D)ż + (C − iωD)z = m·e·s²·exp(ist) at its own speed s.
    own = slow - SLIP
    dynamic = car.radial_stiffness - car.disc_mass * own**2
    net = (car.radial_damping + damping) * own - slow * damping
    return {
        "rest": np.column_stack((slow, [abs(complex(each.x, each.y)) for each in rests])),
        "unbalance": car.disc_mass * car.unbalance * own**2 / np.hypot(dynamic, net),
        "whirl": whirls_above_onset(car),
        "onset": np.array([onset, k]),
    }
