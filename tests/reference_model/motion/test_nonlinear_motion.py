"""Motions on a support that hardens and has a stop, against plain integrators and closed forms."""

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from plain_engines import pull_on_stuck_pin, stuck_state, turned_with_disc
from plain_slip import slide_past_stop

from reference_model import PinOnDisc, simulate
from reference_model.motion.pin_equations import SlipMotion
from reference_model.motion.stick import _first_release

FIG_5 = PinOnDisc(mass=1.0, stiffness=1.0, damping=0.1, friction_force=0.09, disc_speed=1.5, offset=0.1)
FAST = replace(FIG_5, disc_speed=4.0)


@pytest.mark.parametrize("stiffness", [1e2, 1e6])
@pytest.mark.parametrize("start", [[0.2, 0.0, 1.0, 0.5], [0.0, 0.1, 0.3, 0.6]])
def test_pin_bounces_off_a_hard_stop_as_in_a_plain_integration(stiffness, start):
    # From the second start the pin grazes the stop or passes it at a thousandth of the gap.
    pin = replace(FAST, stop_gap=0.5, stop_stiffness=stiffness, friction_force=0.05)
    times = np.linspace(0.0, 10.0, 21)
    expected = slide_past_stop(pin, start, times)
    tight = simulate(pin, start, times, tolerance=1e-13)
    # The error is one tolerance per unit of time 1/ω. A bounce makes the error of the speed √(C_s/m) times larger.
    assert np.abs(tight.states - expected).max() < 1e-13 * 4.0 * 10.0 * math.sqrt(stiffness)
    usual = simulate(pin, start, times)
    assert np.abs(usual.states - expected).max() < 1e-9 * math.sqrt(stiffness)
    assert usual.solution.evaluations < 10_000


@pytest.mark.parametrize("tolerance", [1e-6, 1e-9, 1e-12])
@pytest.mark.parametrize("depth", [-1e-3, -1e-8, 1e-9, 1e-7])
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
    accuracy = 3.0 * max(tolerance, 1e-11)
    assert np.abs(found.states - expected).max() < 1e4 * 8.0 * max(depth, 0.0) / 3.0 * push + accuracy
    # The effect of the push is large enough to be seen.
    assert push == 0.0 or 1e4 * 8.0 * depth / 3.0 < 0.1


coordinates = st.floats(-0.4, 0.4)


@st.composite
def stuck_pins(draw):
    """Draw a pin and a position on the disc where friction can hold it with a margin."""
    pin = PinOnDisc(
        mass=draw(st.floats(0.5, 2.0)),
        stiffness=draw(st.floats(0.0, 2.0)),
        damping=draw(st.floats(0.0, 0.5)),
        friction_force=0.0,
        disc_speed=draw(st.sampled_from([-2.3, -0.9, 0.4, 1.3])),
        offset=draw(st.sampled_from([-0.3, 0.02, 0.1])),
        hardening=draw(st.sampled_from([0.0, 1.0, 20.0])),
        stop_gap=draw(st.floats(0.0, 0.4)),
        stop_stiffness=draw(st.sampled_from([0.0, 5.0, 200.0])),
    )
    x, y, spare = draw(coordinates), draw(coordinates), draw(st.floats(1e-3, 0.5))
    pull = math.hypot(*pull_on_stuck_pin(pin, stuck_state(pin, x, y)))
    assume(pull > 1e-6)
    return replace(pin, friction_force=(1.0 + spare) * pull), complex(x, y)


@settings(max_examples=100)
@given(stuck_pins())
def test_release_is_the_first_time_when_the_pull_exceeds_friction(stuck):
    pin, z = stuck
    found = _first_release(SlipMotion.of(pin), z)
    turn = 2.0 * math.pi / abs(pin.disc_speed)
    pulls = [
        math.hypot(*pull_on_stuck_pin(pin, turned_with_disc(pin, stuck_state(pin, z.real, z.imag), time)))
        for time in np.linspace(0.0, min(found, turn), 150)
    ]
    assert max(pulls) <= pin.friction_force * (1.0 + 1e-7)
    if found < math.inf:
        assert pulls[-1] == pytest.approx(pin.friction_force, rel=1e-10)
