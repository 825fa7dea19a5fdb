"""Harmonic balance of a whirl on a hardening support, against exact whirls and orbits."""

import math
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from scipy.integrate import quad_vec
from test_systems import refusal

from reference_model import PinOnDisc, whirl_orbit, whirls
from reference_model.formulas.harmonic_balance import whirl_by_harmonic_balance

HARD = PinOnDisc(mass=1.0, stiffness=1.0, damping=0.1, friction_force=0.09, disc_speed=2.5, hardening=0.5)
HARDER = PinOnDisc(mass=1.3, stiffness=1.0, damping=0.4, friction_force=0.3, disc_speed=2.0, hardening=1.5)
MIRRORED = PinOnDisc(mass=2.0, stiffness=3.0, damping=0.8, friction_force=0.7, disc_speed=-2.5, hardening=2.0)
CUBIC = PinOnDisc(mass=1.0, stiffness=0.0, damping=0.1, friction_force=0.06, disc_speed=2.5, hardening=2.0)


@pytest.mark.parametrize("pin", [HARD, HARDER, MIRRORED, CUBIC, replace(HARD, hardening=0.0)])
def test_balance_without_offset_gives_the_exact_whirl(pin):
    (whirl,) = whirls(pin)
    found = whirl_by_harmonic_balance(pin)
    assert found.radius == pytest.approx(whirl.radius, rel=1e-12)
    assert found.frequency == pytest.approx(whirl.frequency, rel=1e-12)
    assert abs(found.mean) < 1e-12 * whirl.radius


@pytest.mark.parametrize(("pin", "offset"), [(HARDER, 0.05), (MIRRORED, -0.1)])
def test_mean_and_first_harmonic_of_the_forces_vanish(pin, offset):
    pin = replace(pin, offset=offset)
    found = whirl_by_harmonic_balance(pin)

    def force(turn):
        """Return the residual of (1) relative to friction."""
        e = found.radius * np.exp(1j * turn)
        w = found.mean + e - pin.offset
        v = 1j * found.frequency * e
        slip = v - 1j * pin.disc_speed * (found.mean + e)
        springs = (pin.stiffness + pin.hardening * abs(w) ** 2) * w
        friction = pin.friction_force * slip / abs(slip)
        return (
            -pin.mass * found.frequency**2 * e + pin.damping * v + springs + friction
        ) / pin.friction_force

    def harmonic(order):
        def real_and_imaginary(turn):
            value = force(turn) * np.exp(-1j * order * turn)
            return np.array([value.real, value.imag])

        return quad_vec(real_and_imaginary, 0.0, 2.0 * math.pi)[0]

    assert harmonic(0) == pytest.approx([0.0, 0.0], abs=1e-9)
    assert harmonic(1) == pytest.approx([0.0, 0.0], abs=1e-9)
    assert np.abs(harmonic(2)).max() > 1e-3  # the balance neglects it


@pytest.mark.parametrize("pin", [HARD, MIRRORED])
def test_errors_are_of_second_order_in_the_offset_and_of_first_order_for_the_mean(pin):
    offsets = np.array([0.002, 0.004])
    errors = []
    for offset in offsets:
        balanced = whirl_by_harmonic_balance(replace(pin, offset=offset))
        orbit = whirl_orbit(replace(pin, offset=offset), samples=64)
        z = orbit.trajectory.states[:-1, 0] + 1j * orbit.trajectory.states[:-1, 1]
        harmonics = np.fft.fft(z) / len(z)
        first = harmonics[1 if pin.disc_speed > 0.0 else -1]
        errors.append(
            [
                abs(abs(first) - balanced.radius),
                abs(orbit.frequency - abs(balanced.frequency)),
                abs(harmonics[0] - balanced.mean),
            ]
        )
    orders = np.diff(np.log(errors), axis=0)[0] / np.log(2.0)
    assert orders == pytest.approx([2.0, 2.0, 1.0], abs=0.05), errors
    # The circle without offset has an error of the same order, but a larger one.
    (whirl,) = whirls(replace(pin, offset=0.0))
    assert errors[1][0] < 0.2 * abs(abs(first) - whirl.radius)


def test_pin_without_a_harmonic_balance_is_refused():
    for changes, reason in (
        ({"stop_stiffness": 3.0}, "stop_stiffness = 3 N/m"),
        ({"damping": 0.0}, "as fast as the disc"),
        ({"disc_speed": 1.1}, "ends by sticking"),
    ):
        assert reason in refusal(whirl_by_harmonic_balance, replace(HARD, **changes))
    with pytest.raises(RuntimeError, match="offset = 50 m: too large for harmonic balance"):
        whirl_by_harmonic_balance(replace(HARD, offset=50.0))


def test_a_solution_that_leaves_a_residual_is_refused(monkeypatch):
    nearly = SimpleNamespace(x=np.array([1.0, 1.0, 1e-6, 0.0]))
    monkeypatch.setattr("reference_model.formulas.harmonic_balance.root", lambda *args, **more: nearly)
    with pytest.raises(RuntimeError, match="too large for harmonic balance"):
        whirl_by_harmonic_balance(HARD)
