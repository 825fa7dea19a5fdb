import json

import numpy as np
import pytest
from fake_studies import claim

from compare.claims.as_json import claim_as_json, claim_from_json
from compare.claims.claim import DOUBT, ErrorBudget, Grade, Verdict
from compare.claims.error_estimates import refined
from compare.claims.measured import Measured
from compare.claims.prose import Prose
from compare.claims.study import Study
from compare.report.numbers import account, decision, in_short, worst


@pytest.mark.parametrize(
    ("difference", "numerical", "model", "resolution", "verdict"),
    [
        (0.5e-9, 1e-9, 0.0, 1e-6, Verdict.AGREES),
        (1.0, 1.0, 0.0, 1.0, Verdict.AGREES),  # the bounds are inclusive
        (1.001e-9, 1e-9, 0.0, 1e-6, Verdict.AGREES),  # within the resolution
        (1.4e-14, 7e-15, 0.0, 1e-6, Verdict.AGREES),
        (1e-6, 1e-9, 0.0, 1e-6, Verdict.AGREES),
        (1.001e-6, 1e-9, 0.0, 1e-6, Verdict.DIFFERS),
        (1.5e-9, 1e-9, 1e-9, 1e-6, Verdict.AGREES),
        (0.1, 0.5, 0.0, 1e-6, Verdict.INCONCLUSIVE),
        (0.1, 0.0, 0.5, 1e-6, Verdict.INCONCLUSIVE),
        (0.1, np.inf, 0.0, 1e-6, Verdict.INCONCLUSIVE),
        (0.6, 0.5, 0.0, 1e-6, Verdict.INCONCLUSIVE),
        (1.6, 0.5, 0.0, 1e-6, Verdict.DIFFERS),  # more than even a poor measurement explains
        (np.nan, 1.0, 0.0, 1.0, Verdict.DIFFERS),
        (np.inf, 1.0, 0.0, 1.0, Verdict.DIFFERS),
        (np.nan, np.nan, 0.0, 1.0, Verdict.DIFFERS),
        (1e9, np.inf, 0.0, 1.0, Verdict.INCONCLUSIVE),
        (0.0, np.nan, 0.0, 2.0, Verdict.INCONCLUSIVE),  # the coarser run gave no number
        (np.nan, np.inf, 0.0, 1.0, Verdict.INCONCLUSIVE),  # present at one tolerance but not at another
    ],
)
def test_verdict_of_a_number(difference, numerical, model, resolution, verdict):
    made = claim("c", "good", 0.0, difference, numerical, model=model, resolution=resolution, doubt=DOUBT)
    assert made.verdict is verdict


def test_an_error_that_many_runs_show_is_not_doubted():
    made = claim("c", "good", 0.0, 0.6, 0.5)
    assert made.verdict is Verdict.DIFFERS


@pytest.mark.parametrize(
    ("difference", "numerical", "more"),
    [(1e-8, 1e-9, {"negligible": 0.0}), (1e-8, 1e-9, {}), (0.6, 0.5, {"doubt": DOUBT}), (0.6, 0.5, {})],
)
def test_a_stored_claim_has_the_same_verdict(difference, numerical, more):
    made = claim("c", "good", 0.0, difference, numerical, **more)
    stored = json.loads(json.dumps(claim_as_json(made)))
    assert claim_from_json(stored).verdict is made.verdict


@pytest.mark.parametrize(
    ("value", "error", "more", "grade", "verdict"),
    [
        (2.0, 2e-8, {"resolution": 1e-9}, Grade.EXACT, Verdict.AGREES),
        (2.0, 6e-5, {"resolution": 1e-9}, Grade.FINE, Verdict.AGREES),
        (2.0, 1.8e-2, {"resolution": 1e-9}, Grade.COARSE, Verdict.AGREES),
        (2.0, 1.0, {"resolution": 1e-9}, None, Verdict.INCONCLUSIVE),
        # the relative error needs a size, and is at least the difference
        (0.0, 1e-12, {}, None, Verdict.AGREES),
        (0.0, 1e-12, {"size": 1.0}, Grade.EXACT, Verdict.AGREES),
        (2.0, 1e-12, {"kind": "order"}, None, Verdict.AGREES),
        (2.0, 1e-12, {"measured": 2.0 + 1e-6}, Grade.FINE, Verdict.AGREES),
        (2.0, 1e-12, {"measured": 2.0 + 1e-6, "negligible": 1e-7}, Grade.FINE, Verdict.DIFFERS),
        (2.0, 0.0, {"measured": 1.0, "answers": True, "resolution": 1.5}, None, Verdict.DIFFERS),
        (2.0, 0.0, {"answers": True}, None, Verdict.AGREES),
    ],
)
def test_beyond_its_resolution_an_error_is_graded_relative_to_the_size(value, error, more, grade, verdict):
    made = claim("c", "good", value, more.pop("measured", value), error, **{"resolution": 1.1e-6} | more)
    assert (made.grade, made.verdict) == (grade, verdict)


def test_the_size_of_a_prediction_is_taken_within_one_unit():
    predicted, error = np.array([[1e3, 1e-3], [0.0, 0.0]]), np.array([1.0, 1.0])
    mixed = claim(
        "c", "good", predicted, predicted, error, unit="m, rad/s", axes=((), ("x in m", "spin in rad/s"))
    )
    alike = claim("c", "good", predicted, predicted, error, axes=((), ("x in m", "y in m")))
    assert (mixed.grade, alike.grade) == (None, Grade.COARSE)


@pytest.mark.parametrize(
    ("differences", "budgets", "nearest", "largest"),
    [
        ([1e-13, 9e-6, 1e-7], [1e-12, 1e-5, 1e-3], 1, 1),  # 0.1, 0.9 and 1e-4 of the budget
        ([9e-9, 1e-6], [1e-8, 1e-3], 0, 1),
        ([0.0, 1e-9], [0.0, 1.0], 1, 1),  # exact, so without a budget
        ([1e-30, 5.0], [0.0, 10.0], 0, 1),  # the ratio to a budget of zero is infinite
        ([1e-9, 1e-8, 2.0], [0.0, 0.0, 4.0], 1, 2),
        ([3.0, 1.0], [np.inf, 10.0], 1, 0),
        ([0.5, np.nan], [0.1, 1.0], 1, 1),  # a missing number is the worst
        ([0.5, 0.2], [1.0, np.nan], 1, 0),
    ],
)
def test_the_worst_element_is_the_one_with_the_largest_share_of_its_budget(
    differences, budgets, nearest, largest
):
    made = claim("c", "good", np.zeros(len(differences)), differences, budgets, resolution=100.0)
    assert made.worst == nearest
    assert worst(made).largest[0].index == largest


@pytest.mark.parametrize(
    ("measured", "numerical", "decided"),
    [
        (np.nan, 1.0, "the engine returned NaN at t = 2 s, so a number is missing"),
        (5.0, np.nan, "no error budget at t = 2 s: a number is missing at one of two tolerances"),
        (5.0, np.inf, "no error budget at t = 2 s: a number is missing at one of two tolerances"),
        (5.0, 1e-3, "differs by 5.0 m; the error budget is 0.0010 m"),
        (5.0, 9.0, "the error budget of 9.0 m is too large for a verdict"),
    ],
)
def test_the_reason_of_a_verdict_is_in_words(measured, numerical, decided):
    axes = (("t = 1 s", "t = 2 s"),)
    made = claim("c", "good", np.zeros(2), [1e-7, measured], [1e-9, numerical], axes=axes)
    assert decision(made) == decided
    assert account(made).startswith(decided) == (not np.isfinite(measured + numerical))


MIXED = {"unit": "m, rad", "axes": ((), ("x in m", "angle in rad")), "resolution": 100.0}


def test_numbers_of_several_units_are_compared_within_each_unit():
    made = claim("c", "good", np.zeros((2, 2)), [[0.3, 2.0], [0.1, 9.0]], 10.0, **MIXED)
    assert [(one.index, one.unit, one.difference) for one in worst(made).largest] == [
        (0, "m", 0.3),
        (3, "rad", 9.0),
    ]
    assert (worst(made).unit, in_short(made)) == ("rad", "±\N{NO-BREAK SPACE}10 rad")


@pytest.mark.parametrize(
    ("predicted", "measured", "numerical", "more", "words"),
    [
        (np.zeros(2), np.zeros(3), 0.0, {}, "predicted has shape"),
        (np.zeros(0), np.zeros(0), 0.0, {}, "predicted is empty"),
        (np.zeros(2), np.zeros(2), np.zeros((3, 2)), {}, "numerical error has shape"),
        (1.0, 1.0, 1.0, {"basis": "algebra"}, "basis = 'algebra' requires engine = 'theory'"),
        (1.0, 1.0, 1.0, {"basis": "luck"}, "basis = 'luck': it must be one of independent"),
        (
            np.zeros(2),
            np.zeros(2),
            1.0,
            MIXED | {"axes": (("x in m", "angle"),)},
            "each component must name its unit",
        ),
        (0.0, 0.0, -1.0, {}, "error budget"),
        (0.0, 0.0, 0.0, {"model": -1.0}, "error budget"),
        (0.0, 0.0, 0.0, {"model": np.nan}, "error budget"),
        (0.0, 0.0, 0.0, {"resolution": 0.0}, "error budget"),
    ],
)
def test_an_invalid_claim_is_rejected(predicted, measured, numerical, more, words):
    with pytest.raises(ValueError, match=words):
        claim("c", "good", predicted, measured, numerical, **more)


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: ErrorBudget("1", resolution=1.0), "^numerical = '1': it must be a number"),
        (lambda: ErrorBudget(0.0, resolution=None), "^resolution = None: it must be a number"),
        (lambda: ErrorBudget(0.0, resolution=1.0, doubt=0.5), "^doubt = 0.5: it must be >= 1"),
        (lambda: Measured(predicted=1j, value=1.0), "^predicted = 1j: it must be a number"),
        (
            lambda: Measured(predicted=1.0, value=1.0, answers="no"),
            "^answers = 'no': it must be True or False",
        ),
        (lambda: Measured(predicted=1.0, value=1.0, system="pin"), "^system = 'pin': it must be a PinOnDisc"),
        (lambda: refined(lambda tolerance: tolerance, -1.0), "^tolerance = -1.*: it must be > 0"),
        (lambda: refined(5), "^quantity = 5: it must be a function"),
        (lambda: Study(5, Prose("A title")), "^name = 5: it must be a str"),
        (lambda: Study("mine", "A title"), "^prose = 'A title': it must be a Prose"),
        (lambda: Study("mine", Prose("A title"), system="pin"), "^system = 'pin': it must be a PinOnDisc"),
        (lambda: Study("mine", Prose("A title"), seconds=-1.0), "^seconds = -1 s: it must be > 0"),
        (
            lambda: Study("mine", Prose("A title"), only="exudyn"),
            "^only = 'exudyn': it must be a tuple or a list",
        ),
        (lambda: Study("mine", Prose("A title"), quick="yes"), "^quick = 'yes': it must be True or False"),
    ],
)
def test_wrong_arguments_of_measurements_are_refused(call, message):
    with pytest.raises(ValueError, match=message):
        call()
