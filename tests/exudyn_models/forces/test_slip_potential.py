"""Accuracy of the slip potential's derivatives: the ring against mpmath, annuli against the reference."""

import math

import mpmath
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

RADII = [(0.08, 0.12), (0.0, 0.12), (0.115, 0.12)]


def exact_slopes(speed, rim):
    u, w = mpmath.mpf(speed), mpmath.mpf(rim)
    if u == w:
        return 2 / mpmath.pi, 2 / mpmath.pi
    m = 4 * u * w / (u + w) ** 2
    e, k = (u + w) * mpmath.ellipe(m), (u - w) * mpmath.ellipk(m)
    return (e + k) / (mpmath.pi * u), (e - k) / (mpmath.pi * w)


def relative_error(speed, rim):
    with mpmath.workdps(100):  # the exact form loses twice the digits of the ratio
        pairs = zip(ring_potential_slopes(speed, rim), exact_slopes(speed, rim), strict=True)
        return max(float(abs(found - exact) / exact) for found, exact in pairs)


def test_the_ring_has_thirteen_digits_wherever_it_is_regular_and_nine_where_a_point_of_it_rests():
    rng = np.random.default_rng(0)
    ratios = 10.0 ** rng.uniform(-16.0, 16.0, 400)
    near = 1.0 + rng.choice([-1.0, 1.0], 300) * 10.0 ** rng.uniform(-11.9, -0.5, 300)
    for ratio, speed in zip((*ratios, *near), 10.0 ** rng.uniform(-3.0, 3.0, 700), strict=True):
        assert relative_error(speed, speed * ratio) < 1e-13
    for distance in (0.0, 1e-16, 3e-16, 1e-15, 1e-14, 1e-13, 1e-12):
        for sign in (-1.0, 1.0):
            assert relative_error(1.7, 1.7 * (1.0 + sign * distance)) < 1e-9


@pytest.mark.parametrize(
    ("speed", "rim", "expected"),
    [
        (0.0, 2.0, (0.0, 1.0)),
        (2.0, 0.0, (1.0, 0.0)),
        (1.0, 1e-300, (1.0, 0.5e-300)),
        (1e-300, 1.0, (0.5e-300, 1.0)),
        (1e308, 1.0, (1.0, 0.5e-308)),
        (5e-324, 5e-324, (2.0 / math.pi, 2.0 / math.pi)),
    ],
)
def test_the_ring_at_extreme_ratios(speed, rim, expected):
    assert ring_potential_slopes(speed, rim) == pytest.approx(expected, rel=1e-14, abs=0.0)


def test_curvatures_of_the_ring_are_derivatives_of_its_slopes():
    rng = np.random.default_rng(1)
    for speed, rim in 10.0 ** rng.uniform(-1.0, 1.0, (30, 2)):
        with mpmath.workdps(60):
            exact = [
                mpmath.diff(lambda u, w: exact_slopes(u, w)[0], (speed, rim), order)
                for order in ((1, 0), (0, 1))
            ]
            exact.append(mpmath.diff(lambda w, u=speed: exact_slopes(u, w)[1], rim))
        assert ring_potential_curvatures(speed, rim) == pytest.approx([float(v) for v in exact], rel=1e-11)


def test_a_curvature_stays_finite_where_it_is_infinite_and_grows_up_to_there():
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
