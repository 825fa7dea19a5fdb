"""Exact stick of rotors on parallel axes, and of pins, which hold a point but not the spin."""

import exudyn as exu
import numpy as np
import pytest
from free_bodies import drive, items, new_model, rate_of, settings_of

from exudyn_models import add_ring_friction, solve_dynamic

TRAPEZOIDAL = exu.DynamicSolverType.TrapezoidalIndex2
MASTER, DISC, DISTANCE = 0.5, 0.2, 0.3  # kg m², m
LOAD, COEFFICIENT = 100.0, 0.4
HELD = COEFFICIENT * LOAD * DISTANCE  # moment in N m about the master's axis of a force at the disc's centre


def rotor_at(mbs, inertia, speed, x):
    node = mbs.AddNode(items.Node1D(initialVelocities=[speed]))
    mbs.AddObject(
        items.ObjectRotationalMass1D(nodeNumber=node, inertia=inertia, referencePosition=[x, 0.0, 0.0])
    )
    return node


def pair(radius, speeds, load=0.0, regularisation=None):
    """Return a model of two rotors on parallel axes, a load on the master, both nodes and the heat sensor."""
    mbs = new_model()
    nodes = rotor_at(mbs, MASTER, speeds[0], 0.0), rotor_at(mbs, DISC, speeds[1], DISTANCE)
    law = {"friction_coefficient": COEFFICIENT, "normal_load": LOAD, "regularisation": regularisation}
    contact = add_ring_friction(mbs, *nodes, contact_radius=radius, **law)
    drive(mbs, nodes[0], load)
    return mbs, nodes, contact.add_sensor("heat")


def test_a_pin_on_a_parallel_axis_stops_the_master_and_not_its_own_rotor():
    mbs, (master, disc), heat = pair(0.0, (10.0, 3.0))
    stops = solve_dynamic(mbs, settings_of(1.0, 500), TRAPEZOIDAL)
    assert [stop.time for stop in stops] == pytest.approx([MASTER * 10.0 / HELD], abs=1e-9)
    assert rate_of(mbs, master) == pytest.approx(0.0, abs=1e-12)
    assert rate_of(mbs, disc) == pytest.approx(3.0, rel=1e-12)
    assert float(mbs.GetSensorValues(heat)) == pytest.approx(MASTER * 10.0**2 / 2.0, rel=1e-9)


def test_it_holds_until_the_load_exceeds_the_moment_of_its_force():
    mbs, (master, disc), _ = pair(0.0, (0.0, 3.0), lambda t: 1.5 * HELD * t)
    releases = solve_dynamic(mbs, settings_of(1.0, 499), TRAPEZOIDAL)
    assert [release.time for release in releases] == pytest.approx([2.0 / 3.0], abs=1e-6)
    # The integral of 1.5·HELD·t − HELD from the release to the end, over the inertia:
    assert rate_of(mbs, master) == pytest.approx(0.75 * HELD / MASTER * (1.0 / 3.0) ** 2, rel=1e-4)
    assert rate_of(mbs, disc) == pytest.approx(3.0, rel=1e-9)


def test_a_ring_stops_both_rotors_at_the_time_of_the_regularised_law():
    mbs, nodes, heat = pair(0.1, (10.0, 3.0))
    (stop,) = solve_dynamic(mbs, settings_of(1.0, 500), TRAPEZOIDAL)
    assert [rate_of(mbs, node) for node in nodes] == pytest.approx([0.0, 0.0], abs=1e-12)
    turned = MASTER * 10.0**2 / 2.0 + DISC * 3.0**2 / 2.0
    assert float(mbs.GetSensorValues(heat)) == pytest.approx(turned, rel=1e-5)
    before = 0.9 * stop.time
    speeds = []
    for regularisation in (None, 1e-6):
        mbs, nodes, _ = pair(0.1, (10.0, 3.0), regularisation=regularisation)
        solve_dynamic(mbs, settings_of(before, 1500), TRAPEZOIDAL)  # 500 steps err by 6e-6
        speeds.append([rate_of(mbs, node) for node in nodes])
    np.testing.assert_allclose(*speeds, rtol=1e-6)
