"""Friction of the ring and of points in compiled code, against exact integrals and the contact laws."""

import math

import mpmath
import numba
import numpy as np
import pytest

from reference_model.contact.points import PointsOnRing
from reference_model.ensemble.core.contact_shares import points_shares, ring_shares, turned

EPS = np.finfo(float).eps


@numba.njit
def of_points(ux, uy, rim, around):
    return points_shares(ux, uy, rim, around)


def integrals(slip, rim):
    """Return ∂P/∂U and ∂P/∂W by mpmath, with enough digits for the cancellation."""
    larger, smaller = max(slip, rim), min(slip, rim)
    m = (mpmath.mpf(smaller) / larger) ** 2
    with mpmath.workdps(60 + (int(-mpmath.log10(m)) if m else 0)):
        if m in (0, 1):
            pair = (mpmath.mpf(1), mpmath.mpf(0)) if m == 0 else (2 / mpmath.pi, 2 / mpmath.pi)
        else:
            e, k = mpmath.ellipe(m), mpmath.ellipk(m)
            pair = 2 / mpmath.pi * e, 2 / mpmath.pi * (e - (1 - m) * k) / mpmath.sqrt(m)
    return pair if slip >= rim else pair[::-1]


RATIOS = np.concatenate(
    (
        [0.0, 1e-300, 1e-160, 1e-20, 1e-9, 1e-6, 1e-4, 0.0099, 0.01, 0.0101, 0.05, 0.2, 0.5, 0.8, 0.9],
        1.0 - 10.0 ** -np.array([2.0, 4.0, 5.0, 6.0, 7.0, 8.0, 9.0]),
    )
)


@pytest.mark.parametrize("ratio", RATIOS)
def test_friction_of_a_ring_agrees_with_elliptic_integrals_to_rounding(ratio):
    for slip, rim in ((1.7, 1.7 * ratio), (1.7 * ratio, 1.7)):
        for share, exact in zip(ring_shares(slip, rim), integrals(slip, rim), strict=True):
            assert abs(share - exact) <= 12.0 * EPS * exact


@pytest.mark.parametrize("distance", [1e-10, 1e-12, 1e-14, EPS, 0.0])
def test_friction_of_a_ring_with_a_resting_point_loses_a_logarithm_of_its_accuracy(distance):
    slip, rim = 1.0, 1.0 - distance
    for share, exact in zip(ring_shares(slip, rim), integrals(slip, rim), strict=True):
        assert abs(share - exact) <= 5.0 * EPS * math.log(4.0 / EPS)


def test_friction_of_points_agrees_with_the_contact_law():
    rng = np.random.default_rng(5)
    law = PointsOnRing(1.0, 5)
    around = tuple(np.ravel([(arm.real, arm.imag) for arm in law.arms(0.0)]))
    for ux, uy, rim in rng.normal(size=(50, 3)):
        force, moment = law.force_and_moment(complex(ux, uy), -rim, 0.0)
        along, across, turning, power = of_points(ux, uy, rim, around)
        assert (along, across, turning) == pytest.approx((-force.real, -force.imag, -moment), abs=1e-14)
        assert power == pytest.approx(along * ux + across * uy + turning * rim, abs=1e-14)
    assert of_points(0.0, 0.0, 0.0, around) == (0.0, 0.0, 0.0, 0.0)


def test_cosine_and_sine_are_accurate_to_rounding_in_long_runs():
    rng = np.random.default_rng(2)
    angles = [
        *rng.uniform(-10.0, 10.0, 2000),
        *rng.uniform(-1e6, 1e6, 2000),
        *np.arange(-8, 9) * math.pi / 4.0,
    ]
    for angle in angles:
        c, s = turned(angle)
        assert abs(c - math.cos(angle)) <= EPS
        assert abs(s - math.sin(angle)) <= EPS
