import itertools

import numpy as np
import pytest

from compare.claims.error_estimates import extrapolated_order, observed_exponent


def test_the_exponent_of_a_power_law_with_a_next_term():
    x = np.geomspace(1e-1, 1e-4, 16)
    exponent, numerical, model = observed_exponent(x, 3.0 * x**1.5 * np.exp(0.4 * x**0.25), next_term=0.25)
    assert exponent == pytest.approx(1.5, abs=1e-9)
    assert numerical < 1e-9
    assert 0.001 < model < 0.1


def test_scatter_widens_the_budget_of_an_exponent():
    random = np.random.default_rng(1)
    x = np.geomspace(1e-1, 1e-7, 25)
    inside = 0
    for _ in range(200):
        errors = x * np.exp(0.2 * random.standard_normal(25))
        exponent, numerical, _ = observed_exponent(x, errors, next_term=0.125)
        inside += abs(exponent - 1.0) <= numerical
    assert 0.9 <= inside / 200 <= 0.99


def test_order_is_extrapolated_to_small_steps():
    h = 0.5 ** np.arange(2, 8)
    order, numerical, model = extrapolated_order(h**4 * (1.0 + h), 0.0)
    assert order == pytest.approx(4.0, abs=1e-3)
    assert abs(order - 4.0) <= numerical + model < 0.05


@pytest.mark.parametrize("bad", [np.nan, np.inf, 0.0])
def test_an_order_of_invalid_errors_is_nan(bad):
    errors = np.array([1e-2, 1e-3, bad, 1e-5, 1e-6])
    assert np.isnan(observed_exponent(errors, errors, next_term=1.0)[0])
    assert np.isnan(extrapolated_order(errors, 0.0)[0])


@pytest.mark.parametrize("order", [1.0, 2.0, 4.0])
def test_the_error_of_an_extrapolated_order_covers_the_noise_of_the_errors(order):
    errors = 0.5 ** (order * np.arange(4))
    noise = 0.02 * errors[-1]
    for signs in itertools.product((-1.0, 1.0), repeat=4):
        found, numerical, _ = extrapolated_order(errors + noise * np.array(signs), noise)
        assert abs(found - order) <= numerical
