"""The limit surface, against friction in slip, sampled slips and closed forms."""

import math

import numpy as np
import pytest

from reference_model.contact import (
    Annulus,
    Pin,
    Points,
    PointsOnRing,
    Ring,
    ThreeTermRing,
    largest_wrench,
    wrench_of_slip,
)
from reference_model.contact.limit_surface import PointsLimit

RADIUS = 0.3
FEET = Points([(0.3, 0.0, 0.5), (-0.2, 0.1, 0.2), (-0.1, -0.2, 0.3)])
ROD = Points([(-0.3, 0.0, 0.2), (-0.1, 0.0, 0.3), (0.0, 0.0, 0.1), (0.3, 0.0, 0.4)])
TWO = Points([(-0.1, 0.0, 0.3), (0.3, 0.0, 0.7)])
CONTACTS = {f"{n} points": PointsOnRing(RADIUS, n) for n in (3, 6, 24)}
CONTACTS |= {"three feet": FEET, "rod": ROD, "two points": TWO}


@pytest.mark.parametrize("law", CONTACTS.values(), ids=CONTACTS)
def test_force_and_moment_of_any_slip_lie_on_the_limit_surface(law):
    limit, rng = PointsLimit.of(law), np.random.default_rng(6)
    for _ in range(40):
        u, w = complex(*rng.normal(size=2)) * RADIUS, rng.normal()
        force, moment = law.force_and_moment(u, -w, 0.0)
        # The held load is opposite to friction. Margins are quadratic in the load.
        assert limit.margins(np.array([-force]), -moment)[0] == pytest.approx(0.0, abs=1e-12)
        direction, sense = limit.direction(-force, -moment)
        # The equations are nearly singular for points on a line.
        error = 1e-5 if law in (ROD, TWO) else 3e-9
        assert direction / sense == pytest.approx(u / w, rel=error, abs=0.0)
        assert limit.margins(np.array([-0.999 * force]), -0.999 * moment)[0] > 0.0
        assert limit.margins(np.array([-1.001 * force]), -1.001 * moment)[0] < 0.0


SOME = pytest.mark.parametrize("law", [CONTACTS["3 points"], FEET, ROD])


@SOME
def test_friction_holds_a_load_if_no_slip_gains_power(law):
    limit = PointsLimit.of(law)
    rng = np.random.default_rng(7)
    slips = rng.normal(size=(4000, 3)) * [RADIUS, RADIUS, 1.0]
    # Slips with one point at rest are kinks of the mean slip speed, where breakaway is most likely.
    pivots = [(-1j * w * arm, w) for arm in law.arms(0.0) for w in (1.0, -1.0)]
    u = np.concatenate((slips[:, 0] + 1j * slips[:, 1], [slip for slip, _ in pivots]))
    w = np.concatenate((slips[:, 2], [turn for _, turn in pivots]))
    taken = abs(u[:, None] + 1j * w[:, None] * np.array(law.arms(0.0))) @ law.shares
    decided = 0
    for _ in range(300):
        force, moment = complex(*rng.uniform(-0.8, 0.8, 2)), RADIUS * rng.uniform(-1.0, 1.0)
        surplus = np.max(((force.conjugate() * u).real + moment * w) / taken)
        if abs(surplus - 1.0) > 0.01:  # 4000 slips leave gaps of some 0.05 rad
            assert (limit.margins(np.array([force]), moment)[0] > 0.0) == (surplus < 1.0)
            decided += 1
    assert decided > 200


@SOME
def test_breakaway_on_a_flat_face_is_a_rotation_about_one_point(law):
    limit = PointsLimit.of(law)
    for arm, share in zip(law.arms(0.0), law.shares, strict=True):
        force, moment = law.force_and_moment(-1j * arm, -1.0, 0.0)  # friction of the other points
        for part in (0.5 + 0.3j, 0.3 - 0.8j, -0.9j):
            own = part * share  # the resting point holds any force up to its share
            total = -force + own
            torque = -moment + (arm.conjugate() * own).imag
            assert limit.margins(np.array([total]), torque)[0] == pytest.approx(0.0, abs=1e-12)
            assert limit.direction(total, torque) == (pytest.approx(-1j * arm), 1.0)


def test_force_without_moment_is_held_up_to_full_friction():
    limit = PointsLimit.of(CONTACTS["6 points"])
    forces = np.array([0.0, 0.5, 0.999999, 1.000001, 1.5]) * np.exp(0.4j)
    assert np.array_equal(limit.margins(forces, 0.0) > 0.0, [True, True, True, False, False])
    # The margin continues smoothly beyond, because the squared moment has the slope −R².
    near = limit.margins(np.array([1.0 - 1e-6, 1.0 + 1e-6]), 0.0)
    assert near == pytest.approx([1e-6, -1e-6], rel=1e-2)


ALL = CONTACTS | {
    "ring": Ring(RADIUS),
    "three terms": ThreeTermRing(RADIUS),
    "annulus": Annulus(0.1, RADIUS),
}


@pytest.mark.parametrize("law", ALL.values(), ids=ALL)
def test_largest_load_in_the_direction_of_a_load_that_drives_slip_is_this_load(law):
    rng = np.random.default_rng(3)
    for _ in range(30):
        force, moment = wrench_of_slip(law, complex(*rng.normal(size=2)) * RADIUS, rng.normal())
        found, about = largest_wrench(law, 3.7 * force, 3.7 * moment)
        assert (found, about) == pytest.approx((force, moment), rel=0.0, abs=1e-14)


@pytest.mark.parametrize("law", ALL.values(), ids=ALL)
def test_a_force_through_the_centre_of_the_load_is_held_up_to_full_friction_and_a_couple_up_to_its_lever(law):
    arms = np.array(law.arms(0.0)) if isinstance(law, Points) else np.zeros(1)
    shares = np.array(law.shares) if isinstance(law, Points) else np.ones(1)
    for direction in np.exp(1j * np.array([0.0, 0.7, math.pi / 2.0])):
        moment = float(((shares @ arms).conjugate() * direction).imag)
        assert largest_wrench(law, direction, moment)[0] == pytest.approx(direction, abs=1e-12)
    if not isinstance(law, Points):
        assert largest_wrench(law, 0j, -2.0)[1] == pytest.approx(-law.shares(0.0, 1.0).moment, abs=1e-14)


def test_a_pin_holds_no_moment_and_a_load_needs_a_direction():
    assert largest_wrench(Pin(), 2j, 0.0) == (1j, 0.0)
    assert largest_wrench(Pin(), 2j, 0.1) == (0j, 0.0)
    for law in (Pin(), FEET):
        with pytest.raises(ValueError, match="force and moment are 0: they must have a direction"):
            largest_wrench(law, 0j, 0.0)
        for invalid, message in ((True, "= True: it must be a number"), (math.nan, "nan: it must be finite")):
            for call in (largest_wrench, wrench_of_slip):
                with pytest.raises(ValueError, match=message):
                    call(law, invalid, 1.0)
                with pytest.raises(ValueError, match=message):
                    call(law, 1.0, invalid)
    for call in (largest_wrench, wrench_of_slip):
        with pytest.raises(ValueError, match="contact = 1: it must be an isotropic law"):
            call(1, 1j, 0.0)
