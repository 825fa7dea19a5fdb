"""The run-up in Exudyn."""

from __future__ import annotations

from typing import TYPE_CHECKING

from compare.studies.drivetrain.run_up.parameters import (
    GAIN,
    IDLE,
    RIPPLE,
    SAMPLE,
    SLIP,
    TOP,
    TORQUE,
    duration,
    transmitted,
)
from compare.studies.toolkit.drivetrain_bench import EPSILON, RPM

if TYPE_CHECKING:
    from exudyn_models import Drivetrain
    from exudyn_models.drivetrain.model import DrivetrainMotion


def run(car: Drivetrain, tolerance: float, top: float = TOP) -> DrivetrainMotion:
    """Return the run-up to ``top`` (turns a minute); the load is fed forward and corrected by the slip."""
    from exudyn_models import build_drivetrain, four_cylinder

    torque = transmitted(car)
    needed = car.normal_load(torque)
    model = build_drivetrain(
        car,
        normal_load=needed,
        regularisation=EPSILON,
        engine_speed=IDLE * RPM,
        gearbox_speed=IDLE * RPM - SLIP,
        engine_torque=four_cylinder(TORQUE, RIPPLE),
        shaft_torque=torque,
    )
    model.friction.change(normal_load=lambda time: max(0.0, needed * (1.0 + GAIN * (model.slip() - SLIP))))
    return model.run(duration(car, top), sample_every=SAMPLE, tolerance=tolerance)
