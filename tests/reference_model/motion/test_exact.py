"""Simulated motions of the pin, against closed forms, eq. 7 and independent integrators."""

import cmath
import math
from dataclasses import replace

import numpy as np
import pytest
from plain_engines import pull_on_stuck_pin, stuck_state, turned_with_disc
from plain_slip import slide

from reference_model import PinOnDisc, SimulationError, simulate
from reference_model.formulas import pin as formulas
from reference_model.motion.exact import simulate_with
from reference_model.motion.pin_equations import simulate_polar_form
from reference_model.motion.stepper import Thresholds

FIG_5 = PinOnDisc(mass=1.0, stiffness=1.0, damping=0.1, friction_force=0.09, disc_speed=1.5, offset=0.1)
FIG_6 = replace(FIG_5, friction_force=0.12, disc_speed=1.2)
HEAVY = PinOnDisc(mass=2.3, stiffness=5.1, damping=0.7, friction_force=0.4, disc_speed=2.2, offset=0.15)
TO_WHIRL = [0.1, 0.0, 0.03, 0.0]  # a start of Fig. 5


def event_times(trajectory):
    return np.array([phase.start for phase in trajectory.phases[1:]])


def kinds(trajectory):
    return [phase.kind for phase in trajectory.phases]


@pytest.mark.parametrize(("amplitude", "half_cycles"), [(0.5, 0), (0.95, 0), (2.5, 1), (7.5, 4), (40.4, 20)])
@pytest.mark.parametrize("angle", [0.0, 2.3])
def test_amplitude_on_a_disc_at_rest_falls_by_twice_the_friction_in_each_half_cycle(
    angle, amplitude, half_cycles
):
    # Coulomb-damped oscillator: half cycles about ±f, f = μN/C, until the turning point is within f of X0.
    pin = PinOnDisc(mass=2.0, stiffness=3.0, damping=0.0, friction_force=0.12, disc_speed=0.0, offset=0.1)
    f, k = 0.04, math.sqrt(1.5)
    e = cmath.exp(1j * angle)
    start = pin.offset + amplitude * f * e
    duration = (half_cycles + 1) * math.pi / k
    times = np.linspace(0.0, duration, 301)
    trajectory = simulate(pin, [start.real, start.imag, 0.0, 0.0], times)

    n = np.minimum(np.floor(times * k / math.pi), half_cycles)  # half cycles done
    side = (-1.0) ** n
    moving = n < half_cycles
    swing = np.where(moving, (amplitude - 1.0 - 2.0 * n) * f, 0.0)
    middle = np.where(moving, f, (amplitude - 2.0 * half_cycles) * f)
    along = side * (middle + swing * np.cos(k * times - n * math.pi))
    speed = -side * k * swing * np.sin(k * times - n * math.pi)
    z, v = pin.offset + along * e, speed * e
    expected = np.column_stack((z.real, z.imag, v.real, v.imag))
    # Friction makes motions on a disc at rest draw nearer; the size is the amplitude.
    size = amplitude * f * max(k, 1.0)
    assert np.abs(trajectory.states - expected).max() < 1e-9 * size * k * duration

    assert kinds(trajectory) == (["slip", "stick"] if half_cycles else ["stick"])
    if half_cycles:
        stop = trajectory.phases[1].start
        assert stop == pytest.approx(half_cycles * math.pi / k, abs=1e-8)
        rest = trajectory.phases[1].initial_state
        side = (-1.0) ** half_cycles
        place = pin.offset + side * (amplitude - 2.0 * half_cycles) * f * e
        assert rest == pytest.approx([place.real, place.imag, 0.0, 0.0], abs=1e-8 * size)


def test_pin_that_reverses_where_friction_just_holds_it_stops_there():
    # From 3f it swings about f to −f, where the pull of the springs is μN: either rounding is right.
    pin = PinOnDisc(mass=1.0, stiffness=1.0, damping=0.0, friction_force=0.25, disc_speed=0.0)
    trajectory = simulate(pin, [0.75, 0.0, 0.0, 0.0], np.linspace(0.0, 10.0, 101))
    assert trajectory.at_end == pytest.approx([-0.25, 0.0, 0.0, 0.0], abs=1e-8)
    assert kinds(trajectory) == ["slip", "stick"]
    assert trajectory.phases[1].start == pytest.approx(math.pi, abs=1e-8)


@pytest.mark.parametrize("pin", [FIG_5, replace(HEAVY, disc_speed=-2.2, offset=-0.15)])
def test_polar_form_10_gives_the_motion_of_eq_1(pin):
    start = np.array([0.9, 0.2, -0.1, math.copysign(0.8, pin.disc_speed)])
    times = np.linspace(2.0, 12.0, 21)
    assert np.abs(simulate_polar_form(pin, start, times) - slide(pin, start, times).y.T).max() < 1e-11


speeds = pytest.mark.parametrize(
    "disc_speed", [0.3, FIG_6.disc_speed, formulas.resonant_disc_speed(FIG_6), -2.0]
)
angles = pytest.mark.parametrize("angle", [0.0, 1.0, 4.0])


@speeds
@angles
def test_pin_inside_the_sticking_radius_sticks_permanently(angle, disc_speed):
    pin = replace(FIG_6, disc_speed=disc_speed)
    z0 = 0.98 * formulas.sticking_radius(pin) * cmath.exp(1j * angle)
    times = np.linspace(0.0, 200.0, 401)
    trajectory = simulate(pin, stuck_state(pin, z0.real, z0.imag), times)
    assert kinds(trajectory) == ["stick"]
    z = z0 * np.exp(1j * disc_speed * times)
    v = 1j * disc_speed * z
    expected = np.column_stack((z.real, z.imag, v.real, v.imag))
    # The angle is rounded to 1e-16 of up to 400 rad.
    assert np.abs(trajectory.states - expected).max() < 1e-13 * max(abs(z0), 1.0)


@speeds
@angles
def test_pin_outside_the_sticking_radius_is_released_at_the_root_of_7_and_slips_along_the_pull(
    angle, disc_speed
):
    pin = replace(FIG_6, disc_speed=disc_speed)
    radius = 1.02 * formulas.sticking_radius(pin)
    start = stuck_state(pin, radius * math.cos(angle), radius * math.sin(angle))
    expected = formulas.release_time(pin, radius, angle)
    delays = np.array([0.005, 0.01, 0.02])
    times = np.concatenate(([-1.0], -1.0 + expected + delays))
    trajectory = simulate(pin, start, times)
    assert kinds(trajectory) == (["stick", "slip"] if expected > 0.0 else ["slip"])
    if expected == 0.0:  # friction cannot hold it even at the start
        return
    release = trajectory.phases[1]
    assert release.start + 1.0 == pytest.approx(expected, abs=1e-11)
    let_go = turned_with_disc(pin, start, expected)
    assert release.initial_state == pytest.approx(let_go, abs=1e-11)
    pull = pull_on_stuck_pin(pin, let_go)
    assert math.hypot(*pull) == pytest.approx(pin.friction_force, rel=1e-12)
    # The pull turns by ω·delay at most while slip follows it.
    slip = trajectory.slip_velocity[1:] @ (np.array([[1.0, 1.0j]]).T @ [[1.0]])
    turned = np.angle(slip.ravel() / complex(*pull))
    assert np.all(np.abs(turned) < 2.0 * abs(disc_speed) * delays)
    # Slip grows like t²: doubling the time quadruples it, with corrections of the order of the time.
    ratios = trajectory.slip_speed[2:] / trajectory.slip_speed[1:-1]
    assert ratios == pytest.approx([4.0, 4.0], rel=0.1)


def test_start_at_the_very_moment_of_release_slips():
    pin, radius, angle = FIG_6, 1.1 * formulas.sticking_radius(FIG_6), 4.0
    held = stuck_state(pin, radius * math.cos(angle), radius * math.sin(angle))
    release = formulas.release_time(pin, radius, angle)
    assert release > 0.5
    times = np.linspace(0.0, 1.0, 11)
    trajectory = simulate(pin, turned_with_disc(pin, held, release), times)
    assert kinds(trajectory)[-1] == "slip"
    assert trajectory.phases[-1].start < 1e-11  # rounding decides whether it is held for a moment
    longer = simulate(pin, held, np.concatenate(([0.0], release + times)))
    assert np.abs(trajectory.states - longer.states[1:]).max() < 1e-8


def grazing_pin(excess, radius=0.1):
    """Return a pin, a start whose holding force peaks at (1 + excess)·μN 1.5 rad later, and a width in rad.

    The holding force passes μN this width before the peak, to first order, because the excess is a parabola.
    """
    elastic, viscous = 1.0 - FIG_6.disc_speed**2, 0.1 * FIG_6.disc_speed
    carry = math.hypot(elastic, viscous) * radius
    pin = replace(FIG_6, friction_force=(carry + 0.1) / (1.0 + excess))
    angle = math.pi - math.atan2(viscous, elastic) - 1.5
    width = math.sqrt(2.0 * max(excess, 0.0) / (carry * 0.1)) * (carry + 0.1)
    return pin, stuck_state(pin, radius * math.cos(angle), radius * math.sin(angle)), width


@pytest.mark.parametrize("excess", [-1e-2, -1e-6, -1e-9, 0.0, 1e-15, 1e-12, 1e-9])
def test_holding_force_that_peaks_at_the_friction_force_does_not_release_the_pin(excess):
    pin, start, _ = grazing_pin(excess)
    trajectory = simulate(pin, start, np.linspace(0.0, 50.0, 51))
    assert kinds(trajectory) == ["stick"]
    assert trajectory.radius == pytest.approx(0.1, rel=1e-14)


OUT_OF_REACH = {"stop_gap": 10.0, "stop_stiffness": 1.0}
"""A stop that the pin never meets. The release is then searched for and not computed in closed form."""


def test_slip_that_begins_with_too_large_a_pull_is_the_same_by_series_and_by_collocation():
    start, times = stuck_state(FIG_6, 0.4, 0.3), np.linspace(0.0, 1.0, 21)
    assert math.hypot(*pull_on_stuck_pin(FIG_6, start)) > 1.1 * FIG_6.friction_force
    by_series, by_collocation = (
        simulate(pin, start, times, tolerance=1e-11).states for pin in (FIG_6, replace(FIG_6, **OUT_OF_REACH))
    )
    assert np.abs(by_series - by_collocation).max() < 1e-10


@pytest.mark.parametrize(
    ("excess", "support"),
    [
        *((excess, {}) for excess in (2e-8, 1e-5, 1e-3, 0.1)),
        (1e-4, OUT_OF_REACH),
    ],
)
def test_holding_force_that_just_exceeds_friction_releases_the_pin_briefly_in_each_turn(excess, support):
    pin, start, width = grazing_pin(excess)
    pin = replace(pin, **support)
    times = np.linspace(0.0, 7.0, 71)
    trajectory = simulate(pin, start, times)
    assert kinds(trajectory)[:3] == ["stick", "slip", "stick"]
    slip = trajectory.phases[1]
    # The pull exceeds friction for twice the width. Slip lasts three widths, until the integral of the parabola
    # vanishes. The neglected terms are smaller by a factor of the width.
    assert slip.start == pytest.approx((1.5 - width) / pin.disc_speed, abs=0.2 * width**2)
    assert slip.end - slip.start == pytest.approx(3.0 * width / pin.disc_speed, rel=width)
    tight = simulate(pin, start, times, tolerance=1e-12)
    assert event_times(trajectory) == pytest.approx(event_times(tight), abs=1e-8)


@pytest.mark.parametrize("aside", [0.0, 1e-15, 1e-12, 1e-9, 1e-6, 1e-3])
@pytest.mark.parametrize("angle", [0.0, 0.7])
def test_slip_that_friction_cannot_hold_reverses_head_on_or_nearly(angle, aside):
    # On a disc at rest the pin swings out to 8 f and reverses. Neighbouring motions stay close.
    pin = PinOnDisc(mass=1.0, stiffness=1.0, damping=0.0, friction_force=0.05, disc_speed=0.0)
    e = cmath.exp(1j * angle)
    start = 0.45 * e + 1j * aside * e
    times = np.linspace(0.0, 8.0, 33)
    trajectory = simulate(pin, [start.real, start.imag, 0.0, 0.0], times)
    exact = simulate(pin, [0.45 * e.real, 0.45 * e.imag, 0.0, 0.0], times, tolerance=1e-13)
    # Friction on a disc at rest makes motions approach each other.
    allowed = 2.0 * aside + 1e-8
    assert np.abs(trajectory.states - exact.states).max() < allowed
    assert kinds(trajectory) == ["slip"]
    assert trajectory.solution.evaluations < 5_000


@pytest.mark.parametrize("slipping", [1e-3, 0.03, 1.0])
def test_run_that_ends_some_time_after_release_is_the_first_part_of_the_whole_run(slipping):
    stuck, times = [-0.03, 0.0, 0.0, -0.045], np.linspace(0.0, 20.0, 201)
    whole = simulate(FIG_5, stuck, times)
    part = simulate_with(Thresholds(), FIG_5, stuck, times, slipping=slipping)
    released = whole.phases[0].end
    assert kinds(part) == ["stick", "slip"]
    # It ends with the step that contains this time.
    assert released + slipping - 1e-12 < part.times[-1] < released + 2.0 * slipping + 0.2
    np.testing.assert_array_equal(part.times[:-1], times[times < part.times[-1]])
    np.testing.assert_allclose(part.states[:-1], whole.states[times < part.times[-1]], atol=1e-11)
    ends = simulate(FIG_5, stuck, [0.0, part.times[-1]]).at_end
    assert np.abs(part.at_end - ends).max() < 1e-9


def test_motion_does_not_depend_on_the_requested_times():
    dense = np.linspace(0.0, 20.0, 10_001)
    odd = np.concatenate(([0.0], np.sort(np.random.default_rng(1).uniform(1e-9, 20.0, 50)), [20.0]))
    whole, few, some, tight = (
        simulate(FIG_5, TO_WHIRL, times, tolerance=tolerance)
        for times, tolerance in ((dense, 1e-9), (dense[::1250], 1e-9), (odd, 1e-9), (odd, 1e-13))
    )
    assert np.array_equal(whole.states[::1250], few.states)
    assert np.array_equal(event_times(whole), event_times(few))
    assert np.array_equal(event_times(whole), event_times(some))
    # States between steps are as accurate as at their ends.
    assert np.abs(some.states - tight.states).max() < 1e-8


def test_positions_reach_the_tolerance_on_a_disc_much_faster_than_the_natural_frequency():
    # An error of 1e-9·ωL in the velocity would become an error of 57e-9·L in the position.
    pin = replace(FIG_5, damping=0.11150754, friction_force=0.06107226, disc_speed=-57.613787, offset=0.0)
    start, times = [39.56501, 51.794526, -31.507546, 74.691881], np.linspace(0.0, 100.0, 101)
    usual, tight = (simulate(pin, start, times, tolerance=tolerance) for tolerance in (1e-9, 1e-11))
    assert np.abs(usual.states - tight.states)[:, :2].max() < 1e-9 * tight.radius.max()


def test_motion_beyond_the_range_of_floats_raises_an_error():
    pin = replace(FIG_5)
    object.__setattr__(pin, "mass", 1e-300)  # the constructor refuses it
    overflows = pytest.warns(RuntimeWarning, match="overflow|invalid value")
    with overflows, pytest.raises(SimulationError, match="not finite"):
        simulate(pin, [1.0, 0.0, 0.0, 0.0], [0.0, 1.0])


def test_too_many_steps_raise_an_error_with_the_time_reached(monkeypatch):
    monkeypatch.setattr("reference_model.trajectory.MOST_STEPS", 50)
    with pytest.raises(SimulationError, match=r"stopped at t = \d.* because more than 50 steps are needed"):
        simulate(FIG_5, TO_WHIRL, [0.0, 400.0])


def test_run_that_would_need_far_too_many_steps_stops_early(monkeypatch):
    monkeypatch.setattr("reference_model.trajectory.LOOK_BACK", 200)
    for start in (TO_WHIRL, [0.1, 0.0, 1e-9, 0.15]):
        with pytest.raises(
            SimulationError,
            match=r"stopped at t = \d.* because more than 20,000,000 further steps are needed",
        ):
            simulate(FIG_5, start, [0.0, 1e12])
    simulate(FIG_5, TO_WHIRL, [0.0, 400.0])
