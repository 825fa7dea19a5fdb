"""The car's drivetrain in Exudyn, in a whirl."""

from __future__ import annotations

from typing import TYPE_CHECKING

from compare.studies.drivetrain.frozen.theory import CarWhirl
from compare.studies.toolkit.drivetrain_bench import EPSILON, start_disc

if TYPE_CHECKING:
    from exudyn_models import Drivetrain, DrivetrainModel


def build(
    car: Drivetrain, whirl: CarWhirl, *, deviation: float = 0.0, regularisation: float = EPSILON
) -> DrivetrainModel:
    """Return the drivetrain in a whirl between an engine and a load of constant torque.

    The radius is larger by the part ``deviation``.
    """
    from exudyn_models import build_drivetrain

    model = build_drivetrain(
        car,
        normal_load=whirl.friction_force / (car.faces * car.friction_coefficient),
        regularisation=regularisation,
        engine_speed=whirl.engine_speed,
        gearbox_speed=whirl.engine_speed - whirl.slip,
        engine_torque=lambda time, angle, speed: whirl.engine_torque,
        vehicle_torque=lambda time, angle, speed: -whirl.torque,
        shaft_torque=whirl.torque,
    )
    start_disc(model, (1.0 + deviation) * whirl.place, (1.0 + deviation) * whirl.velocity)
    return model
