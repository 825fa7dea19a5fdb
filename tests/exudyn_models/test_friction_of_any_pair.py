from itertools import product
from typing import Any

import exudyn as exu
import exudyn.itemInterface
import numpy as np
import pytest
from free_bodies import planar_body, rotor, run_explicitly, spatial_body, spatial_energy, spatial_momenta

from exudyn_models import add_ring_friction

items: Any = exudyn.itemInterface

KINDS = {
    "rotor": None,
    "planar": None,
    "rotation vector": items.NodeRigidBodyRotVecLG,
    "Tait-Bryan": items.NodeRigidBodyRxyz,
}
SPATIAL = ("rotation vector", "Tait-Bryan")
PAIRS = list(product(KINDS, repeat=2))

# Mass, principal moments of inertia, position and rotation, velocity and turn rates: tilted and out of line.
MASTER = (2.0, [0.5, 0.6, 0.7], [0.3, -0.2, 0.1, 0.2, -0.1, 0.1], [0.1, 0.05, -0.03, 0.02, 0.1, 2.0])
DISC = (1.0, [0.012, 0.013, 0.02], [0.5, 0.1, 0.35, -0.15, 0.1, 0.4], [-0.2, 0.3, 0.02, 0.1, -0.1, -1.0])
CONTACT = {
    "contact_radius": 0.12,
    "friction_coefficient": 0.25,
    "normal_load": 2.0,
    "regularisation": 1e-3,
    "contact_points": 6,
}
ANNULUS = {"contact_radius": None, "contact_points": None, "inner_radius": 0.08, "outer_radius": 0.12}


def body(mbs, kind, mass, inertia, position, velocity):
    if kind == "rotor":
        return rotor(mbs, inertia[2], velocity[5])
    if kind == "planar":
        return planar_body(mbs, mass, inertia[2], [*position[:2], position[5]], [*velocity[:2], velocity[5]])
    return spatial_body(mbs, KINDS[kind], mass, inertia, position, velocity)


def pair_of(kinds, **contact):
    mbs = exu.SystemContainer().AddSystem()
    nodes = [body(mbs, kind, *data) for kind, data in zip(kinds, (MASTER, DISC), strict=True)]
    return mbs, nodes, add_ring_friction(mbs, *nodes, **CONTACT | contact)


def momenta_and_energy(mbs, kinds, nodes):
    total, energy = np.zeros(6), 0.0
    for kind, node, (mass, inertia, *_) in zip(kinds, nodes, (MASTER, DISC), strict=True):
        if kind == "rotor":
            spin = float(np.squeeze(mbs.GetNodeOutput(node, exu.OutputVariableType.Coordinates_t)))
            total[5] += inertia[2] * spin
            energy += inertia[2] * spin**2 / 2.0
        else:
            total += spatial_momenta(mbs, node, mass, inertia)
            energy += spatial_energy(mbs, node, mass, np.array(inertia))
    return total, energy


def conserved(kinds):
    """Components of momentum and angular momentum that no bearing of a rotor or plane takes up."""
    if set(kinds) <= set(SPATIAL):
        return [0, 1, 2, 3, 4, 5]
    return [5] if "rotor" in kinds else [0, 1, 5]


@pytest.mark.parametrize(
    ("kinds", "contact"),
    [*product(PAIRS, [{}]), *product([("planar", "planar"), ("Tait-Bryan", "rotation vector")], [ANNULUS])],
    ids=lambda value: " on ".join(value) if isinstance(value, tuple) else "annulus" if value else "points",
)
def test_any_two_bodies_exchange_momentum_and_angular_momentum_and_turn_energy_into_heat(kinds, contact):
    mbs, nodes, friction = pair_of(kinds, **contact)
    heat = friction.add_sensor("heat")
    mbs.Assemble()
    before, energy_before = momenta_and_energy(mbs, kinds, nodes)
    run_explicitly(mbs, 0.4, 1000)
    after, energy_after = momenta_and_energy(mbs, kinds, nodes)
    lost = energy_before - energy_after
    assert lost > 0.01  # the contact did act
    change = (after - before)[conserved(kinds)]
    np.testing.assert_allclose(change, 0.0, rtol=0.0, atol=1e-12 * np.abs(before).max())
    # All of them integrated at order 6 or 7: nothing slips with less than ε.
    assert float(mbs.GetSensorValues(heat)) == pytest.approx(lost, rel=1e-10)


@pytest.mark.parametrize("kinds", PAIRS, ids=" on ".join)
@pytest.mark.parametrize(
    "contact",
    [
        {"contact_radius": 0.7, "contact_points": 3},
        {"contact_points": None},
        ANNULUS,
        ANNULUS | {"regularisation": 100.0, "friction_coefficient": lambda v: 0.2 + 0.1 * np.exp(-v)},
        {"contact_radius": 0.0},
        {"contact_points": None, "regularisation": 100.0},
        {"contact_points": None, "friction_coefficient": lambda v: 0.2 + 0.1 * np.exp(-v)},
        {
            "contact_radius": 0.7,
            "contact_points": 3,
            "friction_coefficient": lambda v: 0.2 + 0.1 * np.exp(-v),
            "normal_load": lambda t: 3.0 + t,
        },
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
    ],
)
def test_jacobian_of_any_pair_is_the_derivative_of_the_force(kinds, contact):
    mbs, nodes, friction = pair_of(kinds, **contact)
    functions = mbs.GetObject(friction.item)
    force, jacobian = (functions[f"{name}UserFunction"]["function"] for name in ("force", "jacobian"))
    size = sum(len(mbs.GetNodeParameter(node, "referenceCoordinates")) for node in nodes)
    rng = np.random.default_rng(3)
    q, v = 0.5 * rng.normal(size=size), rng.normal(size=size)
    h, t = 1e-5, 0.7

    def difference(dq, dv):
        plus, minus = (
            np.array(force(mbs, t, 0, (q + s * dq).tolist(), (v + s * dv).tolist())) for s in (h, -h)
        )
        return (plus - minus) / (2.0 * h)

    zero = np.zeros(size)
    by_position = np.array([difference(e, zero) for e in np.eye(size)]).T
    by_velocity = np.array([difference(zero, e) for e in np.eye(size)]).T
    for factors in ((1.0, 0.0), (0.0, 1.0), (3.0, -0.5)):
        expected = -factors[0] * by_position - factors[1] * by_velocity
        found = jacobian(mbs, t, 0, q.tolist(), v.tolist(), *factors)
        # Differences have an error of h² = 1e-10 times third derivatives, and of 1e-16/h.
        np.testing.assert_allclose(found, expected, rtol=0.0, atol=1e-8 * max(1.0, np.abs(expected).max()))


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
    ends = []
    for steps in (None, 20, 40, 80):
        mbs, nodes, _ = pair_of(kinds)
        mbs.Assemble()
        if steps is None:
            run_explicitly(mbs, 0.2, 400)
        else:
            settings = exu.SimulationSettings()
            settings.solution.file.write = False
            options = settings.timeIntegration
            options.endTime, options.numberOfSteps, options.verboseMode = 0.2, steps, 0
            assert exu.MainSolverImplicitSecondOrder().SolveSystem(mbs, settings)
        ends.append(np.hstack([spatial_momenta(mbs, node, 1.0, [0.0] * 3) for node in nodes]))
    errors = [np.abs(end - ends[0]).max() for end in ends[1:]]
    orders = np.log2(np.divide(errors[:-1], errors[1:]))
    np.testing.assert_allclose(orders, 2.0, atol=0.1, err_msg=str(errors))
