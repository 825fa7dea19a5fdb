"""Contacts that stick exactly between bodies that can slide sideways."""

import math

import exudyn as exu
import numpy as np
import pytest
from free_bodies import (
    ball,
    coordinate,
    coordinates,
    items,
    momenta,
    new_model,
    planar_body,
    rotor,
    settings_of,
)
from free_bodies import changes_of as run

from exudyn_models import add_radial_support, add_ring_friction, solve_dynamic
from reference_model import simulate
from reference_model.systems import DiscOnDisc, PinOnDisc

SOLVERS = exu.DynamicSolverType
TRAPEZOIDAL = SOLVERS.TrapezoidalIndex2
IMPLICIT = pytest.mark.parametrize("solver", [TRAPEZOIDAL, SOLVERS.GeneralizedAlpha])
MASS, INERTIA, RADIUS, COEFFICIENT, LOAD = 2.0, 0.02, 0.1, 0.3, 50.0
RING = {"contact_radius": RADIUS, "friction_coefficient": COEFFICIENT}
LOCKED, FORWARD = 0, 1


def velocities(mbs):
    return np.array(mbs.systemData.GetODE2Coordinates_t())


def push(mbs, node, place, load):
    marker = coordinate(mbs, node, place)
    mbs.AddLoad(items.LoadCoordinate(markerNumber=marker, loadUserFunction=lambda mbs, t, _: load(t)))


def stop_of_ring(speed, spin):
    """Return the time when a ring on the ground stops."""
    ring = DiscOnDisc(
        mass=MASS, polar_inertia=INERTIA, contact_radius=RADIUS, friction_force=COEFFICIENT * LOAD,
        stiffness=0.0, damping=0.0, disc_speed=0.0, shaft_damping=0.0, shaft_speed=0.0,
    )  # fmt: skip
    return simulate(ring, [0.0, 0.0, 0.0, speed, 0.0, spin], [0.0, 1.0], tolerance=1e-11).phases[1].start


def sliding_ring(speed, spin, loads=(LOAD,), body=planar_body):
    mbs = new_model()
    node = body(mbs, MASS, INERTIA, [0.0, 0.0, 0.0], [speed, 0.0, spin])
    contacts = [add_ring_friction(mbs, None, node, normal_load=load, **RING) for load in loads]
    return mbs, node, contacts


@IMPLICIT
def test_a_ring_stops_sliding_and_spinning_at_once_with_the_second_order(solver):
    exact = stop_of_ring(1.0, 5.0)
    errors = []
    for step in (2e-3, 1e-3, 5e-4):  # the turn of friction shortens longer ones
        mbs, _, (contact,) = sliding_ring(1.0, 5.0)
        ((time, item, before, after),) = run(mbs, 0.3, step, solver)
        assert (item, before, after) == (int(contact.item), FORWARD, LOCKED)
        assert np.abs(velocities(mbs)).max() < 1e-12
        errors.append(abs(time - exact))
    assert errors[-1] < 1e-6
    assert errors[0] / errors[1] == pytest.approx(4.0, rel=0.1)
    assert errors[1] / errors[2] == pytest.approx(4.0, rel=0.1)


@pytest.mark.parametrize(("solver", "time"), [(TRAPEZOIDAL, 0.3), (SOLVERS.GeneralizedAlpha, 0.4)])
def test_a_block_stops_where_a_step_ends(solver, time):
    """The last short steps leave a millionth of a step, up to rounding."""
    mbs = new_model()
    node = planar_body(mbs, 2.0, 0.01, [0.0] * 3, [1.5 * time, 0.0, 0.0])
    push(mbs, node, 0, lambda t: 3.0)
    add_ring_friction(mbs, None, node, contact_radius=0.05, friction_coefficient=0.3, normal_load=20.0)
    (stop,) = run(mbs, 0.45, 1e-3, solver)
    assert stop[0] == pytest.approx(time, abs=1e-12)


@pytest.mark.parametrize("share", [1e-9, 3e-8, 1e-6, 1e-4])
def test_a_run_ends_at_its_end_also_just_before_a_block_rests(share):
    """The last step to rest passed the end of the run, which then never ended."""
    mbs = new_model()
    body = planar_body(mbs, MASS, INERTIA, [0.0] * 3, [1.0, 0.5, 0.0])
    add_ring_friction(mbs, None, body, contact_radius=0.0, friction_coefficient=1.0, normal_load=10.0 * MASS)
    stops = math.hypot(1.0, 0.5) / 10.0
    end = stops - share * 1e-3
    assert all(time <= end for time, *_ in run(mbs, end, end / 112))
    assert mbs.systemData.GetTime() == end
    assert np.hypot(*velocities(mbs)[:2]) == pytest.approx(10.0 * share * 1e-3, abs=2e-8)


def test_contacts_between_the_same_bodies_stop_hold_and_release_like_one_with_the_sum_of_their_loads():
    mbs, node, contacts = sliding_ring(1.0, 5.0, [10.0, 15.0, 25.0])
    push(mbs, node, 1, lambda t: 30.0 * max(0.0, t - 0.3))
    changes = run(mbs, 1.0, 1e-3)
    times = np.repeat([stop_of_ring(1.0, 5.0), 0.3 + COEFFICIENT * LOAD / 30.0], len(contacts))
    assert [time for time, *_ in changes] == pytest.approx(times, abs=1e-6)
    assert [after for *_, after in changes] == [LOCKED] * len(contacts) + [FORWARD] * len(contacts)
    assert velocities(mbs) == pytest.approx([0.0, 0.3, 0.0], abs=1e-6)  # 15 (t − 0.8)²/2 m/s at the end


def add_pin(mbs, master, place, load):
    """Add a pin with μ = 1 at a place on the only body in the plane."""
    bodies = [mbs.GetObject(item)["objectType"] for item in range(mbs.systemData.NumberOfObjects())]
    foot = mbs.AddMarker(
        items.MarkerBodyRigid(bodyNumber=bodies.index("RigidBody2D"), localPosition=[*place, 0.0])
    )
    add_ring_friction(mbs, master, foot, contact_radius=0.0, friction_coefficient=1.0, normal_load=load)


ON_POINTS = [  # with slip, stick and release; a point rests alone for 0.3 s in the first and 1e-4 s in the second
    (3, (2.92, 0.265, 1.2, 0.0606, 0.0389), [0.0599, 0.00397, 0.0, -0.0585, -0.156, -0.386], (4e-3, 2e-3)),
    (6, (3.26, 0.515, 0.797, 0.139, 0.0452), [0.0969, -0.0235, 0.0, 0.265, -0.375, 1.69], (4e-3,)),
]


@pytest.mark.parametrize(("points", "parameters", "start", "steps"), ON_POINTS)
def test_points_stick_pivot_and_break_loose_as_in_the_reference(points, parameters, start, steps):
    stiffness, friction, speed, offset, inertia = parameters
    disc = DiscOnDisc(
        mass=1.0, stiffness=stiffness, damping=0.05, friction_force=friction, disc_speed=speed, offset=offset,
        polar_inertia=inertia, contact_radius=0.15, contact_points=points, shaft_speed=0.0, shaft_damping=0.0,
    )  # fmt: skip
    exact = simulate(disc, start, [0.0, 4.0])
    errors = []
    for step in steps:
        mbs = new_model()
        master = rotor(mbs, 1e9, speed)  # heavy enough to keep its speed
        node = planar_body(mbs, 1.0, inertia, start[:3], start[3:])
        add_radial_support(mbs, None, node, stiffness=stiffness, damping=0.05, offset=[offset, 0.0])
        law = {"contact_radius": 0.15, "contact_points": points, "friction_coefficient": 1.0}
        add_ring_friction(mbs, master, node, normal_load=friction, **law)
        changes = run(mbs, 4.0, step)
        assert [after == LOCKED for *_, after in changes] == [True] * points + [False] * points
        last_rest, *releases = [time for time, *_ in changes[points - 1 :]]
        off = coordinates(mbs, node)[0] - exact.states[-1, :3]
        off_releases = np.array(releases) - exact.phases[-1].start
        errors.append(np.abs([np.abs(off).max(), last_rest - exact.phases[-2].start, *off_releases]))
    assert errors[-1].max() < 2.5e-5  # m, rad or s
    assert (errors[0] >= 3.6 ** (len(steps) - 1) * errors[-1]).all()  # of second order in the step


@pytest.mark.parametrize(
    "geometry",
    [{"contact_radius": RADIUS}, {"inner_radius": 0.05, "outer_radius": RADIUS}],
    ids=["ring", "annulus"],
)
@pytest.mark.parametrize("slip", [[0.3, -0.4, 2.0], [0.01, 0.02, -3.0], [1.0, 0.0, 0.1]])
def test_a_load_on_the_limit_surface_releases_the_contact(geometry, slip):
    """The friction of a slip lies on the limit surface; an opposite load grows until it reaches this point."""
    law = geometry | {"friction_coefficient": COEFFICIENT, "normal_load": LOAD}
    mbs = new_model()
    node = planar_body(mbs, MASS, INERTIA, [0.0, 0.0, 0.0], slip)
    contact = add_ring_friction(mbs, None, node, regularisation=1e-9, **law)
    mbs.Assemble()
    force = np.array(contact._contact.functions["force"](mbs, 0.0, 0, [0.0] * 3, slip))

    mbs = new_model()
    node = planar_body(mbs, MASS, INERTIA, [0.0, 0.0, 0.0], [0.0] * 3)
    add_ring_friction(mbs, None, node, static_ratio=1.25, **law)
    for place in range(3):
        push(mbs, node, place, lambda t, size=force[place]: -size * t / 0.4)
    ((time, _, before, after),) = run(mbs, 0.6, 1e-2)
    assert time == pytest.approx(0.5, abs=1e-9)
    assert (before, after) == (LOCKED, -1 if slip[2] < 0.0 else 1)


def test_a_load_of_the_radius_holds_a_disc_by_its_own_radius():
    mbs = new_model()
    node = planar_body(mbs, MASS, INERTIA, [0.02, 0.0, 0.0], [0.0] * 3)
    add_ring_friction(mbs, None, node, normal_load=lambda radius: LOAD * (1.0 - 20.0 * radius), **RING)
    push(mbs, node, 1, lambda t: 30.0 * t)
    ((time, *_),) = run(mbs, 0.35, 1e-2)
    assert time == pytest.approx(COEFFICIENT * 0.6 * LOAD / 30.0, abs=1e-9)


def test_a_held_disc_does_not_creep_within_an_hour():
    mbs, node, (contact,) = sliding_ring(0.2, 1.0)
    share = contact.add_sensor("capacity_share", writeToFile=False)
    push(mbs, node, 0, lambda t: 0.8 * COEFFICIENT * LOAD)
    push(mbs, node, 2, lambda t: 0.3 * COEFFICIENT * LOAD * RADIUS)
    solve_dynamic(mbs, settings_of(0.4, 400), TRAPEZOIDAL, updateInitialValues=True)
    before = np.array(mbs.systemData.GetODE2Coordinates())
    assert run(mbs, 3600.0, 10.0) == []
    assert np.abs(mbs.systemData.GetODE2Coordinates() - before).max() <= 1e-12
    assert 0.8 < mbs.GetSensorValues(share) < 1.0


@IMPLICIT
def test_a_block_on_a_belt_sticks_and_slips_with_static_friction(solver):
    """When the spring's force reaches static friction, the block swings about the position of sliding friction."""
    mass, stiffness, speed, friction, ratio = 1.0, 100.0, 0.1, 3.0, 1.5
    mbs = new_model()
    belt = planar_body(mbs, 1e20, 1.0, [0.0] * 3, [speed, 0.0, 0.0])
    block = planar_body(mbs, mass, 1.0, [0.0] * 3, [speed, 0.0, 0.0])
    markers = [coordinate(mbs, None), coordinate(mbs, block)]
    mbs.AddObject(items.ObjectConnectorCoordinateSpringDamper(markerNumbers=markers, stiffness=stiffness))
    law = {"friction_coefficient": 1.0, "normal_load": friction, "static_ratio": ratio}
    add_ring_friction(mbs, belt, block, contact_radius=0.0, **law)
    release = ratio * friction / (stiffness * speed)
    rate = math.sqrt(stiffness / mass)
    angle = math.atan2(-speed / rate, (ratio - 1.0) * friction / stiffness)
    stick = (
        release + (math.pi - 2.0 * angle) / rate
    )  # from the angle to π minus it, where the speeds are equal
    (released, *_), (stuck, *_) = run(mbs, 1.0, 1e-3, solver)
    assert released == pytest.approx(release, abs=1e-9)
    assert stuck == pytest.approx(stick, abs=5e-6)


def spatial_body(kind):
    def body(mbs, mass, inertia, position, velocity):
        vectors = [*position[:2], 0.0], [*velocity[:2], 0.0], [0.0, 0.0, velocity[2]]
        return ball(mbs, getattr(exu.NodeType, kind), mass, inertia, *vectors)

    return body


def free_pair(body, step):
    """Return the time when a body that slides and spins on another stops there; both are free."""
    mbs = new_model()
    first = body(mbs, 3.0, 0.05, [0.0, 0.0, 0.0], [0.1, 0.2, 3.0])
    second = body(mbs, 1.0, 0.01, [0.02, 0.0, 0.0], [1.0, 0.5, 20.0])
    add_ring_friction(mbs, first, second, normal_load=30.0, **RING)
    ((time, _, _, after),) = run(mbs, 0.4, step)
    assert after == LOCKED
    return time


def test_free_bodies_in_space_stick_as_planar_ones():
    planar = free_pair(planar_body, 2e-3)
    for kind in ("RotationRxyz", "RotationRotationVector"):
        assert free_pair(spatial_body(kind), 2e-3) == pytest.approx(planar, abs=1e-9)
    exact = free_pair(planar_body, 5e-4)
    coarse, fine = (free_pair(spatial_body("RotationEulerParameters"), step) - exact for step in (2e-3, 1e-3))
    assert abs(fine) < 1e-5
    assert coarse / fine == pytest.approx(4.0, rel=0.1)  # their coordinates are curved in a free motion


def test_the_pin_of_fig_5_sticks_and_slips_as_in_the_reference():
    pin = PinOnDisc(mass=1e-6, stiffness=1e-6, damping=1e-7, friction_force=9e-8, disc_speed=1.5, offset=0.1)
    start, until = (0.1, 0.0, 0.03, 0.0), 12.0
    exact = simulate(pin, start, [0.0, until], tolerance=1e-11).stick_times.ravel()
    assert len(exact) == 4
    errors = []
    for step in (8e-3, 4e-3):
        mbs = new_model()
        master = rotor(mbs, 1e20, pin.disc_speed)
        body = planar_body(mbs, pin.mass, 1.0, [*start[:2], 0.0], [*start[2:], 0.0])
        offset = (pin.offset, 0.0)
        add_radial_support(mbs, None, body, offset=offset, stiffness=pin.stiffness, damping=pin.damping)
        law = {"friction_coefficient": 1.0, "normal_load": pin.friction_force}
        add_ring_friction(mbs, master, body, contact_radius=0.0, **law)
        errors.append([time for time, *_ in run(mbs, until, step)] - exact)
    assert np.abs(errors[1]).max() < 2e-5
    assert np.linalg.norm(errors[0]) / np.linalg.norm(errors[1]) == pytest.approx(4.0, rel=0.05)


def test_joints_leave_a_guided_block_one_direction_of_slip():
    """The guide takes the side load, so only the load along the guide counts for release."""
    mbs, node, _ = sliding_ring(1.0, 0.0)
    ground = coordinate(mbs, None)
    for place in (1, 2):
        mbs.AddObject(items.ObjectConnectorCoordinate(markerNumbers=[ground, coordinate(mbs, node, place)]))
    push(mbs, node, 0, lambda t: 30.0 * max(0.0, t - 0.3))
    push(mbs, node, 1, lambda t: 30.0)
    deceleration = COEFFICIENT * LOAD / MASS
    (stop, *_), (release, *_) = run(mbs, 1.0, 1e-3)
    assert [stop, release] == pytest.approx([1.0 / deceleration, 0.8], abs=1e-6)


def test_a_disc_between_two_plates_that_rub_on_each_other_sticks_to_both():
    """The locks are more than the three bodies need, so the last one holds fewer directions."""
    mbs = new_model()
    plates = [planar_body(mbs, 1.0, 0.01, [0.0] * 3, [0.0, 0.0, spin]) for spin in (30.0, 10.0)]
    disc = planar_body(mbs, 2.0, 0.02, [0.001, 0.0, 0.0], [0.0] * 3)
    for pair, load in ((plates, 5.0), ((plates[0], disc), 50.0), ((plates[1], disc), 50.0)):
        add_ring_friction(mbs, *pair, normal_load=load, **RING)
    mbs.Assemble()
    bodies = [(plates[0], 1.0, 0.01), (plates[1], 1.0, 0.01), (disc, 2.0, 0.02)]
    before = momenta(mbs, bodies)
    assert {after for *_, after in run(mbs, 1.0, 1e-3)} == {LOCKED}
    spins = velocities(mbs)[[2, 5, 8]]
    assert np.ptp(spins) < 1e-12
    assert momenta(mbs, bodies)[2] == pytest.approx(before[2], abs=1e-6)


def test_a_contact_that_opens_returns_the_load_that_it_has_taken_over():
    mbs = new_model()
    node = planar_body(mbs, MASS, INERTIA, [0.0] * 3, [0.0] * 3)
    # The load along the line through both pins exceeds the capacity of one, until the second pin opens at 1 s.
    push(mbs, node, 1, lambda t: 15.0 if t < 0.9 else 8.0 + 10.0 * max(0.0, t - 1.5))
    add_pin(mbs, None, [0.0, -RADIUS], 10.0)
    add_pin(mbs, None, [0.0, RADIUS], lambda time: 10.0 if time < 1.0 else 0.0)
    changes = run(mbs, 2.0, 1e-2)
    assert [(pytest.approx(time, abs=1e-9), after) for time, _, _, after in changes] == [
        (1.0, 2),
        (1.7, FORWARD),
    ]
    assert velocities(mbs) == pytest.approx([0.0, 10.0 * 0.3**2 / 2.0 / MASS, 0.0], abs=1e-6)
