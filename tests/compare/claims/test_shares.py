from functools import cache

import numpy as np
import pytest
from scipy import stats

from compare.claims.shares import CONFIDENCE, of_grid, of_sample
from reference_model.ensemble import EndState

WHIRL, UNDECIDED, STUCK = EndState.WHIRL, EndState.UNDECIDED, EndState.STUCK


@cache
def share_of(count, n):
    ends = np.full(n, STUCK, dtype=np.uint8)
    ends[:count] = WHIRL
    return of_sample(ends)[WHIRL]


@pytest.mark.parametrize("count", [0, 1, 70, 199, 200])
def test_the_interval_of_a_sample_is_the_wilson_interval(count):
    n = 200
    share = share_of(count, n)
    interval = stats.binomtest(count, n).proportion_ci(CONFIDENCE, method="wilson")
    assert share.value == count / n
    np.testing.assert_allclose((share.low, share.high), (interval.low, interval.high), rtol=1e-13)


def test_undecided_trajectories_widen_every_interval():
    ends = np.array([WHIRL] * 50 + [UNDECIDED] * 50, dtype=np.uint8)
    shares = of_sample(ends)
    assert shares[WHIRL].low < 0.5
    assert shares[WHIRL].high > 0.99
    assert shares[STUCK].low == 0.0
    assert shares[STUCK].high == shares[UNDECIDED].high


def test_bounds_of_a_grid_contain_the_area_and_converge_with_order_one():
    widths = []
    for n in (41, 81, 161):
        y, x = np.mgrid[0.0 : 1.0 : n * 1j, 0.0 : 1.0 : n * 1j]
        inside = (x - 0.47) ** 2 + (y - 0.52) ** 2 < 0.09
        share = of_grid(np.where(inside, WHIRL, STUCK).astype(np.uint8))[WHIRL]
        assert share.low < 0.09 * np.pi < share.high
        assert share.low < share.value < share.high
        widths.append(share.high - share.low)
    np.testing.assert_allclose(np.log2(np.divide(widths[:-1], widths[1:])), 1.0, atol=0.1)


def test_a_cell_with_different_corners_may_contain_any_share_of_each():
    assert of_grid(np.array([[WHIRL, WHIRL], [WHIRL, STUCK]], dtype=np.uint8))[STUCK] == (0.25, 0.0, 1.0)


def test_an_undecided_corner_leaves_the_area_of_its_cell_open():
    ends = np.full((3, 3), WHIRL, dtype=np.uint8)
    ends[1, 1] = UNDECIDED
    shares = of_grid(ends)
    assert shares[WHIRL] == (0.75, 0.0, 1.0)
    assert shares[STUCK] == (0.0, 0.0, 1.0)
    assert shares[UNDECIDED].value == 0.25
