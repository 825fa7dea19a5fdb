"""Points and patches against integrals in closed form: two points, and polygons."""

import math

import numpy as np
import pytest

from reference_model.contact import polygon_patch

TRIANGLE = [(0.3, 0.8), (1.0, 0.0), (0.0, 0.0)]  # clockwise
ANGLE = [(0.0, 0.0), (1.0, 0.0), (1.0, 0.4), (0.4, 0.4), (0.4, 1.0), (0.0, 1.0)]
POLYGONS = pytest.mark.parametrize("corners", [TRIANGLE, ANGLE], ids=["triangle", "L"])


def friction_about(contact, pole):
    """Return force, and moment about ``pole``, of a disc at φ = 0 that turns about it with φ̇ − ω = 1 rad/s."""
    force, moment = contact.force_and_moment(-1j * pole, -1.0, 0.0)
    return force, moment - (pole.conjugate() * force).imag


def friction_of_polygon(corners, pole):
    """Return the same for uniform pressure, as a sum over the triangles between the pole and each side.

    The means of r/|r| and |r| over a triangle with a side at the distance d from the pole are integrals along that
    side of (s² + d²)^(1/2) and s·(s² + d²)^(-1/2).
    """
    around = np.array([complex(*corner) for corner in corners]) - pole
    area = distance = 0.0
    direction = 0j
    for a, b in zip(around, np.roll(around, -1), strict=True):
        along = (b - a) / abs(b - a)
        d = (a.conjugate() * along).imag
        start, end = (along.conjugate() * a).real, (along.conjugate() * b).real
        farther = math.hypot(end, d) - math.hypot(start, d)
        turn = math.asinh(end / abs(d)) - math.asinh(start / abs(d))
        area += d / 2.0 * (end - start)
        distance += d / 6.0 * (end * math.hypot(end, d) - start * math.hypot(start, d) + d * d * turn)
        direction += d / 2.0 * (farther - 1j * d * turn) * along
    return -1j * direction / area, -distance / area


@POLYGONS
def test_patch_converges_with_order_4_to_a_turn_about_a_point_outside(corners):
    for pole in (1.2 + 1.5j, -0.9 + 0.3j, 0.45 - 1.6j):
        exact, errors = friction_of_polygon(corners, pole), []
        for divisions in (16, 32):
            found = friction_about(polygon_patch(corners, divisions), pole)
            errors.append((abs(found[0] - exact[0]), abs(found[1] - exact[1])))
        np.testing.assert_allclose(np.log2(np.divide(*errors)), 4.0, atol=0.05)


@POLYGONS
def test_patch_converges_with_order_2_in_force_and_3_in_moment_to_a_turn_about_a_point_inside(corners):
    """The errors depend on where the pole lies in its small triangle, so they are averaged over 100 poles."""
    phases = np.arange(100.0)
    inside = np.mean([complex(*corner) for corner in corners[:3]]) * 0.9
    poles = inside + 0.15 * (np.cos(phases) + 1j * np.sin(1.3 * phases))
    exact = [friction_of_polygon(corners, pole) for pole in poles]
    errors = []
    for divisions in (6, 24):
        patch = polygon_patch(corners, divisions)
        differences = np.subtract([friction_about(patch, pole) for pole in poles], exact)
        errors.append(np.sqrt(np.mean(abs(differences) ** 2, axis=0)))
    orders = np.log2(errors[0] / errors[1]) / 2.0
    np.testing.assert_allclose(orders, [2.0, 3.0], atol=0.2)
