"""Analytic Jacobians of every pair against the numerical one of Exudyn, in an assembled model."""

import exudyn as exu
import numpy as np
import pytest
from exudyn.advancedUtilities import ItemODE2Coordinates, NumericalJacobian
from pairs_of_bodies import DISC, EULER, KINDS, MASTER, PAIRS, body

from exudyn_models import add_radial_support, add_ring_friction

CONTACTS = {
    "pin": {"contact_radius": 0.0},
    "ring": {"contact_radius": 0.12},
    "creeping ring": {"contact_radius": 0.12, "regularisation": 10.0},
    "points": {"contact_radius": 0.12, "contact_points": 6},
    "annulus": {"inner_radius": 0.08, "outer_radius": 0.12},
    "annulus that wears": {"inner_radius": 0.08, "outer_radius": 0.12, "pressure": "wear"},
    "laws": {
        "contact_radius": 0.12,
        "friction_coefficient": [[0.0, 0.5], [0.2, 0.3], [40.0, 0.4]],
        "normal_load": lambda radius, relative_spin: 2.0 + radius + np.sin(relative_spin),
    },
}


OF_ANNULUS = 1e-6  # derivatives of friction there are integrals over twelve rings by themselves


def assert_of_exudyn(mbs, item, accuracy=1e-7):
    """Compare the Jacobians that the solver uses with differences of the forces, at the initial state."""
    mbs.Assemble()
    mbs.systemData.SetODE2Coordinates(mbs.systemData.GetODE2Coordinates(exu.ConfigurationType.Initial))
    mbs.systemData.SetODE2Coordinates_t(mbs.systemData.GetODE2Coordinates_t(exu.ConfigurationType.Initial))
    places = ItemODE2Coordinates(mbs, item)
    largest = 0.0
    for what, velocities in (("JacobianODE2", False), ("JacobianODE2_t", True)):
        found = np.array(mbs.ComputeItem(item, getattr(exu.ComputeItemType, what)))
        numerical = NumericalJacobian(
            mbs, lambda: mbs.ComputeItem(item, exu.ComputeItemType.ODE2LHS), places, velocities=velocities
        )
        scale = max(1.0, np.abs(numerical).max())
        np.testing.assert_allclose(found, numerical, rtol=0.0, atol=accuracy * scale, err_msg=what)
        largest = max(largest, np.abs(numerical).max())
    assert largest > 1e-4


ROTORS = ((None, "rotor"), ("rotor", "rotor"))
"""Pairs whose friction is constant where they slip, so that it has no derivative but in creep and under laws."""

CASES = [
    (kinds, contact)
    for kinds in (*PAIRS, *((None, kind) for kind in KINDS))
    for contact in CONTACTS
    if kinds not in ROTORS or contact in ("creeping ring", "laws")
]
WITH_EULER = [(None, EULER), ("rotor", EULER), (EULER, "planar"), (EULER, EULER)]
CASES += [(kinds, contact) for kinds in WITH_EULER for contact in ("ring", "creeping ring", "points", "laws")]


@pytest.mark.parametrize(("kinds", "contact"), CASES, ids=str)
def test_friction_has_the_jacobian_that_exudyn_finds_by_differences(kinds, contact):
    mbs = exu.SystemContainer().AddSystem()
    nodes = [
        None if kind is None else body(mbs, kind, *data)
        for kind, data in zip(kinds, (MASTER, DISC), strict=True)
    ]
    default = {"friction_coefficient": 0.25, "normal_load": 2.0, "regularisation": 1e-3}
    friction = add_ring_friction(mbs, *nodes, **default | CONTACTS[contact])
    assert_of_exudyn(mbs, friction.item, OF_ANNULUS if contact.startswith("annulus") else 1e-7)


@pytest.mark.parametrize("base", [None, *KINDS, EULER])
@pytest.mark.parametrize("disc", [*(kind for kind in KINDS if kind != "rotor"), EULER])
def test_a_support_has_the_jacobian_that_exudyn_finds_by_differences(base, disc):
    mbs = exu.SystemContainer().AddSystem()
    first = None if base is None else body(mbs, base, *MASTER)
    law = {"stiffness": 50.0, "damping": 0.3, "hardening": 1e3, "stop_gap": 0.1, "stop_stiffness": 1e3}
    assert_of_exudyn(mbs, add_radial_support(mbs, first, body(mbs, disc, *DISC), **law).item)
