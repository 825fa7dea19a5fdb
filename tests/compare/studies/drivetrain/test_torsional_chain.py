"""The exact motion of rotors with clutches agrees with closed forms and an integration."""

import math

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from compare.studies.drivetrain.coupled_clutches.theory import INERTIAS, UNTIL, chain, exact, torque
from compare.studies.toolkit.torsional_chain import BACKWARD, FORWARD, OPEN, STUCK, Chain, Harmonic

NOTHING = ((0.0, Harmonic()),)


def pieces(amplitude, rate=0.0, phase=math.pi / 2.0):
    return ((0.0, Harmonic(amplitude, rate, phase)),)


def test_two_rotors_lock_up_at_zero_slip():
    motion = Chain((2.0, 3.0), [NOTHING, NOTHING], [pieces(5.0)]).motion([7.0, 1.0], 3.0)
    when = 6.0 / (5.0 / 2.0 + 5.0 / 3.0)
    assert motion.switches(0) == [(pytest.approx(when, rel=1e-14), STUCK)]
    np.testing.assert_allclose(motion.states(np.array([3.0]))[1], [[3.4, 3.4]], rtol=1e-14)


@pytest.mark.parametrize("static_ratio", [1.0, 1.1])
def test_a_clutch_slips_beyond_its_capacity(static_ratio):
    # The clutch transmits three fifths of the torque 10·sin(t) N m on the first rotor.
    given = Chain((2.0, 3.0), [pieces(10.0, 1.0, 0.0), NOTHING], [pieces(4.0)], static_ratio)
    motion = given.motion([0.0, 0.0], 3.0)
    (let_go, mode), *_ = motion.switches(0)
    assert mode == BACKWARD
    assert let_go == pytest.approx(math.asin(4.0 * static_ratio / 6.0), rel=1e-14)


def test_a_clutch_reverses_its_slip_under_a_large_torque():
    motion = Chain((1.0, 1.0), [pieces(-20.0), NOTHING], [pieces(1.0)]).motion([10.0, 0.0], 2.0)
    assert motion.switches(0) == [(pytest.approx(10.0 / 22.0), FORWARD)]


def test_a_clutch_without_load_is_open():
    motion = Chain((1.0, 1.0), [pieces(3.0), NOTHING], [NOTHING]).motion([0.0, 0.0], 2.0)
    assert motion.phases[0].modes == (OPEN,)
    np.testing.assert_allclose(motion.states(np.array([2.0])), [[[6.0, 0.0]], [[6.0, 0.0]]], atol=1e-14)


def test_the_exact_motion_agrees_with_an_integration_between_events():
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


def test_stuck_clutches_stay_below_their_capacity_and_slipping_ones_oppose_the_slip():
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
