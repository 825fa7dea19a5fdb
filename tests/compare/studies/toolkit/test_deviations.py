"""Remaining transients and decaying deviations of motions known in closed form."""

import numpy as np
import pytest

from compare.claims.claim import Verdict
from compare.claims.prose import Prose
from compare.claims.study import Study
from compare.studies.toolkit.deviations import Rates, settled

RATE, FREQUENCY, END = 0.2, 3.0, 1.5


def decaying(times, tolerance):
    t = np.asarray(times[1:])
    envelope = np.exp(-RATE * t)
    return np.column_stack((END + envelope * np.cos(FREQUENCY * t), END + tolerance * np.arange(len(t))))


def test_the_remaining_transient_is_bounded_from_both_sides():
    period = 2.0 * np.pi / FREQUENCY
    found = settled(decaying, duration=60.0, delay=10.0, period=period, rate=RATE, tolerance=1e-9)
    # The bound assumes the largest deviation at the sampled time and an end on the other side.
    most = (np.exp(RATE * (10.0 + period)) + 1.0) / np.expm1(RATE * 10.0) * np.exp(-RATE * 60.0)
    assert abs(found.value[0] - END) < found.left[0] < most
    # The last sample of the second quantity deviates most, by 13 tolerances.
    assert found.error[1] > 13e-9
    assert found.value.shape == found.error.shape == found.left.shape == (2,)


@pytest.mark.parametrize(
    ("slowest", "but", "verdict"),
    [
        (-0.1, 0, Verdict.AGREES),
        (0.1, 0, Verdict.DIFFERS),
        (0.1, 1, Verdict.AGREES),
        (1e-4, 0, Verdict.INCONCLUSIVE),
    ],
)
def test_a_growing_deviation_differs_unless_it_is_excluded(slowest, but, verdict):
    values = np.array([[-1.0, slowest, -0.5 + 2j, -0.5 - 2j]], dtype=complex)
    rates = Rates(values, values, np.array([1e-3]))
    study = Study("rates", Prose("title"), source="ours")
    study.claim("All decay")(lambda: rates.decaying(but))
    (claim,) = study.measure_theory().claims
    assert claim.verdict is verdict
