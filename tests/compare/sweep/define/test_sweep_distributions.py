import numpy as np
import pytest
from scipy import stats

from compare.claims.parameters import FIG5
from compare.sweep.distributions import Uncertain, uniform_rows

DRAWS = 20_000
NEVER = 1e-6
"""Probability of rejecting a correct sample."""


@pytest.mark.parametrize(
    ("text", "mean", "deviation"),
    [
        ("offset=normal(0.1, 0.005)", 0.1, 0.005),
        ("friction_force=uniform(0.05, 0.11)", 0.08, 0.06 / np.sqrt(12.0)),
        ("disc_speed=triangular(1, 1, 4)", 2.0, np.sqrt(9.0 / 18.0)),
        ("damping=lognormal(0.1, 0.5)", 0.1 * np.exp(0.125), 0.1 * np.exp(0.125) * np.sqrt(np.expm1(0.25))),
        # a normal distribution cut off one deviation to either side: variance 1 − 2φ(1)/(2Φ(1) − 1)
        ("mass=truncnorm(2, 1, 1, 3)", 2.0, np.sqrt(1.0 - 2.0 * 0.24197072451914337 / 0.6826894921370859)),
    ],
)
def test_draws_have_the_mean_and_deviation_of_their_distribution(text, mean, deviation):
    uncertain = Uncertain.parse(text, FIG5)
    values = uncertain.values(uniform_rows(3, 0, DRAWS, 1)[:, 0])
    limit = -stats.norm.ppf(NEVER / 2.0)
    assert abs(np.mean(values) - mean) < limit * deviation / np.sqrt(DRAWS)
    fourth = np.mean((values - mean) ** 4) / deviation**4
    assert abs(np.std(values) / deviation - 1.0) < limit * 0.5 * np.sqrt((fourth - 1.0) / DRAWS)


def test_the_table_of_random_numbers_is_uniform_without_correlation():
    table = uniform_rows(5, 0, DRAWS, 6)
    for column in table.T:
        assert stats.kstest(column, "uniform").pvalue > NEVER
    correlation = np.corrcoef(table.T)[np.triu_indices(6, 1)]
    assert np.max(np.abs(correlation)) < -stats.norm.ppf(NEVER / 2.0) / np.sqrt(DRAWS)
    assert not np.any(uniform_rows(6, 0, DRAWS, 6) == table)


@pytest.mark.parametrize("width", [1, 4, 5])
def test_any_part_of_the_table_can_be_computed_separately(width):
    whole = uniform_rows(7, 0, 100, width)
    np.testing.assert_array_equal(uniform_rows(7, 37, 11, width), whole[37:48])


def test_zero_among_the_random_numbers_gives_a_finite_value():
    assert np.isfinite(Uncertain.parse("offset=normal(0, 1)", FIG5).values(np.zeros(1)))
