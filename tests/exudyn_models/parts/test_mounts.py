"""Contacts anywhere on their bodies: markers, rotated axes, and rotors and grounds with any axis."""

from itertools import product

import exudyn as exu
import numpy as np
import pytest
from free_bodies import (
    ball,
    items,
    new_model,
    planar_body,
    rotations,
    run_explicitly,
    settings_of,
)
from pairs_of_bodies import assert_jacobian_is_that_of_exudyn
from test_orientations import AXES

from exudyn_models import add_radial_support, add_ring_friction, solve_dynamic
from exudyn_models.forces.friction_laws import NONE_HELD, friction_of_slip
from exudyn_models.forces.laws.places import ring_places, table_of

OUT = exu.OutputVariableType
NONE = [0.0, 0.0, 0.0]
NODES = exu.NodeType
SPATIAL = {
    "rotation vector": NODES.RotationRotationVector,
    "Tait-Bryan": NODES.RotationRxyz,
    "Euler parameters": NODES.RotationEulerParameters,
}
IMPLICIT = exu.DynamicSolverType.TrapezoidalIndex2
RING = {"contact_radius": 0.12, "friction_coefficient": 0.25, "normal_load": 2.0, "regularisation": 0.01}
THREE = RING | {"contact_points": 3}
WITH_RADIUS = THREE | {"friction_coefficient": 1.0, "normal_load": lambda radius: 1.0 + radius}
RANDOM = np.random.default_rng(7)


def random_rotation():
    return rotations.EulerParameters2RotationMatrix((e := RANDOM.normal(size=4)) / np.linalg.norm(e))


ALL_AXES = [*AXES, *[random_rotation() for _ in range(26)]]


def body_of(mbs, kind, axes, place, velocity=NONE, spin=NONE, mass=1.0, inertia=0.02):
    """Add a body with ``axes`` and motion in global coordinates; a rotor takes its spin about its z-axis."""
    if kind == "ground":
        return mbs.AddObject(items.ObjectGround(referencePosition=place, referenceRotation=axes))
    if kind == "rotor":
        node = mbs.AddNode(items.Node1D(referenceCoordinates=[0.3], initialVelocities=[axes[:, 2] @ spin]))
        frame = {"referencePosition": place, "referenceRotation": axes @ rotations.RotationMatrixZ(-0.3)}
        return mbs.AddObject(items.ObjectRotationalMass1D(nodeNumber=node, inertia=inertia, **frame))
    return ball(mbs, SPATIAL[kind], mass, inertia, place, velocity, spin, axes)


def rotor_object(node, place):
    return items.ObjectRotationalMass1D(nodeNumber=node, inertia=1.0, referencePosition=place)


def marker_on(mbs, body, place):
    return mbs.AddMarker(items.MarkerBodyRigid(bodyNumber=body, localPosition=place))


def is_singular(kind, axes):
    """Return whether the second Tait-Bryan angle is close to ±90°, where the angles are singular."""
    return kind == "Tait-Bryan" and abs(axes[0, 2]) > 0.98


PAIRS = [
    *product(SPATIAL, repeat=2),
    *product(("ground", "rotor"), (*SPATIAL, "rotor")),
    *product(SPATIAL, ("rotor",)),
]


def forces_by_exudyn(mbs, bodies, places, mounts, velocities):
    """Return the generalised forces from Exudyn's velocities of points, one coordinate at a time.

    ``places`` and ``mounts`` are position and axes of the contact in the axes of both bodies.
    """
    data = mbs.systemData
    axes = [mbs.GetObjectOutputBody(body, OUT.RotationMatrix).reshape(3, 3) for body in bodies]
    origin, centre = (
        mbs.GetObjectOutputBody(*of) for of in zip(bodies, 2 * [OUT.Position], places, strict=True)
    )
    below = axes[0].T @ (
        centre - mbs.GetObjectOutputBody(bodies[0], OUT.Position)
    )  # the master's point there
    (x, y, z), turned = (axes[0] @ mounts[0]).T, axes[1] @ mounts[1]
    slips = []
    for rates in np.eye(len(velocities)):
        data.SetODE2Coordinates_t(rates)
        velocity = mbs.GetObjectOutputBody(bodies[1], OUT.Velocity, places[1])
        spin = mbs.GetObjectOutputBody(bodies[1], OUT.AngularVelocity)
        if mbs.GetObject(bodies[0])["objectType"] != "Ground":
            velocity = velocity - mbs.GetObjectOutputBody(bodies[0], OUT.Velocity, below)
            spin = spin - mbs.GetObjectOutputBody(bodies[0], OUT.AngularVelocity)
        slips.append([x @ velocity, y @ velocity, z @ spin])
    data.SetODE2Coordinates_t(velocities)
    angle = np.arctan2(turned[:, 0] @ y, turned[:, 0] @ x)
    contact = (0.12, 3, 1.0, 0.01, NONE_HELD, table_of(ring_places(0.12, 3)))
    load = 1.0 + np.hypot(x @ (centre - origin), y @ (centre - origin))
    return load * np.array(slips) @ friction_of_slip(*(velocities @ slips), angle, contact)


def mounted_at_random(kinds, i):
    """Return a model with randomly placed and oriented bodies and contact."""
    mbs, contact = new_model(), ALL_AXES[i]
    tilted = contact @ rotations.RotationMatrixX(0.3) @ rotations.RotationMatrixZ(i)
    frames = contact, tilted
    axes = [
        contact @ rotations.RotationMatrixZ(i + 1) if kind == "rotor" else ALL_AXES[i - 7 * k]
        for k, kind in enumerate(kinds, 1)
    ]
    if any(is_singular(kind, own) for kind, own in zip(kinds, axes, strict=True)):
        axes = frames
    bodies = [body_of(mbs, kind, own, RANDOM.normal(size=3)) for kind, own in zip(kinds, axes, strict=True)]
    places = RANDOM.uniform(-0.3, 0.3, (2, 3))
    mounts = [own.T @ frame for own, frame in zip(axes, frames, strict=True)]
    friction = add_ring_friction(
        mbs,
        *[marker_on(mbs, *of) for of in zip(bodies, places, strict=True)],
        **WITH_RADIUS,
        master_rotation=mounts[0],
        disc_rotation=mounts[1],
    )
    return mbs, friction, (bodies, places, mounts)


def assert_forces_are_those_of_exudyn(mbs, friction, contact):
    mbs.Assemble()
    velocities = RANDOM.normal(size=mbs.systemData.ODE2Size())
    expected = forces_by_exudyn(mbs, *contact, velocities)
    found = -np.array(mbs.ComputeItem(friction.item, exu.ComputeItemType.ODE2LHS))
    np.testing.assert_allclose(found, expected, rtol=0.0, atol=1e-12)


@pytest.mark.parametrize("kinds", PAIRS, ids=" on ".join)
def test_forces_on_many_mounts_match_exudyns_velocities(kinds):
    for i in range(0, 50, 2):
        assert_forces_are_those_of_exudyn(*mounted_at_random(kinds, i))


def test_the_place_of_a_rotor_along_its_axis_matters_to_a_tilted_master():
    mbs = new_model()
    master = body_of(mbs, "rotation vector", rotations.RotationMatrixX(0.3), [0.1, 0.0, 0.0])
    bodies = master, mbs.AddObject(rotor_object(mbs.AddNode(items.Node1D()), [0.0, 0.0, 0.4]))
    friction = add_ring_friction(mbs, *bodies, **WITH_RADIUS)
    assert_forces_are_those_of_exudyn(mbs, friction, (bodies, np.zeros((2, 3)), 2 * [np.eye(3)]))


@pytest.mark.parametrize("kinds", PAIRS, ids=" on ".join)
def test_a_mounted_contact_has_the_jacobian_that_exudyn_finds_by_differences(kinds):
    mbs, friction, _ = mounted_at_random(kinds, 3)
    for node in friction.nodes:
        rates = RANDOM.normal(size=len(mbs.GetNodeParameter(node, "initialVelocities")))
        mbs.SetNodeParameter(node, "initialVelocities", rates)
    assert_jacobian_is_that_of_exudyn(mbs, friction.item)


WHEEL = {"contact_radius": 0.1, "friction_coefficient": 0.3, "normal_load": 800.0}
"""A brake of 24 N m."""
X = rotations.RotationMatrixY(np.pi / 2.0)
"""A frame with its z-axis along x."""
BACK = rotations.RotationMatrixX(np.pi)
"""A frame with its z-axis reversed."""


@pytest.mark.parametrize(
    ("axes", "ground", "regularisation"),
    [
        (X, "same", 1e-4),
        (X, "reversed", None),
        (X @ BACK, "same", None),
        (ALL_AXES[-1], "same", None),
        (ALL_AXES[-1], "reversed", 1e-4),
    ],
    ids=["x, regularised", "x, reversed", "against x", "any axis", "any axis, reversed, regularised"],
)
def test_a_brake_on_the_ground_stops_a_rotor_about_any_axis_anywhere(axes, ground, regularisation):
    place, mbs, stops = np.array([1.0, 2.0, 3.0]), new_model(), 2.0 * 0.5 / 24.0
    wheel = body_of(mbs, "rotor", axes, place, spin=axes[:, 2] * 2.0, inertia=0.5)
    frame = axes @ BACK if ground == "reversed" else axes @ rotations.RotationMatrixZ(0.4)
    fixed = mbs.AddObject(
        items.ObjectGround(referencePosition=place + 0.2 * axes[:, 2], referenceRotation=frame)
    )
    brake = add_ring_friction(mbs, fixed, wheel, **WHEEL, regularisation=regularisation)
    moment, slip = (brake.add_sensor(quantity) for quantity in ("transmitted_moment", "relative_spin"))
    mbs.Assemble()
    if regularisation:
        sign = -1.0 if ground == "reversed" else 1.0
        assert mbs.GetSensorValues(slip) == pytest.approx(2.0 * sign, abs=1e-12)
        assert mbs.GetSensorValues(moment) == pytest.approx(-24.0 * sign, abs=1e-12)
    changes = solve_dynamic(mbs, settings_of(0.06, 60), IMPLICIT)
    (angle,), (rate,) = mbs.systemData.GetODE2Coordinates(), mbs.systemData.GetODE2Coordinates_t()
    assert angle == pytest.approx(stops, abs=1e-4 if regularisation else 1e-9)
    assert abs(rate) < 1e-9
    if regularisation is None:
        assert [change.time for change in changes] == [pytest.approx(stops, abs=1e-9)]


@pytest.mark.parametrize("hardening", [0.0, 50.0])
@pytest.mark.parametrize("kind", ["ground", "rotor"])
def test_a_support_on_a_base_of_any_axis_holds_a_disc_as_on_the_global_one(kind, hardening):
    ends, starts = [], ([0.1, 0.2, 0.3], [0.1, 0.05, 0.0], [0.0, 0.0, 2.0])
    for turned, shift in ((np.eye(3), np.zeros(3)), (ALL_AXES[-1], np.array([1.0, -2.0, 0.5]))):
        mbs = new_model()
        base = body_of(mbs, kind, turned, shift, spin=turned[:, 2] * 2.0)
        place, *velocities = (turned @ vector for vector in starts)
        disc = body_of(mbs, "rotation vector", turned, place + shift, *velocities)
        support = add_radial_support(
            mbs, base, disc, stiffness=40.0, damping=0.5, hardening=hardening, offset=(0.02, -0.01)
        )
        sensors = [
            support.add_sensor(quantity) for quantity in ("deflection", "stored_energy", "power", "force")
        ]
        run_explicitly(mbs, 0.3, 60)
        *values, force = (mbs.GetSensorValues(sensor) for sensor in sensors)
        end = mbs.GetObjectOutputBody(disc, OUT.Position) - shift
        ends.append(np.hstack([turned.T @ end, turned.T @ force, *values, support.power(mbs, 0.3)]))
    np.testing.assert_allclose(ends[1], ends[0], rtol=0.0, atol=1e-11)


def test_axes_across_each_other_are_refused_where_a_contact_is_added():
    mbs = new_model()
    about_z = body_of(mbs, "rotor", np.eye(3), NONE)
    about_x = body_of(mbs, "rotor", X, NONE)
    tilted = body_of(mbs, "rotor", rotations.RotationMatrixX(0.1), NONE)
    planar = planar_body(mbs, 1.0, 1.0, [0.0] * 3, [0.0] * 3)
    for pair, options, words in (
        ((None, about_x), {}, r"disc_node 1 turns about \[1.0, 0.0, 0.0\]: .* \[0.0, 0.0, 1.0\]"),
        ((about_z, about_x), {}, "disc_node 1 turns about"),
        ((about_x, planar), {}, "disc_node 3 turns about"),
        ((about_z, tilted), {}, "disc_node 2 turns about"),
        ((about_z, about_x), {"master_rotation": X}, "master_node 0 turns about"),
        ((planar, about_z), {"master_rotation": X}, "master_node 3 turns about"),
    ):
        with pytest.raises(ValueError, match=words):
            add_ring_friction(mbs, *pair, **RING, **options)
        add_ring_friction(mbs, *pair, **RING | {"contact_radius": 0.0}, **options)  # a pin exerts no moment
    add_ring_friction(mbs, None, about_x, **RING, master_rotation=X)


@pytest.mark.parametrize("name", ["master_rotation", "disc_rotation"])
def test_an_invalid_rotation_is_refused(name):
    mbs = new_model()
    disc = planar_body(mbs, 1.0, 1.0, [0.0] * 3, [0.0] * 3)
    matrix = f"(?s)^{name} = .*: it must be a rotation matrix of shape"
    for rotation, words in (
        (2.0 * np.eye(3), matrix),
        (-np.eye(3), matrix),
        (np.eye(2), matrix),
        ("x", f"^{name} = 'x': it must be a number"),
        (np.full((3, 3), np.nan), f"(?s)^{name}.* = nan: it must be finite"),
    ):
        with pytest.raises(ValueError, match=words):
            add_ring_friction(mbs, None, disc, **RING, **{name: rotation})


def test_unsuitable_markers_and_rotors_without_one_axis_are_refused():
    mbs = new_model()
    disc = planar_body(mbs, 1.0, 1.0, [0.0] * 3, [0.0] * 3)
    first = body_of(mbs, "rotor", np.eye(3), NONE)
    node = exu.NodeIndex(int(mbs.GetObject(first)["nodeNumber"]))
    above = mbs.AddObject(rotor_object(node, [0.0, 0.0, 0.4]))
    add_ring_friction(mbs, node, disc, **RING)  # both bodies turn about one axis
    apart = mbs.AddObject(rotor_object(node, [0.1, 0.0, 0.0]))
    slide = mbs.AddNode(items.Node1D())
    mbs.AddObject(items.ObjectMass1D(nodeNumber=slide, mass=1.0))
    wrong = mbs.AddMarker(items.MarkerBodyPosition(bodyNumber=first))
    for master, words in (
        (wrong, "master_node 0 is a MarkerBodyPosition: it must be a MarkerBodyRigid or a MarkerNodeRigid"),
        (exu.MarkerIndex(7), "master_node 7 does not exist: this model has 1 markers"),
        (node, "master_node 1 is the Node1D of bodies on different axes: pass the ObjectIndex"),
        (slide, "master_node 2 is the Node1D of an ObjectMass1D, which translates"),
    ):
        with pytest.raises(ValueError, match=words):
            add_ring_friction(mbs, master, disc, **RING)
    for body in (first, above, apart):
        add_ring_friction(mbs, body, disc, **RING)
