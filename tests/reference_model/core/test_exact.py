"""Simulated motions of the pin, against closed forms, eq. 10 and neighbouring motions."""

import cmath
import math
from dataclasses import replace

import numpy as np
import pytest
from plain_engines import as_disc
from plain_slip import slide

from reference_model import PinOnDisc, SimulationError, simulate
from reference_model.formulas.pin.polar_form import simulate_polar_form

FIG_5 = PinOnDisc(mass=1.0, stiffness=1.0, damping=0.1, friction_force=0.09, disc_speed=1.5, offset=0.1)
TO_WHIRL = [0.1, 0.0, 0.03, 0.0]  # a start of Fig. 5


def event_times(trajectory):
    return np.array([phase.start for phase in trajectory.phases[1:]])


def kinds(trajectory):
    return [phase.kind for phase in trajectory.phases]


@pytest.mark.parametrize("tolerance", [1e-7, 1e-11])
@pytest.mark.parametrize("compiled", [False, True])
@pytest.mark.parametrize("points", ["pin", None, 6], ids=["pin", "ring", "six points"])
def test_amplitude_on_a_disc_at_rest_falls_by_twice_the_friction_in_each_half_cycle(
    points, compiled, tolerance
):
    # Coulomb-damped oscillator: half cycles about ±f, f = μN/C, until the turning point is within f of X0.
    pin = PinOnDisc(mass=2.0, stiffness=3.0, damping=0.0, friction_force=0.12, disc_speed=0.0, offset=0.1)
    f, k, e = 0.04, math.sqrt(1.5), cmath.exp(2.3j)
    for amplitude, half_cycles in ((0.95, 0), (2.5, 1), (40.4, 20)):
        duration = (half_cycles + 1) * math.pi / k
        times = np.linspace(0.0, duration, 301)
        n = np.minimum(np.floor(times * k / math.pi), half_cycles)  # half cycles done
        side = (-1.0) ** n
        moving = n < half_cycles
        swing = np.where(moving, (amplitude - 1.0 - 2.0 * n) * f, 0.0)
        middle = np.where(moving, f, (amplitude - 2.0 * half_cycles) * f)
        z = pin.offset + side * (middle + swing * np.cos(k * times - n * math.pi)) * e
        v = -side * k * swing * np.sin(k * times - n * math.pi) * e
        system = pin if points == "pin" else as_disc(pin, points)
        start = np.zeros(system.state_size)
        start[:2] = z[0].real, z[0].imag
        found = simulate(system, start, times, tolerance=tolerance, compiled=compiled)
        at = system.state_size // 2
        size = amplitude * f * max(k, 1.0)
        errors = found.states[:, [0, 1, at, at + 1]] - np.column_stack((z.real, z.imag, v.real, v.imag))
        assert np.abs(errors).max() < 26.0 * tolerance * size
        assert kinds(found) == (["slip", "stick"] if half_cycles else ["stick"])
        assert event_times(found) == pytest.approx(
            [half_cycles * math.pi / k] * (half_cycles > 0), abs=10.0 * tolerance
        )


def test_pin_that_reverses_where_friction_just_holds_it_stops_there():
    # From 3f it swings about f to −f, where the pull of the springs is μN: either rounding is right.
    pin = PinOnDisc(mass=1.0, stiffness=1.0, damping=0.0, friction_force=0.25, disc_speed=0.0)
    trajectory = simulate(pin, [0.75, 0.0, 0.0, 0.0], np.linspace(0.0, 10.0, 101))
    assert trajectory.at_end == pytest.approx([-0.25, 0.0, 0.0, 0.0], abs=1e-8)
    assert kinds(trajectory) == ["slip", "stick"]
    assert event_times(trajectory) == pytest.approx([math.pi], abs=1e-8)


def test_polar_form_10_gives_the_motion_of_eq_1():
    pin = PinOnDisc(mass=2.3, stiffness=5.1, damping=0.7, friction_force=0.4, disc_speed=-2.2, offset=-0.15)
    start, times = np.array([0.9, 0.2, -0.1, -0.8]), np.linspace(2.0, 12.0, 21)
    assert np.abs(simulate_polar_form(pin, start, times) - slide(pin, start, times).y.T).max() < 1e-11


@pytest.mark.parametrize("aside", [0.0, 1e-15, 1e-9, 1e-3])
def test_slip_that_friction_cannot_hold_reverses_head_on_or_nearly(aside):
    # On a disc at rest the pin swings out to 8 f and reverses. Neighbouring motions stay close.
    pin = PinOnDisc(mass=1.0, stiffness=1.0, damping=0.0, friction_force=0.05, disc_speed=0.0)
    e = cmath.exp(0.7j)
    start, times = 0.45 * e + 1j * aside * e, np.linspace(0.0, 8.0, 33)
    trajectory = simulate(pin, [start.real, start.imag, 0.0, 0.0], times)
    exact = simulate(pin, [0.45 * e.real, 0.45 * e.imag, 0.0, 0.0], times, tolerance=1e-13)
    # Friction on a disc at rest makes motions approach each other.
    assert np.abs(trajectory.states - exact.states).max() < 2.0 * aside + 1e-8
    assert kinds(trajectory) == ["slip"]
    assert trajectory.solution.evaluations < 5_000


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
    # An error of 1e-9·ωL in a velocity would become an error of 576e-9·L in the position. Rounding chooses the steps,
    # so it changes the error as much as another start does: 50 starts within 1 % have 0.02 to 0.19 tolerances, or 0.6
    # to 4 if steps ignore the natural frequency.
    pin = replace(FIG_5, damping=0.11150754, friction_force=0.06107226, disc_speed=-576.13787, offset=0.0)
    start, times = [39.56501, 51.794526, -31.507546, 74.691881], np.linspace(0.0, 100.0, 101)
    usual, tight = (simulate(pin, start, times, tolerance=tolerance) for tolerance in (1e-9, 1e-11))
    assert np.abs(usual.states - tight.states)[:, :2].max() < 0.4e-9 * tight.radius.max()


def test_motion_beyond_the_range_of_floats_raises_an_error():
    pin = replace(FIG_5)
    object.__setattr__(pin, "mass", 1e-300)  # the constructor refuses it
    with pytest.raises(SimulationError, match="the integrator failed"):
        simulate(pin, [1.0, 0.0, 0.0, 0.0], [0.0, 1.0])


def test_run_with_too_many_steps_stops_with_the_time_reached_or_early(monkeypatch):
    monkeypatch.setattr("reference_model.trajectory.LOOK_BACK", 200)
    far_too_many = r"stopped at t = \d.* because more than 20,000,000 further steps are needed"
    for start in (TO_WHIRL, [0.1, 0.0, 1e-9, 0.15]):
        with pytest.raises(SimulationError, match=far_too_many):
            simulate(FIG_5, start, [0.0, 1e12])
    simulate(FIG_5, TO_WHIRL, [0.0, 400.0])
    monkeypatch.setattr("reference_model.trajectory.MOST_STEPS", 50)
    with pytest.raises(SimulationError, match=r"stopped at t = \d.* because more than 50 steps are needed"):
        simulate(FIG_5, TO_WHIRL, [0.0, 400.0])
