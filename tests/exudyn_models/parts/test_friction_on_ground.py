"""Friction against the ground, and bodies by the numbers of their objects."""

from typing import Any

import exudyn as exu
import exudyn.itemInterface
import numpy as np
import pytest
from free_bodies import coordinates, planar_body, rotor, run_explicitly
from pairs_of_bodies import DISC, KINDS, assert_jacobian_is_derivative, body, momenta_and_energy

from exudyn_models import add_native_friction, add_radial_support, add_ring_friction, largest_stable_step

items: Any = exudyn.itemInterface

RING = {"contact_radius": 0.12, "friction_coefficient": 0.25, "normal_load": 2.0, "regularisation": 1e-3}
LAWS = {
    "ring": {},
    "points": {"contact_points": 6},
    "annulus": {"contact_radius": None, "inner_radius": 0.08, "outer_radius": 0.12},
    "creeping ring": {"regularisation": 100.0},
    "load of time": {"normal_load": lambda time: 2.0 + time},
    "of all": {
        "friction_coefficient": lambda slip_speed, radius: 0.2 + 0.1 * np.exp(-slip_speed) + 0.1 * radius,
        "normal_load": lambda relative_spin, time: 2.0 + np.tanh(relative_spin) + time,
    },
}


def model_of(kind, ground=True, **contact):
    mbs = exu.SystemContainer().AddSystem()
    disc = body(mbs, kind, *DISC)
    master = None if ground else rotor(mbs, 1e18, 0.0)
    return mbs, disc, add_ring_friction(mbs, master, disc, **RING | contact)


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("law", LAWS)
def test_the_ground_acts_as_a_rotor_that_nothing_can_turn(kind, law):
    ends = []
    for ground in (True, False):
        mbs, disc, _ = model_of(kind, ground, **LAWS[law])
        mbs.Assemble()
        run_explicitly(mbs, 0.1, 100)
        ends.append(np.hstack(coordinates(mbs, disc)))
    assert np.abs(ends[0]).max() > 0.1
    np.testing.assert_allclose(ends[0], ends[1], rtol=0.0, atol=1e-13)


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("law", ["ring", "points", "of all"])
def test_what_a_brake_takes_from_a_body_is_its_heat(kind, law):
    mbs, disc, brake = model_of(kind, **LAWS[law])
    heat = brake.add_sensor("heat")
    mbs.Assemble()
    _, before = momenta_and_energy(mbs, (kind,), (disc,), (DISC,))
    run_explicitly(mbs, 0.05, 250)
    _, after = momenta_and_energy(mbs, (kind,), (disc,), (DISC,))
    assert before - after > 1e-3
    assert float(mbs.GetSensorValues(heat)) == pytest.approx(before - after, rel=1e-10)


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("law", LAWS)
def test_jacobian_on_the_ground_is_the_derivative_of_the_force(kind, law):
    mbs, _, brake = model_of(kind, **LAWS[law])
    assert_jacobian_is_derivative(mbs, brake)


@pytest.mark.parametrize("points", [None, 6])
def test_a_brake_stops_a_rotor_by_its_moment_and_holds_it(points):
    mbs = exu.SystemContainer().AddSystem()
    node = rotor(mbs, 0.02, 3.0)
    brake = add_ring_friction(mbs, None, node, **RING | {"contact_points": points})
    spin, moment = brake.add_sensor("rim_slip"), brake.add_sensor("transmitted_moment")
    mbs.Assemble()
    run_explicitly(mbs, 0.5, 500)
    assert mbs.GetSensorValues(moment) == pytest.approx(-0.25 * 2.0 * 0.12, rel=1e-14)
    assert mbs.GetSensorValues(spin) == pytest.approx(0.12 * (3.0 - 0.06 / 0.02 * 0.5), rel=1e-12)
    run_explicitly(mbs, 1.2, 1200)
    assert abs(mbs.GetSensorValues(spin)) < 1e-6  # it stopped at t = 1 s and decays by ε/r·J/M = 3 ms


def test_the_limit_of_explicit_steps_knows_a_brake():
    mbs = exu.SystemContainer().AddSystem()
    node = rotor(mbs, 0.02, 3.0)
    add_ring_friction(mbs, None, node, **RING)
    expected = 2.0 * 0.02 / (0.25 * 2.0 / 1e-3 * 0.12**2)
    assert largest_stable_step(mbs, exu.DynamicSolverType.ExplicitEuler) == pytest.approx(expected, rel=1e-12)


def test_exudyns_own_contact_on_the_ground_moves_a_disc_alike():
    ends = []
    for add in (add_ring_friction, add_native_friction):
        mbs = exu.SystemContainer().AddSystem()
        disc = planar_body(mbs, 1.0, 0.02, [0.3, 0.1, 0.4], [-0.2, 0.3, -1.0])
        add(
            mbs,
            None,
            disc,
            **RING,
            contact_points=6,
            **({"reach": 2.0} if add is add_native_friction else {}),
        )
        mbs.Assemble()
        run_explicitly(mbs, 0.2, 200)
        ends.append(np.hstack(coordinates(mbs, disc)))
    np.testing.assert_allclose(ends[0], ends[1], rtol=0.0, atol=1e-11)


def test_a_body_by_its_object_is_its_node():
    mbs = exu.SystemContainer().AddSystem()
    master, disc = rotor(mbs, 1.0, 0.0), planar_body(mbs, 1.0, 1.0, [0.0] * 3, [0.0] * 3)
    objects = exu.ObjectIndex(0), exu.ObjectIndex(1)
    assert [int(n) for n in add_ring_friction(mbs, *objects, **RING).nodes] == [int(master), int(disc)]
    assert [int(n) for n in add_radial_support(mbs, *objects, stiffness=1.0).nodes] == [
        int(master),
        int(disc),
    ]
    with pytest.raises(ValueError, match="disc_node 0 is the master_node too"):
        add_ring_friction(mbs, master, exu.ObjectIndex(0), **RING)


def test_an_object_that_is_no_body_is_refused():
    mbs = exu.SystemContainer().AddSystem()
    master = rotor(mbs, 1.0, 0.0)
    ground = mbs.AddObject(items.ObjectGround())
    with pytest.raises(
        ValueError, match="disc_node 1 is an ObjectGround: it must be a body with a node, which is"
    ):
        add_ring_friction(mbs, master, ground, **RING)


def test_the_ground_is_no_disc():
    mbs = exu.SystemContainer().AddSystem()
    with pytest.raises(ValueError, match="disc_node = None is of type NoneType"):
        add_ring_friction(mbs, rotor(mbs, 1.0, 0.0), None, **RING)
