"""Yes-or-no claims differ if a case certainly fails, and are inconclusive if the engine's error leaves one open."""

import numpy as np
import pytest
from fake_studies import claim

from compare.claims.claim import Verdict
from compare.claims.error_estimates import ROUNDING
from compare.claims.measured import answers_of, asked
from compare.report.numbers import in_short


def of(*margins_and_errors, **more):
    found = answers_of(*margins_and_errors, **more)
    numbers = found.predicted, found.value, found.error
    return claim("It is so", "good", *numbers, resolution=found.resolution, answers=found.answers)


@pytest.mark.parametrize(
    ("margins", "errors", "verdict", "count"),
    [
        ([True, True, True], 0.0, Verdict.AGREES, "3 of 3"),
        ([True, False, True], 0.0, Verdict.DIFFERS, "2 of 3"),
        ([0.3, 0.2], 0.1, Verdict.AGREES, "2 of 2"),
        ([0.3, 0.05], 0.1, Verdict.INCONCLUSIVE, "1 of 2"),
        ([0.3, -0.05], 0.1, Verdict.INCONCLUSIVE, "1 of 2"),
        ([0.05, -0.3], 0.1, Verdict.DIFFERS, "0 of 2"),  # an open case does not excuse a failure
        ([0.3, 0.05], [0.1, 0.01], Verdict.AGREES, "2 of 2"),
        ([[0.3, 0.3], [0.05, 0.3]], [[0.1], [0.01]], Verdict.AGREES, "4 of 4"),
        ([0.0], 0.0, Verdict.INCONCLUSIVE, "0 of 1"),
        ([1.0, np.nan], 0.1, Verdict.DIFFERS, "1 of 2"),
        ([1.0, 1.0], [0.1, np.nan], Verdict.DIFFERS, "1 of 2"),
        ([1.0, 1.0], [0.1, np.inf], Verdict.INCONCLUSIVE, "1 of 2"),
    ],
)
def test_only_certain_answers_are_counted(margins, errors, verdict, count):
    claim = of(margins, errors)
    assert claim.verdict is verdict
    assert in_short(claim) == count


def test_the_allowed_number_of_answers_may_be_open():
    margins = np.append(np.ones(1998), [0.0, 0.0])
    assert of(margins, may_be_open=2).verdict is Verdict.AGREES
    assert of(margins, may_be_open=1).verdict is Verdict.INCONCLUSIVE
    assert of(np.append(margins, -1.0), may_be_open=2).verdict is Verdict.DIFFERS


@pytest.mark.parametrize(
    ("question", "margins", "errors"),
    [
        (lambda tolerance: [tolerance], [0.1], [8.0 * 0.0875]),
        (lambda tolerance: [-4.0, 1.0], [-4.0, 1.0], [4.0 * ROUNDING] * 2),  # equal runs have rounding errors
    ],
)
def test_margins_are_those_of_the_requested_tolerance(question, margins, errors):
    found, error = asked(question, 0.1)
    assert found == pytest.approx(margins)
    assert error == pytest.approx(errors)
