"""A drivetrain between an engine and a vehicle of constant speed is the paper's disc, (19)."""

from dataclasses import replace

import exudyn as exu
import numpy as np
import pytest

from exudyn_models import Drivetrain, build_drivetrain
from reference_model import Annulus, DiscOnDisc, simulate

ENDLESS = 1e30
"""Inertia in kg m², so large that a torque of 1 N m changes the speed by less than rounding."""

DISC = DiscOnDisc(
    mass=1.0,
    polar_inertia=1.0,
    stiffness=1.0,
    damping=0.5,
    friction_force=0.0225,
    disc_speed=1.5,
    contact_radius=0.12,
    shaft_damping=0.015,
    shaft_speed=1.25,
)
START = (0.0389, 0.0, 0.0, 0.0, 0.0389, 1.38664)
"""x, y, angle and their rates on the modulated cycle of Fig. 11, where the disc always slips."""


def drivetrain_states(disc, until, *, inner_radius=0.12, tolerance=1e-12):
    """Return times in s, and x, y, angle and their rates of the clutch disc, shape (n, 6)."""
    model = build_drivetrain(
        Drivetrain(
            engine_inertia=ENDLESS,
            vehicle_inertia=ENDLESS,
            disc_mass=disc.mass,
            disc_inertia=disc.polar_inertia,
            inner_radius=inner_radius,
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
        regularisation=1e-6,
        engine_speed=disc.disc_speed,
        gearbox_speed=disc.shaft_speed,
    )
    data, initial = model.mbs.systemData, exu.ConfigurationType.Initial
    first = model.mbs.GetNodeODE2Index(model.disc)
    for values, get, put in (
        (START[:3], data.GetODE2Coordinates, data.SetODE2Coordinates),
        (START[3:], data.GetODE2Coordinates_t, data.SetODE2Coordinates_t),
    ):
        coordinates = get(initial)
        coordinates[first : first + 3] = values
        put(coordinates, initial)
    motion = model.run(until, sample_every=0.5, largest_step=1.0, tolerance=tolerance)
    return motion.times, np.hstack((motion.disc, motion.disc_velocity))


@pytest.mark.parametrize(
    ("change", "inner_radius"),
    [
        ({"offset": 0.02, "hardening": 300.0}, 0.12),
        ({"stop_gap": 0.03, "stop_stiffness": 5.0}, 0.08),
    ],
    ids=["offset and hardening", "stop and facings of finite width"],
)
def test_the_clutch_disc_moves_as_the_reference_does(change, inner_radius):
    disc = replace(DISC, **change)
    times, states = drivetrain_states(disc, 10.0, inner_radius=inner_radius)
    _, coarse = drivetrain_states(disc, 10.0, inner_radius=inner_radius, tolerance=8e-12)
    contact = None if inner_radius == disc.contact_radius else Annulus(inner_radius, disc.contact_radius)
    exact = simulate(disc, START, times, tolerance=1e-13, contact=contact).states
    # Eight times the change bounds the error of the coarse run, even if the finer run is hardly better.
    error = 8.0 * np.max(np.abs(coarse[-1] - states[-1]))
    assert error < 1e-7  # an error of 1e-5 in a parameter changes more
    np.testing.assert_allclose(coarse[-1], exact[-1], rtol=0.0, atol=error)
    assert np.hypot(*states[:, :2].T).max() > 0.03  # beyond the stop's gap
