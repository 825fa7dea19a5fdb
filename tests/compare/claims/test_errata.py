"""Each corrected formula of the errata gives the exact number, and the printed one does not."""

import functools
import math
from dataclasses import replace

import numpy as np
import pytest

from compare.claims import errata
from compare.claims.errata import ERRATA
from compare.claims.parameters import CENTRED, FIG8, FIG9
from reference_model import whirl_orbit
from reference_model.contact.contact_law import ThreeTermRing
from reference_model.formulas.disc import places_by_26
from reference_model.formulas.pin import first_order_whirl_shift, whirl_shift
from reference_model.steady.steady_states import self_centred_equilibria

ROUNDING = 1e-14
"""Error of a few dozen operations on numbers of order one, each exact to 1.1e-16."""

ALWAYS_EXISTS, COEFFICIENT, SHIFT, EXPANSION, BRACKET, STABLE = ERRATA

THIRD_ORDER = 30.0 * 1e-3**2
"""Relative error of the corrected (18): (w·X0/ρ)² = 25·X0², with w = ω/(ω − k) = 6, ρ = 1.2 m and X0 = 1 mm."""

TOLERANCES = {
    ALWAYS_EXISTS: ROUNDING,
    COEFFICIENT: ROUNDING,
    SHIFT: THIRD_ORDER,
    EXPANSION: ROUNDING,
    BRACKET: 100.0 * ROUNDING,  # each value is a root in one variable
    STABLE: 1e-7,  # differences of the flow with relative steps of 4e-3, extrapolated twice
}


@functools.cache
def evidence_of(erratum):
    return erratum.evidence()


def test_the_errata_are_in_the_order_of_the_paper():
    places = [erratum.equation.split(",")[0] for erratum in ERRATA]
    assert places == ["(11)", "(13)", "(18)", "(22)", "(26)", "Section 5"]


@pytest.mark.parametrize("erratum", ERRATA, ids=lambda erratum: erratum.equation)
def test_the_corrected_formula_gives_the_exact_number_and_the_printed_one_does_not(erratum):
    evidence = evidence_of(erratum)
    tolerance = TOLERANCES[erratum] * max(1.0, abs(evidence.exact))
    assert abs(evidence.corrected_value - evidence.exact) <= tolerance
    # The factor 100 ensures that no choice of the tolerance confuses the two.
    assert abs(evidence.printed_value - evidence.exact) > 100.0 * tolerance


@pytest.mark.parametrize("erratum", ERRATA, ids=lambda erratum: erratum.equation)
def test_every_erratum_shows_both_formulas_and_says_why(erratum):
    assert erratum.printed != erratum.correct
    for text in (erratum.printed, erratum.correct, erratum.explanation, evidence_of(erratum).quantity):
        assert text.strip()


def test_below_k_friction_brakes_as_much_as_the_damper():
    """Both exert μN on the pin on the circle (11), where βkρ = μN."""
    evidence = evidence_of(ALWAYS_EXISTS)
    assert evidence.exact == pytest.approx(-2.0 * CENTRED.friction_force, rel=ROUNDING)


def test_the_coefficient_of_13_is_the_negative_trace():
    """The value by hand at ω = 1.5 is β/m·(1 + ω/(ω − k)) = 0.1·(1 + 3); as printed it is 1 + 0.1·3."""
    evidence = evidence_of(COEFFICIENT)
    assert evidence.exact == pytest.approx(0.4, rel=ROUNDING)
    assert evidence.printed_value == pytest.approx(1.3, rel=ROUNDING)


def test_the_printed_13_changes_with_the_unit_of_time_and_the_corrected_one_does_not(monkeypatch):
    """The number of any rate is halved if the unit of time is half a second."""
    halved = replace(
        CENTRED,
        stiffness=CENTRED.stiffness / 4.0,
        damping=CENTRED.damping / 2.0,
        friction_force=CENTRED.friction_force / 4.0,
        disc_speed=CENTRED.disc_speed / 2.0,
    )
    before = evidence_of(COEFFICIENT)
    monkeypatch.setattr(errata, "CENTRED", halved)
    after = COEFFICIENT.evidence()
    assert after.corrected_value == pytest.approx(before.corrected_value / 2.0, rel=ROUNDING)
    assert after.exact == pytest.approx(before.exact / 2.0, rel=ROUNDING)
    assert after.printed_value != pytest.approx(before.printed_value / 2.0, rel=0.1)


def test_the_error_of_the_printed_18_stays_as_the_offset_falls_and_that_of_the_corrected_one_goes():
    printed, corrected = [], []
    for offset in (0.02, 0.01):
        pin = replace(CENTRED, disc_speed=1.2, offset=offset)
        mean = whirl_orbit(pin, samples=64).mean
        printed.append(math.dist(whirl_shift(pin), mean) / offset)
        corrected.append(math.dist(first_order_whirl_shift(pin), mean) / offset)
    growth = (6.0 * 0.02 / 1.2) ** 2  # relative size of the next order
    assert printed[0] == pytest.approx(printed[1], rel=growth)
    assert corrected[0] / corrected[1] == pytest.approx(4.0, rel=2.0 * growth)


def test_the_printed_22_gives_a_moment_that_does_not_depend_on_the_slip_of_the_centre():
    """The value of (23) by hand at U = W is (1 − ½·½ + ¾·¼)/√2; the average of the printed line is 1."""
    evidence = evidence_of(EXPANSION)
    assert evidence.exact == pytest.approx(0.9375 / math.sqrt(2.0), rel=ROUNDING)
    assert evidence.printed_value == pytest.approx(1.0, rel=ROUNDING)


def test_deviations_from_the_equilibrium_of_the_disc_grow_and_those_of_the_pin_do_not():
    evidence = evidence_of(STABLE)
    assert evidence.exact > 1e-3
    # For a pin, by hand: mλ² + βλ + C = 0 with β = 0.003.
    assert evidence.printed_value == pytest.approx(-0.0015, rel=ROUNDING)


def test_the_load_of_the_erratum_is_the_one_at_which_the_equilibrium_loses_its_stability():
    growth = [
        self_centred_equilibria(replace(FIG9, friction_force=load))[0].eigenvalues[0].real
        for load in (0.02095, 0.02105)
    ]
    assert growth[0] < 0.0 < growth[1]
    assert "0.0210 N" in STABLE.correct


def test_the_exact_spin_balances_the_equations_of_motion_with_23():
    """The test evaluates (19) with (23) at the position and spin of the evidence."""
    (disc,) = self_centred_equilibria(FIG8, ThreeTermRing(FIG8.contact_radius))
    assert disc.spin == evidence_of(BRACKET).exact
    slip = FIG8.disc_speed * np.array([disc.y, -disc.x])
    rim = FIG8.contact_radius * (FIG8.disc_speed - disc.spin)
    square = slip @ slip + rim**2
    both = 0.75 * rim**2 * (slip @ slip) / square**2
    force = -FIG8.friction_force * slip / math.sqrt(square) * (1.0 - rim**2 / (2.0 * square) + both)
    moment = FIG8.friction_force * FIG8.contact_radius * rim / math.sqrt(square)
    moment *= 1.0 - (slip @ slip) / (2.0 * square) + both
    springs = FIG8.stiffness * np.array([disc.x - FIG8.offset, disc.y])
    assert springs == pytest.approx(force, abs=ROUNDING)
    assert FIG8.shaft_damping * (disc.spin - FIG8.shaft_speed) == pytest.approx(moment, abs=ROUNDING)
    assert disc.x**2 + disc.y**2 == pytest.approx(disc.x * FIG8.offset, abs=ROUNDING)  # (4)


def test_the_error_of_the_printed_26_does_not_go_with_the_load_and_that_of_the_corrected_one_is_rounding():
    """Both are exact without friction; their difference is of first order in the load, like friction itself."""
    moved, wrong = [], []
    for load in (1e-3, 5e-4):
        disc = replace(FIG8, friction_force=load)
        (exact,) = self_centred_equilibria(disc, ThreeTermRing(disc.contact_radius))
        (printed,), (corrected,) = places_by_26(disc, as_printed=True), places_by_26(disc)
        assert corrected == pytest.approx((exact.x, exact.y, exact.spin), abs=1e-12)
        moved.append(exact.y)
        wrong.append(printed.y - exact.y)
    assert np.divide(wrong, moved) == pytest.approx([wrong[0] / moved[0]] * 2, rel=0.02)
    assert wrong[0] < -0.3 * moved[0]
