from dataclasses import replace

import numpy as np
import pytest

from compare.claims.paper_parameters import FIG11
from exudyn_models import eigenvalues
from reference_model import self_centred_equilibria
from reference_model.contact.contact_law import contact_of
from reference_model.systems import DiscOnDisc, PinOnDisc

PIN = PinOnDisc(mass=2.0, stiffness=1.3, damping=0.1, friction_force=0.09, disc_speed=0.7, offset=0.1)
DISC = replace(FIG11, mass=1.3, polar_inertia=0.7, stiffness=0.9, damping=0.1)


def analytic_eigenvalues(system, state):
    """Of the equations of motion, with the derivatives of the reference's friction law."""
    size = system.state_size // 2
    x, y, *angle = state[:size]
    vx, vy, *spin = state[size:]
    omega = system.disc_speed
    relative_spin = omega - spin[0] if spin else 0.0
    by_slip = contact_of(system).jacobian(
        complex(vx + omega * y, vy - omega * x), relative_spin, angle[0] if angle else 0.0
    )
    # u_x, u_y, S and φ by x, y, φ, vx, vy, φ̇
    by_state = np.zeros((4, 6))
    by_state[0, [1, 3]] = omega, 1.0
    by_state[1, [0, 4]] = -omega, 1.0
    by_state[2, 5], by_state[3, 2] = -1.0, 1.0
    forces = system.friction_force * by_slip @ by_state
    forces[:2, :2] -= support_stiffness(system, x - system.offset, y)
    forces[[0, 1], [3, 4]] -= system.damping
    inertias = [system.mass, system.mass, 1.0]
    if isinstance(system, DiscOnDisc):
        inertias[2] = system.polar_inertia
        forces[2, 5] -= system.shaft_damping
    matrix = np.zeros((6, 6))
    matrix[:3, 3:] = np.eye(3)
    matrix[3:] = forces / np.array(inertias)[:, None]
    if isinstance(system, PinOnDisc):
        own = [0, 1, 3, 4]
    else:
        own = [0, 1, 3, 4, 5] if system.contact_points is None else [0, 1, 2, 3, 4, 5]
    return np.linalg.eigvals(matrix[np.ix_(own, own)])


def support_stiffness(system, *deflection):
    """Derivative of the support's force: the tangent along the deflection, the secant across it."""
    d = np.hypot(*deflection)
    force = (
        system.stiffness * d + system.hardening * d**3 + system.stop_stiffness * max(0.0, d - system.stop_gap)
    )
    tangent = system.stiffness + 3.0 * system.hardening * d**2
    tangent += system.stop_stiffness if d > system.stop_gap else 0.0
    along = np.outer(deflection, deflection) / d**2 if d > 0.0 else np.zeros((2, 2))
    secant = force / d if d > 0.0 else system.stiffness
    return tangent * along + secant * (np.eye(2) - along)


def largest_difference(found, expected):
    """Between two sets, each value of one with the nearest of the other."""
    assert len(found) == len(expected)
    apart = np.abs(found[:, None] - expected[None, :])
    return max(apart.min(axis=0).max(), apart.min(axis=1).max())


@pytest.mark.parametrize(
    "system",
    [
        PIN,
        replace(PIN, disc_speed=-1.5),
        replace(PIN, hardening=20.0),
        replace(PIN, hardening=5.0, stop_gap=0.01, stop_stiffness=0.7),
        DISC,  # centred rotation
        replace(DISC, offset=0.1),
        replace(DISC, offset=0.1, disc_speed=-0.8, shaft_speed=-0.5),
        replace(DISC, offset=0.1, hardening=20.0),
        replace(DISC, offset=0.1, stop_stiffness=0.7),
    ],
)
def test_exudyns_linearisation_has_the_analytic_eigenvalues_of_every_equilibrium(system):
    equilibria = self_centred_equilibria(system)
    assert equilibria
    for equilibrium in equilibria:
        spin = [equilibrium.spin] if isinstance(system, DiscOnDisc) else []
        state = [equilibrium.x, equilibrium.y, *spin, 0.0, 0.0, *spin]
        if spin:
            state[2] = 0.4  # any angle
        found = eigenvalues(system, state)
        assert largest_difference(found, analytic_eigenvalues(system, state)) < 1e-8
        assert largest_difference(found, np.array(equilibrium.eigenvalues)) < 1e-8


@pytest.mark.parametrize("points", [3, 6, 24])
def test_points_keep_the_angle_in_the_linearisation(points):
    disc = replace(DISC, contact_points=points)
    state = [0.05, 0.02, 0.3, 0.01, -0.02, 1.3]
    found = eigenvalues(disc, state)
    assert len(found) == 6
    assert largest_difference(found, analytic_eigenvalues(disc, state)) < 1e-8


def test_without_friction_and_shaft_the_disc_is_an_oscillator_that_turns_freely():
    disc = replace(DISC, friction_force=0.0, shaft_damping=0.0)
    found = np.sort_complex(eigenvalues(disc, [0.0] * 6))
    decay, k = disc.damping / disc.mass / 2.0, disc.natural_frequency
    pair = -decay + 1j * np.sqrt(k**2 - decay**2)
    expected = [pair.conjugate()] * 2 + [pair] * 2 + [0.0]
    assert (
        largest_difference(found, np.array(expected)) < 1e-7
    )  # double ones are known to the root of rounding


@pytest.mark.parametrize(
    ("system", "state", "message"),
    [
        (PIN, [0.0, 0.0, 0.0, 0.0], "at rest, where friction has no derivative"),
        (DISC, [0.0, 0.0, 0.0, 0.0, 0.0, 1.5], "at rest, where friction has no derivative"),
        # Point 0 is where the speeds of the two discs are the same.
        (replace(DISC, contact_points=4), [0.0, 0.0, 0.0, 0.0, 0.12, 0.5], "or a point of it, is at rest"),
        (DISC, [0.0, 0.0, 0.0, 0.0], "DiscOnDisc takes 6 numbers"),
    ],
)
def test_a_contact_without_a_derivative_is_refused(system, state, message):
    with pytest.raises(ValueError, match=message):
        eigenvalues(system, state)
