"""Contacts of bodies in any orientation: the same motion, or an error where it would be wrong."""

from itertools import permutations, product

import exudyn as exu
import numpy as np
import pytest
from free_bodies import ball, items, new_model, rotor, settings_of

from exudyn_models import add_native_friction, add_ring_friction, solve_dynamic
from exudyn_models.solver.linear.matrices import singular_mass

NODES = pytest.mark.parametrize(
    "node", [exu.NodeType.RotationEulerParameters, exu.NodeType.RotationRotationVector], ids=str
)
SIGNED = product(permutations(np.eye(3)), product((1.0, -1.0), repeat=3))
MATRICES = [np.array(rows) * signs for rows, signs in SIGNED]
AXES = [matrix for matrix in MATRICES if np.linalg.det(matrix) > 0.0]
"""The 24 rotations that map the axes onto each other."""
ACROSS, REVERSED = AXES[5], AXES[1]
"""Axes with the z-axis along y, and along −z."""
LAW = {"friction_coefficient": 0.25, "normal_load": 2.0, "regularisation": 0.01}
POINTS = LAW | {"contact_radius": 0.12, "contact_points": 4}  # a quarter turn maps the points onto each other


def motion(node, master_axes, disc_axes):
    """Return positions, velocities and angular velocities of both bodies at 0.1 s, in the master's first axes."""
    mbs = new_model()
    master = [0.1, 0.2, 0.3], [0.1, 0.05, 0.0], [0.0, 0.0, 2.0]
    disc = [0.15, 0.18, 0.3], [-0.2, 0.3, 0.0], [0.0, 0.0, -1.0]
    bodies = [
        ball(mbs, node, *numbers, *[master_axes @ np.array(vector) for vector in vectors], axes)
        for axes, numbers, vectors in (
            (master_axes, (2.0, 0.7), master),
            (master_axes @ disc_axes, (1.0, 0.02), disc),
        )
    ]
    add_ring_friction(mbs, *bodies, **POINTS)
    settings = settings_of(0.1, 10, newton=1e-12)
    solve_dynamic(mbs, settings, exu.DynamicSolverType.TrapezoidalIndex2)
    kinds = exu.OutputVariableType
    quantities = kinds.Position, kinds.Velocity, kinds.AngularVelocity
    return np.hstack(
        [master_axes.T @ mbs.GetObjectOutputBody(body, one) for body in bodies for one in quantities]
    )


@NODES
def test_all_orientations_of_both_bodies_give_the_same_motion(node):
    """A smaller sample would miss faults: one of them once affected only 46 scattered pairs."""
    expected = motion(node, np.eye(3), np.eye(3))
    found = [motion(node, *axes) for axes in product(AXES, AXES)]
    np.testing.assert_allclose(found, np.broadcast_to(expected, (576, 18)), rtol=0.0, atol=1e-12)


@pytest.mark.parametrize("inertia", [0.5, 0.0])
def test_only_a_body_without_inertia_is_said_to_have_none_in_any_orientation(inertia):
    for axes in AXES:
        mbs = new_model()
        ball(mbs, exu.NodeType.RotationEulerParameters, 1.0, inertia, *np.zeros((3, 3)), axes)
        mbs.Assemble()
        assert singular_mass(mbs) == "" if inertia else "coordinate 6 of node 0" in singular_mass(mbs)


@pytest.mark.parametrize(
    "moved",
    [{"referencePosition": [0.1, 0.0, 0.0]}, {"referenceRotation": ACROSS}, {"referenceRotation": REVERSED}],
)
def test_the_built_in_contact_refuses_a_rotor_or_a_ground_off_the_global_z_axis(moved):
    mbs = new_model()
    disc, node = mbs.AddNode(items.NodeRigidBody2D()), mbs.AddNode(items.Node1D())
    mbs.AddObject(items.ObjectRotationalMass1D(nodeNumber=node, inertia=1.0, **moved))
    for master in (node, mbs.AddObject(items.ObjectGround(**moved))):
        with pytest.raises(ValueError, match=r"built-in contact sits at the nodes, .* use add_ring_friction"):
            add_native_friction(mbs, master, disc, **POINTS, reach=1.0)


@pytest.mark.parametrize("is_master", [False, True])
@NODES
def test_a_body_that_spins_across_the_axis_of_the_contact_is_refused(node, is_master):
    mbs = new_model()
    body = ball(mbs, node, 1.0, 0.1, np.zeros(3), np.zeros(3), [50.0, 0.0, 1.0])
    bodies = (body, rotor(mbs, 1.0, 0.0)) if is_master else (None, body)
    with pytest.raises(ValueError, match=r"_node 0 initially spins about \[50.0, 0.0, 1.0\]"):
        add_ring_friction(mbs, *bodies, **POINTS)
    add_ring_friction(mbs, *bodies, **LAW, contact_radius=0.0)  # a pin exerts no moment
    tilted = ball(mbs, node, 1.0, 0.1, *np.zeros((3, 3)), ACROSS)
    with pytest.raises(ValueError, match=r"disc_node .* turns about"):
        add_ring_friction(mbs, tilted, rotor(mbs, 1.0, 0.0), **POINTS)
