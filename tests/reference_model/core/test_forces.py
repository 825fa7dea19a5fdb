"""Friction of an annulus in closed form, against arbitrary precision and Gauss's rule."""

import math

import pytest
from mpmath import mp

from reference_model import Annulus
from reference_model.core.forces.contact import disc, shares


def of_disc(slip, rim):
    """Return force and moment of a disc of radius 1 under uniform pressure, by Farkas et al. (2003)."""
    with mp.workdps(60):
        e = mp.mpf(slip) / mp.mpf(rim)
        m = min(e, 1 / e) ** 2
        E, K = mp.ellipe(m), mp.ellipk(m)
        if e <= 1:
            force, moment = ((e**2 + 1) * E + (e**2 - 1) * K) / e, (4 - 2 * e**2) * E + (e**2 - 1) * K
        else:
            force = (e**2 + 1) * E - (e**2 - 1) * K
            moment = e * ((4 - 2 * e**2) * E + (2 * e**2 - 5 + 3 / e**2) * K)
        return float(4 * force / (3 * mp.pi)), float(4 * moment / (9 * mp.pi))


@pytest.mark.parametrize("ratio", [1e-9, 1e-4, 9e-4, 1.1e-3, 0.3, 0.9, 1.0 - 1e-9])
def test_friction_of_a_disc_is_exact_to_rounding_at_any_ratio_of_slip_and_spin(ratio):
    for slip, rim in ((ratio, 1.0), (1.0, ratio)):
        assert disc(slip, rim) == pytest.approx(of_disc(slip, rim), rel=2e-15)


@pytest.mark.parametrize("inner", [0.0, 0.1, 0.5, 0.9])
@pytest.mark.parametrize("slip", [1e-3, 0.08, 0.13, 0.2, 3.0])
def test_friction_of_an_annulus_is_the_integral_over_its_rings(inner, slip):
    outer = 0.2
    gauss = Annulus(inner * outer, outer, rings=60).shares(slip, 1.0)
    load = 1.0 / (1.0 - inner**2)
    assert shares(slip, 1.0, outer, inner * outer, load) == pytest.approx(tuple(gauss), abs=1e-13)


def test_disc_that_only_spins_or_only_slips():
    assert disc(0.0, 1.0) == pytest.approx((0.0, 2.0 / 3.0), abs=1e-16)
    assert disc(1.0, 0.0) == (1.0, 0.0)
    assert math.isfinite(sum(shares(0.0, 0.0, 0.2, 0.1, 4.0 / 3.0)))
