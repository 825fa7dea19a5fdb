"""The law of the units in C: against 30 digits, against integrals over the contact, and its own differences."""

import ctypes
import itertools
import math

import mpmath
import numpy as np
import pytest


class Contact(ctypes.Structure):
    _fields_ = [
        ("inner", ctypes.c_double),
        ("outer", ctypes.c_double),
        ("points", ctypes.c_int),
        ("angle", ctypes.c_double),
        ("wear", ctypes.c_int),
        ("pressure", ctypes.c_double * 3),
        ("friction", ctypes.c_double),
        ("static_ratio", ctypes.c_double),
        ("epsilon", ctypes.c_double),
    ]


Three = ctypes.c_double * 3


def contact(inner, outer, static_ratio=1.0, points=0, wear=0, pressure=(1.0, 1.0, 1.0)):
    return Contact(inner, outer, points, 0.3, wear, Three(*pressure), 2.0, static_ratio, 1e-3)


RING = contact(0.12, 0.12)
ANNULUS = contact(0.05, 0.12, 1.2)
WORN = contact(0.05, 0.12, 1.2, wear=1)
TAPERED = contact(0.05, 0.12, 1.2, pressure=(0.0, 2.0, 3.0))
PIN = contact(0.0, 0.0, 1.3)
FIVE = contact(0.12, 0.12, 1.2, points=5)


def floats(*values):
    return [ctypes.c_double(value) for value in values]


@pytest.fixture(scope="module")
def law(library):
    found = library("clutch")
    found.friction.restype = found.friction_tangent.restype = ctypes.c_double
    found.friction_needed.restype = found.slip_potential.restype = ctypes.c_double
    return found


def slopes(law, u, w):
    found = (ctypes.c_double * 2)()
    law.ring_slopes(*floats(u, w), found)
    return tuple(found)


def exact(u, w):
    """∂P/∂U and ∂P/∂W of notes on (20): [(U + W)E ± (U − W)K]/(πU or πW), m = 4UW/(U + W)², to 30 digits."""
    with mpmath.workdps(60):
        u, w = mpmath.mpf(u), mpmath.mpf(w)
        if w == 0 or u == 0:
            return (1.0, 0.0) if w == 0 else (0.0, 1.0)
        if u == w:
            return (2 / mpmath.pi,) * 2
        m = 4 * u * w / (u + w) ** 2
        e, k = (u + w) * mpmath.ellipe(m), (u - w) * mpmath.ellipk(m)
        return (e + k) / (mpmath.pi * u), (e - k) / (mpmath.pi * w)


def points():
    """Slip of the centre and of the rim: edges, and ratios over twenty decades."""
    random = np.random.default_rng(20)
    ratios = np.concatenate(
        (10.0 ** random.uniform(-10.0, 0.0, 150), 1.0 - 10.0 ** random.uniform(-15.5, -0.3, 150))
    )
    edges = [0.0, 1e-300, 1e-9, 1e-7, 0.5, 1.0, np.nextafter(1.0, 0.0)]
    sizes = 10.0 ** random.uniform(-9.0, 3.0, ratios.size)
    for ratio, size in itertools.chain(zip(ratios, sizes, strict=True), ((edge, 1.0) for edge in edges)):
        yield float(size), float(ratio * size)
        yield float(ratio * size), float(size)


def test_the_ring_has_thirteen_digits(law):
    for u, w in points():
        found, expected = slopes(law, u, w), exact(u, w)
        assert all(abs(one - float(other)) <= 1e-13 for one, other in zip(found, expected, strict=True)), (
            u,
            w,
        )


def force(law, contact, slip):
    found = Three()
    potential = law.friction(ctypes.byref(contact), Three(*slip), found, ctypes.byref(ctypes.c_double()))
    return np.array(found), potential


@pytest.mark.parametrize("slip", [(0.3, -0.2, 1.0), (0.01, 0.02, -4.0), (0.2, 0.1, 2.5)])
@pytest.mark.parametrize(
    ("contact", "share"),
    [
        (ANNULUS, lambda r: r),
        (WORN, lambda r: 1.0),
        (TAPERED, lambda r: r * (r - 0.05) * (0.225 - r)),  # 0, 2 and 3 of any unit
    ],
    ids=["uniform", "worn", "tapered"],
)
def test_an_annulus_is_what_its_points_add_up_to(law, contact, share, slip):
    radii, weights = np.polynomial.legendre.leggauss(60)
    radii = contact.inner + (contact.outer - contact.inner) * (0.5 + 0.5 * radii)
    weights = weights * np.array([share(r) for r in radii])
    angles = 2.0 * np.pi * np.arange(4000) / 4000
    arms = radii[:, None] * np.exp(1j * angles)
    slips = complex(*slip[:2]) + 1j * slip[2] * arms
    weight = np.repeat((weights / weights.sum())[:, None] / angles.size, angles.size, axis=1)
    pushes = -contact.friction * weight * slips / np.abs(slips)
    moment = np.sum((arms.conjugate() * pushes).imag)
    found, _ = force(law, contact, slip)
    expected = [pushes.sum().real, pushes.sum().imag, moment]
    np.testing.assert_allclose(found, expected, atol=2e-4)  # of this sum, where a point rests


@pytest.mark.parametrize(
    "contact",
    [PIN, RING, ANNULUS, WORN, TAPERED, FIVE],
    ids=["pin", "ring", "annulus", "worn", "tapered", "points"],
)
@pytest.mark.parametrize("size", [0.2, 1.5, 30.0])
def test_tangents_are_derivatives_creeping_falling_and_sliding(law, contact, size):
    slip = np.array([0.6, -0.5, 4.0]) * size * contact.epsilon
    way, turn, step = (
        np.array([0.3, 0.7, -2.0]),
        0.4 / (size * contact.epsilon),
        1e-6 * size * contact.epsilon,
    )
    ahead, behind = (
        force(law, turned(contact, sign * step * turn), slip + sign * step * way) for sign in (1.0, -1.0)
    )
    found = Three()
    potential = law.friction_tangent(
        ctypes.byref(contact), Three(*slip), Three(*way), *floats(0.0, turn), found
    )
    expected = (ahead[0] - behind[0]) / (2.0 * step)
    np.testing.assert_allclose(found, expected, atol=2e-7 * np.abs(expected).max())
    assert potential == pytest.approx((ahead[1] - behind[1]) / (2.0 * step), rel=1e-6)


def turned(contact, angle):
    found = Contact.from_buffer_copy(contact)
    found.angle += angle
    return found


def test_many_points_are_the_ring(law):
    slip = (0.3, -0.2, 1.0)
    np.testing.assert_allclose(
        force(law, contact(0.12, 0.12, points=64), slip)[0], force(law, RING, slip)[0], rtol=1e-12
    )


def test_friction_is_of_first_degree_below_epsilon_and_at_its_peak_there(law):
    slip = np.array([0.4, 0.2, -3.0])
    potential = force(law, ANNULUS, slip)[1]
    full = force(law, ANNULUS, slip)[0]
    for share in (0.25, 1.0 - 1e-12):
        creeping = force(law, ANNULUS, slip * share * ANNULUS.epsilon / potential)[0]
        np.testing.assert_allclose(creeping, full * ANNULUS.static_ratio * share, rtol=1e-9)
    found = Three()
    law.friction_tangent(ctypes.byref(ANNULUS), Three(0.0, 0.0, 0.0), Three(*slip), *floats(0.0, 0.0), found)
    np.testing.assert_allclose(found, full * ANNULUS.static_ratio * potential / ANNULUS.epsilon, rtol=1e-12)


@pytest.mark.parametrize("contact", [RING, ANNULUS], ids=["ring", "annulus"])
def test_what_holds_is_on_the_limit_surface(law, contact):
    for slip in ((0.3, 0.0, 1.0), (0.02, 0.0, -5.0), (1.0, 0.0, 0.0), (0.0, 0.0, 1.0)):
        ((fx, _, moment), potential), by = force(law, contact, slip), (ctypes.c_double * 2)()
        needed = law.friction_needed(ctypes.byref(contact), *floats(abs(fx), -moment), by)
        assert needed == pytest.approx(contact.friction, rel=1e-9)
        np.testing.assert_allclose(
            by, [slip[0] / potential, slip[2] / potential], atol=2e-6 / potential
        )  # flow
    assert law.friction_needed(ctypes.byref(PIN), *floats(math.pi, 0.0), (ctypes.c_double * 2)()) == math.pi
