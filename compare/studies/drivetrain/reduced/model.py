"""The drivetrain in Exudyn, reduced to a friction disc."""

from __future__ import annotations

from typing import Any

import numpy as np

from compare.studies.drivetrain.reduced.parameters import ENDLESS, EPSILON, LARGEST_STEP, UNTIL, Case
from reference_model.systems import FloatArray


def drivetrain_motion(
    case: Case, tolerance: float, inertia: float = ENDLESS
) -> tuple[FloatArray, FloatArray]:
    """Return times in s, and x, y, angle and their rates of the clutch disc at them, shape (n, 6)."""
    import exudyn as exu

    from exudyn_models import Drivetrain, build_drivetrain

    disc = case.disc
    model = build_drivetrain(
        Drivetrain(
            engine_inertia=inertia,
            vehicle_inertia=inertia,
            disc_mass=disc.mass,
            disc_inertia=disc.polar_inertia,
            inner_radius=case.inner_radius,
            outer_radius=disc.contact_radius,
            faces=1,
            friction_coefficient=1.0,
            offset=disc.offset,
            radial_stiffness=disc.stiffness,
            radial_damping=disc.damping,
            hardening=disc.hardening,
            stop_gap=disc.stop_gap,
            stop_stiffness=disc.stop_stiffness,
            torsional_stiffness=0.0,
            torsional_damping=disc.shaft_damping,
        ),
        normal_load=disc.friction_force,
        regularisation=EPSILON,
        engine_speed=disc.disc_speed,
        gearbox_speed=disc.shaft_speed,
    )
    data: Any = model.mbs.systemData
    first = model.mbs.GetNodeODE2Index(model.disc)
    initial = exu.ConfigurationType.Initial
    for values, get, put in (
        (case.start[:3], data.GetODE2Coordinates, data.SetODE2Coordinates),
        (case.start[3:], data.GetODE2Coordinates_t, data.SetODE2Coordinates_t),
    ):
        coordinates = get(initial)
        coordinates[first : first + 3] = values
        put(coordinates, initial)
    motion = model.run(UNTIL, sample_every=0.25, largest_step=LARGEST_STEP, tolerance=tolerance)
    return motion.times, np.hstack((motion.disc, motion.disc_velocity))
