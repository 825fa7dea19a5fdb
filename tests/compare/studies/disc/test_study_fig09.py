"""The study of Figs. 9 and 10: limits of its formulas, and wrong formulas are seen."""

from dataclasses import replace

import numpy as np
import pytest
from studies_under_test import altered
from tested_studies import FIG09

from compare.claims.claim import Verdict
from compare.studies.disc.fig09 import STUDY, of_theory, theory
from compare.studies.disc.fig09.theory import LARGEST_LOAD, RING
from compare.studies.toolkit.steady_motion import last_load
from reference_model.formulas.disc import pin_of, whirl_at
from reference_model.formulas.pin import first_order_whirl_shift


def test_a_disc_with_half_the_friction_does_not_stick_where_it_should():
    found = STUDY.measure(altered(friction_force=0.5), only=("sticks", "coexist")).claims
    assert [claim.verdict for claim in found] == [Verdict.DIFFERS] * 2


def test_the_spin_of_the_whirl_tends_to_a_limit_that_does_not_depend_on_the_load():
    far = [whirl_at(RING, alpha) for alpha in (1e-4, 1e-6)]
    assert far[1].load == pytest.approx(100.0 * far[0].load, rel=1e-6)
    # The next term of M : R²S/(2U) is of the order α².
    for whirl, alpha in zip(far, (1e-4, 1e-6), strict=True):
        assert whirl.spin == pytest.approx(theory.spin_of_large_whirl(RING), abs=alpha**2 + 1e-14)


def test_the_shift_of_a_small_disc_is_that_of_a_pin():
    small = replace(RING, contact_radius=1e-5, shaft_damping=1e-9, damping=0.1, friction_force=0.12)
    shift = theory.first_order_shift(small)
    pin = first_order_whirl_shift(pin_of(small))
    assert [shift.real, shift.imag] == pytest.approx(pin, rel=1e-9)


@pytest.mark.parametrize(("load", "stable"), [(0.02, True), (0.022, False), (0.1, False)])
def test_the_equilibrium_is_stable_up_to_a_load_far_below_that_of_sticking(load, stable):
    assert theory.rest_of(load).stable is stable
    assert theory.last_stable_load(RING) < 0.25 * last_load(RING)


@pytest.mark.parametrize(
    ("formula", "claim", "factor"),
    [
        ("weak_damping_load", "weak_damping", 1.1),
        ("last_stable_load", "merges", 1.001),
        ("smallest_load_with_whirl", "fold", 1.001),
    ],
)
def test_a_wrong_formula_is_seen(formula, claim, factor, monkeypatch):
    right = getattr(of_theory, formula)
    monkeypatch.setattr(of_theory, formula, lambda *which: factor * right(*which))
    (found,) = STUDY.measure_theory(only=(claim,)).claims
    assert found.verdict is Verdict.DIFFERS


def test_the_curve_of_the_whirls_goes_from_the_largest_load_to_the_equilibrium():
    load, least, greatest, spin = FIG09.found("theory").data["orbits"].T
    rest = theory.rest_of(load[-1])
    assert load[0] == pytest.approx(LARGEST_LOAD)
    assert load[-1] == pytest.approx(theory.last_stable_load(RING))
    assert least[-1] == pytest.approx(np.hypot(rest.x, rest.y))
    assert greatest[-1] == pytest.approx(least[-1])
    assert spin[-1] == pytest.approx(rest.spin)
    assert np.all(least <= greatest)
