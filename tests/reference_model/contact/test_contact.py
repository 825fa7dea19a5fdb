"""Contact laws against the printed integrals (20); a study measures the errors of the approximations."""

import math
from dataclasses import replace

import numpy as np
import pytest

from compare.claims.parameters import FIG11
from reference_model.contact.annulus import Annulus
from reference_model.contact.contact_law import (
    Pin,
    Ring,
    ThreeTermRing,
    contact_of,
    isotropic_contact_of,
)
from reference_model.contact.patch import polygon_patch
from reference_model.contact.points import Points, PointsOnRing
from reference_model.systems import PinOnDisc

R = 0.12
RING, EXPANSION, SIX = Ring(R), ThreeTermRing(R), PointsOnRing(R, 6)

# U/W ranges from 0.6 to 8, with both directions of spin.
MOTIONS = [(0.1 + 0.05j, 0.9), (-0.03 + 0.3j, -0.5), (0.2j, 0.2), (-0.05 - 0.09j, -1.4), (0.4 - 0.1j, 1.9)]
motions = pytest.mark.parametrize(("slip", "spin"), MOTIONS)


@motions
@pytest.mark.parametrize("points", [3, 6, 11])
def test_points_are_the_sum_in_place_of_the_integral_20(slip, spin, points):
    found = PointsOnRing(R, points).force_and_moment(slip, spin, 0.4)
    around = 0.4 + 2.0 * np.pi * np.arange(points) / points
    s, c = np.sin(around), np.cos(around)
    x, y = slip.real + R * spin * s, slip.imag - R * spin * c  # (21), with the signs of the paper
    force_x, force_y, moment = np.mean([-x, -y, R * (x * s - y * c)] / np.hypot(x, y), axis=1)
    assert found == pytest.approx((complex(force_x, force_y), moment), abs=1e-14)


def test_parameters_of_a_system_select_its_contact_law():
    pin = PinOnDisc(mass=1.0, stiffness=1.0, damping=0.1, friction_force=0.12, disc_speed=1.5)
    assert contact_of(pin) == Pin()
    assert contact_of(FIG11) == RING
    six = replace(FIG11, contact_points=6)
    assert contact_of(six) == SIX
    assert isotropic_contact_of(FIG11, None, "whirls") == RING
    assert isotropic_contact_of(six, EXPANSION, "whirls") == EXPANSION


BAD_PLACES = {
    7: r"places = 7: it must be a list of \(x, y, share\)",
    ((0.1, 0.2), (0.3, 0.4)): r"places\[0\] = \(0\.1, 0\.2\): it must be \(x, y, share\)",
    ((0.1, 0.2, 0.5), (0.3, math.inf, 0.5)): r"places\[1\] = inf: it must be finite",
    ((0.1, 0.2, 0.5), (0.3, "b", 0.5)): r"places\[1\] = 'b': it must be a number",
    ((0.1, 0.2, 1.5), (0.3, 0.4, -0.5)): r"places\[1\] = .*: the share must be > 0",
    ((0.1, 0.2, 1.0),): "at least two points are needed; use a pin for a single one",
    ((0.1, 0.2, 0.5), (0.1, 0.2, 0.5)): r"2 points lie at \(0\.1, 0\.2\); combine their shares",
    ((0.1, 0.2, 0.5), (0.1, 0.3, 0.49999)): "the shares sum to 0.99999; they must sum to 1",
}
SQUARE = ((0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0))
BAD_POLYGONS = {
    (SQUARE, 0): "divisions = 0: it must be a whole number >= 1",
    (SQUARE[:2], 1): "a polygon has at least three corners",
    (3.0, 1): r"corners = 3\.0: it must be a list of \(x, y\) in m",
    (((0.0, 0.0), (1.0, math.nan), (1.0, 1.0)), 1): "corners = nan: it must be finite",
    (((0.0, 0.0), (1.0, 1.0), (2.0, 2.0)), 1): "the polygon has no area or intersects itself",
    (((0.0, 0.0), (1.0, 1.0), (1.0, 0.0), (0.0, 1.0)), 1): "the polygon has no area or intersects itself",
}


@pytest.mark.parametrize(
    ("make", "arguments", "message"),
    [
        *((law, (0.0,), "radius = 0 m: it must be > 0") for law in (Ring, ThreeTermRing)),
        (PointsOnRing, (-0.1, 6), r"radius = -0\.1 m"),
        (Ring, (math.nan,), "radius = nan: it must be finite"),
        (Ring, ("wide",), "radius = 'wide': it must be a number"),
        *(
            (PointsOnRing, (R, points), "points = .*: it must be a whole number from 3 to 1000")
            for points in (2, 6.0, True, math.nan, "six", None, 1001)
        ),
        *((Points, (places,), message) for places, message in BAD_PLACES.items()),
        *((polygon_patch, arguments, message) for arguments, message in BAD_POLYGONS.items()),
        (Annulus, (0.12, 0.12), r"outer_radius = 0\.12 m: it must be > inner_radius = 0\.12 m"),
        (Annulus, (-0.1, 0.12), r"inner_radius = -0\.1 m: it must be >= 0"),
        (Annulus, (math.nan, 0.12), "inner_radius = nan: it must be finite"),
        (Annulus, (0.08, 0.12, 0), "rings = 0: it must be a whole number >= 1"),
        (Annulus, (0.08, 0.12, True), "rings = True: it must be a whole number >= 1"),
        (Annulus, (0.08, 0.12, 8, lambda r: 0.1 - r), r"pressure\(0\.1\d* m\) = -.*: it must be >= 0"),
        (Annulus, (0.08, 0.12, 8, lambda r: math.nan), r"pressure\(0\.08\d* m\) = nan: it must be finite"),
        (Annulus, (0.08, 0.12, 8, lambda r: 0.0), "pressure = 0 everywhere"),
        (Annulus, (0.08, 0.12, 8, 3.0), r"pressure = 3\.0: it must be a function of the radius, or None"),
        (
            isotropic_contact_of,
            (replace(FIG11, contact_points=6), None, "whirls"),
            "contact_points = 6: whirls cannot be computed for single points",
        ),
        (
            isotropic_contact_of,
            (FIG11, SIX, "whirls"),
            r"contact = PointsOnRing\(radius=0\.12, points=6\): whirls cannot be computed",
        ),
    ],
)
def test_invalid_contact_is_refused(make, arguments, message):
    with pytest.raises(ValueError, match=message):
        make(*arguments)


def test_radius_of_any_kind_of_number_becomes_a_float():
    for law in (Ring("0.12"), ThreeTermRing(np.float32(0.125)), PointsOnRing(1, 6)):
        assert type(law.radius) is float
    assert Ring("0.12") == RING
