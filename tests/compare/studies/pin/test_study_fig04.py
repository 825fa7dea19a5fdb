import numpy as np
import pytest
from studies_under_test import engine_named

from compare.claims.claim import Verdict
from compare.studies.pin import fig04 as study
from compare.studies.pin.fig04 import STUDY
from reference_model.formulas.pin import first_order_whirl_response, whirl_shift


@pytest.mark.parametrize(("factor", "seen"), [(1.01, {"shift", "limit"}), (1.0001, {"limit"})])
def test_a_wrong_equation_18_differs_from_a_correct_engine(monkeypatch, factor, seen):
    monkeypatch.setattr(study, "whirl_shift", lambda pin: tuple(factor * np.array(whirl_shift(pin))))
    assert those_that_differ() == seen


def test_a_wrong_first_order_response_differs_from_a_correct_engine(monkeypatch):
    def wrong(pin):
        right = first_order_whirl_response(pin)
        return right._replace(second_harmonic=1.001 * right.second_harmonic)

    monkeypatch.setattr(study, "first_order_whirl_response", wrong)
    assert those_that_differ() == {"response"}


def those_that_differ():
    found = STUDY.measure(
        engine_named("reference"), only=[f"{name}/1.5" for name in ("shift", "response", "order", "limit")]
    )
    return {claim.identity.split("/")[1] for claim in found.claims if claim.verdict is Verdict.DIFFERS}


def test_the_error_bound_of_equation_18_needs_no_simulation(monkeypatch):
    def refuse(*arguments, **options):
        raise AssertionError("simulated")

    monkeypatch.setattr("reference_model.simulation.simulate_by", refuse)
    for speed in study.CLAIM_SPEEDS:
        pin = study.pin_at(speed)
        assert study.error_of_eq18(pin) < 0.05 * np.hypot(*whirl_shift(pin))
