"""Stability and existence of the equilibrium and the whirl, against the equations of motion."""

import math
from dataclasses import replace

import numpy as np
import pytest
from disc_equations import LARGE, derivative, mirrored, points_on_ring, rates
from hypothesis import given
from hypothesis import strategies as st

from compare.claims.parameters import FIG11
from reference_model.contact.annulus import Annulus
from reference_model.contact.contact_law import Ring, ThreeTermRing
from reference_model.steady.stability import (
    equilibrium_eigenvalues,
    onset_load,
    sliding_jacobian,
    whirl_eigenvalues,
)
from reference_model.steady.steady_states import self_centred_equilibria
from reference_model.systems import PinOnDisc

FIG_5 = PinOnDisc(mass=1.0, stiffness=1.0, damping=0.1, friction_force=0.09, disc_speed=1.5, offset=0.1)
CENTRED = replace(FIG_5, offset=0.0)


@given(
    state=st.lists(st.floats(-2.0, 2.0), min_size=6, max_size=6),
    disc=st.sampled_from([LARGE, mirrored(LARGE), replace(LARGE, shaft_damping=0.0, stiffness=0.0)]),
)
def test_jacobian_of_a_disc_on_points_is_the_derivative_of_eq_19(state, disc):
    x, y, angle, vx, vy, spin = state
    slip = complex(vx + disc.disc_speed * y, vy - disc.disc_speed * x)
    arms = disc.contact_radius * np.exp(1j * (angle + 2.0 * math.pi * np.arange(6) / 6))
    if np.abs(slip - 1j * (disc.disc_speed - spin) * arms).min() > 1e-3:
        expected = derivative(lambda s: rates(disc, points_on_ring(disc, 6), s), state)
        found = sliding_jacobian(replace(disc, contact_points=6), state)
        assert found == pytest.approx(expected, abs=1e-10 * np.abs(expected).max())


def test_eigenvalues_are_sorted_by_decay():
    for eigenvalues in (equilibrium_eigenvalues(FIG_5), whirl_eigenvalues(CENTRED)):
        assert list(np.diff([value.real for value in eigenvalues]) <= 0.0) == [True] * 3
        upper = [value for value in eigenvalues if value.imag > 0.0]
        followers = [eigenvalues[eigenvalues.index(value) + 1] for value in upper]
        assert upper
        assert followers == [value.conjugate() for value in upper]


def test_slow_eigenvalue_of_a_strongly_damped_equilibrium_is_accurate_to_rounding():
    slowest = equilibrium_eigenvalues(replace(FIG_5, damping=1e8, friction_force=0.0))[0]
    assert slowest == pytest.approx(-1e-8, rel=1e-14, abs=0.0)


TURNING = [
    replace(FIG11, disc_speed=speed, shaft_speed=shaft)
    for speed, shaft in ((1.5, 1.25), (-1.5, 1.25), (4.0, 9.0))
]


@pytest.mark.parametrize(
    "law", [Ring, ThreeTermRing, lambda R: Annulus(0.5 * R, R), lambda R: Annulus(0.0, R)]
)
@pytest.mark.parametrize("disc", [*TURNING, replace(LARGE, offset=0.0)])
def test_centred_rotation_loses_stability_at_the_onset_load_with_the_natural_frequency(disc, law):
    contact = law(disc.contact_radius)
    load = onset_load(disc, contact)
    (at_onset,) = self_centred_equilibria(replace(disc, friction_force=load), contact)
    assert (at_onset.x, at_onset.y) == (0.0, 0.0)
    critical = max(at_onset.eigenvalues, key=lambda value: value.real)
    k = disc.natural_frequency
    assert critical.real == pytest.approx(0.0, abs=1e-13 * k)
    assert abs(critical.imag) == pytest.approx(k, rel=1e-13)
    for factor in (1.0 - 1e-9, 1.0 + 1e-9):
        (centred,) = self_centred_equilibria(replace(disc, friction_force=factor * load), contact)
        assert centred.stable == (factor < 1.0)


@pytest.mark.parametrize(("speed", "share"), [(0.0, 0.5), (1.0, 0.999), (-1.0, 0.01)])
def test_centred_rotation_on_a_slow_master_disc_is_stable_at_every_load(speed, share):
    disc = replace(FIG11, disc_speed=speed, shaft_speed=speed - 0.25)
    with pytest.raises(ValueError, match=f"disc_speed = {speed:g} rad/s.*natural frequency 1 rad/s"):
        onset_load(disc)
    sticking = 0.015 * 0.25 / 0.12
    disc = replace(disc, friction_force=share * sticking)
    assert self_centred_equilibria(disc)[0].stable


@pytest.mark.parametrize("load", [0.0, 0.09])
def test_undamped_equilibrium_is_only_marginally_stable(load):
    (equilibrium,) = self_centred_equilibria(replace(FIG_5, damping=0.0, friction_force=load))
    assert equilibrium.eigenvalues[0] == 1j
    assert not equilibrium.stable
