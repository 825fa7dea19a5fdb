"""Whole motions of the paper's systems on a support that hardens or has a stop."""

import math
from dataclasses import replace

import numpy as np
import pytest
from plain_slip import slide_past_stop
from scipy.optimize import brentq

from exudyn_models import simulate, simulate_fixed_step, simulate_with_native_contact
from reference_model.systems import DiscOnDisc, PinOnDisc

PIN = PinOnDisc(mass=1.3, stiffness=1.0, damping=0.1, friction_force=0.09, disc_speed=2.5, offset=0.1)
FREE = replace(PIN, damping=0.0, friction_force=0.0, disc_speed=1.0, offset=0.0)
HARDENING = {"hardening": 2.0}
STOP = {"stop_gap": 0.3, "stop_stiffness": 20.0}
BOTH = HARDENING | STOP


def spring_force(system, d):
    """Return the force of the support at the deflection d, towards its centre."""
    stop = system.stop_stiffness * max(0.0, d - system.stop_gap)
    return system.stiffness * d + system.hardening * d**3 + stop


@pytest.mark.parametrize("law", [HARDENING, BOTH], ids=["hardening", "with a stop"])
def test_the_error_of_a_slipping_pin_is_near_the_tolerance_and_falls_with_the_order_of_the_integrator(law):
    pin, start, times = replace(PIN, **law), [0.3, 0.0, 0.0, 0.2], np.linspace(0.0, 20.0, 21)
    exact = slide_past_stop(pin, start, times)
    deflections = abs(exact[:, 0] - pin.offset + 1j * exact[:, 1])
    assert deflections.min() < STOP["stop_gap"] < deflections.max()
    for tolerance in (1e-5, 1e-9):
        found = simulate(pin, start, times, tolerance=tolerance)
        assert [phase.kind for phase in found.phases] == ["slip"]
        assert np.abs(found.states - exact).max() < 3.0 * tolerance
    witness = simulate_with_native_contact(pin, start, times)
    np.testing.assert_allclose(witness.states, exact, rtol=0.0, atol=3e-9)
    if law is not HARDENING:
        return  # the kink of a stop spoils the order
    for integrator, order, step in (("RK67", 6, 0.1), ("GeneralizedAlpha", 2, 0.02)):
        errors = [
            np.abs(
                simulate_fixed_step(pin, start, times[[0, -1]], integrator=integrator, step=h).at_end
                - exact[-1]
            ).max()
            for h in (step, step / 2.0)
        ]
        assert np.log2(errors[0] / errors[1]) == pytest.approx(order, abs=0.3), errors


@pytest.mark.parametrize("solver", ["explicit", "implicit"])
def test_a_pin_sticks_until_the_support_pulls_harder_than_friction(solver):
    pin = replace(PIN, friction_force=0.45, disc_speed=0.5, **BOTH)
    place, omega = 0.35, pin.disc_speed

    def load(angle):
        z = place * np.exp(1j * angle)
        w = z - pin.offset
        pull = spring_force(pin, abs(w)) * w / abs(w)
        return abs(pin.mass * omega**2 * z - pull - 1j * pin.damping * omega * z)

    angle = brentq(lambda angle: load(angle) - pin.friction_force, 0.0, math.pi, xtol=1e-14)
    assert load(0.0) < pin.friction_force < load(math.pi)
    start = [place, 0.0, 0.0, omega * place]
    found = simulate(pin, start, [0.0, 6.0], tolerance=1e-8, solver=solver)
    assert found.phases[0].kind == "stick"
    assert found.phases[0].end == pytest.approx(angle / omega, abs=1e-4)


def test_a_stop_is_not_overlooked_where_it_is_hardly_touched():
    # A swing of 0.01 mm beyond the gap, 16 ms long: DOPRI5 would miss it if its steps ignored the stop.
    stiffness, gap, stop_stiffness, amplitude = 1.0, 0.3, 1e4, 0.30001
    pin = replace(FREE, stop_gap=gap, stop_stiffness=stop_stiffness)
    k, rate = math.sqrt(stiffness / pin.mass), math.sqrt((stiffness + stop_stiffness) / pin.mass)
    speed = k * amplitude  # on the axis
    until = math.asin(gap / amplitude) / k
    # At a distance y beyond the gap m·ÿ = −C·gap − (C + C_s)·y, so y = 0 again after twice the time to reversal.
    rest = stiffness * gap / (stiffness + stop_stiffness)
    beyond = 2.0 / rate * math.atan2(speed * math.cos(k * until) / rate, rest)
    end = simulate(pin, [0.0, 0.0, speed, 0.0], [0.0, 10.0 * (2.0 * until + beyond)], tolerance=1e-7).at_end
    np.testing.assert_allclose(end, [0.0, 0.0, speed, 0.0], atol=1e-7)


def test_a_disc_without_friction_circles_with_the_secant_stiffness():
    shape = {"polar_inertia": 0.4, "contact_radius": 0.12}
    shaft = {"shaft_damping": 0.1, "shaft_speed": 1.0, "disc_speed": 2.0, "friction_force": 0.0}
    disc = DiscOnDisc(mass=1.3, stiffness=1.0, damping=0.0, offset=0.2, **shape, **shaft, **BOTH)
    radius = 0.5
    frequency = math.sqrt(spring_force(disc, radius) / radius / disc.mass)
    period = math.tau / frequency
    start = [disc.offset + radius, 0.0, 0.3, 0.0, frequency * radius, 1.0]
    end = simulate(disc, start, [0.0, period]).at_end
    np.testing.assert_allclose(end, np.add(start, [0.0, 0.0, period, 0.0, 0.0, 0.0]), atol=2e-9)
