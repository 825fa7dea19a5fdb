"""Contacts between bodies of every kind: Jacobians, conserved momenta, heat, and equivalent models."""

import exudyn as exu
import numpy as np
import pytest
from free_bodies import all_states, coordinates, new_model, planar_body, rotor, run_explicitly
from pairs_of_bodies import (
    DISC,
    EULER,
    KINDS,
    MASTER,
    PAIRS,
    SPATIAL,
    assert_jacobian_is_that_of_exudyn,
    bodies_of,
    conserved,
    momenta_and_energy,
)

from exudyn_models import add_radial_support, add_ring_friction

RING = {"contact_radius": 0.12, "friction_coefficient": 0.25, "normal_load": 2.0, "regularisation": 1e-3}
ANNULUS = {"contact_radius": None, "inner_radius": 0.08, "outer_radius": 0.12}
TABLE = [[0.0, 0.5], [0.05, 0.35], [0.2, 0.3], [1.0, 0.28], [40.0, 0.4]]
GROUND = [(None, kind) for kind in KINDS]


def stribeck(slip_speed):
    return 0.2 + 0.1 * np.exp(-slip_speed)


OF_EVERYTHING = {
    "friction_coefficient": lambda slip_speed, radius: stribeck(slip_speed) + 0.1 * radius,
    "normal_load": lambda radius, time, slip_speed, relative_spin: (
        (3.0 + time + slip_speed + np.sin(relative_spin)) / (1.0 + 4.0 * radius**2)
    ),
}
CREEPS = {"regularisation": 10.0}
FEET = [(0.12, 0.0, 0.5), (-0.03, 0.07, 0.2), (-0.05, -0.06, 0.3)]
CONTACTS = {
    "pin": {"contact_radius": 0.0},
    "ring": {},
    "creeping ring": CREEPS,
    "points": {"contact_points": 6},
    "feet": {"contact_radius": None, "contact_points": FEET},
    "annulus": ANNULUS,
    "annulus that wears": ANNULUS | {"pressure": "wear"},
    "Stribeck's creeping annulus": ANNULUS | CREEPS | {"friction_coefficient": stribeck},
    "table": {"friction_coefficient": TABLE},
    **{
        f"peak at {epsilon} m/s": {"static_ratio": 1.3, "regularisation": epsilon}
        for epsilon in (0.2, 0.4, 0.7)
    },
    "creeping peak": CREEPS | {"static_ratio": 1.3},
    "plates": {"plates": 3},
    "drag and coast": {"friction_coefficient": lambda relative_spin: 0.3 + 0.1 * np.tanh(relative_spin)},
    "functions": OF_EVERYTHING,
    "all words": OF_EVERYTHING | {"friction_coefficient": TABLE, "static_ratio": 1.2, "plates": 2},
}


def pair_of(kinds, contact, **more):
    mbs, nodes = bodies_of(kinds)
    return mbs, nodes, add_ring_friction(mbs, *nodes, **RING | CONTACTS[contact] | more)


WITH_EULER = [(None, EULER), ("rotor", EULER), (EULER, "planar"), (EULER, EULER)]
CONSTANT = ("pin", "ring", "creeping ring", "points", "feet", "annulus", "annulus that wears", "plates")
"""Contacts between two rotors without our Jacobian: constant moments, or Exudyn's own connector."""
EVERY_CONTACT = [
    (None, "rotor"),
    (None, "planar"),
    ("rotor", "planar"),
    ("planar", "planar"),
    ("planar", "Tait-Bryan"),
]
"""Pairs with specialised functions, and one example of the others, whose kinds only affect the map to the slip."""
CASES = [
    (kinds, contact)
    for kinds in (*PAIRS, *GROUND)
    for contact in (CONTACTS if kinds in EVERY_CONTACT else ("creeping ring", "feet", "functions"))
    if not {*kinds} <= {None, "rotor"} or contact not in CONSTANT
] + [(kinds, "functions") for kinds in WITH_EULER]


@pytest.mark.parametrize(("kinds", "contact"), CASES, ids=str)
def test_a_contact_has_the_jacobian_that_exudyn_finds_by_differences(kinds, contact):
    mbs, _, friction = pair_of(kinds, contact)
    # The derivatives of an annulus are themselves quadratures over twelve rings.
    assert_jacobian_is_that_of_exudyn(mbs, friction.item, 1e-6 if "annulus" in contact else 1e-7)


@pytest.mark.parametrize(
    ("kinds", "contacts"),
    [
        *((kinds, ("points", "all words")) for kinds in (*PAIRS, *GROUND)),
        *(
            (kinds, (one,))
            for kinds in (("planar", "planar"), ("Tait-Bryan", "rotation vector"))
            for one in CONTACTS
        ),
    ],
    ids=str,
)
def test_contacts_keep_momenta_and_turn_energy_into_heat(kinds, contacts):
    """The integration is of order 6 or 7, and nothing slips slower than ε."""
    mbs, nodes = bodies_of(kinds)
    heats = [add_ring_friction(mbs, *nodes, **RING | CONTACTS[one]).add_sensor("heat") for one in contacts]
    mbs.Assemble()
    before, energy_before = momenta_and_energy(mbs, kinds, nodes)
    run_explicitly(mbs, 0.05, 200)
    after, energy_after = momenta_and_energy(mbs, kinds, nodes)
    change = (after - before)[conserved(kinds)]
    np.testing.assert_allclose(change, 0.0, rtol=0.0, atol=1e-12 * np.abs(before).max())
    turned = [float(mbs.GetSensorValues(heat)) for heat in heats]
    assert min(turned) > 1e-4  # all of them acted
    assert sum(turned) == pytest.approx(energy_before - energy_after, rel=1e-9)


@pytest.mark.parametrize(
    "kinds", [("rotor", "rotor"), ("planar", "planar"), ("Tait-Bryan", "rotation vector")]
)
@pytest.mark.parametrize("contact", ["points", "functions"])
def test_three_plates_are_three_contacts(kinds, contact):
    ends = []
    for contacts, more in ((1, {"plates": 3}), (3, {})):
        mbs, nodes = bodies_of(kinds)
        for _ in range(contacts):
            add_ring_friction(mbs, *nodes, **RING | CONTACTS[contact] | more)
        mbs.Assemble()
        run_explicitly(mbs, 0.05, 100)
        ends.append(all_states(mbs))
    np.testing.assert_allclose(*ends, rtol=0.0, atol=1e-13 * np.abs(ends[0]).max())


@pytest.mark.parametrize("kinds", PAIRS, ids=" on ".join)
def test_a_load_is_given_the_distance_of_the_disc_from_the_masters_axis(kinds):
    seen = []

    def load(radius):
        seen.append(radius)
        return 1.0

    mbs, nodes, _ = pair_of(kinds, "points", normal_load=load)
    mbs.Assemble()
    outputs = exu.OutputVariableType
    place, disc_place = (
        np.zeros(3) if kind == "rotor" else mbs.GetNodeOutput(node, outputs.Position)
        for kind, node in zip(kinds, nodes, strict=True)
    )
    axis = np.array([0.0, 0.0, 1.0])
    if kinds[0] in SPATIAL:
        axis = mbs.GetNodeOutput(nodes[0], outputs.RotationMatrix).reshape(3, 3)[:, 2]
    run_explicitly(mbs, 1e-6, 1)
    assert seen[0] == pytest.approx(np.linalg.norm(np.cross(disc_place - place, axis)), rel=1e-14, abs=1e-15)


@pytest.mark.parametrize("master", ["rotor", "planar"])
@pytest.mark.parametrize("node", SPATIAL)
def test_a_spatial_disc_in_the_plane_moves_as_a_planar_one(master, node):
    flat = *DISC[:2], [0.5, 0.1, 0.0, 0.0, 0.0, 0.4], [-0.2, 0.3, 0.0, 0.0, 0.0, -1.0]
    ends = []
    for kind in ("planar", node):
        mbs, nodes = bodies_of((master, kind), (MASTER, flat))
        add_ring_friction(mbs, *nodes, **RING | CONTACTS["points"])
        mbs.Assemble()
        run_explicitly(mbs, 0.4, 400)
        q, v = coordinates(mbs, nodes[1])
        ends.append([q[[0, 1, -1]], v[[0, 1, -1]]])
    np.testing.assert_allclose(ends[1], ends[0], rtol=0.0, atol=1e-13)


def test_a_body_by_its_object_is_its_node():
    mbs = new_model()
    nodes = rotor(mbs, 1.0, 0.0), planar_body(mbs, 1.0, 1.0, [0.0] * 3, [0.0] * 3)
    objects = exu.ObjectIndex(0), exu.ObjectIndex(1)
    for part in (add_ring_friction(mbs, *objects, **RING), add_radial_support(mbs, *objects, stiffness=1.0)):
        assert [int(node) for node in part.nodes] == [int(node) for node in nodes]
