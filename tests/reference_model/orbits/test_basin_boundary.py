"""The boundary of the basins of Fig. 5, which is the stable set of a stick-slip orbit."""

from dataclasses import replace

import numpy as np
import pytest
from matplotlib.path import Path

from compare.claims.parameters import FIG5, FIG5_STARTS
from reference_model import PinOnDisc, basin_boundary, boundary_point, simulate, stick_slip_orbits
from reference_model.orbits.basin_boundary import Separatrix

RANGES = ((-0.3, 0.5), (-0.4, 0.4))


@pytest.fixture(scope="module")
def saddle():
    (orbit,) = stick_slip_orbits(FIG5, tolerance=1e-11, samples=2)
    return orbit


@pytest.fixture(scope="module")
def boundary(saddle):
    return basin_boundary(with_tolerance(saddle, 1e-6), ranges=RANGES, cells=5)


@pytest.fixture(scope="module")
def point(saddle):
    return boundary_point(saddle, *FIG5_STARTS.values())


def with_tolerance(orbit, tolerance):
    return replace(orbit, problem=replace(orbit.problem, tolerance=tolerance))


def whirls(start, duration, tolerance):
    end = simulate(FIG5, start, [0.0, duration], tolerance=tolerance, compiled=True).at_end
    return np.hypot(*end[:2]) > 0.4


@pytest.mark.parametrize(
    ("first", "second"),
    [
        ((0.1, 0.0, -0.1, 0.0), (0.1, 0.0, -0.35, 0.0)),  # first stick after one turn, not two
        ((0.0, 0.0, 0.0, 0.0), (0.2, 0.3, -0.3, 0.4)),
    ],
)
def test_starts_on_both_sides_of_a_point_of_the_boundary_end_in_different_motions(saddle, first, second):
    point = boundary_point(saddle, first, second)
    along = np.subtract(second, first)
    # The point lies between the two, on their line.
    share = float(along @ (point - first) / (along @ along))
    assert 0.0 < share < 1.0
    assert point == pytest.approx(first + share * along, abs=1e-14)
    # A deviation of 1e-10 grows to order one in 45 periods of 6.2 s.
    step = 1e-10 * along / np.linalg.norm(along)
    assert not whirls(point - step, 400.0, 1e-12)
    assert whirls(point + step, 400.0, 1e-12)


def test_closed_curve_encloses_the_basin_of_the_equilibrium_of_fig_5(boundary):
    (curve,) = boundary
    assert curve.closed
    steps = np.linalg.norm(np.diff(curve.points, axis=0), axis=1)
    assert steps.max() <= 1.05 * 0.8 / 5  # a correction is normal to the tangent
    # Tangents of neighbouring points differ by acos 0.97 at most, so the curve is within 1/16 of a step of the chord.
    polygon, margin = Path(curve.points), steps.max() / 16.0
    starts = np.random.default_rng(5).uniform([-0.1, -0.3], [0.35, 0.15], (16, 2))
    tested = 0
    for x, vx in starts:
        around = [(x + margin * np.cos(a), vx + margin * np.sin(a)) for a in np.arange(0.0, 6.2, 0.3)]
        inside = polygon.contains_points(around)
        if inside.all() or not inside.any():
            assert whirls([x, 0.0, vx, 0.0], 150.0, 1e-6) != inside.all(), (x, vx)
            tested += 1
    assert tested > 10


def test_curve_through_a_rectangle_that_cuts_the_basin_ends_at_its_limits(saddle):
    low, high = 0.0, 0.05
    (curve,) = basin_boundary(with_tolerance(saddle, 1e-6), ranges=((low, high), (0.0, 0.15)), cells=2)
    assert sorted(curve.ends) == [0, 2]
    assert sorted(curve.points[[0, -1], 0]) == pytest.approx([low, high], abs=1e-9)
    for x, vx in curve.points[[0, -1]]:
        point = boundary_point(with_tolerance(saddle, 1e-8), (x, 0.0, 0.0, 0.0), (x, 0.0, 0.2, 0.0))
        assert vx == pytest.approx(point[2], abs=1e-6)


def test_cut_by_other_components_lies_on_the_boundary(saddle, point):
    (curve,) = basin_boundary(
        with_tolerance(saddle, 1e-6),
        components=("vy", "y"),
        ranges=((-0.02, 0.02), (-0.02, 0.02)),
        others=point,
        cells=2,
    )
    # The curve goes through this point, and all of its points lie on the boundary.
    assert np.min(np.linalg.norm(curve.points, axis=1)) < 0.02
    separatrix = Separatrix.of(saddle)
    assert separatrix.miss(point) == pytest.approx(0.0, abs=1e-9)
    for vy, y in curve.points:
        assert separatrix.miss([point[0], y, point[2], vy]) == pytest.approx(0.0, abs=1e-5)


def test_boundary_between_a_stick_slip_cycle_and_the_whirl_is_found():
    pin = PinOnDisc(
        mass=1.0, stiffness=1.0, damping=0.2328, friction_force=0.585, disc_speed=1.443, offset=0.564
    )
    cycle, saddle = stick_slip_orbits(pin, tolerance=1e-8, samples=2)
    assert cycle.release_angle < saddle.release_angle
    assert 0.0 < cycle.multiplier < 1.0 < saddle.multiplier
    assert max(cycle.residual, saddle.residual) < 1e-7
    second = np.array([1.5, 0.0, 0.0, 1.5])
    point = boundary_point(saddle, cycle.state, second)
    step = 1e-6 * (second - point) / np.linalg.norm(second - point)
    # A deviation of 1e-6 grows by 1.137¹¹⁰ = 1e6 in 110 periods.
    before, behind = (
        simulate(pin, start, [0.0, 150.0 * saddle.period], compiled=True).stick_phases[-1].end / saddle.period
        for start in (point - step, point + step)
    )
    assert behind < 140.0 < 148.0 < before


def test_stable_orbit_is_refused():
    damped = PinOnDisc(
        mass=1.0, stiffness=1.0, damping=0.85, friction_force=0.47, disc_speed=2.4, offset=0.46
    )
    (cycle,) = stick_slip_orbits(damped, tolerance=1e-8, samples=2)
    with pytest.raises(ValueError, match=r"multiplier 0\.1086: a basin boundary needs one > 1"):
        boundary_point(cycle, (0.1, 0.0, 0.0, 0.0), (0.2, 0.0, 0.0, 0.0))
