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


@pytest.mark.parametrize("slip", [0.01, 0.3])
def test_annulus_converges_faster_than_any_power_where_all_of_it_slips(slip):
    exact = np.array(Annulus(INNER, OUTER, rings=60).shares(slip, 1.0))
    errors = [np.abs(np.array(Annulus(INNER, OUTER, n).shares(slip, 1.0)) - exact).max() for n in (4, 6, 8)]
    assert errors[1] / errors[0] < 1e-2
    assert errors[2] / errors[1] < 1e-2


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


@pytest.mark.parametrize("inner", [0.0, INNER])
@pytest.mark.parametrize("spin", [2.0, -2.0])
def test_annulus_that_turns_in_place_has_the_moment_and_the_damping_of_the_textbook(inner, spin):
    sign = math.copysign(1.0, spin)
    uniform, even_wear = Annulus(inner, OUTER), Annulus(inner, OUTER, pressure=worn)
    mean_radius = 2.0 / 3.0 * (OUTER**3 - inner**3) / (OUTER**2 - inner**2)
    assert uniform.shares(0.0, spin) == (0.0, pytest.approx(sign * mean_radius, rel=1e-14))
    assert even_wear.shares(0.0, spin) == (0.0, pytest.approx(sign * (inner + OUTER) / 2.0, rel=1e-14))
    # The mean of 1/(2r|S|) over the area.
    assert uniform.slopes(0.0, spin).resistance_by_slip == pytest.approx(0.5 / (inner + OUTER), rel=1e-13)
    assert uniform.slopes(0.0, spin).moment_by_spin == 0.0


def test_annulus_that_only_slips_has_full_friction_and_no_moment():
    assert FACING.shares(0.3, 0.0) == (pytest.approx(1.0, rel=1e-15), 0.0)
    # The mean of r²/(2U) over the area.
    damping = (INNER**2 + OUTER**2) / 2.0 / 0.6
    assert FACING.slopes(0.3, 0.0).moment_by_spin == pytest.approx(damping, rel=1e-13)


@pytest.mark.parametrize("slip", [0.0, 0.05, 0.095, 0.119, 0.3])
@pytest.mark.parametrize("spin", [1.0, -1.0])
def test_slopes_of_an_annulus_are_its_derivatives(slip, spin):
    # Far from the ends of the range the shares are smooth in U and S; differences of fourth order.
    law, h = Annulus(INNER, OUTER, rings=32), 1e-4
    if slip == 0.0:
        h, slip = 1e-5, 1e-4
    weights = np.array((1.0, -8.0, 8.0, -1.0)) / (12.0 * h)
    by_slip = weights @ [law.shares(slip + n * h, spin) for n in (-2, -1, 1, 2)]
    by_spin = weights @ [law.shares(slip, spin + n * h) for n in (-2, -1, 1, 2)]
    found = law.slopes(slip, spin)
    assert (found.resistance_by_slip, found.moment_by_slip) == pytest.approx(by_slip, rel=1e-6, abs=1e-8)
    assert (found.resistance_by_spin, found.moment_by_spin) == pytest.approx(by_spin, rel=1e-6, abs=1e-8)


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


def test_annulus_is_a_law_like_the_others():
    force, moment = FACING.force_and_moment(0.03 - 0.04j, -1.0, 0.7)
    resistance, magnitude = FACING.shares(0.05, 1.0)
    assert force == pytest.approx(resistance * (-0.6 + 0.8j), rel=1e-14)
    assert moment == pytest.approx(-magnitude, rel=1e-14)


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ((0.12, 0.08), r"outer_radius = 0\.08 m: it must be > inner_radius = 0\.12 m"),
        ((0.12, 0.12), r"outer_radius = 0\.12 m: it must be > inner_radius = 0\.12 m"),
        ((-0.1, 0.12), r"inner_radius = -0\.1 m: it must be >= 0"),
        ((0.0, 0.0), r"outer_radius = 0 m: it must be > inner_radius = 0 m"),
        ((math.nan, 0.12), "inner_radius = nan: it must be finite"),
        ((0.08, math.inf), "outer_radius = inf: it must be finite"),
        ((0.08, "wide"), "outer_radius = 'wide': it must be a number"),
        ((0.08, 0.12, 0), "rings = 0: it must be a whole number >= 1"),
        ((0.08, 0.12, 1.5), r"rings = 1\.5: it must be a whole number >= 1"),
        ((0.08, 0.12, True), "rings = True: it must be a whole number >= 1"),
        ((0.08, 0.12, 8, lambda r: 0.1 - r), r"pressure\(0\.1\d* m\) = -.*: it must be >= 0"),
        ((0.08, 0.12, 8, lambda r: math.nan), r"pressure\(0\.08\d* m\) = nan: it must be finite"),
        ((0.08, 0.12, 8, lambda r: 0.0), "pressure = 0 everywhere"),
        ((0.08, 0.12, 8, 3.0), r"pressure = 3\.0: it must be a function of the radius, or None"),
    ],
)
def test_what_is_no_annulus_is_refused(arguments, message):
    with pytest.raises(ValueError, match=message):
        Annulus(*arguments)


def test_annulus_at_rest_has_neither_shares_nor_slopes():
    for function in (FACING.shares, FACING.slopes):
        with pytest.raises(ValueError, match="the disc is at rest"):
            function(0.0, 0.0)
    assert FACING.force_and_moment(0j, 0.0, 0.0) == (0j, 0.0)
