"""Ends of single trajectories of the plain reference, for motions whose ends the theory knows."""

from dataclasses import replace

import numpy as np
import pytest

from compare.paper import CENTRED, FIG5, FIG5_STARTS, FIG11
from compare.sweep.plain import end_of, plain_trajectory
from reference_model import sticking_radius, whirls
from reference_model.ensemble import EndState


def end(system, start, duration, tolerance=1e-9):
    return end_of(plain_trajectory(system, np.array(start), 0.3 * duration, duration, tolerance))


def test_both_motions_of_fig_5():
    assert end(FIG5, FIG5_STARTS["equilibrium"], 300.0) == EndState.SELF_CENTRED
    assert end(FIG5, FIG5_STARTS["whirl"], 300.0) == EndState.WHIRL


def test_a_whirl_about_an_axis_without_offset():
    (whirl,) = whirls(CENTRED)
    assert end(CENTRED, whirl.state, 60.0) == EndState.WHIRL


@pytest.mark.parametrize("speed", [0.8, -0.8])
def test_a_pin_inside_of_the_sticking_radius_is_stuck(speed):
    pin = replace(FIG5, friction_force=0.15, disc_speed=speed)
    radius = 0.9 * sticking_radius(pin)
    assert end(pin, (radius, 0.0, 0.0, speed * radius), 60.0) == EndState.STUCK


def test_a_pin_that_sticks_beyond_the_sticking_radius_slips_and_sticks_again_and_again():
    pin = replace(FIG5, friction_force=0.124, disc_speed=0.8)
    assert end(pin, (0.1, 0.0, 0.03, 0.0), 300.0) == EndState.STICK_SLIP


def test_the_modulated_cycle_of_fig_11():
    assert end(FIG11, (0.02, 0.0, 0.0, 0.0, 0.0, 1.3), 1500.0, 1e-6) == EndState.MODULATED


def test_a_transient_is_undecided():
    assert end(FIG5, FIG5_STARTS["whirl"], 100.0) == EndState.UNDECIDED


def test_a_whirl_turning_the_other_way():
    pin = replace(FIG5, disc_speed=-1.5)
    x, y, vx, vy = FIG5_STARTS["whirl"]
    assert end(pin, (x, -y, vx, -vy), 300.0) == EndState.WHIRL
