"""Two bodies of every kind, tilted and out of line, and what holds for whatever acts between them."""

from itertools import product
from typing import Any

import exudyn as exu
import exudyn.itemInterface
import numpy as np
from free_bodies import (
    euler_body,
    planar_body,
    rotor,
    run_explicitly,
    spatial_body,
    spatial_energy,
    spatial_momenta,
)

items: Any = exudyn.itemInterface

KINDS = {
    "rotor": None,
    "planar": None,
    "rotation vector": items.NodeRigidBodyRotVecLG,
    "Tait-Bryan": items.NodeRigidBodyRxyz,
}
SPATIAL = ("rotation vector", "Tait-Bryan")
PAIRS = list(product(KINDS, repeat=2))
EULER = "Euler parameters"
"""For implicit solvers alone: their norm is a constraint."""

# Mass, principal moments of inertia, position and rotation, velocity and turn rates: tilted and out of line.
MASTER = (2.0, [0.5, 0.6, 0.7], [0.3, -0.2, 0.1, 0.2, -0.1, 0.1], [0.1, 0.05, -0.03, 0.02, 0.1, 2.0])
DISC = (1.0, [0.012, 0.013, 0.02], [0.5, 0.1, 0.35, -0.15, 0.1, 0.4], [-0.2, 0.3, 0.02, 0.1, -0.1, -1.0])


def body(mbs, kind, mass, inertia, position, velocity):
    if kind == "rotor":
        return rotor(mbs, inertia[2], velocity[5])
    if kind == "planar":
        return planar_body(mbs, mass, inertia[2], [*position[:2], position[5]], [*velocity[:2], velocity[5]])
    if kind == EULER:
        return euler_body(mbs, mass, inertia, position, velocity)
    return spatial_body(mbs, KINDS[kind], mass, inertia, position, velocity)


def momenta_and_energy(mbs, kinds, nodes, bodies=(MASTER, DISC)):
    total, energy = np.zeros(6), 0.0
    for kind, node, (mass, inertia, *_) in zip(kinds, nodes, bodies, strict=True):
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
    if set(kinds) <= {*SPATIAL, EULER}:
        return [0, 1, 2, 3, 4, 5]
    return [5] if "rotor" in kinds else [0, 1, 5]


def assert_jacobian_is_derivative(mbs, connector):
    """Compare the two user functions of a connector over its ``nodes`` with each other."""
    functions = mbs.GetObject(connector.item)
    force, jacobian = (functions[f"{name}UserFunction"]["function"] for name in ("force", "jacobian"))
    size = sum(len(mbs.GetNodeParameter(node, "referenceCoordinates")) for node in connector.nodes)
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


def assert_implicit_order_is_two(build):
    """Follow the model that ``build`` returns, with its nodes, for 0.2 s; the last one is that of the disc."""
    ends = []
    for steps in (None, 20, 40, 80):
        mbs, nodes = build()
        mbs.Assemble()
        if steps is None:
            run_explicitly(mbs, 0.2, 400)
        else:
            settings = exu.SimulationSettings()
            settings.solution.file.write = False
            options = settings.timeIntegration
            options.endTime, options.numberOfSteps, options.verboseMode = 0.2, steps, 0
            assert exu.MainSolverImplicitSecondOrder().SolveSystem(mbs, settings)
        ends.append(spatial_momenta(mbs, nodes[-1], 1.0, [0.0] * 3))
    errors = [np.abs(end - ends[0]).max() for end in ends[1:]]
    orders = np.log2(np.divide(errors[:-1], errors[1:]))
    np.testing.assert_allclose(orders, 2.0, atol=0.1, err_msg=str(errors))
