import numpy as np
import pytest

from compare.claims.claim import Verdict
from compare.studies.disc.fig09 import STUDY, growth_and_stick, theory
from compare.studies.disc.fig09.theory import LARGEST_LOAD, RING


@pytest.mark.parametrize(
    ("formula", "claim", "factor"),
    [
        ("weak_damping_load", "weak_damping", 1.1),
        ("last_stable_load", "merges", 1.001),
        ("smallest_load_with_whirl", "fold", 1.001),
    ],
)
def test_a_wrong_formula_differs(formula, claim, factor, monkeypatch):
    right = getattr(growth_and_stick, formula)
    monkeypatch.setattr(growth_and_stick, formula, lambda *which: factor * right(*which))
    (found,) = STUDY.measure_theory(only=(claim,)).claims
    assert found.verdict is Verdict.DIFFERS


def test_the_curve_of_whirls_ends_at_the_equilibrium():
    load, least, greatest, spin = theory.smooth(theory.orbits())["orbits"].T
    rest = theory.rest_of(load[-1])
    assert load[0] == pytest.approx(LARGEST_LOAD)
    assert load[-1] == pytest.approx(theory.last_stable_load(RING))
    assert least[-1] == pytest.approx(np.hypot(rest.x, rest.y))
    assert greatest[-1] == pytest.approx(least[-1])
    assert spin[-1] == pytest.approx(rest.spin)
    assert np.all(least <= greatest)
