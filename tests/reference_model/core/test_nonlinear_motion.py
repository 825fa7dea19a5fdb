"""Motions on a support with a stop, against plain integrators and closed forms."""

import math

import numpy as np
import pytest
from plain_slip import slide_past_stop

from reference_model import PinOnDisc, simulate


@pytest.mark.parametrize("stiffness", [1e2, 1e6])
@pytest.mark.parametrize("start", [[0.2, 0.0, 1.0, 0.5], [0.0, 0.1, 0.3, 0.6]])
def test_pin_bounces_off_a_hard_stop_as_in_a_plain_integration(stiffness, start):
    # From the second start the pin grazes the stop or passes it at a thousandth of the gap.
    pin = PinOnDisc(
        mass=1.0, stiffness=1.0, damping=0.1, friction_force=0.05, disc_speed=4.0, offset=0.1, stop_gap=0.5,
        stop_stiffness=stiffness,
    )  # fmt: skip
    times = np.linspace(0.0, 10.0, 21)
    expected = slide_past_stop(pin, start, times)
    tight, usual = (simulate(pin, start, times, tolerance=tolerance) for tolerance in (1e-13, 1e-9))
    # The error is one tolerance per unit of time 1/ω. A bounce makes the error of the speed √(C_s/m) times larger.
    assert np.abs(tight.states - expected).max() < 1e-13 * 4.0 * 10.0 * math.sqrt(stiffness)
    assert np.abs(usual.states - expected).max() < 1e-9 * math.sqrt(stiffness)
    assert usual.solution.evaluations < 10_500  # up to 10,005, with rounding


@pytest.mark.parametrize("tolerance", [1e-6, 1e-9, 1e-12])
@pytest.mark.parametrize("depth", [-1e-8, 1e-9, 1e-7])
def test_step_across_a_grazed_stop_detects_the_contact(depth, tolerance):
    # The undamped motion is an ellipse with semi-axes 1 and 1/2 on a disc at rest. Its tip touches the stop.
    pin = PinOnDisc(
        mass=1.0, stiffness=1.0, damping=0.0, friction_force=0.0, disc_speed=0.0, stop_gap=1.0 - depth,
        stop_stiffness=1e4,
    )  # fmt: skip
    times = np.linspace(0.0, 3.0, 7)
    found = simulate(pin, [0.0, 0.5, 1.0, 0.0], times, tolerance=tolerance)
    # Near the tip the radius is 1 − (3/8)τ²: the stop acts for √(32·depth/3), with 2/3 of its peak on average.
    push = 1e4 * (2.0 / 3.0) * depth * math.sqrt(32.0 * depth / 3.0) if depth > 0.0 else 0.0
    after = np.maximum(times - math.pi / 2.0, 0.0)
    x, vx = np.sin(times) - push * np.sin(after), np.cos(times) - push * np.cos(after) * (after > 0.0)
    expected = np.column_stack((x, 0.5 * np.cos(times), vx, -0.5 * np.sin(times)))
    # The stop decelerates the pin, so its force is smaller by C_s times the square of half that time over m.
    # Rounding errors in the position, up to 1e-13, become √(C_s/m) = 100 times larger errors in the speed.
    accuracy = 13.0 * max(tolerance, 1e-11)
    assert np.abs(found.states - expected).max() < 1e4 * 8.0 * max(depth, 0.0) / 3.0 * push + accuracy
    # The effect of the push is large enough to be seen.
    assert push == 0.0 or 1e4 * 8.0 * depth / 3.0 < 0.1
