"""The study of the launch agrees, and each of its claims fails for a drivetrain that is wrong."""

import functools
import math
from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import quad
from studies_under_test import findings_of, verdicts

import exudyn_models
from compare.claims.claim import Verdict
from compare.engines import engines
from compare.studies.drivetrain.launch import claims as study
from compare.studies.drivetrain.launch.theory import FullSlip, Launch, states_at
from exudyn_models import PASSENGER_CAR, RingFriction, four_cylinder

ENGINE = engines(["exudyn"])[0]
CENTRED = study.centred(PASSENGER_CAR)
SENTENCES = [study.BALANCE, study.MOMENTUM, study.FULL_SLIP, study.EXACT, study.HELD, study.ORDER]


@functools.cache
def measured():
    return findings_of(study, "exudyn", {})


@functools.cache
def exact_launch():
    return Launch(CENTRED, study.capacity, study.KNOTS[1:], four_cylinder(100.0, 1.0), study.resistance)


@functools.cache
def exact_parts():
    return exact_launch().run(study.ENGINE_SPEED, study.UNTIL)


def test_every_statement_holds():
    assert verdicts(measured()) == dict.fromkeys(SENTENCES, Verdict.AGREES)


def test_figures_are_drawn_of_what_there_is():
    figures = study.draw({"exudyn": measured().data})
    assert set(figures) == set(study.STUDY.figures)
    for figure in figures.values():
        figure.canvas.draw()
    assert study.draw({}) == {}


def test_the_car_slips_sticks_and_slips_again():
    assert [part.sticks for part in exact_parts()] == [False, False, True, True, False, False]
    data = measured().data
    slip = data["speeds"][:, 0] - data["speeds"][:, 1]
    creep = study.EPSILONS[0] / CENTRED.friction_radius
    start, end = data["stick"]
    during = (data["t"] > start + 0.01) & (data["t"] < end - 0.01)
    assert np.abs(slip[during]).max() < creep
    assert slip[0] > 200.0
    assert slip[-1] > 10.0


def test_friction_pulls_the_disc_towards_the_engines_axis_where_the_slip_ends():
    data = measured().data
    radius = np.hypot(*data["centre"].T)
    before, stuck = (np.interp(time, data["t"], radius) for time in (0.5, study.STUCK[-1]))
    assert before == pytest.approx(PASSENGER_CAR.offset, rel=0.02)
    assert stuck < 0.5 * PASSENGER_CAR.offset


@pytest.mark.parametrize("stiffness", [1000.0, 1500.0])
def test_closed_form_of_full_slip_is_that_of_the_equations(stiffness):
    theory = FullSlip(replace(CENTRED, torsional_stiffness=stiffness), 210.0, 100.0, 225.0)
    until = theory.time_of(10.0)
    (part,) = Launch(theory.rotors, lambda t: 225.0 * t, [], lambda *_: 100.0, lambda *_: 0.0).run(
        210.0, until
    )
    *_, engine, disc, vehicle, heat = part.states(until)
    assert engine - disc == pytest.approx(10.0, rel=1e-9)
    np.testing.assert_allclose(theory.speeds(until), [engine, disc, vehicle], rtol=1e-11)
    assert theory.heat(until) == pytest.approx(heat, rel=1e-11)


def test_exact_launch_keeps_energy_and_sticks_within_its_capacity():
    launch, parts = exact_launch(), exact_parts()

    def power(t):
        state = states_at(parts, t)
        engine = launch.engine_torque(t, state[0], state[3]) * state[3]
        vehicle = launch.vehicle_torque(t, state[2], state[5]) * state[5]
        return engine + vehicle - CENTRED.torsional_damping * (state[4] - state[5]) ** 2

    gained = sum(quad(power, part.start, part.end, limit=400, epsrel=1e-10)[0] for part in parts)
    start, end = parts[0].states(0.0), parts[-1].states(study.UNTIL)
    inertias = np.array([CENTRED.engine_inertia, CENTRED.disc_inertia, CENTRED.vehicle_inertia])

    def stored(state):
        return (inertias @ state[3:6] ** 2 + CENTRED.torsional_stiffness * (state[1] - state[2]) ** 2) / 2.0

    assert stored(end) - stored(start) + end[6] == pytest.approx(gained, rel=1e-8)
    for part in parts:
        times = np.linspace(part.start, part.end, 50)[1:-1]
        if part.sticks:
            assert all(launch.spare(t, part.states(t)) > 0.0 for t in times)
            assert all(abs(part.states(t)[3] - part.states(t)[4]) < 1e-9 for t in times)
        else:
            assert all(part.states(t)[3] > part.states(t)[4] for t in times)


def with_car(monkeypatch, **factors):
    """Let every drivetrain be built with parameters that are off by ``factors``."""
    build = exudyn_models.build_drivetrain

    def off(car, **options):
        # The load stays that of the true clutch.
        return build(
            replace(car, **{name: factor * getattr(car, name) for name, factor in factors.items()}), **options
        )

    monkeypatch.setattr(exudyn_models, "build_drivetrain", off)


SLIP_CLAIMS = {
    study.MOMENTUM: lambda: study.claim_of_momentum(ENGINE, PASSENGER_CAR),
    study.FULL_SLIP: lambda: study.claim_of_full_slip(ENGINE, CENTRED),
}
SEES, BLIND = Verdict.DIFFERS, Verdict.AGREES


@pytest.mark.parametrize(
    ("fault", "of_momentum", "of_full_slip"),
    [
        ("engine_inertia", SEES, SEES),
        ("disc_inertia", SEES, SEES),
        ("vehicle_inertia", SEES, SEES),
        ("friction_coefficient", BLIND, SEES),  # friction is inner force
        ("torsional_stiffness", BLIND, SEES),
        # not of torsional damping, which acts on the first oscillation only: 2e-11 of the heat, as much as the error
        ("unbalance", SEES, BLIND),  # of a centred disc there is none
    ],
)
def test_a_drivetrain_that_is_off_by_a_thousandth_is_found_out(monkeypatch, fault, of_momentum, of_full_slip):
    with_car(monkeypatch, **{fault: 1.001})
    found = {sentence: claim().verdict for sentence, claim in SLIP_CLAIMS.items()}
    assert found == {study.MOMENTUM: of_momentum, study.FULL_SLIP: of_full_slip}


def test_heat_that_is_not_counted_is_found_out(monkeypatch):
    power = RingFriction.power
    monkeypatch.setattr(RingFriction, "power", lambda self, mbs, t: 0.99999 * power(self, mbs, t))
    monkeypatch.setattr(study, "launch", functools.partial(study.launch, until=0.3))
    assert study.claim_of_balance(ENGINE, PASSENGER_CAR, {}).verdict is Verdict.DIFFERS
    assert SLIP_CLAIMS[study.FULL_SLIP]().verdict is Verdict.DIFFERS


def of_stick():
    claims = study.claims_of_stick(ENGINE, CENTRED, study.EPSILONS, {})
    return {claim.sentence: claim.verdict for claim in claims}


def test_a_clutch_that_holds_less_is_found_out(monkeypatch):
    with_car(monkeypatch, friction_coefficient=0.99)
    assert of_stick()[study.EXACT] is Verdict.DIFFERS


def test_creep_of_another_size_and_of_another_order_is_found_out(monkeypatch):
    build = exudyn_models.build_drivetrain
    monkeypatch.setattr(
        exudyn_models,
        "build_drivetrain",
        lambda car, *, regularisation, **options: build(
            car, regularisation=math.sqrt(0.1 * regularisation), **options
        ),
    )
    found = of_stick()
    assert found[study.HELD] is Verdict.DIFFERS
    assert found[study.ORDER] is Verdict.DIFFERS
