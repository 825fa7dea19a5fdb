"""The parts as methods of Exudyn's MainSystem."""

from typing import Any

import exudyn as exu
import exudyn.itemInterface
import numpy as np
import pytest
from free_bodies import planar_body, run_explicitly
from pairs_of_bodies import DISC, MASTER, body

from exudyn_models import add_radial_support, add_ring_friction

items: Any = exudyn.itemInterface

FRICTION = {"friction_coefficient": [[0.0, 0.3], [1.0, 0.2]], "normal_load": lambda time: 2.0 + time}
CONTACT = FRICTION | {"regularisation": 1e-3, "static_ratio": 1.2, "plates": 2}
GEOMETRIES = [
    {"contact_radius": 0.12, "contact_points": 6},
    {"inner_radius": 0.08, "outer_radius": 0.12, "pressure": "wear"},
]
SUPPORT = {
    "stiffness": 50.0,
    "damping": 0.3,
    "hardening": 1e3,
    "stop_gap": 0.1,
    "stop_stiffness": 1e3,
    "offset": (0.01, -0.02),
}


def in_style_of_exudyn(parameters):
    def camel(name):
        first, *others = name.split("_")
        return first + "".join(word.capitalize() for word in others)

    return {camel(name): value for name, value in parameters.items()}


def end_of_run(add):
    mbs = exu.SystemContainer().AddSystem()
    nodes = [body(mbs, kind, *data) for kind, data in (("planar", MASTER), ("Tait-Bryan", DISC))]
    add(mbs, *nodes)
    mbs.Assemble()
    run_explicitly(mbs, 0.05, 100)
    return mbs.systemData.GetODE2Coordinates_t()


@pytest.mark.parametrize("geometry", GEOMETRIES, ids=["points", "annulus"])
def test_friction_that_is_created_is_that_which_is_added(geometry):
    contact = CONTACT | geometry
    added = end_of_run(lambda mbs, *nodes: add_ring_friction(mbs, *nodes, **contact))
    created = end_of_run(
        lambda mbs, *nodes: mbs.CreateRingFriction(bodyNumbers=nodes, **in_style_of_exudyn(contact))
    )
    np.testing.assert_array_equal(created, added)


def test_a_support_that_is_created_is_that_which_is_added():
    added = end_of_run(lambda mbs, *nodes: add_radial_support(mbs, *nodes, **SUPPORT))
    created = end_of_run(
        lambda mbs, *nodes: mbs.CreateRadialSupport(bodyNumbers=nodes, **in_style_of_exudyn(SUPPORT))
    )
    np.testing.assert_array_equal(created, added)


def test_a_ground_of_exudyn_is_a_master_that_rests():
    ends = []
    for of_exudyn in (False, True):
        mbs = exu.SystemContainer().AddSystem()
        disc = planar_body(mbs, 1.0, 0.02, [0.5, 0.1, 0.4], [-0.2, 0.3, -1.0])
        ground = mbs.CreateGround() if of_exudyn else None
        mbs.CreateRingFriction([ground, disc], **in_style_of_exudyn(CONTACT | GEOMETRIES[0]))
        mbs.CreateRadialSupport([ground, exu.ObjectIndex(0)], stiffness=3.0, hardening=5.0)
        mbs.Assemble()
        run_explicitly(mbs, 0.05, 100)
        ends.append(mbs.systemData.GetODE2Coordinates_t())
    np.testing.assert_array_equal(ends[0], ends[1])


@pytest.mark.parametrize(
    ("bodies", "message"),
    [
        (lambda mbs, disc: [disc], "bodyNumbers = .*: it must be a list of two bodies"),
        (lambda mbs, disc: disc, "bodyNumbers = .*: it must be a list of two bodies"),
        (
            lambda mbs, disc: [mbs.CreateGround(referencePosition=[0.1, 0.0, 0.0]), disc],
            "at the global origin",
        ),
        (lambda mbs, disc: [disc, disc], "is the (master|base)_node too"),
    ],
)
def test_what_is_no_pair_of_bodies_is_refused(bodies, message):
    mbs = exu.SystemContainer().AddSystem()
    disc = planar_body(mbs, 1.0, 0.02, [0.0] * 3, [0.0] * 3)
    with pytest.raises(ValueError, match=message):
        mbs.CreateRingFriction(bodies(mbs, disc), **in_style_of_exudyn(CONTACT | GEOMETRIES[0]))
    with pytest.raises(ValueError, match=message):
        mbs.CreateRadialSupport(bodies(mbs, disc), stiffness=1.0)
