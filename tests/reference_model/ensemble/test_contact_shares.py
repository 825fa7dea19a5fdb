import math

import mpmath
import numba
import numpy as np
import pytest

from reference_model.contact.contact_law import PointsOnRing, Ring
from reference_model.ensemble.core.contact_shares import points_shares, ring_shares, turned

LANES = 16
EPS = np.finfo(float).eps


@numba.njit
def of_ring(slip, rim):
    return ring_shares(slip, rim)


@numba.njit
def of_points(ux, uy, rim, around):
    return points_shares(ux, uy, rim, around)


@numba.njit
def turn(angle):
    return turned(angle)


def integrals(slip, rim):
    """∂P/∂U and ∂P/∂W by mpmath, with enough digits for what cancels."""
    larger, smaller = max(slip, rim), min(slip, rim)
    m = (mpmath.mpf(smaller) / larger) ** 2
    with mpmath.workdps(60 + (int(-mpmath.log10(m)) if m else 0)):
        if m in (0, 1):
            pair = (mpmath.mpf(1), mpmath.mpf(0)) if m == 0 else (2 / mpmath.pi, 2 / mpmath.pi)
        else:
            e, k = mpmath.ellipe(m), mpmath.ellipk(m)
            pair = 2 / mpmath.pi * e, 2 / mpmath.pi * (e - (1 - m) * k) / mpmath.sqrt(m)
    return pair if slip >= rim else pair[::-1]


RATIOS = [
    0.0,
    1e-300,
    1e-160,
    1e-20,
    1e-9,
    1e-6,
    1e-4,
    0.0099,
    0.01,
    0.0101,
    0.05,
    0.2,
    0.5,
    0.8,
    0.9,
    0.99,
    0.9999,
]


@pytest.mark.parametrize("ratio", [*RATIOS, *(1.0 - 10.0 ** -np.arange(5.0, 10.0))])
def test_friction_of_a_ring_is_that_of_the_elliptic_integrals_to_rounding(ratio):
    for slip, rim in ((1.7, 1.7 * ratio), (1.7 * ratio, 1.7)):
        for share, exact in zip(of_ring(slip, rim), integrals(slip, rim), strict=True):
            assert abs(share - exact) <= 12.0 * EPS * exact


@pytest.mark.parametrize("distance", [1e-10, 1e-12, 1e-14, EPS, 0.0])
def test_where_a_point_of_the_ring_rests_a_logarithm_is_lost_and_no_more(distance):
    slip, rim = 1.0, 1.0 - distance
    for share, exact in zip(of_ring(slip, rim), integrals(slip, rim), strict=True):
        assert abs(share - exact) <= 5.0 * EPS * math.log(4.0 / EPS)


def test_friction_of_a_ring_is_that_of_the_reference():
    rng = np.random.default_rng(1)
    ring = Ring(0.12)
    for slip, spin in 10.0 ** rng.uniform(-4.0, 1.0, (300, 2)):
        resistance, moment = of_ring(slip, 0.12 * spin)
        shares = ring.shares(slip, spin)
        assert resistance == pytest.approx(shares.resistance, rel=1e-13)
        assert 0.12 * moment == pytest.approx(shares.moment, rel=1e-13)


@pytest.mark.parametrize("points", [3, 4, 6, 24])
def test_friction_of_points_is_that_of_the_reference(points):
    rng = np.random.default_rng(points)
    law = PointsOnRing(1.0, points)
    around = tuple(np.ravel([(arm.real, arm.imag) for arm in law.arms(0.0)]))
    for ux, uy, rim in rng.normal(size=(50, 3)):
        force, moment = law.force_and_moment(complex(ux, uy), -rim, 0.0)
        along, across, turning, power = of_points(ux, uy, rim, around)
        assert (along, across, turning) == pytest.approx((-force.real, -force.imag, -moment), abs=1e-14)
        assert power == pytest.approx(along * ux + across * uy + turning * rim, abs=1e-14)


def test_a_point_at_rest_gives_no_friction():
    assert of_points(0.0, 0.0, 0.0, (1.0, 0.0, -1.0, 0.0)) == (0.0, 0.0, 0.0, 0.0)


def test_cosine_and_sine_are_right_to_rounding_for_long_runs():
    rng = np.random.default_rng(2)
    angles = [
        *rng.uniform(-10.0, 10.0, 2000),
        *rng.uniform(-1e6, 1e6, 2000),
        *np.arange(-8, 9) * math.pi / 4.0,
    ]
    for angle in angles:
        c, s = turn(angle)
        assert abs(c - math.cos(angle)) <= EPS
        assert abs(s - math.sin(angle)) <= EPS


@numba.njit(error_model="numpy")
def ring_lanes(lanes):
    for i in range(LANES):
        by_slip, by_rim = ring_shares(lanes[i], lanes[LANES + i])
        lanes[2 * LANES + i] = by_slip
        lanes[3 * LANES + i] = by_rim


def test_lanes_give_what_a_single_one_does_bit_by_bit():
    lanes = np.linspace(0.1, 1.0, 4 * LANES)
    expected = [of_ring(slip, rim) for slip, rim in zip(lanes[:LANES], lanes[LANES : 2 * LANES], strict=True)]
    ring_lanes(lanes)
    assert list(zip(lanes[2 * LANES : 3 * LANES], lanes[3 * LANES :], strict=True)) == expected
