"""A body on points with unequal shares slides, pivots about a point at rest, and sticks."""

import functools
from collections import Counter
from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from random_systems import TIMES, RandomMotion, random_points, smooth_motion

from reference_model import DiscOnDisc, Points, simulate

SEEDS = (*range(2, 50, 6), 188)  # in the last motion the disc comes to rest just when its pivot gives way
seeds = pytest.mark.parametrize("seed", SEEDS)
FEET = Points([(0.05, 0.0, 0.5), (-0.03, 0.04, 0.2), (-0.02, -0.05, 0.3)])
BODY = DiscOnDisc(
    mass=1.5, polar_inertia=2e-3, stiffness=0.0, damping=0.0, friction_force=2.0, disc_speed=0.0,
    contact_radius=0.05, shaft_damping=0.0, shaft_speed=0.0,
)  # fmt: skip


@functools.cache
def states(seed, tolerance=1e-9):
    run = RandomMotion.of(seed)
    return simulate(run.system, run.start, TIMES, contact=random_points(seed), tolerance=tolerance)


def test_motions_on_random_points_include_all_transitions_between_phases():
    kinds = [[phase.kind for phase in states(seed).phases] for seed in SEEDS]
    seen = Counter(pair for each in kinds for pair in set(pairwise(each)))
    phases = ("slip", "pivot", "stick")
    assert {(a, b) for a in phases for b in phases if a != b} - {("stick", "pivot")} <= set(seen)
    assert {len(random_points(seed).shares) for seed in SEEDS} == {2, 3, 4, 5}


@seeds
def test_error_on_random_points_is_at_most_a_few_tolerances(seed):
    assert np.abs(states(seed).states - states(seed, 1e-12).states).max() < 3e-8


@seeds
def test_motions_with_smooth_friction_converge_to_that_on_random_points(seed):
    run = RandomMotion.of(seed)
    coarse, fine = (
        np.abs(smooth_motion(run.system, run.start, epsilon, random_points(seed)) - states(seed).states).max()
        for epsilon in (1e-6, 1e-8)
    )
    # The error of the smooth motion is of order ε, of order ε^0.8 after a release, and always below √ε.
    assert fine < max(0.1 * coarse, 3e-8)
    assert fine < 3e-5


def test_body_that_turns_about_a_resting_foot_is_braked_by_the_others_at_their_distances():
    foot, spin = 0.05, 1.2
    lever = 0.2 * abs(-0.08 + 0.04j) + 0.3 * abs(-0.07 - 0.05j)
    rate = BODY.friction_force * lever / (BODY.polar_inertia + BODY.mass * foot**2)
    times = np.linspace(0.0, 1.2 * spin / rate, 61)
    run = simulate(BODY, [0.0, 0.0, 0.0, 0.0, -spin * foot, spin], times, contact=FEET)
    assert [phase.kind for phase in run.phases] == ["pivot", "stick"]
    assert run.phases[1].start == pytest.approx(spin / rate, rel=1e-9)
    turning = np.minimum(times, spin / rate)
    angle = spin * turning - 0.5 * rate * turning**2
    np.testing.assert_allclose(run.states[:, 2], angle, atol=1e-10)
    place = foot - foot * np.exp(1j * angle)
    np.testing.assert_allclose(run.states[:, :2], np.column_stack((place.real, place.imag)), atol=1e-10)


def test_foot_at_the_centre_of_mass_can_be_the_pivot():
    """The arm of this foot vanishes, so its friction turns nothing and needs no leverage."""
    centred = Points([(0.0, 0.0, 0.6), (0.05, 0.0, 0.2), (-0.03, 0.04, 0.2)])
    run = simulate(BODY, [0.0, 0.0, 0.0, 0.02, 0.01, 8.0], np.linspace(0.0, 0.6, 61), contact=centred)
    kinds = [phase.kind for phase in run.phases]
    assert "pivot" in kinds
    assert kinds[-1] == "stick"
    stuck = replace(BODY, stiffness=30.0, disc_speed=1.5, offset=0.05)
    released = simulate(stuck, [0.05, 0.0, 0.0, 0.0, 0.075, 1.5], np.linspace(0.0, 6.0, 61), contact=centred)
    fine = simulate(stuck, released.states[0], released.times, contact=centred, tolerance=1e-12)
    assert np.abs(fine.states - released.states).max() < 3e-8
    assert [phase.kind for phase in released.phases][:2] == ["stick", "slip"]
