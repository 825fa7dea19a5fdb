"""Accuracy of the slip potential's derivatives in Exudyn, against the reference."""

import math

import numpy as np
import pytest

from exudyn_models.forces.friction_laws import CONTINUOUS
from exudyn_models.forces.slip_potential import (
    ring_potential_curvatures,
    ring_potential_slopes,
    slip_potential_gradient,
    slip_potential_hessian,
)
from reference_model.contact.annulus import Annulus
from reference_model.contact.elliptic import mean_curvatures, mean_directions

RADII = [(0.08, 0.12), (0.0, 0.12), (0.115, 0.12)]
EXTREME = [(0.0, 2.0), (2.0, 0.0), (1.0, 1e-300), (1e-300, 1.0), (1e308, 1.0), (5e-324, 5e-324)]


def test_the_ring_has_thirteen_digits_wherever_it_is_regular_and_nine_where_a_point_of_it_rests():
    """The reference is tested against arbitrary precision."""
    rng = np.random.default_rng(0)
    ratios = 10.0 ** rng.uniform(-16.0, 16.0, 400)
    near = 1.0 + rng.choice([-1.0, 1.0], 300) * 10.0 ** rng.uniform(-11.9, -0.5, 300)
    speeds = 10.0 ** rng.uniform(-3.0, 3.0, 700)
    regular = [*zip(speeds, speeds * np.append(ratios, near), strict=True), *EXTREME]
    resting = [(1.7, 1.7 * (1.0 + sign * gap)) for gap in (0.0, 1e-16, 1e-15, 1e-13) for sign in (-1.0, 1.0)]
    for pairs, accuracy in ((regular, 2e-13), (resting, 2e-9)):
        for pair in np.array(pairs).tolist():
            assert ring_potential_slopes(*pair) == pytest.approx(
                mean_directions(*pair), rel=accuracy, abs=0.0
            ), pair


def test_curvatures_of_the_ring_are_those_of_the_reference_and_finite_where_they_are_infinite():
    for pair in 10.0 ** np.random.default_rng(1).uniform(-1.0, 1.0, (30, 2)):
        assert ring_potential_curvatures(*pair) == pytest.approx(mean_curvatures(*pair), rel=1e-11)
    at = [ring_potential_curvatures(1.0, 1.0 - d)[2] for d in (1e-3, 1e-6, 1e-9, 1e-12, 0.0)]
    # (1/π)·ln(1/d) and a constant, bounded at a distance of 1e-15.
    np.testing.assert_allclose(np.diff(at), math.log(1e3) / math.pi, rtol=0.02)
    assert ring_potential_curvatures(1.0, 1.0)[0] > 0.0


def curvature_error(reference, speed, inner, outer):
    """Return the largest difference of the curvatures at S = 1 rad/s, divided by 1/outer, 1 and outer."""
    slopes = reference.slopes(speed, 1.0)
    found = slip_potential_hessian(speed, 1.0, inner, outer, CONTINUOUS)
    scale = np.array([outer, 1.0, 1.0 / outer])
    return np.abs(scale * (np.array(found) - [slopes[0], slopes[1], slopes[3]])).max()


@pytest.mark.parametrize(("inner", "outer"), RADII)
def test_friction_of_an_annulus_equals_the_reference(inner, outer):
    """At S = 1 rad/s the point at the radius U rests; U is in, near or far from the annulus."""
    reference, rng = Annulus(inner, outer, rings=40), np.random.default_rng(4)
    for speed in [*rng.uniform(0.9 * inner, 1.1 * outer, 60), *10.0 ** rng.uniform(-3.0, 1.0, 30)]:
        expected = reference.shares(speed, 1.0)
        by_speed, by_spin = slip_potential_gradient(speed, 1.0, inner, outer, CONTINUOUS)
        assert by_speed == pytest.approx(expected.resistance, abs=1e-9)
        assert by_spin == pytest.approx(expected.moment, abs=1e-9 * outer)
        assert (
            curvature_error(reference, speed, inner, outer) < 2e-6
        )  # each has an error of 5e-7 where a point rests


@pytest.mark.parametrize("gap", [0.3, 0.1, 0.01, 1e-3])
def test_curvatures_of_an_annulus_are_sharp_where_a_point_would_rest_just_outside_of_it(gap):
    reference = Annulus(0.08, 0.12, rings=160)
    for speed in (0.08 * (1.0 - gap), 0.12 * (1.0 + gap)):
        assert curvature_error(reference, speed, 0.08, 0.12) < 1e-11
