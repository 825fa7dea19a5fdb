"""Harmonic balance of a whirl on a hardening support, against exact whirls and its residual."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from test_systems import refusal

from reference_model import PinOnDisc, whirls
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


@pytest.mark.parametrize(("pin", "offset"), [(HARD, 0.05), (HARDER, 0.05), (MIRRORED, -0.1)])
def test_mean_and_first_harmonic_of_the_forces_vanish(pin, offset):
    pin = replace(pin, offset=offset)
    found = whirl_by_harmonic_balance(pin)

    e = found.radius * np.exp(2j * np.pi * np.arange(256) / 256)
    w = found.mean + e - pin.offset
    v = 1j * found.frequency * e
    slip = v - 1j * pin.disc_speed * (found.mean + e)
    springs = (pin.stiffness + pin.hardening * abs(w) ** 2) * w
    friction = pin.friction_force * slip / abs(slip)
    residual = -pin.mass * found.frequency**2 * e + pin.damping * v + springs + friction  # of (1)
    harmonics = np.fft.fft(residual / pin.friction_force) / 256
    assert np.abs(harmonics[:2]).max() < 1e-10
    assert abs(harmonics[2]) > 1e-4  # the balance neglects it


def test_pin_without_a_harmonic_balance_is_refused():
    for changes, reason in (
        ({"stop_stiffness": 3.0}, "stop_stiffness = 3 N/m"),
        ({"damping": 0.0}, "as fast as the disc"),
        ({"disc_speed": 1.1}, "ends up sticking"),
    ):
        assert reason in refusal(whirl_by_harmonic_balance, replace(HARD, **changes))
    with pytest.raises(RuntimeError, match="offset = 50 m: too large for harmonic balance"):
        whirl_by_harmonic_balance(replace(HARD, offset=50.0))


def test_a_solution_that_leaves_a_residual_is_refused(monkeypatch):
    nearly = SimpleNamespace(x=np.array([1.0, 1.0, 1e-6, 0.0]))
    monkeypatch.setattr("reference_model.formulas.harmonic_balance.root", lambda *args, **more: nearly)
    with pytest.raises(RuntimeError, match="too large for harmonic balance"):
        whirl_by_harmonic_balance(HARD)
