"""Static analysis of a disc on springs over a master that turns: the self-centred equilibrium (eq. 3 and 4)."""

import numpy as np
import pytest
from free_bodies import (
    coordinate,
    coordinates,
    items,
    new_model,
    planar_body,
    rotor,
    settings_of,
    spatial_body,
)

from exudyn_models import add_ring_friction

MASS, STIFFNESS, DAMPING, OFFSET, SPEED = 2.0, 1.3, 0.1, 0.1, 1.5
KINDS = {
    "planar": None,
    "rotation vector": items.NodeRigidBodyRotVecLG,
    "Tait-Bryan": items.NodeRigidBodyRxyz,
}
LENGTH = 0.15


def coefficient(slip_speed):
    return 0.2 + 0.1 * np.exp(-slip_speed / 0.3)


def falling(radius):
    """Load over the load on the axis."""
    return 1.0 / (1.0 + (radius / LENGTH) ** 2)


def supported_disc(kind, place, contact, spin=0.0, held=False):
    """A disc on springs to (X₀, 0, 0) at rest in ``place`` over a master disc; its other motions have springs too."""
    mbs = new_model()
    master = rotor(mbs, 1e30, SPEED)
    if kind == "planar":
        disc = planar_body(mbs, MASS, 0.02, [*place, 0.0], [0.0, 0.0, spin])
    else:
        motion = [0.0] * 5 + [spin]
        disc = spatial_body(mbs, KINDS[kind], MASS, [0.02, 0.03, 0.04], [*place, *[0.0] * 4], motion)
    ground = mbs.AddNode(items.NodePointGround())
    reference = mbs.GetNodeParameter(disc, "referenceCoordinates")
    relaxed = [OFFSET] + [0.0] * (len(reference) - 1)
    springs = [(disc, i, relaxed[i] - reference[i]) for i in range(len(reference))]
    for node, axis, offset in [*springs, (master, 0, 0.0)] if held else springs:
        mbs.AddObject(
            items.ObjectConnectorCoordinateSpringDamper(
                markerNumbers=[coordinate(mbs, ground), coordinate(mbs, node, axis)],
                stiffness=STIFFNESS,
                damping=DAMPING if node == disc else 0.0,
                offset=offset,
            )
        )
    friction = add_ring_friction(mbs, master, disc, **{"regularisation": 1e-9} | contact)
    return mbs, disc, friction


def self_centred(radius):
    """Place of the disc's centre at a distance from the axis, and the friction that holds it there (eq. 3 and 4)."""
    arm = np.sqrt(OFFSET**2 - radius**2)  # μN/C
    return np.array([radius**2 / OFFSET, arm * radius / OFFSET]), STIFFNESS * arm


RADIUS = 0.07
PLACE, FRICTION = self_centred(RADIUS)
NUMBERS = {"friction_coefficient": 0.25, "normal_load": FRICTION / 0.25}
LOAD = FRICTION / coefficient(SPEED * RADIUS) / falling(RADIUS)  # on the axis
FUNCTIONS = {"friction_coefficient": coefficient, "normal_load": lambda radius: LOAD * falling(radius)}


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("factors", [NUMBERS, FUNCTIONS], ids=["numbers", "functions"])
@pytest.mark.parametrize(
    ("contact", "spin"),
    [({"contact_radius": 0.0}, 0.0), ({"contact_radius": 0.12}, SPEED)],
    ids=["pin", "ring that turns with the master"],
)
def test_static_solver_finds_the_self_centred_equilibrium(kind, factors, contact, spin):
    # All of a ring that turns with the master slips alike, as a pin does. A static run keeps the initial velocities.
    mbs, disc, _ = supported_disc(kind, [0.08, 0.03], contact | factors, spin, held=True)
    mbs.Assemble()
    settings = settings_of(1.0, 1)
    options = settings.staticSolver
    options.verboseMode = 0
    options.newton.relativeTolerance, options.newton.absoluteTolerance = 1e-12, 1e-13
    mbs.SolveStatic(settings)
    np.testing.assert_allclose(coordinates(mbs, disc)[0][:2], PLACE, rtol=0.0, atol=1e-12)
    assert mbs.sys["staticSolver"].it.newtonStepsCount <= 8
