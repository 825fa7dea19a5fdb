"""The car's drivetrain agrees with the reference at frozen speeds, and a drivetrain that is another one does not."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from study_harness import BLIND, LEFT_OUT, SEES, engine_named
from wrong_parts import WrongPartTests

import exudyn_models
from compare.claims.claim import Verdict
from compare.studies.drivetrain.frozen import STUDY, whirls
from compare.studies.drivetrain.frozen.theory import (
    of_modulation,
    state_matrix_of,
    whirl_growth,
    whirl_under_surplus,
)
from compare.studies.toolkit.drivetrain_bench import RPM, Operation, centred_car, facings
from exudyn_models.solver import linear_matrices
from reference_model import DiscOnDisc
from reference_model import whirls as whirls_of_reference
from reference_model.steady.stability import whirl_eigenvalues

CAR = centred_car()

SLOW, FAST = (1500.0,), (6000.0,)
"""Turns a minute: one speed below the onset, and one above, in place of three."""


def bench_with(**factors):
    """Let the drivetrain on the bench be another one, off by ``factors``."""

    def put(patch):
        build = Operation.build
        changes = {name: factor * getattr(CAR, name) for name, factor in factors.items()}
        patch.setattr(Operation, "build", lambda operation, car: build(operation, replace(car, **changes)))

    return put


def damping_of_the_whole_drivetrain(patch):
    build = exudyn_models.build_drivetrain
    other = CAR.radial_damping * (1.0 + 1e-9)
    patch.setattr(
        exudyn_models,
        "build_drivetrain",
        lambda car, **options: build(replace(car, radial_damping=other), **options),
    )


def reaction_without_the_arm_of_the_force(patch):
    matrix = linear_matrices.state_matrix

    def without_arm(mbs):
        result = matrix(mbs)
        # The engine's row, from that of the disc.
        result[5] = -result[9] * CAR.disc_inertia / CAR.engine_inertia
        return result

    patch.setattr(linear_matrices, "state_matrix", without_arm)


def whirl_of_a_car_with(**factors):
    """Let the car in a whirl be another one, off by ``factors``."""

    def put(patch):
        build = whirls.build
        other = replace(CAR, **{name: factor * getattr(CAR, name) for name, factor in factors.items()})
        patch.setattr(whirls, "build", lambda car, whirl, **options: build(other, whirl, **options))

    return put


def balance_that_does_not_close(patch):
    motion = SimpleNamespace(
        times=np.zeros(2),
        disc=np.zeros((2, 3)),
        slip=np.zeros(2),
        energy=SimpleNamespace(residual=np.array([0.0, 2e-6]), turnover=1.0),
    )
    model = SimpleNamespace(run=lambda *_, **options: motion)
    patch.setattr(whirls, "build", lambda *_, **options: model)


class TestDrivetrainFrozen(WrongPartTests):
    study = STUDY
    few = {
        "rests": {"below": SLOW},
        "radius": {"above": FAST},
        "frequency": {"above": FAST},
        "slips": {"below": SLOW, "above": FAST},
        "balance": {"until": 0.1},
        "curves": {"every": 3},
    }
    faults = {
        "stop": bench_with(stop_gap=1.0 + 1e-6),
        "radial stiffness": bench_with(radial_stiffness=1.0 + 1e-5),
        "coefficient of friction": bench_with(inner_radius=1.0 + 1e-5),
        "damping": damping_of_the_whole_drivetrain,
        "reaction without its arm": reaction_without_the_arm_of_the_force,
        "friction in the whirl": whirl_of_a_car_with(inner_radius=1.0 + 1e-6),
        "engine's inertia in the whirl": whirl_of_a_car_with(engine_inertia=1.01),
        "balance": balance_that_does_not_close,
    }
    columns = (
        *("loses_stability", "rests", "radius", "frequency", "slips"),
        *("linearised", "border", "growth", "balance"),
    )
    table = {
        "stop": (LEFT_OUT, BLIND, SEES, BLIND, BLIND, *[LEFT_OUT] * 4),
        "radial stiffness": (LEFT_OUT, SEES, SEES, LEFT_OUT, LEFT_OUT, *[LEFT_OUT] * 4),
        "coefficient of friction": (LEFT_OUT, SEES, LEFT_OUT, SEES, SEES, *[LEFT_OUT] * 4),
        "damping": (SEES, *[LEFT_OUT] * 8),
        "reaction without its arm": (*[LEFT_OUT] * 5, SEES, *[LEFT_OUT] * 3),
        "friction in the whirl": (*[LEFT_OUT] * 6, SEES, LEFT_OUT, LEFT_OUT),
        "engine's inertia in the whirl": (*[LEFT_OUT] * 7, SEES, LEFT_OUT),
        "balance": (*[LEFT_OUT] * 8, SEES),
    }

    def test_another_friction_is_far_from_the_border_of_the_modulation(self):
        (claim,) = self.claims_of_fault("friction in the whirl", "border")
        assert np.all(claim.difference > 10.0 * claim.budget.total)

    def test_where_no_speed_divides_growth_from_decay_there_is_no_border(self):
        few = {"border": {"between": (4300.0, 4500.0)}}
        (claim,) = STUDY.measure(engine_named("exudyn"), few, only=("border",)).claims
        assert np.all(np.isnan(claim.measured))
        assert claim.verdict is Verdict.DIFFERS

    def test_a_whirl_on_the_stop_is_steady_and_one_in_the_play_at_speed_is_not(self):
        theory = self.found("theory").data
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
    """Return the disc on a master disc and a shaft that do not yield, which has that whirl."""
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
def test_a_whirl_under_surplus_is_one_of_the_reference(speed, torque, surplus):
    whirl = whirl_under_surplus(CAR, speed * RPM, torque, surplus)
    found = whirls_of_reference(reduced(whirl), facings(CAR))
    nearest = min(found, key=lambda each: abs(each.radius - whirl.radius))
    assert nearest.radius == pytest.approx(whirl.radius, rel=1e-9)
    assert nearest.frequency == pytest.approx(whirl.frequency, rel=1e-9)
    assert nearest.spin == pytest.approx(whirl.engine_speed - whirl.slip, rel=1e-9)


@pytest.mark.parametrize(("speed", "torque", "surplus"), WHIRLS)
def test_between_bodies_that_do_not_yield_the_eigenvalues_are_those_of_the_disc(speed, torque, surplus):
    whirl = whirl_under_surplus(CAR, speed * RPM, torque, surplus)
    held = replace(
        CAR, engine_inertia=1e30, vehicle_inertia=1e30, torsional_stiffness=0.0, torsional_damping=0.3
    )
    found = of_modulation(state_matrix_of(held, whirl), whirl.frequency)
    state = [whirl.radius, 0.0, 0.0, 0.0, whirl.frequency * whirl.radius, whirl.engine_speed - whirl.slip]
    for value in whirl_eigenvalues(reduced(whirl), state, facings(CAR))[1:]:
        assert np.min(np.abs(found - value)) < 1e-9 * abs(value)


def test_a_clutch_locks_up_where_no_whirl_is_slower_than_the_engine():
    assert whirl_under_surplus(CAR, 4500.0 * RPM, 80.0, 0.1) is None
    assert np.all(np.isnan(whirl_growth(CAR, 4500.0, 80.0, 0.1)))
