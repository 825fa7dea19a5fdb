"""Stability and existence of the equilibrium and the whirl, against the equations of motion."""

import math
from dataclasses import replace

import numpy as np
import pytest
from disc_equations import (
    LARGE,
    eq_23,
    mirrored,
    points_on_ring,
    rates,
)
from hypothesis import given
from hypothesis import strategies as st

from compare.claims.parameters import FIG11
from reference_model import plain
from reference_model.contact.annulus import Annulus
from reference_model.contact.contact_law import Ring, ThreeTermRing
from reference_model.formulas import pin as formulas
from reference_model.steady.stability import (
    equilibrium_eigenvalues,
    onset_load,
    sliding_jacobian,
    turning_frame_jacobian,
    whirl_eigenvalues,
)
from reference_model.steady.steady_states import self_centred_equilibria
from reference_model.systems import PinOnDisc

FIG_5 = PinOnDisc(mass=1.0, stiffness=1.0, damping=0.1, friction_force=0.09, disc_speed=1.5, offset=0.1)
HEAVY = PinOnDisc(mass=2.3, stiffness=5.1, damping=0.7, friction_force=0.4, disc_speed=2.2, offset=0.15)
CENTRED = replace(FIG_5, offset=0.0)


COMPLEX_STEP = 1e-20


def rates_of_eq_1(pin, state):
    """Return the right side of (1) as a first-order system, also for complex arguments."""
    return np.array(plain.rates(pin, plain.on_ring(pin.friction_force, 0.0, 1, 0.0), state))


def pin_rates_in_turning_axes(pin, frequency, state):
    """Return the rates of (1) for position and velocity in axes that turn at ``frequency``."""
    turn = np.array([-state[1], state[0], -state[3], state[2]])
    return rates_of_eq_1(pin, state) - frequency * turn


def derivative(function, point):
    """Return the Jacobian by complex steps, which avoids cancellation."""
    point = np.asarray(point, dtype=complex)
    columns = [function(point + 1j * COMPLEX_STEP * e).imag / COMPLEX_STEP for e in np.eye(point.size)]
    return np.column_stack(columns)


def assert_same_eigenvalues(found, expected, tolerance=1e-12):
    left = list(expected)
    assert len(found) == len(left)
    scale = np.abs(left).max()
    for value in found:
        nearest = min(left, key=lambda other: abs(other - value))
        assert abs(nearest - value) <= tolerance * scale, f"{value} not in {expected}"
        left.remove(nearest)


coordinates = st.floats(-2.0, 2.0)


@given(st.lists(coordinates, min_size=4, max_size=4), st.sampled_from([1.5, -0.4]))
def test_sliding_jacobian_is_the_derivative_of_the_equations_of_motion(state, disc_speed):
    pin = replace(HEAVY, disc_speed=disc_speed)
    slip = math.hypot(state[2] + disc_speed * state[1], state[3] - disc_speed * state[0])
    if slip > 1e-3:
        expected = derivative(lambda s: rates_of_eq_1(pin, s), state)
        assert sliding_jacobian(pin, state) == pytest.approx(expected, abs=1e-10 * np.abs(expected).max())


disc_states = st.lists(coordinates, min_size=6, max_size=6)


def slip_ratio(disc, state):
    x, y, _, vx, vy, spin = state
    rim = disc.contact_radius * abs(disc.disc_speed - spin)
    return math.hypot(vx + disc.disc_speed * y, vy - disc.disc_speed * x) / max(rim, 1e-300)


def slowest_point(disc, state):
    x, y, angle, vx, vy, spin = state
    slip = complex(vx + disc.disc_speed * y, vy - disc.disc_speed * x)
    arms = disc.contact_radius * np.exp(1j * (angle + 2.0 * math.pi * np.arange(6) / 6))
    return np.abs(slip - 1j * (disc.disc_speed - spin) * arms).min()


@pytest.mark.parametrize("law", ["six points", "ring", "eq. 23"])
@given(
    state=disc_states,
    disc=st.sampled_from(
        [LARGE, mirrored(LARGE), replace(LARGE, shaft_damping=0.0), replace(LARGE, stiffness=0.0)]
    ),
)
def test_jacobian_of_a_disc_is_the_derivative_of_eq_19(state, disc, law):
    ratio = slip_ratio(disc, state)
    if law == "six points":
        smooth, contact, friction = slowest_point(disc, state) > 1e-3, None, points_on_ring(disc, 6)
        disc = replace(disc, contact_points=6)
    elif law == "ring":  # the error of 1024 points is of order ratio^1024
        smooth, contact, friction = abs(ratio - 1.0) > 0.05, None, points_on_ring(disc, 1024)
    else:
        smooth, contact, friction = ratio > 1e-3, ThreeTermRing(disc.contact_radius), eq_23(disc)
    if smooth:
        expected = derivative(lambda s: rates(disc, friction, s), state)
        found = sliding_jacobian(disc, state, contact)
        assert found == pytest.approx(expected, abs=1e-10 * np.abs(expected).max())


@pytest.mark.parametrize("disc_speed", [0.01, 0.8, 3.0, -0.8])
@pytest.mark.parametrize("load_ratio", [0.0, 0.1, 0.5, 0.99])
@pytest.mark.parametrize("pin", [FIG_5, replace(HEAVY, offset=-0.15), replace(FIG_5, damping=4.0)])
def test_eigenvalues_of_the_equilibrium_are_those_of_its_jacobian(pin, load_ratio, disc_speed):
    load = load_ratio * formulas.largest_load_with_equilibrium(pin)
    pin = replace(pin, friction_force=load, disc_speed=disc_speed)
    state = [*formulas.equilibrium_position(pin), 0.0, 0.0]
    expected = np.linalg.eigvals(derivative(lambda s: rates_of_eq_1(pin, s), state))
    # With weak friction eigenvalues are nearly equal, so the general solver finds them to the root of rounding.
    assert_same_eigenvalues(equilibrium_eigenvalues(pin), expected, tolerance=1e-8)


@pytest.mark.parametrize("disc_speed", [1.001, 1.2, 2.0, 30.0, -1.2])
@pytest.mark.parametrize("damping", [0.01, 0.1, 1.0, 8.0])
def test_eigenvalues_of_the_whirl_are_zero_and_the_roots_of_the_corrected_13(damping, disc_speed):
    pin = replace(CENTRED, damping=damping, disc_speed=disc_speed)
    eigenvalues = whirl_eigenvalues(pin)
    assert eigenvalues[0] == 0.0
    roots = np.roots(formulas.characteristic_coefficients(pin))
    assert_same_eigenvalues(eigenvalues[1:], roots, tolerance=1e-11)
    assert_same_eigenvalues(eigenvalues, np.linalg.eigvals(turning_frame_jacobian(pin)), tolerance=1e-11)


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
    for speed in (1.5, -1.5, 4.0)
    for shaft in (1.25, -1.25, 9.0)
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
    below, above = (
        self_centred_equilibria(replace(disc, friction_force=factor * load), contact)[0].stable
        for factor in (1.0 - 1e-9, 1.0 + 1e-9)
    )
    assert below
    assert not above


@pytest.mark.parametrize("speed", [0.0, 0.5, 1.0, -1.0])
@pytest.mark.parametrize("share", [0.01, 0.5, 0.999])
def test_centred_rotation_on_a_slow_master_disc_is_stable_at_every_load(speed, share):
    disc = replace(FIG11, disc_speed=speed, shaft_speed=speed - 0.25)
    with pytest.raises(ValueError, match=f"disc_speed = {speed:g} rad/s.*natural frequency 1 rad/s"):
        onset_load(disc)
    disc = replace(
        disc, friction_force=share * 0.015 * 0.25 / 0.12
    )  # share of the load at which the disc sticks
    assert self_centred_equilibria(disc)[0].stable


@pytest.mark.parametrize("load", [0.0, 1e-9, 0.05, 0.09])
def test_undamped_equilibrium_is_only_marginally_stable(load):
    (equilibrium,) = self_centred_equilibria(replace(FIG_5, damping=0.0, friction_force=load))
    assert equilibrium.eigenvalues[0] == 1j
    assert not equilibrium.stable
