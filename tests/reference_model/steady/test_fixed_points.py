"""Equilibria and whirls of random pins and discs are fixed points of (1) and (19), with the right Jacobian."""

import cmath
import math
from dataclasses import replace

import numpy as np
import pytest
from disc_equations import assert_same_eigenvalues, derivative, eq_23, points_on_ring, rates_in_turning_axes

from reference_model import DiscOnDisc, PinOnDisc, plain, self_centred_equilibria, whirls
from reference_model.contact.contact_law import Ring, ThreeTermRing
from reference_model.formulas import pin as formulas
from reference_model.formulas.disc import pin_of
from reference_model.steady.stability import jacobian_without_angle, turning_frame_jacobian

LAWS, SUPPORTS = (None, Ring, ThreeTermRing), ("linear", "hardening", "stop", "both")
seeds = pytest.mark.parametrize("seed", range(3 * len(LAWS) * len(SUPPORTS)))


def random_system(seed, whirling):
    """Return a random pin or disc with an equilibrium or a whirl, and the law of its contact."""
    rng = np.random.default_rng((seed, whirling))
    law, support = LAWS[seed % 3], SUPPORTS[seed // 3 % 4]
    speed = rng.choice((-1.0, 1.0)) * rng.uniform(*((6.0, 8.0) if whirling else (0.1, 4.0)))
    offset = rng.choice((-1.0, 1.0)) * rng.uniform(0.05, 0.3)
    pin = PinOnDisc(
        mass=rng.uniform(0.5, 2.0), stiffness=rng.uniform(0.5, 2.0), damping=rng.uniform(0.1, 1.0),
        friction_force=1.0, disc_speed=speed, offset=offset, stop_gap=rng.uniform(0.02, 0.1),
        hardening=rng.uniform(1.0, 30.0) if support in ("hardening", "both") else 0.0,
        stop_stiffness=rng.uniform(1.0, 10.0) if support in ("stop", "both") else 0.0,
    )  # fmt: skip
    if whirling:
        radius = abs(offset)
        load = pin.damping * formulas.circling_speed(pin, radius) * radius
        pin = replace(pin, offset=0.0, friction_force=load)
    else:
        share = rng.uniform(0.01, 0.95)
        pin = replace(pin, friction_force=share * formulas.largest_load_with_equilibrium(pin))
    if law is None:
        return pin, None
    disc = DiscOnDisc(
        **vars(pin), polar_inertia=rng.uniform(0.01, 1.0), contact_radius=rng.uniform(0.05, 0.3),
        shaft_damping=rng.uniform(0.001, 0.01), shaft_speed=speed * rng.uniform(0.7, 1.3),
    )  # fmt: skip
    return disc, law(disc.contact_radius)


def friction_of(system, law):
    if law is None:
        return plain.on_ring(system.friction_force, 0.0, 1, 0.0)
    return eq_23(system) if isinstance(law, ThreeTermRing) else points_on_ring(system, 1024)


def assert_fixed_point(system, law, motion, frequency, jacobian):
    state, friction, omega = motion.state, friction_of(system, law), system.disc_speed
    if law is not None:
        state = np.delete(state, 2)
        slip, rim = math.hypot(state[2] + omega * state[1], state[3] - omega * state[0]), omega - motion.spin
        if abs(slip / abs(law.radius * rim) - 1.0) < 0.05:
            return  # the error of 1024 points is of order ratio^1024

    def rates(state):
        return rates_in_turning_axes(system, friction, frequency, state)

    assert np.abs(rates(state)).max() < 1e-12
    expected = derivative(rates, state)
    assert jacobian == pytest.approx(expected, abs=1e-9 * np.abs(expected).max())
    assert_same_eigenvalues(motion.eigenvalues, np.linalg.eigvals(expected), tolerance=1e-8)


@seeds
def test_equilibrium_is_a_fixed_point_on_the_semicircle_4_to_which_friction_drags(seed):
    system, law = random_system(seed, whirling=False)
    (found,) = self_centred_equilibria(system, law)
    jacobian = jacobian_without_angle(system, found.state, law)
    assert_fixed_point(system, law, found, 0.0, jacobian)
    pin = system if law is None else pin_of(system)
    assert formulas.semicircle_residual(pin, found.x, found.y) == pytest.approx(0.0, abs=1e-15)
    assert found.y * system.disc_speed * system.offset > 0.0
    if law is None:
        polar = formulas.equilibrium_radius(pin), formulas.equilibrium_angle(pin)
        assert polar == pytest.approx(cmath.polar(complex(found.x, found.y)), rel=1e-12)
        assert found.stable
    else:
        slowest, fastest = sorted((system.shaft_speed, system.disc_speed))
        assert slowest <= found.spin <= fastest


@seeds
def test_whirl_is_a_fixed_point_in_turning_axes(seed):
    system, law = random_system(seed, whirling=True)
    found = whirls(system, law)
    assert found
    for whirl in found:
        jacobian = turning_frame_jacobian(system, whirl.state, law)
        assert_fixed_point(system, law, whirl, whirl.frequency, jacobian)
        assert whirl.eigenvalues[0] == 0.0
        assert 0.0 < whirl.frequency / system.disc_speed < 1.0
