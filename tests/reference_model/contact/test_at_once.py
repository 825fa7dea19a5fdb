"""Friction of many states at once against friction of each."""

import math

import numpy as np
import pytest

from reference_model.contact.at_once import PointsAtOnce, at_once
from reference_model.contact.contact_law import PointsOnRing, Ring, ThreeTermRing

LAWS = [PointsOnRing(0.12, 4), PointsOnRing(0.12, 24), Ring(0.12), ThreeTermRing(0.12)]
STATES = 400


def states():
    """Slip, relative spin and angle, with ratios of slip and rim over 16 decades, and slip with none of the other."""
    rng = np.random.default_rng(5)
    slip = 10.0 ** rng.uniform(-8.0, 8.0, STATES) * np.exp(2j * math.pi * rng.random(STATES))
    spin = rng.normal(size=STATES) / 0.12
    slip[0], spin[1] = 0.0, 0.0
    slip[2], spin[2] = 0.12, 1.0  # a point of the ring rests
    slip[4], spin[4] = 1e-100, 1e-100
    return slip, spin, rng.uniform(-9.0, 9.0, STATES)


@pytest.mark.parametrize("law", LAWS, ids=repr)
def test_force_and_moment_are_those_of_each_state(law):
    forces, moments = at_once(law).force_and_moment(*states())
    each = [law.force_and_moment(*state) for state in zip(*(part.tolist() for part in states()), strict=True)]
    # Sums of terms of order one (moments: R), and differences of elliptic integrals, to rounding.
    assert np.max(abs(forces - [force for force, _ in each])) < 1e-14
    assert np.max(abs(moments - [moment for _, moment in each])) < 0.12e-14 * 10.0


@pytest.mark.parametrize("law", [LAWS[0], LAWS[2]], ids=repr)
def test_there_is_no_friction_at_rest(law):
    force, moment = at_once(law).force_and_moment(np.zeros(1, complex), np.zeros(1), np.ones(1))
    assert (force, moment) == (0.0, 0.0)


@pytest.mark.parametrize("points", [3, 24])
def test_friction_of_other_points_and_of_one_is_that_of_all(points):
    law = PointsOnRing(0.12, points)
    for slip, spin, angle in zip(*(part.tolist() for part in states()), strict=True):
        arm = law.arm(1, angle)
        own = slip - 1j * spin * arm
        force, moment = law.friction_of_others(1, own, spin, angle)
        friction = -own / abs(own) / points
        total = law.force_and_moment(slip, spin, angle)
        # Velocities of points are differences whose rounding counts as that of the larger part.
        least = min(abs(slip - 1j * spin * other) for other in law.arms(angle))
        noise = 1e-14 + 4e-16 * (abs(slip) + 0.12 * abs(spin)) / least
        assert abs(force + friction - total[0]) < noise
        assert abs(moment + (arm.conjugate() * friction).imag - total[1]) < 0.12 * noise


@pytest.mark.parametrize("points", [4, 24])
def test_friction_of_other_points_is_that_of_each_state(points):
    law = PointsOnRing(0.12, points)
    many = PointsAtOnce(law)
    forces, moments = many.friction_of_others(2, *states())
    each = [
        law.friction_of_others(2, *state) for state in zip(*(part.tolist() for part in states()), strict=True)
    ]
    assert np.max(abs(forces - [force for force, _ in each])) < 1e-14
    assert np.max(abs(moments - [moment for _, moment in each])) < 1e-14 * 0.12
    assert np.allclose(
        many.arm(2, states()[2]), [law.arm(2, angle) for angle in states()[2]], rtol=0, atol=1e-15
    )
