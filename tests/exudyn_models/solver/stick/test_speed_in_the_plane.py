"""Shortcuts for contacts in the plane that stick exactly: they change no result, and save evaluations."""

import math

import numpy as np
import pytest
from free_bodies import changes_of, coordinate, items, new_model, planar_body

from exudyn_models import add_ring_friction
from exudyn_models.solver.contacts import laws_of
from exudyn_models.solver.stick.complementarity import Sets
from exudyn_models.solver.stick.planar_stick import PlanarStick
from exudyn_models.solver.stick.sliding_steps import SlidingSteps
from exudyn_models.solver.stick.slip_motion import resisted_slip
from exudyn_models.solver.stick.sticking_contacts import PlanarContact

SHAPES = {
    "pin": {"contact_radius": 0.0},
    "ring": {"contact_radius": 0.1},
    "annulus": {"inner_radius": 0.05, "outer_radius": 0.2},
}


def disc(position=(0.0, 0.0, 0.0), velocity=(0.0, 0.0, 0.0), load=100.0, **shape):
    mbs = new_model()
    node = planar_body(mbs, 2.0, 0.02, list(position), list(velocity))
    contact = add_ring_friction(mbs, None, node, friction_coefficient=0.3, normal_load=load, **shape)
    return mbs, node, contact


def law_of(shape):
    mbs, _, _ = disc(**shape)
    ((item, law),) = laws_of(mbs).items()
    return PlanarContact(item, law, np.arange(3), law)


@pytest.mark.parametrize("shape", SHAPES.values(), ids=SHAPES)
def test_the_load_share_does_not_depend_on_the_start_of_its_search_and_is_below_its_bound(shape):
    contact, random = law_of(shape), np.random.default_rng(5)
    count = contact.planar.most_locks
    for free in random.normal(size=(30, 3, 3)):
        columns = np.ascontiguousarray(free[:, : random.integers(1, count + 1)])
        columns[count:] = 0.0
        load = random.normal(size=3) * [1.0, 1.0, 0.1] * 10.0 ** random.uniform(-3.0, 3.0)
        load[count:] = 0.0
        starts = np.vstack([np.zeros(3), random.normal(size=(5, 3))])
        found = [resisted_slip(load, columns, start, contact.planar.factors.geometry) for start in starts]
        shares = [share for share, _ in found]
        assert shares == pytest.approx([shares[0]] * len(starts), rel=1e-11)
        slips = np.array([slip for _, slip in found])
        assert load @ slips.T == pytest.approx(shares, rel=1e-11)  # P of the slips is 1 m/s
        others = columns @ random.normal(size=(columns.shape[1], 100))
        largest = max(load @ slip / contact.planar.potential_of(slip) for slip in others.T)
        assert largest <= shares[0] * (1.0 + 1e-12)
        assert shares[0] <= contact.share_bound(load[:count] / contact.planar.scales, 1.0) * (1.0 + 1e-12)


@pytest.mark.parametrize("shape", SHAPES.values(), ids=SHAPES)
def test_forces_that_clearly_hold_need_no_iteration(shape):
    contact, random, clear = law_of(shape), np.random.default_rng(6), 0
    rows = contact.planar.most_locks
    sets = Sets([slice(0, rows), slice(rows, rows + 1)], [contact.law, None])
    for roots in random.normal(size=(40, rows + 1, rows + 1)):
        to_rates, rates = roots @ roots.T + np.eye(rows + 1), random.normal(size=rows + 1)
        limits = 10.0 ** random.uniform(-1.0, 1.0, (2, 1)) * [1.0, 1.0]
        clear += sets._clearly_contain(-np.linalg.solve(to_rates, rates), limits)
        forces, _ = sets.forces(to_rates, rates, limits)
        iterated, _ = sets._smooth_forces(to_rates, rates, limits)
        assert forces == pytest.approx(iterated, abs=1e-6 * limits.max())
    assert 5 < clear < 35


def test_exudyn_calls_no_friction_of_a_contact_at_rest_and_its_load_at_most_three_times_a_step(monkeypatch):
    times, forces, force = [], [], PlanarStick.force
    monkeypatch.setattr(PlanarStick, "force", lambda self, *args: forces.append(1) or force(self, *args))

    def load(time):
        times.append(time)
        return 100.0

    mbs, node, _ = disc(load=load, contact_radius=0.1)
    mbs.AddLoad(items.LoadCoordinate(markerNumber=coordinate(mbs, node), load=5.0))
    assert changes_of(mbs, 0.2, 1e-3) == []
    assert len(times) <= 3 * 200 + 50
    assert len(forces) < 10


def test_few_steps_are_taken_back_while_friction_turns(monkeypatch):
    """A disc on springs of 40 rad/s runs in a circle, so friction turns by 0.04 in a step."""
    found, resolves = [], SlidingSteps.resolves
    monkeypatch.setattr(
        SlidingSteps, "resolves", lambda self, step: found.append(resolves(self, step)) or found[-1]
    )
    mbs, node, _ = disc([0.1, 0.0, 0.0], [0.0, 4.0, 0.0], 5.0, contact_radius=0.1)
    for place in (0, 1):
        markers = [coordinate(mbs, None), coordinate(mbs, node, place)]
        mbs.AddObject(
            items.ObjectConnectorCoordinateSpringDamper(markerNumbers=markers, stiffness=2.0 * 40.0**2)
        )
    assert changes_of(mbs, 0.2, 1e-3) == []
    assert 2 * 200 < len(found) < 3.5 * 200
    assert found.count(False) < 0.02 * len(found)
    assert math.isfinite(mbs.systemData.GetODE2Coordinates().sum())
