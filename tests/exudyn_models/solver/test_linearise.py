"""Small motions about states with locked and sliding contacts, against constrained eigenproblems by hand."""

import itertools
import math

import numpy as np
import pytest
import scipy.linalg
import scipy.optimize
from free_bodies import (
    all_states,
    ball,
    changes_of,
    coordinate,
    drive,
    exu,
    items,
    new_model,
    planar_body,
    rotations,
    rotor,
)

from exudyn_models import add_gear, add_ring_friction, linearise
from exudyn_models.forces.axial_pairs import Mode


def spring(mbs, one, other, stiffness, damping=0.0):
    markers = [coordinate(mbs, node) for node in (one, other)]
    mbs.AddObject(
        items.ObjectConnectorCoordinateSpringDamper(
            markerNumbers=markers, stiffness=stiffness, damping=damping
        )
    )


def clutch(mbs, master, disc, moment, coefficient=1.0):
    law = {"contact_radius": 1.0, "friction_coefficient": coefficient, "normal_load": moment}
    return add_ring_friction(mbs, master, disc, **law)


def paired(found, expected):
    """Return the largest relative difference of two sets of eigenvalues."""
    distances = np.abs(found[:, None] - expected) / np.abs(expected)
    return distances[scipy.optimize.linear_sum_assignment(distances)].max()


def random_locked_train(seed):
    """Return a model with locked groups of rotors that slip against each other, and its eigenvalues by hand."""
    rng, mbs = np.random.default_rng(seed), new_model()
    count, groups = int(rng.integers(2, 9)), int(rng.integers(1, 4))
    group = rng.integers(groups, size=count)
    inertias, speeds = rng.uniform(0.3, 2.0, count), rng.normal(0.0, 5.0, groups)[group]
    nodes = [rotor(mbs, *pair) for pair in zip(inertias, speeds, strict=True)]
    stiffness, damping = np.zeros((count, count)), np.zeros((count, count))
    pairs = [(None, k) for k in range(count)] + [(k, k + 1) for k in range(count - 1)]
    for one, other in pairs:
        gradient = np.zeros(count)
        gradient[other] = 1.0
        if one is not None:
            gradient[one] = -1.0
        k, d = rng.uniform(50.0, 5e3), rng.uniform(0.0, 1.0)
        spring(mbs, None if one is None else nodes[one], nodes[other], k, d)
        stiffness += k * np.outer(gradient, gradient)
        damping += d * np.outer(gradient, gradient)
    for one, other in itertools.combinations(range(count), 2):
        load, fall = rng.uniform(1.0, 5.0), rng.uniform(0.0, 0.02)
        if group[one] == group[other]:
            clutch(mbs, nodes[one], nodes[other], 1e4)
            continue
        clutch(mbs, nodes[one], nodes[other], load, [[0.0, 0.9], [30.0, 0.9 - 30.0 * fall]])
        gradient = np.eye(count)[other] - np.eye(count)[one]
        damping -= load * fall * np.outer(gradient, gradient)
    shape = np.eye(groups)[group][:, np.unique(group)]
    mass, stiffness, damping = (shape.T @ m @ shape for m in (np.diag(inertias), stiffness, damping))
    zero, one = np.zeros_like(mass), np.eye(len(mass))
    by_hand = scipy.linalg.eigvals(
        np.block([[zero, one], [-stiffness, -damping]]), scipy.linalg.block_diag(one, mass)
    )
    return mbs, by_hand


@pytest.mark.parametrize("seed", range(20))
def test_eigenvalues_of_random_locked_trains_are_those_of_the_constrained_problem(seed):
    mbs, by_hand = random_locked_train(seed)
    found = linearise(mbs)
    assert paired(found.eigenvalues, by_hand) <= 1e-8
    np.testing.assert_allclose(found.constraints @ found.modes, 0.0, atol=1e-12)
    for value, mode in zip(found.eigenvalues, found.modes.T, strict=True):
        residual = (value**2 * found.mass + value * found.damping + found.stiffness) @ mode
        held = np.linalg.lstsq(found.constraints.T, residual, rcond=None)[0] if len(found.constraints) else 0
        np.testing.assert_allclose(found.constraints.T @ held, residual, atol=1e-8 * np.abs(residual).max())


def two_rotors_that_lock():
    """Return a rotor on a spring of 400 N m/rad, and one that two clutches of 10 and 5 N m stop on it."""
    mbs = new_model()
    one, other = rotor(mbs, 1.0, 0.0), rotor(mbs, 1.0, 1.0)
    spring(mbs, None, one, 400.0, 2.0)
    return mbs, one, other, [clutch(mbs, one, other, moment) for moment in (10.0, 5.0)]


def test_a_line_that_locked_in_a_run_has_the_frequency_of_both_rotors():
    """Exudyn's own eigenvalues are those of the rotor alone, 20 rad/s."""
    mbs, _, other, clutches = two_rotors_that_lock()
    drive(mbs, other, 3.0)
    assert linearise(mbs).contacts[0].mode == Mode.FORWARD
    assert [change[3] for change in changes_of(mbs, 2.0, 1e-3)] == [0, 0]
    before = all_states(mbs).copy(), mbs.systemData.GetODE2Coordinates(exu.ConfigurationType.Initial).copy()
    found = linearise(mbs)
    expected = -0.5 + 1j * math.sqrt(200.0 - 0.25)
    assert found.time == pytest.approx(2.0)
    assert found.eigenvalues == pytest.approx([expected.conjugate(), expected], rel=1e-10)
    assert found.damping_ratios == pytest.approx([0.5 / math.sqrt(200.0)] * 2, rel=1e-10)
    assert found.modes == pytest.approx(np.ones((2, 2)), rel=1e-10)
    np.testing.assert_array_equal(all_states(mbs), before[0])
    np.testing.assert_array_equal(mbs.systemData.GetODE2Coordinates(exu.ConfigurationType.Initial), before[1])
    first, second = found.contacts
    assert first.group == second.group == tuple(int(one.item) for one in clutches)
    total = mbs.systemData.GetODE2Coordinates_tt()[1] * 1.0 - 3.0  # the rest accelerates the second rotor
    assert (first.moment, second.moment) == pytest.approx((total * 2.0 / 3.0, total / 3.0), abs=1e-6)
    assert first.capacity_share == pytest.approx(abs(total) / 15.0, abs=1e-6)
    squares, _ = mbs.ComputeODE2Eigenvalues()
    assert max(squares) == pytest.approx(400.0)


def test_a_contact_that_carries_too_much_slips_at_the_state_where_it_would_rest():
    mbs, _, other, _ = two_rotors_that_lock()
    mbs.SetNodeParameter(other, "initialVelocities", [0.0])
    drive(mbs, other, 31.0)  # 15.5 N m for each rotor
    found = linearise(mbs)
    assert [contact.mode for contact in found.contacts] == [Mode.FORWARD, Mode.FORWARD]
    assert sorted(np.abs(found.eigenvalues).round(6)) == [0.0, 0.0, 20.0, 20.0]


def test_falling_friction_makes_a_sliding_mass_unstable():
    """Judder: D = 2 − 0.05·60 N m s/rad."""
    mbs = new_model()
    driver, disc = rotor(mbs, 1e9, 10.0), rotor(mbs, 0.5, 0.0)
    spring(mbs, None, disc, 200.0, 2.0)
    clutch(mbs, driver, disc, 60.0, [[0.0, 1.0], [20.0, 0.0]])
    found = linearise(mbs)
    unstable = found.eigenvalues[found.eigenvalues.real > 0.1]
    assert unstable.real == pytest.approx([1.0, 1.0], rel=1e-8)
    assert abs(unstable[0]) == pytest.approx(20.0, rel=1e-8)


@pytest.mark.parametrize(("moment", "efficiency"), [(50.0, 0.8), (-50.0, 1.0 / 0.6)])
def test_a_gear_with_losses_passes_on_a_share_of_spring_and_inertia(moment, efficiency):
    """The first of two rotors of 1 and 0.5 kg m² drives a spring, or is driven by it through η' = 0.6."""
    mbs = new_model()
    first, second = rotor(mbs, 1.0, 2.0), rotor(mbs, 0.5, 1.0)
    add_gear(mbs, first, second, ratio=2.0, efficiency=(0.8, 0.6))
    spring(mbs, None, second, 300.0)
    drive(mbs, first, moment)
    reflected = 4.0 * efficiency
    frequency = math.sqrt(300.0 / reflected / (1.0 + 0.5 / reflected))
    assert linearise(mbs).eigenvalues.imag == pytest.approx([-frequency, frequency], rel=1e-10)


def test_a_pendulum_has_the_stiffness_of_its_weight_until_its_dry_pivot_locks():
    def pendulum(friction):
        mbs, down = new_model(), [0.0, -0.4, -math.pi / 2.0]
        node = mbs.AddNode(items.NodeRigidBody2D(referenceCoordinates=down))
        rod = mbs.AddObject(items.ObjectRigidBody2D(nodeNumber=node, mass=2.0, inertia=0.1))
        centre = mbs.AddMarker(items.MarkerBodyRigid(bodyNumber=rod))
        mbs.AddLoad(items.Force(markerNumber=centre, loadVector=[0.0, -2.0 * 9.81, 0.0]))
        pins = [
            mbs.AddMarker(items.MarkerBodyRigid(bodyNumber=body, localPosition=[place, 0.0, 0.0]))
            for body, place in ((mbs.AddObject(items.ObjectGround()), 0.0), (rod, -0.4))
        ]
        mbs.AddObject(items.GenericJoint(markerNumbers=pins, constrainedAxes=[1, 1, 0, 0, 0, 0]))
        if friction:
            add_ring_friction(mbs, *pins, contact_radius=0.1, friction_coefficient=0.3, normal_load=10.0)
        return linearise(mbs)

    frequency = math.sqrt(2.0 * 9.81 * 0.4 / (0.1 + 2.0 * 0.4**2))
    assert pendulum(False).eigenvalues.imag == pytest.approx([-frequency, frequency], rel=1e-8)
    assert len(pendulum(True).eigenvalues) == 0


@pytest.mark.parametrize("kind", ["RotationRxyz", "RotationRotationVector", "RotationEulerParameters"])
def test_a_pendulum_in_motion_keeps_its_frequency(kind):
    """The linearised equation of J·φ̈ = −m·g·l·sin φ does not contain φ̇."""
    mbs, angle, spin = new_model(), 0.5, 2.0
    place = 0.4 * np.array([math.sin(angle), -math.cos(angle), 0.0])
    velocity = [-spin * place[1], spin * place[0], 0.0]
    axes = rotations.RotationMatrixZ(angle)
    rod = ball(mbs, getattr(exu.NodeType, kind), 2.0, 0.1, place, velocity, [0.0, 0.0, spin], axes)
    centre = mbs.AddMarker(items.MarkerBodyRigid(bodyNumber=rod))
    mbs.AddLoad(items.Force(markerNumber=centre, loadVector=[0.0, -2.0 * 9.81, 0.0]))
    ends = (mbs.AddObject(items.ObjectGround()), 0.0), (rod, 0.4)
    pins = [
        mbs.AddMarker(items.MarkerBodyRigid(bodyNumber=one, localPosition=[0.0, y, 0.0])) for one, y in ends
    ]
    mbs.AddObject(items.GenericJoint(markerNumbers=pins, constrainedAxes=[1, 1, 1, 1, 1, 0]))
    frequency = math.sqrt(2.0 * 9.81 * 0.4 * math.cos(angle) / (0.1 + 2.0 * 0.4**2))
    assert linearise(mbs).eigenvalues.imag == pytest.approx([-frequency, frequency], rel=1e-8)


def test_a_slider_in_a_rotating_slot_softens():
    """In the slot of a shaft with a prescribed speed Ω, m·r̈ + d·ṙ + (k − m·Ω²)·r is constant."""
    mbs, speed, mass, stiffness, damping = new_model(), 8.0, 1.5, 300.0, 4.0
    hub = planar_body(mbs, 1.0, 0.1, [0.0] * 3, [0.0, 0.0, speed])
    planar_body(mbs, mass, 0.01, [0.2, 0.0, 0.0], [0.0, 0.2 * speed, speed])
    for place in (0, 1, 2):
        mbs.AddObject(
            items.ObjectConnectorCoordinate(
                markerNumbers=[coordinate(mbs, None), coordinate(mbs, hub, place)],
                velocityLevel=place == 2,
                offsetUserFunction_t=(lambda mbs, t, item, offset: speed) if place == 2 else 0,
            )
        )
    ends = [mbs.AddMarker(items.MarkerBodyRigid(bodyNumber=exu.ObjectIndex(one))) for one in (0, 1)]
    mbs.AddObject(items.GenericJoint(markerNumbers=ends, constrainedAxes=[0, 1, 0, 0, 0, 1]))
    radial = np.diag([1.0, 0.0, 0.0, 0.0, 0.0, 0.0])
    mbs.AddObject(
        items.RigidBodySpringDamper(
            markerNumbers=ends,
            stiffness=stiffness * radial,
            damping=damping * radial,
            offset=[0.2 - mass * speed**2 * 0.2 / stiffness, *[0.0] * 5],
        )
    )
    expected = np.roots([mass, damping, stiffness - mass * speed**2])
    assert np.sort_complex(linearise(mbs).eigenvalues) == pytest.approx(np.sort_complex(expected), rel=1e-8)


def test_a_disc_that_sticks_in_the_plane_moves_with_its_carrier():
    mbs = new_model()
    disc, carrier = (planar_body(mbs, mass, 0.02, [0.0] * 3, [0.0] * 3) for mass in (1.0, 3.0))
    for direction, stiffness in enumerate((100.0, 900.0, 50.0)):
        markers = [coordinate(mbs, None), coordinate(mbs, carrier, direction)]
        mbs.AddObject(items.ObjectConnectorCoordinateSpringDamper(markerNumbers=markers, stiffness=stiffness))
    add_ring_friction(mbs, carrier, disc, contact_radius=0.1, friction_coefficient=0.3, normal_load=50.0)
    found = linearise(mbs)
    expected = np.repeat([5.0, 15.0, math.sqrt(50.0 / 0.04)], 2)
    assert np.abs(found.eigenvalues) == pytest.approx(expected, rel=1e-9)
    assert found.contacts[0].wrench == pytest.approx(np.zeros(3), abs=1e-9)


def test_bodies_with_euler_parameters_have_no_motion_of_their_norm():
    mbs = new_model()
    ball(mbs, exu.NodeType.RotationEulerParameters, 1.0, 0.1, [0.0] * 3, [0.0] * 3, [0.0] * 3)
    assert len(linearise(mbs).eigenvalues) == 12
