"""The launch in Exudyn, and a part of it in which the clutch slips all the time."""

from __future__ import annotations

from typing import TYPE_CHECKING

from compare.studies.drivetrain.launch.parameters import (
    ENGINE_SPEED,
    EPSILONS,
    LARGEST_STEP,
    MEAN,
    RATE,
    RIPPLE,
    UNTIL,
    capacity,
    resistance,
)

if TYPE_CHECKING:
    from exudyn_models import Drivetrain
    from exudyn_models.drivetrain.model import DrivetrainMotion


def launch(
    car: Drivetrain, *, epsilon: float, tolerance: float, until: float = UNTIL, sample_every: float = 1e-3
) -> DrivetrainMotion:
    """Return the launch of ``car`` with the engine's ripple and the vehicle's resistance."""
    from exudyn_models import build_drivetrain, four_cylinder

    model = build_drivetrain(
        car,
        normal_load=lambda time: car.normal_load(capacity(time)),
        regularisation=epsilon,
        engine_speed=ENGINE_SPEED,
        gearbox_speed=0.0,
        engine_torque=four_cylinder(MEAN, RIPPLE),
        vehicle_torque=resistance,
    )
    return model.run(until, sample_every=sample_every, largest_step=LARGEST_STEP, tolerance=tolerance)


def slipping(car: Drivetrain, *, tolerance: float, until: float) -> DrivetrainMotion:
    """Return a motion of full slip, under the engine's mean torque alone and a capacity that grows steadily."""
    from exudyn_models import build_drivetrain, four_cylinder

    model = build_drivetrain(
        car,
        normal_load=lambda time: car.normal_load(RATE * time),
        regularisation=float(EPSILONS[0]),
        engine_speed=ENGINE_SPEED,
        gearbox_speed=0.0,
        engine_torque=four_cylinder(MEAN, 0.0),
    )
    return model.run(until, sample_every=until / 10, largest_step=LARGEST_STEP, tolerance=tolerance)
