"""Motions on a support that hardens and has a stop, against plain integrations, plain roots and balances."""

import cmath
import math
from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from disc_equations import disc_in_units
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from plain_disc_engines import slide_disc, stuck_disc
from plain_engines import (
    in_units,
    just_released,
    pull_on_stuck_pin,
    release_after,
    stick_time_bounds,
    stuck_state,
    turned_with_disc,
)
from plain_slip import slide, slide_past_stop

from reference_model import Annulus, DiscOnDisc, PinOnDisc, PointsOnRing, power_balance, simulate
from reference_model.formulas.disc import held_pin, pin_of
from reference_model.motion.disc_equations import DiscMotion
from reference_model.motion.pin_equations import SlipMotion
from reference_model.motion.pivot import OnePoint
from reference_model.motion.stepper import Thresholds
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
BOTH = {"hardening": 1.0, "stop_gap": 0.3, "stop_stiffness": 3.0}


def event_times(trajectory):
    return [phase.start for phase in trajectory.phases[1:]]


def deflection(trajectory):
    return np.hypot(trajectory.states[:, 0] - trajectory.system.offset, trajectory.states[:, 1])


# ---------------------------------------------------------------- slip


@pytest.mark.parametrize(
    ("support", "start"),
    [
        ({"hardening": 0.3}, [0.7, 0.0, 0.0, 0.75]),
        ({"hardening": 30.0}, [0.2, 0.0, 0.0, 0.4]),
        ({"stop_gap": 0.5, "stop_stiffness": 20.0}, [0.45, 0.0, 0.0, 0.6]),
        (BOTH, [0.3, 0.0, 0.1, 0.3]),
    ],
)
def test_slip_agrees_with_a_plain_integration_after_a_hundred_seconds(support, start):
    pin, times = replace(FAST, **support), np.linspace(0.0, 100.0, 101)
    plain = slide_past_stop if pin.stop_stiffness > 0.0 else lambda *a: slide(*a).y.T
    expected = plain(pin, start, times)
    for tolerance in (1e-9, 1e-12):
        found = simulate(pin, start, times, tolerance=tolerance)
        assert [phase.kind for phase in found.phases] == ["slip"]
        if pin.stop_stiffness > 0.0:
            assert np.sum(np.diff(deflection(found) > pin.stop_gap)) >= 3  # it goes in and out
        # Errors do not grow: the whirl is stable. So the tolerance in each unit of time, 1/ω, at most.
        assert np.abs(found.states - expected).max() < tolerance * 4.0 * 100.0


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


@pytest.mark.parametrize("points", [None, 6])
def test_step_of_a_disc_that_grazes_a_stop_on_its_way_does_not_miss_it(points):
    disc = replace(
        DISC, offset=0.0, damping=0.0, friction_force=0.0, disc_speed=0.0, stop_gap=0.9999, stop_stiffness=1e4,
        contact_points=points,
    )  # fmt: skip
    pin = pin_of(disc)
    start, times = np.array([0.0, 0.5, 1.0, 0.0]), np.linspace(0.0, 3.0, 7)
    expected = simulate(pin, start, times, tolerance=1e-12).states
    found = simulate(disc, [0.0, 0.5, 0.0, 1.0, 0.0, 0.0], times, tolerance=1e-6).states
    assert np.abs(found[:, [0, 1, 3, 4]] - expected).max() < 1e-6 * math.sqrt(1e4)
    free = np.array([np.sin(3.0), 0.5 * np.cos(3.0)])
    assert np.abs(found[-1, :2] - free).max() > 1e-3  # the stop is felt


def test_every_description_of_a_motion_knows_where_the_stop_begins():
    disc = replace(DISC, **STOP)
    motion = DiscMotion.of(disc, PointsOnRing(0.12, 3))
    point = OnePoint(motion, PointsOnRing(0.12, 3), 0)
    for coordinates in (point.slipping(Thresholds()), point.pivoting(Thresholds())):
        (surface,) = coordinates.surfaces
        unknowns = [0.25, 0.0, 0.3, 0.1, 0.2, 0.1]  # 0.15 m from (0.1, 0)
        assert surface.value(unknowns) == pytest.approx(0.0, abs=1e-16)
        assert surface.trend(unknowns, [1.0, -1.0, 0.0, 0.0, 0.0, 0.0]) > 0.0


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


@pytest.mark.parametrize("support", [{"hardening": 1.0}, SOFT_STOP])
def test_friction_holds_in_each_stick_phase_up_to_its_end_and_the_deflection_may_pass_the_gap(support):
    pin = replace(FIG_6, **support)
    trajectory = simulate(pin, [0.1, 0.0, 0.03, 0.0], np.linspace(0.0, 40.0, 4001))
    assert len(trajectory.stick_phases) >= 4
    passed = 0
    for phase in trajectory.stick_phases[:4]:
        delays = np.linspace(0.0, phase.end - phase.start, 201)
        turned = [turned_with_disc(pin, phase.initial_state, delay) for delay in delays]
        forces = [math.hypot(*pull_on_stuck_pin(pin, state)) for state in turned]
        assert max(forces[:-1]) < pin.friction_force
        assert forces[-1] == pytest.approx(pin.friction_force, rel=1e-11)
        beyond = [math.hypot(x - pin.offset, y) > pin.stop_gap for x, y, *_ in turned]
        passed += beyond[0] and not beyond[-1]
    assert passed >= 2 or pin.stop_stiffness == 0.0


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
        for time in np.linspace(0.0, min(found, turn), 400)
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


def test_pin_is_held_on_a_nonlinear_support_relaxed_at_the_axis_for_ever():
    pin = replace(FIG_6, offset=0.0, **BOTH)
    trajectory = simulate(pin, stuck_state(pin, 0.1, 0.0), [0.0, 50.0])
    assert [phase.kind for phase in trajectory.phases] == ["stick"]


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


# ---------------------------------------------------------------- any units, either sense


@pytest.mark.parametrize("support", [HARD, STOP, BOTH])
@pytest.mark.parametrize(
    "units", [(2.0**9, 2.0**-10, 1.0), (2.0**-13, 1.0, 2.0**17), (2.0**7, 2.0**15, 2.0**-20)]
)
def test_motion_is_the_same_in_any_units_of_mass_length_and_time(support, units):
    mass, length, time = units
    pin, start, times = replace(FIG_6, **support), np.array([0.3, 0.1, 0.0, 0.2]), np.linspace(0.0, 12.0, 25)
    scale = np.array([length, length, length / time, length / time])
    plain = simulate(pin, start, times)
    other = simulate(in_units(pin, mass, length, time), scale * start, time * times)
    # Powers of two, with which nothing is rounded in another way: the very same steps and digits.
    assert np.array_equal(plain.states, other.states / scale)
    assert np.array_equal(np.array(event_times(other)) / time, event_times(plain))


@pytest.mark.parametrize("free", [{"hardening": 3.0}, {"stop_gap": 0.1, "stop_stiffness": 20.0}])
@pytest.mark.parametrize("friction_force", [0.0, 0.05])
def test_motion_without_a_spring_is_the_same_in_any_units(free, friction_force):
    pin = PinOnDisc(
        mass=1.0, stiffness=0.0, damping=0.0, friction_force=friction_force, disc_speed=0.0, **free
    )
    start, times = np.array([0.2, 0.0, 0.1, 0.3]), np.linspace(0.0, 6.0, 13)
    scale = 2.0 ** np.array([10, 10, 27, 27])
    plain = simulate(pin, start, times)
    other = simulate(in_units(pin, 2.0**-7, 2.0**10, 2.0**-17), scale * start, 2.0**-17 * times)
    assert np.array_equal(plain.states, other.states / scale)
    if friction_force == 0.0:
        balance = power_balance(simulate(pin, start, np.linspace(0.0, 6.0, 601), tolerance=1e-12))
        assert np.ptp(balance.stored_energy) < 1e-10 * balance.stored_energy[0]


@pytest.mark.parametrize("support", [HARD, STOP, BOTH])
def test_disc_that_turns_the_other_way_gives_the_mirrored_motion(support):
    pin, start, times = replace(FIG_6, **support), np.array([0.3, 0.1, 0.0, 0.2]), np.linspace(0.0, 12.0, 25)
    mirror = np.array([1.0, -1.0, 1.0, -1.0])
    plain = simulate(pin, start, times)
    mirrored = simulate(replace(pin, disc_speed=-1.2), mirror * start, times)
    turned = simulate(replace(pin, offset=-0.1), -start, times)
    assert np.abs(mirror * plain.states - mirrored.states).max() < 1e-9
    assert np.abs(plain.states + turned.states).max() < 1e-9


# ---------------------------------------------------------------- the friction disc


@pytest.mark.parametrize(
    "contact", [None, PointsOnRing(0.12, 3), Annulus(0.08, 0.16)], ids=["ring", "3", "annulus"]
)
@pytest.mark.parametrize("support", [HARD, BOTH])
def test_sliding_disc_agrees_with_eq_19_under_a_plain_integrator(support, contact):
    disc = replace(DISC, **support)
    start, times = [0.5, 0.3, 0.0, 0.0, 0.15, 0.4], np.linspace(0.0, 2.0, 5)
    expected = slide_disc(disc, start, times, contact)
    found = simulate(disc, start, times, tolerance=1e-12, contact=contact)
    # The tolerance in each of some ten units of time: 2 s, in which friction parts two motions by little.
    assert np.abs(found.states - expected).max() < 1e-11


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


@pytest.mark.parametrize("points", [None, 3, 6])
@pytest.mark.parametrize("support", [HARD, STOP])
@pytest.mark.parametrize("start", [[0.1, 0.0, 0.0, 0.03, 0.0, 1.5], [0.5, 0.3, 0.0, 0.0, 0.15, 0.4]])
def test_power_of_the_disc_is_balanced_on_a_nonlinear_support(start, support, points):
    disc = replace(DISC, contact_points=points, **support)
    trajectory = simulate(disc, start, np.linspace(0.0, 10.0, 3001), tolerance=1e-11)
    balance = power_balance(trajectory)
    # Where a stop begins or ends to act the rate X0·C·y of the moment has a kink of up to C_s·ḋ·X0. Between two
    # samples of the distance h a kink of one is integrated wrong by h²/8 at most.
    crossings = np.sum(np.diff(deflection(trajectory) > disc.stop_gap)) if disc.stop_stiffness > 0.0 else 0
    speed = np.hypot(*trajectory.states[:, 3:5].T).max()
    kinks = (
        crossings * disc.disc_speed * disc.offset * disc.stop_stiffness * speed * (10.0 / 3000.0) ** 2 / 8.0
    )
    assert np.abs(balance.residual).max() < 3e-9 * balance.turned_over + kinks


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


@pytest.mark.parametrize("support", [HARD, STOP])
def test_disc_is_the_same_in_any_units(support):
    disc = replace(DISC, **support)
    start, times = np.array([0.3, 0.1, 0.2, 0.0, 0.2, 0.9]), np.linspace(0.0, 8.0, 17)
    scale = 2.0 ** np.array([10, 10, 0, 27, 27, 17])
    plain = simulate(disc, start, times)
    other = simulate(disc_in_units(disc, 2.0**-7, 2.0**10, 2.0**-17), scale * start, 2.0**-17 * times)
    assert np.array_equal(plain.states, other.states / scale)


def test_linear_support_costs_what_it_did():
    # A gap to a stop of no stiffness changes nothing at all.
    times = np.linspace(0.0, 60.0, 601)
    plain, gap = (
        simulate(pin, [0.1, 0.0, 0.03, 0.0], times) for pin in (FIG_5, replace(FIG_5, stop_gap=0.05))
    )
    assert np.array_equal(plain.states, gap.states)
    assert plain.solution.evaluations == gap.solution.evaluations


@pytest.mark.parametrize("support", [HARD, SOFT_STOP, STOP, BOTH])
def test_phases_follow_each_other_and_slip_in_between(support):
    pin = replace(FIG_6, **support)
    trajectory = simulate(pin, [0.3, 0.1, 0.0, 0.2], np.linspace(0.0, 60.0, 6001))
    for before, after in pairwise(trajectory.phases):
        assert before.end == after.start
        assert {before.kind, after.kind} == {"slip", "stick"}
    for phase in trajectory.phases:
        assert phase.end - phase.start > 1e-3
        between = (trajectory.times > phase.start) & (trajectory.times < phase.end)
        if phase.kind == "slip":
            assert trajectory.slip_speed[between].min(initial=1.0) > 0.0
        else:
            assert trajectory.slip_speed[between].max(initial=0.0) < 1e-14
