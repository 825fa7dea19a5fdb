import numpy as np
import pytest
from fake_studies import claim

from compare.claims.claim import ErrorBudget, Grade, Verdict
from compare.report.numbers import in_short, worst


@pytest.mark.parametrize(
    ("difference", "numerical", "model", "resolution", "verdict"),
    [
        (0.5e-9, 1e-9, 0.0, 1e-6, Verdict.AGREES),
        (1.0, 1.0, 0.0, 1.0, Verdict.AGREES),  # the bounds are inclusive
        (1.5e-9, 1e-9, 0.0, 1e-6, Verdict.DIFFERS),
        (1.5e-9, 1e-9, 1e-9, 1e-6, Verdict.AGREES),
        (0.1, 0.5, 0.0, 1e-6, Verdict.INCONCLUSIVE),
        (0.1, 0.0, 0.5, 1e-6, Verdict.INCONCLUSIVE),
        (0.1, np.inf, 0.0, 1e-6, Verdict.INCONCLUSIVE),
        (0.6, 0.5, 0.0, 1e-6, Verdict.DIFFERS),  # more than even a poor measurement explains
        (np.nan, 1.0, 0.0, 1.0, Verdict.DIFFERS),
        (np.inf, 1.0, 0.0, 1.0, Verdict.DIFFERS),
        (np.nan, np.nan, 0.0, 1.0, Verdict.DIFFERS),
        (np.nan, np.inf, 0.0, 1.0, Verdict.INCONCLUSIVE),  # present at one tolerance but not at another
    ],
)
def test_verdict_of_a_number(difference, numerical, model, resolution, verdict):
    made = claim("c", "good", 0.0, difference, numerical, model=model, resolution=resolution)
    assert made.verdict is verdict


@pytest.mark.parametrize(
    ("error", "grade", "verdict"),
    [
        (1e-8, Grade.EXACT, Verdict.AGREES),
        (3e-5, Grade.FINE, Verdict.AGREES),
        (9e-3, Grade.COARSE, Verdict.AGREES),
        (0.5, None, Verdict.INCONCLUSIVE),
    ],
)
def test_an_error_beyond_the_resolution_is_judged_by_the_size_of_what_is_predicted(error, grade, verdict):
    made = claim("c", "good", 2.0, 2.0, 2.0 * error, resolution=1e-9)
    assert (made.grade, made.verdict) == (grade, verdict)


def test_a_size_is_of_the_numbers_of_one_unit():
    predicted, error = np.array([[1e3, 1e-3], [0.0, 0.0]]), np.array([1.0, 1.0])
    mixed = claim(
        "c", "good", predicted, predicted, error, unit="m, rad/s", axes=((), ("x in m", "spin in rad/s"))
    )
    alike = claim("c", "good", predicted, predicted, error, axes=((), ("x in m", "y in m")))
    assert (mixed.grade, alike.grade) == (None, Grade.COARSE)


def test_what_has_no_size_has_no_grade():
    zero = claim("c", "good", 0.0, 0.0, 1e-12)
    assert (zero.grade, zero.verdict) == (None, Verdict.AGREES)
    assert claim("c", "good", 0.0, 0.0, 1e-12, size=1.0).grade is Grade.EXACT
    assert claim("c", "good", 2.0, 2.0, 1e-12, kind="order").grade is None
    assert claim("c", "good", 2.0, 2.0, 0.0, answers=True).grade is None


def test_one_element_of_an_array_decides_for_all():
    predicted = np.zeros(4)
    measured = np.array([0.0, 1e-9, 0.0, 3e-9])
    assert claim("c", "good", predicted, measured, 3e-9).verdict is Verdict.AGREES
    differing = claim("c", "good", predicted, measured, 2e-9)
    assert differing.verdict is Verdict.DIFFERS
    assert (worst(differing).index, worst(differing).count) == (3, 4)
    assert worst(differing).difference == 3e-9


@pytest.mark.parametrize(
    ("differences", "budgets", "nearest", "largest"),
    [
        (
            [1e-13, 9e-6, 1e-7],
            [1e-12, 1e-5, 1e-3],
            1,
            1,
        ),  # a tenth, nine tenths, a ten-thousandth of the budget
        ([9e-9, 1e-6], [1e-8, 1e-3], 0, 1),
        ([0.0, 1e-9], [0.0, 1.0], 1, 1),  # exact, so without a budget
        ([1e-30, 5.0], [0.0, 10.0], 0, 1),  # the ratio to a budget of zero is infinite
        ([1e-9, 1e-8, 2.0], [0.0, 0.0, 4.0], 1, 2),
        ([3.0, 1.0], [np.inf, 10.0], 1, 0),
        ([0.5, np.nan], [0.1, 1.0], 1, 1),  # a missing number is the worst
        ([0.5, 0.2], [1.0, np.nan], 1, 0),
    ],
)
def test_the_element_that_stands_for_an_array_is_the_one_with_the_least_of_its_budget_left(
    differences, budgets, nearest, largest
):
    made = claim("c", "good", np.zeros(len(differences)), differences, budgets, resolution=100.0)
    assert made.worst == nearest
    assert worst(made).largest[0].index == largest


def test_an_exact_number_without_a_budget_agrees_at_a_ratio_of_zero():
    made = claim("c", "good", [1.0, 2.0], [1.0, 2.0], 0.0)
    assert made.verdict is Verdict.AGREES
    np.testing.assert_array_equal(made.ratio, [0.0, 0.0])


def test_the_largest_difference_is_told_beside_the_one_that_decides():
    made = claim("c", "good", np.zeros(2), [9e-9, 1e-6], [1e-8, 1e-3], resolution=1.0)
    element = worst(made)
    assert (element.index, element.difference, element.total) == (0, 9e-9, 1e-8)
    (largest,) = element.largest
    assert (largest.index, largest.difference) == (1, 1e-6)


def test_numbers_of_several_units_are_compared_within_each_unit():
    parts = {"unit": "m, rad", "axes": ((), ("x in m", "angle in rad")), "resolution": 100.0}
    made = claim("c", "good", np.zeros((2, 2)), [[0.3, 2.0], [0.1, 9.0]], 10.0, **parts)
    assert [(one.index, one.unit, one.difference) for one in worst(made).largest] == [
        (0, "m", 0.3),
        (3, "rad", 9.0),
    ]
    assert (worst(made).unit, in_short(made)) == ("rad", "±\N{NO-BREAK SPACE}10 rad")
    with pytest.raises(ValueError, match="each component must name its unit"):
        claim("c", "good", np.zeros(2), np.zeros(2), 1.0, **parts | {"axes": (("x in m", "angle"),)})


def test_algebra_is_of_the_theory_alone():
    with pytest.raises(ValueError, match="basis = 'algebra' requires engine = 'theory'"):
        claim("c", "good", 1.0, 1.0, 1.0, basis="algebra")
    with pytest.raises(ValueError, match="basis = 'luck': it must be one of independent"):
        claim("c", "good", 1.0, 1.0, 1.0, basis="luck")


def test_a_missing_element_differs_and_is_the_worst():
    made = claim("c", "good", np.zeros(3), np.array([0.0, np.nan, 0.5]), 1e-9)
    assert made.verdict is Verdict.DIFFERS
    assert worst(made).index == 1


def test_an_inconclusive_array_shows_its_least_certain_element():
    made = claim("c", "good", np.zeros(3), np.array([1e-9, 0.0, 0.0]), np.array([1e-9, 1.0, 1e-9]))
    assert made.verdict is Verdict.INCONCLUSIVE
    assert worst(made).index == 1


def test_an_error_that_could_not_be_estimated_is_no_agreement():
    """An engine whose coarser run gives no numbers fails this claim, not the whole study."""
    assert claim("c", "good", 1.0, 1.0, np.nan, resolution=2.0).verdict is Verdict.DIFFERS


def test_a_predicted_nan_is_no_agreement():
    assert claim("c", "good", np.nan, 1.0, 1.0, resolution=2.0).verdict is Verdict.DIFFERS


@pytest.mark.parametrize(
    ("predicted", "measured", "numerical", "words"),
    [
        (np.zeros(2), np.zeros(3), 0.0, "predicted has shape"),
        (np.zeros(0), np.zeros(0), 0.0, "predicted is empty"),
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
