"""Motions on a support that hardens and has a stop, against plain integrations, plain roots and balances."""

import cmath
import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from plain_disc_engines import stuck_disc
from plain_engines import (
    just_released,
    pull_on_stuck_pin,
    release_after,
    stick_time_bounds,
    stuck_state,
    turned_with_disc,
)
from plain_slip import slide, slide_past_stop

from reference_model import DiscOnDisc, PinOnDisc, power_balance, simulate
from reference_model.formulas.disc import held_pin
from reference_model.motion.pin_equations import SlipMotion
from reference_model.motion.stick import _first_release, can_hold, release_delay

FIG_5 = PinOnDisc(mass=1.0, stiffness=1.0, damping=0.1, friction_force=0.09, disc_speed=1.5, offset=0.1)
FAST = replace(FIG_5, disc_speed=4.0)
FIG_6 = replace(FIG_5, friction_force=0.12, disc_speed=1.2)
DISC = DiscOnDisc(
    mass=1.0, polar_inertia=0.02, stiffness=1.0, damping=0.1, friction_force=0.09, disc_speed=1.5, offset=0.1,
    contact_radius=0.12, shaft_damping=0.005, shaft_speed=1.25,
)  # fmt: skip
HARD = {"hardening": 3.0}
SOFT_STOP = {"stop_gap": 0.12, "stop_stiffness": 0.5}
STOP = {"stop_gap": 0.15, "stop_stiffness": 20.0}


def event_times(trajectory):
    return [phase.start for phase in trajectory.phases[1:]]


# ---------------------------------------------------------------- slip


@pytest.mark.parametrize("stiffness", [1e2, 1e4, 1e6])
@pytest.mark.parametrize("start", [[0.2, 0.0, 1.0, 0.5], [0.0, 0.1, 0.3, 0.6]])
def test_pin_bounces_off_a_hard_stop_as_in_a_plain_integration(stiffness, start):
    # From the second start it comes as near to the stop as a thousandth of the gap's radius, or grazes it.
    pin = replace(FAST, stop_gap=0.5, stop_stiffness=stiffness, friction_force=0.05)
    times = np.linspace(0.0, 10.0, 101)
    expected = slide_past_stop(pin, start, times)
    tight = simulate(pin, start, times, tolerance=1e-13)
    # The tolerance in each unit of time, 1/ω, as above; in a bounce that is one of speed √(C_s/m) times as large.
    assert np.abs(tight.states - expected).max() < 1e-13 * 4.0 * 10.0 * math.sqrt(stiffness)
    usual = simulate(pin, start, times)
    assert np.abs(usual.states - expected).max() < 1e-9 * math.sqrt(stiffness)
    assert usual.solution.evaluations < 10_000


@pytest.mark.parametrize("tolerance", [1e-6, 1e-9, 1e-12])
@pytest.mark.parametrize("depth", [-1e-3, -1e-8, 1e-9, 1e-7])
def test_step_that_grazes_a_stop_on_its_way_does_not_miss_it(depth, tolerance):
    # An undamped ellipse about the axis with the semi-axes 1 and 1/2, on a disc at rest; the stop takes the tip.
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
    # The stop turns the pin back a little: its force is less by C_s times the square of half that time over m.
    # Rounding errors in place, up to 1e-13, become errors in speed √(C_s/m) = 100 times as large.
    accuracy = 3.0 * max(tolerance, 1e-11)
    assert np.abs(found.states - expected).max() < 1e4 * 8.0 * max(depth, 0.0) / 3.0 * push + accuracy
    assert (
        push == 0.0 or push > 10.0 * 1e4 * 8.0 * depth / 3.0 * push
    )  # so much of it is seen, if the tolerance lets


# ---------------------------------------------------------------- stick


@pytest.mark.parametrize("pin", [replace(FIG_6, hardening=1.0), replace(FIG_6, **SOFT_STOP)])
def test_stick_and_release_times_agree_with_a_plain_integrator_and_a_plain_root(pin):
    start = [0.1, 0.0, 0.03, 0.0]
    expected, t, state = [], 0.0, np.array(start)
    for _ in range(2):
        earliest, latest, t, state = stick_time_bounds(pin, state, t, longest=10.0)
        assert latest - earliest < 1e-8
        held = release_after(pin, state, longest=4.0)
        let_go = turned_with_disc(pin, state, held)
        release = t + held
        expected += [(earliest + latest) / 2.0, release]
        shortly = just_released(pin, let_go, 1e-4)
        early = slide(pin, shortly, [release + 1e-4, release + 0.05], method="Radau", rtol=1e-11, atol=1e-13)
        t, state = release + 0.05, early.y[:, -1]
    found = event_times(simulate(pin, start, [0.0, 12.0]))
    assert found == pytest.approx(expected, abs=1e-8)


coordinates = st.floats(-0.4, 0.4)


@st.composite
def stuck_pins(draw):
    """A pin and its place on the disc, where friction holds it with something to spare."""
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


@settings(max_examples=150)
@given(stuck_pins())
def test_release_is_the_first_time_at_which_the_pull_exceeds_friction(stuck):
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


@settings(max_examples=150)
@given(stuck_pins())
def test_search_for_the_release_finds_that_of_the_closed_form_on_a_linear_support(stuck):
    pin, z = stuck
    motion = SlipMotion.of(replace(pin, hardening=0.0, stop_stiffness=0.0))
    if can_hold(motion, z):
        # Near to grazing the time is the root of a parabola: 1e-15 of the force, 3e-8 of the time.
        assert _first_release(motion, z) == pytest.approx(release_delay(motion, z), rel=1e-7, abs=1e-11)


def test_slip_that_begins_next_to_the_stop_is_that_of_the_plain_integration():
    # The pin is let go where the stop begins, to within 1e-3 of the gap on either side.
    hard = replace(FIG_6, friction_force=0.3, damping=0.3)
    radius = 0.35
    held = stuck_state(hard, radius * math.cos(2.0), radius * math.sin(2.0))
    let_go = turned_with_disc(hard, held, release_after(hard, held, 6.0))
    gap = math.hypot(let_go[0] - hard.offset, let_go[1])
    for aside in (-1e-3, 1e-3):
        pin = replace(hard, stop_gap=(1.0 + aside) * gap, stop_stiffness=30.0)
        release = release_after(pin, held, 6.0)
        start = turned_with_disc(pin, held, release)
        times = np.array([0.0, 0.002, 0.01, 0.1, 0.5])
        found = simulate(pin, held, [0.0, *(release + times[1:])])
        assert event_times(found)[0] == pytest.approx(release, abs=1e-10)
        shortly = just_released(pin, start, 1e-5)
        plain = slide(pin, shortly, [1e-5, *times[1:]], method="Radau", rtol=1e-11, atol=1e-13).y.T
        assert np.abs(found.states[1:] - plain[1:]).max() < 1e-7


# ---------------------------------------------------------------- the friction disc


@pytest.mark.parametrize("points", [None, 6])
def test_stuck_disc_is_let_go_by_the_pull_on_its_centre_on_a_nonlinear_support(points):
    disc = replace(DISC, friction_force=0.12, disc_speed=1.2, contact_points=points, **SOFT_STOP)
    z = 0.1 * cmath.exp(-3j)  # it turns through the gap's circle before it is let go
    found = simulate(disc, stuck_disc(disc, z, 0.0), np.linspace(0.0, 6.0, 61))
    assert found.phases[0].kind == "stick"
    # A ring holds what its limit surface leaves beside the shaft's moment; six points within some per cent of it.
    pin = held_pin(replace(disc, contact_points=None))
    release = release_after(pin, stuck_state(pin, z.real, z.imag), 2.0 * math.pi / 1.2)
    before, after = abs(z - disc.offset), abs(z * cmath.exp(1.2j * release) - disc.offset)
    assert after < disc.stop_gap < before
    assert found.phases[1].start == pytest.approx(release, abs=1e-9 if points is None else 0.2)


@pytest.mark.parametrize("fault", [{"hardening": 3.03}, {"stop_gap": 0.1515}, {"stop_stiffness": 20.2}])
def test_balance_with_a_wrong_support_does_not_close(fault):
    support = HARD if "hardening" in fault else STOP
    pin = replace(FIG_5, **support)
    times = np.linspace(0.0, 10.0, 4001)
    right, wrong = (
        simulate(p, [0.6, 0.0, 0.0, 0.7], times, tolerance=1e-11) for p in (pin, replace(pin, **fault))
    )
    closed = power_balance(right)
    assert np.abs(closed.residual).max() < 2e-6 * closed.turned_over
    claimed = power_balance(type(wrong)(pin, wrong.times, wrong.states, wrong.phases, wrong.solution))
    assert np.abs(claimed.residual).max() > 1e-3 * claimed.turned_over
