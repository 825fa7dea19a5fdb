"""Friction of an annulus against integrals over its area, closed forms, and the ring that it becomes when thin."""

import math

import numpy as np
import pytest
from scipy.integrate import quad

from reference_model.contact.annulus import ORDER, SLOPE_ORDER, Annulus
from reference_model.contact.contact_law import Ring

INNER, OUTER = 0.08, 0.12
FACING = Annulus(INNER, OUTER)


def worn(radius):
    """Pressure of a facing that wears evenly: the wear is that of pressure times speed."""
    return 1.0 / radius


def rising(radius):
    return 1.0 + 50.0 * radius**2


# U = r₀ at S = 1: within, at both ends, a little outside of the annulus, and far from it.
SLIPS = [0.0, 0.03, 0.0799, 0.08, 0.0801, 0.1, 0.11, 0.119999, 0.12, 0.1201, 0.3]


@pytest.mark.parametrize("slip", SLIPS)
@pytest.mark.parametrize("inner", [0.0, INNER])
@pytest.mark.parametrize("pressure", [None, worn, rising])
def test_friction_of_an_annulus_is_the_integral_over_its_rings(slip, inner, pressure):
    weight = pressure or (lambda _: 1.0)

    def integral(function):
        kink = [slip] if inner < slip < OUTER else None
        return quad(function, inner, OUTER, points=kink, epsabs=1e-15, epsrel=1e-13, limit=200)[0]

    def rings(radius):
        return Ring(radius).shares(slip, 1.0)

    load = integral(lambda r: weight(r) * r)
    force = integral(lambda r: weight(r) * r * rings(r).resistance) / load
    moment = integral(lambda r: weight(r) * r * rings(r).moment) / load
    for spin in (1.0, -1.0):
        found = Annulus(inner, OUTER, pressure=pressure).shares(slip, spin)
        assert found.resistance == pytest.approx(force, abs=1e-11)
        assert found.moment == pytest.approx(math.copysign(moment, spin), abs=1e-11 * OUTER)


@pytest.mark.parametrize("slip", [0.08, 0.095, 0.12])
def test_annulus_converges_at_its_order_where_a_ring_has_a_resting_point(slip):
    exact = Annulus(INNER, OUTER, rings=100)
    for function, rings, order in (
        (Annulus.shares, (6, 8, 10, 12), ORDER),
        (Annulus.slopes, (12, 16, 24, 32), SLOPE_ORDER),
    ):
        true = np.array(function(exact, slip, 1.0))
        errors = [np.abs(np.array(function(Annulus(INNER, OUTER, n), slip, 1.0)) - true).max() for n in rings]
        observed = -np.polyfit(np.log(rings), np.log(errors), 1)[0]
        assert observed > order - 0.5, (
            f"observed order {observed:.2f} of {function.__name__}, expected {order}"
        )


def test_thin_annulus_is_a_ring_up_to_the_square_of_its_width():
    for slip in (0.05, 0.2):
        exact = np.array(Ring(0.1).shares(slip, 1.0))
        errors = []
        for width in (0.01, 0.005, 0.0025):
            thin = Annulus(0.1 - width / 2.0, 0.1 + width / 2.0).shares(slip, 1.0)
            errors.append(np.abs(np.array(thin) - exact))
        assert np.log2(errors[1] / errors[2]) == pytest.approx([2.0, 2.0], abs=0.02)
    assert np.array(Annulus(0.1, 0.1 + 1e-12).shares(0.05, 1.0)) == pytest.approx(
        np.array(Ring(0.1).shares(0.05, 1.0)), rel=1e-10
    )


@pytest.mark.parametrize("gap", [0.0, 1e-16, 1e-14, 1e-9])
@pytest.mark.parametrize("end", [INNER, OUTER])
def test_slopes_are_finite_and_continuous_where_the_ring_at_an_edge_has_a_resting_point(gap, end):
    at_edge = np.array(FACING.slopes(end, 1.0))
    for side in (1.0, -1.0):
        # The slope changes like gap·ln(gap)/width.
        change = 30.0 * gap / (OUTER - INNER) / end
        assert np.array(FACING.slopes(end * (1.0 + side * gap), 1.0)) == pytest.approx(
            at_edge, abs=change + 1e-12
        )
