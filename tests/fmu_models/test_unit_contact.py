"""The friction law of the units in C, for every contact.

Above ε friction takes the power μN·P with the mean slip speed P, and it obeys the principle of maximal dissipation.
Below ε it is viscous.
"""

import ctypes

import mpmath
import numpy as np
import pytest
from contact_in_c import Contact, Three


def contact(inner, outer, static_ratio=1.0, points=0, wear=0, pressure=(1.0, 1.0, 1.0)):
    return Contact(inner, outer, points, 0.3, wear, Three(*pressure), 2.0, static_ratio, 1e-3)


RING = contact(0.12, 0.12)
ANNULUS = contact(0.05, 0.12, 1.2)
WORN = contact(0.05, 0.12, 1.2, wear=1)
TAPERED = contact(0.05, 0.12, 1.2, pressure=(0.0, 2.0, 3.0))
PIN = contact(0.0, 0.0, 1.3)
FIVE = contact(0.12, 0.12, 1.2, points=5)
CONTACTS = {"pin": PIN, "points": FIVE, "ring": RING, "annulus": ANNULUS, "worn": WORN, "tapered": TAPERED}
EVERY = pytest.mark.parametrize("contact", CONTACTS.values(), ids=CONTACTS)


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
    """Return ∂P/∂U and ∂P/∂W, [(U + W)E ± (U − W)K]/(πU or πW) with m = 4UW/(U + W)², to 30 digits."""
    with mpmath.workdps(60):
        u, w = mpmath.mpf(u), mpmath.mpf(w)
        if w == 0 or u == 0:
            return (1.0, 0.0) if w == 0 else (0.0, 1.0)
        if u == w:
            return (2 / mpmath.pi,) * 2
        m = 4 * u * w / (u + w) ** 2
        e, k = (u + w) * mpmath.ellipe(m), (u - w) * mpmath.ellipk(m)
        return (e + k) / (mpmath.pi * u), (e - k) / (mpmath.pi * w)


def test_friction_of_the_ring_is_accurate_to_thirteen_digits(law):
    random = np.random.default_rng(20)
    far, near = 10.0 ** random.uniform(-10.0, 0.0, 150), 1.0 - 10.0 ** random.uniform(-15.5, -0.3, 150)
    ratios = [0.0, 1e-300, 1e-9, 1e-7, 0.5, 1.0, np.nextafter(1.0, 0.0), *far, *near]
    for ratio, size in zip(ratios, 10.0 ** random.uniform(-9.0, 3.0, len(ratios)), strict=True):
        for u, w in ((size, ratio * size), (ratio * size, size)):
            found, expected = slopes(law, u, w), [float(one) for one in exact(u, w)]
            np.testing.assert_allclose(found, expected, rtol=0.0, atol=1e-13, err_msg=f"{u} {w}")


def force(law, contact, slip):
    found = Three()
    potential = law.friction(ctypes.byref(contact), Three(*slip), found, ctypes.byref(ctypes.c_double()))
    return np.array(found), potential


def slips(count=80):
    """Return slips between 1e-3 ε and 1e4 ε, some with a resting point on the rim."""
    random = np.random.default_rng(7)
    found = random.normal(size=(count, 3)) * [1.0, 1.0, 1.0 / 0.12]
    found[::5, 2] = np.hypot(found[::5, 0], found[::5, 1]) / 0.12
    return found * 1e-3 * 10.0 ** random.uniform(-3.0, 4.0, (count, 1))


@EVERY
def test_friction_takes_the_power_of_the_mean_slip_and_obeys_maximal_dissipation(law, contact):
    directions = slips() / np.abs(slips()).max(axis=1)[:, None]
    potentials = np.array([force(law, contact, direction)[1] for direction in directions])
    for slip in slips():
        load, mean = force(law, contact, slip)
        share = mean / contact.epsilon
        creep = 1.0 if contact.points > 0 else min(1.0, share)  # single points creep independently
        most = contact.friction * creep * (contact.static_ratio if share < 2.0 else 1.0)
        assert 0.0 < -load @ slip <= most * mean * (1.0 + 1e-9)
        single = contact.points > 0 and slowest(law, contact, slip) < contact.epsilon
        if not single and not 1.0 <= share < 2.0:
            assert -load @ slip == pytest.approx(most * mean, rel=1e-9)
        assert np.all(
            -directions @ load <= contact.friction * contact.static_ratio * potentials * (1.0 + 1e-9)
        )


def slowest(law, contact, slip):
    found = ctypes.c_double()
    law.friction(ctypes.byref(contact), Three(*slip), Three(), ctypes.byref(found))
    return found.value


@EVERY
def test_friction_rises_to_its_peak_at_epsilon_and_is_constant_above_twice_epsilon(law, contact):
    slip = np.array([0.4, 0.2, -3.0])
    full, potential = force(law, contact, slip)
    if contact.points == 0:
        for share in (0.25, 1.0 - 1e-12):
            creeping = force(law, contact, slip * share * contact.epsilon / potential)[0]
            np.testing.assert_allclose(creeping, full * contact.static_ratio * share, rtol=1e-9)
        found = Three()
        law.friction_tangent(ctypes.byref(contact), Three(), Three(*slip), *floats(0.0, 0.0), found)
        np.testing.assert_allclose(
            found, full * contact.static_ratio * potential / contact.epsilon, rtol=1e-12
        )
    shares = np.linspace(1.0 + 1e-9, 2.0, 30)
    sizes = [force(law, contact, (share * contact.epsilon, 0.0, 0.0))[0][0] for share in shares]
    assert sizes[0] == pytest.approx(-contact.friction * contact.static_ratio, rel=1e-5)
    assert sizes[-1] == pytest.approx(-contact.friction, rel=1e-12)
    assert contact.static_ratio == 1.0 or np.all(np.diff(sizes) > 0.0)


@pytest.mark.parametrize("contact", [PIN, RING, ANNULUS, WORN, TAPERED])
def test_held_loads_lie_on_the_limit_surface(law, contact):
    for slip in ((0.3, 0.0, 1.0), (0.02, 0.0, -5.0), (1.0, 0.0, 0.0), (0.0, 0.0, 1.0)):
        ((fx, _, moment), potential), by = force(law, contact, slip), (ctypes.c_double * 2)()
        needed = law.friction_needed(ctypes.byref(contact), *floats(abs(fx), -moment), by)
        if contact.outer > 0.0:
            assert needed == pytest.approx(contact.friction, rel=1e-9)
            flow = [slip[0] / potential, slip[2] / potential]
            np.testing.assert_allclose(by, flow, atol=2e-6 / potential)
        else:
            assert needed == pytest.approx(abs(fx), rel=1e-15)
