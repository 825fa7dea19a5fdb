"""Growth rate of a modulation as a function of its amplitude, against simulated motions."""

from dataclasses import replace

import numpy as np
import pytest

from compare.claims.parameters import FIG11
from reference_model.contact.contact_law import Ring, ThreeTermRing
from reference_model.simulation import simulate
from reference_model.steady.bifurcation_curves import ParameterPlane, crossings
from reference_model.steady.lyapunov_coefficient import growth_by_amplitude, polar_rates
from reference_model.steady.stability import turning_frame_jacobian
from reference_model.steady.steady_states import whirls

PLANE = ParameterPlane(FIG11, ("disc_speed", "friction_force"), (1.3, 0.001), (3.0, 0.08))
RING, THREE_TERMS = Ring(0.12), ThreeTermRing(0.12)


def marginal_whirl(which):
    """Return a disc at ω = 1.5 rad/s on a Hopf curve, and its whirl."""
    disc = replace(FIG11, friction_force=crossings(PLANE, "Hopf", "disc_speed", 1.5)[which])
    return disc, min(whirls(disc), key=lambda whirl: abs(whirl.eigenvalues[1].real))


def simulated_growth(disc, whirl, amplitude):
    """Return (1/a₀² − 1/a₁²)/2 over a period of the modulation from ȧ = c·a³.

    a is half the difference between extremes of the radius, which removes the second harmonic.
    """
    values, vectors = np.linalg.eig(turning_frame_jacobian(disc, whirl.state))
    pair = int(np.argmin(np.abs(values - whirl.eigenvalues[1])))
    shift = (amplitude * whirl.radius / vectors[0, pair] * vectors[:, pair]).real
    period = 2.0 * np.pi / abs(values[pair].imag)
    times = np.linspace(0.0, 4.0 * period, 8001)
    start = whirl.state + np.insert(shift, 2, 0.0)
    radius = simulate(disc, start, times, tolerance=1e-11, compiled=True).radius
    turns = np.flatnonzero(np.diff(np.sign(np.diff(radius)))) + 1
    sizes, instants = [], []
    for i in turns:
        a, b, c = radius[i - 1 : i + 2]
        offset = 0.5 * (a - c) / (a - 2.0 * b + c)
        sizes.append(b - 0.25 * (a - c) * offset)
        instants.append(times[i] + offset * (times[1] - times[0]))
    # The fast components of the start have decayed by the third extreme.
    extremes, instants = np.array(sizes[2:]), np.array(instants[2:])
    swing = np.abs(np.diff(extremes)) / (2.0 * whirl.radius)
    return (1.0 / swing[0] ** 2 - 1.0 / swing[2] ** 2) / (2.0 * (instants[2] - instants[0]))


@pytest.mark.parametrize(("which", "amplitude"), [(0, 0.05), (1, 0.006)])
def test_growth_of_simulated_modulations_is_cubic_in_the_amplitude(which, amplitude):
    """The next order is smaller by the amplitude squared; extrapolation removes 90 % of it."""
    disc, whirl = marginal_whirl(which)
    expected = growth_by_amplitude(disc, whirl.state)
    assert expected > 0.0
    large, small = (simulated_growth(disc, whirl, share * amplitude) for share in (1.0, 0.5))
    assert small + (small - large) / 3.0 == pytest.approx(expected, abs=0.1 * abs(small - large))
    assert small == pytest.approx(expected, rel=0.01)


def test_growth_under_23_changes_sign_along_the_boundary():
    """The loss of stability is soft near ω = Ω and hard at higher speeds."""
    signs = []
    for speed in (1.28, 2.0):
        (load,) = crossings(replace(PLANE, lower=(1.27, 1e-3)), "Hopf", "disc_speed", speed, THREE_TERMS)
        disc = replace(FIG11, disc_speed=speed, friction_force=load)
        whirl = min(whirls(disc, THREE_TERMS), key=lambda whirl: abs(whirl.eigenvalues[1].real))
        signs.append(np.sign(growth_by_amplitude(disc, whirl.state, THREE_TERMS)))
    assert signs == [-1.0, 1.0]


@pytest.mark.parametrize("law", [RING, THREE_TERMS], ids=["ring", "(23)"])
def test_whirl_is_a_fixed_point_in_polar_coordinates(law):
    (whirl,) = whirls(FIG11, law)
    state = np.array([whirl.radius, 0.0, whirl.frequency * whirl.radius, FIG11.disc_speed - whirl.spin])
    assert polar_rates(FIG11, law)(state) == pytest.approx(np.zeros(4), abs=1e-15)
