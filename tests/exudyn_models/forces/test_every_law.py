"""Properties of the friction of every contact at any slip: pin, points, ring, and annuli under each pressure.

P is the mean slip speed. Where P > ε force and moment F dissipate the power −F·slip = μN·P, and −F·v <= μN·P(v) for
any other slip v. Where P < ε the contact creeps, and F is its value at P = ε times P/ε.
"""

import functools
import math

import numpy as np
import pytest

from exudyn_models.forces.friction_laws import (
    CONTINUOUS,
    NONE_HELD,
    mean_radius,
    ring_friction,
    ring_friction_derivatives,
    slip_potential_of_contact,
)
from exudyn_models.forces.laws.places import BEND, places_in, point_regularisation, ring_places, table_of
from exudyn_models.forces.laws.pressures import density_of

INNER, RADIUS, FRICTION, EPSILON, ANGLE = 0.08, 0.12, 0.5, 1e-4, 0.3


THREE_FEET = ((0.12, 0.0, 0.2), (-0.03, 0.07, 0.5), (-0.04, -0.03, 0.3))
ROD = ((-0.12, 0.0, 0.3), (-0.02, 0.0, 0.3), (0.05, 0.0, 0.1), (0.12, 0.0, 0.3))


def contact_of(points=CONTINUOUS, inner=RADIUS, outer=RADIUS, held=NONE_HELD):
    """Return a contact on circles, at a number of points on a circle, or at given points."""
    if points == CONTINUOUS or (isinstance(points, int) and points < CONTINUOUS):
        return outer, points, FRICTION, EPSILON, held, inner
    places = ring_places(outer, points) if isinstance(points, int) else points
    return outer, len(places), FRICTION, EPSILON, held, table_of(places)


def towards_the_rim(radius):
    return 1.0 + 200.0 * radius**2


UNIFORM = 2.0 / 3.0 * (RADIUS**3 - INNER**3) / (RADIUS**2 - INNER**2)  # textbook friction radius of a clutch
RISING = ((RADIUS**3 - INNER**3) / 3.0 + 40.0 * (RADIUS**5 - INNER**5)) / (
    0.5 * (RADIUS**2 - INNER**2) + 50.0 * (RADIUS**4 - INNER**4)
)
CONTACTS = {
    "pin": (contact_of(1, 0.0, 0.0), 0.0),
    **{f"{n} points": (contact_of(n), RADIUS) for n in (2, 3, 6, 24)},
    "three feet": (contact_of(THREE_FEET), 0.2 * 0.12 + 0.5 * math.sqrt(0.0058) + 0.3 * 0.05),
    "rod": (contact_of(ROD), 0.3 * 0.12 + 0.3 * 0.02 + 0.1 * 0.05 + 0.3 * 0.12),
    "ring": (contact_of(), RADIUS),
    "annulus": (contact_of(inner=INNER), UNIFORM),
    "full disc": (contact_of(inner=0.0), 2.0 / 3.0 * RADIUS),
    "worn annulus": (contact_of(density_of("wear", INNER, RADIUS), INNER), 0.5 * (INNER + RADIUS)),
    "pressed at the rim": (contact_of(density_of(towards_the_rim, INNER, RADIUS), INNER), RISING),
}
EVERY = pytest.mark.parametrize("contact", [pair[0] for pair in CONTACTS.values()], ids=CONTACTS)
SCALE = np.array([1.0, 1.0, 1.0 / RADIUS])


def friction(contact, slip, angle=ANGLE):
    """Return force and moment for a slip (u_x, u_y, φ̇ − ω) on a master at rest."""
    return np.array(ring_friction(0.0, 0.0, angle, slip[0], slip[1], 0.0, slip[2], contact)[:3])


def mean_slip(contact, slip, angle=ANGLE):
    return slip_potential_of_contact(*slip, angle, contact)


def slips(count=60, largest=4.0):
    """Return slips in any direction from 1e-3·ε to 10^largest·ε, some with a point of the rim at rest."""
    rng = np.random.default_rng(7)
    found = rng.normal(size=(count, 3)) * SCALE
    found[::5, 2] = np.hypot(found[::5, 0], found[::5, 1]) / RADIUS  # U = R·S
    return found * EPSILON * 10.0 ** rng.uniform(-3.0, largest, (count, 1))


def of_points(contact):
    return contact[1] > 1


def slowest(contact, slip, angle=ANGLE):
    """Return the slip of the slowest point as a complex number."""
    x, y, _ = places_in(contact[5]).T
    all_slips = complex(*slip[:2]) + 1j * slip[2] * np.exp(1j * angle) * (x + 1j * y)
    return all_slips[np.abs(all_slips).argmin()]


@EVERY
def test_friction_takes_the_power_of_the_mean_slip_and_never_more(contact):
    for slip in slips():
        mean = mean_slip(contact, slip)
        most = FRICTION * mean * min(1.0, mean / EPSILON)
        power = -friction(contact, slip) @ slip
        yields = of_points(contact) and abs(slowest(contact, slip)) < BEND * point_regularisation(
            EPSILON, places_in(contact[5])
        ) * min(1.0, mean / EPSILON)
        assert 0.0 < power <= most * (1.0 + 1e-9)
        assert yields or power == pytest.approx(most, rel=1e-9)


@EVERY
def test_no_other_slip_would_meet_more_friction_than_coulomb_s(contact):
    """This bounds the force by μN, the moment by μN·R, and any mixture by the limit surface."""
    others = slips(200, 0.0)
    limits = FRICTION * np.array([mean_slip(contact, other) for other in others])
    for slip in slips():
        load = friction(contact, slip)
        assert np.all(-others @ load <= limits * (1.0 + 1e-9))
        assert math.hypot(*load[:2]) <= FRICTION * (1.0 + 1e-12)
        assert abs(load[2]) <= FRICTION * contact[0] * (1.0 + 1e-12)


def mirror_image(contact):
    if not of_points(contact):
        return contact
    return (*contact[:5], table_of(tuple((x, -y, share) for x, y, share in places_in(contact[5]).tolist())))


@EVERY
def test_a_turned_mirrored_or_reversed_slip_meets_friction_of_the_same_kind(contact):
    turn, mirror = 0.9, np.array([1.0, -1.0, -1.0])
    for slip in slips():
        x, y, moment = friction(contact, slip)
        size = 1e-11 * FRICTION * np.array([1.0, 1.0, RADIUS])
        z, force = complex(*slip[:2]) * np.exp(1j * turn), complex(x, y) * np.exp(1j * turn)
        turned = friction(contact, [z.real, z.imag, slip[2]], ANGLE + turn)
        assert np.all(abs(turned - [force.real, force.imag, moment]) <= size)
        mirrored = friction(mirror_image(contact), mirror * slip, -ANGLE)
        assert np.all(abs(mirrored - mirror * [x, y, moment]) <= size)
        assert np.all(abs(np.add(friction(contact, -slip), [x, y, moment])) <= size)


@pytest.mark.parametrize(("contact", "lever"), CONTACTS.values(), ids=CONTACTS)
def test_pure_slip_meets_the_whole_force_and_pure_spin_the_whole_moment(contact, lever):
    """Only a contact whose load is symmetric about the centre has no moment in translation and no force in spin."""
    x, y, shares = places_in(contact[5]).T if of_points(contact) else np.zeros((3, 1))
    arms = np.exp(1j * ANGLE) * (x + 1j * y)
    moment = np.sum(shares * arms.conjugate() * (-0.3 + 0.4j)).imag
    np.testing.assert_allclose(friction(contact, [3.0, -4.0, 0.0]), [-0.3, 0.4, moment], atol=1e-14)
    assert mean_radius(contact) == pytest.approx(lever, rel=1e-13)
    force = -1j * FRICTION * np.sum(shares * arms / np.maximum(abs(arms), 1e-300))
    for spin in (7.0, -7.0):
        expected = np.sign(spin) * np.array([force.real, force.imag, -FRICTION * lever])
        np.testing.assert_allclose(friction(contact, [0.0, 0.0, spin]), expected, atol=1e-14)
    np.testing.assert_array_equal(friction(contact, [0.0] * 3), [0.0] * 3)


@EVERY
def test_a_contact_that_slips_feels_the_direction_alone_and_one_that_creeps_the_amount_too(contact):
    for slip in slips():
        if contact[0] == 0.0:
            slip[2] = 0.0
        at_limit = slip * EPSILON / mean_slip(contact, slip)
        limit = friction(contact, at_limit)
        for share in (1.0 - 1e-15, 0.3, 1e-6):
            np.testing.assert_allclose(
                friction(contact, share * at_limit), share * limit, rtol=1e-11, atol=1e-13 * share
            )
        if not of_points(contact):  # single points are still viscous near rest
            np.testing.assert_allclose(friction(contact, 1e3 * at_limit), limit, rtol=1e-9, atol=1e-12)


@EVERY
def test_more_slip_in_a_direction_never_meets_less_friction(contact):
    for direction in slips(30, 0.0):
        amounts = np.geomspace(1.0, 1e6, 61) * EPSILON / np.abs(direction / SCALE).max() * 1e-3
        power = [-friction(contact, amount * direction) @ direction for amount in amounts]
        assert power[0] > 0.0
        assert np.all(np.diff(power) >= -1e-12 * max(power))


def test_points_become_the_ring_faster_than_any_power_of_their_number():
    slip = [0.3, -0.2, 1.0]
    errors = [
        np.abs(friction(contact_of(n), slip) - friction(contact_of(), slip)).max() for n in (4, 8, 16, 32, 64)
    ]
    ratios = np.divide(errors[1:-1], errors[:-2])
    assert np.all(np.diff(ratios) < 0.0), errors
    assert errors[-1] < 1e-13


def test_a_thin_annulus_becomes_the_ring_with_the_square_of_its_width():
    for slip in ([0.05, 0.0, 1.0], [0.3, 0.0, 1.0]):
        ring = friction(contact_of(CONTINUOUS, 0.1, 0.1), slip)
        errors = [
            np.abs(friction(contact_of(CONTINUOUS, 0.1 - d, 0.1 + d), slip) - ring).max()
            for d in (4e-3, 2e-3, 1e-3)
        ]
        np.testing.assert_allclose(np.log2(np.divide(errors[:-1], errors[1:])), 2.0, atol=0.05)


@functools.cache
def rings_of(inner, outer, share):
    """Return radii in m and load shares of 60 rings."""
    places, weights = np.polynomial.legendre.leggauss(60)
    radii = inner + (outer - inner) * (0.5 + 0.5 * places)
    weights = weights * [share(r) for r in radii]
    return radii, weights / weights.sum()


SHARES = {"annulus": lambda r: r, "full disc": lambda r: r, "worn annulus": lambda r: 1.0}
SHARES["pressed at the rim"] = lambda r: r * towards_the_rim(r)


@pytest.mark.parametrize("name", CONTACTS)
@pytest.mark.parametrize(
    ("slip", "accuracy"),
    [
        ((0.3, -0.2, 1.0), 1e-12),  # every point slips
        ((0.01, 0.02, -4.0), 1e-12),
        ((0.2, 0.1, 2.5), 2e-4),  # with a resting point the sum is less accurate
    ],
)
def test_friction_is_the_sum_over_its_points(name, slip, accuracy):
    if name == "full disc":
        accuracy = 2e-4  # one of its points is always nearly at rest
    (outer, points, _, _, _, inner), _ = CONTACTS[name]
    if points > CONTINUOUS:
        x, y, weights = places_in(inner).T
        arms = np.exp(1j * ANGLE) * (x + 1j * y)
    else:
        radii, weights = rings_of(inner, outer, SHARES[name]) if name in SHARES else ([outer], [1.0])
        arms = np.outer(radii, np.exp(1j * (ANGLE + 2.0 * np.pi * np.arange(4000) / 4000)))
        weights = np.array(weights)[:, None] / 4000
    each = complex(*slip[:2]) + 1j * slip[2] * arms
    pushes = -FRICTION * weights * each / np.abs(each)
    expected = [pushes.sum().real, pushes.sum().imag, np.sum((arms.conjugate() * pushes).imag)]
    np.testing.assert_allclose(friction(CONTACTS[name][0], slip), expected, rtol=0.0, atol=accuracy)


HELD = {f"{n} points, one held": contact_of(n, held=0) for n in (3, 6)}
HELD["three feet, one held"] = contact_of(THREE_FEET, held=0)


@pytest.mark.parametrize(
    "contact", [*[pair[0] for pair in CONTACTS.values()], *HELD.values()], ids=[*CONTACTS, *HELD]
)
@pytest.mark.parametrize("size", [1.0, 1e-6], ids=["slip", "creep"])
def test_derivatives_match_differences_of_friction(contact, size):
    """The exception is the slip of points that creep as a whole: it contains a share of the secant, for Newton."""
    rng = np.random.default_rng(5)
    blended = size < 1.0 and of_points(contact)
    # Twelve rings have an error of 5e-7 of an annulus's largest curvature, and a derivative adds several curvatures.
    accuracy = 1e-6 if contact[1] > CONTINUOUS or contact[5] == contact[0] else 1e-5
    for _ in range(20):
        slip = rng.normal(size=3) * [1.0, 1.0, 8.0] * size
        arguments = np.array([0.0, 0.0, rng.uniform(-3.0, 3.0), slip[0], slip[1], 0.0, slip[2]])
        derivatives = ring_friction_derivatives(*arguments, contact)
        for j, scale in ((2, 1.0), (3, size), (4, size), (6, 8.0 * size))[: 1 if blended else 4]:
            step = np.zeros(7)
            step[j] = 1e-6 * scale
            plus, minus = (np.array(ring_friction(*(arguments + sign * step), contact)) for sign in (1, -1))
            expected = (plus - minus) / (2.0 * step[j])
            size_of_column = np.abs(expected).max() + FRICTION / max(size, EPSILON) * 1e-3
            np.testing.assert_allclose(derivatives[:, j], expected, rtol=0.0, atol=accuracy * size_of_column)


@pytest.mark.parametrize(
    ("points", "most"), [(CONTINUOUS, 25), (3, 25), (6, 25), (12, 25), (THREE_FEET, 100)]
)
def test_newtons_iteration_finds_the_creep_of_every_load_from_far_away(points, most):
    _, number, *_, last = contact_of(points)
    endless = RADIUS, number, FRICTION * 2.0**40, EPSILON * 2.0**40, NONE_HELD, last
    rng = np.random.default_rng(6)
    for _ in range(100):
        load = friction(endless, rng.normal(size=3) * SCALE * EPSILON)
        slip = rng.normal(size=3) * SCALE * EPSILON * 1000.0
        for _ in range(most):
            derivatives = ring_friction_derivatives(0.0, 0.0, ANGLE, slip[0], slip[1], 0.0, slip[2], endless)
            slip = slip + np.linalg.solve(derivatives[:3][:, [3, 4, 6]], load - friction(endless, slip))
            if np.abs(friction(endless, slip) - load).max() < 1e-6 * np.abs(load).max():
                break
        else:
            pytest.fail(f"no creep found for the load {load}")


@pytest.mark.parametrize("points", [3, 6, 24, THREE_FEET])
def test_creep_ends_on_the_limit_surface_also_where_a_point_carries_less_than_its_share(points):
    """A load is at the limit if its power is μN·P for one slip: the contact's slip minus that of a slow point."""
    contact, seen = contact_of(points), set()
    delta = point_regularisation(EPSILON, places_in(contact[5]))
    rng = np.random.default_rng(8)
    for _ in range(300):
        pole = RADIUS * (np.exp(1j * ANGLE) + 0.3 * complex(*rng.normal(size=2)))
        slip = np.array([pole.imag, -pole.real, 1.0])  # rotation about the pole
        slip *= EPSILON / mean_slip(contact, slip)
        load, slow = friction(contact, slip), slowest(contact, slip)
        ratio = abs(slow) / delta
        lost = slow * (1.0 if ratio < 1.0 else max(0.0, 4.0 - 3.0 * ratio))
        slip = slip - [lost.real, lost.imag, 0.0]
        assert -load @ slip == pytest.approx(FRICTION * mean_slip(contact, slip), rel=1e-10)
        seen.add("pivot" if ratio < 1.0 else "between" if ratio < 4.0 / 3.0 else "slip")
    assert seen == {"pivot", "between", "slip"}


@pytest.mark.parametrize("points", [3, 4, 6, 7, 24, THREE_FEET, ROD])
def test_no_two_points_are_slower_than_a_point_at_its_bend_while_the_contact_slips(points):
    places = ring_places(1.0, points) if isinstance(points, int) else points
    x, y, shares = np.array(places).T
    arms, rng = x + 1j * y, np.random.default_rng(4)
    # The worst poles lie near the middle between the two neighbouring points.
    apart = abs(np.subtract.outer(arms, arms)) + 1e3 * np.eye(len(arms))
    i, j = np.unravel_index(apart.argmin(), apart.shape)
    middle, noise = (arms[i] + arms[j]) / 2.0, 0.1 * abs(arms).max()
    poles = np.append(middle, middle + noise * (rng.normal(size=500) + 1j * rng.normal(size=500)))
    speeds = np.abs(arms - poles[:, None])
    bend = BEND * point_regularisation(1.0, places) * (speeds @ shares)
    second = np.sort(speeds, axis=1)[:, 1]
    assert np.all(second > bend)
    assert (bend / second).max() > 0.4  # so δ is not too small either
