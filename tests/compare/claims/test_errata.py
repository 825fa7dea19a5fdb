"""Each corrected formula of the errata gives the exact number, and the printed one does not."""

import functools
from dataclasses import replace

import pytest

from compare.claims.errata import ERRATA
from compare.claims.parameters import FIG9
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


@pytest.mark.parametrize("erratum", ERRATA, ids=lambda erratum: erratum.equation)
def test_the_corrected_formula_gives_the_exact_number_and_the_printed_one_does_not(erratum):
    evidence = evidence_of(erratum)
    tolerance = TOLERANCES[erratum] * max(1.0, abs(evidence.exact))
    assert abs(evidence.corrected_value - evidence.exact) <= tolerance
    # The factor 100 ensures that no choice of the tolerance confuses the two.
    assert abs(evidence.printed_value - evidence.exact) > 100.0 * tolerance


def test_the_equilibrium_of_the_disc_loses_its_stability_at_the_load_in_the_erratum():
    evidence = evidence_of(STABLE)
    assert evidence.exact > 1e-3
    # For a pin, by hand: mλ² + βλ + C = 0 with β = 0.003.
    assert evidence.printed_value == pytest.approx(-0.0015, rel=ROUNDING)
    growth = [
        self_centred_equilibria(replace(FIG9, friction_force=load))[0].eigenvalues[0].real
        for load in (0.02095, 0.02105)
    ]
    assert growth[0] < 0.0 < growth[1]
    assert "0.0210 N" in STABLE.correct
