"""The exact motion of rotors with clutches agrees with closed forms."""

import math

import numpy as np
import pytest

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


def test_a_clutch_may_connect_geared_rotors_and_the_ground():
    """A brake of 5 N m stops the second of two speeds that a gear adds up, and a torque of 3 N m cannot move it."""
    masses = np.array([[3.0, 1.0], [1.0, 2.0]])
    given = Chain(masses, [NOTHING, pieces(3.0)], [pieces(5.0)], slips=np.array([[0.0, 1.0]]))
    motion = given.motion([0.0, 2.0], 3.0)
    deceleration = 2.0 / (2.0 - 1.0 / 3.0)  # the first speed is free
    assert motion.switches(0) == [(pytest.approx(2.0 / deceleration, rel=1e-14), STUCK)]
    np.testing.assert_allclose(motion.states(np.array([3.0]))[1], [[2.0 / 3.0, 0.0]], atol=1e-14)
