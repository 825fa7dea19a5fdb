"""The parts as methods of Exudyn's MainSystem."""

import numpy as np
import pytest
from free_bodies import all_states, changes_of, new_model, planar_body, rotor, run_explicitly
from pairs_of_bodies import DISC, MASTER, bodies_of

from exudyn_models import add_radial_support, add_ring_friction

FRICTION = {"friction_coefficient": [[0.0, 0.3], [1.0, 0.2]], "normal_load": lambda time: 2.0 + time}
CONTACT = FRICTION | {"regularisation": 0.3, "static_ratio": 1.2, "plates": 2}
POINTS = CONTACT | {"contact_radius": 0.12, "contact_points": 6}
TURNED = {"master_rotation": np.diag([1.0, -1.0, -1.0]), "disc_rotation": np.diag([-1.0, -1.0, 1.0])}
ANNULUS = CONTACT | {"inner_radius": 0.08, "outer_radius": 0.12, "pressure": "wear"}
SUPPORT = {"stiffness": 50.0, "damping": 0.3, "hardening": 1e3, "offset": (0.01, -0.02)}
SUPPORT |= {"stop_gap": 0.1, "stop_stiffness": 1e3}


def in_style_of_exudyn(parameters):
    def camel(name):
        first, *others = name.split("_")
        return first + "".join(word.capitalize() for word in others)

    return {camel(name): value for name, value in parameters.items()}


@pytest.mark.parametrize(
    ("add", "create", "options"),
    [
        (add_ring_friction, "CreateRingFriction", POINTS | TURNED),
        (add_ring_friction, "CreateRingFriction", ANNULUS | TURNED),
        (add_radial_support, "CreateRadialSupport", SUPPORT),
    ],
    ids=["points", "annulus", "support"],
)
def test_create_functions_add_the_same_parts(add, create, options):
    ends = []
    for created in (False, True):
        mbs, nodes = bodies_of(("rotation vector", "Tait-Bryan"), (MASTER, DISC))
        if created:
            getattr(mbs, create)(bodyNumbers=nodes, **in_style_of_exudyn(options))
        else:
            add(mbs, *nodes, **options)
        run_explicitly(mbs, 0.05, 10)
        ends.append(all_states(mbs))
    np.testing.assert_array_equal(ends[0], ends[1])


def test_couplings_are_created_between_bodies_by_their_numbers():
    mbs = new_model()
    ground = mbs.CreateGround()
    shafts = [rotor(mbs, 1.0, speed) for speed in (2.0, 1.0)]
    gear = mbs.CreateGear([*shafts], ratio=2.0, efficiency=0.9)
    brake = mbs.CreateSliderFriction(
        [ground, shafts[0]], frictionCoefficient=0.5, normalLoad=10.0, secondRadius=0.2
    )
    assert [[int(node) for node in one.nodes] for one in (gear, brake)] == [[0, 1], [0]]
    # The second shaft drives: J₁ + J₂·η/i² = 1.225 kg m² against 1 N m.
    assert [time for time, *_ in changes_of(mbs, 3.0, 1e-3)][:1] == pytest.approx([2.0 * 1.225], abs=1e-6)
    with pytest.raises(TypeError, match="second_radius is not an argument; these are frictionCoefficient"):
        mbs.CreateSliderFriction([ground, shafts[0]], second_radius=0.2)
    with pytest.raises(ValueError, match="it must be a list of three bodies, case, left, right"):
        mbs.CreateDifferential(shafts)


def test_an_invalid_pair_of_bodies_is_refused():
    mbs = new_model()
    disc = planar_body(mbs, 1.0, 0.02, [0.0] * 3, [0.0] * 3)
    no_pair = "bodyNumbers = .*: it must be a list of two bodies"
    for bodies, message in (
        ([disc], no_pair),
        (disc, no_pair),
        ([disc, disc], "is also the (master|base)_node"),
    ):
        with pytest.raises(ValueError, match=message):
            mbs.CreateRingFriction(bodies, **in_style_of_exudyn(POINTS))
        with pytest.raises(ValueError, match=message):
            mbs.CreateRadialSupport(bodies, stiffness=1.0)


def test_a_contact_without_regularisation_sticks_exactly():
    mbs = new_model()
    disc = planar_body(mbs, 1.0, 0.5, [0.0] * 3, [0.0, 0.0, 3.0])
    mbs.CreateRingFriction(
        [mbs.CreateGround(), disc], contactRadius=0.1, frictionCoefficient=0.3, normalLoad=800.0
    )
    ((stop, *_),) = changes_of(mbs, 0.1, 1e-3)
    assert stop == pytest.approx(3.0 * 0.5 / 24.0)
