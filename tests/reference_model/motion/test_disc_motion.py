"""Simulated motions of the friction disc against conservation laws, closed forms, eq. 7, and plain integrators."""

import cmath
import math
from dataclasses import fields, replace
from functools import cache
from itertools import pairwise

import numpy as np
import pytest
from plain_disc_engines import friction_of_pivot, just_released_disc, slide_disc, stuck_disc

from compare.claims.parameters import FIG11
from reference_model import PinOnDisc, simulate
from reference_model.contact.annulus import Annulus
from reference_model.contact.contact_law import PointsOnRing, Ring, ThreeTermRing
from reference_model.motion.exact import simulate_with
from reference_model.motion.pin_equations import SlipMotion
from reference_model.motion.stepper import Thresholds
from reference_model.motion.stick import release_delay
from reference_model.systems import DiscOnDisc

STICKY = DiscOnDisc(
    mass=1.0, polar_inertia=0.02, stiffness=1.0, damping=0.1, friction_force=0.09, disc_speed=1.5, offset=0.1,
    contact_radius=0.12, shaft_damping=0.005, shaft_speed=1.25,
)  # fmt: skip
FREE = DiscOnDisc(
    mass=2.0, polar_inertia=2.0 * 0.3**2, stiffness=0.0, damping=0.0, friction_force=0.4, disc_speed=0.0,
    contact_radius=0.3, shaft_damping=0.0, shaft_speed=0.0,
)  # fmt: skip
STARTS = ([0.1, 0.0, 0.0, 0.03, 0.0, 1.5], [0.1, 0.0, 0.0, 0.0, 0.15, 1.5])
LAWS = {
    "ring": (None, None),
    "three terms": (None, ThreeTermRing(0.12)),
    "six points": (6, None),
    "three points": (3, None),
}


def kinds(trajectory):
    return [phase.kind for phase in trajectory.phases]


def of_law(disc, law):
    points, contact = LAWS[law]
    return replace(disc, contact_points=points), contact


@cache
def sticky_motion(law, start, until, samples):
    """The motion of ``STICKY`` that several tests look at, from one of ``STARTS``."""
    disc, contact = of_law(STICKY, law)
    return simulate(disc, STARTS[start], np.linspace(0.0, until, samples), contact=contact)


# ---------------------------------------------------------------- slip


def test_thin_annulus_slips_and_sticks_like_the_ring_with_an_error_of_second_order_in_its_width():
    disc, start, times = STICKY, STARTS[0], np.linspace(0.0, 20.0, 31)
    ring = simulate(disc, start, times)
    errors = []
    for half_width in (2e-3, 1e-3):
        facing = Annulus(disc.contact_radius - half_width, disc.contact_radius + half_width)
        annulus = simulate(disc, start, times, contact=facing)
        assert kinds(annulus) == kinds(ring)
        errors.append(np.abs(annulus.states - ring.states).max())
    assert "stick" in kinds(ring)
    assert math.log2(errors[0] / errors[1]) == pytest.approx(2.0, abs=0.01)


@pytest.mark.parametrize("start", [[0.395575, -0.553647, 0.0, 1.2747005841951533, 0.5507301118799482, 0.799]])
def test_crossing_the_logarithm_of_the_ring_at_equal_speeds_keeps_the_tolerance(start):
    # U and R|S| cross five times in these 8 s. Without landing on the crossings the error is 1e-7.
    disc = DiscOnDisc(
        mass=0.8863, polar_inertia=0.01014, stiffness=1.943, damping=0.3917, friction_force=0.04138, disc_speed=1.264,
        contact_radius=0.1603, shaft_damping=0.001154, shaft_speed=-1.842,
    )  # fmt: skip
    times = np.linspace(0.0, 8.0, 81)
    tight = simulate(disc, start, times, tolerance=1e-14)
    sliding = np.hypot(*tight.slip_velocity.T) - disc.contact_radius * np.abs(
        disc.disc_speed - tight.states[:, 5]
    )
    assert np.sum(np.diff(np.sign(sliding)) != 0.0) >= 4
    tolerances = np.array([1e-8, 1e-9, 1e-10, 1e-11, 1e-12])
    errors = [
        np.abs(simulate(disc, start, times, tolerance=tolerance).states - tight.states).max()
        for tolerance in tolerances
    ]
    # A single one goes by how the steps happen to fall.
    assert np.mean(np.log10(errors / tolerances)) < 1.0, errors
    # Where to land is the law's to say, not the disc's.
    other = simulate(
        replace(disc, contact_radius=0.3), start, times, tolerance=1e-9, contact=Ring(disc.contact_radius)
    )
    assert np.array_equal(other.states, simulate(disc, start, times, tolerance=1e-9).states)


def test_without_friction_the_disc_is_a_damped_oscillator_and_a_spin_that_decays():
    disc = replace(FIG11, friction_force=0.0, offset=0.1, shaft_damping=0.3)
    times = np.linspace(0.0, 20.0, 41)
    trajectory = simulate(disc, [0.3, -0.2, 0.4, -0.1, 0.4, -2.0], times)
    spin = 1.25 + (-2.0 - 1.25) * np.exp(-0.3 * times)
    angle = 0.4 + 1.25 * times + (-2.0 - 1.25) / 0.3 * (1.0 - np.exp(-0.3 * times))
    pin = PinOnDisc(mass=1.0, stiffness=1.0, damping=0.5, friction_force=0.0, disc_speed=1.5, offset=0.1)
    centre = simulate(pin, [0.3, -0.2, -0.1, 0.4], times, tolerance=1e-13)
    expected = np.column_stack((centre.states[:, :2], angle, centre.states[:, 2:], spin))
    assert np.abs(trajectory.states - expected).max() < 1e-9 * 30
    assert kinds(trajectory) == ["slip"]


# ---------------------------------------------------------------- stick


def test_stuck_disc_is_a_stuck_pin_with_the_friction_that_the_moment_leaves():
    # On the limit surface of the ring, k = W/U: F = (2/π)E(k²), M/R = (2/π)·k·B(k²); here through AGM-free sums.
    angles = (np.arange(1000) + 0.5) * 2.0 * math.pi / 1000
    moment = (
        STICKY.shaft_damping
        * (STICKY.disc_speed - STICKY.shaft_speed)
        / (STICKY.friction_force * STICKY.contact_radius)
    )

    def surface(k):
        speed = np.sqrt(1.0 + k**2 - 2.0 * k * np.cos(angles))
        return np.mean((1.0 - k * np.cos(angles)) / speed), np.mean((k - np.cos(angles)) / speed)

    low, high = 0.0, 1.0
    for _ in range(60):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if surface(middle)[1] < moment else (low, middle)
    pin = PinOnDisc(
        mass=1.0,
        stiffness=1.0,
        damping=0.1,
        friction_force=0.09 * surface(low)[0],
        disc_speed=1.5,
        offset=0.1,
    )
    released = 0
    for angle in np.linspace(0.0, 6.0, 25):
        z = 0.05 * cmath.exp(1j * angle)
        trajectory = simulate(STICKY, stuck_disc(STICKY, z, 0.3), [0.0, 20.0])
        expected = release_delay(SlipMotion.of(pin), z)
        if kinds(trajectory)[0] == "stick":
            assert trajectory.phases[0].end == pytest.approx(min(expected, 20.0), abs=1e-10)
            released += expected < 20.0
    assert released >= 5


@pytest.mark.parametrize("points", [None, 3, 6])
@pytest.mark.parametrize("margin", [0.99, 1.01])
def test_disc_at_the_axis_sticks_as_long_as_the_moment_of_its_shaft_is_below_friction(points, margin):
    # b(ω − Ω) against μN·R: at the axis nothing pulls at the centre.
    b = margin * STICKY.friction_force * STICKY.contact_radius / 0.25
    disc = replace(STICKY, offset=0.0, shaft_damping=b, contact_points=points)
    trajectory = simulate(disc, stuck_disc(disc, 0j, 0.2), np.linspace(0.0, 30.0, 31))
    assert kinds(trajectory) == (["stick"] if margin < 1.0 else ["slip"])
    if margin > 1.0:
        # It then slips by what the damper has over friction: b(ω − Ω − S) = μN·R.
        slip = 0.25 - STICKY.friction_force * STICKY.contact_radius / b
        decay = math.exp(-b / disc.polar_inertia * 30.0)
        assert 1.5 - trajectory.at_end[5] == pytest.approx(slip * (1.0 - decay), rel=1e-7)


@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize("start", range(len(STARTS)))
def test_default_tolerance_is_reached_through_slip_stick_and_pivots(law, start):
    disc, contact = of_law(STICKY, law)
    default = sticky_motion(law, start, 30.0, 3001)
    tight = simulate(disc, STARTS[start], default.times[::10], tolerance=1e-13, contact=contact)
    assert kinds(default) == kinds(tight)
    found, expected = ([phase.start for phase in run.phases] for run in (default, tight))
    assert found == pytest.approx(expected, abs=1e-7)
    assert default.stick_times == pytest.approx(tight.stick_times, abs=1e-8)
    assert np.abs(default.states[::10] - tight.states).max() < 1e-8


@cache
def motion_with(law, thresholds):
    disc, contact = of_law(STICKY, law)
    return simulate_with(thresholds, disc, STARTS[0], np.linspace(0.0, 12.0, 61), contact=contact)


@pytest.mark.parametrize("factor", [0.5, 2.0])
@pytest.mark.parametrize("threshold", [field.name for field in fields(Thresholds)])
@pytest.mark.parametrize("law", ["ring", "three points"])
def test_motion_does_not_depend_on_any_threshold(law, threshold, factor):
    other = replace(Thresholds(), **{threshold: factor * getattr(Thresholds(), threshold)})
    plain, changed = motion_with(law, Thresholds()), motion_with(law, other)
    assert kinds(plain) == kinds(changed)
    assert np.abs(plain.states - changed.states).max() < 1e-8


@pytest.mark.parametrize("law", ["ring", "six points"])
def test_slip_after_a_release_is_the_one_that_starts_from_its_leading_order(law):
    disc, contact = of_law(STICKY, law)
    trajectory = simulate(disc, STARTS[1], np.linspace(0.0, 30.0, 301), contact=contact, tolerance=1e-12)
    release = trajectory.stick_phases[0]
    errors = []
    for delay in (4e-3, 1e-3):
        shortly = just_released_disc(disc, release, delay)
        times = [release.end + delay, release.end + 0.2]
        states = slide_disc(disc, shortly, times, contact, method="Radau", rtol=1e-10, atol=1e-13)
        exact = simulate(disc, release.initial_state, [release.start, *times], tolerance=1e-12)
        errors.append(np.abs(states[-1] - exact.states[-1]).max())
    # Slip of ½κt² is wrong by its next order in time: four times the delay, 64 times the error.
    assert errors[0] < 1e-6
    assert errors[1] < 0.05 * errors[0]


@pytest.mark.parametrize(("points", "start"), [(5, STARTS[0]), (6, STARTS[1]), (3, STARTS[0])])
def test_pivot_holds_as_long_as_its_friction_is_within_the_share_of_one_point(points, start):
    disc = replace(STICKY, contact_points=points)
    trajectory = simulate(disc, start, np.linspace(0.0, 20.0, 5001), tolerance=1e-12)
    let_go = 0
    for pivot, after in pairwise(trajectory.phases):
        if pivot.kind != "pivot":
            continue
        inside = (trajectory.times > pivot.start) & (trajectory.times < pivot.end)
        state = pivot.initial_state
        arms = np.array(PointsOnRing(0.12, points).arms(state[2]))
        slip = (
            complex(state[3], state[4]) + 1j * state[5] * arms - 1.5j * (complex(state[0], state[1]) + arms)
        )
        point = int(np.argmin(abs(slip)))
        forces = [abs(friction_of_pivot(disc, state, point)) for state in trajectory.states[inside]]
        assert max(forces, default=0.0) < 0.09 / points
        if after.kind == "slip":
            force = abs(friction_of_pivot(disc, after.initial_state, point))
            assert force == pytest.approx(0.09 / points, rel=1e-9)
            let_go += 1
    assert let_go >= 1


# ---------------------------------------------------------------- a ring thrown on a resting table


@pytest.mark.parametrize(
    "start", [[0.0, 0.0, 0.0, 1.0, 0.0, 1.0], [0.0, 0.0, 0.0, 0.3, 0.4, -6.0], [0, 0, 0, 2.0, 0, 0.01]]
)
def test_sliding_and_spinning_of_a_free_ring_stop_together_and_in_the_ratio_one(start):
    trajectory = simulate(FREE, start, np.linspace(0.0, 40.0, 11))
    assert kinds(trajectory) == ["slip", "stick"]
    stop = trajectory.phases[1].start
    left = stop * 2.0 ** -np.arange(1.0, 29.0)
    before = simulate(FREE, start, [0.0, *(stop - left)], tolerance=1e-13).states[1:]
    sliding, rim = np.hypot(before[:, 3], before[:, 4]), 0.3 * np.abs(before[:, 5])
    distance = np.abs(sliding / rim - 1.0)
    # The logarithm in the ring's law draws the ratio to 1 faster than any power of the time that is left.
    resolved = (distance * sliding)[
        1:
    ] > 1e-11  # ten times what the closed form for coming to rest leaves out
    assert np.all(distance[1:][resolved] < distance[:-1][resolved])
    near = resolved & (distance[:-1] < 0.1)
    assert np.any(near)
    assert np.all(distance[1:][near] < 0.1 * distance[:-1][near])
    assert distance[-1] < 1e-6
    # In the end 2/π of full friction works on either.
    rate = 2.0 / math.pi * FREE.friction_force / FREE.mass
    assert sliding[-1] == pytest.approx(rate * left[-1], rel=1e-3)
    assert rim[-1] == pytest.approx(rate * left[-1], rel=1e-3)


@pytest.mark.parametrize(("inertia", "spin"), [(1e9, 1.3), (1.0, 1e6), (1e-4, 1.3)])
def test_accuracy_of_the_place_depends_on_neither_inertia_nor_spin(inertia, spin):
    disc, start = replace(FIG11, polar_inertia=inertia), [0.02, 0.0, 0.0, 0.0, 0.0, spin]
    coarse, fine = (
        simulate(disc, start, np.linspace(0.0, 10.0, 51), tolerance=tolerance) for tolerance in (1e-9, 1e-12)
    )
    assert np.abs(coarse.states[:, :2] - fine.states[:, :2]).max() < 1e-8 * fine.radius.max()
