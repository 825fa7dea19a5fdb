import numpy as np
import pytest
from studies_under_test import DIFFERS, theory_of

from compare.studies.pin.whirl_stability import study
from compare.studies.pin.whirl_stability.study import STUDY
from reference_model.formulas.pin import characteristic_coefficients_as_printed


def test_a_wrong_stability_condition_differs(monkeypatch):
    """A slightly shifted margin (16) disagrees with eigenvalues at some points of the grid."""
    margin = study.upper_branch_margin
    monkeypatch.setattr(study, "upper_branch_margin", lambda pin: margin(pin) + 0.02)
    assert theory_of(STUDY, "hurwitz") == {"hurwitz": DIFFERS}


def test_the_printed_equation_13_differs(monkeypatch):
    monkeypatch.setattr(study, "characteristic_coefficients", characteristic_coefficients_as_printed)
    assert theory_of(STUDY, "same_eigenvalues") == {"same_eigenvalues": DIFFERS}


def test_the_linear_deviation_solves_the_linear_equations():
    times = np.linspace(0.0, 2.0, 201)
    deviation = study.linear_deviation(times)
    assert deviation[0] == 1.0
    assert (deviation[1] - deviation[0]) / times[1] == pytest.approx(study.K, rel=0.01)
