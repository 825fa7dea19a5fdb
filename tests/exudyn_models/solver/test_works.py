"""Works of contacts of all kinds: one evaluation of all powers."""

import exudyn as exu
import numpy as np
import pytest
from free_bodies import drive, new_model, planar_body, rotor, settings_of, spatial_body

from exudyn_models import add_energy_balance, add_gear, add_ring_friction, add_torsional_spring, solve_dynamic
from exudyn_models.solver.items import items
from exudyn_models.solver.works import works_of

RING = {"contact_radius": 0.1, "friction_coefficient": 0.3}
STRIBECK = [[0.0, 0.4], [0.1, 0.3], [1.0, 0.25]]


def regularised_contacts(mbs):
    """Return contacts of rotors, planar bodies and a body in space, with constant and varying friction."""
    wheel, shaft = rotor(mbs, 1.0, 9.0), rotor(mbs, 1.0, -4.0)
    disc, other = (planar_body(mbs, 2.0, 0.1, [x, 0.1, 0.3], [1.0, 0.2, 8.0]) for x in (0.01, -0.02))
    body = spatial_body(
        mbs, items.NodeRigidBodyRotVecLG, 2.0, [0.1, 0.1, 0.2], [0.1, 0, 0, 0, 0, 0], [0.3, 0, 0, 0, 0.1, 5.0]
    )
    slow = RING | {"regularisation": 0.5}
    return [
        add_ring_friction(mbs, None, wheel, normal_load=10.0, **slow),
        add_ring_friction(mbs, shaft, wheel, normal_load=lambda time: 10.0 + time, **slow),
        add_ring_friction(mbs, None, disc, normal_load=10.0, plates=2, **slow),
        add_ring_friction(mbs, wheel, disc, normal_load=20.0, contact_points=3, **slow),
        add_ring_friction(
            mbs,
            disc,
            other,
            normal_load=lambda radius: 1.0 + radius,
            **slow | {"friction_coefficient": STRIBECK},
        ),
        add_ring_friction(mbs, shaft, body, normal_load=5.0, **slow),
    ]


def exact_contacts(mbs):
    """Return contacts that slide and stick, a regularised disc in the plane, a gear and a spring with backlash."""
    wheel, shaft, held = rotor(mbs, 1.0, 9.0), rotor(mbs, 1.0, -4.0), rotor(mbs, 1.0, 0.0)
    disc = planar_body(mbs, 2.0, 0.1, [0.01, 0.0, 0.3], [1.0, 0.2, 8.0])
    drive(mbs, held, 0.1)
    return [
        add_ring_friction(mbs, None, wheel, normal_load=10.0, **RING),
        add_ring_friction(mbs, shaft, wheel, normal_load=lambda time: 10.0 + time, **RING),
        add_ring_friction(mbs, None, held, normal_load=10.0, **RING),
        add_gear(mbs, shaft, rotor(mbs, 0.1, -2.0), ratio=2.0, efficiency=0.9),
        add_torsional_spring(mbs, wheel, rotor(mbs, 0.1, 9.0), stiffness=50.0, damping=0.1, backlash=0.02),
        add_ring_friction(mbs, None, disc, normal_load=10.0, regularisation=0.1, **RING),
    ]


@pytest.mark.parametrize("contacts", [regularised_contacts, exact_contacts])
def test_one_evaluation_returns_the_powers_that_each_contact_returns_itself(contacts):
    mbs = new_model()
    found = contacts(mbs)
    losses = {str(i): contact.power for i, contact in enumerate(found)}
    add_energy_balance(mbs, gains={"drive": lambda mbs, t: 2.0 * t}, losses=losses, unit=10.0)
    for contact in found[::2]:
        contact.add_sensor("heat")
    solve_dynamic(mbs, settings_of(0.1, 100), exu.DynamicSolverType.TrapezoidalIndex2)
    own = [contact.power(mbs, 0.1) for contact in found]
    evaluated = works_of(mbs).rates(mbs, 0.1, 0, [])
    np.testing.assert_allclose(evaluated, [0.02, *(np.array(own) / 10.0), *own[::2]], rtol=1e-13, atol=1e-15)
    assert np.abs(own).max() > 1.0


def test_a_model_can_get_another_work_after_a_run():
    mbs = new_model()
    contacts = [
        add_ring_friction(mbs, None, rotor(mbs, 1.0, speed), normal_load=10.0, regularisation=0.1, **RING)
        for speed in (9.0, -4.0)
    ]
    heats = []
    for contact in contacts:
        heats.append(contact.add_sensor("heat"))
        for solver in (exu.DynamicSolverType.TrapezoidalIndex2, exu.DynamicSolverType.RK44):
            mbs.Assemble()
            solve_dynamic(mbs, settings_of(0.1, 100), solver)
            moment, found = 0.3, [mbs.GetSensorValues(heat) for heat in heats]
            expected = [moment * (speed - moment * 0.05) * 0.1 for speed in (9.0, 4.0)]
            np.testing.assert_allclose(found, expected[: len(found)], rtol=1e-9)
