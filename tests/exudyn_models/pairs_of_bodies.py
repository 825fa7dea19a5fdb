"""Two bodies of every kind, tilted and out of line, and properties of any interaction between them."""

from itertools import product
from typing import Any

import exudyn as exu
import exudyn.itemInterface
import numpy as np
from exudyn.advancedUtilities import ItemODE2Coordinates, NumericalJacobian
from free_bodies import (
    euler_body,
    new_model,
    planar_body,
    rate_of,
    rotor,
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
"""Kinds for implicit solvers only, because a constraint keeps their norm."""

# Mass, principal moments of inertia, position, rotation, velocity and turn rates, all tilted and out of line.
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
        if kind is None:
            continue
        if kind == "rotor":
            spin = rate_of(mbs, node)
            total[5] += inertia[2] * spin
            energy += inertia[2] * spin**2 / 2.0
        else:
            total += spatial_momenta(mbs, node, mass, inertia)
            energy += spatial_energy(mbs, node, mass, np.array(inertia))
    return total, energy


def conserved(kinds):
    """Return the components of momentum and angular momentum that no ground, bearing or plane absorbs."""
    if None in kinds:
        return []
    if set(kinds) <= {*SPATIAL, EULER}:
        return [0, 1, 2, 3, 4, 5]
    return [5] if "rotor" in kinds else [0, 1, 5]


def bodies_of(kinds, data=(MASTER, DISC)):
    """Return a model with bodies of ``kinds``, None for the ground, and their nodes."""
    mbs = new_model()
    return mbs, [
        None if kind is None else body(mbs, kind, *values) for kind, values in zip(kinds, data, strict=True)
    ]


def assert_jacobian_is_that_of_exudyn(mbs, item, accuracy=1e-7):
    """Compare the Jacobians that solvers use with Exudyn's differences of the forces, at the initial state."""
    mbs.Assemble()
    data, initial = mbs.systemData, exu.ConfigurationType.Initial
    data.SetODE2Coordinates(data.GetODE2Coordinates(initial))
    data.SetODE2Coordinates_t(data.GetODE2Coordinates_t(initial))
    largest = 0.0
    for what, velocities in (("JacobianODE2", False), ("JacobianODE2_t", True)):
        found = np.array(mbs.ComputeItem(item, getattr(exu.ComputeItemType, what)))
        numerical = NumericalJacobian(
            mbs,
            lambda: mbs.ComputeItem(item, exu.ComputeItemType.ODE2LHS),
            ItemODE2Coordinates(mbs, item),
            velocities=velocities,
        )
        scale = max(1.0, np.abs(numerical).max())
        np.testing.assert_allclose(found, numerical, rtol=0.0, atol=accuracy * scale, err_msg=what)
        largest = max(largest, np.abs(numerical).max())
    assert largest > 1e-4
