"""What every motion of the pin has in common, sticking, grazing and turning included."""

import math
from dataclasses import replace

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st
from plain_engines import error_bound, in_units, stuck_state

from reference_model import PinOnDisc, power_balance, simulate

UNITS_OF_TIME = 5.0
TOLERANCE = 1e-10


SPEEDS = st.floats(0.2, 2.5)
OFFSETS = st.sampled_from([0.0, 0.1, -0.3])


@st.composite
def pins(draw, disc_speeds=SPEEDS, offsets=OFFSETS):
    """Pins of every kind; friction from much less to somewhat more than the springs hold at their offset."""
    return PinOnDisc(
        mass=draw(st.floats(0.5, 2.0)),
        stiffness=draw(st.floats(0.5, 2.0)),
        damping=draw(st.floats(0.0, 0.5)),
        friction_force=draw(st.floats(0.01, 0.4)),
        disc_speed=draw(st.sampled_from([-1.0, 1.0])) * draw(disc_speeds),
        offset=draw(offsets),
    )


coordinates = st.floats(-0.6, 0.6).map(lambda value: round(value, 6))
states = st.lists(coordinates, min_size=4, max_size=4).map(np.array)


@st.composite
def motions(draw, **kinds):
    """A pin and a start, one in three of them stuck to the disc if friction holds it."""
    pin, state = draw(pins(**kinds)), draw(states)
    if draw(st.integers(0, 2)) == 0:
        state = stuck_state(pin, state[0], state[1])
    return pin, state


def unit_of_time(pin):
    return 1.0 / max(pin.natural_frequency, abs(pin.disc_speed))


def times_of(pin, samples=26):
    return np.linspace(0.0, UNITS_OF_TIME * unit_of_time(pin), samples)


def distance(pin, states, others):
    """Largest difference in units of the size of the motion."""
    scale = np.array([1.0, 1.0, unit_of_time(pin), unit_of_time(pin)])
    size = max(
        np.abs(states * scale).max(), abs(pin.offset), pin.friction_force / pin.mass * unit_of_time(pin) ** 2
    )
    return np.abs((states - others) * scale).max() / size


def allowed(pin, tolerance=TOLERANCE):
    """Two simulations, each wrong by so much."""
    return 2.0 * error_bound(pin, UNITS_OF_TIME * unit_of_time(pin), tolerance)


def turned(states, angle):
    c, s = math.cos(angle), math.sin(angle)
    return states @ np.kron(np.eye(2), [[c, s], [-s, c]])


@settings(max_examples=60)
@given(motions(offsets=st.just(0.0)), st.floats(-math.pi, math.pi))
def test_turned_start_gives_the_turned_motion_on_springs_relaxed_at_the_axis(motion, angle):
    pin, start = motion
    plain, other = (
        simulate(pin, state, times_of(pin), tolerance=TOLERANCE).states
        for state in (start, turned(start, angle))
    )
    assert distance(pin, turned(plain, angle), other) < allowed(pin)


@settings(max_examples=60)
@given(motions())
def test_disc_that_turns_the_other_way_gives_the_mirrored_motion(motion):
    pin, start = motion
    mirror = np.array([1.0, -1.0, 1.0, -1.0])
    plain = simulate(pin, start, times_of(pin), tolerance=TOLERANCE)
    other = simulate(
        replace(pin, disc_speed=-pin.disc_speed), mirror * start, times_of(pin), tolerance=TOLERANCE
    )
    assert distance(pin, mirror * plain.states, other.states) < allowed(pin)


@settings(max_examples=60)
@given(motions())
def test_offset_on_the_other_side_gives_the_motion_turned_by_half_a_turn(motion):
    pin, start = motion
    plain, other = (
        simulate(system, sign * start, times_of(pin), tolerance=TOLERANCE).states
        for system, sign in ((pin, 1.0), (replace(pin, offset=-pin.offset), -1.0))
    )
    assert distance(pin, -plain, other) < allowed(pin)


factors = st.floats(-6.0, 6.0).map(lambda exponent: 10.0**exponent)


@settings(max_examples=60)
@given(motions(), factors, factors, factors)
def test_motion_is_the_same_in_any_units_of_mass_length_and_time(motion, mass, length, time):
    pin, start = motion
    scale = np.array([length, length, length / time, length / time])
    plain = simulate(pin, start, times_of(pin), tolerance=TOLERANCE)
    other = simulate(
        in_units(pin, mass, length, time), scale * start, time * times_of(pin), tolerance=TOLERANCE
    )
    # Not only as accurate: the very same steps, so that only rounding differs.
    assert distance(pin, plain.states, other.states / scale) < allowed(pin, tolerance=1e-13)


@settings(max_examples=60)
@given(motions(), st.sampled_from([1e-5, 1e-7, 1e-9]))
def test_error_is_within_what_the_tolerance_and_the_growth_of_errors_allow(motion, tolerance):
    pin, start = motion
    loose, tight = (
        simulate(pin, start, times_of(pin), tolerance=value).states for value in (tolerance, 1e-13)
    )
    assert distance(pin, tight, loose) < allowed(pin, tolerance)


@settings(max_examples=40)
@given(motions())
def test_halving_the_tolerance_brings_the_motion_closer_to_the_exact_one(motion):
    pin, start = motion
    exact, *others = (
        simulate(pin, start, times_of(pin), tolerance=value).states for value in (1e-13, 1e-5, 1e-8)
    )
    # A thousandth of the tolerance: a thousandth of the error if it is exact to first order; a tenth at least,
    # unless there was next to none.
    coarse, fine = (distance(pin, exact, other) for other in others)
    assert fine < max(0.1 * coarse, 1e-8)


@settings(max_examples=60)
@given(motions(disc_speeds=st.just(0.0)))
def test_friction_on_a_disc_at_rest_only_takes_energy(motion):
    pin, start = motion
    times = times_of(pin, 501)
    trajectory = simulate(pin, start, times, tolerance=TOLERANCE)
    balance = power_balance(trajectory)
    # An error of the motion changes its energy by no more than twice that, relative to the largest.
    slack = 4.0 * TOLERANCE * UNITS_OF_TIME * balance.stored_energy.max()
    assert np.diff(balance.stored_energy).max() <= slack
    assert np.all(balance.drive_work == 0.0)


@settings(max_examples=60)
@given(motions())
def test_friction_heat_and_damper_heat_never_flow_back(motion):
    pin, start = motion
    balance = power_balance(simulate(pin, start, times_of(pin, 501), tolerance=TOLERANCE))
    # A spline of samples >= 0 dips below where slip turns: by less than the samples' own change in a step.
    step = times_of(pin, 501)[1]
    pull = (pin.stiffness * 3.0 + pin.damping * 3.0 + pin.mass * 12.0 + pin.friction_force) * step
    assert np.diff(balance.friction_heat).min() >= -pin.friction_force * pull / pin.mass * step
    assert np.diff(balance.damper_heat).min() >= -TOLERANCE


@st.composite
def sliding_motions(draw):
    """Motions near to the whirl without offset: slip stays near to (ω − k)·ρ_c and far from zero."""
    pin = replace(
        draw(pins(disc_speeds=st.just(1.0), offsets=st.just(0.0))), damping=draw(st.floats(0.05, 0.5))
    )
    pin = replace(pin, disc_speed=pin.natural_frequency * draw(st.floats(1.4, 3.0)) * pin.disc_speed)
    k = math.copysign(pin.natural_frequency, pin.disc_speed)
    radius = pin.friction_force / (pin.damping * abs(k)) * draw(st.floats(0.95, 1.05))
    return pin, np.array([radius, 0.0, 0.0, k * radius])


@settings(max_examples=40)
@given(sliding_motions())
def test_power_is_balanced_in_every_sliding_motion(motion):
    pin, start = motion
    trajectory = simulate(pin, start, times_of(pin, 201), tolerance=TOLERANCE)
    assert len(trajectory.phases) == 1
    assert trajectory.slip_speed.min() > 0.1 * trajectory.slip_speed.max()
    balance = power_balance(trajectory)
    # Errors of the motion, and of the spline: (0.025 units of time)⁶ with derivatives of the slip by 0.1 of it.
    assert np.abs(balance.residual).max() < (allowed(pin) + 0.025**6 * 1e2) * balance.turned_over
