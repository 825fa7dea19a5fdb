import numpy as np
from scipy.stats import sobol_indices

from compare.sweep.compute.sensitivity import GROUPS, indices, moments
from compare.sweep.distributions import uniform_rows


def ishigami(x):
    return np.sin(x[:, 0]) + 7.0 * np.sin(x[:, 1]) ** 2 + 0.1 * x[:, 2] ** 4 * np.sin(x[:, 0])


def table_of(function, rows, quantities):
    uniform = np.pi * (2.0 * uniform_rows(2, 0, rows, 2 * quantities) - 1.0)
    first, second = uniform[:, :quantities], uniform[:, quantities:]
    columns = [function(first), function(second)]
    for i in range(quantities):
        mixture = first.copy()
        mixture[:, i] = second[:, i]
        columns.append(function(mixture))
    return np.stack(columns, axis=-1)


def indices_of(table, blocks=GROUPS):
    """Return the indices of a table, shape (rows, 2 + quantities)."""
    return indices([moments(part[np.newaxis]) for part in np.split(table, blocks)])


def test_indices_of_a_function_with_known_ones_lie_in_their_intervals():
    found = indices_of(table_of(ishigami, 2**14, 3))
    # the variances of Ishigami's function with a = 7, b = 0.1
    first = (1.0 + 0.1 * np.pi**4 / 5.0) ** 2 / 2.0
    second = 49.0 / 8.0
    both = 0.01 * np.pi**8 * (1.0 / 18.0 - 1.0 / 50.0)
    variance = first + second + both
    # twice the 95 % interval
    assert np.all(
        np.abs(found.first[0] - np.array([first, second, 0.0]) / variance) < 2.0 * found.first_error[0]
    )
    total = np.array([first + both, second, both]) / variance
    assert np.all(np.abs(found.total[0] - total) < 2.0 * found.total_error[0])
    assert np.max(found.first_error) < 0.05


def test_a_constant_result_has_no_indices():
    found = indices_of(np.ones((256, 4)))
    assert np.all(np.isnan(found.first))
    assert np.all(np.isnan(found.total))


def test_indices_computed_by_blocks_equal_those_of_scipy():
    table = 1e4 + table_of(
        ishigami, 2**10, 3
    )  # a large mean would cancel all digits of a plain sum of squares
    scipy = sobol_indices(
        func={"f_A": table[:, 0:1].T, "f_B": table[:, 1:2].T, "f_AB": table[:, 2:].T[:, np.newaxis]}, n=2**10
    )
    for blocks in (GROUPS, 8 * GROUPS):
        found = indices_of(table, blocks)
        np.testing.assert_allclose(found.first[0], scipy.first_order, atol=1e-9)
        np.testing.assert_allclose(found.total[0], scipy.total_order, atol=1e-9)
