"""Contacts on an axis and in the plane that rest on each other."""

import exudyn as exu
import numpy as np
import pytest
from free_bodies import changes_of, coordinate, items, new_model, planar_body, rate_of, rotor

from exudyn_models import add_ring_friction
from exudyn_models.solver.stick.complementarity import Sets

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


@pytest.mark.parametrize("solver", IMPLICIT)
@pytest.mark.parametrize("brake_first", [True, False])
@pytest.mark.parametrize(
    ("place", "brake", "release", "slips"), [(0, 0.5, 2.0, 0), (1, 0.5, 1.625, 1), (1, 2.0, 2.0, 0)]
)
def test_a_coin_on_ground_and_disc_releases_where_both_or_a_brake_reach_their_limits(
    place, brake, release, slips, brake_first, solver
):
    """Both pins hold 4 N along the radius; across it, a brake of 0.5 N m limits the part of the disc to 2.5 N."""
    mbs = new_model()
    shaft, coin = shaft_and_coin(mbs)
    pairs = [((None, shaft), brake), ((None, coin), 4.0), ((shaft, coin), 4.0)]
    found = [add(mbs, *pair) for pair in (pairs if brake_first else pairs[::-1])]
    on_axis, ground, disc = found if brake_first else found[::-1]
    push(mbs, coin, place, lambda t: 4.0 * t)
    changes = changes_of(mbs, 2.01, 1e-2, solver)
    assert {contact for _, contact, *_ in changes} == {ground, on_axis if slips else disc}
    assert [time for time, *_ in changes] == pytest.approx([release, release], abs=1e-9)


def test_forces_of_contacts_on_axes_and_in_the_plane_lie_within_their_sets_and_oppose_slip():
    """The sets are discs and intervals, and some contacts are redundant."""
    rng = np.random.default_rng(5)

    def disc(slip):
        size = np.linalg.norm(slip)
        along = slip / size if size else np.array([1.0, 0.0])
        return size, along, np.eye(2) - np.outer(along, along)

    sets = Sets([slice(0, 2), slice(2, 3), slice(3, 5)], [disc, None, disc])
    for rank in (1, 2, 3, 5):
        root = rng.normal(size=(5, rank))
        to_rates, rates = root @ root.T, root @ rng.normal(size=rank)
        limits = np.repeat(rng.uniform(0.2, 1.0, (3, 1)), 2, axis=1)
        forces, left = sets.forces(to_rates, rates, limits)
        for rows, limit in zip(sets.blocks, limits[:, 0], strict=True):
            size = np.linalg.norm(left[rows])
            assert np.linalg.norm(forces[rows]) < limit * (1.0 + 1e-3)
            if size > 1e-6:
                assert forces[rows] == pytest.approx(-limit * left[rows] / size, abs=1e-3)
