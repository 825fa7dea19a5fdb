"""The contact law of a system, and error messages for invalid contacts."""

import math
from dataclasses import replace

import pytest

from compare.claims.parameters import FIG11
from reference_model.contact.annulus import Annulus
from reference_model.contact.contact_law import Pin, Ring, ThreeTermRing, contact_of, isotropic_contact_of
from reference_model.contact.patch import polygon_patch
from reference_model.contact.points import Points, PointsOnRing
from reference_model.systems import PinOnDisc

RING, EXPANSION, POINTS = Ring(0.12), ThreeTermRing(0.12), PointsOnRing(0.12, 6)
SIX = replace(FIG11, contact_points=6)


def test_parameters_of_a_system_select_its_contact_law():
    pin = PinOnDisc(mass=1.0, stiffness=1.0, damping=0.1, friction_force=0.12, disc_speed=1.5)
    assert contact_of(pin) == Pin()
    assert contact_of(FIG11) == isotropic_contact_of(FIG11, None, "whirls") == Ring(0.12) == RING
    assert contact_of(SIX) == POINTS
    assert isotropic_contact_of(SIX, EXPANSION, "whirls") == EXPANSION


def points(*places):
    return lambda: Points(list(places))


def polygon(*corners, divisions=1):
    return lambda: polygon_patch(corners, divisions)


def pressed(pressure):
    return lambda: Annulus(0.08, 0.12, 8, pressure)


@pytest.mark.parametrize(
    ("make", "message"),
    [
        *((lambda law=law: law(0.0), "radius = 0 m: it must be > 0") for law in (Ring, ThreeTermRing)),
        (lambda: PointsOnRing(math.nan, 6), "radius = nan: it must be finite"),
        (lambda: PointsOnRing(0.1, 2), "points = 2: it must be a whole number >= 3 and <= 1000"),
        (lambda: Points(7), r"places = 7: it must be a list of \(x, y, share\)"),
        (points((0.1, 0.2), (0.3, 0.4)), r"places\[0\] = \(0\.1, 0\.2\): it must be \(x, y, share\)"),
        (points((0.1, 0.2, 0.5), (0.3, "b", 0.5)), r"places\[1\] = 'b': it must be a number"),
        (points((0.1, 0.2, 1.5), (0.3, 0.4, -0.5)), r"places\[1\] = .*: the share must be > 0"),
        (points((0.1, 0.2, 1.0)), "at least two points are needed; use a pin for a single one"),
        (points((0.1, 0.2, 0.5), (0.1, 0.2, 0.5)), r"2 points lie at \(0\.1, 0\.2\); combine their shares"),
        (points((0.1, 0.2, 0.5), (0.1, 0.3, 0.49999)), "the shares sum to 0.99999; they must sum to 1"),
        (polygon((0.0, 0.0), (1.0, 0.0), divisions=0), "divisions = 0: it must be a whole number >= 1"),
        (polygon((0.0, 0.0), (1.0, 0.0)), "a polygon has at least three corners"),
        (lambda: polygon_patch(3.0, 1), r"corners = 3\.0: it must be a list of \(x, y\) in m"),
        (polygon((0.0, 0.0), (1.0, math.nan), (1.0, 1.0)), "corners = nan: it must be finite"),
        (polygon((0.0, 0.0), (1.0, 1.0), (2.0, 2.0)), "the polygon has no area"),
        (
            polygon((0.0, 0.0), (1.0, 1.0), (1.0, 0.0), (0.0, 1.0)),
            "the polygon has no area or intersects itself",
        ),
        (lambda: Annulus(0.12, 0.12), r"outer_radius = 0\.12 m: it must be > inner_radius = 0\.12 m"),
        (lambda: Annulus(-0.1, 0.12), r"inner_radius = -0\.1 m: it must be >= 0"),
        (lambda: Annulus(0.08, 0.12, 0), "rings = 0: it must be a whole number >= 1"),
        (
            lambda: Annulus(0.08, 0.12, 10**9),
            "rings = 1000000000: it must be a whole number >= 1 and <= 1000",
        ),
        (polygon((0.0, 0.0), (1.0, 0.0), divisions=10**6), "divisions = 1000000: it must be .* <= 100"),
        (polygon(*301 * [(0.0, 0.0)]), "number of corners = 301: it must be .* <= 300"),
        (pressed(lambda r: 0.1 - r), r"pressure\(0\.1\d* m\) = -.*: it must be >= 0"),
        (pressed(lambda r: math.nan), r"pressure\(0\.08\d* m\) = nan: it must be finite"),
        (pressed(lambda r: 0.0), "pressure = 0 everywhere"),
        (pressed(3.0), r"pressure = 3\.0: it must be a function of radius"),
        (pressed(lambda: 1.0), r"pressure = .*: it must be a function of radius"),
        (
            lambda: isotropic_contact_of(SIX, None, "whirls"),
            "contact_points = 6: whirls cannot be computed for single points",
        ),
        (
            lambda: isotropic_contact_of(FIG11, POINTS, "whirls"),
            r"contact = PointsOnRing\(radius=0\.12, points=6\): whirls cannot be computed",
        ),
    ],
)
def test_invalid_contact_is_refused(make, message):
    with pytest.raises(ValueError, match=message):
        make()
