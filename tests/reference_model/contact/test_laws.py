"""Properties of all contact laws at random slips, spins and angles, and their limits."""

import cmath
import math
from dataclasses import replace

import numpy as np
import pytest
from disc_equations import STICKY, eq_23
from hypothesis import given
from hypothesis import strategies as st

from reference_model import plain
from reference_model.contact.annulus import Annulus
from reference_model.contact.contact_law import Pin, Ring, ThreeTermRing
from reference_model.contact.points import Points, PointsOnRing

R = 0.12
RING = Ring(R)
LAWS = [
    Pin(),
    RING,
    ThreeTermRing(R),
    Annulus(0.05, R),
    Annulus(0.0, R, pressure=lambda r: 1.0 / r),
    *(PointsOnRing(R, points) for points in (3, 6, 7)),
    Points([(R, 0.0, 0.5), (-0.09, 0.03, 0.2), (-0.02, -0.08, 0.3)]),
]


def name(law):
    """Return the name of a law without the addresses of functions, because these differ between processes."""
    return f"{type(law).__name__}{' with pressure' if getattr(law, 'pressure', None) else ''}"


laws = pytest.mark.parametrize("law", LAWS, ids=name)
on_circle = pytest.mark.parametrize("law", LAWS[1:-1], ids=name)


@st.composite
def motions(draw):
    """Draw slip, relative spin and angle. The rim slips 1e-3 to 1e3 times as fast as the centre."""
    speed = 10.0 ** draw(st.floats(-2.0, 1.0))
    ratio = 10.0 ** draw(st.floats(-3.0, 3.0)) * draw(st.sampled_from([-1.0, 1.0]))
    return speed * cmath.exp(1j * draw(st.floats(-3.0, 3.0))), ratio * speed / R, draw(st.floats(-3.0, 3.0))


def friction(law, motion):
    force, moment = law.force_and_moment(*motion)
    return np.array((force.real, force.imag, moment / R))


def nearest_to_rest(law, motion):
    """Return the ratio of the slips of the slowest and the fastest point."""
    slip, spin, angle = motion
    if isinstance(law, Points):
        speeds = [abs(slip - 1j * spin * arm) for arm in law.arms(angle)]
        return min(speeds) / max(speeds)
    if isinstance(law, Pin | ThreeTermRing):
        return 1.0
    inner = law.inner_radius if isinstance(law, Annulus) else R
    slowest = max(abs(slip) - R * abs(spin), inner * abs(spin) - abs(slip), 0.0)
    return slowest / (abs(slip) + R * abs(spin))


PRINTED = [(law, plain.on_ring(1.0, R, law.points, 0.0)) for law in LAWS if isinstance(law, PointsOnRing)]
PRINTED += [
    (RING, plain.on_ring(1.0, R, 1024, 0.0)),
    (ThreeTermRing(R), eq_23(replace(STICKY, friction_force=1.0))),
]


@pytest.mark.parametrize(("law", "printed"), PRINTED, ids=[name(law) for law, _ in PRINTED])
@given(motion=motions())
def test_friction_is_that_of_20_and_23(law, printed, motion):
    slip, spin, angle = motion
    nearest = nearest_to_rest(law, motion)
    if law is RING and nearest < 0.05:
        return  # the error of 1024 points is of order ratio^1024
    x, y, moment = printed(slip.real, slip.imag, spin, angle)
    rounded = 1e-14 + 1e-15 / max(nearest, 1e-15)
    assert friction(law, motion) == pytest.approx((x, y, moment / R), abs=rounded)


@laws
@given(motion=motions(), other=motions())
def test_friction_obeys_the_principle_of_maximal_dissipation(law, motion, other):
    """Friction of any other slip takes less power. Friction of the opposite slip shows that it dissipates."""
    slip, spin, angle = motion
    other = (*other[:2], angle)
    taken, by_other = (friction(law, way) @ (slip.real, slip.imag, -R * spin) for way in (motion, other))
    assert taken <= by_other + 1e-13 * (abs(slip) + R * abs(spin))


@laws
@given(motion=motions(), turn=st.floats(-3.0, 3.0), factor=st.floats(-100.0, 100.0).map(lambda e: 10.0**e))
def test_friction_rotates_and_reflects_with_the_motion_and_does_not_depend_on_its_speed(
    law, motion, turn, factor
):
    slip, spin, angle = motion
    force, moment = law.force_and_moment(*motion)
    near = 1e-14 + 1e-15 / max(nearest_to_rest(law, motion), 1e-15)  # rounded direction

    def assert_same(other_motion, expected_force, expected_moment, law=law):
        found_force, found_moment = law.force_and_moment(*other_motion)
        assert abs(found_force - expected_force) < near
        assert abs(found_moment - expected_moment) < R * near

    rotated = cmath.exp(1j * turn)
    assert_same((slip * rotated, spin, angle + turn), force * rotated, moment)
    mirrored = Points([(x, -y, share) for x, y, share in law]) if isinstance(law, Points) else law
    assert_same((slip.conjugate(), -spin, -angle), force.conjugate(), -moment, mirrored)
    assert_same((-slip, spin, angle + math.pi), -force, moment)
    assert_same((slip * factor, spin * factor, angle), force, moment)
    if isinstance(law, PointsOnRing):
        assert_same((slip, spin, angle + 2.0 * math.pi / law.points), force, moment)
    elif not isinstance(law, Points):
        assert_same((slip, spin, angle + 1.0), force, moment)


@laws
@given(motion=motions())
def test_jacobian_is_the_derivative_of_friction_and_the_hessian_of_a_convex_potential(law, motion):
    distance = nearest_to_rest(law, motion)
    if distance < (0.1 if isinstance(law, Annulus) else 0.01):
        return  # differences are inaccurate near a resting point
    slip, spin, _ = motion
    size = max(abs(slip), R * abs(spin))
    found = law.jacobian(*motion)
    scaled = found * (1.0, 1.0, 1.0 / R, 1.0 / size) / np.array([[1.0], [1.0], [R]]) * size
    h = 1e-3 * min(distance, abs(slip) / size, 1.0)
    columns = []
    for shift in ((size, 0.0, 0.0), (1j * size, 0.0, 0.0), (0.0, size / R, 0.0), (0.0, 0.0, 1.0)):
        there = [
            friction(law, tuple(a + n * h * b for a, b in zip(motion, shift, strict=True)))
            for n in (-2, -1, 1, 2)
        ]
        columns.append(np.array((1.0, -8.0, 8.0, -1.0)) / (12.0 * h) @ there)
    # The step is 1e-3 of the distance to the next singularity; rounding errors are divided by it.
    assert scaled == pytest.approx(np.column_stack(columns), abs=1e-8 * np.abs(scaled).max() + 1e-14 / h)
    by_motion = scaled[:, :3] * (1.0, 1.0, -1.0)  # the spin of the disc is ω − S
    assert by_motion == pytest.approx(by_motion.T, abs=1e-12 * np.abs(by_motion).max())
    assert np.linalg.eigvalsh(by_motion).max() < 1e-12 * np.abs(by_motion).max()
    along = found @ (slip.real, slip.imag, spin, 0.0)
    assert along == pytest.approx(np.zeros(3), abs=1e-12 * np.abs(scaled).max())


@on_circle
@pytest.mark.parametrize("spin", [2.0, -2.0])
def test_pure_slip_meets_full_force_and_pure_spin_a_moment_and_a_damper(law, spin):
    slip = 0.3 - 0.4j
    force, moment = law.force_and_moment(slip, 1e-12 * spin, 0.7)
    assert force == pytest.approx(-0.6 + 0.8j, abs=1e-11)
    assert moment == pytest.approx(0.0, abs=1e-11)
    # The moment is that of the mean radius. A small slip meets the mean of 1/(2r|S|).
    pure, most = law.force_and_moment(0j, spin, 0.7)
    radius = most * math.copysign(1.0, spin)
    assert pure == pytest.approx(0.0, abs=1e-15)
    exact = {RING: R, LAWS[3]: 2.0 / 3.0 * (R**3 - 0.05**3) / (R**2 - 0.05**2), LAWS[4]: R / 2.0}
    assert radius == pytest.approx(exact.get(law, R), rel=1e-13)
    if law is not LAWS[4]:  # points near the axis always slip
        damper = 1.0 / (R + 0.05) if law is LAWS[3] else 1.0 / (2.0 * R)
        slow, _ = law.force_and_moment(1e-6 * R * slip, spin, 0.7)
        assert slow == pytest.approx(-1e-6 * R * slip * damper / abs(spin), rel=1e-4)


@laws
def test_at_rest_friction_is_zero_and_the_derivative_is_refused(law):
    assert law.force_and_moment(0j, 0.0, 0.4) == (0j, 0.0)
    with pytest.raises(ValueError, match="at rest"):
        law.jacobian(0j, 0.0, 0.4)
    if isinstance(law, Points):
        with pytest.raises(ValueError, match="a point is at rest"):
            law.jacobian(1j * law.arms(0.4)[2], 1.0, 0.4)
    if law is RING:
        with pytest.raises(ValueError, match=r"slip = 0\.24 m/s = radius·\|relative spin\|"):
            law.jacobian(R * 2.0j, -2.0, 0.0)


@pytest.mark.parametrize("law", [PointsOnRing(R, 3), PointsOnRing(R, 24), LAWS[-1]])
@given(motion=motions())
def test_friction_of_one_point_and_of_the_others_adds_up_to_the_total(law, motion):
    slip, spin, angle = motion
    arm = law.arm(1, angle)
    own = slip - 1j * spin * arm
    if nearest_to_rest(law, motion) < 1e-6:
        return
    force, moment = law.friction_of_others(1, own, spin, angle)
    friction_of_point = -own / abs(own) * law.shares[1]
    total = law.force_and_moment(slip, spin, angle)
    noise = 1e-14 + 1e-15 / nearest_to_rest(law, motion)
    assert abs(force + friction_of_point - total[0]) < noise
    assert abs(moment + (arm.conjugate() * friction_of_point).imag - total[1]) < R * noise
