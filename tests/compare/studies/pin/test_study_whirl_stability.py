"""The study of the whirl: what its claims see, and that its theory sees wrong formulas."""

import numpy as np
import pytest
from studies_under_test import GROSS
from study_harness import LEFT_OUT, SEES, StudyTests

from compare.claims.claim import Verdict
from compare.studies.pin.whirl_stability import study
from compare.studies.pin.whirl_stability.study import STUDY
from reference_model.formulas.pin import characteristic_coefficients_as_printed

SPEEDS, STARTS, POINTS = {"speeds": (1.5,)}, {"starts": (0.8, 1.5)}, {"points": ((1.5, 0.1), (1.5, 1.0))}


class TestWhirlStability(StudyTests):
    study = STUDY
    sound = ("reference", "exudyn")
    few = {
        "radius": SPEEDS,
        "frequency": SPEEDS,
        "balance": STARTS,
        "caught": STARTS,
        "eigenvalues": POINTS,
        "stable": POINTS,
    }
    faults = GROSS
    columns = ("radius", "frequency", "balance", "caught", "eigenvalues", "stable", "history")
    table = {
        # The pin whirls backwards on a circle of the right radius: only (11)'s radius does not see that.
        "wrong sign": (LEFT_OUT, SEES, SEES, SEES, SEES, SEES, SEES),
        "square": (SEES, SEES, LEFT_OUT, LEFT_OUT, SEES, LEFT_OUT, SEES),
        # The pin ends stuck to the disc whatever the damping, and deviations still decay, only slower.
        "half the damping": (SEES, LEFT_OUT, SEES, LEFT_OUT, SEES, LEFT_OUT, SEES),
    }

    def test_every_claim_holds_in_the_engine_that_faults_are_put_into(self):
        found = {claim.sentence: claim.verdict for claim in self.found("intact").claims}
        assert list(found) == list(STUDY.sentences())
        # It knows the radius to 1.4e-9 m or so, and the claim asks for 1.2e-9 m.
        radius = next(iter(found))
        assert found.pop(radius) is not Verdict.DIFFERS
        assert found == dict.fromkeys(found, Verdict.AGREES)


def verdict(function):
    (claim,) = STUDY.measure_theory(only=(function,)).claims
    return claim.verdict


def test_the_count_of_disagreements_sees_a_wrong_condition(monkeypatch):
    """The margin of (16) shifted a little disagrees with the eigenvalues at some points of the grid."""
    margin = study.upper_branch_margin
    monkeypatch.setattr(study, "upper_branch_margin", lambda pin: margin(pin) + 0.02)
    assert verdict("hurwitz") is Verdict.DIFFERS


def test_the_printed_equation_13_does_not_pass(monkeypatch):
    monkeypatch.setattr(study, "characteristic_coefficients", characteristic_coefficients_as_printed)
    assert verdict("same_eigenvalues") is Verdict.DIFFERS


def test_the_linear_deviation_solves_the_linear_equations():
    times = np.linspace(0.0, 2.0, 201)
    deviation = study.linear_deviation(times)
    assert deviation[0] == 1.0
    assert (deviation[1] - deviation[0]) / times[1] == pytest.approx(study.K, rel=0.01)
