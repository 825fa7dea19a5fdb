import math

import exudyn as exu
import exudyn.itemInterface
import numpy as np
import pytest
from free_bodies import planar_body, rotor, run_explicitly
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
from scipy.integrate import quad
from scipy.optimize import brentq
from scipy.special import ellipj

from exudyn_models import add_energy_balance, add_radial_support

GROUND = "ground"
ON_BODIES = [kinds for kinds in PAIRS if kinds[1] != "rotor"]
ALL_PAIRS = [(GROUND, kind) for kind in ("planar", *SPATIAL)] + ON_BODIES

SUPPORT = {"stiffness": 3.0, "damping": 0.4, "hardening": 20.0, "offset": (0.05, -0.03)}
STOP = {"stop_gap": 0.2, "stop_stiffness": 30.0}


def supported(kinds, data=(MASTER, DISC), **support):
    """A disc on a support, by kinds of base and disc and what ``body`` takes of both."""
    mbs = exu.SystemContainer().AddSystem()
    nodes = [
        None if kind == GROUND else body(mbs, kind, *values) for kind, values in zip(kinds, data, strict=True)
    ]
    return mbs, nodes, add_radial_support(mbs, *nodes, **support)


def of_disc(mbs, node):
    """x, y and angle of a disc and their rates."""
    q, q_t = (
        mbs.GetNodeOutput(node, kind) + 0.0
        for kind in (exu.OutputVariableType.Coordinates, exu.OutputVariableType.Coordinates_t)
    )
    q += mbs.GetNodeParameter(node, "referenceCoordinates")
    return np.hstack((q[[0, 1, -1]], q_t[[0, 1, -1]]))


def force_at(d, stiffness=0.0, hardening=0.0, stop_gap=0.0, stop_stiffness=0.0, **_):
    return stiffness * d + hardening * d**3 + stop_stiffness * max(0.0, d - stop_gap)


@pytest.mark.parametrize("kinds", ON_BODIES, ids=" on ".join)
def test_any_two_bodies_exchange_momentum_and_angular_momentum(kinds):
    mbs, nodes, support = supported(kinds, **SUPPORT | STOP)
    beyond = support.add_sensor("deflection")
    mbs.Assemble()
    before, _ = momenta_and_energy(mbs, kinds, nodes)
    run_explicitly(mbs, 0.4, 500)
    after, _ = momenta_and_energy(mbs, kinds, nodes)
    lengths = np.linalg.norm(mbs.GetSensorStoredData(beyond)[:, 1:], axis=1)
    assert lengths.min() < STOP["stop_gap"] < lengths.max()  # all of the law acted
    change = (after - before)[conserved(kinds)]
    np.testing.assert_allclose(change, 0.0, rtol=0.0, atol=1e-12 * np.abs(before).max())


@pytest.mark.parametrize("kinds", ON_BODIES, ids=" on ".join)
def test_what_the_bodies_lose_is_in_the_springs_and_in_the_damper(kinds):
    mbs, _, support = supported(kinds, **SUPPORT)
    balance = add_energy_balance(
        mbs, gains={}, losses={"damper": support.power}, stored=[support.stored_energy]
    )
    mbs.Assemble()
    run_explicitly(mbs, 0.4, 500)
    found = balance()
    assert found.losses["damper"][-1] > 0.01
    assert np.all(np.diff(found.losses["damper"]) > 0.0)
    assert (
        abs(found.residual).max() < 1e-10 * found.turnover
    )  # all of order 6 or 7, at 1e-3 of the time scales


@pytest.mark.parametrize("kinds", ALL_PAIRS, ids=" on ".join)
@pytest.mark.parametrize("stop", [{}, STOP], ids=["hardening", "stop"])
def test_jacobian_is_the_derivative_of_the_force(kinds, stop):
    mbs, _, support = supported(kinds, **SUPPORT | stop)
    assert_jacobian_is_derivative(mbs, support)


FLAT_BASE = (2.0, [0.5, 0.6, 0.7], [0.3, -0.2, 0.0, 0.0, 0.0, 0.1], [0.1, 0.05, 0.0, 0.0, 0.0, 2.0])
FLAT_DISC = (1.0, [0.012, 0.013, 0.02], [0.5, 0.1, 0.0, 0.0, 0.0, 0.4], [-0.2, 0.3, 0.0, 0.0, 0.0, -1.0])


@pytest.mark.parametrize("kinds", [kinds for kinds in ALL_PAIRS if kinds[0] != "rotor"], ids=" on ".join)
@pytest.mark.parametrize("law", [{"hardening": 0.0}, {}, STOP], ids=["linear", "hardening", "stop"])
def test_bodies_in_the_plane_move_as_planar_ones(kinds, law):
    ends = []
    flat = GROUND if kinds[0] == GROUND else "planar"
    for pair in (kinds, (flat, "planar")):
        mbs, nodes, _ = supported(pair, (FLAT_BASE, FLAT_DISC), **SUPPORT | law)
        mbs.Assemble()
        run_explicitly(mbs, 0.4, 200)
        ends.append(np.hstack([of_disc(mbs, node) for node in nodes if node is not None]))
    np.testing.assert_allclose(ends[0], ends[1], rtol=0.0, atol=1e-13)


@pytest.mark.parametrize("kind", ["planar", *SPATIAL])
@pytest.mark.parametrize(
    "law", [{"hardening": 0.0}, {"hardening": 0.0, "stop_gap": 9.0, "stop_stiffness": 1.0}, {}]
)
def test_the_ground_is_a_body_that_nothing_moves(kind, law):
    ends = []
    heavy = (1.0, [0.0, 0.0, 1e30], [0.0] * 6, [0.0] * 6)
    for base in (GROUND, "rotor"):
        mbs, nodes, support = supported((base, kind), (heavy, DISC), **SUPPORT | law)
        shown = [
            support.add_sensor(quantity) for quantity in ("deflection", "force", "stored_energy", "power")
        ]
        mbs.Assemble()
        run_explicitly(mbs, 1.0, 200)
        ends.append(np.hstack([of_disc(mbs, nodes[1]), *(mbs.GetSensorValues(sensor) for sensor in shown)]))
    np.testing.assert_allclose(ends[0], ends[1], rtol=0.0, atol=1e-13)


@pytest.mark.parametrize("gap", [0.2, 0.7])
def test_sensors_show_the_law(gap):
    support = SUPPORT | STOP | {"offset": (0.2, 0.1), "stop_gap": gap}
    mbs = exu.SystemContainer().AddSystem()
    base = planar_body(mbs, 2.0, 0.5, [1.0, 2.0, math.pi / 2.0], [0.0, 0.0, 3.0])
    # In the axes of the base, turned by 90°, the disc is at (0.5, 0.5), 0.5 from where the support is relaxed.
    disc = planar_body(mbs, 1.0, 0.5, [0.5, 2.5, 0.0], [-1.5, -1.3, 0.0])
    handle = add_radial_support(mbs, base, disc, **support)
    shown = {
        quantity: handle.add_sensor(quantity)
        for quantity in ("deflection", "force", "stored_energy", "power")
    }
    mbs.Assemble()
    found = {quantity: np.atleast_1d(mbs.GetSensorValues(sensor)) for quantity, sensor in shown.items()}
    # The base takes its point under the disc along with 3·(−0.5, −0.5), so that (0, 0.2) is left to the damper.
    np.testing.assert_allclose(found["deflection"], [0.3, 0.4], atol=1e-15)
    share = force_at(0.5, **support) / 0.5
    np.testing.assert_allclose(found["force"], [0.4 * share, -0.3 * share - 0.4 * 0.2, 0.0], atol=1e-14)
    energy = quad(lambda d: force_at(d, **support), 0.0, 0.5, points=[0.2])[0]
    assert found["stored_energy"] == pytest.approx(energy, rel=1e-12)
    assert handle.stored_energy(mbs) == pytest.approx(energy, rel=1e-12)
    assert found["power"] == pytest.approx(0.4 * 0.2**2, rel=1e-12)
    assert handle.power(mbs, 0.0) == pytest.approx(0.4 * 0.2**2, rel=1e-12)


def test_a_damper_on_a_body_takes_nothing_of_a_turn_of_both_as_one_rigid_body():
    # Bodies that turn with ω about their centre of mass, apart by d: the spring C·d bears m·ω²·d/2 of each.
    mass, d, stiffness = 2.0, 0.3, 5.0
    speed = math.sqrt(2.0 * stiffness / mass)
    mbs = exu.SystemContainer().AddSystem()
    nodes = [
        planar_body(mbs, mass, 0.5, [side * d / 2.0, 0.0, 0.0], [0.0, side * speed * d / 2.0, speed])
        for side in (-1.0, 1.0)
    ]
    support = add_radial_support(mbs, *nodes, stiffness=stiffness, damping=3.0)
    mbs.Assemble()
    end = 10.0
    run_explicitly(mbs, end, 4000)
    assert support.power(mbs, end) < 1e-20
    turn = np.exp(1j * speed * end)
    np.testing.assert_allclose(
        of_disc(mbs, nodes[1])[:2], [d / 2.0 * turn.real, d / 2.0 * turn.imag], atol=1e-10
    )


@pytest.mark.parametrize("speed", [0.5, 2.0])
def test_a_disc_on_an_eccentric_shaft_runs_out_and_centres_itself_above_its_critical_speed(speed):
    # On a support that turns at the distance e from the axis: r = C·e/(C − m·ω²), of the other sign above √(C/m).
    stiffness, e = 1.0, 0.1
    r = stiffness * e / (stiffness - speed**2)
    mbs = exu.SystemContainer().AddSystem()
    shaft = rotor(mbs, 1e30, speed)
    disc = planar_body(mbs, 1.0, 0.5, [r, 0.0, 0.0], [0.0, speed * r, 0.0])
    add_radial_support(mbs, shaft, disc, stiffness=stiffness, damping=0.2, offset=(e, 0.0))
    mbs.Assemble()
    end = 3.0
    run_explicitly(mbs, end, 2000)
    turn = r * np.exp(1j * speed * end)
    np.testing.assert_allclose(of_disc(mbs, disc)[:2], [turn.real, turn.imag], atol=1e-12)


@pytest.mark.parametrize("law", [{"hardening": 20.0}, {"hardening": 5.0} | STOP], ids=["hardening", "stop"])
def test_a_mass_circles_in_the_support_with_the_secant_stiffness(law):
    stiffness, radius, mass = 3.0, 0.4, 1.7
    speed = math.sqrt(force_at(radius, stiffness, **law) / radius / mass)
    mbs = exu.SystemContainer().AddSystem()
    disc = planar_body(mbs, mass, 1.0, [0.1 + radius, -0.2, 0.0], [0.0, speed * radius, 0.0])
    add_radial_support(mbs, None, disc, stiffness=stiffness, offset=(0.1, -0.2), **law)
    mbs.Assemble()
    run_explicitly(mbs, 2.0 * math.tau / speed, 2000)
    np.testing.assert_allclose(of_disc(mbs, disc)[:2], [0.1 + radius, -0.2], atol=1e-10)


def test_a_mass_swings_through_the_hardening_spring_as_the_elliptic_function():
    # m·ẍ = −C·x − C₃·x³ from rest at A: x = A·cn(pt), p² = (C + C₃A²)/m, parameter C₃A²/(2mp²).
    stiffness, hardening, amplitude, mass, end = 3.0, 20.0, 0.6, 1.7, 7.0
    rate = math.sqrt((stiffness + hardening * amplitude**2) / mass)
    parameter = hardening * amplitude**2 / (2.0 * mass * rate**2)
    mbs = exu.SystemContainer().AddSystem()
    direction = np.exp(0.7j)
    place = amplitude * direction
    disc = planar_body(mbs, mass, 1.0, [place.real, place.imag, 0.0], [0.0, 0.0, 0.0])
    add_radial_support(mbs, None, disc, stiffness=stiffness, hardening=hardening)
    mbs.Assemble()
    run_explicitly(mbs, end, 2000)
    expected = amplitude * ellipj(rate * end, parameter)[1] * direction
    np.testing.assert_allclose(of_disc(mbs, disc)[:2], [expected.real, expected.imag], atol=1e-10)


@pytest.mark.parametrize(
    "kinds", [(GROUND, "planar"), ("rotor", "planar"), ("Tait-Bryan", "rotation vector")]
)
def test_the_implicit_solver_converges_to_the_explicit_one_with_order_two(kinds):
    assert_implicit_order_is_two(lambda: supported(kinds, **SUPPORT)[:2])


def test_the_static_solver_finds_where_spring_and_load_balance():
    stiffness, hardening, load = 3.0, 20.0, 1.3
    mbs = exu.SystemContainer().AddSystem()
    disc = planar_body(mbs, 1.0, 1.0, [0.0, 0.0, 0.0], [0.0, 0.0, 0.0])
    add_radial_support(mbs, None, disc, stiffness=stiffness, hardening=hardening, offset=(0.1, 0.0), **STOP)
    items = exudyn.itemInterface
    marker = mbs.AddMarker(items.MarkerNodePosition(nodeNumber=disc))
    mbs.AddLoad(items.Force(markerNumber=marker, loadVector=[0.0, load, 0.0]))
    hold = mbs.AddMarker(items.MarkerNodeCoordinate(nodeNumber=disc, coordinate=2))
    still = mbs.AddMarker(
        items.MarkerNodeCoordinate(nodeNumber=mbs.AddNode(items.NodePointGround()), coordinate=0)
    )
    mbs.AddObject(items.CoordinateConstraint(markerNumbers=[still, hold]))
    mbs.Assemble()
    settings = exu.SimulationSettings()
    settings.solution.file.write = False
    settings.staticSolver.newton.relativeTolerance = 1e-12
    settings.staticSolver.newton.maxIterations = 10
    assert exu.MainSolverStatic().SolveSystem(mbs, settings)
    d = brentq(lambda d: force_at(d, stiffness, hardening, **STOP) - load, 0.0, 1.0, xtol=1e-15)
    np.testing.assert_allclose(of_disc(mbs, disc)[:2], [0.1, d], atol=1e-10)


@pytest.mark.parametrize(
    ("support", "message"),
    [
        ({"stiffness": -1.0}, "stiffness = -1 N/m: it must be >= 0"),
        ({"damping": math.nan}, "damping = nan: it must be finite"),
        ({"hardening": -2.0}, "hardening = -2 N/m³: it must be >= 0"),
        ({"stop_gap": -0.1}, "stop_gap = -0.1 m: it must be >= 0"),
        ({"stop_stiffness": math.inf}, "stop_stiffness = inf: it must be finite"),
        ({"stop_stiffness": "stiff"}, "stop_stiffness = 'stiff': it must be a number"),
        ({"offset": 0.1}, "offset = 0.1: it must be two numbers, x and y in m"),
        ({"offset": (0.0, 0.0, 0.0)}, r"offset = \(0.0, 0.0, 0.0\): it must be two numbers"),
        ({"offset": (0.0, math.nan)}, r"offset\[1\] = nan: it must be finite"),
    ],
)
def test_numbers_that_no_support_has_are_refused(support, message):
    with pytest.raises(ValueError, match=message):
        supported((GROUND, "planar"), **{"stiffness": 1.0} | support)


def test_nodes_that_no_support_can_hold_are_refused():
    mbs = exu.SystemContainer().AddSystem()
    shaft, disc = rotor(mbs, 1.0, 0.0), planar_body(mbs, 1.0, 1.0, [0.0] * 3, [0.0] * 3)
    point = mbs.AddNode(exudyn.itemInterface.NodePoint())
    kinds = "NodeRigidBody2D, NodeRigidBodyRotVecLG, NodeRigidBodyRxyz or NodeRigidBodyEP"
    with pytest.raises(ValueError, match=f"disc_node 0 is a Node1D: it must be a {kinds}$"):
        add_radial_support(mbs, None, shaft, stiffness=1.0)
    with pytest.raises(ValueError, match=f"base_node 2 is a NodePoint: it must be a Node1D, {kinds}$"):
        add_radial_support(mbs, point, disc, stiffness=1.0)
    with pytest.raises(ValueError, match="disc_node 1 is the base_node too"):
        add_radial_support(mbs, disc, disc, stiffness=1.0)
    support = add_radial_support(mbs, shaft, disc, stiffness=1.0)
    with pytest.raises(ValueError, match="quantity = 'stress': it must be one of deflection, force"):
        support.add_sensor("stress")
