from typing import Any

import exudyn as exu
import exudyn.itemInterface
import numpy as np
import pytest
from free_bodies import coordinates, momenta, planar_body, rotor, run_explicitly

from exudyn_models import add_ring_friction, build_pin_on_disc
from reference_model.systems import PinOnDisc

items: Any = exudyn.itemInterface

CONTACT = {
    "contact_radius": 0.0,
    "friction_coefficient": 0.25,
    "normal_load": 2.0,
    "regularisation": 1e-3,
    "contact_points": 1,
}
ANNULUS = {"contact_radius": None, "contact_points": None, "inner_radius": 0.08, "outer_radius": 0.12}


@pytest.mark.parametrize(("radius", "points"), [(0.0, 1), (0.12, 3), (0.12, 6), (0.3, 24), (0.12, None)])
def test_two_free_bodies_keep_their_momentum_and_angular_momentum(radius, points):
    mbs = exu.SystemContainer().AddSystem()
    master = planar_body(mbs, 2.0, 0.7, [0.3, -0.2, 0.1], [0.1, 0.05, 2.0])
    disc = planar_body(mbs, 1.0, 0.02, [0.5, 0.1, 0.4], [-0.2, 0.3, -1.0])
    add_ring_friction(
        mbs,
        master,
        disc,
        friction_coefficient=0.25,
        normal_load=2.0,
        contact_radius=radius,
        contact_points=points,
        regularisation=1e-3,
    )
    mbs.Assemble()
    bodies = [(master, 2.0, 0.7), (disc, 1.0, 0.02)]
    before, (_, velocity_before) = momenta(mbs, bodies), coordinates(mbs, master)
    run_explicitly(mbs, 3.0)
    _, velocity_after = coordinates(mbs, master)
    assert np.linalg.norm(velocity_after - velocity_before) > 0.1  # the contact did act
    np.testing.assert_allclose(momenta(mbs, bodies), before, rtol=1e-12, atol=1e-13)


def test_rotor_takes_up_the_angular_momentum_about_its_axis_that_a_free_disc_loses():
    mbs = exu.SystemContainer().AddSystem()
    master = rotor(mbs, 0.7, 2.0)
    disc = planar_body(mbs, 1.0, 0.02, [0.5, 0.1, 0.4], [-0.2, 0.3, -1.0])
    add_ring_friction(mbs, master, disc, **CONTACT | {"contact_radius": 0.12, "contact_points": 6})
    mbs.Assemble()

    def angular_momentum() -> float:
        return momenta(mbs, [(disc, 1.0, 0.02)])[2] + 0.7 * coordinates(mbs, master)[1][0]

    before = angular_momentum()
    run_explicitly(mbs, 3.0)
    assert abs(coordinates(mbs, master)[1][0] - 2.0) > 0.1
    assert angular_momentum() == pytest.approx(before, rel=1e-12)


@pytest.mark.parametrize("planar_master", [False, True])
@pytest.mark.parametrize(
    ("radius", "points", "regularisation"),
    [
        *[
            (radius, points, 1e-4) for radius, points in ((0.0, 1), (0.12, 6), (0.12, None))
        ],  # Coulomb friction
        *[
            (radius, points, 10.0) for radius, points in ((0.0, 1), (0.12, 1), (0.12, None))
        ],  # viscous friction
    ],
)
def test_jacobian_is_the_derivative_of_the_force(planar_master, radius, points, regularisation):
    mbs = exu.SystemContainer().AddSystem()
    state = [0.3, -0.2, 0.1], [0.1, 0.05, 2.0]
    master = planar_body(mbs, 2.0, 0.7, *state) if planar_master else rotor(mbs, 0.7, 2.0)
    disc = planar_body(mbs, 1.0, 0.02, [0.5, 0.1, 0.4], [-0.2, 0.3, -1.0])
    connector = add_ring_friction(
        mbs,
        master,
        disc,
        friction_coefficient=0.25,
        normal_load=2.0,
        contact_radius=radius,
        contact_points=points,
        regularisation=regularisation,
    )
    functions = mbs.GetObject(connector.item)
    force = functions["forceUserFunction"]["function"]
    jacobian = functions["jacobianUserFunction"]["function"]
    rng = np.random.default_rng(1)
    size = 6 if planar_master else 4
    q, v = rng.normal(size=size), rng.normal(size=size)
    h = 1e-6

    def difference(dq: np.ndarray, dv: np.ndarray) -> np.ndarray:
        def at(sign: float) -> np.ndarray:
            return np.array(force(mbs, 0.0, 0, (q + sign * h * dq).tolist(), (v + sign * h * dv).tolist()))

        return (at(1.0) - at(-1.0)) / (2.0 * h)

    zero, unit = np.zeros(size), np.eye(size)
    by_position = np.array([difference(e, zero) for e in unit]).T
    by_velocity = np.array([difference(zero, e) for e in unit]).T
    arguments = mbs, 0.0, 0, q.tolist(), v.tolist()
    np.testing.assert_allclose(jacobian(*arguments, 1.0, 0.0), -by_position, atol=2e-9)
    np.testing.assert_allclose(jacobian(*arguments, 0.0, 1.0), -by_velocity, atol=2e-9)
    np.testing.assert_allclose(
        jacobian(*arguments, 3.0, 0.5), -3.0 * by_position - 0.5 * by_velocity, atol=1e-8
    )


@pytest.mark.parametrize("omega", [1.5, 0.7, -1.5])
def test_exudyns_linearisation_has_the_eigenvalues_of_the_self_centred_equilibrium(omega):
    # Eq. 3 and 4: ρ² = X0² − (μN/C)², x = ρ²/X0, y = ±(μN/C)ρ/X0.
    pin = PinOnDisc(mass=2.0, stiffness=1.3, damping=0.1, friction_force=0.09, disc_speed=omega, offset=0.1)
    arm = pin.friction_force / pin.stiffness
    rho = np.sqrt(pin.offset**2 - arm**2)
    x, y = rho**2 / pin.offset, np.sign(omega) * arm * rho / pin.offset
    # m r̈ = −βṙ − C(r − X0) − μN u/|u| with u = ṙ − ω×r: d(u/|u|) = (1 − e⊗e) du/|u|.
    turn = omega * np.array([[0.0, -1.0], [1.0, 0.0]])
    slip = -turn @ [x, y]
    speed = np.hypot(*slip)
    direction = slip / speed
    np.testing.assert_allclose(
        pin.stiffness * np.array([x - pin.offset, y]) + pin.friction_force * direction, 0.0, atol=1e-15
    )
    friction = pin.friction_force * (np.eye(2) - np.outer(direction, direction)) / speed
    matrix = np.zeros((4, 4))
    matrix[:2, 2:] = np.eye(2)
    matrix[2:, :2] = (-pin.stiffness * np.eye(2) + friction @ turn) / pin.mass
    matrix[2:, 2:] = (-pin.damping * np.eye(2) - friction) / pin.mass
    expected = np.sort_complex(np.linalg.eigvals(matrix))

    model = build_pin_on_disc(pin, np.array([x, y, 0.0, 0.0]), regularisation=1e-9)
    values, _ = model.mbs.ComputeODE2Eigenvalues(computeComplexEigenvalues=True, useAbsoluteValues=False)
    values = np.asarray(values)
    # Besides, the master disc and the pin's own angle are free to turn: four zeros.
    found = np.sort_complex(values[np.argsort(np.abs(values))[-4:]])
    np.testing.assert_allclose(found, expected, rtol=0.0, atol=1e-10)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"friction_coefficient": -1.0}, "friction_coefficient = -1: it must be >= 0"),
        ({"friction_coefficient": "steel"}, "friction_coefficient = 'steel': it must be a number"),
        ({"normal_load": -1.0}, "normal_load = -1 N: it must be >= 0"),
        ({"normal_load": float("nan")}, "normal_load = nan"),
        ({"contact_radius": -0.1}, "contact_radius = -0.1 m"),
        ({"contact_points": 0}, "contact_points = 0"),
        ({"contact_points": 2.5}, "contact_points = 2.5"),
        ({"contact_radius": None}, "contact_radius = None: it must be a number"),
        (ANNULUS | {"inner_radius": -0.1}, "inner_radius = -0.1 m: it must be >= 0"),
        (ANNULUS | {"inner_radius": None}, "inner_radius = None: it must be a number"),
        (ANNULUS | {"outer_radius": 0.08}, "outer_radius = 0.08 m: it must be > inner_radius = 0.08 m"),
        (ANNULUS | {"outer_radius": float("inf")}, "outer_radius = inf"),
        (ANNULUS | {"contact_radius": 0.1}, "contact_radius = 0.1: it must be left out for an annulus"),
        (ANNULUS | {"contact_points": 6}, "contact_points = 6: it must be left out for an annulus"),
        (ANNULUS | {"regularisation": -1.0}, "regularisation = -1 m/s"),
        ({"held": 2}, "held = 2: it must be from 1 to the number of points, 1"),
        ({"held": 0}, "held = 0: it must be from 1 to the number of points, 1"),
        ({"held": 1, "contact_points": None, "contact_radius": 0.1}, "held = 1: it must be from 1"),
        ({"regularisation": 0.0}, "regularisation = 0 m/s"),
    ],
)
def test_nonsense_is_refused_with_its_name_and_value(change, message):
    mbs = exu.SystemContainer().AddSystem()
    master, disc = rotor(mbs, 1.0, 0.0), planar_body(mbs, 1.0, 1.0, [0.0] * 3, [0.0] * 3)
    arguments = CONTACT | change
    with pytest.raises(ValueError, match=message):
        add_ring_friction(mbs, master, disc, **arguments)


@pytest.mark.parametrize("node", [items.NodePoint(), items.NodePoint2D()])
@pytest.mark.parametrize("name", ["master_node", "disc_node"])
def test_a_node_of_the_wrong_kind_is_refused_with_the_kinds_that_serve(node, name):
    mbs = exu.SystemContainer().AddSystem()
    nodes = {"master_node": rotor(mbs, 1.0, 0.0), "disc_node": rotor(mbs, 1.0, 0.0)}
    nodes[name] = mbs.AddNode(node)
    kinds = "Node1D, NodeRigidBody2D, NodeRigidBodyRotVecLG, NodeRigidBodyRxyz or NodeRigidBodyEP"
    with pytest.raises(ValueError, match=rf"{name} 2 is a Node\w+: it must be a {kinds}$"):
        add_ring_friction(mbs, **nodes, **CONTACT)


@pytest.mark.parametrize(
    ("index", "message"),
    [
        (exu.NodeIndex(7), "7 is none of the 2 nodes of this model"),
        (exu.NodeIndex(), "-1 is none of the 2 nodes of this model"),
        (exu.ObjectIndex(7), "7 is none of the 2 objects of this model"),
        (exu.MarkerIndex(1), "= 1 is of type MarkerIndex: it must be a NodeIndex"),
        (1.0, r"= 1\.0 is of type float: it must be a NodeIndex"),
        ("disc", "= 'disc' is of type str: it must be a NodeIndex or the ObjectIndex of a body"),
    ],
)
@pytest.mark.parametrize("name", ["master_node", "disc_node"])
def test_what_is_no_node_of_the_model_is_refused(index, message, name):
    mbs = exu.SystemContainer().AddSystem()
    nodes = {"master_node": rotor(mbs, 1.0, 0.0), "disc_node": rotor(mbs, 1.0, 0.0)}
    with pytest.raises(ValueError, match=f"^{name} {message}"):
        add_ring_friction(mbs, **nodes | {name: index}, **CONTACT)


def test_a_body_has_no_friction_with_itself():
    mbs = exu.SystemContainer().AddSystem()
    disc = planar_body(mbs, 1.0, 1.0, [0.0] * 3, [0.0] * 3)
    with pytest.raises(ValueError, match="disc_node 0 is the master_node too"):
        add_ring_friction(mbs, disc, disc, **CONTACT)
