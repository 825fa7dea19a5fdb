"""Continuation of curves with bends, up to their limits."""

import math

import numpy as np
import pytest

from reference_model.numerics.continuation import ContinuationError, follow

SCALES = np.array([3.0, 1e-3])
ROUNDING = 1e-13


def circle(unknowns):
    return np.array([unknowns @ unknowns - 1.0])


def everywhere(unknowns):
    return np.array([2.0 - abs(unknowns[0])])


def followed(equations, limits, start, step=0.03, scales=SCALES):
    """Follow a curve of scaled unknowns, and check that its points are on it, in order and well spaced."""

    def scaled(function):
        return lambda unknowns: function(unknowns / scales)

    curve = follow(scaled(equations), scaled(limits), np.asarray(start) * scales, scales, step=step)
    points = curve.points / scales
    assert max(np.abs(equations(point)).max() for point in points) < ROUNDING
    chords = np.diff(points, axis=0)
    lengths = np.linalg.norm(chords, axis=1)
    assert lengths.min() > 0.0
    assert lengths.max() <= 1.01 * step  # a chord is only slightly longer than the step along the tangent
    straight = np.sum(chords[1:] * chords[:-1], axis=1) / (lengths[1:] * lengths[:-1])
    assert straight.min() > 0.9
    return points, curve.ends


@pytest.mark.parametrize("step", [0.2])
def test_closed_curve_is_followed_once(step):
    points, ends = followed(circle, everywhere, [0.9, 0.1], step)
    assert ends == ()
    assert np.array_equal(points[0], points[-1])
    angles = np.unwrap(np.arctan2(*points.T))
    assert abs(angles[-1] - angles[0]) == pytest.approx(2.0 * np.pi, abs=1e-12)
    assert len(points) < 1.1 * 2.0 * np.pi / step + 5.0  # after a short first step the steps grow


def test_steps_shrink_where_a_curve_turns_sharply_and_grow_again():
    """The distance between the sides of the flat ellipse is smaller than the step."""
    points, _ = followed(
        lambda p: np.array([p[0] ** 2 + (p[1] / 0.02) ** 2 - 1.0]), everywhere, [0.0, 0.02], 0.3
    )
    angles = np.unwrap(np.arctan2(points[:, 1] / 0.02, points[:, 0]))
    assert abs(angles[-1] - angles[0]) == pytest.approx(2.0 * np.pi, abs=1e-9)
    assert len(points) < 200  # at the steps that the sharp ends need it would be thousands


def test_spiral_that_passes_its_start_does_not_close():
    def spiral(p):  # ten radians either way; the radius grows by 0.1 per radian
        x, y, angle = p[0], p[1], 10.0 * p[2]
        return np.array([np.hypot(x, y) - 2.0 - 0.1 * angle, x * np.sin(angle) - y * np.cos(angle)])

    points, ends = followed(
        spiral, lambda p: np.array([p[2] + 1.0, 1.0 - p[2]]), [2.0, 0.0, 0.0], scales=np.ones(3)
    )
    assert sorted(ends) == [0, 1]
    assert points[[0, -1], 2] == pytest.approx([2.0 * end - 1.0 for end in ends], abs=ROUNDING)


@pytest.mark.parametrize("step", [0.2, 0.05])
def test_curve_with_two_turns_ends_on_the_limit_for_any_step(step):
    points, ends = followed(
        lambda p: np.array([p[1] ** 3 - p[1] - p[0]]), lambda p: np.array([1.0 - p[0] ** 2]), [0.3, 1.1], step
    )
    root = np.max(np.roots([1.0, 0.0, -1.0, -1.0]).real)
    assert ends == (0, 0)
    assert sorted(points[[0, -1], 1]) == pytest.approx([-root, root], abs=ROUNDING)


def test_first_and_last_point_lie_on_their_limits_the_nearest_ones_within_a_step():
    def limits(p):
        return np.array([0.52 - p[0], 0.5 - p[0], 0.51 - p[0], 0.8 + p[1]])

    for start in ([-0.9, 0.1], [-0.9, -0.1]):
        points, ends = followed(circle, limits, start, 0.5)
        there = {1: (0.5, np.sqrt(0.75)), 3: (-0.6, -0.8)}
        assert points[[0, -1]] == pytest.approx(np.array([there[end] for end in ends]), abs=ROUNDING)


def test_curve_that_stops_inside_the_limits_raises_an_error():
    def parabola(p):  # raises ValueError for p[0] < 0
        return np.array([p[1] - math.sqrt(p[0])])

    with pytest.raises(ContinuationError, match="can't be followed beyond"):
        follow(parabola, lambda p: np.array([2.0 - p[0], p[1] + 1.0]), [1.0, 1.0], [1.0, 1.0])
