import math
from itertools import pairwise

import mpmath
import numpy as np
import pytest

from exudyn_models.forces import friction_laws
from exudyn_models.forces.friction_laws import (
    CONTINUOUS,
    NONE_HELD,
    point_regularisation,
    ring_friction,
    ring_friction_derivatives,
)
from exudyn_models.forces.slip_potential import (
    ring_potential_curvatures,
    ring_potential_slopes,
    ring_potentials,
)
from reference_model.contact.contact_law import PointsOnRing, Ring

RADIUS, FRICTION, EPSILON = 0.12, 0.5, 1e-4
CONTACTS = {n: (RADIUS, n or CONTINUOUS, FRICTION, EPSILON, NONE_HELD, RADIUS) for n in (None, 3, 6, 12, 24)}


def on_disc(contact, slip, angle=0.3):
    """Force and moment for a slip (u_x, u_y, φ̇ − ω) over a master disc at rest."""
    return np.array(ring_friction(0.0, 0.0, angle, slip[0], slip[1], 0.0, slip[2], contact)[:3])


def exact_slopes(speed, rim):
    u, w = mpmath.mpf(speed), mpmath.mpf(rim)
    if u == w:
        return 2 / mpmath.pi, 2 / mpmath.pi
    m = 4 * u * w / (u + w) ** 2
    e, k = (u + w) * mpmath.ellipe(m), (u - w) * mpmath.ellipk(m)
    return (e + k) / (mpmath.pi * u), (e - k) / (mpmath.pi * w)


def relative_error(speed, rim):
    with mpmath.workdps(100):  # the exact form loses twice as many digits as the ratio has
        pairs = zip(ring_potential_slopes(speed, rim), exact_slopes(speed, rim), strict=True)
        return max(float(abs(found - exact) / exact) for found, exact in pairs)


def test_law_of_the_ring_has_thirteen_digits_wherever_it_is_regular():
    rng = np.random.default_rng(0)
    ratios = 10.0 ** rng.uniform(-16.0, 16.0, 1500)
    near = 1.0 + rng.choice([-1.0, 1.0], 1000) * 10.0 ** rng.uniform(-11.9, -0.5, 1000)
    for ratio, speed in zip((*ratios, *near), 10.0 ** rng.uniform(-3.0, 3.0, 2500), strict=True):
        assert relative_error(speed, speed * ratio) < 1e-13


@pytest.mark.parametrize("distance", [0.0, 1e-16, 3e-16, 1e-15, 1e-14, 1e-13, 1e-12])
@pytest.mark.parametrize("sign", [-1.0, 1.0])
def test_law_of_the_ring_has_nine_digits_where_a_point_of_it_is_at_rest(distance, sign):
    assert relative_error(1.7, 1.7 * (1.0 + sign * distance)) < 1e-9


@pytest.mark.parametrize(
    ("speed", "rim", "expected"),
    [
        (0.0, 2.0, (0.0, 1.0)),
        (2.0, 0.0, (1.0, 0.0)),
        (1.0, 1e-300, (1.0, 0.5e-300)),
        (1e-300, 1.0, (0.5e-300, 1.0)),
        (1e308, 1.0, (1.0, 0.5e-308)),
        (5e-324, 5e-324, (2.0 / math.pi, 2.0 / math.pi)),
    ],
)
def test_law_of_the_ring_at_extreme_ratios(speed, rim, expected):
    assert ring_potential_slopes(speed, rim) == pytest.approx(expected, rel=1e-14, abs=0.0)


def test_curvatures_of_the_mean_slip_are_derivatives_of_its_slopes():
    rng = np.random.default_rng(1)
    for speed, rim in 10.0 ** rng.uniform(-1.0, 1.0, (30, 2)):
        with mpmath.workdps(60):
            exact = [
                mpmath.diff(lambda u, w: exact_slopes(u, w)[0], (speed, rim), order)
                for order in ((1, 0), (0, 1))
            ]
            exact.append(mpmath.diff(lambda w, u=speed: exact_slopes(u, w)[1], rim))
        assert ring_potential_curvatures(speed, rim) == pytest.approx([float(v) for v in exact], rel=1e-11)


def test_curvature_stays_finite_where_it_is_infinite_and_grows_up_to_there():
    at = [ring_potential_curvatures(1.0, 1.0 - d)[2] for d in (1e-3, 1e-6, 1e-9, 1e-12, 0.0)]
    # (1/π)·ln(1/d) and a constant, bounded at a distance of 1e-15.
    np.testing.assert_allclose(np.diff(at), math.log(1e3) / math.pi, rtol=0.02)
    assert ring_potential_curvatures(1.0, 1.0)[0] > 0.0


@pytest.mark.parametrize("points", [None, 3, 6, 24])
def test_law_is_that_of_coulomb_where_all_slip_is_fast(points):
    exact = Ring(RADIUS) if points is None else PointsOnRing(RADIUS, points)
    rng = np.random.default_rng(2)
    for _ in range(100):
        slip, angle = rng.normal(size=3) * [1.0, 1.0, 8.0], rng.uniform(-9.0, 9.0)
        force, moment = exact.force_and_moment(complex(*slip[:2]), -slip[2], angle)
        found = on_disc(CONTACTS[points], slip, angle)
        expected = FRICTION * np.array([force.real, force.imag, moment])
        np.testing.assert_allclose(found, expected, rtol=0.0, atol=1e-14 * FRICTION)


def arms_of(points, angle=0.3):
    return RADIUS * np.exp(1j * (angle + 2.0 * np.pi * np.arange(points) / points))


def slips_of(points, slip):
    return complex(*slip[:2]) + 1j * slip[2] * arms_of(points)


@pytest.mark.parametrize("points", [None, 3, 6, 24])
def test_creep_as_a_whole_is_viscous_up_to_the_limit_of_coulomb_friction(points):
    rng = np.random.default_rng(3)
    for _ in range(100):
        slip = rng.normal(size=3) * [1.0, 1.0, 1.0 / RADIUS]
        if points is None:
            mean = ring_potentials(np.array([math.hypot(*slip[:2])]), RADIUS * slip[2:])[0]
        else:
            mean = np.abs(slips_of(points, slip)).mean()
        slip *= EPSILON / mean
        limit = on_disc(CONTACTS[points], slip)
        if points is None:
            exact = Ring(RADIUS).force_and_moment(complex(*slip[:2]), -slip[2], 0.3)
            expected = FRICTION * np.array([exact[0].real, exact[0].imag, exact[1]])
            np.testing.assert_allclose(limit, expected, rtol=1e-12, atol=1e-15)
        for share in (1.0 - 1e-15, 0.3, 1e-6):
            found = on_disc(CONTACTS[points], share * slip)
            np.testing.assert_allclose(found, share * limit, rtol=1e-11, atol=1e-13 * share)


@pytest.mark.parametrize("points", [3, 6, 24])
def test_force_at_the_end_of_creep_is_on_the_limit_surface_also_where_a_point_carries_less_than_its_share(
    points,
):
    """A load is held if its power is less than μN·P for every slip, and just held if it is equal for one."""
    delta = point_regularisation(EPSILON, points)
    rng = np.random.default_rng(8)
    seen = set()
    others = rng.normal(size=(2000, 3)) * [1.0, 1.0, 1.0 / RADIUS]
    powers = FRICTION * np.abs([slips_of(points, other) for other in others]).mean(axis=1)
    for _ in range(300):
        pole = arms_of(points)[0] + RADIUS * 0.3 * complex(*rng.normal(size=2))
        slip = np.array([pole.imag, -pole.real, 1.0])  # a turn about the pole
        slip *= EPSILON / np.abs(slips_of(points, slip)).mean()
        load = on_disc(CONTACTS[points], slip)
        slips = slips_of(points, slip)
        slowest = slips[np.abs(slips).argmin()]
        ratio = abs(slowest) / delta
        lost = slowest * (1.0 if ratio < 1.0 else max(0.0, 4.0 - 3.0 * ratio))
        slip = slip - [lost.real, lost.imag, 0.0]
        power = FRICTION * np.abs(slips_of(points, slip)).mean()
        assert -load @ slip == pytest.approx(power, rel=1e-10)
        assert np.all(-others @ load <= powers * (1.0 + 1e-12))
        seen.add("pivot" if ratio < 1.0 else "between" if ratio < 4.0 / 3.0 else "slip")
    assert seen == {"pivot", "between", "slip"}


@pytest.mark.parametrize("points", [3, 4, 6, 7, 24])
def test_no_two_points_are_slower_than_a_point_at_its_bend_while_the_contact_slips(points):
    rng = np.random.default_rng(4)
    around = np.exp(2j * np.pi * np.arange(points) / points)
    # Slip about a pole: the worst ones lie near the middle between two points next to each other.
    poles = (around[0] + around[1]) / 2.0 + 0.1 * (rng.normal(size=500) + 1j * rng.normal(size=500))
    speeds = np.sort(np.abs(around - np.append(poles, (around[0] + around[1]) / 2.0)[:, None]), axis=1)
    bend = friction_laws.BEND * point_regularisation(1.0, points) * speeds.mean(axis=1)
    assert np.all(speeds[:, 1] > bend)
    assert bend.max() > 0.4 * speeds[-1, 1]  # and δ is not needlessly small


@pytest.mark.parametrize("points", [None, 1, 3, 6])
@pytest.mark.parametrize("size", [1.0, 1e-6], ids=["slip", "creep"])
@pytest.mark.parametrize("held", [NONE_HELD, 0])
def test_derivatives_are_those_of_the_law(points, size, held):
    contact = (RADIUS, points or CONTINUOUS, FRICTION, EPSILON, held, RADIUS)
    rng = np.random.default_rng(5)
    for _ in range(20):
        slip = rng.normal(size=3) * [1.0, 1.0, 8.0] * size
        arguments = np.array([0.0, 0.0, rng.uniform(-3.0, 3.0), slip[0], slip[1], 0.0, slip[2]])
        derivatives = ring_friction_derivatives(*arguments, contact)
        secant = secant_of(contact, slip, arguments[2]) if size < 1.0 and points not in (None, 1) else None
        for j, scale in ((2, 1.0), (3, size), (4, size), (6, 8.0 * size)):
            step = np.zeros(7)
            step[j] = 1e-6 * scale
            plus, minus = (np.array(ring_friction(*(arguments + sign * step), contact)) for sign in (1, -1))
            expected = (plus - minus) / (2.0 * step[j])
            if secant is not None and j > 2:
                column = (3, 4, 6).index(j)
                share = friction_laws.SECANT
                expected[:3] = (1.0 - share) * expected[:3] + share * secant[:, column]
                expected[3] = -expected[2]
            size_of_column = np.abs(expected).max() + FRICTION / max(size, EPSILON) * 1e-3
            np.testing.assert_allclose(derivatives[:, j], expected, rtol=0.0, atol=1e-6 * size_of_column)


def secant_of(contact, slip, angle):
    """K of F = K·slip while the contact creeps as a whole: every point's own viscosity, on its arm."""
    radius, points, friction, epsilon, held, _ = contact
    alpha = angle + 2.0 * np.pi * np.arange(points) / points
    lever = np.array([-radius * np.sin(alpha), radius * np.cos(alpha)])
    velocity = slip[:2, None] + slip[2] * lever
    speed = np.hypot(*velocity)
    creep, delta = speed.mean() / epsilon, point_regularisation(epsilon, points)
    viscosity = friction / points * creep / np.maximum(speed, delta * creep)
    if held >= 0:
        viscosity[held] = friction / points / delta
    maps = np.array([np.vstack((np.eye(2), lever[:, i])).T for i in range(points)])
    return -np.einsum("kai,k,kaj->ij", maps, viscosity, maps)


@pytest.mark.parametrize("points", [None, 3, 6, 12])
def test_newtons_iteration_finds_the_creep_of_every_load_from_far_away(points):
    contact = CONTACTS[points]
    rng = np.random.default_rng(6)
    endless = (*contact[:2], contact[2] * 2.0**40, contact[3] * 2.0**40, *contact[4:])
    scale = np.array([1.0, 1.0, 1.0 / RADIUS]) * EPSILON
    for _ in range(100):
        load = on_disc(endless, rng.normal(size=3) * scale)
        slip = rng.normal(size=3) * scale * 1000.0
        for _ in range(25):
            derivatives = ring_friction_derivatives(0.0, 0.0, 0.3, slip[0], slip[1], 0.0, slip[2], endless)
            slip = slip + np.linalg.solve(derivatives[:3][:, [3, 4, 6]], load - on_disc(endless, slip))
            if np.abs(on_disc(endless, slip) - load).max() < 1e-6 * np.abs(load).max():
                break
        else:
            pytest.fail(f"no creep found for the load {load}")


@pytest.mark.parametrize("points", [None, 3, 6])
def test_more_slip_in_a_direction_never_meets_less_friction(points):
    rng = np.random.default_rng(7)
    for direction in rng.normal(size=(30, 3)) * [1.0, 1.0, 1.0 / RADIUS]:
        amounts = np.geomspace(1e-3, 1e3, 61) * EPSILON
        power = [-on_disc(CONTACTS[points], a * direction) @ direction for a in amounts]
        assert power[0] > 0.0
        assert all(after >= before - 1e-15 for before, after in pairwise(power))
