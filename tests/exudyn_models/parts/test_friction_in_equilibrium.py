"""Static analysis of a supported disc on a turning master: the self-centred equilibrium (eq. 3 and 4)."""

import numpy as np
import pytest
from free_bodies import coordinate, coordinates, items, new_model, planar_body, rotor, settings_of

from exudyn_models import add_radial_support, add_ring_friction

STIFFNESS, OFFSET, SPEED, RADIUS, LENGTH = 1.3, 0.1, 1.5, 0.07, 0.15
ARM = np.sqrt(OFFSET**2 - RADIUS**2)  # μN/C
PLACE = np.array([RADIUS**2 / OFFSET, ARM * RADIUS / OFFSET])


def coefficient(slip_speed):
    return 0.2 + 0.1 * np.exp(-slip_speed / 0.3)


def load(radius):
    """Return a load in N that falls with the distance from the axis and holds the disc in place."""
    falls = (1.0 + (RADIUS / LENGTH) ** 2) / (1.0 + (radius / LENGTH) ** 2)
    return STIFFNESS * ARM / coefficient(SPEED * RADIUS) * falls


NUMBERS = {"friction_coefficient": 0.25, "normal_load": STIFFNESS * ARM / 0.25}
FUNCTIONS = {"friction_coefficient": coefficient, "normal_load": load}


@pytest.mark.parametrize(
    ("contact_radius", "spin", "factors"),
    [(0.0, 0.0, NUMBERS), (0.12, SPEED, FUNCTIONS)],
    ids=["pin, numbers", "ring that turns with the master, functions"],
)
def test_static_solver_finds_the_self_centred_equilibrium(factors, contact_radius, spin):
    # A ring that turns with the master slips equally everywhere, like a pin. A static run keeps the velocities.
    mbs = new_model()
    master, disc = rotor(mbs, 1e30, SPEED), planar_body(mbs, 2.0, 0.02, [0.08, 0.03, 0.0], [0.0, 0.0, spin])
    add_radial_support(mbs, None, disc, stiffness=STIFFNESS, damping=0.1, offset=(OFFSET, 0.0))
    for node, place in ((master, 0), (disc, 2)):
        markers = [coordinate(mbs, None), coordinate(mbs, node, place)]
        mbs.AddObject(items.ObjectConnectorCoordinateSpringDamper(markerNumbers=markers, stiffness=1.0))
    add_ring_friction(mbs, master, disc, contact_radius=contact_radius, regularisation=1e-9, **factors)
    mbs.Assemble()
    settings = settings_of(1.0, 1)
    options = settings.staticSolver
    options.verboseMode = 0
    options.newton.relativeTolerance, options.newton.absoluteTolerance = 1e-12, 1e-13
    mbs.SolveStatic(settings)
    np.testing.assert_allclose(coordinates(mbs, disc)[0][:2], PLACE, rtol=0.0, atol=1e-12)
    assert (
        mbs.sys["staticSolver"].it.newtonStepsCount <= 8
    )  # Newton's method with the right Jacobian needs no more
