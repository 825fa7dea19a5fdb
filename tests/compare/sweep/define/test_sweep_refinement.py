"""Refinement of regions with known boundaries."""

import numpy as np
import pytest

from compare.sweep.refinement import first_stride, mixed, refined


def disc(x, y):
    return (x - 0.4) ** 2 + (y - 0.5) ** 2 < 0.1


def three_regions(x, y):
    return (np.sin(9.0 * x) * np.sin(7.0 * y) > 0.2) + 2 * (x + y > 1.3)


def rings(x, y):
    return np.hypot(x - 0.5, y - 0.5) % 0.25 < 0.12


def comb(x, y):
    """A region with teeth thinner than the coarse grid."""
    return (y < 0.3) | ((y < 0.8) & (x % 0.08 < 0.012))


def refine(shape, coarse, region):
    """Return the grid, the region, and the numbers of all rounds."""
    y, x = np.mgrid[0.0 : 1.0 : shape[0] * 1j, 0.0 : 1.0 : shape[1] * 1j]
    truth = region(x, y).astype(np.uint8)
    rounds = refined(shape, coarse)
    numbers = [next(rounds)]
    try:
        while True:
            numbers.append(rounds.send(truth.flat[numbers[-1]]))
    except StopIteration as last:
        return last.value, truth, np.concatenate(numbers)


@pytest.mark.parametrize("shape", [(257, 129), (64, 301), (2, 2)])
@pytest.mark.parametrize("region", [disc, three_regions, rings, comb])
def test_refinement_finds_the_region_as_a_full_grid_does(shape, region):
    grid, truth, numbers = refine(shape, 20, region)
    np.testing.assert_array_equal(grid.ends, truth)
    assert len(np.unique(numbers)) == len(numbers)  # no point twice
    np.testing.assert_array_equal(np.flatnonzero(grid.simulated), np.sort(numbers))
    for y, x in np.argwhere(mixed(grid.ends)):
        assert np.all(grid.simulated[y : y + 2, x : x + 2])


@pytest.mark.parametrize("region", [disc, three_regions, rings, comb])
def test_all_points_of_a_mixed_cell_are_simulated(region):
    grid, truth, _ = refine((41, 61), 21, region)
    for y, x in 2 * np.argwhere(mixed(truth[::2, ::2])):
        assert np.all(grid.simulated[y : y + 3, x : x + 3])


def test_the_number_of_simulated_points_grows_like_the_length_of_the_boundary():
    counts = [len(refine((n, n), 33, disc)[2]) - 33**2 for n in (257, 513, 1025)]
    np.testing.assert_allclose(np.log2(np.divide(counts[1:], counts[:-1])), 1.0, atol=0.1)


@pytest.mark.parametrize(
    ("points", "coarse", "stride"), [(257, 65, 4), (1000, 65, 8), (65, 65, 1), (64, 65, 1), (3, 2, 2)]
)
def test_the_coarse_grid_has_at_least_the_requested_points(points, coarse, stride):
    assert first_stride((points, 2 * points), coarse) == stride
