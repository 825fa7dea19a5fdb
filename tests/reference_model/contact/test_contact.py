"""Laws of contact against the integrals (20) as they are printed, and against what every friction obeys."""

import cmath
import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.integrate import quad
from scipy.optimize import minimize_scalar

from compare.claims.paper_parameters import FIG11
from reference_model.contact.contact_law import (
    Pin,
    PointsOnRing,
    Ring,
    ThreeTermRing,
    contact_of,
    isotropic_contact_of,
)
from reference_model.systems import PinOnDisc

R = 0.12
RING, EXPANSION, SIX = Ring(R), ThreeTermRing(R), PointsOnRing(R, 6)
LAWS = [Pin(), RING, EXPANSION, SIX, PointsOnRing(R, 7)]
ISOTROPIC = [Pin(), RING, EXPANSION]


named = pytest.mark.parametrize("law", LAWS, ids=repr)

# With U/W from 0.6 to 8, and either direction of spin.
MOTIONS = [(0.1 + 0.05j, 0.9), (-0.03 + 0.3j, -0.5), (0.2j, 0.2), (-0.05 - 0.09j, -1.4), (0.4 - 0.1j, 1.9)]
motions = pytest.mark.parametrize(("slip", "spin"), MOTIONS)


def along_circle(slip, spin, angle, around):
    """ν_rx, ν_ry and ν̃_r of (21) at the angles χ ``around`` the circle, with the signs of the paper."""
    s, c = np.sin(angle + around), np.cos(angle + around)
    x, y = slip.real + R * spin * s, slip.imag - R * spin * c
    return x, y, x * s - y * c


def power(law, slip, spin, angle=0.3):
    force, moment = law.force_and_moment(slip, spin, angle)
    return (force * slip.conjugate()).real - moment * spin


# ---------------------------------------------------------------- (20) to (23)


@motions
@pytest.mark.parametrize("angle", [0.0, 2.1])
def test_ring_is_the_integral_20(slip, spin, angle):
    def integrand(around, i):
        x, y, tangential = along_circle(slip, spin, angle, around)
        return (-x, -y, R * tangential)[i] / math.hypot(x, y) / (2.0 * math.pi)

    force, moment = RING.force_and_moment(slip, spin, angle)
    expected = [quad(integrand, 0.0, 2.0 * math.pi, args=(i,), epsabs=1e-13, limit=200)[0] for i in range(3)]
    assert (force.real, force.imag, moment) == pytest.approx(expected, abs=1e-12)


@motions
@pytest.mark.parametrize("points", [3, 6, 11])
def test_points_are_the_sum_in_place_of_the_integral_20(slip, spin, points):
    x, y, tangential = along_circle(slip, spin, 0.4, 2.0 * np.pi * np.arange(points) / points)
    speed = np.hypot(x, y)
    force, moment = PointsOnRing(R, points).force_and_moment(slip, spin, 0.4)
    expected = np.mean([-x / speed, -y / speed, R * tangential / speed], axis=1)
    assert (force.real, force.imag, moment) == pytest.approx(expected, abs=1e-14)


@motions
def test_23_is_the_average_of_the_three_term_form_of_22(slip, spin):
    around = 2.0 * np.pi * np.arange(16) / 16  # exact for trigonometric polynomials up to the 15th
    x, y, tangential = along_circle(slip, spin, 0.4, around)
    mean_square = abs(slip) ** 2 + (R * spin) ** 2
    across = slip.real * np.sin(0.4 + around) - slip.imag * np.cos(0.4 + around)
    step = R * spin * across / mean_square
    inverse_speed = (1.0 - step + 1.5 * step**2) / math.sqrt(mean_square)
    force, moment = EXPANSION.force_and_moment(slip, spin, 0.4)
    expected = np.mean([-x * inverse_speed, -y * inverse_speed, R * tangential * inverse_speed], axis=1)
    assert (force.real, force.imag, moment) == pytest.approx(expected, abs=1e-15)


@pytest.mark.parametrize(("share", "place"), [("resistance", 0.77), ("moment", 1.0 / 0.77)])
def test_23_is_off_by_a_tenth_at_most(share, place):
    size = {"resistance": 1.0, "moment": R}[share]

    def error(ratio):
        return (
            abs(
                getattr(EXPANSION.shares(ratio * R, 1.0), share) - getattr(RING.shares(ratio * R, 1.0), share)
            )
            / size
        )

    largest = max(np.geomspace(1e-3, 1e3, 2001), key=error)
    top = minimize_scalar(
        lambda ratio: -error(ratio), bounds=(0.97 * largest, 1.03 * largest), method="bounded"
    )
    assert top.x == pytest.approx(place, rel=0.01)
    assert -top.fun == pytest.approx(0.10, abs=0.005)


def test_23_is_exact_in_the_limits_of_pure_slip_and_pure_spin():
    for small in (1e-3, 1e-4):
        slipping, spinning = (
            (EXPANSION.shares(1.0, small / R), RING.shares(1.0, small / R)),
            (
                EXPANSION.shares(small * R, 1.0),
                RING.shares(small * R, 1.0),
            ),
        )
        for approximate, exact in (slipping, spinning):
            # The first term left out is of the third power of the ratio.
            assert np.array(approximate) == pytest.approx(np.array(exact), abs=2.0 * small**3 + 1e-15)


# ---------------------------------------------------------------- points and ring


@pytest.mark.parametrize("ratio", [0.3, 0.6, 1.0 / 0.6])
def test_points_tend_to_the_ring_like_a_geometric_series(ratio):
    smaller = min(ratio, 1.0 / ratio)
    errors = []
    for points in (6, 12, 24):
        law = PointsOnRing(R, points)
        found = [
            law.force_and_moment(ratio * R, 1.0, angle) for angle in np.linspace(0.0, 2.0 * np.pi / points, 9)
        ]
        exact = RING.force_and_moment(ratio * R, 1.0, 0.0)
        errors.append(max(abs(force - exact[0]) for force, _ in found))
    # Direction is analytic along the circle up to |Im χ| = |ln(U/W)|, with a square root there.
    for fewer, more, points in ((errors[0], errors[1], 6), (errors[1], errors[2], 12)):
        assert 0.5 * smaller**points < more / fewer < smaller**points


@pytest.mark.parametrize("points", [6, 7, 24])
def test_points_are_off_the_most_where_one_of_them_comes_to_rest(points):
    law = PointsOnRing(R, points)
    others = 1.0 / math.tan(math.pi / (2.0 * points)) / points  # mean of sin(χ/2) over the points at U = W
    greatest = 1.0 / points + 2.0 / math.pi - others

    def errors(ratio, angle):
        force, moment = law.force_and_moment(ratio * R, 1.0, angle)
        exact_force, exact_moment = RING.force_and_moment(ratio * R, 1.0, angle)
        return abs(force - exact_force), abs(moment - exact_moment) / R

    # Point 0 is at −π/2 and all but at rest. The ring's slope at 1e-9 from U = W is ln(1e9)/π.
    assert errors(1.0 - 1e-9, -0.5 * math.pi)[0] == pytest.approx(greatest, abs=1e-8)
    assert errors(1.0 + 1e-9, -0.5 * math.pi)[1] == pytest.approx(greatest, abs=1e-8)
    for ratio in (0.8, 0.95, 0.999, 1.0, 1.001, 1.05, 1.2):
        for angle in np.linspace(0.0, 2.0 * math.pi / points, 41):
            assert max(errors(ratio, angle)) < greatest


def test_points_come_round_after_a_part_of_a_turn():
    for law in (SIX, PointsOnRing(R, 7)):
        part = 2.0 * math.pi / law.points
        first, half, whole = (
            law.force_and_moment(0.1 + 0.05j, 0.9, 0.3 + turn) for turn in (0.0, part / 2, part)
        )
        assert whole == pytest.approx(first, abs=1e-14)
        assert abs(half[0] - first[0]) > 0.01


# ---------------------------------------------------------------- what every friction obeys


@named
@motions
def test_force_turns_with_the_slip(law, slip, spin):
    turn = cmath.exp(0.7j)
    force, moment = law.force_and_moment(slip, spin, 0.3)
    turned_force, turned_moment = law.force_and_moment(slip * turn, spin, 0.3 + 0.7)
    assert (turned_force, turned_moment) == pytest.approx((force * turn, moment), abs=1e-14)
    if law in ISOTROPIC:
        assert law.force_and_moment(slip, spin, 1.9) == (force, moment)


@named
@motions
def test_mirror_image_of_the_motion_has_the_mirror_image_of_friction(law, slip, spin):
    force, moment = law.force_and_moment(slip, spin, 0.3)
    mirrored = law.force_and_moment(slip.conjugate(), -spin, -0.3)
    assert mirrored == pytest.approx((force.conjugate(), -moment), abs=1e-15)


@named
@motions
@pytest.mark.parametrize("factor", [1e-150, 1e-6, 1e6, 1e150])
def test_only_the_ratio_of_slip_and_spin_counts(law, slip, spin, factor):
    at_any_speed = law.force_and_moment(slip * factor, spin * factor, 0.3)
    assert at_any_speed == pytest.approx(law.force_and_moment(slip, spin, 0.3), abs=1e-14)


@named
@given(
    slip=st.complex_numbers(min_magnitude=1e-3, max_magnitude=1.0),
    spin=st.floats(-10.0, 10.0),
    angle=st.floats(-4, 4),
)
def test_friction_takes_power_and_is_no_greater_than_its_limit(law, slip, spin, angle):
    force, moment = law.force_and_moment(slip, spin, angle)
    assert power(law, slip, spin, angle) < 0.0
    assert abs(force) <= 1.0 + 1e-15
    assert abs(moment) <= R * (1.0 + 1e-15)


@motions
def test_power_of_friction_is_the_mean_slip_speed(slip, spin):
    around = 2.0 * np.pi * np.arange(4000) / 4000
    x, y, _ = along_circle(slip, spin, 0.0, around)
    # The mean of a periodic function, analytic within |ln(U/W)| >= 0.17 of the real line.
    assert -power(RING, slip, spin) == pytest.approx(np.hypot(x, y).mean(), rel=1e-13)
    x, y, _ = along_circle(slip, spin, 0.3, 2.0 * np.pi * np.arange(6) / 6)
    assert -power(SIX, slip, spin) == pytest.approx(np.hypot(x, y).mean(), rel=1e-14)


# ---------------------------------------------------------------- derivatives


STEP = 1e-4


def by_differences(law, slip, spin, angle):
    """Derivatives of (F_x, F_y, M) by (u_x, u_y, S, φ), of fourth order."""
    columns = []
    for by in ((1.0, 0.0, 0.0), (1j, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)):
        values = []
        for n in (-2, -1, 1, 2):
            h = n * STEP
            force, moment = law.force_and_moment(slip + h * by[0], spin + h * by[1], angle + h * by[2])
            values.append(np.array((force.real, force.imag, moment)))
        columns.append((values[0] - 8.0 * values[1] + 8.0 * values[2] - values[3]) / (12.0 * STEP))
    return np.column_stack(columns)


def error_of_differences(jacobian, slip, spin, angle):
    """The distance d from a resting point is that from the next singularity: (h/d)⁴, and rounding of 1e-16/h."""
    points = [
        np.hypot(*along_circle(slip, spin, angle, 2.0 * np.pi * np.arange(n) / n)[:2]).min() for n in (6, 7)
    ]
    distance = min(abs(abs(slip) - abs(R * spin)), *points)
    return 4.0 * (STEP / distance) ** 4 * np.abs(jacobian).max() + 1e-11


@named
@pytest.mark.parametrize(("slip", "spin"), [*MOTIONS, (0.3 + 0.1j, 0.0), (-0.3j, -0.0)])
def test_jacobian_is_the_derivative(law, slip, spin):
    found = law.jacobian(slip, spin, 0.4)
    error = error_of_differences(found, slip, spin, 0.4)
    assert error < 1e-3 * np.abs(found).max() + 1e-9
    assert found == pytest.approx(by_differences(law, slip, spin, 0.4), abs=error)


@pytest.mark.parametrize("law", [RING, EXPANSION, SIX], ids=repr)
@pytest.mark.parametrize("spin", [3.0, -3.0])
def test_jacobian_of_a_disc_that_turns_in_place_is_the_derivative(law, spin):
    found = law.jacobian(0j, spin, 0.4)
    error = error_of_differences(found, 0j, spin, 0.4)
    assert found == pytest.approx(by_differences(law, 0j, spin, 0.4), abs=error)


@pytest.mark.parametrize("spin", [0.7, -0.7])
def test_ring_that_turns_in_place_damps_slip_like_a_damper(spin):
    assert RING.jacobian(0j, spin, 0.0)[:2, :2] == pytest.approx(-np.eye(2) / (2.0 * R * 0.7), rel=1e-15)


@named
@motions
def test_derivatives_are_those_of_a_convex_potential(law, slip, spin):
    # By u and the spin of the disc, which is that of the master disc less S.
    by_motion = law.jacobian(slip, spin, 0.4)[:, :3] * (1.0, 1.0, -1.0)
    assert by_motion == pytest.approx(by_motion.T, abs=1e-14 * np.abs(by_motion).max())
    assert np.linalg.eigvalsh(by_motion).max() < 1e-14 * np.abs(by_motion).max()


@pytest.mark.parametrize("ratio", [0.0, 0.3, 1.0, 2.5])
def test_potential_of_23_is_the_mean_slip_speed_to_second_order(ratio):
    around = 2.0 * np.pi * np.arange(16) / 16
    x = 2.0 * ratio / (1.0 + ratio**2) * np.cos(around)  # |ν_r|² = ν̄²(1 − x)
    speed = R * math.sqrt(1.0 + ratio**2) * np.mean(1.0 - x / 2.0 - x**2 / 8.0)
    assert -power(EXPANSION, ratio * R + 0j, 1.0) == pytest.approx(speed, rel=1e-14)


@named
@motions
def test_derivatives_along_the_motion_itself_vanish(law, slip, spin):
    jacobian = law.jacobian(slip, spin, 0.4)
    along = jacobian @ np.array((slip.real, slip.imag, spin, 0.0))
    assert along == pytest.approx(np.zeros(3), abs=1e-14 * np.abs(jacobian).max())


# ---------------------------------------------------------------- edges


def test_pin_has_full_friction_and_no_moment():
    assert Pin().force_and_moment(0.03 - 0.04j, 2.0, 0.0) == (pytest.approx(-0.6 + 0.8j), 0.0)
    assert Pin().force_and_moment(0j, 2.0, 0.0) == (0j, 0.0)


def test_forces_keep_their_digits_in_extreme_motions():
    force, moment = RING.force_and_moment(3e-300 - 4e-300j, -1.0, 0.0)
    assert force == pytest.approx((-3e-300 + 4e-300j) / (2.0 * R), rel=1e-15, abs=0.0)
    assert moment == -R
    force, moment = RING.force_and_moment(3.0 - 4.0j, -1e-300, 0.0)
    assert force == pytest.approx(-0.6 + 0.8j, rel=1e-15)
    assert moment == pytest.approx(-1e-300 * R**2 / 10.0, rel=1e-15, abs=0.0)


def test_ring_with_a_resting_point_still_has_its_friction_but_no_derivative():
    speed = RING.radius * 2.0
    assert RING.shares(speed, -2.0) == pytest.approx((2.0 / math.pi, -2.0 * R / math.pi), rel=1e-15)
    with pytest.raises(ValueError, match=r"slip = 0\.24 m/s = radius·\|relative spin\|"):
        RING.jacobian(speed * 1j, -2.0, 0.0)


@named
def test_disc_at_rest_has_no_derivative(law):
    with pytest.raises(ValueError, match="at rest"):
        law.jacobian(0j, 0.0, 0.4)


@pytest.mark.parametrize("law", LAWS, ids=repr)
def test_friction_at_rest_is_left_to_what_holds_the_disc(law):
    assert law.force_and_moment(0j, 0.0, 0.4) == (0j, 0.0)


def test_point_at_rest_gives_nothing_and_has_no_derivative():
    slip = 1j * SIX.arms(0.4)[2]
    force, _ = SIX.force_and_moment(slip, 1.0, 0.4)
    others = 1.0 / math.tan(math.pi / 12.0) / 6.0
    assert force == pytest.approx(-slip / R * others, abs=1e-14)
    with pytest.raises(ValueError, match="a point is at rest"):
        SIX.jacobian(slip, 1.0, 0.4)


@pytest.mark.parametrize("law", [Ring, ThreeTermRing, lambda radius: PointsOnRing(radius, 6)])
@pytest.mark.parametrize(
    ("radius", "message"),
    [
        (0.0, "radius = 0 m: it must be > 0"),
        (-0.1, r"radius = -0\.1 m"),
        (math.nan, "nan"),
        ("wide", "number"),
    ],
)
def test_circle_of_no_size_is_refused(law, radius, message):
    with pytest.raises(ValueError, match=message):
        law(radius)


@pytest.mark.parametrize("points", [2, -6, 6.5, 6.0, True, math.nan, "six", None, 10**6])
def test_what_is_no_number_of_points_is_refused(points):
    with pytest.raises(ValueError, match=r"points = .*: it must be a whole number from 3 to 1000"):
        PointsOnRing(R, points)


def test_system_says_which_law_it_has():
    pin = PinOnDisc(mass=1.0, stiffness=1.0, damping=0.1, friction_force=0.12, disc_speed=1.5)
    assert contact_of(pin) == Pin()
    assert contact_of(FIG11) == RING
    assert contact_of(replace(FIG11, contact_points=6)) == SIX


def test_points_are_refused_where_the_law_must_not_depend_on_the_angle():
    six = replace(FIG11, contact_points=6)
    assert isotropic_contact_of(FIG11, None, "whirls") == RING
    assert isotropic_contact_of(six, EXPANSION, "whirls") == EXPANSION
    with pytest.raises(
        ValueError, match="contact_points = 6: whirls can't be had for a disc on single points"
    ):
        isotropic_contact_of(six, None, "whirls")
    with pytest.raises(
        ValueError, match=r"contact = PointsOnRing\(radius=0\.12, points=6\): whirls can't be had"
    ):
        isotropic_contact_of(FIG11, SIX, "whirls")


def test_radius_of_any_kind_of_number_becomes_a_float():
    for law in (Ring("0.12"), ThreeTermRing(np.float32(0.125)), PointsOnRing(1, 6)):
        assert type(law.radius) is float
    assert Ring("0.12") == RING
