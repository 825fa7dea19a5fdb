from itertools import product
from typing import Any

import exudyn as exu
import exudyn.itemInterface
import numpy as np
import pytest
from free_bodies import run_explicitly
from pairs_of_bodies import (
    DISC,
    MASTER,
    PAIRS,
    SPATIAL,
    assert_implicit_order_is_two,
    assert_jacobian_is_derivative,
    body,
    conserved,
    momenta_and_energy,
)

from exudyn_models import add_ring_friction

items: Any = exudyn.itemInterface

CONTACT = {
    "contact_radius": 0.12,
    "friction_coefficient": 0.25,
    "normal_load": 2.0,
    "regularisation": 1e-3,
    "contact_points": 6,
}
OF_EVERYTHING = {
    "contact_points": None,
    "friction_coefficient": lambda slip_speed, radius: 0.2 + 0.1 * np.exp(-slip_speed) + 0.1 * radius,
    "normal_load": lambda radius, time, slip_speed: (3.0 + time + slip_speed) / (1.0 + 4.0 * radius**2),
}
ANNULUS = {"contact_radius": None, "contact_points": None, "inner_radius": 0.08, "outer_radius": 0.12}


def pair_of(kinds, **contact):
    mbs = exu.SystemContainer().AddSystem()
    nodes = [body(mbs, kind, *data) for kind, data in zip(kinds, (MASTER, DISC), strict=True)]
    return mbs, nodes, add_ring_friction(mbs, *nodes, **CONTACT | contact)


@pytest.mark.parametrize(
    ("kinds", "contact"),
    [
        *product(PAIRS, [{}, OF_EVERYTHING]),
        *product([("planar", "planar"), ("Tait-Bryan", "rotation vector")], [ANNULUS]),
    ],
)
def test_any_two_bodies_exchange_momentum_and_angular_momentum_and_turn_energy_into_heat(kinds, contact):
    mbs, nodes, friction = pair_of(kinds, **contact)
    heat = friction.add_sensor("heat")
    mbs.Assemble()
    before, energy_before = momenta_and_energy(mbs, kinds, nodes)
    run_explicitly(mbs, 0.1, 250)
    after, energy_after = momenta_and_energy(mbs, kinds, nodes)
    lost = energy_before - energy_after
    assert lost > 0.01  # the contact did act
    change = (after - before)[conserved(kinds)]
    np.testing.assert_allclose(change, 0.0, rtol=0.0, atol=1e-12 * np.abs(before).max())
    # All of them integrated at order 6 or 7: nothing slips with less than ε.
    assert float(mbs.GetSensorValues(heat)) == pytest.approx(lost, rel=1e-10)


THIRD = (1.5, [0.3, 0.2, 0.4], [0.2, 0.3, -0.2, 0.1, 0.2, -0.3], [0.3, -0.1, 0.05, -0.1, 0.05, -2.0])


@pytest.mark.parametrize(
    "kinds",
    [
        ("rotor", "planar", "rotor"),
        ("planar", "rotor", "rotation vector"),
        ("planar", "planar", "planar"),
        ("rotation vector", "planar", "Tait-Bryan"),
        ("rotation vector", "rotation vector", "Tait-Bryan"),
        ("Tait-Bryan", "Tait-Bryan", "rotation vector"),
    ],
    ids=" on ".join,
)
def test_two_clutches_in_a_chain_on_shafts_out_of_line_keep_all_momenta_and_add_up_their_heat(kinds):
    bodies = (MASTER, DISC, THIRD)
    mbs = exu.SystemContainer().AddSystem()
    nodes = [body(mbs, kind, *data) for kind, data in zip(kinds, bodies, strict=True)]
    clutches = [
        add_ring_friction(mbs, *nodes[:2], **CONTACT),
        add_ring_friction(mbs, *nodes[1:], **CONTACT | OF_EVERYTHING),
    ]
    heats = [clutch.add_sensor("heat") for clutch in clutches]
    mbs.Assemble()
    before, energy_before = momenta_and_energy(mbs, kinds, nodes, bodies)
    run_explicitly(mbs, 0.15, 500)  # all points still slip: no bend of the law disturbs the order
    after, energy_after = momenta_and_energy(mbs, kinds, nodes, bodies)
    change = (after - before)[conserved(kinds)]
    np.testing.assert_allclose(change, 0.0, rtol=0.0, atol=1e-12 * np.abs(before).max())
    turned = [float(mbs.GetSensorValues(heat)) for heat in heats]
    assert min(turned) > 0.01  # both did act
    assert sum(turned) == pytest.approx(energy_before - energy_after, rel=1e-10)


@pytest.mark.parametrize("kinds", [("planar", "planar"), ("Tait-Bryan", "rotation vector")], ids=" on ".join)
@pytest.mark.parametrize("contact", [{}, OF_EVERYTHING], ids=["numbers", "functions"])
def test_a_clutch_with_two_facings_is_one_with_twice_the_load(kinds, contact):
    ends = []
    for facings in (1, 2):
        mbs, nodes, friction = pair_of(kinds, **contact)
        if facings == 2:
            add_ring_friction(mbs, *nodes, **CONTACT | contact)
        else:
            load = (CONTACT | contact)["normal_load"]
            doubled = (
                (lambda radius, time, slip_speed, load=load: 2.0 * load(radius, time, slip_speed))
                if callable(load)
                else 2.0 * load
            )
            friction.change(normal_load=doubled)
        mbs.Assemble()
        run_explicitly(mbs, 0.2, 200)
        ends.append(np.hstack([mbs.systemData.GetODE2Coordinates(), mbs.systemData.GetODE2Coordinates_t()]))
    np.testing.assert_allclose(ends[1], ends[0], rtol=0.0, atol=1e-13 * np.abs(ends[0]).max())


@pytest.mark.parametrize("kinds", [("planar", "planar"), ("Tait-Bryan", "rotation vector")], ids=" on ".join)
def test_a_run_goes_on_under_changed_functions_with_all_momenta_kept(kinds):
    ends = []
    for changed in ({}, OF_EVERYTHING):
        mbs, nodes, friction = pair_of(kinds, contact_points=None)
        mbs.Assemble()
        before, _ = momenta_and_energy(mbs, kinds, nodes)
        for start in (0.0, 0.2):
            settings = exu.SimulationSettings()
            settings.solution.file.write = False
            options = settings.timeIntegration
            options.startTime, options.endTime = start, start + 0.2
            options.numberOfSteps, options.verboseMode = 400, 0
            mbs.SolveDynamic(settings, exu.DynamicSolverType.RK67, updateInitialValues=True)
            friction.change(**{name: changed.get(name) for name in ("friction_coefficient", "normal_load")})
        after, energy = momenta_and_energy(mbs, kinds, nodes)
        change = (after - before)[conserved(kinds)]
        np.testing.assert_allclose(change, 0.0, rtol=0.0, atol=1e-12 * np.abs(before).max())
        ends.append(energy)
    assert abs(ends[1] - ends[0]) > 1e-3 * ends[0]


@pytest.mark.parametrize("kinds", PAIRS, ids=" on ".join)
@pytest.mark.parametrize(
    "contact",
    [
        {"contact_radius": 0.7, "contact_points": 3},
        {"contact_points": None},
        ANNULUS,
        ANNULUS
        | {
            "regularisation": 100.0,
            "friction_coefficient": lambda slip_speed: 0.2 + 0.1 * np.exp(-slip_speed),
        },
        {"contact_radius": 0.0},
        {"contact_points": None, "regularisation": 100.0},
        {"contact_points": None, "friction_coefficient": lambda slip_speed: 0.2 + 0.1 * np.exp(-slip_speed)},
        {
            "contact_radius": 0.7,
            "contact_points": 3,
            "friction_coefficient": lambda slip_speed: 0.2 + 0.1 * np.exp(-slip_speed),
            "normal_load": lambda time: 3.0 + time,
        },
        OF_EVERYTHING,
    ],
    ids=[
        "points",
        "ring",
        "annulus",
        "Stribeck's creeping annulus",
        "pin",
        "creeping ring",
        "Stribeck's ring",
        "Stribeck's points, load of time",
        "load of radius, slip speed and time",
    ],
)
def test_jacobian_of_any_pair_is_the_derivative_of_the_force(kinds, contact):
    mbs, _, friction = pair_of(kinds, **contact)
    assert_jacobian_is_derivative(mbs, friction)


@pytest.mark.parametrize("kinds", PAIRS, ids=" on ".join)
def test_a_load_is_given_the_distance_of_the_disc_from_the_masters_axis(kinds):
    seen = []

    def load(radius):
        seen.append(radius)
        return 1.0

    mbs, nodes, _ = pair_of(kinds, normal_load=load)
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
@pytest.mark.parametrize("points", [None, 6])
def test_a_spatial_disc_in_the_plane_moves_as_a_planar_one(master, node, points):
    ends = []
    for kind in ("planar", node):
        mbs = exu.SystemContainer().AddSystem()
        first = body(mbs, master, *MASTER)
        flat = [0.5, 0.1, 0.0, 0.0, 0.0, 0.4], [-0.2, 0.3, 0.0, 0.0, 0.0, -1.0]
        disc = body(mbs, kind, *DISC[:2], *flat)
        add_ring_friction(mbs, first, disc, **CONTACT | {"contact_points": points})
        mbs.Assemble()
        run_explicitly(mbs, 0.4, 400)
        q, v = (
            mbs.GetNodeOutput(disc, kind) + 0.0
            for kind in (exu.OutputVariableType.Coordinates, exu.OutputVariableType.Coordinates_t)
        )
        ends.append([q[[0, 1, -1]], v[[0, 1, -1]]])
    np.testing.assert_allclose(ends[1], ends[0], rtol=0.0, atol=1e-13)


@pytest.mark.parametrize("kinds", [("rotation vector", "Tait-Bryan"), ("Tait-Bryan", "rotation vector")])
def test_the_implicit_solver_converges_to_the_explicit_one_with_order_two(kinds):
    assert_implicit_order_is_two(lambda: pair_of(kinds)[:2])
