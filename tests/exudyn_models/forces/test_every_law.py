"""Properties of the friction of every contact at random slips, in the reference, in Exudyn and in C.

P is the mean slip speed. With μN = 1 N, force and moment F dissipate the power −F·slip = P, and −F·v <= P(v) for any
other slip v. In Exudyn and in C friction is viscous near rest: where P < ε the contact creeps, and F is its value at
P = ε times P/ε. In C each of several points is regularised separately.
"""

import ctypes
import functools
import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
import pytest
from contact_in_c import Contact, Three

from exudyn_models.forces.friction_laws import (
    CONTINUOUS,
    NONE_HELD,
    mean_radius,
    ring_friction,
    ring_friction_derivatives,
    slip_potential_of_contact,
)
from exudyn_models.forces.jit import KeptOnDisk
from exudyn_models.forces.laws.places import BEND, point_regularisation, ring_places, table_of
from exudyn_models.forces.laws.pressures import density_of
from reference_model.contact import Annulus, Pin, Points, Ring

INNER, RADIUS, EPSILON, ANGLE = 0.08, 0.12, 1e-4, 0.3
friction_of, derivatives_of, potential_of = map(
    KeptOnDisk, (ring_friction, ring_friction_derivatives, slip_potential_of_contact)
)


def uniform(radius):
    return 1.0


def worn(radius):
    return 1.0 / radius


def towards_the_rim(radius):
    return 1.0 + 200.0 * radius**2


PIN = ((0.0, 0.0, 1.0),)
THREE_FEET = ((0.12, 0.0, 0.2), (-0.03, 0.07, 0.5), (-0.04, -0.03, 0.3))
ROD = ((-0.12, 0.0, 0.3), (-0.02, 0.0, 0.3), (0.05, 0.0, 0.1), (0.12, 0.0, 0.3))
ON_RING = {f"{n} points": ring_places(RADIUS, n) for n in (3, 6, 24)}
CIRCLES = {
    "ring": (RADIUS, RADIUS, uniform),
    "annulus": (INNER, RADIUS, uniform),
    "full disc": (0.0, RADIUS, uniform),
    "worn annulus": (INNER, RADIUS, worn),
    "pressed at the rim": (INNER, RADIUS, towards_the_rim),
}
SHAPES = {"pin": PIN, **ON_RING, "three feet": THREE_FEET, "rod": ROD, **CIRCLES}
"""Places and shares of points, or inner and outer radius and pressure of circles."""


@dataclass(frozen=True)
class Law:
    """Friction of a ``shape`` for μN = 1 N; ``on`` returns (F_x, F_y, M) for a slip (u_x, u_y, φ̇ − ω) and an angle.

    The contact as a whole is viscous below ``epsilon``, and each of several points below ``point_epsilon``.
    """

    shape: Any
    on: Callable[..., Any]
    epsilon: float = 0.0
    point_epsilon: float = 0.0

    @property
    def of_points(self):
        return self.shape not in (PIN, *CIRCLES.values())

    def __call__(self, slip, angle=ANGLE):
        return np.array(self.on(np.asarray(slip, dtype=float), angle))

    def mean(self, slip):
        """Return P, because the power of a slip far beyond ε is P."""
        return -self(np.multiply(slip, 1e3 / np.abs(slip).max())) @ slip

    def creep(self, mean):
        return min(1.0, mean / self.epsilon) if self.epsilon else 1.0

    def yields(self, slip):
        """Return whether a single point is so slow that it is viscous."""
        creep = self.creep(self.mean(slip))
        return self.of_points and abs(slowest(self.shape, slip)) < self.point_epsilon * creep


def slowest(places, slip, angle=ANGLE):
    """Return the slip of the slowest point as a complex number."""
    x, y, _ = np.transpose(places)
    all_slips = complex(*slip[:2]) + 1j * slip[2] * np.exp(1j * angle) * (x + 1j * y)
    return all_slips[np.abs(all_slips).argmin()]


def in_reference(shape, _):
    if shape == PIN:
        law = Pin()
    elif shape[-1] not in (uniform, worn, towards_the_rim):
        law = Points(shape)
    else:
        inner, outer, pressure = shape
        law = Ring(outer) if inner == outer else Annulus(inner, outer, pressure=pressure)

    def on(slip, angle):
        force, moment = law.force_and_moment(complex(*slip[:2]), -slip[2], angle)
        return force.real, force.imag, moment

    return Law(shape, on)


def contact_of(shape, friction=1.0, epsilon=EPSILON, held=NONE_HELD):
    """Return the contact of a shape in Exudyn."""
    if not callable(shape[-1]):
        return (
            max(math.hypot(x, y) for x, y, _ in shape),
            len(shape),
            friction,
            epsilon,
            held,
            table_of(shape),
        )
    inner, outer, pressure = shape
    named = {uniform: "uniform", worn: "wear"}.get(pressure, pressure)
    return outer, density_of(named, inner, outer), friction, epsilon, held, inner


def in_exudyn(shape, _):
    contact = contact_of(shape)

    def on(slip, angle):
        return friction_of(0.0, 0.0, angle, slip[0], slip[1], 0.0, slip[2], contact)[:3]

    delta = BEND * point_regularisation(EPSILON, shape) if not callable(shape[-1]) else 0.0
    return Law(shape, on, EPSILON, delta)


def in_c(shape, library):
    inner, outer, pressure = shape if callable(shape[-1]) else (max(x for x, *_ in shape),) * 2 + (uniform,)
    points = len(shape) if shape != PIN and not callable(shape[-1]) else 0
    factors = [pressure(r) for r in (inner, (inner + outer) / 2.0, outer)] if pressure != worn else [1.0] * 3

    def on(slip, angle):
        contact = Contact(inner, outer, points, angle, pressure == worn, Three(*factors), 1.0, 1.0, EPSILON)
        force = Three()
        library.friction(ctypes.byref(contact), Three(*slip), force, ctypes.byref(ctypes.c_double()))
        return list(force)

    return Law(shape, on, 0.0 if points else EPSILON, EPSILON)


IMPLEMENTATIONS = {"reference": in_reference, "exudyn": in_exudyn, "c": in_c}
EVERY = pytest.mark.parametrize(
    ("implementation", "shape"),
    [
        (one, name)
        for one in IMPLEMENTATIONS
        for name in SHAPES
        if one != "c" or name not in ("three feet", "rod")
    ],
)


@pytest.fixture
def make(implementation, request):
    """Return a function that makes the law of a shape."""
    library = request.getfixturevalue("library")("clutch") if implementation == "c" else None
    return lambda shape: IMPLEMENTATIONS[implementation](shape, library)


@pytest.fixture
def law(make, shape):
    return make(SHAPES[shape])


SCALE = np.array([1.0, 1.0, 1.0 / RADIUS])


def slips(count=60, largest=4.0):
    """Return slips in any direction from 1e-3·ε to 10^largest·ε, some with a point of the rim at rest."""
    rng = np.random.default_rng(7)
    found = rng.normal(size=(count, 3)) * SCALE
    found[::5, 2] = np.hypot(found[::5, 0], found[::5, 1]) / RADIUS  # U = R·S
    return found * EPSILON * 10.0 ** rng.uniform(-3.0, largest, (count, 1))


@EVERY
def test_friction_takes_the_power_of_the_mean_slip_and_no_other_slip_would_meet_more(law):
    """This bounds the force by μN, the moment by μN·R, and any mixture by the limit surface."""
    others = slips(200, 0.0)
    limits = np.array([law.mean(other) for other in others])
    for slip in slips():
        load, mean = law(slip), law.mean(slip)
        most = mean * law.creep(mean)
        assert 0.0 < -load @ slip <= most * (1.0 + 1e-9)
        assert law.yields(slip) or -load @ slip == pytest.approx(most, rel=1e-9)
        assert np.all(-others @ load <= limits * (1.0 + 1e-9))
        assert math.hypot(*load[:2]) <= 1.0 + 1e-12
        assert abs(load[2]) <= RADIUS * (1.0 + 1e-12)


@EVERY
def test_a_turned_mirrored_or_reversed_slip_meets_friction_of_the_same_kind(law, make):
    turn, mirror = 0.9, np.array([1.0, -1.0, -1.0])
    image = make(tuple((x, -y, share) for x, y, share in law.shape)) if law.of_points else law
    size = 1e-11 * np.array([1.0, 1.0, RADIUS])
    for slip in slips():
        x, y, moment = law(slip)
        z, force = complex(*slip[:2]) * np.exp(1j * turn), complex(x, y) * np.exp(1j * turn)
        turned = law([z.real, z.imag, slip[2]], ANGLE + turn)
        assert np.all(abs(turned - [force.real, force.imag, moment]) <= size)
        assert np.all(abs(image(mirror * slip, -ANGLE) - mirror * [x, y, moment]) <= size)
        assert np.all(abs(np.add(law(-slip), [x, y, moment])) <= size)


@functools.cache
def rings_of(inner, outer, pressure):
    """Return radii in m and load shares of 60 rings, or of one."""
    if inner == outer:
        return np.array([outer]), np.ones(1)
    places, weights = np.polynomial.legendre.leggauss(60)
    radii = inner + (outer - inner) * (0.5 + 0.5 * places)
    weights = weights * [radius * pressure(radius) for radius in radii]
    return radii, weights / weights.sum()


def lever_of(shape):
    """Return the moment of pure spin in m."""
    if callable(shape[-1]):
        radii, weights = rings_of(*shape)
        return float(radii @ weights)
    return sum(share * math.hypot(x, y) for x, y, share in shape)


@EVERY
def test_pure_slip_meets_the_whole_force_and_pure_spin_the_whole_moment(law):
    """Only a contact whose load is symmetric about the centre has no moment in translation and no force in spin."""
    x, y, shares = np.transpose(law.shape) if law.of_points else np.zeros((3, 1))
    arms = np.exp(1j * ANGLE) * (x + 1j * y)
    moment = np.sum(shares * arms.conjugate() * (-0.6 + 0.8j)).imag
    np.testing.assert_allclose(law([3.0, -4.0, 0.0]), [-0.6, 0.8, moment], atol=1e-14)
    force = -1j * np.sum(shares * arms / np.maximum(abs(arms), 1e-300))
    for spin in (7.0, -7.0):
        expected = np.sign(spin) * np.array([force.real, force.imag, -lever_of(law.shape)])
        np.testing.assert_allclose(law([0.0, 0.0, spin]), expected, atol=1e-14)
    np.testing.assert_array_equal(law([0.0] * 3), [0.0] * 3)


@EVERY
def test_a_contact_that_slips_feels_the_direction_alone_and_one_that_creeps_the_amount_too(law):
    for slip in slips():
        at_limit = slip * (law.epsilon or EPSILON) / law.mean(slip)
        limit = law(at_limit)
        for share in (1e-6, 0.3, 1.0 - 1e-15, 1e3):
            creep = law.creep(share * EPSILON)
            if law.of_points and creep == 1.0:
                continue  # single points are still viscous near rest
            expected = creep * limit
            np.testing.assert_allclose(
                law(share * at_limit), expected, rtol=1e-9, atol=1e-12 * min(1.0, share)
            )


@EVERY
def test_more_slip_in_a_direction_never_meets_less_friction(law):
    for direction in slips(30, 0.0):
        amounts = np.geomspace(1.0, 1e6, 61) * EPSILON / np.abs(direction / SCALE).max() * 1e-3
        power = [-law(amount * direction) @ direction for amount in amounts]
        assert power[0] > 0.0
        assert np.all(np.diff(power) >= -1e-12 * max(power))


def errors_against_the_ring(make, shapes, slip):
    ring = make(CIRCLES["ring"])(slip)
    return np.array([np.abs(make(shape)(slip) - ring).max() for shape in shapes])


@pytest.mark.parametrize("implementation", IMPLEMENTATIONS)
def test_points_become_the_ring_faster_than_any_power_and_an_annulus_with_the_square_of_its_width(make):
    points = [ring_places(RADIUS, n) for n in (4, 8, 16, 32, 64)]
    errors = errors_against_the_ring(make, points, [0.3, -0.2, 1.0])
    ratios = errors[1:-1] / errors[:-2]
    assert np.all(np.diff(ratios) < 0.0), errors
    assert errors[-1] < 1e-13
    annuli = [(RADIUS - d, RADIUS + d, uniform) for d in (4e-3, 2e-3, 1e-3)]
    for slip in ([0.06, 0.0, 1.0], [0.36, 0.0, 1.0]):
        errors = errors_against_the_ring(make, annuli, slip)
        np.testing.assert_allclose(np.log2(errors[:-1] / errors[1:]), 2.0, atol=0.05)


@EVERY
@pytest.mark.parametrize(
    ("slip", "accuracy"),
    [
        ((0.3, -0.2, 1.0), 1e-12),  # every point slips
        ((0.01, 0.02, -4.0), 1e-12),
        ((0.2, 0.1, 2.5), 2e-4),  # with a resting point the sum is less accurate
    ],
)
def test_friction_is_the_sum_over_its_points(law, slip, accuracy):
    if law.shape == CIRCLES["full disc"]:
        accuracy = 2e-4  # one of its points is always nearly at rest
    if callable(law.shape[-1]):
        radii, weights = rings_of(*law.shape)
        arms = np.outer(radii, np.exp(1j * (ANGLE + 2.0 * np.pi * np.arange(4000) / 4000)))
        weights = np.array(weights)[:, None] / 4000
    else:
        x, y, weights = np.transpose(law.shape)
        arms = np.exp(1j * ANGLE) * (x + 1j * y)
    each = complex(*slip[:2]) + 1j * slip[2] * arms
    pushes = -weights * each / np.abs(each)
    expected = [pushes.sum().real, pushes.sum().imag, np.sum((arms.conjugate() * pushes).imag)]
    np.testing.assert_allclose(law(slip), expected, rtol=0.0, atol=accuracy)


@pytest.mark.parametrize("shape", SHAPES.values(), ids=SHAPES)
def test_the_effective_radius_is_the_lever_of_pure_spin(shape):
    assert mean_radius(contact_of(shape)) == pytest.approx(lever_of(shape), rel=1e-13)


def friction_in(contact, slip):
    return np.array(friction_of(0.0, 0.0, ANGLE, slip[0], slip[1], 0.0, slip[2], contact)[:3])


CONTACTS = {name: contact_of(shape) for name, shape in SHAPES.items() if name != "24 points"}
HELD = {f"{name}, one held": contact_of(SHAPES[name], held=0) for name in ("6 points", "three feet")}


@pytest.mark.parametrize("contact", [*CONTACTS.values(), *HELD.values()], ids=[*CONTACTS, *HELD])
@pytest.mark.parametrize("size", [1.0, 1e-6], ids=["slip", "creep"])
def test_derivatives_match_differences_of_friction(contact, size):
    """The exception is the slip of points that creep as a whole: it contains a share of the secant, for Newton."""
    rng = np.random.default_rng(5)
    blended = size < 1.0 and contact[1] > 1
    # Twelve rings have an error of 5e-7 of an annulus's largest curvature, and a derivative adds several curvatures.
    accuracy = 1e-6 if contact[1] > CONTINUOUS or contact[5] == contact[0] else 1e-5
    for _ in range(20):
        slip = rng.normal(size=3) * [1.0, 1.0, 8.0] * size
        arguments = np.array([0.0, 0.0, rng.uniform(-3.0, 3.0), slip[0], slip[1], 0.0, slip[2]])
        derivatives = derivatives_of(*arguments, contact)
        for j, scale in ((2, 1.0), (3, size), (4, size), (6, 8.0 * size))[: 1 if blended else 4]:
            step = np.zeros(7)
            step[j] = 1e-6 * scale
            plus, minus = (np.array(friction_of(*(arguments + sign * step), contact)) for sign in (1, -1))
            expected = (plus - minus) / (2.0 * step[j])
            size_of_column = np.abs(expected).max() + 1.0 / max(size, EPSILON) * 1e-3
            np.testing.assert_allclose(derivatives[:, j], expected, rtol=0.0, atol=accuracy * size_of_column)


@pytest.mark.parametrize(
    ("shape", "most"), [("ring", 25), ("3 points", 25), ("6 points", 25), ("three feet", 100)]
)
def test_newtons_iteration_finds_the_creep_of_every_load_from_far_away(shape, most):
    endless = contact_of(SHAPES[shape], 2.0**40, EPSILON * 2.0**40)
    rng = np.random.default_rng(6)
    for _ in range(100):
        load = friction_in(endless, rng.normal(size=3) * SCALE * EPSILON)
        slip = rng.normal(size=3) * SCALE * EPSILON * 1000.0
        for _ in range(most):
            derivatives = derivatives_of(0.0, 0.0, ANGLE, slip[0], slip[1], 0.0, slip[2], endless)
            slip = slip + np.linalg.solve(derivatives[:3][:, [3, 4, 6]], load - friction_in(endless, slip))
            if np.abs(friction_in(endless, slip) - load).max() < 1e-6 * np.abs(load).max():
                break
        else:
            pytest.fail(f"no creep found for the load {load}")


@pytest.mark.parametrize("shape", ["3 points", "6 points", "24 points", "three feet"])
def test_creep_ends_on_the_limit_surface_also_where_a_point_carries_less_than_its_share(shape):
    """A load is at the limit if its power is μN·P for one slip: the contact's slip minus that of a slow point."""
    places, seen = SHAPES[shape], set()
    contact, delta = contact_of(places), point_regularisation(EPSILON, places)
    rng = np.random.default_rng(8)
    for _ in range(300):
        pole = RADIUS * (np.exp(1j * ANGLE) + 0.3 * complex(*rng.normal(size=2)))
        slip = np.array([pole.imag, -pole.real, 1.0])  # rotation about the pole
        slip *= EPSILON / potential_of(*slip, ANGLE, contact)
        load, slow = friction_in(contact, slip), slowest(places, slip)
        ratio = abs(slow) / delta
        lost = slow * (1.0 if ratio < 1.0 else max(0.0, 4.0 - 3.0 * ratio))
        slip = slip - [lost.real, lost.imag, 0.0]
        assert -load @ slip == pytest.approx(potential_of(*slip, ANGLE, contact), rel=1e-10)
        seen.add("pivot" if ratio < 1.0 else "between" if ratio < 4.0 / 3.0 else "slip")
    assert seen == {"pivot", "between", "slip"}
