"""The functions that Exudyn calls: planar pairs in closed form against the law for any pair, and their renewal."""

import numpy as np
import pytest
from free_bodies import new_model, planar_body, rotor

from exudyn_models import add_ring_friction
from exudyn_models.forces.any_pair import force_on_any, jacobian_on_any
from exudyn_models.forces.friction_laws import CONTACT_SIZE, CONTINUOUS, NONE_HELD
from exudyn_models.forces.jit import taking_lists
from exudyn_models.forces.planar_pairs import LAWS
from exudyn_models.forces.slip_kinematics import SIZES

CONTACTS = {
    "pin": (0.0, 1, 0.5, 1e-4, NONE_HELD, 0.0),
    "six points": (0.12, 6, 0.5, 1e-4, NONE_HELD, 0.12),
    "ring": (0.12, CONTINUOUS, 0.5, 1e-4, NONE_HELD, 0.12),
    "creeping ring": (0.12, CONTINUOUS, 0.5, 1e3, NONE_HELD, 0.12),
    "annulus": (0.12, CONTINUOUS, 0.5, 1e-4, NONE_HELD, 0.08),
}


@pytest.mark.parametrize("kinds", LAWS)
@pytest.mark.parametrize("contact", CONTACTS.values(), ids=CONTACTS)
def test_closed_form_of_planar_pairs_is_the_law_for_any_pair(kinds, contact):
    size = sum(SIZES[kind] for kind in kinds)
    first, motion = CONTACT_SIZE + 2 + size, (None, None, None, size, size)
    forces = [taking_lists(law, first, None, *motion) for law in (LAWS[kinds][0], force_on_any)]
    jacobians = [taking_lists(law, first, *motion, float, float) for law in (LAWS[kinds][1], jacobian_on_any)]
    rng = np.random.default_rng(0)
    for _ in range(20):
        reference, q, q_t = rng.normal(size=(3, size)).tolist()
        parameters, motion = [*contact, *kinds, *reference], (None, 0.0, 0, q, q_t)
        planar, general = (np.array(force(parameters, None, *motion)) for force in forces)
        np.testing.assert_allclose(planar, general, rtol=0.0, atol=1e-13)
        planar, general = (jacobian(parameters, *motion, 3.0, 0.5) for jacobian in jacobians)
        np.testing.assert_allclose(planar, general, rtol=0.0, atol=1e-11 * abs(general).max())


@pytest.mark.parametrize("master", [rotor, planar_body])
def test_force_and_jacobian_are_those_of_the_load_after_every_change(master):
    mbs = new_model()
    state = (0.7, 2.0) if master is rotor else (2.0, 0.7, [0.3, -0.2, 0.1], [0.1, 0.05, 2.0])
    nodes = master(mbs, *state), planar_body(mbs, 1.0, 0.02, [0.5, 0.1, 0.4], [-0.2, 0.3, -1.0])
    connector = add_ring_friction(
        mbs, *nodes, contact_radius=0.12, friction_coefficient=0.5, normal_load=1.0, regularisation=1e-4
    )
    mbs.Assemble()
    q, q_t = np.random.default_rng(0).normal(size=(2, 4 if master is rotor else 6)).tolist()

    def force_and_jacobian(t):
        functions = mbs.GetObject(connector.item)
        force, jacobian = (functions[f"{name}UserFunction"]["function"] for name in ("force", "jacobian"))
        return np.array(force(mbs, t, 0, q, q_t)), jacobian(mbs, t, 0, q, q_t, 3.0, 0.5)

    once = force_and_jacobian(0.0)
    assert all(abs(part).max() > 0.1 for part in once)
    loads = (
        (2.0, 0.0, 2.0),
        (lambda time: 1.0 + time, 3.0, 4.0),
        (lambda radius: 5.0, 0.0, 5.0),  # the functions for any pair
        (lambda time: 6.0 * time, 1.0, 6.0),
        (0.5, 0.0, 0.5),
    )
    for load, t, factor in loads:
        connector.change(normal_load=load)
        for found, expected in zip(force_and_jacobian(t), once, strict=True):
            np.testing.assert_allclose(found, factor * expected, rtol=0.0, atol=1e-11 * abs(expected).max())
