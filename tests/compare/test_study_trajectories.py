from dataclasses import replace

import numpy as np
import pytest
from broken_engines import broken_engines, broken_on_discs
from studies_under_test import altered, findings_of, for_every_sound_engine, verdicts

from compare.claim import Verdict
from compare.engines import EVERY_KIND, Engine
from compare.studies.trajectories import (
    KINEMATICS,
    MOMENTUM,
    MOTIONS,
    MOVES,
    NODES,
    PANEL,
    STUDY,
    forces,
    gauss,
    measure,
    times_of,
)
from reference_model import simulate
from reference_model.systems import DiscOnDisc

PIN, RING, SIX = "a pin", "a disc on the continuous ring", "a disc on six points"

FEW = {name: MOTIONS[name] for name in (PIN, RING, SIX)}


@for_every_sound_engine
def test_sound_engines_move_as_the_reference_and_their_forces_add_up(engine):
    findings = measure(engine)
    assert len(findings.claims) == 3 * len(MOTIONS) - 2  # of the one that sticks only the first
    assert set(verdicts(findings).values()) == {Verdict.AGREES}


@pytest.mark.parametrize("name", MOTIONS)
def test_nothing_comes_to_rest_where_forces_are_integrated(name):
    motion = MOTIONS[name]
    run = simulate(motion.system, motion.start, np.linspace(0.0, motion.until, 801), tolerance=1e-10)
    assert any(phase.kind != "slip" for phase in run.phases) is motion.sticks
    if isinstance(motion.system, DiscOnDisc):
        rim = motion.system.contact_radius * np.abs(motion.system.disc_speed - run.states[:, 5])
        assert np.min(np.abs(run.slip_speed - rim)) > 0.01  # no point of the ring rests either


def test_no_two_parameters_are_equal():
    for name in (PIN, RING):
        values = [value for value in vars(MOTIONS[name].system).values() if value]
        assert len(set(values)) == len(values)
        assert 1.0 not in values


@pytest.mark.parametrize("pole", [0.01, 0.1, 1.0])
def test_gauss_integrates_to_the_error_that_it_tells(pole):
    places = times_of(MOTIONS[PIN])[1 : len(NODES) + 1]
    found, error = gauss((1.0 / (pole + places))[np.newaxis, :, np.newaxis])
    missed = abs(found.item() - np.log((pole + PANEL) / pole))
    assert missed <= error.item() + 4.0 * np.finfo(float).eps


@pytest.mark.parametrize("name", [PIN, "a pin on a support that hardens, beyond its stop", RING, SIX])
def test_forces_are_those_that_the_reference_moves_by(name):
    """The change of velocity over a short time, by a simulation."""
    motion = MOTIONS[name]
    half, h = motion.system.state_size // 2, 1e-4
    states = simulate(motion.system, motion.start, [0.0, h, 2.0 * h], tolerance=1e-13).states
    inertia = [motion.system.mass] * 2 + ([motion.system.polar_inertia] if half == 3 else [])
    change = np.array(inertia) * (states[2] - states[0])[half:] / (2.0 * h)
    assert forces(motion.system, states[1]) == pytest.approx(change, abs=1e-6)


@pytest.mark.parametrize(
    "parameter",
    [name for name, value in vars(MOTIONS[RING].system).items() if value],
)
def test_an_error_of_a_millionth_in_any_parameter_is_found_by_trajectory_and_by_momentum(parameter):
    pin_too = hasattr(MOTIONS[PIN].system, parameter)
    motions = FEW if pin_too else {name: motion for name, motion in FEW.items() if name != PIN}
    found = verdicts(measure(altered(**{parameter: 1.0 + 1e-6}), motions))
    for name in motions:
        assert found[MOVES.format(name)] is Verdict.DIFFERS
        assert found[MOMENTUM.format(name)] is Verdict.DIFFERS


@pytest.mark.parametrize("name", ["wrong sign", "half the damping"])
def test_a_wrong_force_is_found(name):
    found = verdicts(measure(broken_engines()[name], {PIN: MOTIONS[PIN]}))
    assert found[MOVES.format(PIN)] is found[MOMENTUM.format(PIN)] is Verdict.DIFFERS


@pytest.mark.parametrize("name", ["moment 1 % off", "five points"])
def test_a_wrong_moment_is_found(name):
    found = verdicts(measure(broken_on_discs()[name], {SIX: MOTIONS[SIX]}))
    assert found[MOVES.format(SIX)] is found[MOMENTUM.format(SIX)] is Verdict.DIFFERS


def test_an_angle_that_is_not_the_integral_of_spin_is_found():
    def wrapped(system, initial_state, times, *, tolerance=1e-9):
        run = simulate(system, initial_state, times, tolerance=tolerance)
        states = run.states.copy()
        states[:, 2] = (states[:, 2] + np.pi) % (2.0 * np.pi) - np.pi
        return replace(run, states=states)

    found = verdicts(measure(Engine("wrapped", wrapped, EVERY_KIND), {RING: MOTIONS[RING]}))
    assert found[KINEMATICS.format(RING)] is found[MOVES.format(RING)] is Verdict.DIFFERS
    assert found[MOMENTUM.format(RING)] is Verdict.AGREES


def test_an_engine_is_measured_on_what_it_promises():
    findings = measure(Engine("pins that slip", simulate, ("pin",), sticks=False))
    assert len(findings.claims) == 9
    assert "disc" in findings.not_simulated


def test_the_figure_copes_with_what_is_missing():
    findings = findings_of(STUDY, "reference", {})
    assert list(STUDY.draw({"reference": findings.data})) == ["trajectories"]
    STUDY.draw({})
