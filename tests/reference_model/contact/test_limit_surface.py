"""Static friction of points, against their friction in slip and against sampled slips."""

import numpy as np
import pytest

from reference_model.contact.limit_surface import PointsLimit
from reference_model.contact.points import PointsOnRing

RADIUS = 0.3


def limit_of(points):
    return PointsLimit(np.array(PointsOnRing(RADIUS, points).arms(0.0)), np.full(points, 1.0 / points))


@pytest.mark.parametrize("points", [3, 4, 5, 6, 24])
def test_force_and_moment_of_any_slip_lie_on_the_limit_surface(points):
    law, limit = PointsOnRing(RADIUS, points), limit_of(points)
    rng = np.random.default_rng(points)
    for _ in range(40):
        u, w = complex(*rng.normal(size=2)) * RADIUS, rng.normal()
        force, moment = law.force_and_moment(u, -w, 0.0)
        # The held load is opposite to friction. Margins are quadratic in the load.
        assert limit.margins(np.array([-force]), -moment)[0] == pytest.approx(0.0, abs=1e-12)
        direction, sense = limit.direction(-force, -moment)
        assert direction / sense == pytest.approx(u / w, rel=1e-5, abs=1e-6 * abs(u / w))
        assert limit.margins(np.array([-0.999 * force]), -0.999 * moment)[0] > 0.0
        assert limit.margins(np.array([-1.001 * force]), -1.001 * moment)[0] < 0.0


@pytest.mark.parametrize("points", [3, 5, 6])
def test_friction_holds_a_load_if_no_slip_gains_power(points):
    law, limit = PointsOnRing(RADIUS, points), limit_of(points)
    rng = np.random.default_rng(7)
    slips = rng.normal(size=(4000, 3)) * [RADIUS, RADIUS, 1.0]
    # Slips with one point at rest are kinks of the mean slip speed, where breakaway is most likely.
    pivots = [(-1j * w * arm, w) for arm in law.arms(0.0) for w in (1.0, -1.0)]
    u = np.concatenate((slips[:, 0] + 1j * slips[:, 1], [slip for slip, _ in pivots]))
    w = np.concatenate((slips[:, 2], [turn for _, turn in pivots]))
    taken = np.mean(abs(u[:, None] + 1j * w[:, None] * np.array(law.arms(0.0))), axis=1)
    decided = 0
    for _ in range(300):
        force, moment = complex(*rng.uniform(-0.8, 0.8, 2)), RADIUS * rng.uniform(-1.0, 1.0)
        surplus = np.max(((force.conjugate() * u).real + moment * w) / taken)
        if abs(surplus - 1.0) > 0.01:  # 4000 slips leave gaps of some 0.05 rad
            assert (limit.margins(np.array([force]), moment)[0] > 0.0) == (surplus < 1.0)
            decided += 1
    assert decided > 200


@pytest.mark.parametrize("points", [3, 6])
def test_breakaway_on_a_flat_face_is_a_rotation_about_one_point(points):
    law, limit = PointsOnRing(RADIUS, points), limit_of(points)
    for arm in law.arms(0.0):
        force, moment = law.force_and_moment(-1j * arm, -1.0, 0.0)  # friction of the other points
        for share in (0.0, 0.5 + 0.3j, -0.9j):
            own = share / points  # the resting point holds any force up to its share
            total = -force + own
            torque = -moment + (arm.conjugate() * own).imag
            assert limit.margins(np.array([total]), torque)[0] == pytest.approx(0.0, abs=1e-12)
            assert limit.direction(total, torque) == (pytest.approx(-1j * arm), 1.0)


def test_force_without_moment_is_held_up_to_full_friction():
    limit = limit_of(5)
    forces = np.array([0.0, 0.5, 0.999999, 1.000001, 1.5]) * np.exp(0.4j)
    assert np.array_equal(limit.margins(forces, 0.0) > 0.0, [True, True, True, False, False])
    # The margin continues smoothly beyond, because the squared moment has the slope −R².
    near = limit.margins(np.array([1.0 - 1e-6, 1.0 + 1e-6]), 0.0)
    assert near == pytest.approx([1e-6, -1e-6], rel=1e-2)
