"""Friction of an annulus against arbitrary precision and Gauss's rule, forces of supports, and slip from rest."""

import math

import numpy as np
import pytest
from mpmath import mp

from reference_model import Annulus, PinOnDisc, simulate
from reference_model.contact.contact_law import contact_of
from reference_model.core.forces.contact import disc, shares
from reference_model.core.forces.rates import secant, tangent
from reference_model.core.rest import begun, direction
from reference_model.core.single import law_of
from reference_model.core.units import Units


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


def law(**parameters):
    """Return the law of a pin with units of 1 m and 1 s."""
    pin = PinOnDisc(mass=1.0, stiffness=1.0, **parameters)
    return law_of(pin, contact_of(pin), Units(1.0, 1.0))


@pytest.mark.parametrize("d", [0.2, 0.5, 0.9])
def test_tangent_stiffness_is_the_slope_of_the_force_of_springs_and_stop(d):
    support = {"hardening": 0.7, "stop_gap": 0.6, "stop_stiffness": 3.0}
    with_stop = law(damping=0.0, friction_force=0.1, disc_speed=0.0, offset=0.0, **support)
    low, high = (secant(end, with_stop) * end for end in (d - 1e-6, d + 1e-6))
    assert tangent(d, with_stop) == pytest.approx((high - low) / 2e-6, rel=1e-8)


def test_slip_from_rest_grows_and_turns_as_its_first_terms_say():
    """The slip (first·t + gain·t²/2)·(n + turning·t) has an error of third order."""
    parameters = {"damping": 0.3, "friction_force": 0.6, "disc_speed": 0.8, "offset": 0.5}
    place = complex(-0.6, 0.8)
    v = 1j * parameters["disc_speed"] * place
    times = np.array([0.0, 0.01, 0.02, 0.04])
    start, about = [place.real, place.imag, v.real, v.imag], law(**parameters)
    n = direction(place.real, place.imag, 0.0, about)
    first, gain, tx, ty, _ = begun((place.real, place.imag, 0.0, 0.0, 0.0, 0.0, 0.0), n, about)
    x, y, vx, vy = simulate(
        PinOnDisc(mass=1.0, stiffness=1.0, **parameters), start, times, tolerance=1e-12
    ).states.T
    slip = vx + 1j * vy - 1j * parameters["disc_speed"] * (x + 1j * y)
    errors = abs(
        slip - (first * times + 0.5 * gain * times**2) * (complex(n[0], n[1]) + complex(tx, ty) * times)
    )
    assert first > 0.1
    np.testing.assert_allclose(np.log2(errors[2:] / errors[1:-1]), 3.0, atol=0.1)
