import numpy as np
import pytest

from exudyn_models.forces.friction_laws import CONTINUOUS, NONE_HELD, friction_of_slip
from exudyn_models.forces.slip_potential import (
    slip_potential_gradient,
    slip_potential_hessian,
    slip_potential_of_circles,
)
from reference_model.contact.annulus import Annulus

RADII = [(0.08, 0.12), (0.0, 0.12), (0.115, 0.12)]


def slips(inner, outer):
    """U and S = 1 rad/s, for which a point of the annulus rests at the radius U, is near to it or far from it."""
    rng = np.random.default_rng(4)
    return [*rng.uniform(0.9 * inner, 1.1 * outer, 60), *10.0 ** rng.uniform(-3.0, 1.0, 30)]


@pytest.mark.parametrize(("inner", "outer"), RADII)
def test_friction_of_an_annulus_is_that_of_the_reference(inner, outer):
    reference = Annulus(inner, outer, rings=40)
    for speed in slips(inner, outer):
        expected, slopes = reference.shares(speed, 1.0), reference.slopes(speed, 1.0)
        by_speed, by_spin = slip_potential_gradient(speed, 1.0, inner, outer, CONTINUOUS)
        assert by_speed == pytest.approx(expected.resistance, abs=1e-9)
        assert by_spin == pytest.approx(expected.moment, abs=1e-9 * outer)
        # 5e-7 of 1/outer, 1 and outer, which is what they are where a point rests.
        scale = np.array([outer, 1.0, 1.0 / outer])
        found, exact = (
            slip_potential_hessian(speed, 1.0, inner, outer, CONTINUOUS),
            (slopes[0], slopes[1], slopes[3]),
        )
        np.testing.assert_allclose(scale * found, scale * exact, rtol=0.0, atol=2e-6)


@pytest.mark.parametrize("gap", [0.3, 0.1, 0.01, 1e-3])
def test_friction_of_an_annulus_is_smooth_where_a_point_of_it_would_rest_just_outside(gap):
    inner, outer = 0.08, 0.12
    reference = Annulus(inner, outer, rings=160)
    scale = np.array([outer, 1.0, 1.0 / outer])
    for speed in (inner * (1.0 - gap), outer * (1.0 + gap)):
        slopes = reference.slopes(speed, 1.0)
        found, exact = (
            slip_potential_hessian(speed, 1.0, inner, outer, CONTINUOUS),
            (slopes[0], slopes[1], slopes[3]),
        )
        np.testing.assert_allclose(scale * found, scale * exact, rtol=0.0, atol=1e-11)


@pytest.mark.parametrize(("inner", "outer"), RADII)
def test_annulus_that_only_spins_has_the_moment_of_a_clutch_and_one_that_only_slips_none(inner, outer):
    # M = μN·(2/3)(R³ − r³)/(R² − r²), the textbook's clutch under uniform pressure.
    lever = 2.0 / 3.0 * (outer**3 - inner**3) / (outer**2 - inner**2)
    assert slip_potential_gradient(0.0, 7.0, inner, outer, CONTINUOUS) == pytest.approx(
        (0.0, lever), rel=1e-14
    )
    assert slip_potential_gradient(3.0, 0.0, inner, outer, CONTINUOUS) == pytest.approx((1.0, 0.0), rel=1e-14)


def test_mean_slip_of_a_thin_annulus_differs_from_that_of_its_middle_ring_by_its_width_squared():
    for speed in (0.05, 0.3):
        ring = slip_potential_of_circles(speed, 1.0, 0.1, 0.1, CONTINUOUS)
        errors = [
            abs(slip_potential_of_circles(speed, 1.0, 0.1 - d, 0.1 + d, CONTINUOUS) - ring)
            for d in (4e-3, 2e-3, 1e-3)
        ]
        np.testing.assert_allclose(np.log2(np.divide(errors[:-1], errors[1:])), 2.0, atol=0.05)


@pytest.mark.parametrize(("inner", "outer"), RADII)
@pytest.mark.parametrize("epsilon", [1e-6, 10.0])
def test_friction_of_an_annulus_works_against_its_slip_with_the_power_of_its_mean_slip(inner, outer, epsilon):
    contact = (outer, CONTINUOUS, 0.7, epsilon, NONE_HELD, inner)
    rng = np.random.default_rng(5)
    for slip in rng.normal(size=(50, 3)) * [0.1, 0.1, 1.0]:
        mean = slip_potential_of_circles(np.hypot(*slip[:2]), abs(slip[2]), inner, outer, CONTINUOUS)
        power = -np.array(friction_of_slip(*slip, 0.3, contact)) @ slip
        assert power == pytest.approx(0.7 * mean * min(1.0, mean / epsilon), rel=1e-13)


def test_an_annulus_at_rest_has_no_friction():
    assert friction_of_slip(0.0, 0.0, 0.0, 0.3, (0.12, CONTINUOUS, 0.7, 1e-3, NONE_HELD, 0.08)) == (
        0.0,
        0.0,
        0.0,
    )
