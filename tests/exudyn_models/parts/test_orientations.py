"""Contacts of bodies in space, however the axes of either body lie."""

from itertools import permutations, product
from typing import Any

import exudyn as exu
import exudyn.itemInterface
import exudyn.rigidBodyUtilities
import numpy as np
import pytest

from exudyn_models import add_ring_friction, solve_dynamic
from exudyn_models.solver.linear_matrices import singular_mass

items: Any = exudyn.itemInterface
rotations: Any = exudyn.rigidBodyUtilities

SIGNED = [
    np.eye(3)[list(order)] * signs for order in permutations(range(3)) for signs in product((1, -1), repeat=3)
]
AXES = [matrix for matrix in SIGNED if np.linalg.det(matrix) > 0.0]
"""The 24 rotations that take axes into axes."""


def body(mbs, kind, mass, inertia, position, axes, velocity, spin):
    """Add a ball in global coordinates."""
    if kind == "Euler parameters":
        angles = rotations.RotationMatrix2EulerParameters(axes)
        rates, node = rotations.AngularVelocity2EulerParameters_t(spin, angles), items.NodeRigidBodyEP
    else:
        angles, rates = rotations.RotationMatrix2RotationVector(axes), axes.T @ spin
        node = items.NodeRigidBodyRotVecLG
    number = mbs.AddNode(
        node(referenceCoordinates=[*position, *angles], initialVelocities=[*velocity, *rates])
    )
    mbs.AddObject(items.ObjectRigidBody(nodeNumber=number, mass=mass, inertia=[inertia] * 3 + [0.0] * 3))
    return number


def motion(kind, master_axes, disc_axes, points):
    """Return positions, velocities and angular velocities of both bodies at 0.1 s, in the master's first axes."""
    mbs = exu.SystemContainer().AddSystem()
    master = [[0.1, 0.2, 0.3], [0.1, 0.05, 0.0], [0.0, 0.0, 2.0]]
    disc = [[0.15, 0.18, 0.3], [-0.2, 0.3, 0.0], [0.0, 0.0, -1.0]]
    nodes = []
    for mass, inertia, axes, data in ((2.0, 0.7, np.eye(3), master), (1.0, 0.02, disc_axes, disc)):
        position, velocity, spin = (master_axes @ np.array(vector) for vector in data)
        nodes.append(body(mbs, kind, mass, inertia, position, master_axes @ axes, velocity, spin))
    contact = {"friction_coefficient": 0.25, "normal_load": 2.0, "regularisation": 0.01}
    add_ring_friction(mbs, *nodes, contact_radius=0.12, contact_points=points, **contact)
    settings = exu.SimulationSettings()
    settings.solution.file.write = False
    run = settings.timeIntegration
    run.endTime, run.numberOfSteps, run.verboseMode = 0.1, 20, 0
    run.newton.relativeTolerance = run.newton.absoluteTolerance = 1e-12
    solve_dynamic(mbs, settings, exu.DynamicSolverType.TrapezoidalIndex2)
    kinds = exu.OutputVariableType
    quantities = kinds.Position, kinds.Velocity, kinds.AngularVelocity
    return np.hstack([master_axes.T @ mbs.GetNodeOutput(node, one) for node in nodes for one in quantities])


@pytest.mark.parametrize("points", [None, 4])  # a quarter turn takes four points into each other
@pytest.mark.parametrize("kind", ["Euler parameters", "rotation vector"])
def test_all_orientations_of_both_bodies_give_the_same_motion(kind, points):
    expected = motion(kind, np.eye(3), np.eye(3), points)
    found = [motion(kind, *axes, points) for axes in product(AXES, AXES)]
    np.testing.assert_allclose(found, np.broadcast_to(expected, (576, 18)), rtol=0.0, atol=1e-12)


@pytest.mark.parametrize("inertia", [0.5, 0.0])
def test_only_a_body_without_inertia_is_said_to_have_none_in_any_orientation(inertia):
    for axes in AXES:
        mbs = exu.SystemContainer().AddSystem()
        body(mbs, "Euler parameters", 1.0, inertia, [0.0] * 3, axes, [0.0] * 3, np.zeros(3))
        mbs.Assemble()
        assert singular_mass(mbs) == "" if inertia else "coordinate 6 of node 0" in singular_mass(mbs)
