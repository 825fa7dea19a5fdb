"""Bodies about whose axes a contact would not act as it must."""

from typing import Any

import exudyn as exu
import exudyn.itemInterface
import numpy as np
import pytest
from free_bodies import euler_body, planar_body, rotor, spatial_body

from exudyn_models import add_native_friction, add_radial_support, add_ring_friction

items: Any = exudyn.itemInterface
LAW = {"friction_coefficient": 0.3, "normal_load": 100.0, "regularisation": 1e-3}
POINTS = {"contact_radius": 0.1, "contact_points": 3}
ADD = {
    "friction": lambda mbs, *bodies: add_ring_friction(mbs, *bodies, **LAW, **POINTS),
    "native friction": lambda mbs, *bodies: add_native_friction(mbs, *bodies, **LAW, **POINTS, reach=1.0),
    "support": lambda mbs, *bodies: add_radial_support(mbs, *bodies, stiffness=1.0),
}
ABOUT_X = [[0.0, 0.0, 1.0], [0.0, 1.0, 0.0], [-1.0, 0.0, 0.0]]
MOVED = [
    {"referencePosition": [0.1, 0.0, 0.0]},
    {"referenceRotation": ABOUT_X},
    {"referenceRotation": np.diag([1.0, -1.0, -1.0]).tolist()},
]


@pytest.mark.parametrize("add", ADD.values(), ids=ADD)
@pytest.mark.parametrize("moved", MOVED, ids=str)
def test_a_rotor_or_a_ground_off_the_global_z_axis_is_refused(add, moved):
    mbs = exu.SystemContainer().AddSystem()
    disc = planar_body(mbs, 1.0, 0.02, [0.1, 0.0, 0.0], [0.0, 0.0, 5.0])
    node = mbs.AddNode(items.Node1D())
    mbs.AddObject(items.ObjectRotationalMass1D(nodeNumber=node, inertia=1.0, **moved))
    ground = mbs.AddObject(items.ObjectGround(**moved))
    with pytest.raises(ValueError, match=f"_node {int(node)} .* about the global z-axis"):
        add(mbs, node, disc)
    with pytest.raises(ValueError, match=f"_node {int(ground)} is an ObjectGround.* global origin"):
        add(mbs, ground, disc)


def test_a_mass_that_slides_is_not_a_rotor():
    mbs = exu.SystemContainer().AddSystem()
    node = mbs.AddNode(items.Node1D())
    mbs.AddObject(items.ObjectMass1D(nodeNumber=node, mass=1.0))
    with pytest.raises(ValueError, match="disc_node 0 is the Node1D of an ObjectMass1D"):
        add_ring_friction(mbs, None, node, **LAW, **POINTS)


@pytest.mark.parametrize("spatial", [items.NodeRigidBodyRotVecLG, items.NodeRigidBodyRxyz, None], ids=str)
@pytest.mark.parametrize("is_master", [False, True])
def test_a_body_that_spins_across_the_axis_of_the_contact_is_refused(spatial, is_master):
    mbs = exu.SystemContainer().AddSystem()
    state = [0.0] * 6, [0.0, 0.0, 0.0, 50.0, 0.0, 1.0]
    add_body = euler_body if spatial is None else lambda mbs, *data: spatial_body(mbs, spatial, *data)
    body = add_body(mbs, 1.0, [0.1] * 3, *state)
    bodies = (body, rotor(mbs, 1.0, 0.0)) if is_master else (None, body)
    with pytest.raises(ValueError, match=r"_node 0 spins about \[50.0, 0.0, 1.0\] at the start"):
        add_ring_friction(mbs, *bodies, **LAW, **POINTS)
    add_ring_friction(mbs, *bodies, **LAW, contact_radius=0.0)  # a pin exerts no moment


def test_a_rotor_across_the_axis_of_a_body_in_space_is_refused():
    mbs = exu.SystemContainer().AddSystem()
    tilted = spatial_body(
        mbs, items.NodeRigidBodyRxyz, 1.0, [0.1] * 3, [0.0, 0.0, 0.0, 0.0, 1.0, 0.0], [0.0] * 6
    )
    with pytest.raises(ValueError, match="disc_node 1 spins about"):
        add_ring_friction(mbs, tilted, rotor(mbs, 1.0, 0.0), **LAW, **POINTS)


@pytest.mark.parametrize("add", ADD.values(), ids=ADD)
def test_a_ground_of_exudyn_is_taken_by_all_parts(add):
    mbs = exu.SystemContainer().AddSystem()
    disc = planar_body(mbs, 1.0, 0.02, [0.1, 0.0, 0.0], [0.0, 0.0, 5.0])
    assert add(mbs, mbs.AddObject(items.ObjectGround()), disc)
