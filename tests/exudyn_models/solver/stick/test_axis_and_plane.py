"""Contacts on an axis and in the plane that rest on each other."""

import exudyn as exu
import pytest
from free_bodies import changes_of, coordinate, items, new_model, planar_body, rate_of, rotor

from exudyn_models import add_ring_friction
from reference_model.trajectory import SimulationError

IMPLICIT = [exu.DynamicSolverType.TrapezoidalIndex2, exu.DynamicSolverType.GeneralizedAlpha]
RADIUS = 0.2  # m


def add(mbs, ends, friction, ratio=1.0):
    law = {"friction_coefficient": 1.0, "normal_load": friction, "static_ratio": ratio}
    grounded_rotor = ends[0] is None and mbs.GetNode(ends[1])["nodeType"] == "1D"
    return int(add_ring_friction(mbs, *ends, contact_radius=1.0 if grounded_rotor else 0.0, **law).item)


def push(mbs, node, place, force):
    load = {"loadUserFunction": lambda mbs, t, _: force(t)}
    mbs.AddLoad(items.LoadCoordinate(markerNumber=coordinate(mbs, node, place), **load))


def shaft_and_coin(mbs):
    """Return a rotor of 0.5 kg m² and a coin of 1 kg at rest on it."""
    return rotor(mbs, 0.5, 0.0), planar_body(mbs, 1.0, 0.002, [RADIUS, 0.0, 0.0], [0.0] * 3)


@pytest.mark.parametrize("solver", IMPLICIT)
@pytest.mark.parametrize("brake_first", [True, False])
def test_a_coin_slips_at_once_if_the_brake_of_its_disc_releases_with_a_jerk(solver, brake_first):
    """The brake drops from 4.5 to 3 N m at 0.45 s; the coin would need 0.2·1.5/0.54 N to follow, and has 0.5 N."""
    mbs = new_model()
    shaft, coin = shaft_and_coin(mbs)
    pairs = [((None, shaft), 3.0, 1.5), ((shaft, coin), 0.5, 1.0)]
    brake, pin = (add(mbs, *pair) for pair in pairs[:: 1 if brake_first else -1])
    if not brake_first:
        brake, pin = pin, brake
    push(mbs, shaft, 0, lambda t: 10.0 * t)
    changes = changes_of(mbs, 0.6, 1e-3, solver)
    assert {change[1:] for change in changes} == {(brake, 0, 1), (pin, 0, -1)}
    assert [time for time, *_ in changes] == pytest.approx([0.45, 0.45], abs=1e-9)
    assert rate_of(mbs, shaft) == pytest.approx((5.0 * (0.6**2 - 0.45**2) - 3.1 * 0.15) / 0.5, rel=1e-6)


@pytest.mark.parametrize("brake_first", [True, False])
def test_a_coin_on_ground_and_disc_releases_or_is_refused_where_the_brake_decides(brake_first):
    """Both hold 4 N along the radius; across it, the brake of 0.5 N m limits the part of the disc to 2.5 N."""
    for place in range(2):
        mbs = new_model()
        shaft, coin = shaft_and_coin(mbs)
        pairs = [((None, shaft), 0.5), ((None, coin), 4.0), ((shaft, coin), 4.0)]
        for pair in pairs if brake_first else pairs[::-1]:
            add(mbs, *pair)
        push(mbs, coin, place, lambda t: 4.0 * t)
        if place == 0:
            assert [time for time, *_ in changes_of(mbs, 2.1, 1e-2)] == pytest.approx([2.0, 2.0], abs=1e-9)
        else:
            with pytest.raises(SimulationError, match="contacts on an axis and in the plane share a load"):
                changes_of(mbs, 2.1, 1e-2)
