import numpy as np
import pytest
from fake_studies import claim

from compare.claim import ErrorBudget, Verdict
from compare.report.worst import worst


@pytest.mark.parametrize(
    ("difference", "numerical", "model", "resolution", "verdict"),
    [
        (0.5e-9, 1e-9, 0.0, 1e-6, Verdict.AGREES),
        (1.0, 1.0, 0.0, 1.0, Verdict.AGREES),  # the bounds themselves are allowed
        (1.5e-9, 1e-9, 0.0, 1e-6, Verdict.DIFFERS),
        (1.5e-9, 1e-9, 1e-9, 1e-6, Verdict.AGREES),
        (0.1, 0.5, 0.0, 1e-6, Verdict.INCONCLUSIVE),
        (0.1, 0.0, 0.5, 1e-6, Verdict.INCONCLUSIVE),
        (0.1, np.inf, 0.0, 1e-6, Verdict.INCONCLUSIVE),
        (0.6, 0.5, 0.0, 1e-6, Verdict.DIFFERS),  # further off than even a poor measurement explains
        (np.nan, 1.0, 0.0, 1.0, Verdict.DIFFERS),
        (np.inf, 1.0, 0.0, 1.0, Verdict.DIFFERS),
        (np.nan, np.inf, 0.0, 1.0, Verdict.DIFFERS),
    ],
)
def test_verdict_of_a_number(difference, numerical, model, resolution, verdict):
    made = claim("c", "good", 0.0, difference, numerical, model=model, resolution=resolution)
    assert made.verdict is verdict


def test_one_element_of_an_array_decides_for_all():
    predicted = np.zeros(4)
    measured = np.array([0.0, 1e-9, 0.0, 3e-9])
    assert claim("c", "good", predicted, measured, 3e-9).verdict is Verdict.AGREES
    differing = claim("c", "good", predicted, measured, 2e-9)
    assert differing.verdict is Verdict.DIFFERS
    assert (worst(differing).index, worst(differing).count) == (3, 4)
    assert worst(differing).difference == 3e-9


def test_a_missing_element_differs_and_is_the_worst():
    made = claim("c", "good", np.zeros(3), np.array([0.0, np.nan, 0.5]), 1e-9)
    assert made.verdict is Verdict.DIFFERS
    assert worst(made).index == 1


def test_an_inconclusive_array_shows_its_least_certain_element():
    made = claim("c", "good", np.zeros(3), np.array([1e-9, 0.0, 0.0]), np.array([1e-9, 1.0, 1e-9]))
    assert made.verdict is Verdict.INCONCLUSIVE
    assert worst(made).index == 1


def test_an_error_that_could_not_be_estimated_is_no_agreement():
    """An engine whose coarser run gives no numbers loses this claim, not the whole study."""
    assert claim("c", "good", 1.0, 1.0, np.nan, resolution=2.0).verdict is Verdict.DIFFERS


def test_a_predicted_nan_is_no_agreement():
    assert claim("c", "good", np.nan, 1.0, 1.0, resolution=2.0).verdict is Verdict.DIFFERS


@pytest.mark.parametrize(
    ("predicted", "measured", "numerical", "words"),
    [
        (np.zeros(2), np.zeros(3), 0.0, "predicted has shape"),
        (np.zeros(0), np.zeros(0), 0.0, "has no numbers"),
        (np.zeros(2), np.zeros(2), np.zeros((3, 2)), "numerical error has shape"),
    ],
)
def test_shapes_that_prove_nothing_are_refused(predicted, measured, numerical, words):
    with pytest.raises(ValueError, match=words):
        claim("c", "good", predicted, measured, numerical)


@pytest.mark.parametrize("budget", [(-1.0, 0.0, 1.0), (0.0, -1.0, 1.0), (0.0, np.nan, 1.0), (0.0, 0.0, 0.0)])
def test_a_budget_without_meaning_is_refused(budget):
    numerical, model, resolution = budget
    with pytest.raises(ValueError, match="error budget"):
        ErrorBudget(numerical, model=model, resolution=resolution)
