from dataclasses import replace

import numpy as np
import pytest
from studies_under_test import engine_named
from tested_studies import FROZEN

from compare.claims.claim import Verdict
from compare.studies.drivetrain.frozen import STUDY
from compare.studies.drivetrain.frozen.theory import (
    of_modulation,
    state_matrix_of,
    whirl_growth,
    whirl_under_surplus,
)
from compare.studies.toolkit.drivetrain_bench import RPM, centred_car, facings
from reference_model import DiscOnDisc
from reference_model.steady.stability import whirl_eigenvalues

CAR = centred_car()


def test_the_border_is_nan_if_stability_does_not_change():
    few = {"border": {"between": (4300.0, 4500.0)}}
    (claim,) = STUDY.measure(engine_named("exudyn"), few, only=("border",)).claims
    assert np.all(np.isnan(claim.measured))
    assert claim.verdict is Verdict.DIFFERS


def test_whirls_on_the_stop_are_stable_and_fast_whirls_in_the_play_are_not():
    theory = FROZEN.found("theory").data
    growth, radius = np.moveaxis(theory["over speed"], -1, 0)
    there = np.isfinite(growth)
    on_stop = there & (radius > CAR.stop_gap)
    assert np.any(on_stop)
    assert np.all(growth[on_stop] < 0.0)
    in_play = there & (radius < CAR.stop_gap)
    speeds = np.broadcast_to(theory["speeds"], growth.shape)
    assert np.all(growth[in_play & (speeds > 4200.0)] > 0.0)
    assert np.all(growth[in_play & (speeds < 4000.0)] < 0.0)


def reduced(whirl, damping=0.3):
    """Return the disc between a rigid master disc and a rigid shaft, with the same whirl."""
    return DiscOnDisc(
        mass=CAR.disc_mass,
        polar_inertia=CAR.disc_inertia,
        stiffness=CAR.radial_stiffness,
        damping=CAR.radial_damping,
        stop_gap=CAR.stop_gap,
        stop_stiffness=CAR.stop_stiffness,
        friction_force=whirl.friction_force,
        disc_speed=whirl.engine_speed,
        contact_radius=CAR.outer_radius,
        shaft_damping=damping,
        shaft_speed=whirl.engine_speed - whirl.slip - whirl.torque / damping,
    )


WHIRLS = [(6000.0, 0.6, 0.1), (3800.0, 1.3, 0.05), (4500.0, 8.0, 0.01)]


@pytest.mark.parametrize(("speed", "torque", "surplus"), WHIRLS)
def test_between_rigid_bodies_the_eigenvalues_are_those_of_the_disc(speed, torque, surplus):
    whirl = whirl_under_surplus(CAR, speed * RPM, torque, surplus)
    held = replace(
        CAR, engine_inertia=1e30, vehicle_inertia=1e30, torsional_stiffness=0.0, torsional_damping=0.3
    )
    found = of_modulation(state_matrix_of(held, whirl), whirl.frequency)
    state = [whirl.radius, 0.0, 0.0, 0.0, whirl.frequency * whirl.radius, whirl.engine_speed - whirl.slip]
    for value in whirl_eigenvalues(reduced(whirl), state, facings(CAR))[1:]:
        assert np.min(np.abs(found - value)) < 1e-9 * abs(value)


def test_a_clutch_without_a_whirl_slower_than_the_engine_locks_up():
    assert whirl_under_surplus(CAR, 4500.0 * RPM, 80.0, 0.1) is None
    assert np.all(np.isnan(whirl_growth(CAR, 4500.0, 80.0, 0.1)))
