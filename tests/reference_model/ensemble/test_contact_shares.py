"""Friction of points in compiled code, against the contact law; its angles to rounding."""

import math

import numba
import numpy as np
import pytest

from reference_model.contact.points import PointsOnRing
from reference_model.ensemble.core.contact_shares import points_shares, turned

EPS = np.finfo(float).eps


@numba.njit
def of_points(ux, uy, rim, around):
    return points_shares(ux, uy, rim, around)


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
    angles = [*rng.uniform(-10.0, 10.0, 500), *rng.uniform(-1e6, 1e6, 500), *np.arange(-8, 9) * math.pi / 4.0]
    for angle in angles:
        assert turned(angle) == pytest.approx((math.cos(angle), math.sin(angle)), rel=0.0, abs=EPS)
