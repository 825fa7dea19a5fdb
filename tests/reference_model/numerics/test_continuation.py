"""Continuation of curves with bends, up to their limits."""

import numpy as np
import pytest

from reference_model.numerics.continuation import ContinuationError, follow


def circle(unknowns):
    return np.array([unknowns @ unknowns - 1.0])


def everywhere(unknowns):
    return np.array([2.0 - abs(unknowns[0])])


def test_closed_curve_is_followed_once():
    curve = follow(circle, everywhere, [0.9, 0.1], [1.0, 1.0], step=0.1)
    assert curve.closed
    assert np.array_equal(curve.points[0], curve.points[-1])
    assert np.hypot(*curve.points.T) == pytest.approx(1.0, abs=1e-15)
    angles = np.unwrap(np.arctan2(*curve.points.T))
    assert abs(angles[-1] - angles[0]) == pytest.approx(2.0 * np.pi, abs=1e-12)


def test_curve_ends_on_the_first_limits_in_either_direction():
    curve = follow(circle, lambda p: np.array([0.5 - p[0], 0.8 + p[1]]), [-0.9, 0.1], [1.0, 1.0])
    assert not curve.closed
    assert set(curve.ends) == {0, 1}
    ends = dict(zip(curve.ends, curve.points[[0, -1]], strict=True))
    assert ends[0] == pytest.approx([0.5, np.sqrt(0.75)], abs=1e-14)
    assert ends[1] == pytest.approx([-0.6, -0.8], abs=1e-14)
    assert np.all(curve.points[1:-1, 0] < 0.5)
    assert np.all(curve.points[1:-1, 1] > -0.8)


@pytest.mark.parametrize("step", [0.2, 0.05, 0.01])
def test_the_ends_do_not_depend_on_the_step(step):
    def cubic(p):
        return np.array([p[1] ** 3 - p[1] - p[0]])

    curve = follow(cubic, lambda p: np.array([1.0 - p[0] ** 2]), [0.3, 1.1], [1.0, 1.0], step=step)
    root = np.max(np.roots([1.0, 0.0, -1.0, -1.0]).real)
    assert sorted(curve.points[[0, -1], 1]) == pytest.approx([-root, root], abs=1e-13)
    assert (
        np.min(np.diff(curve.points[:, 0]) * np.sign(curve.points[-1, 0])) < 0.0
    )  # the curve turned back twice


def test_steps_are_short_enough_to_stay_on_a_sharply_turning_curve():
    """The distance between the sides of a flat ellipse is smaller than the step."""

    def ellipse(p):
        return np.array([p[0] ** 2 + (p[1] / 0.02) ** 2 - 1.0])

    curve = follow(ellipse, everywhere, [0.0, 0.02], [1.0, 1.0], step=0.3)
    assert curve.closed
    angles = np.unwrap(np.arctan2(curve.points[:, 1] / 0.02, curve.points[:, 0]))
    steps = np.diff(angles)
    assert np.all(steps > 0.0) or np.all(steps < 0.0)
    assert abs(angles[-1] - angles[0]) == pytest.approx(2.0 * np.pi, abs=1e-9)


def test_nearest_of_several_limits_within_a_step_ends_the_curve():
    def limits(p):
        return np.array([0.52 - p[0], 0.5 - p[0], 0.51 - p[0], p[1]])

    curve = follow(circle, limits, [-0.9, 0.4], [1.0, 1.0], step=0.5)
    assert set(curve.ends) == {1, 3}


def test_two_equations_for_three_unknowns():
    def great_circle(p):
        return np.array([p @ p - 1.0, p[0] - p[1]])

    curve = follow(great_circle, lambda p: np.array([p[2]]), [0.5, 0.5, 0.7], [1.0, 1.0, 1.0])
    assert np.abs(curve.points[[0, -1]]) == pytest.approx(
        np.array([[np.sqrt(0.5), np.sqrt(0.5), 0.0]] * 2), abs=1e-13
    )


def test_start_without_a_curve_raises_an_error_with_the_point():
    with pytest.raises(ContinuationError, match=r"no point of the curve near \[3\. 0\.\]"):
        follow(lambda p: np.array([p @ p + 1.0]), everywhere, [3.0, 0.0], [1.0, 1.0])


def test_curve_that_stops_inside_the_limits_raises_an_error():
    def parabola(p):  # √ is undefined for p[0] < 0
        return np.array([p[1] - np.sqrt(p[0]) if p[0] >= 0.0 else np.nan])

    with pytest.raises(ContinuationError, match="can't be followed beyond"):
        follow(parabola, lambda p: np.array([2.0 - p[0], p[1] + 1.0]), [1.0, 1.0], [1.0, 1.0])
