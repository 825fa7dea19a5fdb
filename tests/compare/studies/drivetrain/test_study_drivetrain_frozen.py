"""The car's drivetrain agrees with the reference at frozen speeds, and a drivetrain that is another one does not."""

from dataclasses import replace

import numpy as np
import pytest
from studies_under_test import sentences, verdicts

import exudyn_models.paper.linearisation
from compare.claims.claim import Verdict
from compare.claims.study import Findings
from compare.engines import engines
from compare.studies.drivetrain.frozen import claims as drivetrain_frozen
from compare.studies.drivetrain.frozen import map as drivetrain_map
from compare.studies.drivetrain.frozen import modulated as drivetrain_modulated
from compare.studies.drivetrain.frozen import onset as drivetrain_onset
from compare.studies.drivetrain.frozen.linear import of_modulation, state_matrix_of, whirl_under_surplus
from compare.studies.toolkit import drivetrain_bench, drivetrain_steady
from compare.studies.toolkit.drivetrain_bench import RPM, Operation, facings, passenger_car
from reference_model import DiscOnDisc, whirls
from reference_model.steady.stability import whirl_eigenvalues

CAR = replace(passenger_car(), offset=0.0, unbalance=0.0)


@pytest.fixture
def few(monkeypatch):
    """Two speeds in place of six, and a short look at the modulated whirl."""
    monkeypatch.setattr(drivetrain_steady, "BELOW", (1500.0,))
    monkeypatch.setattr(drivetrain_steady, "ABOVE", (6000.0,))
    monkeypatch.setattr(drivetrain_modulated, "UNTIL", 0.1)


@pytest.fixture(scope="module")
def theory():
    return drivetrain_frozen.theory()


def test_every_statement_holds_and_the_figures_show_it(few, theory):
    findings = drivetrain_frozen.measure(engines(["exudyn"])[0])
    assert set(verdicts(findings).values()) == {Verdict.AGREES}
    assert set(verdicts(theory).values()) == {Verdict.AGREES}
    assert len(findings.claims) == 9
    figures = drivetrain_frozen.STUDY.draw({"exudyn": findings.data, "theory": theory.data})
    assert set(figures) == set(drivetrain_frozen.STUDY.figures)
    assert drivetrain_frozen.STUDY.draw({}) == {}


def steady(monkeypatch, **changes):
    """Return the sentences about steady motions that differ when the drivetrain on the bench is another one."""
    build = Operation.build
    monkeypatch.setattr(Operation, "build", lambda operation, car: build(operation, replace(car, **changes)))
    claims, _ = drivetrain_steady.claims_of_steady_motions("exudyn", passenger_car())
    return sentences(Findings(claims), Verdict.DIFFERS)


def test_another_stop_is_found_out(few, monkeypatch):
    found = steady(monkeypatch, stop_gap=CAR.stop_gap * (1.0 + 1e-6))
    assert found == {drivetrain_steady.RADIUS}


def test_another_radial_stiffness_is_found_out(few, monkeypatch):
    found = steady(monkeypatch, radial_stiffness=CAR.radial_stiffness * (1.0 + 1e-5))
    assert {drivetrain_steady.RESTS, drivetrain_steady.RADIUS} <= found


def test_another_coefficient_of_friction_is_found_out(few, monkeypatch):
    found = steady(monkeypatch, inner_radius=CAR.inner_radius * (1.0 + 1e-5))
    assert {drivetrain_steady.RESTS, drivetrain_steady.FREQUENCY, drivetrain_steady.SLIP} <= found


def test_another_damping_is_found_out_at_the_onset(monkeypatch):
    import exudyn_models

    build = exudyn_models.build_drivetrain
    other = CAR.radial_damping * (1.0 + 1e-9)
    monkeypatch.setattr(
        exudyn_models,
        "build_drivetrain",
        lambda car, **options: build(replace(car, radial_damping=other), **options),
    )
    claim = drivetrain_onset.claim_of_linearised_drivetrain("exudyn", CAR)
    assert claim.verdict is Verdict.DIFFERS


def test_a_reaction_without_the_arm_of_the_force_is_found_out_in_the_linearisation(monkeypatch):
    matrix = exudyn_models.paper.linearisation.state_matrix

    def without_arm(mbs):
        result = matrix(mbs)
        result[5] = (
            -result[9] * CAR.disc_inertia / CAR.engine_inertia
        )  # the engine's row, from that of the disc
        return result

    monkeypatch.setattr(exudyn_models.paper.linearisation, "state_matrix", without_arm)
    assert drivetrain_modulated.claim_of_linearisation("exudyn", CAR).verdict is Verdict.DIFFERS


def test_another_friction_is_found_out_in_the_border_of_the_modulation(monkeypatch):
    build = drivetrain_modulated.build
    other = replace(CAR, inner_radius=CAR.inner_radius * (1.0 + 1e-6))
    monkeypatch.setattr(
        drivetrain_modulated, "build", lambda car, whirl, **options: build(other, whirl, **options)
    )
    claim = drivetrain_modulated.claim_of_border("exudyn", CAR)
    assert claim.verdict is Verdict.DIFFERS
    assert np.all(claim.difference > 10.0 * claim.budget.total)


def test_where_no_speed_divides_growth_from_decay_there_is_no_border(monkeypatch):
    monkeypatch.setattr(drivetrain_modulated, "BETWEEN", (4300.0, 4500.0))
    claim = drivetrain_modulated.claim_of_border("exudyn", CAR)
    assert np.all(np.isnan(claim.measured))
    assert claim.verdict is Verdict.DIFFERS


def test_another_inertia_of_the_engine_is_found_out_in_the_growth(monkeypatch):
    monkeypatch.setattr(drivetrain_modulated, "build", other_engine(drivetrain_modulated.build))
    assert drivetrain_modulated.claim_of_growth("exudyn", CAR).verdict is Verdict.DIFFERS


def other_engine(build):
    heavier = CAR.engine_inertia * 1.01
    return lambda car, whirl, **options: build(replace(car, engine_inertia=heavier), whirl, **options)


def test_a_balance_that_does_not_close_is_found_out():
    class Balance:
        residual, turnover = np.array([0.0, 2e-6]), 1.0

    claim = drivetrain_bench.balance_claim("words", "exudyn", [Balance(), Balance()], {})
    assert claim.verdict is Verdict.DIFFERS


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
    found = whirls(reduced(whirl), facings(CAR))
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
    assert np.all(np.isnan(drivetrain_map.whirl_growth(CAR, 4500.0, 80.0, 0.1)))


def test_a_whirl_on_the_stop_is_steady_and_one_in_the_play_at_speed_is_not(theory):
    growth, radius = np.moveaxis(theory.data["over speed"], -1, 0)
    there = np.isfinite(growth)
    on_stop = there & (radius > CAR.stop_gap)
    assert np.any(on_stop)
    assert np.all(growth[on_stop] < 0.0)
    in_play = there & (radius < CAR.stop_gap)
    speeds = np.broadcast_to(theory.data["speeds"], growth.shape)
    assert np.all(growth[in_play & (speeds > 4200.0)] > 0.0)
    assert np.all(growth[in_play & (speeds < 4000.0)] < 0.0)
