"""Friction of sliders, belts, tyres and mass points, against closed forms."""

import math

import exudyn as exu
import numpy as np
import pytest
from free_bodies import changes_of, coordinate, drive, items, new_model, rate_of, rotor

from exudyn_models import add_ring_friction, add_slider_friction, add_torsional_spring, add_tyre

STEP = 1e-3


def slider(mbs, mass, speed):
    node = mbs.AddNode(items.Node1D(initialVelocities=[speed]))
    mbs.AddObject(items.ObjectMass1D(nodeNumber=node, mass=mass))
    return node


def spring(mbs, node, stiffness):
    markers = [coordinate(mbs, None), coordinate(mbs, node)]
    mbs.AddObject(items.ObjectConnectorCoordinateSpringDamper(markerNumbers=markers, stiffness=stiffness))


def test_a_slider_on_a_belt_sticks_and_slips_as_in_closed_form():
    """A spring pulls a mass of 1 kg from a belt at 0.5 m/s when k·x exceeds 6 N; it slides with 5 N until 0.5 m/s."""
    mbs, rate = new_model(), 10.0
    belt, mass = rotor(mbs, 1e9, 1.0), slider(mbs, 1.0, 0.5)
    spring(mbs, mass, rate**2)
    friction = add_slider_friction(
        mbs, belt, mass, friction_coefficient=0.5, normal_load=10.0, first_radius=0.5, static_ratio=1.2
    )
    heat = friction.add_sensor("heat")
    changes = changes_of(mbs, 0.73, STEP)
    release = 0.06 / 0.5
    # About its rest at 0.05 m, the mass swings from 0.01 m to −0.01 m, where it has the speed of the belt again.
    slide = (math.pi + 2.0 * math.atan2(0.5 / rate, 0.01)) / rate
    assert [mode for *_, mode in changes] == [-1, 0]
    assert [time for time, *_ in changes] == pytest.approx([release, release + slide], abs=1e-5)
    assert mbs.GetSensorValues(heat) == pytest.approx(5.0 * (0.5 * slide + 0.02), rel=1e-4)


def test_a_valve_stays_where_friction_holds_it_and_hits_its_stop():
    """It moves under more than 3 N, from 0.15 s on, by x = 20·τ³/6/m, until a stop at 2 mm pushes back."""
    mbs = new_model()
    valve = slider(mbs, 0.1, 0.0)
    drive(mbs, valve, lambda t: 20.0 * t)
    friction = add_slider_friction(mbs, None, valve, friction_coefficient=0.3, normal_load=10.0)
    stop = add_torsional_spring(mbs, None, valve, stiffness=1e5, backlash=4e-3)
    changes = changes_of(mbs, 0.25, 2e-4)
    hit = 0.15 + (6.0 * 0.1 * 2e-3 / 20.0) ** (1.0 / 3.0)
    assert changes[0][:2] == (pytest.approx(0.15, abs=1e-9), int(friction.item))
    assert changes[1][:2] == (pytest.approx(hit, abs=1e-6), int(stop.item))


def test_a_tyre_rolls_until_its_static_friction_and_then_slides():
    mbs = new_model()
    wheel, car = rotor(mbs, 1.0, 0.0), slider(mbs, 300.0, 0.0)
    drive(mbs, wheel, lambda t: 1000.0 * t)
    tyre = add_tyre(
        mbs, wheel, car, radius=0.3, friction_coefficient=0.5, normal_load=3000.0, static_ratio=1.1
    )
    force = tyre.add_sensor("moment")
    ((release, *_, mode),) = changes_of(mbs, 1.0, STEP)
    mass = 300.0 + 1.0 / 0.3**2  # kg, of the rolling car
    exact = 1650.0 * mass / 300.0 * 0.3 / 1000.0
    assert (mode, release) == (-1, pytest.approx(exact, abs=1e-9))
    assert mbs.GetSensorValues(force) == pytest.approx(1500.0, rel=1e-12)
    rolled = 1000.0 * exact**2 / 2.0 / 0.3 / mass
    assert rate_of(mbs, car) == pytest.approx(rolled + 5.0 * (1.0 - exact), abs=1e-8)


@pytest.mark.parametrize(
    ("node", "body"), [(items.NodePoint2D, items.ObjectMassPoint2D), (items.NodePoint, items.ObjectMassPoint)]
)
def test_a_mass_point_slides_straight_and_stops(node, body):
    mbs = new_model()
    point = mbs.AddNode(node(initialVelocities=[2.0, 1.0, 0.0][: 2 + (node is items.NodePoint)]))
    mbs.AddObject(body(nodeNumber=point, mass=2.0))
    add_ring_friction(mbs, None, point, contact_radius=0.0, friction_coefficient=0.3, normal_load=20.0)
    ((stop, *_, mode),) = changes_of(mbs, 1.0, STEP)
    assert (mode, stop) == (0, pytest.approx(math.sqrt(5.0) / 3.0, abs=1e-9))
    place = mbs.GetNodeOutput(point, exu.OutputVariableType.Coordinates)[:2]
    np.testing.assert_allclose(place, np.array([2.0, 1.0]) * math.sqrt(5.0) / 6.0, atol=1e-9)


def test_a_mass_point_and_a_disc_exchange_their_momentum():
    """They end with the speed of their common centre of mass."""
    mbs = new_model()
    points = [mbs.AddNode(items.NodePoint2D(initialVelocities=[speed, 0.2])) for speed in (3.0, 0.0)]
    for point, mass in zip(points, (1.0, 2.0), strict=True):
        mbs.AddObject(items.ObjectMassPoint2D(nodeNumber=point, mass=mass))
    add_ring_friction(mbs, *points, contact_radius=0.0, friction_coefficient=0.5, normal_load=10.0)
    ((stop, *_),) = changes_of(mbs, 1.0, STEP)
    assert stop == pytest.approx(3.0 / (5.0 + 2.5), abs=1e-9)
    for point in points:
        velocity = mbs.GetNodeOutput(point, exu.OutputVariableType.Coordinates_t)
        np.testing.assert_allclose(velocity, [1.0, 0.2], atol=1e-9)


def test_points_do_not_turn_and_rotations_in_space_are_not_freedoms():
    mbs = new_model()
    point = mbs.AddNode(items.NodePoint2D())
    with pytest.raises(ValueError, match="is a point: contact_radius must be 0"):
        add_ring_friction(mbs, None, point, contact_radius=0.1, friction_coefficient=0.3, normal_load=1.0)
    body = mbs.AddNode(items.NodeRigidBodyRxyz())
    for wrong in (point, coordinate(mbs, body, 3), 7):
        with pytest.raises(ValueError, match=r"second = .* it must be a Node1D"):
            add_slider_friction(mbs, None, wrong, friction_coefficient=0.3, normal_load=1.0)
