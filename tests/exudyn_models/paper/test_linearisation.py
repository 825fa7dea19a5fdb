"""Exudyn's linearisation: it has the reference's eigenvalues at equilibria, and those of the plain equations in
slip."""

from dataclasses import replace

import numpy as np
import pytest

from compare.claims.parameters import FIG11
from exudyn_models import eigenvalues
from reference_model import plain, self_centred_equilibria
from reference_model.contact.contact_law import contact_of
from reference_model.systems import DiscOnDisc, PinOnDisc

PIN = PinOnDisc(mass=2.0, stiffness=1.3, damping=0.1, friction_force=0.09, disc_speed=0.7, offset=0.1)
DISC = replace(FIG11, mass=1.3, polar_inertia=0.7, stiffness=0.9, damping=0.1)


def largest_difference(found, expected):
    """Return the largest distance of a value of one set from the nearest value of the other."""
    assert len(found) == len(expected)
    apart = np.abs(found[:, None] - expected[None, :])
    return max(apart.min(axis=0).max(), apart.min(axis=1).max())


@pytest.mark.parametrize(
    "system",
    [
        replace(PIN, disc_speed=-1.5),
        replace(PIN, hardening=5.0, stop_gap=0.01, stop_stiffness=0.7),
        DISC,  # centred rotation
        replace(DISC, offset=0.1, disc_speed=-0.8, shaft_speed=-0.5),
        replace(DISC, offset=0.1, hardening=20.0, stop_stiffness=0.7),
    ],
)
def test_every_equilibrium_has_the_eigenvalues_of_the_reference(system):
    equilibria = self_centred_equilibria(system)
    assert equilibria
    for equilibrium in equilibria:
        state = [equilibrium.x, equilibrium.y, 0.0, 0.0]
        if isinstance(system, DiscOnDisc):  # at any angle
            state = [equilibrium.x, equilibrium.y, 0.4, 0.0, 0.0, equilibrium.spin]
        assert largest_difference(eigenvalues(system, state), np.array(equilibrium.eigenvalues)) < 1e-8


@pytest.mark.parametrize("system", [PIN, *(replace(DISC, contact_points=points) for points in (3, 6, 24))])
def test_any_slip_has_the_eigenvalues_of_the_plain_equations(system):
    """The linearisation of a disc on points contains the angle."""
    state = np.array([0.05, 0.02, 0.01, -0.02] if system is PIN else [0.05, 0.02, 0.3, 0.01, -0.02, 1.3])
    law, step = plain.by_law(system.friction_force, contact_of(system)), 1e-5

    def rates(change):
        return np.array(plain.rates(system, law, state + change))

    matrix = np.array([(rates(step * e) - rates(-step * e)) / (2.0 * step) for e in np.eye(len(state))]).T
    # Differences have an error of step² = 1e-10 times third derivatives of friction, which are 1/slip² ~ 1e3 times
    # friction.
    assert largest_difference(eigenvalues(system, state.tolist()), np.linalg.eigvals(matrix)) < 1e-6
