"""Error estimates of numbers that an engine does not give at every tolerance."""

import numpy as np
import pytest

from compare.claims.error_estimates import SAFETY, Measurement, change_as_error, known, open_where_coarse


def test_a_number_missing_at_one_tolerance_has_an_infinite_error_and_none_if_missing_at_both():
    found, other = np.array([1.0, np.nan, np.inf, np.nan, 2.0]), np.array([1.1, 3.0, 3.0, np.nan, 2.0])
    error = change_as_error(found, other)
    assert error == pytest.approx([SAFETY * 0.1, np.inf, np.inf, np.nan, 0.1], nan_ok=True)
    assert known(np.array([1.0, np.nan]), np.full(2, np.nan)) == pytest.approx([np.inf, np.nan], nan_ok=True)


def test_a_missing_number_has_an_infinite_error_if_the_states_are_coarse():
    found = Measurement(np.array([1.0, np.nan]), np.array([0.1, np.nan]))
    fine, coarse = (Measurement(np.ones(2), np.full(2, error)) for error in (1e-6, 1e-3))
    assert np.isinf(open_where_coarse(found, coarse).error[1])
    assert np.isnan(open_where_coarse(found, fine).error[1])
    assert open_where_coarse(found, coarse).error[0] == 0.1
