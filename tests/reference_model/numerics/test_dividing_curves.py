"""Curves where a function of two variables changes sign: circles, branches, corners and islands."""

import math

import numpy as np
import pytest

from reference_model.numerics.continuation import ContinuationError
from reference_model.numerics.dividing_curves import dividing_curves

LOW, HIGH = np.array([-1.0, -2.0]), np.array([1.0, 2.0])


@pytest.mark.parametrize("cells", [4, 32])
def test_closed_curve_is_found_once_with_points_on_it_no_farther_apart_than_a_cell(cells):
    # Scaled to the unit square, the curve is a circle of radius 0.35.
    def value(point):
        return math.hypot(point[0] - 0.1, 0.5 * (point[1] + 0.2)) - 0.7

    (curve,) = dividing_curves(value, LOW, HIGH, cells)
    assert curve.closed
    assert curve.points[0] == pytest.approx(curve.points[-1], abs=1e-15)
    assert [value(point) for point in curve.points] == pytest.approx(np.zeros(len(curve.points)), abs=1e-12)
    steps = np.linalg.norm(np.diff(curve.points / (HIGH - LOW), axis=0), axis=1)
    assert steps.max() <= 1.0 / cells + 1e-12
    # The whole circle is found, because a chord that turns by more than 0.35·1.5 rad is halved.
    angles = np.unwrap(np.arctan2(0.5 * (curve.points[:, 1] + 0.2), curve.points[:, 0] - 0.1))
    assert abs(angles[-1] - angles[0]) == pytest.approx(2.0 * math.pi)
    assert np.abs(np.diff(angles)).max() < 0.35 * 1.5


def test_away_from_the_curve_only_the_sign_of_the_function_matters():
    def value(point):
        return float(np.clip(1e3 * (point[1] - point[0] ** 3), -1e-3, 1e-3))

    (curve,) = dividing_curves(value, LOW, HIGH, 6)
    assert sorted(curve.ends) == [0, 2]
    assert curve.points[:, 1] == pytest.approx(curve.points[:, 0] ** 3, abs=1e-12)
    assert sorted(curve.points[[0, -1], 0]) == pytest.approx([-1.0, 1.0], abs=1e-12)


def test_all_branches_and_islands_are_found():
    def hyperbola(point):
        return point[0] ** 2 - 0.25 * point[1] ** 2 - 0.2  # leaves the rectangle at |x| = 1

    branches = dividing_curves(hyperbola, LOW, HIGH, 8)
    assert [sorted(curve.ends) for curve in branches] == [[0, 0], [2, 2]]
    assert sorted(np.sign(curve.points[0, 0]) for curve in branches) == [-1.0, 1.0]

    def cassini(point):  # two ovals about (±0.5, 0)
        x, y = point
        return (x * x + y * y) ** 2 - 0.5 * (x * x - y * y) + 0.0625 - 0.05

    ovals = dividing_curves(cassini, LOW, HIGH, 16)
    assert [curve.closed for curve in ovals] == [True, True]
    # On the x axis x² = 0.25 ± √0.05 on each side.
    reach = np.sort([np.abs([curve.points[:, 0].min(), curve.points[:, 0].max()]) for curve in ovals])
    inner, outer = math.sqrt(0.25 - math.sqrt(0.05)), math.sqrt(0.25 + math.sqrt(0.05))
    assert reach == pytest.approx(np.array([[inner, outer]] * 2), abs=0.02)


def test_curve_is_followed_around_corners_and_not_computed_again_where_it_crosses_the_grid():
    calls = 0

    def value(point):  # a rhombus with right angles in the unit square
        nonlocal calls
        calls += 1
        return abs(point[0]) + 0.5 * abs(point[1]) - 0.61

    cells = 10
    (curve,) = dividing_curves(value, LOW, HIGH, cells)
    # A point takes two signs and some eight steps of Brent's method, and sometimes fails at a bend.
    assert calls <= (cells + 1) ** 2 + 12 * len(curve.points)
    assert curve.closed
    assert [value(point) for point in curve.points] == pytest.approx(np.zeros(len(curve.points)), abs=1e-12)
    for corner in ([0.61, 0.0], [0.0, 1.22], [-0.61, 0.0], [0.0, -1.22]):
        assert np.min(np.linalg.norm(curve.points - corner, axis=1)) < 0.1


def test_curve_that_cuts_off_a_corner_of_the_rectangle_within_a_cell_is_found():
    (curve,) = dividing_curves(lambda p: p[0] + p[1] - 2.9, LOW, HIGH, 4)
    assert sorted(curve.ends) == [2, 3]
    assert curve.points.sum(axis=1) == pytest.approx(np.full(len(curve.points), 2.9), abs=1e-12)
    assert {round(x, 9) for x in curve.points[[0, -1], 0]} == {0.9, 1.0}


def test_two_lines_that_meet_are_followed_straight_on():
    lines = dividing_curves(lambda p: (p[0] - 0.01) * (p[1] + 0.03), LOW, HIGH, 8)
    assert sorted(sorted(curve.ends) for curve in lines) == [[0, 2], [1, 3]]


def test_curve_that_winds_without_end_raises_an_error():
    def spiral(point):
        x, y = point - 0.03
        return math.sin(0.5 / math.hypot(x, y) + math.atan2(y, x))

    with pytest.raises(ContinuationError, match="the curve"):
        dividing_curves(spiral, LOW, HIGH, 8)
