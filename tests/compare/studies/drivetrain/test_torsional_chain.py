"""The exact motion of rotors with clutches, beside closed forms, laws of conservation and an integration."""

import math

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from compare.studies.drivetrain.coupled_clutches.theory import INERTIAS, SPEED, UNTIL, chain, exact, torque
from compare.studies.toolkit.torsional_chain import BACKWARD, FORWARD, OPEN, STUCK, Chain, Harmonic

NOTHING = ((0.0, Harmonic()),)


def pieces(amplitude, rate=0.0, phase=math.pi / 2.0):
    return ((0.0, Harmonic(amplitude, rate, phase)),)


@pytest.mark.parametrize("harmonic", [Harmonic(2.0), Harmonic(2.0, 3.0, 0.4), Harmonic(2.0, 1e-3, 0.4)])
def test_integrals_of_a_harmonic_are_those_of_its_values(harmonic):
    found = solve_ivp(lambda t, y: [float(harmonic(t)), y[0]], (0.3, 2.0), [0.0, 0.0], rtol=1e-12, atol=1e-14)
    np.testing.assert_allclose(harmonic.integrals(0.3, np.array([2.0])), found.y[:, -1:], rtol=1e-10)


def test_two_rotors_lock_up_when_the_torque_has_taken_their_slip():
    motion = Chain((2.0, 3.0), [NOTHING, NOTHING], [pieces(5.0)]).motion([7.0, 1.0], 3.0)
    when = 6.0 / (5.0 / 2.0 + 5.0 / 3.0)
    assert motion.switches(0) == [(pytest.approx(when, rel=1e-14), STUCK)]
    np.testing.assert_allclose(motion.states(np.array([3.0]))[1], [[3.4, 3.4]], rtol=1e-14)


@pytest.mark.parametrize("static_ratio", [1.0, 1.1])
def test_a_clutch_lets_go_where_it_is_asked_for_more_than_it_holds(static_ratio):
    # of a torque of 10·sin(t) N m on the first rotor three fifths go through the clutch
    given = Chain((2.0, 3.0), [pieces(10.0, 1.0, 0.0), NOTHING], [pieces(4.0)], static_ratio)
    motion = given.motion([0.0, 0.0], 3.0)
    (let_go, mode), *_ = motion.switches(0)
    assert mode == BACKWARD
    assert let_go == pytest.approx(math.asin(4.0 * static_ratio / 6.0), rel=1e-14)


def test_a_clutch_that_passes_zero_slip_under_a_large_torque_goes_on_to_slip():
    motion = Chain((1.0, 1.0), [pieces(-20.0), NOTHING], [pieces(1.0)]).motion([10.0, 0.0], 2.0)
    assert motion.switches(0) == [(pytest.approx(10.0 / 22.0), FORWARD)]


def test_a_clutch_without_load_is_open():
    motion = Chain((1.0, 1.0), [pieces(3.0), NOTHING], [NOTHING]).motion([0.0, 0.0], 2.0)
    assert motion.phases[0].modes == (OPEN,)
    np.testing.assert_allclose(motion.states(np.array([2.0])), [[[6.0, 0.0]], [[6.0, 0.0]]], atol=1e-14)


def test_coupled_clutches_are_those_of_an_integration_between_events():
    motion = exact()
    inertias = np.array(INERTIAS)
    for phase, end in zip(motion.phases, [*(p.begin for p in motion.phases[1:]), UNTIL], strict=True):

        def rates(t, y, phase=phase):
            through = phase.transmitted(np.array([t]))[0]
            given = np.array([torque(t), *through]) - np.array([*through, 0.0])
            return np.concatenate((y[4:], given / inertias))

        start = np.concatenate((phase.angles, phase.speeds))
        found = solve_ivp(rates, (phase.begin, end), start, rtol=1e-12, atol=1e-13, method="DOP853")
        together = np.hstack(phase.states(np.array([end])))[0]
        np.testing.assert_allclose(found.y[:, -1], together, atol=2e-11)


def test_coupled_clutches_hold_no_more_than_they_can_and_slip_the_way_they_are_drawn():
    motion, given = exact(), chain()
    for phase, end in zip(motion.phases, [*(p.begin for p in motion.phases[1:]), UNTIL], strict=True):
        t = np.linspace(phase.begin, end, 101)[1:-1]
        capacities = np.array([f(t) for f in given.in_force(phase.begin)[4:]]).T
        slips, through = np.diff(phase.states(t)[1], axis=1), phase.transmitted(t)
        for i, mode in enumerate(phase.modes):
            if mode == STUCK:
                np.testing.assert_allclose(slips[:, i], 0.0, atol=1e-13)
                assert np.all(np.abs(through[:, i]) <= given.static_ratio * capacities[:, i])
            elif mode == OPEN:
                assert np.all(through[:, i] == 0.0)
            else:
                assert np.all(mode * slips[:, i] > 0.0)
                np.testing.assert_allclose(through[:, i], -mode * capacities[:, i], rtol=1e-14)


def test_coupled_clutches_gain_what_the_torque_gives():
    t = np.linspace(0.0, UNTIL, 40)
    impulse = SPEED + 10.0 / (10.0 * math.pi) * (1.0 - np.cos(10.0 * math.pi * t))
    np.testing.assert_allclose(exact().states(t)[1] @ np.array(INERTIAS), impulse, rtol=1e-14)
